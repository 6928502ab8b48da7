//! Verdict on a motion that neither came to rest nor to a known orbit.

use crate::dynamics::{Outcome, Place, Regime, Summary};

/// Classification of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Verdict {
    /// A settled motion: all with the same regime, side and period (if any) are one attractor.
    Settled {
        /// See [`Regime`].
        regime: Regime,
        /// Where it is.
        side: Option<Place>,
        /// Its period, where no ellipse could be found around it.
        period: Option<u32>,
    },
    /// It ended early.
    Lost,
    /// Its attractor is not known.
    Undecided,
}

/// The verdict by the summary of a pursuit, whose window is its last hundred forcing periods, and whether it
/// ended on an orbit that is unstable. A verdict without a period is confirmed by the exponent of one motion
/// of its kind.
///
/// An exponent tells irregular motion from a motion that is slow to settle, but not from a long transient:
/// the transients of a double well are themselves irregular, and end by chance. So a motion is called
/// irregular only after a thousand periods in which it found no other.
pub(super) fn verdict(summary: &Summary, on_unstable: bool) -> Verdict {
    match summary.outcome {
        Outcome::Done if on_unstable || summary.steady != Some(true) => Verdict::Undecided,
        Outcome::Done => {
            Verdict::Settled { regime: summary.regime, side: summary.side, period: summary.period }
        }
        _ => Verdict::Lost,
    }
}
