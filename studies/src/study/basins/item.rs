//! Items that a map of basins follows, and the length of their way to an attractor.

use super::starts::Starts;
use crate::dynamics::{Capture, Pursuit, Region};
use crate::study::settled;

/// Forcing periods after which a motion that reaches no known attractor is judged.
pub(super) const PATIENCE: u64 = settled::PATIENCE as u64;

/// Length of a motion until its attractor is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Way {
    /// Forcing periods.
    pub periods: u32,
    /// Crossings of the barrier.
    pub crossings: u32,
}

impl Way {
    /// These counts less those of `before`.
    pub fn since(self, before: Self) -> Self {
        Self {
            periods: self.periods.saturating_sub(before.periods),
            crossings: self.crossings.saturating_sub(before.crossings),
        }
    }

    /// This way followed by another.
    pub fn and(self, next: Self) -> Self {
        Self {
            periods: self.periods.saturating_add(next.periods),
            crossings: self.crossings.saturating_add(next.crossings),
        }
    }
}

/// A motion to follow: a start, or the motion after a release, as the continuation of a start past
/// some releases.
#[derive(Debug, Clone, Copy)]
pub(super) struct Item {
    pub row: usize,
    pub releases: u32,
    /// The release that it continues, and the way up to there.
    pub after: Option<(u32, Way)>,
    pub repeats_from: u64,
}

impl Item {
    /// A start.
    pub fn of_start(row: usize) -> Self {
        Self { row, releases: 0, after: None, repeats_from: 0 }
    }

    /// The way of a pursuit, counted from where it continues another one.
    pub fn way(&self, periods: u64, crossings: u64) -> Way {
        let count = |number: u64| u32::try_from(number).unwrap_or(u32::MAX);
        let whole = Way { periods: count(periods), crossings: count(crossings) };
        whole.since(self.after.map_or(Way::default(), |(_, before)| before))
    }

    /// The item as a pursuit of at most `most_work` units.
    pub fn pursuit<'a>(
        &self,
        starts: &Starts,
        known: &'a [Capture],
        regions: &'a [Region],
        most_work: u64,
    ) -> Pursuit<'a> {
        let (x_mm, v) = starts.at(self.row);
        Pursuit {
            start: (x_mm / 1e3, v),
            known,
            regions,
            repeats_from: self.repeats_from,
            most_periods: PATIENCE,
            releases: self.releases,
            most_work,
        }
    }
}
