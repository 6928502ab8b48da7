//! Onsets of a motion, and the verdict of a run on one: whether the motion does it, and whether that
//! is known.

use crate::dynamics::{Outcome, Regime, Summary};

/// What begins at a threshold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Onset {
    /// The mass leaves the stop on which it rests.
    Release,
    /// The settled motion crosses the barrier at all.
    Crossing,
    /// The settled motion crosses, and its crossings repeat.
    Interwell,
}

/// Verdict of a run on an onset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Verdict {
    /// Whether the motion does it in the last window of the run.
    pub does: bool,
    /// Whether it goes on so: the motion repeats or rests. A motion that does not, up to the end of the time
    /// for which it is followed, may be a transient: one that crosses may stay in one well later, and one in
    /// one well may cross later. Under a drive that does not repeat, the verdict is about the run itself.
    pub known: bool,
}

impl Verdict {
    /// Of a value that makes no valid model.
    pub(super) const NO_MODEL: Self = Self { does: false, known: false };
}

impl Onset {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Release, Self::Crossing, Self::Interwell];

    /// The word on the command line and in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Release => "release",
            Self::Crossing => "crossing",
            Self::Interwell => "interwell",
        }
    }

    /// The verdict of the run with this summary.
    pub fn verdict(self, summary: &Summary) -> Verdict {
        let does = match self {
            Self::Release => summary.releases > 0,
            Self::Crossing => summary.crossings > 0 && summary.regime != Regime::OneWell,
            Self::Interwell => summary.regime == Regime::Interwell,
        };
        Verdict { does, known: goes_on_so(summary) }
    }
}

/// Whether what a run did in its last window is what the motion does from then on: it repeats or rests, or
/// the drive has no period and nothing is asked beyond the run.
fn goes_on_so(summary: &Summary) -> bool {
    let within_the_run = summary.settled.is_none() || summary.periods == 0;
    summary.outcome == Outcome::Done && (summary.settled == Some(true) || within_the_run)
}
