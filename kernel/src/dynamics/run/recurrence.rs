//! Recurrence: completion, without integration, of a run whose motion has returned to an earlier state.
//!
//! A mass released from rest under a drive that repeats starts from a state that can be identified without
//! comparing computed numbers: it is on the stop, has no speed, and the phase of the drive is that of the
//! release root. So a release has a *label*: the stop, and the root within the drive's common period. Two
//! releases with equal labels are followed by the same motion, bit for bit, since the integrator does the
//! same arithmetic some cycles of the clock later. (If curve, stops and drive are symmetric, a release from
//! the other stop half a period later is followed by the mirror image, to rounding.)
//!
//! From the first labelled release on, every recorder call is kept in a log. When a label occurs again, the
//! calls of that lap are replayed, lap by lap. The same code then produces samples, events, stroboscopic
//! states and sums, even if a window opens or closes within a lap. Laps that lie entirely inside or entirely
//! outside the settled window are added to sums and counts by multiplication, and replayed only if something
//! in them is listed. The last, incomplete lap is replayed up to its last step, which is integrated.
//!
//! These have no label: a release immediately after an incomplete chatter or a plastic impact, one at the
//! start or at a jump of the drive, and one under a ramp, chirp, noise or record (without a common period, or
//! none so far). On compliant stops there is no rest and so no release.

use crate::dynamics::clock::Instant;
use crate::dynamics::drive::Drive;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::laps::Totals;
use crate::dynamics::record::log::{CycleShift, Log};
use crate::dynamics::result::ReleaseIdentity;
use crate::dynamics::state::Label;
use crate::dynamics::step::work::REPLAYED;
use crate::numeric::Scalar;

/// Common periods of the drive after which a motion that has not repeated is no longer logged: most cycles
/// take one or two, and a motion that never rests again would be logged to its end.
const MAX_LOGGED_PERIODS: i64 = 8;

/// Totals before and after a lap that lies entirely inside or entirely outside the settled window.
#[derive(Debug, Clone, Copy)]
struct LapTotals<T> {
    inside: bool,
    before: Totals<T>,
    after: Totals<T>,
}

/// One cycle of the motion.
#[derive(Debug, Clone, Copy)]
struct Lap<T> {
    /// The mark in the log at which it begins.
    first: usize,
    /// Cycles of the clock that it takes.
    cycles: i64,
    lap_totals: Option<LapTotals<T>>,
}

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// Handles a release of the mass with this label: completes the run if an earlier release had the same
    /// label. In a pursuit, the release is reported to the goal instead.
    pub fn handle_release(&mut self, label: Label<T>) {
        let Label { end, turn, phase } = label;
        let identity = ReleaseIdentity { side: end.side(), cycle: turn, phase: phase.to_f64() };
        if self.record.released(&self.state.at, identity) {
            return;
        }
        let Some(log) = self.log.take().filter(|log| log.has_room()) else {
            self.log_release(Box::new(Log::new()), label);
            return;
        };
        if let Some((first, before)) = log.find(|known| *known == label) {
            let cycles = self.state.at.cycle - log.at(first).cycle;
            let lap_totals = self.lap_totals(first, &log, before);
            self.complete(&log, Lap { first, cycles, lap_totals });
            self.record.classifier.end_observations();
        } else if let Some((first, before)) = log.find(|known| known.end == label.end.other())
            && self.stepper.drive.is_odd()
            && self.symmetric
            && let Some(cycles) = self.record.odd_half_cycles(&log.at(first), &self.state.at)
        {
            self.complete_mirrored(log, first, cycles, before);
            self.record.classifier.end_observations();
        } else {
            self.log_release(log, label);
        }
    }

    fn log_release(&mut self, mut log: Box<Log<T>>, label: Label<T>) {
        if log.marks() == 0 {
            self.record.classifier.begin_observations();
        }
        log.label(label, self.record.totals());
        self.log = Some(log);
    }

    /// Adds a checkpoint to the log, if there is one.
    #[inline]
    pub fn mark(&mut self) {
        if self.log.is_some() {
            let point = self.checkpoint();
            let max_cycles = MAX_LOGGED_PERIODS.saturating_mul(self.stepper.drive.common_cycles());
            if let Some(log) = &mut self.log {
                if log.cycles_until(&point.state.at) > max_cycles || !log.has_room() {
                    self.log = None; // the next release begins another
                    self.record.classifier.end_observations();
                } else {
                    log.mark(point);
                }
            }
        }
    }

    /// The totals of the lap since mark `first`, if it lies entirely inside or outside the settled window.
    fn lap_totals(&self, first: usize, log: &Log<T>, before: Totals<T>) -> Option<LapTotals<T>> {
        let inside = self.record.lies_inside(&log.at(first), &self.state.at)?;
        Some(LapTotals { inside, before, after: self.record.totals() })
    }

    /// Completes the run from the half lap since mark `first` and its mirror image, which make a lap.
    fn complete_mirrored(&mut self, mut log: Box<Log<T>>, first: usize, cycles: i64, before: Totals<T>) {
        let (at, middle) = (log.at(first), log.marks());
        let back = Instant { cycle: at.cycle + cycles, phase: at.phase };
        self.recurs = false;
        if !(self.stepper.clock.between(&back, &self.stepper.end) > T::zero()) {
            return;
        }
        log.append_mirrored(first, cycles / 2, self.stepper.equation.modes.len(), &self.stepper.clock);
        self.replay(&log, (middle, None), CycleShift(0));
        self.resume(&log.point_later(first, CycleShift(cycles)));
        let lap_totals = self.lap_totals(first, &log, before);
        self.complete(&log, Lap { first, cycles, lap_totals });
    }

    /// Completes the run from the end of a lap.
    fn complete(&mut self, log: &Log<T>, mut lap: Lap<T>) {
        self.recurs = false;
        let mut later = 0;
        loop {
            let next = Instant { cycle: self.state.at.cycle + lap.cycles, phase: self.state.at.phase };
            if !(self.stepper.clock.between(&next, &self.stepper.end) > T::zero()) {
                break;
            }
            if self.stepper.work.is_cancelled() || !self.stepper.work.has_room_for(0) {
                return; // the rest of the run is integrated
            }
            if let Some(lap_totals) = lap.lap_totals {
                let (at, end) = (&self.state.at, &self.stepper.end);
                let ahead = self.record.laps_on_this_side(at, end, lap.cycles, lap_totals.inside);
                if ahead > 0 {
                    let laps = self.replay_listed(log, &lap, later, ahead);
                    self.record.repeat(&lap_totals.before, &lap_totals.after, laps, lap.cycles);
                    later += laps * lap.cycles;
                    self.state.at.cycle += laps * lap.cycles;
                    continue;
                }
            }
            let before = self.record.totals();
            later += lap.cycles;
            self.replay(log, (lap.first, None), CycleShift(later));
            let inside = self.record.lies_inside(&self.state.at, &next);
            let after = self.record.totals();
            lap.lap_totals = inside.map(|inside| LapTotals { inside, before, after });
            self.state.at = next;
        }
        let rest = CycleShift(later + lap.cycles);
        let last = log.last_before(lap.first, rest, &self.stepper.end, &self.stepper.clock);
        self.replay(log, (lap.first, Some(last)), rest);
        self.resume(&log.point_later(last, rest));
    }

    /// Replays those of the next `laps` in which something is listed. The sums are restored afterwards, so
    /// that they do not depend on what is listed. Replays count as work; returns the number of laps that the
    /// budget allows.
    fn replay_listed(&mut self, log: &Log<T>, lap: &Lap<T>, later: i64, laps: i64) -> i64 {
        let (sums, classifier) = (self.record.totals(), self.record.classifier.clone());
        // The stroboscopic states of these laps are added by multiplication.
        self.record.next_strobe = None;
        let listings = std::mem::take(&mut self.record.listings);
        let start = self.state.at;
        let length = self.stepper.clock.period * T::of(lap.cycles as f64);
        let begin =
            |lap_before: i64| Instant { cycle: start.cycle + lap_before * lap.cycles, phase: start.phase };
        let (mut done, mut covered) = (0, laps);
        while let Some(next) = self.record.next_listed(&begin(done)) {
            // by rounding it may lie in the previous lap
            let between = (self.stepper.clock.between(&start, &next) / length).floor().to_f64() as i64 - 1;
            let number = between.max(done) + 1;
            if number > laps {
                break;
            }
            if self.stepper.work.is_cancelled() || !self.stepper.work.has_room_for(0) {
                covered = done;
                break;
            }
            if self.stepper.clock.between(&next, &begin(number)) >= T::zero() {
                let impacts = self.replay(log, (lap.first, None), CycleShift(later + number * lap.cycles));
                self.stepper.work.impacts += impacts;
            }
            done = number;
        }
        self.record.restore(&sums);
        (self.record.classifier, self.record.listings) = (classifier, listings);
        covered
    }

    /// Replays a part of the log. Returns the number of impacts in it.
    fn replay(&mut self, log: &Log<T>, marks: (usize, Option<usize>), later: CycleShift) -> u64 {
        let recorded = (&mut self.record, &mut self.stepper.series);
        let (calls, impacts) = log.replay(recorded, marks, later, self.state.segment);
        self.stepper.work.add(REPLAYED * calls as u64);
        impacts
    }
}
