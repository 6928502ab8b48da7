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

pub(crate) struct StepCrossings<'a, T> {
    /// The side from which the mass comes.
    pub from: i8,
    /// 1 if the step begins with a crossing, because the last step ended on the barrier; else 0.
    pub at_once: usize,
    /// The further crossings are its sign changes.
    pub roots: PolynomialRoots<'a, T>,
    end: i8,
}

impl<'a, T: Scalar> StepCrossings<'a, T> {
    /// From the coefficients of the displacement from the barrier over a step of length 1. If `from` is 0,
    /// the motion started on the barrier and counts as coming from the side to which it leaves; `None` if it
    /// stays.
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

    pub fn count(&self) -> usize {
        self.corrected_count(self.at_once + self.roots.count_sign_changes())
    }

    /// The number of crossings if `count` roots were found. The end of the step decides the parity, since
    /// rounding may put a root just beyond it or split a touch.
    pub fn corrected_count(&self, count: usize) -> usize {
        match count % 2 == 1 {
            odd if self.end == 0 => count - usize::from(odd), // on the barrier: the next step decides
            odd if odd == (self.end != self.from) => count,
            _ => count.checked_sub(1).unwrap_or(1),
        }
    }

    pub fn side_after(&self, count: usize) -> i8 {
        if count % 2 == 1 { -self.from } else { self.from }
    }
}
