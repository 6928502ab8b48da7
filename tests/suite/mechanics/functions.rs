//! Curves of functions: their errors against the function, their corners, and their form in a scene.

use interwell::mechanics::{ForceCurve, FunctionError, Mechanism, Piece};
use interwell::scene::{Document, Files};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::build;

/// Comparisons with the function.
const PLACES: usize = 3001;

/// The largest |curve - function| over the range.
fn worst(curve: &ForceCurve, force: impl Fn(f64) -> f64) -> f64 {
    let (low, high) = curve.domain();
    let place = |i: usize| low + (high - low) * i as f64 / (PLACES - 1) as f64;
    (0..PLACES)
        .map(|i| place(i).clamp(low, high))
        .map(|x| (curve.force(x) - force(x)).abs())
        .fold(0.0, f64::max)
}

/// The curve of the mechanism of a scene with this curve, read back from its text.
fn through_a_scene(curve: &ForceCurve) -> ForceCurve {
    let mut scene = Document::preset("nominal-cubic").unwrap().scene;
    scene.mechanism = curve.to_scene();
    let text = interwell::scene::write(&scene).unwrap();
    let read = Document::from_text("s.ron", &text, Files::default()).unwrap();
    read.check().unwrap();
    assert_eq!(read.scene.mechanism, scene.mechanism);
    build(read.scene.mechanism).curve
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(40) })]

    /// Polynomial, wave and exponential over a random range: the curve is as close as it was asked to be, its
    /// report is true, and a scene holds it bit for bit.
    #[test]
    fn a_smooth_function_is_followed(
        linear in -100.0..100.0_f64,
        cubic in -2.0..2.0_f64,
        (wave, waves) in (-0.2..0.2_f64, 0.0..12.0_f64),
        growth in -2.0..2.0_f64,
        (middle, half) in (-5.0e-3..5.0e-3_f64, 1.0e-3..2.0e-2_f64),
        digits in 2.0..9.0_f64,
    ) {
        let range = (middle - half, middle + half);
        let force = |x: f64| {
            let y = (x - middle) / half;
            linear * x + cubic * y.powi(3) + wave * (waves * y).sin() + 0.1 * (growth * y).exp()
        };
        let tolerance = 10.0_f64.powf(-digits);
        let curve = ForceCurve::from_fn(force, range, tolerance, &[]).unwrap();
        let report = curve.fit().unwrap().clone();
        let found = worst(&curve, force);
        prop_assert!(report.worst_n <= 1.001 * tolerance * report.scale_n + 1e-14, "{report:?}");
        // the report is of five places in each interval; the largest error may lie between them
        prop_assert!(found <= 1.5 * report.worst_n + 1e-14, "{found:e} {report:?}");
        prop_assert_eq!(curve.domain(), range);
        let read = through_a_scene(&curve);
        prop_assert_eq!(read.pieces(), curve.pieces());
        prop_assert_eq!(read.breaks(), curve.breaks());
        prop_assert_eq!(read.is_odd(), curve.is_odd());
    }

    /// An odd function over a symmetric range gives an odd curve.
    #[test]
    fn an_odd_function_has_an_odd_curve(stiffness in -50.0..50.0_f64, waves in 0.1..9.0_f64) {
        let force = |x: f64| stiffness * x + (waves * x / 0.01).sin();
        let curve = ForceCurve::from_fn(force, (-0.01, 0.01), 1e-7, &[]).unwrap();
        prop_assert!(curve.is_odd());
        prop_assert!(through_a_scene(&curve).is_odd());
    }

    /// A corner is found where it is not named, and stands exactly where it is.
    #[test]
    fn a_corner_is_found(at in -8.0e-3..8.0e-3_f64, left in -60.0..-1.0_f64, right in 1.0..60.0_f64) {
        let force = |x: f64| if x < at { left * (x - at) } else { right * (x - at) };
        let found = ForceCurve::from_fn(force, (-0.01, 0.01), 1e-6, &[]).unwrap();
        prop_assert!(worst(&found, force) <= 1.5e-6 * found.fit().unwrap().scale_n);
        prop_assert!(found.breaks().len() == 1 && (found.breaks()[0] - at).abs() < 1e-13);
        let named = ForceCurve::from_fn(force, (-0.01, 0.01), 1e-6, &[at]).unwrap();
        prop_assert_eq!(named.breaks(), &[at]);
        let (before, after) = named.stiffness_on_both_sides(at);
        prop_assert!((before - left).abs() < 1e-6 * left.abs() && (after - right).abs() < 1e-6 * right);
        let kinks = &Mechanism::new(named).landscape.kinks;
        prop_assert!(kinks.len() == 1 && kinks[0].x == at);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    /// Corners of a double well give the same wells, kinks and stiffnesses whether they are named or found,
    /// for any tolerance.
    #[test]
    fn corners_found_are_corners_named(
        places in proptest::collection::vec(-8.5e-3..8.5e-3_f64, 1..4),
        steps in proptest::collection::vec(10.0..200.0_f64, 4),
        digits in 6.0..9.0_f64,
    ) {
        let force = |x: f64| {
            let bends = places.iter().zip(&steps).map(|(at, step)| step * (x - at).max(0.0));
            -40.0 * x + 8e5 * x.powi(3) + bends.sum::<f64>()
        };
        let mut apart = places.clone();
        apart.sort_by(f64::total_cmp);
        // corners that all but coincide are one bend
        prop_assume!(apart.windows(2).all(|pair| pair[1] - pair[0] > 1e-4));
        let (range, tolerance) = ((-9e-3, 9e-3), 10.0_f64.powf(-digits));
        let calls = std::cell::Cell::new(0);
        let counted = |x: f64| {
            calls.set(calls.get() + 1);
            force(x)
        };
        let found = ForceCurve::from_fn(counted, range, tolerance, &[]).unwrap();
        prop_assert!(calls.get() < 6_000, "{} calls", calls.get());
        let named = ForceCurve::from_fn(force, range, tolerance, &places).unwrap();
        let landscapes = [found, named].map(|curve| Mechanism::new(curve).landscape);
        let kinks = |i: usize| landscapes[i].kinks.iter().map(|kink| kink.x).collect::<Vec<_>>();
        prop_assert_eq!(kinks(0).len(), kinks(1).len(), "{:?} {:?}", kinks(0), kinks(1));
        let same = kinks(0).into_iter().zip(kinks(1)).all(|(found, named)| (found - named).abs() < 1e-9);
        prop_assert!(same, "{:?} {:?}", kinks(0), kinks(1));
        let stiffness = |i: usize| landscapes[i].damping_stiffness();
        match (stiffness(0), stiffness(1)) {
            (Some(found), Some(named)) => {
                // both are slopes at an end of a piece, which the tolerance bounds less well than the force
                let bound = 0.02 * named.abs() + 1.0;
                prop_assert!((found - named).abs() < bound, "{} is not {}", found, named);
            }
            (found, named) => prop_assert_eq!(found, named),
        }
    }
}

#[test]
fn a_corner_beside_a_sample_and_one_in_the_middle_are_where_they_are() {
    let wavy = |wave: f64, places: &[f64], steps: &[f64], tolerance: f64| {
        let force = |x: f64| {
            let bends = places.iter().zip(steps).map(|(at, step)| step * (x - at).max(0.0));
            -40.0 * x + 8e5 * x.powi(3) + wave * (x / 1e-3).sin() + bends.sum::<f64>()
        };
        let curve = ForceCurve::from_fn(force, (-9e-3, 9e-3), tolerance, &[]).unwrap();
        Mechanism::new(curve).landscape
    };
    let found = |places: &[f64], steps: &[f64], tolerance: f64| wavy(0.0, places, steps, tolerance);
    let places = [-1.167_757_077_873_290_2e-3, 2.286_109_608_505_83e-3, -1.420_466_877_074_472_5e-3];
    let kinks = found(&places, &[10.0; 3], 1e-6).kinks;
    assert!(kinks.len() == 3 && (kinks[1].x - places[0]).abs() < 1e-12, "{kinks:?}");
    // there are samples at multiples of the range's 64th part
    for (cell, beside) in [(-13.0, 1.3e-9), (5.0, -0.7e-9), (20.0, 3e-11)] {
        let at = cell * 18e-3 / 64.0 + beside;
        let kinks = found(&[at], &[94.0], 3.5e-8).kinks;
        assert!(kinks.len() == 1 && (kinks[0].x - at).abs() < 1e-12, "{at} {kinks:?}");
    }
    for wave in [0.0, 0.02] {
        for cells in [[4.0, 14.0], [-13.0, 0.0], [4.0, 11.0], [3.0, 20.0]] {
            let places = cells.map(|cell| cell * 18e-3 / 64.0 + 1e-9);
            let kinks = wavy(wave, &places, &[94.0; 2], 3.5e-8).kinks;
            let are_found = kinks.iter().zip(places).all(|(kink, at)| (kink.x - at).abs() < 1e-12);
            assert!(kinks.len() == 2 && are_found, "{wave} {places:?} {kinks:?}");
        }
    }
    let landscape = found(&[-8.243_429e-3, 0.0, 9.231_25e-4], &[10.0, 199.9, 10.0], 1e-6);
    assert!(landscape.kinks[1].x == 0.0, "{:?}", landscape.kinks);
    // not the slope beside the corner in the middle, which is 170 N/m
    let stiffness = landscape.damping_stiffness().unwrap();
    assert!((stiffness - 94.36).abs() < 0.1, "{stiffness}");
}

#[test]
fn an_odd_function_with_corners_has_an_odd_curve() {
    for at in [1.0e-3, 2.345_678e-3, 6.9e-3] {
        let bend = |x: f64| 50.0 * ((x - at).max(0.0) - (-x - at).max(0.0));
        let curve = ForceCurve::from_fn(|x| -40.0 * x + 8e5 * x.powi(3) + bend(x), (-9e-3, 9e-3), 1e-8, &[]);
        let curve = curve.unwrap();
        assert!(curve.is_odd(), "{:?}", curve.breaks());
        assert!(curve.breaks().iter().any(|x| (x - at).abs() < 1e-12), "{:?}", curve.breaks());
    }
}

#[test]
fn the_corners_of_an_interpolation_are_found() {
    // forces at 60 random places, joined by lines
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut next = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let mut x: Vec<f64> = (0..60).map(|_| -9e-3 + 18e-3 * next()).chain([-9e-3, 9e-3]).collect();
    x.sort_by(f64::total_cmp);
    x.dedup_by(|b, a| *b - *a < 2e-5);
    let force: Vec<f64> = x.iter().map(|x| -40.0 * x + 8e5 * x.powi(3) + 0.05 * next()).collect();
    let line = |at: f64| {
        let right = x.partition_point(|x| *x < at).clamp(1, x.len() - 1);
        let share = (at - x[right - 1]) / (x[right] - x[right - 1]);
        force[right - 1] * (1.0 - share) + force[right] * share
    };
    let curve = ForceCurve::from_fn(line, (-9e-3, 9e-3), 1e-8, &[]).unwrap();
    assert!(worst(&curve, line) <= 1.5e-8 * curve.fit().unwrap().scale_n);
    for inner in &x[1..x.len() - 1] {
        assert!(curve.breaks().iter().any(|found| (found - inner).abs() < 1e-11), "{inner}");
    }
}

#[test]
fn noise_is_refused_after_a_bounded_number_of_calls() {
    let noisy = |x: f64| -40.0 * x + 8e5 * x.powi(3) + 1e-3 * ((x * 1e9).sin() * 43758.5).fract();
    let error = ForceCurve::from_fn(noisy, (-9e-3, 9e-3), 1e-8, &[]).unwrap_err();
    assert!(matches!(error, FunctionError::Rough(_) | FunctionError::Step(_)), "{error}");
}

#[test]
fn samples_become_a_curve_or_are_refused() {
    let x: Vec<f64> = (0..200).map(|i| -9e-3 + 18e-3 * f64::from(i) / 199.0).collect();
    let force: Vec<f64> = x.iter().map(|x| -40.0 * x + 8e5 * x.powi(3)).collect();
    let curve = ForceCurve::from_samples(&x, &force, 1e-8).unwrap();
    assert!(worst(&curve, |x| -40.0 * x + 8e5 * x.powi(3)) < 1e-8 * curve.fit().unwrap().scale_n * 2.0);
    let refused =
        |x: &[f64], force: &[f64]| ForceCurve::from_samples(x, force, 1e-3).unwrap_err().to_string();
    assert!(refused(&x, &force[1..]).contains("200 positions have 199 forces"));
    assert!(refused(&x[..3], &force[..3]).contains("give 4 to"));
    let mut turned = x.clone();
    turned[7] = turned[6];
    assert!(refused(&turned, &force).contains("sort them"));
    turned[7] = f64::NAN;
    assert!(refused(&turned, &force).contains("number 7"));
}

#[test]
fn what_is_no_force_is_refused() {
    let range = (-0.01, 0.01);
    let made = |force: fn(f64) -> f64, range, tolerance, breaks: &[f64]| {
        ForceCurve::from_fn(force, range, tolerance, breaks).unwrap_err()
    };
    let step = made(|x| if x < 1.234e-3 { 0.0 } else { 1.0 }, range, 1e-6, &[]);
    assert!(matches!(step, FunctionError::Step(x) if (x - 1.234e-3).abs() < 1e-9), "{step:?}");
    assert!(matches!(made(|x| 1.0 / x, range, 1e-6, &[]), FunctionError::NotFinite(0.0, _)));
    assert!(matches!(made(|x| x, (0.01, -0.01), 1e-6, &[]), FunctionError::Range(..)));
    assert!(matches!(made(|x| x, (0.0, f64::INFINITY), 1e-6, &[]), FunctionError::Range(..)));
    assert!(matches!(made(|x| x, range, f64::NAN, &[]), FunctionError::Tolerance(_)));
    assert!(matches!(made(|x| x, range, 1e-20, &[]), FunctionError::Tolerance(_)));
    assert!(matches!(made(|x| x, range, 1e-6, &[0.02]), FunctionError::Break(0.02)));
    let wrong = |pieces: usize, domain| {
        let flat = Piece { origin: 0.0, coefficients: vec![1.0], potential_at_origin: 0.0 };
        ForceCurve::from_pieces(vec![flat; pieces], vec![0.0], domain, false, None).unwrap_err()
    };
    assert_eq!(wrong(3, (-1.0, 1.0)), FunctionError::Pieces(3, 1, -1.0, 1.0));
    assert_eq!(wrong(2, (1.0, -1.0)), FunctionError::Pieces(2, 1, 1.0, -1.0));
}
