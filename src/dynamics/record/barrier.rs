//! Crossings of the barrier within one step: their number, and the side after them.

use crate::numeric::{PolynomialRoots, Scalar};

/// -1 to the left of the barrier, 1 to its right, 0 on it.
#[inline]
pub(crate) fn side_of<T: Scalar>(x: T, barrier: T) -> i8 {
    if x > barrier {
        1
    } else if x < barrier {
        -1
    } else {
        0
    }
}

/// The crossings of the barrier within one step.
pub(crate) struct StepCrossings<'a, T> {
    /// The side that the mass comes from.
    pub from: i8,
    /// 1 where the step begins with a crossing: the barrier was reached at the end of the last step.
    pub at_once: usize,
    /// Those that follow are its changes of sign.
    pub roots: PolynomialRoots<'a, T>,
    /// The side on which the step ends.
    end: i8,
}

impl<'a, T: Scalar> StepCrossings<'a, T> {
    /// Of the step whose displacement from the barrier has these coefficients, its length being 1. With
    /// `from` 0 the motion started on the barrier and counts as coming from the side that it leaves to. None
    /// where it stays on the barrier.
    pub fn new(g: &'a mut [T], from: i8, end: i8) -> Option<Self> {
        // A step that starts on the barrier leaves it by its first coefficient that is not 0.
        let first = g.iter().position(|c| *c != T::zero())?;
        let g = &mut g[first..];
        let departs: i8 = if g[0] > T::zero() { 1 } else { -1 };
        let from = if from == 0 { departs } else { from };
        if departs < 0 {
            g.iter_mut().for_each(|c| *c = -*c);
        }
        Some(Self { from, at_once: usize::from(departs != from), roots: PolynomialRoots::new(g), end })
    }

    /// Their number.
    pub fn count(&self) -> usize {
        self.corrected_count(self.at_once + self.roots.count_sign_changes())
    }

    /// The number of crossings where `count` roots were found: the step's end decides the parity, since
    /// rounding may put a root just beyond it or split a touch.
    pub fn corrected_count(&self, count: usize) -> usize {
        match count % 2 == 1 {
            odd if self.end == 0 => count - usize::from(odd), // on the barrier: the next step decides
            odd if odd == (self.end != self.from) => count,
            _ => count.checked_sub(1).unwrap_or(1),
        }
    }

    /// The side after `count` of them.
    pub fn side_after(&self, count: usize) -> i8 {
        if count % 2 == 1 { -self.from } else { self.from }
    }
}
