//! What does a record make of a step on which nothing happens? Most steps are such.

use super::clock::Instant;
use super::record::{Recorder, side_of};
use crate::numeric::{GaussLegendre, Scalar};

/// A step of free flight that may be one on which nothing happens.
pub(super) struct Glide<T> {
    pub at: Instant<T>,
    pub length: T,
    /// Displacement at its start and at its end.
    pub start: T,
    pub end: T,
    /// Bound of |x - x(start)|.
    pub bound: T,
    /// Ends of the arena.
    pub limits: (T, T),
    /// As [`Recorder::wholly_inside`] says.
    pub inside: Option<bool>,
    /// Integral of the squared velocity over it, where that is asked for.
    pub squared: T,
}

impl<T: Scalar> Recorder<'_, T, false> {
    /// Whether a step lies wholly inside the settled window, or wholly outside; none where it does neither.
    #[inline(always)]
    pub fn wholly_inside(&self, at: &Instant<T>, length: T) -> Option<bool> {
        match self.overlap(at, length) {
            None => Some(false),
            Some((from, to)) => (from == T::zero() && to == length).then_some(true),
        }
    }

    /// Takes in a step on which nothing happens, as [`step`](Self::step) would; false where something may, and nothing
    /// has been taken in.
    #[inline(always)]
    pub fn glide(&mut self, step: &Glide<T>) -> bool {
        let Some(inside) = step.inside else { return false };
        if self.log.is_some() || self.next_time < self.times.len() {
            return false;
        }
        if let Some(barrier) = self.barrier
            && (side_of(step.end, barrier) != self.barrier_side
                || !((step.start - barrier).abs() > step.bound))
        {
            return false;
        }
        if let Some(strobe) = &self.next_strobe
            && self.clock.between(&step.at, strobe) < step.length
        {
            return false;
        }
        if inside {
            let within = step.start.larger(step.limits.0).smaller(step.limits.1);
            let low = self.low.smaller(within).smaller(step.end);
            let high = self.high.larger(within).larger(step.end);
            let highest = (step.start + step.bound).smaller(step.limits.1);
            let lowest = (step.start - step.bound).larger(step.limits.0);
            if highest > high || lowest < low {
                return false; // a turning point inside may lie beyond both ends
            }
            (self.low, self.high) = (low, high);
            self.settled.squared_velocity.add(step.squared);
            self.covered.add(step.length);
        }
        true
    }

    /// What integrals over a step are taken with.
    pub fn rule_of_steps(&self) -> GaussLegendre<T> {
        GaussLegendre::new(self.order / 2 + 1)
    }
}
