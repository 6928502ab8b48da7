//! Motion: the equation of motion and its exact, event-driven integration.

mod clock;
mod contact;
mod describe;
mod drive;
mod equation;
mod model;
mod motion;
mod prepare;
mod record;
mod regime;
mod result;
mod scales;
mod series;
mod summary;

pub use model::{Model, Request, STANDARD_GRAVITY};
pub use result::*;
pub use scales::Scales;
