//! Tests of the search for sign changes.

use proptest::prelude::*;

use super::*;
use crate::numeric::{DoubleDouble, random, times_roots};

fn from_roots(roots: &[f64], scale: f64) -> Vec<f64> {
    times_roots(&[scale], roots)
}

fn all(g: &[f64]) -> Vec<f64> {
    let mut found = Vec::new();
    PolynomialRoots::new(g).each_sign_change(&mut |s| {
        found.push(s);
        true
    });
    assert_eq!(PolynomialRoots::new(g).count_sign_changes(), found.len());
    found
}

#[test]
fn a_polynomial_and_its_negative_have_the_same_roots_whatever_sign_a_zero_has() {
    // a mass that starts at rest: the slope is 0 or -0
    let mut next = random();
    for _ in 0..200 {
        let g = [0.2 + 0.5 * next(), 0.0, -0.9 - 0.3 * next(), 0.05 * next(), -0.01 * next()];
        let other = [g[0], -0.0, g[2], g[3], g[4]];
        let found = all(&g);
        assert!(!found.is_empty());
        assert_eq!(
            (all(&other), all(&g.map(|c| -c)), all(&other.map(|c| -c))),
            (found.clone(), found.clone(), found)
        );
    }
}

#[test]
fn every_root_inside_is_found_once_and_in_order() {
    let g = from_roots(&[0.1, 0.35, 0.36, 0.9, 1.4, -0.2], -1.0);
    let found = all(&g);
    assert_eq!(found.len(), 4);
    for (f, r) in found.iter().zip([0.1, 0.35, 0.36, 0.9]) {
        assert!((f - r).abs() < 1e-13, "{f} {r}");
    }
    assert!((PolynomialRoots::new(&g).first().unwrap() - 0.1).abs() < 1e-15);
}

#[test]
fn a_pair_of_roots_is_found_although_the_ends_have_equal_signs() {
    let g = from_roots(&[0.5, 0.500_001], 1.0);
    let found = all(&g);
    assert_eq!(found.len(), 2);
    assert!((found[0] - 0.5).abs() < 1e-9 && (found[1] - 0.500_001).abs() < 1e-9);
}

#[test]
fn a_double_root_is_a_touch() {
    assert!(all(&from_roots(&[0.3, 0.3], 1.0)).len().is_multiple_of(2));
    assert!(all(&from_roots(&[0.3, 0.3, 0.7], -1.0)).len() % 2 == 1);
    // a value of exactly 0 at a halving point is found as a pair, as close as rounding allows
    let pair = all(&from_roots(&[0.5, 0.5], 1.0));
    assert!(pair.len() == 2 && (pair[0] - 0.5).abs() < 1e-7 && (pair[1] - 0.5).abs() < 1e-7);
}

#[test]
fn small_roots_keep_their_relative_digits() {
    let g = [1e-9, -0.3, 0.2, 0.1];
    let s = PolynomialRoots::new(&g).first().unwrap();
    assert!((s - 1e-9 / 0.3 * (1.0 + 0.2 * 1e-9 / 0.09)).abs() < 1e-24);
}

#[test]
fn the_expansion_is_value_and_slopes() {
    for count in 1..9 {
        let g: Vec<f64> = (0..count).map(|k| 1.0 / (1.5 + k as f64) - 0.3 * (k % 3) as f64).collect();
        let polynomial = PolynomialRoots::new(&g);
        for s in [-0.7, 0.0, 0.3, 1.0, 1.4] {
            let (value, slope, half_curvature) = expansion(&g, s);
            let (v, first, second) = polynomial.value_and_slopes(s);
            let near = |a: f64, b: f64| (a - b).abs() < 1e-13 * (1.0 + b.abs());
            assert!(
                near(value, v) && near(slope, first) && near(2.0 * half_curvature, second),
                "{count} {s}"
            );
        }
    }
}

#[test]
fn the_same_code_in_double_double() {
    let g: Vec<DoubleDouble> = [2.0, 0.0, -4.0].iter().map(|c| crate::numeric::Number::of(*c)).collect();
    let s = PolynomialRoots::new(&g).first().unwrap();
    let half: DoubleDouble = crate::numeric::Number::of(0.5);
    assert!((s * s - half).to_f64().abs() < 1e-30);
}

#[test]
fn a_root_at_0_is_no_sign_change() {
    // the slope of a quartic that rests at 0, 1/2 and 1, and turns at 1/2
    let g = [0.0, 0.5, -1.5, 1.0];
    for g in [g, g.map(|c| -c)] {
        assert_eq!(all(&g), [0.5]);
    }
    for (g, roots) in [
        (&[0.0, 1.0][..], &[][..]),
        (&[0.0, 0.0, 0.0, -3.0], &[]),
        (&[0.0, 1e-300], &[]),
        (&[-0.0, -1.0, 4.0], &[0.25]),
        (&[0.0, 0.0, 1.0, -2.0], &[0.5]),
        (&[0.0, -1e-200, 1e-200], &[1.0]),
        (&[1.0, -1.0], &[1.0]),
        (&[0.0, 0.0, 0.0], &[]),
        (&[0.0], &[]),
    ] {
        assert_eq!(all(g), roots, "{g:?}");
    }
    // a root very close to 0 beside a root at 0
    for near in [1e-9, 1e-30] {
        let found = all(&[0.0, -near, 1.0]);
        assert!(found.len() == 1 && (found[0] / near - 1.0).abs() < 1e-15, "{found:?}");
    }
}

#[test]
fn a_root_at_1_and_at_the_ends_of_halves_is_found_from_either_side() {
    for (roots, found) in [
        (&[1.0][..], &[1.0][..]),
        (&[0.5], &[0.5]),
        (&[0.25, 0.5, 0.75], &[0.25, 0.5, 0.75]),
        (&[0.5, 0.5, 0.5], &[0.5]),
        (&[0.25, 0.25, 0.25, 0.75], &[0.25, 0.75]),
        (&[1.0, 1.0, 1.0], &[1.0]),
        (&[0.0, 0.0, 0.5, 1.0], &[0.5]),
        (&[0.125, 0.875, 2.0, -1.0], &[0.125, 0.875]),
    ] {
        for scale in [1.0, -1.0, 1e-280, -1e200] {
            let all = all(&from_roots(roots, scale));
            assert_eq!(all.len(), found.len(), "{roots:?} {scale}: {all:?}");
            let off = |(s, root): (&f64, &f64)| (s - root).abs();
            assert!(all.iter().zip(found).map(off).all(|off| off < 2e-5), "{roots:?} {scale}: {all:?}");
        }
    }
}

#[test]
fn a_root_at_the_end_of_a_half_to_rounding_is_found_once() {
    // Two ways to evaluate the polynomial at 1/2 give opposite signs.
    for k in (0..4000).map(f64::from) {
        let (near, other) = (0.5 + 0.3 * (0.7 * k).sin().abs(), 1.5 + 1e-3 * k);
        if near < 0.501 {
            continue;
        }
        let found = all(&from_roots(&[0.5, near, other, -0.3 * other], 0.1));
        assert_eq!(found.len(), 2, "{k}");
        assert!((found[0] - 0.5).abs().max((found[1] - near).abs()) < 1e-11, "{k}: {found:?}");
    }
}

#[test]
fn a_change_inside_is_found_although_the_end_is_a_root_to_rounding() {
    for k in (1..2000).map(|k| f64::from(k) / 2000.0) {
        for other in [-0.39, -2.0, 1.7] {
            for scale in [0.5, -0.5] {
                let found = all(&from_roots(&[other, 1.0, k], scale));
                assert!(!found.is_empty() && (found[0] - k).abs() < 1e-11, "{k} {other} {scale}: {found:?}");
            }
        }
    }
}

/// Roots from 0 to 1, including multiples of 1/16, and some outside.
fn some_roots() -> impl Strategy<Value = Vec<f64>> {
    let root = prop_oneof![
        (0_u8..=16).prop_map(|k| f64::from(k) / 16.0),
        0.0..1.0,
        (-30.0_f64..0.0).prop_map(f64::exp2),
        1.001..3.0,
        -3.0..-0.001,
    ];
    prop::collection::vec(root, 0..7)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 4000, failure_persistence: None, ..ProptestConfig::default()
    })]

    /// Compares with the roots that the polynomial was made from. Of a cluster of roots closer than rounding
    /// can resolve, only the parity counts.
    #[test]
    fn sign_changes_are_those_of_a_scan(mut roots in some_roots(), scale in -1.0..1.0) {
        prop_assume!(scale != 0.0);
        let g = from_roots(&roots, scale);
        let found = all(&g);
        let negative: Vec<f64> = g.iter().map(|c| -c).collect();
        prop_assert_eq!(&all(&negative), &found);
        prop_assert!(found.is_sorted() && found.iter().all(|s| *s > 0.0 && *s <= 1.0), "{:?}", found);
        // compare the number of roots between two positions that are far from every root
        roots.sort_by(f64::total_cmp);
        let value = |s: f64| roots.iter().map(|root| s - root).product::<f64>();
        let clear = |s: f64| roots.iter().all(|root| (s - root).abs() > 0.02);
        let places: Vec<f64> = (1..512).map(|k| f64::from(k) / 512.0).filter(|s| clear(*s)).collect();
        for pair in places.windows(2) {
            let between = found.iter().filter(|s| **s > pair[0] && **s <= pair[1]).count();
            let changes = (value(pair[0]) > 0.0) != (value(pair[1]) > 0.0);
            prop_assert_eq!(between % 2 == 1, changes, "{:?} between {:?}: {:?}", roots, pair, found);
            let within = roots.iter().filter(|root| **root > pair[0] && **root <= pair[1]).count();
            prop_assert!(between <= within, "{:?} between {:?}: {:?}", roots, pair, found);
        }
    }
}
