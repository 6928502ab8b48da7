//! Arithmetic that a power series needs: without a branch, so that the numbers of several motions can be one.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Arithmetic without a branch.
pub trait Number:
    'static
    + Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// Whether an operation takes so little that the bookkeeping of a short loop costs as much.
    const QUICK: bool = false;

    /// The number nearest to `value`.
    fn of(value: f64) -> Self;
    /// The number nearest to `over / under`.
    fn ratio(over: f64, under: f64) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;

    /// A whole number below 2^32, a degree as a rule.
    #[inline(always)]
    fn whole(number: usize) -> Self {
        Self::of(f64::from(number as u32)) // (one instruction, where 64 bits without a sign take several)
    }

    /// 0.
    fn zero() -> Self {
        Self::of(0.0)
    }
}

impl Number for f64 {
    const QUICK: bool = true;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn ratio(over: f64, under: f64) -> Self {
        over / under
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
}
