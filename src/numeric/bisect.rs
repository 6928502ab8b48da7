//! Bisection.

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
