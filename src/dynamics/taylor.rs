//! What does a polynomial in time say of the motion within its step?
//!
//! Functions of coefficients alone, so that a step that was kept is read as the one that has just been made.

use super::series::ROOM;
use crate::numeric::{GaussLegendre, MOST_POINTS, Number, Scalar};

/// The coefficients, each times its power of `h`.
#[inline]
pub(super) fn scaled<T: Scalar>(y: &[T], h: T) -> [T; ROOM] {
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

/// The value at time `t` into the step.
#[inline]
pub(super) fn value<T: Scalar>(y: &[T], t: T) -> T {
    let mut sum = T::zero();
    for c in y.iter().rev() {
        sum = sum * t + *c;
    }
    sum
}

/// The time derivative at time `t` into the step.
#[inline]
pub(super) fn slope<T: Scalar>(y: &[T], t: T) -> T {
    let mut sum = T::zero();
    for k in (1..y.len()).rev() {
        sum = sum * t + y[k] * T::of(k as f64);
    }
    sum
}

/// Integrals over (from, to) within the step: of the squared velocity and, where `WORK`, of base acceleration (`a`)
/// times velocity; of the step's own polynomials by Gauss' rule. (Products truncated at their order miss, on a long
/// step under a fast drive, a thousand times the tolerance.)
#[inline(always)]
pub(super) fn integrals<T: Number, const WORK: bool>(
    y: &[T],
    a: &[T],
    rule: &GaussLegendre<T>,
    from: T,
    to: T,
) -> (T, T) {
    let length = to - from;
    let count = rule.nodes().len();
    let mut times = [T::zero(); MOST_POINTS];
    for (time, node) in times.iter_mut().zip(rule.nodes()) {
        *time = from + length * *node;
    }
    let times = &times[..count];
    let mut v = [T::zero(); MOST_POINTS];
    for k in (1..y.len()).rev() {
        let c = y[k] * T::of(k as f64);
        for (sum, t) in v[..count].iter_mut().zip(times) {
            *sum = *sum * *t + c;
        }
    }
    let mut squared = T::zero();
    for (v, weight) in v.iter().zip(rule.weights()) {
        squared += *v * *v * *weight;
    }
    let mut power = T::zero();
    if WORK {
        let mut base = [T::zero(); MOST_POINTS];
        for c in a.iter().rev() {
            for (sum, t) in base[..count].iter_mut().zip(times) {
                *sum = *sum * *t + *c;
            }
        }
        for ((base, v), weight) in base.iter().zip(&v).zip(rule.weights()) {
            power += *base * *v * *weight;
        }
    }
    (squared * length, power * length)
}
