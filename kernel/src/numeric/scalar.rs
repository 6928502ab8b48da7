//! Number types of the integrator: branch-free arithmetic, for one motion or for several in a vector, and
//! scalars with comparison and a few functions.
//!
//! `f64` is the working type, [`DoubleDouble`](super::DoubleDouble) the reference.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::double_double::DoubleDouble;
use super::quadrature::{GaussLegendre, Rules};

/// A number type whose arithmetic has no branches.
///
/// `f64`, [`DoubleDouble`], [`Dual`](super::Dual) and [`Lanes`](super::Lanes) are such types.
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
    /// Whether one operation costs no more than the overhead of a short loop.
    const QUICK: bool = false;
    /// Whether its arithmetic is worth compiling for each width of registers.
    const WIDE: bool = true;

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

/// Implements `+=` and `-=` of a number type by its sum and difference.
macro_rules! assign_operators {
    ([$($generics:tt)*] $type:ty) => {
        impl<$($generics)*> std::ops::AddAssign for $type {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }

        impl<$($generics)*> std::ops::SubAssign for $type {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
    };
}
pub(super) use assign_operators;

/// A real number with comparison and a few functions.
///
/// The integrator is written for it, so that one code computes in `f64`, with about 31 digits
/// ([`DoubleDouble`]) or with derivatives ([`Dual`](super::Dual)).
pub trait Scalar: Number + PartialOrd {
    /// Relative spacing of the numbers just above 1.
    const EPSILON: f64;

    /// A relative error whose third power is far below rounding.
    const ROUGH: f64;

    /// 2 pi.
    fn tau() -> Self;
    /// The nearest `f64`.
    fn to_f64(self) -> f64;
    /// The number as a sum of two doubles, exact for `f64` and `DoubleDouble`.
    fn to_pair(self) -> DoubleDouble;
    /// The nearest number to a sum of two doubles.
    fn of_pair(pair: DoubleDouble) -> Self;
    /// Largest whole number that is not above this one.
    fn floor(self) -> Self;
    /// Square root of a number that is 0 or above.
    fn sqrt(self) -> Self;
    /// (sin 2 pi u, cos 2 pi u), to an ulp or two; exact at multiples of a quarter, and
    /// sin(-u) = -sin(u) bit for bit. Precondition: |u| well below 2^52.
    fn sin_cos_turns(u: Self) -> (Self, Self);

    /// The Gauss-Legendre rule with 1 to 20 points (clamped), computed once.
    fn gauss_legendre(points: usize) -> &'static GaussLegendre<Self>;

    /// Completes a root that an iteration has found, for number types that need one more step.
    #[inline(always)]
    fn at_root(root: Self, _value_and_slope: impl FnOnce(Self) -> (Self, Self)) -> Self {
        root
    }

    /// The magnitude by which the length of a step is chosen.
    #[inline(always)]
    fn magnitude(self) -> f64 {
        self.to_f64().abs()
    }

    /// Whether it is neither infinite nor NaN.
    fn is_finite(self) -> bool {
        self.to_f64().is_finite()
    }
    /// The larger of two; `self` if they do not compare.
    fn larger(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
    /// The smaller of two; `self` if they do not compare.
    fn smaller(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
}

impl Scalar for f64 {
    const EPSILON: f64 = f64::EPSILON;
    const ROUGH: f64 = 6e-7;

    #[inline]
    fn gauss_legendre(points: usize) -> &'static GaussLegendre<Self> {
        static RULES: Rules<f64> = Rules::new();
        RULES.of(points)
    }

    #[inline(always)]
    fn tau() -> Self {
        std::f64::consts::TAU
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
    fn to_pair(self) -> DoubleDouble {
        DoubleDouble::of(self)
    }
    fn of_pair(pair: DoubleDouble) -> Self {
        pair.to_f64()
    }
    #[inline(always)]
    fn floor(self) -> Self {
        // The library function is not inlined for a target with SSE2 only.
        if self.abs() < 4.0e18 {
            let whole = self as i64 as f64;
            if whole > self { whole - 1.0 } else { whole }
        } else {
            self
        }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    /// It has no branches, so that several can be evaluated at once, and short chains of dependent
    /// operations, because each step of the motion begins with it.
    #[inline(always)]
    fn sin_cos_turns(u: Self) -> (Self, Self) {
        // 1.5 2^52: the last bits of its sum with a number below 2^50 are that number's nearest integer
        const NO_FRACTION: f64 = 6_755_399_441_055_744.0;
        let shifted = u * 4.0 + NO_FRACTION;
        let quarter = shifted.to_bits();
        let r = u - (shifted - NO_FRACTION) * 0.25; // exact
        // Taylor series in (2 pi r)^2 for |2 pi r| <= pi/4, summed by pairs and pairs of pairs (Estrin): the
        // first omitted term is 4e-18 of the leading one.
        let y = std::f64::consts::TAU * r;
        let z = y * y;
        let (z2, reciprocal) = (z * z, |d: f64| 1.0 / d);
        let z4 = z2 * z2;
        let pair = |low: f64, high: f64| reciprocal(low) + z * reciprocal(high);
        let s = (pair(-6.0, 120.0) + z2 * pair(-5_040.0, 362_880.0))
            + z4 * (pair(-39_916_800.0, 6_227_020_800.0)
                + z2 * pair(-1_307_674_368_000.0, 355_687_428_096_000.0));
        let c = (pair(24.0, -720.0) + z2 * pair(40_320.0, -3_628_800.0))
            + z4 * (pair(479_001_600.0, -87_178_291_200.0) + z2 * reciprocal(20_922_789_888_000.0));
        let (s, c) = (y + y * (z * s), 1.0 - (0.5 * z - z2 * c));
        let (sine, cosine) = if quarter & 1 == 1 { (c, s) } else { (s, c) };
        let negated = |value: f64, bit: u64| f64::from_bits(value.to_bits() ^ (bit & 2) << 62);
        (negated(sine, quarter), negated(cosine, quarter + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_of_turns() {
        for i in 1..8000 {
            let u = f64::from(i) * 0.000_713_1;
            let (s, c) = f64::sin_cos_turns(u);
            // compare with the library on the exactly reduced argument
            let r = (u - u.round()) * std::f64::consts::TAU;
            assert!((s - r.sin()).abs() < 4e-16, "sin {u}");
            assert!((c - r.cos()).abs() < 4e-16, "cos {u}");
            let (sm, cm) = f64::sin_cos_turns(-u);
            assert_eq!((sm.to_bits(), cm.to_bits()), ((-s).to_bits(), c.to_bits()));
        }
        for (u, s, c) in
            [(0.0, 0.0, 1.0), (0.25, 1.0, 0.0), (0.5, 0.0, -1.0), (0.75, -1.0, 0.0), (7.25, 1.0, 0.0)]
        {
            let got = f64::sin_cos_turns(u);
            assert_eq!((got.0 + 0.0, got.1 + 0.0), (s, c));
        }
    }
}
