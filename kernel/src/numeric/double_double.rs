//! Double-double arithmetic with about 31 digits.
//!
//! The method is that of Dekker 1971, "A floating-point technique for extending the available precision",
//! with Knuth's two-sum. Products are split instead of using a fused multiply-add, so that the result does
//! not depend on the processor.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::quadrature::{GaussLegendre, Rules};
use super::scalar::{Number, Scalar, assign_operators};

/// A number with about 31 digits: the sum high + low of two doubles with |low| at most half an ulp of high
/// (Dekker 1971). [`Model::run_reference`](crate::dynamics::Model::run_reference) computes with it, to
/// measure the error of a run in doubles.
///
/// ```
/// # use interwell_kernel as interwell;
/// use interwell::numeric::{DoubleDouble, Number, Scalar};
///
/// let root = DoubleDouble::of(2.0).sqrt();
/// let error = root * root - DoubleDouble::of(2.0);
/// assert!(error.to_f64().abs() < 1e-30);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// 2 pi to 32 digits.
const TAU: DoubleDouble = DoubleDouble { high: std::f64::consts::TAU, low: 2.449_293_598_294_706_4e-16 };

/// Sum of two doubles with its rounding error.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

/// Product of two doubles with its rounding error. Precondition: magnitudes below 1e300.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let split = |x: f64| {
        let t = 134_217_729.0 * x; // 2^27 + 1
        let high = t - (t - x);
        (high, x - high)
    };
    let p = a * b;
    let (ah, al) = split(a);
    let (bh, bl) = split(b);
    (p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl DoubleDouble {
    /// The exact product of two doubles.
    pub fn product(a: f64, b: f64) -> Self {
        let (high, low) = two_product(a, b);
        Self { high, low }
    }

    /// The leading double.
    pub fn high(self) -> f64 {
        self.high
    }

    /// The trailing double.
    pub fn low(self) -> f64 {
        self.low
    }

    fn renormalised(high: f64, low: f64) -> Self {
        let s = high + low;
        Self { high: s, low: low - (s - high) }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let (s, e) = two_sum(self.high, o.high);
        let (t, f) = two_sum(self.low, o.low);
        let step = Self::renormalised(s, e + t);
        Self::renormalised(step.high, step.low + f)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let (p, e) = two_product(self.high, o.high);
        Self::renormalised(p, e + (self.high * o.low + self.low * o.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let first = self.high / o.high;
        let rest = self - o * Self::of(first);
        let second = rest.high / o.high;
        let rest = rest - o * Self::of(second);
        Self::renormalised(first, second) + Self::of(rest.high / o.high)
    }
}

assign_operators!([] DoubleDouble);

impl PartialOrd for DoubleDouble {
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&o.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&o.low),
            other => other,
        }
    }
}

impl Number for DoubleDouble {
    const WIDE: bool = false;

    fn of(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
    fn ratio(over: f64, under: f64) -> Self {
        Self::of(over) / Self::of(under)
    }
    fn abs(self) -> Self {
        if self.high < 0.0 || (self.high == 0.0 && self.low < 0.0) { -self } else { self }
    }
}

impl Scalar for DoubleDouble {
    const EPSILON: f64 = 1.0e-31;
    const ROUGH: f64 = 4e-12;

    fn gauss_legendre(points: usize) -> &'static GaussLegendre<Self> {
        static RULES: Rules<DoubleDouble> = Rules::new();
        RULES.of(points)
    }

    fn tau() -> Self {
        TAU
    }
    fn to_f64(self) -> f64 {
        self.high + self.low
    }
    fn to_pair(self) -> DoubleDouble {
        self
    }
    fn of_pair(pair: DoubleDouble) -> Self {
        pair
    }
    fn floor(self) -> Self {
        let high = self.high.floor();
        if high == self.high { Self::renormalised(high, self.low.floor()) } else { Self::of(high) }
    }
    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::of(self.high.sqrt());
        }
        let guess = Self::of(self.high.sqrt());
        let better = guess + (self - guess * guess) / (guess + guess);
        better + (self - better * better) / (better + better)
    }
    /// Reduces `u` exactly to |r| <= 1/8 turn, sums the series there and restores the octant.
    fn sin_cos_turns(u: Self) -> (Self, Self) {
        let size = u.abs();
        let part = size - size.floor(); // exact
        let quarter = (part * Self::of(4.0) + Self::of(0.5)).floor();
        let r = part - quarter * Self::of(0.25); // exact
        let y = TAU * r;
        let z = y * y;
        let series = |first: i32| {
            // sum of (-z)^i first!/(first + 2 i)!, from the innermost factor
            let mut sum = Self::of(1.0);
            for i in (1..=15).rev() {
                let d = f64::from((first + 2 * i) * (first + 2 * i - 1));
                sum = Self::of(1.0) - z * sum / Self::of(d);
            }
            sum
        };
        let (s, c) = (y * series(1), series(0));
        let (s, c) = match quarter.to_f64() as i32 & 3 {
            0 => (s, c),
            1 => (c, -s),
            2 => (-s, -c),
            _ => (-c, s),
        };
        if u < Self::zero() { (-s, c) } else { (s, c) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_keeps_thirty_digits() {
        let third = DoubleDouble::of(1.0) / DoubleDouble::of(3.0);
        let one = third * DoubleDouble::of(3.0);
        assert!((one - DoubleDouble::of(1.0)).to_f64().abs() < 1e-31);
        let root = DoubleDouble::of(2.0).sqrt();
        assert!((root * root - DoubleDouble::of(2.0)).to_f64().abs() < 1e-30);
    }

    #[test]
    fn sine_and_cosine_lie_on_the_circle() {
        for i in 0..200 {
            let u = DoubleDouble::of(f64::from(i) * 0.017) / DoubleDouble::of(3.0);
            let (s, c) = DoubleDouble::sin_cos_turns(u);
            assert!((s * s + c * c - DoubleDouble::of(1.0)).to_f64().abs() < 1e-30);
            let (s64, c64) = f64::sin_cos_turns(u.to_f64());
            assert!((s.to_f64() - s64).abs() < 1e-15 && (c.to_f64() - c64).abs() < 1e-15);
        }
        // sin(pi/6) = 1/2 to all digits
        let twelfth = DoubleDouble::of(1.0) / DoubleDouble::of(12.0);
        assert!((DoubleDouble::sin_cos_turns(twelfth).0 - DoubleDouble::of(0.5)).to_f64().abs() < 1e-31);
    }
}
