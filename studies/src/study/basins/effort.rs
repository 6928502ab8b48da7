//! Work of a map of basins: the total, what is done, and the share of one start.
//!
//! A well may swing ten thousand times in a forcing period, and a map would then take days. So work is
//! counted, in the units of a [`Pursuit`](crate::dynamics::Pursuit), and what is left of it between rounds
//! decides how far a start is followed: so the answer does not depend on the number of threads.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::dynamics::{Arrival, Pursued, Pursuit};

/// Units of the orbits and regions that a map looks for: the ellipses of an orbit of 12 periods that passes a
/// kink of the force take some of the prototype's.
const OF_THE_MAP: u64 = 20_000_000_000;

/// Units of each start: four times those of the prototype followed for 1000 forcing periods.
const OF_A_START: u64 = 20_000_000;

/// Starts differ in work: one may take this many times its share of what is left.
const SHARES: u64 = 4;
/// Units that a start may take in any case.
const LEAST: u64 = 2_000_000;

/// Work of one map.
#[derive(Debug)]
pub(super) struct Effort {
    budget: u64,
    done: AtomicU64,
    /// Forcing periods that were followed for it.
    periods: AtomicU64,
}

impl Effort {
    pub fn of_starts(count: usize) -> Self {
        let budget = OF_THE_MAP + OF_A_START.saturating_mul(count as u64);
        Self { budget, done: AtomicU64::new(0), periods: AtomicU64::new(0) }
    }

    /// Adds a pursuit whose forcing period in s is given.
    pub fn add(&self, pursuit: &Pursuit, pursued: &Pursued, period: f64) {
        let ended = || match &pursued.arrival {
            Arrival::Unsettled(summary) => summary.outcome.ended_at().map(|at| (at / period) as u64),
            _ => None,
        };
        let periods = pursued.arrival.periods().or_else(ended).unwrap_or(pursuit.most_periods);
        self.done.fetch_add(pursued.work, Ordering::Relaxed);
        self.periods.fetch_add(periods, Ordering::Relaxed);
    }

    fn left(&self) -> u64 {
        self.budget.saturating_sub(self.done.load(Ordering::Relaxed))
    }

    /// Units that each start may take while `remaining` starts are still to be followed.
    pub fn of_one(&self, remaining: usize) -> u64 {
        (SHARES * (self.left() / remaining.max(1) as u64)).max(LEAST)
    }

    /// Whether `periods` more forcing periods, each with the mean work of those before, are within what
    /// is left.
    pub fn has_room_for(&self, periods: u64) -> bool {
        let (done, before) = (self.done.load(Ordering::Relaxed), self.periods.load(Ordering::Relaxed));
        done as f64 / before.max(1) as f64 * periods as f64 <= self.left() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_start_may_take_some_shares_of_what_is_left_and_a_search_what_fits() {
        let effort = Effort::of_starts(100);
        assert_eq!(effort.of_one(100), SHARES * (OF_THE_MAP / 100 + OF_A_START));
        assert!(effort.has_room_for(u64::MAX), "nothing is known of the work of a period yet");
        let pursuit = Pursuit {
            start: (0.0, 0.0),
            known: &[],
            regions: &[],
            repeats_from: 0,
            most_periods: 1000,
            releases: 0,
            most_work: u64::MAX,
        };
        let arrival = Arrival::Captured { which: 0, periods: 1000 };
        let pursued = |work| Pursued { arrival: arrival.clone(), crossings: 0, work };
        effort.add(&pursuit, &pursued(OF_THE_MAP), 1.0);
        // 2e7 units a period, and 2e9 are left
        assert!(effort.has_room_for(100) && !effort.has_room_for(101));
        effort.add(&pursuit, &pursued(OF_THE_MAP), 1.0);
        assert!(!effort.has_room_for(1));
        assert_eq!(effort.of_one(3), LEAST);
    }
}
