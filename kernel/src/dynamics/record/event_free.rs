//! Recording of event-free steps.

use super::recorder::Recorder;
use crate::dynamics::clock::Instant;
use crate::numeric::{CompensatedSum, GaussLegendre, Scalar};

/// Share of the clock's cycle by which an event-free step must end before a border: more than rounding.
pub(crate) const MARGIN: f64 = 1e-9;

/// The part of a record that event-free steps change, and the instant up to which they may be taken.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EventFree<T> {
    /// The end of the run, a border of the settled window or a strobe, whichever comes first.
    pub border: Instant<T>,
    /// Whether the time up to `border` is in the settled window.
    pub inside: bool,
    /// Whether the instant of every crossing is needed.
    pub listed: bool,
    pub barrier: Option<T>,
    pub side: i8,
    pub low: T,
    pub high: T,
    pub squared: CompensatedSum<T>,
    pub covered: CompensatedSum<T>,
}

impl<T: Scalar> Recorder<'_, T> {
    /// Begins a sequence of event-free steps at `at`, which ends at `end` at the latest.
    pub fn begin_event_free(&self, at: &Instant<T>, end: &Instant<T>) -> EventFree<T> {
        let until = |border: &Instant<T>| self.clock.between(at, border);
        let (from, to) = (&self.window.0, &self.window.1);
        let mut border = *end;
        let ahead = [from, to].into_iter().filter(|border| until(border) > T::zero());
        for next in ahead.copied().chain(self.next_strobe).chain(self.listings.due()) {
            if until(&next) < until(&border) {
                border = next;
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

    /// Ends the sequence: takes over what its steps have changed, the side of the barrier after them and the
    /// number of crossings, all of them outside the settled window.
    pub fn end_event_free(
        &mut self,
        (low, high): (T, T),
        squared: CompensatedSum<T>,
        covered: CompensatedSum<T>,
        side: i8,
        crossings: u64,
    ) {
        (self.low, self.high) = (low, high);
        self.settled.squared_velocity = squared;
        self.covered = covered;
        self.barrier_side = side;
        self.counts.total_crossings += crossings;
    }

    /// Quadrature rule for integrals over a full step.
    pub fn rule_of_steps(&self) -> &'static GaussLegendre<T> {
        T::gauss_legendre(self.order / 2 + 1)
    }
}
