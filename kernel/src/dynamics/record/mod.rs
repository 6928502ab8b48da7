//! Record of a run: samples, events, statistics, ledger. It does not affect the motion.

pub(crate) mod barrier;
mod crossings;
mod decay;
pub(crate) mod event_free;
pub(crate) mod events;
pub(crate) mod goal;
pub(crate) mod laps;
mod listing;
pub(crate) mod log;
pub(crate) mod recorder;
mod regime;
pub(crate) mod repeats;
mod steps;
pub(crate) mod summary;
mod sums;
mod window;
