//! The least and the greatest of some values.

/// Both, NaN passed over; of none `(inf, -inf)`.
pub fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    values.into_iter().fold(none, |(low, high), own| (low.min(own), high.max(own)))
}
