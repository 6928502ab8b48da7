//! Motion: the equation of motion and its exact, event-driven integration.

mod base;
mod clock;
mod compliant;
mod composite;
mod contact;
mod describe;
mod drive;
mod equation;
mod extent;
mod glide;
mod lanes;
mod live;
mod model;
mod motion;
mod path;
mod penetration;
mod prepare;
mod rebound;
mod record;
mod recurrence;
mod regime;
mod result;
mod scales;
mod series;
mod step;
mod summary;
mod taylor;
mod tone;
mod totals;

pub(crate) use base::BaseTone;
pub use base::STANDARD_GRAVITY;
pub use live::{Live, LiveLedger, Passage};
pub(crate) use model::StopAt;
pub use model::{Model, Request};
pub use result::*;
pub use scales::Scales;
