//! Motion: the equation of motion and its exact, event-driven integration.

mod clock;
mod contact;
mod drive;
mod equation;
mod lanes;
mod live;
mod model;
mod motion;
mod record;
mod result;
mod run;
mod series;
mod state;
mod step;

pub use live::{Live, LiveLedger, Passage};
pub use model::Model;
pub(crate) use model::excitation::BaseTone;
pub use model::excitation::STANDARD_GRAVITY;
pub use model::scales::Scales;
pub(crate) use model::stops::StopAt;
pub use result::*;
