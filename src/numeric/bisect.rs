//! Bisection and golden section.

use super::scalar::Scalar;

/// The ends between which a condition changes, from `low`, where it holds, to `high`, where it does not:
/// halved `most` times at most, or until nothing lies between them.
pub fn bisect<T: Scalar>(mut low: T, mut high: T, most: u32, holds: impl Fn(T) -> bool) -> (T, T) {
    for _ in 0..most {
        let middle = (low + high) * T::of(0.5);
        if middle == low || middle == high {
            break;
        }
        *(if holds(middle) { &mut low } else { &mut high }) = middle;
    }
    (low, high)
}

/// Where a function with one minimum between `low` and `high` has it, to `steps` golden sections.
pub fn golden_section(mut low: f64, mut high: f64, steps: u32, of: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (of(left), of(right));
    for _ in 0..steps {
        if at_left <= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = of(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = of(right);
        }
    }
    if at_left <= at_right { left } else { right }
}
