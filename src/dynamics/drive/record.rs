//! A recorded acceleration: straight lines between its samples.

use crate::dynamics::clock::{Clock, Instant};
use crate::numeric::Scalar;

/// A straight line between two samples.
#[derive(Debug, Clone)]
pub(crate) struct Line<T> {
    /// The segment of the drive in which this line begins, ascending.
    pub first_segment: usize,
    /// When it begins.
    pub at: Instant<T>,
    /// Its value there and its slope, kernel units.
    pub value: T,
    pub slope: T,
}

/// The lines of one record in their order; the last one is zero. Before the first the record is zero too.
pub(crate) type Record<T> = Vec<Line<T>>;

/// The sum of several records and its slope.
pub(crate) fn value_and_slope<T: Scalar>(
    records: &[Record<T>],
    clock: &Clock<T>,
    at: &Instant<T>,
    segment: usize,
) -> (T, T) {
    let mut sum = (T::zero(), T::zero());
    for record in records {
        let line = record.partition_point(|line| line.first_segment <= segment);
        if let Some(line) = line.checked_sub(1).map(|i| &record[i]) {
            sum.0 += line.value + line.slope * clock.between(&line.at, at);
            sum.1 += line.slope;
        }
    }
    sum
}
