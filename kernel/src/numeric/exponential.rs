//! Exponential decay and its mean. Fast approximate base-2 logarithm and power, with the same bits on every
//! processor.

use super::elementary;
use super::scalar::Scalar;

/// Above this x, e^-x is 0 in every number type.
const UNDERFLOW: f64 = 1e4;

/// e^-x and (1 - e^-x)/x for x >= 0, to within a few units of rounding of 1.
///
/// Both are summed as series for x up to 1/8. Larger x are reached by doubling, e^-2x = (e^-x)^2 and
/// (1 - e^-2x)/(2x) = (1 - e^-x)/x (1 + e^-x)/2, in which nothing cancels.
pub(crate) fn decay<T: Scalar>(x: T) -> (T, T) {
    let one = T::of(1.0);
    let size = x.to_f64();
    if size > UNDERFLOW {
        return (T::zero(), one / x);
    }
    let doublings = if size > 0.125 { (elementary::log2(size) + 3.0).ceil() } else { 0.0 };
    let small = x * T::of(elementary::exp2(-doublings));
    let (mut mean, mut term) = (one, one);
    for k in 2..30 {
        term = -(term * small / T::whole(k));
        mean += term;
        if term.to_f64().abs() < 0.1 * T::EPSILON {
            break;
        }
    }
    let mut exponential = one - small * mean;
    for _ in 0..doublings as u32 {
        mean = mean * (one + exponential) * T::of(0.5);
        exponential = exponential * exponential;
    }
    (exponential, mean)
}

/// log2 of a positive normal number, to 0.01.
#[inline(always)]
pub(crate) fn fast_log2(x: f64) -> f64 {
    // 2^52 with the exponent in its last bits: the conversion from integer stays in the vector registers.
    const WHOLE: u64 = 0x4330_0000_0000_0000;
    const BIAS: f64 = 4_503_599_627_370_496.0 + 1023.0;
    let bits = x.to_bits();
    let exponent = f64::from_bits(bits >> 52 | WHOLE) - BIAS;
    let m = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) | 0x3ff0_0000_0000_0000) - 1.0;
    exponent + m * (1.3465 - 0.3465 * m)
}

/// 2^x to 0.3 %, for |x| up to 1000.
#[inline(always)]
pub(crate) fn fast_exp2(x: f64) -> f64 {
    const NO_FRACTION: f64 = 6_755_399_441_055_744.0; // 1.5 2^52
    let shifted = x + NO_FRACTION;
    let f = x - (shifted - NO_FRACTION);
    let mantissa = 1.0 + f * (0.7035 + 0.2402 * f); // 2^f for |f| <= 1/2
    f64::from_bits((shifted.to_bits() << 52).wrapping_add(1023 << 52)) * mantissa
}

#[cfg(test)]
mod tests {
    use super::super::{DoubleDouble, Number};
    use super::*;

    #[test]
    fn decay_is_the_exponential_function() {
        for x in [0.0, 1e-300, 1e-9, 0.1, 0.125, 0.126, 1.0, 3.7, 40.0, 700.0, 2e4, f64::INFINITY] {
            let (exponential, mean) = decay(x);
            assert!((exponential - (-x).exp()).abs() < 4.0 * f64::EPSILON, "{x}");
            let exact = if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 };
            assert!((mean - exact).abs() <= 8.0 * f64::EPSILON * exact, "{x}: {mean} {exact}");
        }
        // e^-1 = 0.36787944117144232159552377016146
        let (exponential, _) = decay(DoubleDouble::of(1.0));
        let exact =
            DoubleDouble::of(0.367_879_441_171_442_33) + DoubleDouble::of(-1.242_875_367_278_836_4e-17);
        assert!((exponential - exact).to_f64().abs() < 1e-31);
    }

    #[test]
    fn fast_logarithms_and_powers_keep_their_stated_errors() {
        for i in 1..2000 {
            let x = f64::from(i) * 0.37;
            assert!((fast_log2(x) - x.log2()).abs() < 0.01);
            let y = f64::from(i - 1000) * 0.1;
            assert!((fast_exp2(y) / y.exp2() - 1.0).abs() < 4e-3);
        }
    }
}
