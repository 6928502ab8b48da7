//! What does a record make of steps on which nothing happens? Most steps are such.

use super::clock::Instant;
use super::record::Recorder;
use crate::numeric::{CompensatedSum, GaussLegendre, Scalar};

/// Share of the clock's cycle that a step on which nothing happens stays before the next border: more than rounding can
/// hide.
pub(super) const MARGIN: f64 = 1e-9;

/// How much further than a bound asks a step must stay away from a surface that it is clear of: rounding never decides it.
pub(super) const ROOM_BESIDE: f64 = 1.0625;

/// What changes in a record while nothing happens, and up to when that may go on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gliding<T> {
    /// The end of the run, a border of the settled window or a strobe, whichever comes first.
    pub border: Instant<T>,
    /// Whether the time up to there is in the settled window.
    pub inside: bool,
    /// Whether the instant of every crossing matters.
    pub listed: bool,
    /// The top that crossings are counted at, and the side of it.
    pub barrier: Option<T>,
    pub side: i8,
    pub low: T,
    pub high: T,
    pub squared: CompensatedSum<T>,
    pub covered: CompensatedSum<T>,
}

/// Where a step of free flight goes.
pub(super) struct Glide<T> {
    /// Displacement at its start and at its end.
    pub start: T,
    pub end: T,
    /// Bound of |x - x(start)|.
    pub bound: T,
    /// Bound of how far it leaves the chord between its ends, as [`taylor::bend`](super::taylor::bend) gives it.
    pub bend: T,
    /// Ends of the arena.
    pub limits: (T, T),
}

impl<T: Scalar> Glide<T> {
    /// Whether the step stays clear of the low and of the high end of the arena, as far as its chord can tell.
    #[inline(always)]
    pub fn is_clear(&self) -> (bool, bool) {
        let bend = self.bend * T::of(ROOM_BESIDE);
        let low = self.start.smaller(self.end) - bend > self.limits.0;
        let high = self.start.larger(self.end) + bend < self.limits.1;
        (low, high)
    }

    /// The extremes with the ends of the step, and whether a turning point inside it may lie beyond them.
    #[inline(always)]
    pub fn extremes(&self, (low, high): (T, T)) -> (T, T, bool) {
        let start = self.start.larger(self.limits.0).smaller(self.limits.1);
        let (lower, higher) = (start.smaller(self.end), start.larger(self.end));
        let (low, high) = (low.smaller(lower), high.larger(higher));
        let highest = (self.start + self.bound).smaller(self.limits.1).smaller(higher + self.bend);
        let lowest = (self.start - self.bound).larger(self.limits.0).larger(lower - self.bend);
        (low, high, (highest > high) | (lowest < low))
    }
}

impl<T: Scalar, const LEDGER: bool> Recorder<'_, T, LEDGER> {
    /// Whether it need not be told of steps on which nothing happens: no samples are taken, and no steps are kept.
    #[inline]
    pub fn is_quiet(&self) -> bool {
        self.next_time >= self.times.len() && self.log.is_none()
    }

    /// What it is to be told of steps after `at` on which nothing happens, up to `end`.
    pub fn glide(&self, at: &Instant<T>, end: &Instant<T>) -> Gliding<T> {
        let until = |border: &Instant<T>| self.clock.between(at, border);
        let (from, to) = (&self.window.0, &self.window.1);
        let mut border = *end;
        let ahead = [from, to].into_iter().filter(|border| until(border) > T::zero());
        for own in ahead.chain(&self.next_strobe) {
            if until(own) < until(&border) {
                border = *own;
            }
        }
        let inside = until(from) <= T::zero() && until(to) > T::zero();
        Gliding {
            border,
            inside,
            listed: self.lists_crossings(),
            barrier: self.barrier,
            side: self.barrier_side,
            low: self.low,
            high: self.high,
            squared: self.settled.squared_velocity,
            covered: self.covered,
        }
    }

    /// Takes in what such steps have changed.
    pub fn end_glide(&mut self, (low, high): (T, T), squared: CompensatedSum<T>, covered: CompensatedSum<T>) {
        (self.low, self.high) = (low, high);
        self.settled.squared_velocity = squared;
        self.covered = covered;
    }

    /// The same of passages of the top before the settled window, and on which side they have led.
    pub fn end_glide_crossings(&mut self, side: i8, count: u64) {
        self.barrier_side = side;
        self.counts.total_crossings += count;
    }

    /// What integrals over a step are taken with.
    pub fn rule_of_steps(&self) -> &'static GaussLegendre<T> {
        T::gauss_legendre(self.order / 2 + 1)
    }
}
