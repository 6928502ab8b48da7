//! The first surface that a step of free flight runs into.

use super::chord::Chord;
use super::path::Path;
use super::stepper::Stepper;
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::End;
use crate::dynamics::series::{Endpoint, polynomial};
use crate::dynamics::state::{BY_SPEED, HELD, MotionState};
use crate::numeric::{PolynomialRoots, Scalar};

impl<T: Scalar, D: Drive<T>> Stepper<'_, T, D> {
    /// The first contact with an end of the mode within the step, as a share of it; of the step's end is
    /// known how it lies in the piece.
    #[inline(always)]
    pub fn find_exit(
        &self,
        state: &MotionState<T>,
        h: T,
        &Endpoint { y: end, bound, .. }: &Endpoint<T>,
    ) -> Option<(T, End)> {
        let zero = T::zero();
        let mode = self.mode(state);
        let n = self.series.known;
        let mut first: Option<(T, End)> = None;
        if state.touch.is_none() {
            let limits = (mode.low, mode.high);
            let near = !(state.x - limits.0 > bound && limits.1 - state.x > bound);
            if !near {
                return None;
            }
            let (y, to) = (&self.series.y[..n], end + mode.origin);
            let deviations = polynomial::chord_deviations(y, h);
            let chord = Chord { start: state.x, end: to, bound, deviations, ways: (zero, zero), limits };
            if chord.is_clear() == (true, true) {
                return None;
            }
        }
        for end in [End::Low, End::High] {
            let sign = end.sign::<T>();
            let gap = sign * (mode.end(end).0 - state.x);
            let touch = state.touch.filter(|t| t.end == end);
            if touch.map_or(gap > bound, |touch| touch.multiplicity == HELD) {
                continue;
            }
            let mut g = self.series.scaled(h);
            if end == End::High {
                g[1..n].iter_mut().for_each(|c| *c = -*c);
            }
            g[0] = gap;
            // Beyond the surface only by rounding, after it was held, and not on the way out: it is touched.
            let returns = touch.is_none() && gap < zero && sign * state.v <= zero;
            let mut from = if returns { BY_SPEED } else { touch.map_or(0, |t| t.multiplicity.min(n - 1)) };
            // A coefficient that is exactly 0 decides nothing.
            while from + 1 < n && g[from] == zero {
                from += 1;
            }
            let g = &g[from..n];
            let s = if g[0] > zero {
                PolynomialRoots::new(g).first()
            } else if g[0] < zero {
                Some(zero) // outward at once
            } else {
                None // it stays where it is
            };
            if let Some(s) = s
                && first.is_none_or(|f| s < f.0)
            {
                first = Some((s, end));
            }
        }
        first
    }
}
