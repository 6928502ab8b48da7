//! Exponential decay and its mean.

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
    let doublings = if size > 0.125 { (size.log2() + 3.0).ceil() } else { 0.0 };
    let small = x * T::of((-doublings).exp2());
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

#[cfg(test)]
mod tests {
    use super::super::{DoubleDouble, Number};
    use super::*;

    #[test]
    fn it_is_the_exponential_function() {
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
}
