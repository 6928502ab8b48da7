//! Dual numbers x + x1 e1 + .. + xn en, in which every product of two of the e is 0 (Clifford 1873): every
//! result comes with its derivatives, exact to rounding. The value has the same bits as in plain double
//! arithmetic and decides every comparison.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::double_double::DoubleDouble;
use super::quadrature::{GaussLegendre, Rules};
use super::scalar::{Number, Scalar, assign_operators};

/// A value and its derivatives with respect to `N` quantities. It is a [`Scalar`] for two and three of them.
///
/// A function that is written for any [`Scalar`] gives its derivatives without a formula for them
/// (forward-mode differentiation); the stroboscopic map gets those of a motion in this way.
#[derive(Debug, Clone, Copy)]
pub struct Dual<const N: usize = 2> {
    /// The value.
    pub value: f64,
    /// Its derivatives.
    pub slopes: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// The derivatives of `a self + b other` for constant `a` and `b`.
    #[inline(always)]
    fn slopes_of(self, a: f64, other: Self, b: f64) -> [f64; N] {
        std::array::from_fn(|i| a * self.slopes[i] + b * other.slopes[i])
    }
}

impl<const N: usize> PartialEq for Dual<N> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<const N: usize> PartialOrd for Dual<N> {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { value: self.value + o.value, slopes: self.slopes_of(1.0, o, 1.0) }
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { value: self.value - o.value, slopes: self.slopes_of(1.0, o, -1.0) }
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self { value: self.value * o.value, slopes: self.slopes_of(o.value, o, self.value) }
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let (value, inverse) = (self.value / o.value, 1.0 / o.value);
        Self { value, slopes: self.slopes_of(inverse, o, -(value * inverse)) }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slopes: self.slopes.map(|slope| -slope) }
    }
}

assign_operators!([const N: usize] Dual<N>);

impl<const N: usize> Number for Dual<N> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self { value, slopes: [0.0; N] }
    }
    #[inline(always)]
    fn ratio(over: f64, under: f64) -> Self {
        Self::of(over / under)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let slopes = if self.value < 0.0 { self.slopes.map(|slope| -slope) } else { self.slopes };
        Self { value: self.value.abs(), slopes }
    }
}

/// The functions of a dual number; a macro, since each number of derivatives has a separate table.
macro_rules! scalar {
    ($n:literal) => {
        impl Scalar for Dual<$n> {
            const EPSILON: f64 = f64::EPSILON;
            const ROUGH: f64 = f64::ROUGH;

            fn tau() -> Self {
                Self::of(f64::tau())
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.value
            }
            /// The value alone.
            fn to_pair(self) -> DoubleDouble {
                DoubleDouble::of(self.value)
            }
            fn of_pair(pair: DoubleDouble) -> Self {
                Self::of(pair.to_f64())
            }
            fn floor(self) -> Self {
                Self::of(self.value.floor())
            }
            /// The derivatives at 0, which are infinite, are set to 0.
            fn sqrt(self) -> Self {
                let root = self.value.sqrt();
                let by = if root > 0.0 { 0.5 / root } else { 0.0 };
                Self { value: root, slopes: self.slopes.map(|slope| slope * by) }
            }
            #[inline(always)]
            fn sin_cos_turns(u: Self) -> (Self, Self) {
                let (s, c) = f64::sin_cos_turns(u.value);
                let angle = u.slopes.map(|slope| slope * std::f64::consts::TAU);
                let sine = Self { value: s, slopes: angle.map(|slope| c * slope) };
                (sine, Self { value: c, slopes: angle.map(|slope| -s * slope) })
            }

            /// The largest magnitude of the value and its derivatives, since the derivatives still change
            /// where the value is near 0. The value alone counts if a derivative is infinite, as after a
            /// grazing impact.
            #[inline(always)]
            fn magnitude(self) -> f64 {
                let all =
                    self.slopes.iter().fold(self.value.abs(), |largest, slope| largest.max(slope.abs()));
                if all.is_finite() { all } else { self.value.abs() }
            }

            fn gauss_legendre(points: usize) -> &'static GaussLegendre<Self> {
                static RULES: Rules<Dual<$n>> = Rules::new();
                RULES.of(points)
            }

            /// An iteration stops when the value no longer changes; the derivatives may then lag by one step.
            /// One more step of Newton's method at the root computes them.
            #[inline(always)]
            fn at_root(root: Self, value_and_slope: impl FnOnce(Self) -> (Self, Self)) -> Self {
                let (value, slope) = value_and_slope(Self::of(root.value));
                Self { value: root.value, slopes: (-(value / slope)).slopes }
            }
        }
    };
}

scalar!(2);
scalar!(3);

#[cfg(test)]
mod tests {
    use super::super::PolynomialRoots;
    use super::*;

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() <= 4e-15 * (1.0 + b.abs())
    }

    #[test]
    fn derivatives_follow_the_rules_of_calculus() {
        let x: Dual = Dual { value: 0.7, slopes: [1.0, 0.0] };
        let y = Dual { value: -1.3, slopes: [0.0, 1.0] };
        let check = |dual: Dual, value: f64, by_x: f64, by_y: f64| {
            assert_eq!(dual.value, value);
            assert!(near(dual.slopes[0], by_x) && near(dual.slopes[1], by_y), "{dual:?} {by_x} {by_y}");
        };
        check(x + y, 0.7 + -1.3, 1.0, 1.0);
        check(x - y, 0.7 - -1.3, 1.0, -1.0);
        check(x * y, 0.7 * -1.3, -1.3, 0.7);
        check(x / y, 0.7 / -1.3, -1.0 / 1.3, -0.7 / 1.69);
        check(-x, -0.7, -1.0, 0.0);
        check(y.abs(), 1.3, 0.0, -1.0);
        check(x.sqrt(), 0.7_f64.sqrt(), 0.5 / 0.7_f64.sqrt(), 0.0);
        let (s, c) = Dual::sin_cos_turns(x * y);
        let tau = std::f64::consts::TAU;
        let (sine, cosine) = f64::sin_cos_turns(0.7 * -1.3);
        check(s, sine, cosine * tau * -1.3, cosine * tau * 0.7);
        check(c, cosine, sine * tau * 1.3, -sine * tau * 0.7);
    }

    #[test]
    fn a_root_comes_with_its_derivatives() {
        // (s - a) (s^2 + b): the root is a, whatever b
        for k in 1..40 {
            let a = Dual { value: f64::from(k) / 41.0, slopes: [1.0, 0.0] };
            let b = Dual { value: 0.4, slopes: [0.0, 1.0] };
            let g = [-(a * b), b, -a, Dual::of(1.0)].map(|c| -c);
            let root = PolynomialRoots::new(&g).first().unwrap();
            assert!(near(root.value, a.value));
            assert!((root.slopes[0] - 1.0).abs() < 1e-13 && root.slopes[1].abs() < 1e-13, "{root:?}");
            let plain = g.map(|c| c.value);
            assert_eq!(PolynomialRoots::new(&plain).first().unwrap().to_bits(), root.value.to_bits());
        }
    }
}
