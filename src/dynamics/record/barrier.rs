//! How often does a step pass the top between the wells, and on which side does it end?

use crate::numeric::{PolynomialRoots, Scalar};

/// -1 to the left of the top, 1 to its right, 0 on it.
#[inline]
pub(crate) fn side_of<T: Scalar>(x: T, top: T) -> i8 {
    if x > top {
        1
    } else if x < top {
        -1
    } else {
        0
    }
}

/// The passages of the top within one step.
pub(crate) struct StepCrossings<'a, T> {
    /// The side that the mass comes from.
    pub from: i8,
    /// One at the very start: the top was reached at the end of the last step.
    pub at_once: usize,
    /// Those that follow are its changes of sign.
    pub roots: PolynomialRoots<'a, T>,
    /// The side on which the step ends.
    end: i8,
}

impl<'a, T: Scalar> StepCrossings<'a, T> {
    /// Of the step whose displacement from the top has these coefficients, its length being 1; a motion that `from` 0 starts
    /// on the top comes from the side that it leaves to. None where it stays on the top.
    pub fn new(g: &'a mut [T], from: i8, end: i8) -> Option<Self> {
        // A step that starts on the top leaves it by its first coefficient that is not 0.
        let first = g.iter().position(|c| *c != T::zero())?;
        let g = &mut g[first..];
        let departs: i8 = if g[0] > T::zero() { 1 } else { -1 };
        let from = if from == 0 { departs } else { from };
        if departs < 0 {
            g.iter_mut().for_each(|c| *c = -*c);
        }
        Some(Self { from, at_once: usize::from(departs != from), roots: PolynomialRoots::new(g), end })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.settle(self.at_once + self.roots.count_sign_changes())
    }

    /// How many `count` stands for: the end decides the parity, since rounding may put a root just beyond it, or a touch of
    /// the top.
    pub fn settle(&self, count: usize) -> usize {
        match count % 2 == 1 {
            odd if self.end == 0 => count - usize::from(odd), // on the top: the next step tells
            odd if odd == (self.end != self.from) => count,
            _ => count.checked_sub(1).unwrap_or(1),
        }
    }

    /// The side after `count` of them.
    pub fn side_after(&self, count: usize) -> i8 {
        if count % 2 == 1 { -self.from } else { self.from }
    }
}
