//! Request and results of a run: samples, events, statistics, outcome and ledger. All SI.

mod arrival;
mod event;
mod outcome;
mod summary;

use std::sync::atomic::AtomicBool;

pub use arrival::{Arrival, Beside, Capture, Pursued, Pursuit, Region, ReleaseIdentity, Trail};
pub use event::{Event, EventKind, MapState, Phase, Sample, SectionPoint, Side};
pub use outcome::{Outcome, Place, Regime};
pub use summary::{First, Firsts, Harvest, Ledger, Summary};

/// The results that a run should keep.
///
/// The default keeps the summary alone, which is the fastest. What is kept has no influence on the motion:
/// the numbers of the summary have the same bits with and without samples and events.
#[derive(Debug, Clone, Copy, Default)]
pub struct Request<'a> {
    /// Times in s at which to sample, ascending, within 0..=duration.
    pub sample_times: &'a [f64],
    /// Whether to keep the list of events.
    pub events: bool,
    /// Whether to keep the energy ledger (a sweep does not need it).
    pub ledger: bool,
    /// A flag that another thread sets to end the run early with the outcome `Cancelled`.
    pub cancel: Option<&'a AtomicBool>,
    /// The run is extended, window after window, until the motion repeats or the next window would end after
    /// this time in s. No effect under a drive that does not repeat, or if the window holds less than two
    /// forcing periods.
    pub until_settled: Option<f64>,
    /// Phase of the drive in turns at which the states of the settled window are kept, one per forcing period
    /// ([`Run::section`]).
    pub section: Option<f64>,
    /// Whether to keep the state from which another run can continue ([`Run::carried`]).
    pub carry: bool,
    /// Whether the run ends with the step in which the mass first crosses the barrier.
    pub until_crossing: bool,
}

/// Everything a run returns.
///
/// A run never fails: if it cannot go on, [`Summary::outcome`] says why and when, and samples and events
/// reach up to there. What was not requested is empty.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Run {
    /// The state at the requested times, up to the end of the run.
    pub samples: Vec<Sample>,
    /// Events in order of time, if they were requested.
    pub events: Vec<Event>,
    /// The states of the settled window at the requested phase, one per forcing period, if they were
    /// requested and the drive repeats; at most some 4 million, and up to the end of the run.
    pub section: Vec<SectionPoint>,
    /// The state at the last instant that is a whole number of forcing periods
    /// after the start, if it was requested and the drive repeats.
    pub carried: Option<MapState>,
    /// Statistics, outcome and ledger.
    pub summary: Summary,
}
