//! Motion: the equation of motion and its exact, event-driven integration.

mod model;
mod result;

pub use model::{Model, Request};
pub use result::*;
