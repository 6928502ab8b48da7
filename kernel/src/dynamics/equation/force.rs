//! Force of one piece of the curve: a polynomial about the piece's origin.

use crate::numeric::{Number, Scalar, shift};

/// The force of one piece over mass, in kernel units, about the piece's origin.
#[derive(Debug, Clone)]
pub(crate) struct PieceForce<T> {
    /// From the constant up; never empty.
    pub coefficients: Vec<T>,
}

impl<T: Number> PieceForce<T> {
    pub fn degree(&self) -> usize {
        self.coefficients.len() - 1
    }

    /// Force over mass at displacement `y` from the origin.
    #[inline(always)]
    pub fn at(&self, y: T) -> T {
        let Some((last, lower)) = self.coefficients.split_last() else { return T::zero() };
        let mut sum = *last;
        for c in lower.iter().rev() {
            sum = sum * y + *c;
        }
        sum
    }

    /// Coefficients of force over mass about displacement `y` from the origin, into `terms`.
    pub fn about(&self, y: T, terms: &mut Vec<T>) {
        terms.clear();
        terms.extend_from_slice(&self.coefficients);
        shift(terms, y);
    }
}

impl<T: Scalar> PieceForce<T> {
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

    /// Bound of the slope up to `reach` on either side of the origin.
    pub fn steepest(&self, reach: T) -> T {
        let terms = self.coefficients.iter().enumerate().skip(1).rev();
        terms.fold(T::zero(), |sum, (k, c)| sum * reach + c.abs() * T::whole(k))
    }
}
