//! What of a record changes on event-free steps.

use super::recorder::Recorder;
use crate::dynamics::clock::Instant;
use crate::numeric::{CompensatedSum, GaussLegendre, Scalar};

/// Share of the clock's cycle that a step on which nothing happens stays before the next border: more than rounding can
/// hide.
pub(crate) const MARGIN: f64 = 1e-9;

/// What changes in a record while nothing happens, and up to when that may go on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EventFree<T> {
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

impl<T: Scalar, const LEDGER: bool> Recorder<'_, T, LEDGER> {
    /// Whether it need not be told of steps on which nothing happens: no samples are taken.
    #[inline]
    pub fn is_quiet(&self) -> bool {
        self.next_time >= self.times.len()
    }

    /// What it is to be told of steps after `at` on which nothing happens, up to `end`.
    pub fn begin_event_free(&self, at: &Instant<T>, end: &Instant<T>) -> EventFree<T> {
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
        EventFree {
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
    pub fn end_event_free(
        &mut self,
        (low, high): (T, T),
        squared: CompensatedSum<T>,
        covered: CompensatedSum<T>,
    ) {
        (self.low, self.high) = (low, high);
        self.settled.squared_velocity = squared;
        self.covered = covered;
    }

    /// The same of passages of the top before the settled window, and on which side they have led.
    pub fn end_event_free_crossings(&mut self, side: i8, count: u64) {
        self.barrier_side = side;
        self.counts.total_crossings += count;
    }

    /// What integrals over a step are taken with.
    pub fn rule_of_steps(&self) -> &'static GaussLegendre<T> {
        T::gauss_legendre(self.order / 2 + 1)
    }
}
