//! Request and results of a run: samples, events, statistics, outcome and ledger. All SI.

mod arrival;
mod event;
mod outcome;
mod request;
mod summary;

pub use arrival::{Arrival, Capture, Pursued, Pursuit, Region, ReleaseIdentity};
pub use event::{Event, EventKind, Phase, Sample, SectionPoint, Side};
pub use outcome::{Outcome, Place, Regime};
pub use request::Request;
pub use summary::{First, Firsts, Harvest, Ledger, Summary};

/// Everything a run returns.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Run {
    /// The state at the requested times, up to the end of the run.
    pub samples: Vec<Sample>,
    /// Events in order of time, if they were requested.
    pub events: Vec<Event>,
    /// The states of the settled window at the requested phase, one a forcing period, if they were requested
    /// and the drive repeats; at most some 4 million, and up to the end of the run.
    pub section: Vec<SectionPoint>,
    /// Displacement in m and velocity in m/s at the last instant that is a whole number of forcing periods
    /// after the start, if it was requested and the drive repeats.
    pub carried: Option<(f64, f64)>,
    /// Statistics, outcome and ledger.
    pub summary: Summary,
}
