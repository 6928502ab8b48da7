//! Functions of a polynomial in time: value, slope, integrals, deviation from the chord.
//!
//! They use coefficients alone, so that a logged step is evaluated like one that has just been computed.

use super::each_order;
use super::order::ROOM;
use crate::numeric::{GaussLegendre, Number, Scalar};

/// The coefficients, each times its power of `h`.
#[inline(always)]
pub(crate) fn scaled<T: Number>(y: &[T], h: T) -> [T; ROOM] {
    let mut scaled = [T::zero(); ROOM];
    let mut power = T::of(1.0);
    for (k, (slot, c)) in scaled.iter_mut().zip(y).enumerate() {
        if k > 0 {
            power = power * h;
        }
        *slot = *c * power;
    }
    scaled
}

/// The coefficients of the velocity times `h`, each times its power of `h`.
#[inline(always)]
pub(crate) fn scaled_slope<T: Number>(y: &[T], h: T) -> [T; ROOM] {
    derivative(&scaled(y, h)[..y.len()])
}

/// The coefficients of the derivative.
#[inline(always)]
pub(crate) fn derivative<T: Number>(y: &[T]) -> [T; ROOM] {
    let mut slope = [T::zero(); ROOM];
    for (k, slot) in (1..y.len()).zip(&mut slope) {
        *slot = y[k] * T::whole(k);
    }
    slope
}

/// The value at time `t` into the step.
#[inline(always)]
pub(crate) fn value<T: Number>(y: &[T], t: T) -> T {
    let mut sum = T::zero();
    for c in y.iter().rev() {
        sum = sum * t + *c;
    }
    sum
}

/// The time derivative at time `t` into the step.
#[inline(always)]
pub(crate) fn slope<T: Number>(y: &[T], t: T) -> T {
    let mut sum = T::zero();
    for k in (1..y.len()).rev() {
        sum = sum * t + y[k] * T::whole(k);
    }
    sum
}

/// The second time derivative at time `t` into the step.
#[inline(always)]
pub(crate) fn curvature<T: Number>(y: &[T], t: T) -> T {
    let mut sum = T::zero();
    for k in (2..y.len()).rev() {
        sum = sum * t + y[k] * T::whole(k * (k - 1));
    }
    sum
}

/// Bounds of the deviations from the chords between the ends of a step of length `h`: of the displacement, of
/// the velocity times `h` and of the acceleration times `h`^2. Each is an eighth of the square of the length
/// times the largest second derivative.
#[inline(always)]
pub(crate) fn chord_deviations<T: Number>(y: &[T], h: T) -> (T, T, T) {
    let (mut second, mut third, mut fourth, mut power) = (T::zero(), T::zero(), T::zero(), h);
    each_order::<T, true, 2>(
        2..y.len(),
        #[inline(always)]
        |k| {
            power = power * h;
            let term = y[k].abs() * power * T::whole(k * (k - 1));
            second += term;
            let term = term * T::whole(k - 2);
            third += term;
            fourth += term * T::whole(k.saturating_sub(3));
        },
    );
    (second * T::of(0.125), third * T::of(0.125), fourth * T::of(0.125))
}

/// Integrals over (from, to) within the step: of the squared velocity and, if `WORK`, of base acceleration
/// (`a`) times velocity, by Gauss' rule from the polynomials of the step. (The product of the series,
/// truncated at their order, is off by a thousand tolerances on a long step under a fast drive.)
#[inline(always)]
pub(crate) fn integrals<T: Number, const WORK: bool>(
    y: &[T],
    a: &[T],
    rule: &GaussLegendre<T>,
    from: T,
    to: T,
) -> (T, T) {
    let mut sums = (T::zero(), T::zero());
    let points = rule.nodes().len();
    let whole = points - points % 4;
    for first in (0..whole).step_by(4) {
        at_nodes::<T, WORK, 4>(y, a, rule, first, (from, to), &mut sums);
    }
    match points % 4 {
        1 => at_nodes::<T, WORK, 1>(y, a, rule, whole, (from, to), &mut sums),
        2 => at_nodes::<T, WORK, 2>(y, a, rule, whole, (from, to), &mut sums),
        3 => at_nodes::<T, WORK, 3>(y, a, rule, whole, (from, to), &mut sums),
        _ => {}
    }
    (sums.0 * (to - from), sums.1 * (to - from))
}

/// Adds the contributions of `COUNT` nodes, beginning with the one numbered `first`; up to four side by side.
#[inline(always)]
fn at_nodes<T: Number, const WORK: bool, const COUNT: usize>(
    y: &[T],
    a: &[T],
    rule: &GaussLegendre<T>,
    first: usize,
    (from, to): (T, T),
    (squared, power): &mut (T, T),
) {
    let (length, nodes) = (to - from, &rule.nodes()[first..first + COUNT]);
    let weights = &rule.weights()[first..first + COUNT];
    // Named variables: arrays would go through memory. Common expressions are computed once.
    let time = |i: usize| from + length * nodes[i.min(COUNT - 1)];
    let times = (time(0), time(1), time(2), time(3));
    let v = at_four_times(y.len(), |k| y[k] * T::whole(k), 1, times);
    let base = if WORK { at_four_times(a.len(), |k| a[k], 0, times) } else { v };
    macro_rules! add {
        ($($index:tt)*) => {
            $(if $index < COUNT {
                *squared += v.$index * v.$index * weights[$index];
                if WORK {
                    *power += base.$index * v.$index * weights[$index];
                }
            })*
        };
    }
    add!(0 1 2 3);
}

/// The integral of a function over (from, to), by Gauss' rule.
#[inline]
pub(crate) fn integral<T: Scalar>(rule: &GaussLegendre<T>, from: T, to: T, of: impl Fn(T) -> T) -> T {
    let length = to - from;
    let parts = rule.nodes().iter().zip(rule.weights());
    parts.fold(T::zero(), |sum, (node, weight)| sum + of(from + length * *node) * *weight) * length
}

/// The integral of the square over (from, to) within the step.
pub(crate) fn squared<T: Scalar>(w: &[T], rule: &GaussLegendre<T>, from: T, to: T) -> T {
    integral(rule, from, to, |t| value(w, t) * value(w, t))
}

/// The polynomial of the coefficients `first..count`, the lowest being the constant, at four times.
#[inline(always)]
pub(crate) fn at_four_times<T: Number>(
    count: usize,
    coefficient: impl Fn(usize) -> T,
    first: usize,
    (t0, t1, t2, t3): (T, T, T, T),
) -> (T, T, T, T) {
    let zero = T::zero();
    let (mut v0, mut v1, mut v2, mut v3) = (zero, zero, zero, zero);
    for k in (first..count).rev() {
        let c = coefficient(k);
        v0 = v0 * t0 + c;
        v1 = v1 * t1 + c;
        v2 = v2 * t2 + c;
        v3 = v3 * t3 + c;
    }
    (v0, v1, v2, v3)
}
