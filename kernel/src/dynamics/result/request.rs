//! Request of a run: what it keeps, and when it ends.

use std::sync::atomic::AtomicBool;

/// What a run should keep.
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
    /// The run goes on, window after window, until the motion repeats or the next window would end after
    /// this time in s. No effect under a drive that does not repeat, or if the window holds less than two
    /// forcing periods.
    pub until_settled: Option<f64>,
    /// Phase of the drive in turns at which the states of the settled window are kept, one a forcing period
    /// ([`Run::section`](super::Run::section)).
    pub section: Option<f64>,
    /// Whether to keep the state from which another run can continue ([`Run::carried`](super::Run::carried)).
    pub carry: bool,
}
