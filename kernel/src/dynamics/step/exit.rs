//! First surface that a step of free flight meets.

use super::chord::Chord;
use super::stepper::Stepper;
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::End;
use crate::dynamics::series::{Endpoint, polynomial};
use crate::dynamics::state::{MotionState, Opening, Touch};
use crate::numeric::{PolynomialRoots, Scalar, single_root};

impl<T: Scalar, D: Drive<T>> Stepper<'_, T, D> {
    /// The end of the mode that a step of length `h` meets, with its time and velocity, in the two cases in
    /// which there is only one such contact: the end ahead, if the velocity keeps its sign, or the end just
    /// left, if the acceleration does. In the second case the end ahead may be met before. A batch does the
    /// same arithmetic (`lanes/columns/landing.rs`).
    #[inline(always)]
    fn plain_exit(&self, state: &MotionState<T>, h: T, end: &Endpoint<T>) -> Option<(T, T, End)> {
        let mode = self.mode(state);
        let to = end.y + mode.origin;
        let past = |exit: End| exit.sign::<T>() * (to - mode.end(exit).0) > T::zero();
        let ahead = if state.v > T::zero() { End::High } else { End::Low };
        let exit = match state.touch {
            Some(Touch { opening: Opening::Speed, end }) if past(end) => end,
            None | Some(Touch { opening: Opening::Speed, .. }) => ahead,
            Some(_) => return None,
        };
        let (sign, level) = (exit.sign::<T>(), mode.end(exit).0);
        let from = state.x - level;
        let (returns, starts_inside) = (exit != ahead, sign * from < T::zero());
        if !(past(exit) && (returns || starts_inside)) {
            return None;
        }
        let y = self.series.coefficients();
        let (v, last, to) = (state.v * h, end.v * h, to - level);
        let mut g = polynomial::scaled(y, h);
        let (g, ends) = if returns {
            // the gap divided by the time since the start
            (&g[1..=y.len()], ((v, g[2]), (to, last - to)))
        } else {
            g[0] = from;
            (&g[..y.len()], ((from, v), (to, last)))
        };
        let pair = |(value, slope): (T, T)| (value.to_f64(), slope.to_f64());
        let guess = T::of(single_root::guess(pair(ends.0), pair(ends.1)));
        let length = single_root::single_root(g, guess)? * h;
        let v = polynomial::slope(y, length);
        let chord = Chord::new(y, (state.x, level), (length, v), end.bound, (mode.low, mode.high));
        let alone = if returns { chord.bends_one_way() } else { chord.is_monotone() };
        (alone && sign * v > T::zero()).then_some((length, v, exit))
    }

    /// The first contact with an end of the mode within a step of length `h`: its time, its velocity and the
    /// end of the mode. `end` is the end of the step.
    #[inline(always)]
    pub fn find_exit(&self, state: &MotionState<T>, h: T, end: &Endpoint<T>) -> Option<(T, T, End)> {
        let y = self.series.coefficients();
        let at = |(share, exit): (T, End)| {
            let length = share * h;
            (length, polynomial::slope(y, length), exit)
        };
        let Some(plain) = self.plain_exit(state, h, end) else {
            return self.first_exit(state, h, end).map(at);
        };
        let (other, bound) = (plain.2.other(), end.bound);
        if state.touch.is_some_and(|touch| touch.end == plain.2)
            && let Some(share) = self.contact(state, h, other, bound)
            && share * h < plain.0
        {
            return Some(at((share, other)));
        }
        Some(plain)
    }

    /// The first contact with either end, as a fraction of the step.
    #[inline(always)]
    fn first_exit(
        &self,
        state: &MotionState<T>,
        h: T,
        &Endpoint { y: end, v, acceleration, bound }: &Endpoint<T>,
    ) -> Option<(T, End)> {
        let mode = self.mode(state);
        let mut first: Option<(T, End)> = None;
        if state.touch.is_none() {
            let limits = (mode.low, mode.high);
            if state.x - limits.0 > bound && limits.1 - state.x > bound {
                return None;
            }
            let (y, to) = (self.series.coefficients(), end + mode.origin);
            let deviations = polynomial::chord_deviations(y, h);
            let square = h * h;
            let (slopes, curvatures) =
                ((state.v * h, v * h), ((y[2] + y[2]) * square, acceleration * square));
            let chord = Chord { start: state.x, end: to, bound, deviations, slopes, curvatures, limits };
            if chord.stays_clear() {
                return None;
            }
        }
        for end in [End::Low, End::High] {
            if let Some(s) = self.contact(state, h, end, bound)
                && first.is_none_or(|f| s < f.0)
            {
                first = Some((s, end));
            }
        }
        first
    }

    /// The first contact with this end, as a fraction of a step that leads no further than `bound`.
    #[inline(always)]
    fn contact(&self, state: &MotionState<T>, h: T, end: End, bound: T) -> Option<T> {
        let (zero, sign, n) = (T::zero(), end.sign::<T>(), self.series.known);
        let gap = sign * (self.mode(state).end(end).0 - state.x);
        let touch = state.touch.filter(|t| t.end == end);
        if touch.map_or(gap > bound, |touch| touch.opening == Opening::Ignored) {
            return None;
        }
        let mut g = polynomial::scaled(self.series.coefficients(), h);
        if end == End::High {
            g[1..n].iter_mut().for_each(|c| *c = -*c);
        }
        g[0] = gap;
        // The mass lies beyond a surface that the last step ignored, but only by rounding, and does not move
        // outward: it touches the surface.
        let returns = touch.is_none() && gap < zero && sign * state.v <= zero;
        let opening = if returns { Some(Opening::Speed) } else { touch.map(|touch| touch.opening) };
        let mut from = opening.map_or(0, |opening| (opening as usize).min(n - 1));
        // A coefficient that is exactly 0 is divided out.
        while from + 1 < n && g[from] == zero {
            from += 1;
        }
        let g = &g[from..n];
        if g[0] > zero {
            PolynomialRoots::new(g).first()
        } else {
            // outward at once, or all coefficients are 0 and it stays
            (g[0] < zero).then_some(zero)
        }
    }
}
