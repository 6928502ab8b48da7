//! Smallest and largest of a set of values.

/// The smallest and the largest value, ignoring NaN; `(inf, -inf)` if there are none.
pub fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    values.into_iter().fold(none, |(low, high), value| (low.min(value), high.max(value)))
}
