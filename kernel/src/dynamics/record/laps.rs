//! Laps of a recurrent motion, added to sums and counts by multiplication.

use super::listing::Listed;
use super::recorder::Recorder;
use super::sums::{Counts, Sums};
use crate::dynamics::clock::Instant;
use crate::numeric::{CompensatedSum, Scalar};

/// Share of the clock's cycle by which a time interval must be clear of a border.
const CLEAR: f64 = 1e-9;

/// The sums and counts of a recorder at an instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Totals<T> {
    whole: Sums<T>,
    settled: Sums<T>,
    covered: CompensatedSum<T>,
    work_moved: f64,
    counts: Counts,
    /// Number of observations that the classifier has kept.
    observed: usize,
    next_strobe: Option<Instant<T>>,
    listed: Listed<T>,
}

impl<T: Scalar> Recorder<'_, T> {
    pub fn totals(&self) -> Totals<T> {
        Totals {
            whole: self.whole,
            settled: self.settled,
            covered: self.covered,
            work_moved: self.work_moved,
            counts: self.counts,
            observed: self.classifier.observed(),
            next_strobe: self.next_strobe,
            listed: self.listings.listed(),
        }
    }

    /// Whether the time from `start` to `end` lies entirely inside the settled window (true) or entirely
    /// outside it (false); `None` if it does neither, or ends within rounding of a border.
    pub fn lies_inside(&self, start: &Instant<T>, end: &Instant<T>) -> Option<bool> {
        let clear = self.clock.period * T::of(CLEAR);
        let (from, to) = &self.window;
        let between = |a: &Instant<T>, b: &Instant<T>| self.clock.between(a, b);
        if between(from, start) >= T::zero() && between(end, to) > clear {
            Some(true)
        } else if between(end, from) > clear || between(to, start) > clear {
            Some(false)
        } else {
            None
        }
    }

    /// The number of half cycles of the clock between two instants, if it is an odd whole number.
    pub fn odd_half_cycles(&self, from: &Instant<T>, to: &Instant<T>) -> Option<i64> {
        let halves = self.clock.between(from, to) / (self.clock.period * T::of(0.5));
        let whole = (halves + T::of(0.5)).floor();
        let count = whole.to_f64() as i64;
        ((halves - whole).abs() <= T::of(CLEAR) && count % 2 == 1).then_some(count)
    }

    /// Number of whole laps of `cycles` cycles of the clock between `at` and `end` that lie on the same side
    /// of the window's borders as the last lap, which lay `inside` the window or not.
    pub fn laps_on_this_side(&self, at: &Instant<T>, end: &Instant<T>, cycles: i64, inside: bool) -> i64 {
        let (from, to) = self.window;
        let border =
            if inside { Some(to) } else { Some(from).filter(|w| self.clock.between(at, w) > T::zero()) };
        let until = border.filter(|border| self.clock.between(border, end) > T::zero()).unwrap_or(*end);
        let clear = self.clock.period * T::of(CLEAR);
        let length = self.clock.period * T::of(cycles as f64);
        let laps = ((self.clock.between(at, &until) - clear) / length).floor();
        laps.larger(T::zero()).to_f64() as i64
    }

    /// The first instant, at `at` or later, at which something is listed; `None` if nothing is.
    pub fn next_listed(&self, at: &Instant<T>) -> Option<Instant<T>> {
        let sample = self.times.get(self.next_time).map(|t| self.clock.at(*t));
        if self.events.is_some() { Some(*at) } else { sample }
    }

    /// Restores sums and counts to earlier values; events and samples listed since then are kept.
    pub fn restore(&mut self, totals: &Totals<T>) {
        self.whole = totals.whole;
        self.settled = totals.settled;
        self.covered = totals.covered;
        self.work_moved = totals.work_moved;
        self.counts = totals.counts;
        self.next_strobe = totals.next_strobe;
    }

    /// Adds `laps` more laps of `cycles` cycles of the clock, each like the one from `before` to `after`, the
    /// present. All lie inside the window, or all outside.
    pub fn repeat(&mut self, before: &Totals<T>, after: &Totals<T>, laps: i64, cycles: i64) {
        let times = T::of(laps as f64);
        let more = |sum: &mut CompensatedSum<T>, before: &CompensatedSum<T>, after: &CompensatedSum<T>| {
            sum.add((after.value() - before.value()) * times);
        };
        self.whole.each(&before.whole, &after.whole, more);
        self.settled.each(&before.settled, &after.settled, more);
        more(&mut self.covered, &before.covered, &after.covered);
        self.work_moved += (after.work_moved - before.work_moved) * laps as f64;
        self.counts.repeat(&before.counts, &after.counts, laps as u64);
        let periods = cycles / self.period_cycles.max(1);
        let squared =
            (after.settled.squared_velocity.value() - before.settled.squared_velocity.value()).to_f64();
        let gained = (squared, after.counts.crossings - before.counts.crossings);
        self.classifier.repeat((before.observed, after.observed), laps as u64, periods as u64, gained);
        if let Some(strobe) = &mut self.next_strobe {
            strobe.cycle += laps * cycles;
        }
        self.listings.repeat(&before.listed, &after.listed, laps, cycles);
    }
}
