//! The root of a polynomial that changes its sign once between 0 and 1.
//!
//! It works on one polynomial or on several in lanes; each lane gets exactly the root that it
//! would get alone.

use super::scalar::{Number, Scalar};

/// Largest number of steps to the root; each cubes the error.
pub(crate) const MAX_STEPS: usize = 3;

/// An approximate root of the cubic with these values and slopes at 0 and at 1. The values must
/// differ in sign.
#[inline(always)]
pub(crate) fn guess((g0, slope0): (f64, f64), (g1, slope1): (f64, f64)) -> f64 {
    let rise = g1 - g0;
    // start from the parabola with both values and the slope at 0
    let bend = rise - slope0;
    let root = (slope0 * slope0 - 4.0 * g0 * bend).sqrt();
    let s = -2.0 * g0 / (slope0 + root.copysign(slope0));
    // one step of third order on the cubic
    let (c, d) = (3.0 * rise - 2.0 * slope0 - slope1, slope0 + slope1 - 2.0 * rise);
    let value = g0 + s * (slope0 + s * (c + s * d));
    let slope = slope0 + s * (2.0 * c + 3.0 * d * s);
    s - step((value, slope, c + 3.0 * d * s)).0
}

/// Chebyshev's step (third order) from value, slope and half the curvature, and by which share it exceeds
/// Newton's step.
#[inline(always)]
pub(crate) fn step<T: Scalar>((value, slope, half_curvature): (T, T, T)) -> (T, T) {
    let newton = value / slope;
    let bent = newton * half_curvature / slope;
    (newton + newton * bent, bent)
}

/// One step from `s`: the next estimate of the root, and whether it has converged.
#[inline(always)]
pub(crate) fn next<T: Scalar>(s: T, expansion: (T, T, T)) -> (T, bool) {
    let (step, bent) = step(expansion);
    let close = T::of(T::ROUGH);
    // the remaining error is the third power of the last one
    (s - step, (step.abs() <= s.abs() * close) & (bent.abs() <= close))
}

/// The root near `guess`; `None` if it does not converge in a few steps, or is not between 0 and 1.
#[inline]
pub(crate) fn single_root<T: Scalar>(g: &[T], guess: T) -> Option<T> {
    let mut s = guess;
    for _ in 0..MAX_STEPS {
        let (next, found) = next(s, expansion(g, s));
        s = next;
        if found {
            let root = completed(g, s);
            return (root > T::zero() && root <= T::of(1.0)).then_some(root);
        }
    }
    None
}

/// Completes a root of a polynomial that an iteration has found; see [`Scalar::at_root`].
#[inline(always)]
pub(crate) fn completed<T: Scalar>(g: &[T], root: T) -> T {
    T::at_root(root, |s| {
        let (value, slope, _) = expansion(g, s);
        (value, slope)
    })
}

/// Value, first and half the second derivative of a polynomial at `s`. Even and odd powers are summed
/// separately to shorten the chain of dependent products.
#[inline(always)]
pub(crate) fn expansion<T: Number>(g: &[T], s: T) -> (T, T, T) {
    let zero = T::zero();
    let square = s * s;
    // of each part: value, first and half the second derivative with respect to `square`
    let (mut e0, mut e1, mut e2, mut o0, mut o1, mut o2) = (zero, zero, zero, zero, zero, zero);
    let mut pairs = g.rchunks_exact(2);
    macro_rules! add {
        ($value:ident $first:ident $second:ident, $c:expr) => {
            $second = $second * square + $first;
            $first = $first * square + $value;
            $value = $value * square + $c;
        };
    }
    if g.len().is_multiple_of(2) {
        for pair in pairs.by_ref() {
            add!(o0 o1 o2, pair[1]);
            add!(e0 e1 e2, pair[0]);
        }
    } else {
        for pair in pairs.by_ref() {
            add!(e0 e1 e2, pair[1]);
            add!(o0 o1 o2, pair[0]);
        }
        add!(e0 e1 e2, pairs.remainder()[0]);
    }
    let two = T::of(2.0);
    let first = e1 + s * o1;
    let value = e0 + s * o0;
    let slope = o0 + two * s * first;
    let half_curvature = first + two * s * (o1 + two * s * (e2 + s * o2));
    (value, slope, half_curvature)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::{DoubleDouble, Lanes, times_roots};

    fn guessed(g: &[f64]) -> f64 {
        let (value, slope, _) = expansion(g, 1.0);
        guess((g[0], g[1]), (value, slope))
    }

    #[test]
    fn the_root_is_found_to_rounding_wherever_it_lies() {
        for root in [1e-9, 1e-4, 0.01, 0.3, 0.5, 0.9, 0.9999] {
            for factor in [&[1.0, 0.4, 0.1, -0.05][..], &[-3.0, 0.5, -0.2], &[2.0, -0.7, 0.0, 0.0, 0.03]] {
                let g = times_roots(factor, &[root]);
                let found = single_root(&g, guessed(&g)).unwrap();
                assert!((found - root).abs() <= 4e-16 * root.max(0.25), "{root} {factor:?} {found:e}");
                let negative = g.iter().map(|c| -c).collect::<Vec<_>>();
                assert_eq!(single_root(&negative, guessed(&negative)), Some(found));
            }
        }
    }

    #[test]
    fn a_root_beyond_1_and_a_missing_root_give_none() {
        let g = times_roots(&[1.0, 0.4], &[1.25]);
        assert_eq!(single_root(&g, 1.2), None);
        assert_eq!(single_root(&[1.0, 0.1, 1.0], 0.5), None);
        assert_eq!(single_root(&[1.0, -2.0], f64::NAN), None);
    }

    #[test]
    fn zeros_above_the_highest_power_change_no_bit() {
        let g = times_roots(&[1.0, 0.4, 0.1, -0.05], &[0.37]);
        let longer = [&g[..], &[0.0, 0.0, 0.0]].concat();
        for length in g.len()..=longer.len() {
            assert_eq!(expansion(&longer[..length], 0.3), expansion(&g, 0.3));
        }
        let lanes = g.iter().map(|c| Lanes([*c; 4])).collect::<Vec<_>>();
        let (value, slope, half_curvature) = expansion(&lanes, Lanes([0.3; 4]));
        assert_eq!((value.0[3], slope.0[3], half_curvature.0[3]), expansion(&g, 0.3));
    }

    #[test]
    fn the_same_code_in_double_double() {
        let g: Vec<DoubleDouble> = [2.0, 0.0, -4.0].iter().map(|c| DoubleDouble::of(*c)).collect();
        let s = single_root(&g, DoubleDouble::of(0.7)).unwrap();
        assert!((s * s - DoubleDouble::of(0.5)).to_f64().abs() < 1e-30);
    }
}
