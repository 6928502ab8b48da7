//! Motion: the equation of motion and its exact, event-driven integration.

mod clock;
mod describe;
mod drive;
mod equation;
mod model;
mod motion;
mod record;
mod regime;
mod result;
mod scales;
mod series;

pub use model::{Model, Request, STANDARD_GRAVITY};
pub use result::*;
pub use scales::Scales;
