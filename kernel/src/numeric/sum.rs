//! Compensated summation.

use super::scalar::Scalar;

/// A running sum with compensation (Neumaier 1974): its error does not grow with the number of terms.
#[derive(Debug, Clone, Copy)]
pub struct CompensatedSum<T> {
    sum: T,
    carry: T,
}

impl<T: Scalar> CompensatedSum<T> {
    /// The empty sum.
    pub fn new() -> Self {
        Self { sum: T::zero(), carry: T::zero() }
    }

    /// Adds one term.
    #[inline(always)]
    pub fn add(&mut self, term: T) {
        let sum = self.sum + term;
        self.carry +=
            if self.sum.abs() >= term.abs() { (self.sum - sum) + term } else { (term - sum) + self.sum };
        self.sum = sum;
    }

    /// The sum with these [`parts`](Self::parts).
    #[inline(always)]
    pub fn of_parts(sum: T, carry: T) -> Self {
        Self { sum, carry }
    }

    /// The rounded sum and its accumulated rounding error.
    #[inline(always)]
    pub fn parts(&self) -> (T, T) {
        (self.sum, self.carry)
    }

    /// The sum of all terms so far.
    pub fn value(&self) -> T {
        self.sum + self.carry
    }
}

impl<T: Scalar> Default for CompensatedSum<T> {
    fn default() -> Self {
        Self::new()
    }
}
