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
pub use model::excitation::{ChirpPart, ExcitationParts, NoisePart, STANDARD_GRAVITY, TonePart};
pub use model::scales::Scales;
pub use model::stops::{StopAt, StopPair};
pub use result::*;
