//! Force of one piece of the curve: a polynomial about the piece's origin.

use crate::numeric::{Number, Scalar};

/// The force of one piece over mass, in kernel units, about the piece's origin.
#[derive(Debug, Clone)]
pub(crate) struct PieceForce<T> {
    coefficients: Vec<T>,
    odd: bool,
}

impl<T: Number> PieceForce<T> {
    /// Coefficients from the constant up, at least one; `odd` where all even ones are 0.
    pub fn new(coefficients: Vec<T>, odd: bool) -> Self {
        Self { coefficients, odd }
    }

    /// One of the coefficients.
    #[inline]
    pub fn coefficient_mut(&mut self, degree: usize) -> &mut T {
        &mut self.coefficients[degree]
    }

    /// Coefficients from the constant up; never empty.
    #[inline(always)]
    pub fn coefficients(&self) -> &[T] {
        &self.coefficients
    }

    /// Whether all even coefficients are 0.
    #[inline(always)]
    pub fn is_odd(&self) -> bool {
        self.odd
    }

    /// Products of series that its own series takes beyond the first.
    pub fn products(&self) -> usize {
        let count = self.coefficients.len();
        if self.odd { count / 2 - 1 } else { count - 1 }
    }

    /// Force over mass at displacement `y` from the origin.
    #[inline(always)]
    pub fn at(&self, y: T) -> T {
        let Some((last, others)) = self.coefficients.split_last() else { return T::zero() };
        let mut sum = *last;
        for c in others.iter().rev() {
            sum = sum * y + *c;
        }
        sum
    }
}

impl<T: Scalar> PieceForce<T> {
    /// Coefficients of force over mass about displacement `y` from the origin, into `terms`.
    pub fn about(&self, y: T, terms: &mut Vec<T>) {
        terms.clear();
        terms.extend_from_slice(&self.coefficients);
        for first in 0..terms.len() {
            for k in (first..terms.len() - 1).rev() {
                terms[k] = terms[k] + y * terms[k + 1];
            }
        }
    }

    /// Force over mass and its slope at displacement `y` from the origin, and a bound of the rounding.
    pub fn value(&self, y: T) -> (T, T, T) {
        let (mut f, mut slope, mut size) = (T::zero(), T::zero(), T::zero());
        for c in self.coefficients.iter().rev() {
            slope = slope * y + f;
            f = f * y + *c;
            size = size * y.abs() + c.abs();
        }
        (f, slope, size * T::of(2.0 * T::EPSILON))
    }
}
