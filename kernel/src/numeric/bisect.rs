//! Bisection and golden-section search.

use super::scalar::Scalar;

/// Bisects the interval from `low`, where a condition holds, to `high`, where it does not, and returns its
/// ends. Stops after `halvings` or when no number lies between the ends.
pub fn bisect<T: Scalar>(mut low: T, mut high: T, halvings: u32, holds: impl Fn(T) -> bool) -> (T, T) {
    for _ in 0..halvings {
        let middle = (low + high) * T::of(0.5);
        if middle == low || middle == high {
            break;
        }
        *(if holds(middle) { &mut low } else { &mut high }) = middle;
    }
    (low, high)
}

/// Where `f`, which has one minimum between `low` and `high`, is smallest, after `steps` golden sections.
pub fn golden_section(mut low: f64, mut high: f64, steps: u32, f: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (f(left), f(right));
    for _ in 0..steps {
        if at_left <= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = f(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = f(right);
        }
    }
    if at_left <= at_right { left } else { right }
}
