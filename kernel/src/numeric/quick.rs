//! Fast approximate base-2 logarithm and power, with the same bits on every processor.

/// log2 of a positive normal number, to 0.01.
#[inline(always)]
pub fn fast_log2(x: f64) -> f64 {
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
pub fn fast_exp2(x: f64) -> f64 {
    const NO_FRACTION: f64 = 6_755_399_441_055_744.0; // 1.5 2^52
    let shifted = x + NO_FRACTION;
    let f = x - (shifted - NO_FRACTION);
    let mantissa = 1.0 + f * (0.7035 + 0.2402 * f); // 2^f for |f| <= 1/2
    f64::from_bits((shifted.to_bits() << 52).wrapping_add(1023 << 52)) * mantissa
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quick_logarithms_are_good_enough_for_a_step() {
        for i in 1..2000 {
            let x = f64::from(i) * 0.37;
            assert!((fast_log2(x) - x.log2()).abs() < 0.01);
            let y = f64::from(i - 1000) * 0.1;
            assert!((fast_exp2(y) / y.exp2() - 1.0).abs() < 4e-3);
        }
    }
}
