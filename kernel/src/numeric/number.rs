//! Branch-free arithmetic for power series, so that the numbers of several motions can share one vector.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number type whose arithmetic has no branches.
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
    /// Whether one operation is so cheap that the overhead of a short loop costs as much.
    const QUICK: bool = false;

    /// The number nearest to `value`.
    fn of(value: f64) -> Self;
    /// The number nearest to `over / under`.
    fn ratio(over: f64, under: f64) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;

    /// Converts a whole number below 2^32, usually a degree.
    #[inline(always)]
    fn whole(number: usize) -> Self {
        Self::of(f64::from(number as u32)) // one instruction; a conversion from u64 takes several
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
