//! Recurrence: a run whose motion has come back to an earlier state is completed without integration.
//!
//! A mass that is released from rest under a drive that repeats starts from a state that is known without
//! comparing computed numbers: it is on the stop, has no speed, and the drive is where it is at that release
//! root. So a release has a *label*: the stop, and the root within the drive's common period. Two releases
//! with equal labels are followed by the same motion, bit for bit, one some cycles of the clock later: the
//! integrator would do the same arithmetic again. (Where curve, stops and drive are symmetric, a release from
//! the other stop half a period later is followed by the mirror image, to rounding.)
//!
//! From the first labelled release on, every recorder call is kept in a log. Once a label comes back, the
//! calls of that lap are replayed, lap by lap, which gives samples, events, windows that open or close within
//! a lap, stroboscopic states and sums by the same code. Laps that lie wholly inside or wholly outside the
//! settled window are added to sums and counts by multiplication, and replayed only where something in them
//! is listed. The last, incomplete lap is replayed up to its last step, which is integrated.
//!
//! No labels: a release at once after an incomplete chatter or a plastic impact, one at the start or at a
//! jump of the drive, one under a ramp, chirp, noise or record (no common period, or not yet), and compliant
//! stops, on which nothing rests.

use crate::dynamics::clock::Instant;
use crate::dynamics::drive::Drive;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::laps::Totals;
use crate::dynamics::record::log::{CycleShift, Log};
use crate::dynamics::result::ReleaseIdentity;
use crate::dynamics::state::Label;
use crate::dynamics::step::work::TOLD;
use crate::numeric::Scalar;

/// Share of the clock's cycle by which a lap must keep clear of what would set it apart: more than rounding
/// can hide.
const CLEAR: f64 = 1e-9;

/// Common periods of the drive after which a motion that has not come back is no longer kept: most cycles
/// take one or two, and a motion that never rests again would be kept to its end.
const PATIENCE: i64 = 8;

/// A run of laps that are alike for the recorder, and what one of them adds.
#[derive(Debug, Clone, Copy)]
struct Like<T> {
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
    like: Option<Like<T>>,
}

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// The mass has just been released with this label: completes the run where a release had the same label
    /// before. Where it is pursued, it has arrived.
    pub fn let_go(&mut self, label: Label<T>) {
        let Label { end, turn, phase } = label;
        let identity = ReleaseIdentity { side: end.side(), cycle: turn, phase: phase.to_f64() };
        if self.record.released(&self.state.at, identity) {
            return;
        }
        let Some(log) = self.log.take().filter(|log| log.has_room()) else {
            self.keep_from(Box::new(Log::new()), label);
            return;
        };
        if let Some((first, before)) = log.find(|known| *known == label) {
            let cycles = self.state.at.cycle - log.at(first).cycle;
            let like = self.like(first, &log, before);
            self.complete(&log, Lap { first, cycles, like });
            self.record.judge.end_tape();
        } else if let Some((first, before)) = log.find(|known| known.end == label.end.other())
            && self.stepper.drive.is_odd()
            && self.symmetric
            && let Some(cycles) = self.half_cycles_since(&log.at(first))
        {
            self.complete_mirrored(log, first, cycles, before);
            self.record.judge.end_tape();
        } else {
            self.keep_from(log, label);
        }
    }

    fn keep_from(&mut self, mut log: Box<Log<T>>, label: Label<T>) {
        if log.marks() == 0 {
            self.record.judge.begin_tape();
        }
        log.label(label, self.record.totals());
        self.log = Some(log);
    }

    /// Adds a checkpoint to the log, where there is one.
    #[inline]
    pub fn mark(&mut self) {
        if self.log.is_some() {
            let point = self.checkpoint();
            let patience = PATIENCE.saturating_mul(self.stepper.drive.common_cycles());
            if let Some(log) = &mut self.log {
                if log.cycles_until(&point.state.at) > patience || !log.has_room() {
                    self.log = None; // the next release begins another
                    self.record.judge.end_tape();
                } else {
                    log.mark(point);
                }
            }
        }
    }

    /// The odd number of half cycles of the clock since `at`, where it is one.
    fn half_cycles_since(&self, at: &Instant<T>) -> Option<i64> {
        let halves =
            self.stepper.clock.between(at, &self.state.at) / (self.stepper.clock.period() * T::of(0.5));
        let whole = (halves + T::of(0.5)).floor();
        let close = (halves - whole).abs() <= T::of(CLEAR);
        let count = whole.to_f64() as i64;
        (close && count % 2 == 1).then_some(count)
    }

    /// What the lap since mark `first` has added, where it lay wholly inside or outside the settled window.
    fn like(&self, first: usize, log: &Log<T>, before: Totals<T>) -> Option<Like<T>> {
        let inside = self.record.lies_inside(&log.at(first), &self.state.at)?;
        Some(Like { inside, before, after: self.record.totals() })
    }

    /// The half lap since mark `first` and its mirror image make a lap.
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
        let like = self.like(first, &log, before);
        self.complete(&log, Lap { first, cycles, like });
    }

    /// Completes the run from here, where a lap has just ended.
    fn complete(&mut self, log: &Log<T>, mut lap: Lap<T>) {
        self.recurs = false;
        let mut later = 0;
        loop {
            let next = Instant { cycle: self.state.at.cycle + lap.cycles, phase: self.state.at.phase };
            if !(self.stepper.clock.between(&next, &self.stepper.end) > T::zero()) {
                break;
            }
            if self.stepper.work.is_cancelled() || self.stepper.work.is_spent() {
                return; // as it stands it goes on
            }
            if let Some(like) = lap.like {
                let alike = self.laps_alike(&lap, like.inside);
                if alike > 0 {
                    let laps = self.list(log, &lap, later, alike);
                    self.record.repeat(&like.before, &like.after, laps, lap.cycles);
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
            lap.like = inside.map(|inside| Like { inside, before, after });
            self.state.at = next;
        }
        let rest = CycleShift(later + lap.cycles);
        let last = log.last_before(lap.first, rest, &self.stepper.end, &self.stepper.clock);
        self.replay(log, (lap.first, Some(last)), rest);
        self.resume(&log.point_later(last, rest));
    }

    /// Replays those of the next `laps` in which something is listed; the sums stay, so that they do not
    /// depend on what is listed. A replay is work: the number of laps for which it was done.
    fn list(&mut self, log: &Log<T>, lap: &Lap<T>, later: i64, laps: i64) -> i64 {
        let (sums, judge) = (self.record.totals(), self.record.judge.clone());
        // The stroboscopic states are those of the lap.
        self.record.next_strobe = None;
        let listings = std::mem::take(&mut self.record.listings);
        let start = self.state.at;
        let length = self.stepper.clock.period() * T::of(lap.cycles as f64);
        let begin =
            |lap_before: i64| Instant { cycle: start.cycle + lap_before * lap.cycles, phase: start.phase };
        let mut told = 0;
        while let Some(next) = self.record.next_listed(&begin(told)) {
            // (by rounding it may lie in the lap before)
            let between = (self.stepper.clock.between(&start, &next) / length).floor().to_f64() as i64 - 1;
            let number = between.max(told) + 1;
            if number > laps {
                break;
            }
            if self.stepper.work.is_cancelled() || self.stepper.work.is_spent() {
                self.record.restore(&sums);
                (self.record.judge, self.record.listings) = (judge, listings);
                return told;
            }
            if self.stepper.clock.between(&next, &begin(number)) >= T::zero() {
                let impacts = self.replay(log, (lap.first, None), CycleShift(later + number * lap.cycles));
                self.stepper.work.add_impacts(impacts);
            }
            told = number;
        }
        self.record.restore(&sums);
        (self.record.judge, self.record.listings) = (judge, listings);
        laps
    }

    /// Replays a part of the log; the number of impacts in it.
    fn replay(&mut self, log: &Log<T>, marks: (usize, Option<usize>), later: CycleShift) -> u64 {
        let recorded = (&mut self.record, &mut self.stepper.series);
        let (calls, impacts) = log.play(recorded, marks, later, self.state.segment);
        self.stepper.work.add(TOLD * calls as u64);
        impacts
    }

    /// Laps from here on that are wholly inside (or outside) the settled window, as the last one was.
    fn laps_alike(&self, lap: &Lap<T>, inside: bool) -> i64 {
        let clear = self.stepper.clock.period() * T::of(CLEAR);
        let length = self.stepper.clock.period() * T::of(lap.cycles as f64);
        let until = self.record.same_side_until(&self.state.at, &self.stepper.end, inside);
        let laps = ((self.stepper.clock.between(&self.state.at, &until) - clear) / length).floor();
        laps.larger(T::zero()).to_f64() as i64
    }
}
