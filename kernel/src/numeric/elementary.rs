//! Elementary functions with the same bits on every target: sines, exponentials, logarithms, powers and their
//! inverses.
//!
//! The methods of `f64` call the mathematics library of the system, or the compiler computes them with the
//! one that it has; such libraries differ in the last digit. These functions are those of the crate `libm`,
//! which is compiled from Rust for every target and uses only sums, products, quotients and square roots, all
//! of which IEEE 754 rounds in one way. Its feature `arch` takes `sqrt`, `fma` and roundings to whole numbers
//! from the processor; they are exactly rounded there too, and no other function differs between targets. The
//! `clippy.toml` of the kernel and that of the studies forbid the methods of `f64` in their place.
//!
//! Errors in units of the last digit (ulp), as the sources state them:
//!
//! | functions | source | error |
//! | --- | --- | --- |
//! | `sin`, `cos`, `sin_cos`, `tan` | FreeBSD msun | "nearly rounded" |
//! | `exp`, `ln`, `ln_1p` | FreeBSD msun | below 1 |
//! | `exp2` | FreeBSD msun | below 0.503 |
//! | `powf` | FreeBSD msun | "nearly rounded" |
//! | `asin`, `acos`, `atan`, `atan2`, `exp_m1`, `log2`, `log10` | FreeBSD msun | not stated |
//! | `acosh`, `asinh`, `tanh` | musl | up to 2, 1.6, 2 |
//! | `cosh`, `sinh`, `hypot` | musl | not stated |
//! | `cbrt` | CORE-MATH | correctly rounded |
//!
//! `log10` is exact at the powers of ten that are normal numbers, `log2` and `exp2` at powers of two.
//!
//! The methods `sqrt`, `floor`, `round` and `mul_add` of `f64` are exactly rounded on every target and are
//! called as they are, and so is `powi` with a small constant exponent, which becomes the same products
//! everywhere.
//!
//! Known gap: two crates call the methods of `f64` inside, rustfft for the factors of a transform and statrs
//! for quantiles. Their results can differ in the last digits.

pub use libm::{
    acos, acosh, asin, asinh, atan, atan2, cbrt, cos, cosh, exp, exp2, expm1 as exp_m1, hypot, log as ln,
    log1p as ln_1p, log2, log10, sin, sincos as sin_cos, sinh, tan, tanh,
};

/// Whole numbers up to this one are doubles.
const LARGEST_WHOLE: f64 = 9_007_199_254_740_992.0; // 2^53

/// `base` to the power `exponent`.
///
/// For whole numbers `libm` is exact where the exponent is positive and the result below 2^53, but in places
/// 1 ulp off where the exponent is negative, as at 10^-5. There the result is the reciprocal of the positive
/// power, which is the nearest double.
pub fn powf(base: f64, exponent: f64) -> f64 {
    if exponent < 0.0 && base.fract() == 0.0 && exponent.fract() == 0.0 {
        let positive = libm::pow(base, -exponent);
        if positive.abs() <= LARGEST_WHOLE {
            return 1.0 / positive;
        }
    }
    libm::pow(base, exponent)
}

/// `base` to a whole power, by products of its squares. A negative exponent gives the reciprocal of the
/// positive power, so that results of at most 2^-1024 are 0.
///
/// The error in ulp is about half the magnitude of the exponent. The order of the products is fixed; in
/// `f64::powi` the compiler chooses it where the exponent is a variable.
pub fn powi(base: f64, exponent: i32) -> f64 {
    let (mut product, mut square, mut rest) = (1.0, base, exponent.unsigned_abs());
    while rest > 0 {
        if rest & 1 == 1 {
            product *= square;
        }
        square *= square;
        rest >>= 1;
    }
    if exponent < 0 { 1.0 / product } else { product }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_and_ten_have_exact_logarithms() {
        for power in -1022..=1023 {
            let value = f64::from_bits(((power + 1023) as u64) << 52);
            assert_eq!((log2(value), exp2(f64::from(power))), (f64::from(power), value));
        }
        for power in -307..=308 {
            let value: f64 = format!("1e{power}").parse().unwrap();
            assert_eq!(log10(value), f64::from(power));
        }
    }

    #[test]
    fn powers_of_whole_numbers_are_the_nearest_doubles() {
        for power in -15..=15 {
            let value: f64 = format!("1e{power}").parse().unwrap();
            assert_eq!(powf(10.0, f64::from(power)), value);
        }
        assert_eq!((powf(-3.0, -3.0), powf(-3.0, 3.0)), (-1.0 / 27.0, -27.0));
        assert_eq!((powf(0.0, -1.0), powf(-0.0, -1.0)), (f64::INFINITY, f64::NEG_INFINITY));
        assert_eq!((powf(2.0, -1074.0), powf(f64::INFINITY, -1.0)), (f64::from_bits(1), 0.0));
        assert!(powf(-2.0, 0.5).is_nan() && powf(f64::NAN, -1.0).is_nan());
    }

    #[test]
    fn whole_powers_are_products() {
        assert_eq!([3, 2, 1, 0].map(|power| powi(-7.0, power)), [-343.0, 49.0, -7.0, 1.0]);
        assert_eq!((powi(10.0, 22), powi(10.0, -22)), (1e22, 1.0 / 1e22));
        assert_eq!((powi(0.5, 1022), powi(2.0, -1022)), (f64::MIN_POSITIVE, f64::MIN_POSITIVE));
        assert_eq!((powi(0.0, 0), powi(0.0, -1)), (1.0, f64::INFINITY));
        assert_eq!((powi(2.0, i32::MIN), powi(1.0, i32::MIN)), (0.0, 1.0));
        let cubed = 0.1 * (0.1 * 0.1);
        assert_eq!(powi(0.1, 3), cubed);
    }
}
