//! Work of a run and its budgets, which limit the computation and not the simulated time.
//!
//! Work is counted in units of about ten nanoseconds of one core. The cost of a step of free flight grows
//! with the order of its series, the degree of the force and each part of the drive; those of a step of
//! contact with a compliant stop, a search for a release and the replay of a lap were measured. Laps that are
//! added by multiplication cost nothing, so a run that recurs is completed however long it is. Samples,
//! events and the ledger are not counted: a request does not affect how a run ends, unless laps are replayed.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::dynamics::drive::Drive;
use crate::numeric::Scalar;

/// Units of work that one run may take: five to twenty seconds of one core, depending on the parts of the
/// scene, and at least 2e7 steps of a cubic force under one sine at any tolerance.
pub(crate) const WORK_BUDGET: u64 = 1_000_000_000;

/// Impacts that one run may compute one by one, without those that laps add by multiplication.
pub(crate) const IMPACT_BUDGET: u64 = 2_000_000;

/// Units between two checks of the cancel flag: 200 steps of a simple scene, some tenths of a millisecond.
const CHECK_INTERVAL: u64 = 10_000;

/// Cost of a sample, without the sum of the drive's parts.
const SAMPLE: u64 = 10;

/// Cost of an arrival at a surface, whose instant is a root of the step's polynomial.
pub(crate) const ARRIVAL: u64 = 50;

/// Cost of a log entry that is replayed.
pub(crate) const REPLAYED: u64 = 10;

/// Costs of the parts of a run, in units of work.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Costs {
    pub step: u64,
    /// Another check of a step, after it was halved.
    pub check: u64,
    /// An expansion in contact with a compliant stop, or an impact on it as one step.
    pub contact: u64,
    sample: u64,
}

impl Costs {
    /// For series of this order, forces of up to this degree, and a drive.
    pub fn new<T: Scalar, D: Drive<T>>(order: usize, degree: usize, drive: &D) -> Self {
        let (order, products) = (order as u64, degree as u64 / 2);
        let drive = drive.cost(order as usize);
        let step = 20 + order * order * (2 + 2 * products) / 80 + drive;
        Self {
            step,
            check: 5 + products + drive / 2,
            contact: 40 + order * order / 3 + drive,
            sample: SAMPLE + drive,
        }
    }

    pub fn samples_per_check(&self) -> u64 {
        (CHECK_INTERVAL / self.sample).max(1)
    }
}

/// Work done, its limit, and the next check of the cancel flag.
#[derive(Debug, Clone)]
pub(crate) struct Work<'a> {
    pub done: u64,
    max_units: u64,
    pub impacts: u64,
    next_check: u64,
    cancel: Option<&'a AtomicBool>,
}

impl<'a> Work<'a> {
    pub fn new(cancel: Option<&'a AtomicBool>) -> Self {
        Self { done: 0, max_units: WORK_BUDGET, impacts: 0, next_check: CHECK_INTERVAL, cancel }
    }

    pub fn limit(&mut self, max_units: u64) {
        self.max_units = self.max_units.min(max_units);
    }

    #[inline]
    pub fn add(&mut self, units: u64) {
        self.done += units;
    }

    /// Whether this many more units are within the budgets.
    pub fn has_room_for(&self, units: u64) -> bool {
        self.done + units < self.max_units && self.impacts < IMPACT_BUDGET
    }

    pub fn is_done(&self) -> bool {
        self.done >= self.max_units
    }

    /// Number of pieces of this cost up to the next check of the cancel flag, at least one.
    pub fn pieces_until_check(&self, cost: u64) -> u64 {
        (self.next_check.saturating_sub(self.done) / cost.max(1)).max(1)
    }

    /// Whether the run is cancelled; checks the flag at intervals.
    #[inline]
    pub fn check_cancelled(&mut self) -> bool {
        if self.done < self.next_check {
            return false;
        }
        self.next_check = self.done + CHECK_INTERVAL;
        self.is_cancelled()
    }

    /// Whether the run is cancelled; checks the flag at once.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::drive::Constant;
    use crate::dynamics::drive::general::General;
    use crate::dynamics::drive::tone::{Tone, TurnsPerCycle};

    #[test]
    fn a_simple_scene_may_take_twenty_million_steps_at_any_tolerance() {
        for order in 8..=23 {
            let costs = Costs::new::<f64, _>(order, 3, &Constant { acceleration: 0.0 });
            assert!(WORK_BUDGET / costs.step >= 20_000_000, "{order} {costs:?}");
        }
        const { assert!(IMPACT_BUDGET >= 2_000_000) };
    }

    #[test]
    fn checks_are_equally_far_apart_for_any_cost_of_a_piece() {
        let cancel = AtomicBool::new(true);
        for cost in [1, 30, 9_999, 10_000, 3_000_000] {
            let mut work = Work::new(Some(&cancel));
            let mut pieces = 0;
            while !work.check_cancelled() {
                work.add(cost);
                pieces += 1;
            }
            assert_eq!(pieces, CHECK_INTERVAL.div_ceil(cost));
            assert!(work.pieces_until_check(cost) <= pieces.max(1));
        }
    }

    #[test]
    fn every_part_of_a_drive_costs_its_share() {
        let ratio = TurnsPerCycle::Rounded(1.0);
        let tone = Tone { amplitude: 1.0, frequency: 1.0, ratio, phase: 0.0, quarter: false, ramp: None };
        let drive = |lines: usize| General { tones: vec![tone.clone(); lines], ..General::default() };
        let step = |lines| Costs::new(16, 3, &drive(lines)).step;
        assert!(step(4096) > 500 * step(1) && step(64) > 5 * step(1));
        assert_eq!(Costs::new(16, 3, &drive(4096)).samples_per_check(), 1);
    }
}
