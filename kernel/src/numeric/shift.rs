//! Expansion of a polynomial about another origin.

use super::scalar::Number;

/// Makes coefficients of powers of x those of powers of x - `origin`, by synthetic division.
#[inline(always)]
pub(crate) fn shift<T: Number>(coefficients: &mut [T], origin: T) {
    for first in 1..coefficients.len() {
        let mut above = coefficients[coefficients.len() - 1];
        for coefficient in coefficients[first - 1..].iter_mut().rev().skip(1) {
            above = *coefficient + origin * above;
            *coefficient = above;
        }
    }
}
