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

pub use live::{Live, LiveLedger, LiveOutput};
pub use model::Model;
pub use model::excitation::STANDARD_GRAVITY;
pub(crate) use model::excitation::TonePart;
pub use model::scales::Scales;
pub(crate) use model::stops::StopAt;
pub use result::*;
