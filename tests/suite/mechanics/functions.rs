//! Curves of functions: their errors against the function, their corners, and their form in a scene.

use interwell::mechanics::{ForceCurve, FunctionError, Mechanism};
use interwell::scene::{Document, Files};
use proptest::prelude::*;

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
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

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
        let named = ForceCurve::from_fn(force, (-0.01, 0.01), 1e-6, &[at]).unwrap();
        prop_assert_eq!(named.breaks(), &[at]);
        let (before, after) = named.stiffness_on_both_sides(at);
        prop_assert!((before - left).abs() < 1e-6 * left.abs() && (after - right).abs() < 1e-6 * right);
        let kinks = &Mechanism::new(named).landscape.kinks;
        prop_assert!(kinks.len() == 1 && kinks[0].x == at);
    }
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
}
