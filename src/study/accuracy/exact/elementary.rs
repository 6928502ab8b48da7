//! Functions of double-doubles that closed forms need.

use super::dd;
use crate::numeric::{DoubleDouble, Scalar};

/// e^x, to some 29 digits, for |x| below 700.
///
/// Reduced by ln 2 and halved eight times, then Taylor's series and eight squarings, which cost some
/// two digits.
pub fn exp(x: DoubleDouble) -> DoubleDouble {
    let ln_2 = dd(std::f64::consts::LN_2) + dd(2.319_046_813_846_299_6e-17);
    let halvings = (x / ln_2 + dd(0.5)).floor().to_f64();
    let small = (x - ln_2 * dd(halvings)) * dd(1.0 / 256.0);
    // Sum of small^i/i!, innermost factor first; small is below 1.4e-3.
    let mut sum = dd(1.0);
    for i in (1..=12).rev() {
        sum = dd(1.0) + small * sum / dd(f64::from(i));
    }
    for _ in 0..8 {
        sum = sum * sum;
    }
    // in two halves, since 2^halvings itself may be out of range
    let half = (halvings * 0.5).floor();
    sum * dd(half.exp2()) * dd((halvings - half).exp2())
}

/// (sin, cos) of an angle in radians, to some 30 digits of a turn.
pub fn sin_cos(angle: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    turns(angle / DoubleDouble::tau())
}

/// (sin, cos) of an angle in turns, which may be large.
pub(super) fn turns(turns: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    DoubleDouble::sin_cos_turns(turns - turns.floor())
}

/// The angle in turns, 0 to 1/4, whose sine is `sine`, 0 to 1. Newton's method from the double: near a
/// quarter turn the angle has half the digits of the sine.
pub fn sine_turns(sine: DoubleDouble) -> DoubleDouble {
    let one = dd(1.0);
    let cosine = ((one - sine) * (one + sine)).sqrt();
    let mut angle = dd(sine.to_f64().atan2(cosine.to_f64()));
    for _ in 0..3 {
        let (s, c) = sin_cos(angle);
        // the difference of two angles from the sine of it, which stays well conditioned near a quarter turn
        angle += sine * c - cosine * s;
    }
    angle / DoubleDouble::tau()
}

/// The complete elliptic integral K, given the complementary parameter 1 - k^2 above 0: pi over twice the
/// arithmetic-geometric mean of 1 and the root of it (Gauss).
pub fn elliptic_k(complement: DoubleDouble) -> DoubleDouble {
    let (mut a, mut b) = (dd(1.0), complement.sqrt());
    for _ in 0..12 {
        (a, b) = ((a + b) * dd(0.5), (a * b).sqrt());
    }
    DoubleDouble::tau() * dd(0.25) / a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_multiply_and_invert() {
        for x in [-300.0, -1.7, -1e-9, 0.0, 0.3, 1.0, 42.0, 600.0] {
            let product = exp(dd(x)) * exp(dd(-x));
            assert!((product - dd(1.0)).to_f64().abs() < 1e-28, "{x}");
            assert!((exp(dd(x)).to_f64() / x.exp() - 1.0).abs() < 4e-16, "{x}");
        }
        // e to 32 digits
        let e = dd(std::f64::consts::E) + dd(1.445_646_891_729_250_2e-16);
        assert!((exp(dd(1.0)) - e).to_f64().abs() < 1e-29);
    }

    #[test]
    fn an_angle_comes_back_from_its_sine() {
        for angle in [0.0, 1e-9, 0.1, 0.125, 0.2, 0.249_999_999, 0.25] {
            let (sine, _) = turns(dd(angle));
            let found = sine_turns(sine);
            // near a quarter turn the error is the root of the rounding of the sine
            let allowed = if angle < 0.249 { 1e-30 } else { 1e-15 };
            assert!((found - dd(angle)).to_f64().abs() < allowed, "{angle}");
        }
    }

    #[test]
    fn the_elliptic_integral_at_its_ends() {
        // K(0) = pi/2; K near 1 is ln(4/k') to first order
        assert!((elliptic_k(dd(1.0)).to_f64() - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        let near = elliptic_k(dd(1e-24)).to_f64();
        assert!((near / (4e12_f64).ln() - 1.0).abs() < 1e-15, "{near}");
    }
}
