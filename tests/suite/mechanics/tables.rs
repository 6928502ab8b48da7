//! Curves fitted to synthetic tables: recovered polynomials, symmetry, corners, noise and extreme numbers.

use interwell::mechanics::{ForceTable, Landscape, Mechanism, fit, force_scale};
use proptest::prelude::*;

use super::{PROTOTYPE, close, keeps_its_promises, sampled};

#[test]
fn a_sampled_cubic_is_recovered() {
    let cubic = |x: f64| -40.0 * x + 8e5 * x * x * x;
    let curve = keeps_its_promises(&sampled(-9e-3, 9e-3, 61, cubic), 1e-4);
    assert_eq!((curve.pieces().len(), curve.max_degree(), curve.is_odd()), (1, 3, true));
    close(curve.pieces()[0].coefficients[1], -40.0, 1e-12);
    close(curve.pieces()[0].coefficients[3], 8e5, 1e-12);
    // Not odd, and as few points as there may be.
    let slanted = |x: f64| 3.0 - 2.0 * x + x * x * x;
    let curve = keeps_its_promises(&sampled(-1.0, 2.0, 4, slanted), 1e-6);
    assert_eq!((curve.pieces().len(), curve.max_degree(), curve.is_odd()), (1, 3, false));
    assert!((curve.force(0.37) - slanted(0.37)).abs() < 1e-13);
}

#[test]
fn an_even_number_of_odd_samples_is_odd_too() {
    let curve = keeps_its_promises(&sampled(-1.0, 1.0, 40, |x| x * x * x - 0.4 * x), 1e-4);
    assert!(curve.is_odd());
    assert_eq!(curve.pieces().len(), 1);
    assert_eq!(curve.force(0.0), 0.0);
}

#[test]
fn data_that_are_odd_but_for_noise_below_the_tolerance_are_odd() {
    let noise = |x: f64| 1e-5 * (1e4 * x).sin().abs();
    let table = sampled(-1.0, 1.0, 101, |x| x * x * x - 0.4 * x + noise(x));
    assert!(keeps_its_promises(&table, 1e-3).is_odd());
    assert!(!keeps_its_promises(&table, 1e-5).is_odd());
}

#[test]
fn extrema_below_the_error_of_a_fit_are_none() {
    // a plateau with ripple of 1e-5 in it, between two walls, and a hump of its own
    for hump in [0.0, 2e-2] {
        let force =
            |x: f64| x.powi(9) + 0.2 * x - hump * (20.0 * x).sin() + 1e-5 * (1e3 * x * x + 400.0 * x).sin();
        let table = sampled(-1.0, 1.2, 401, |x| if hump == 0.0 { force(x) - 0.2 * x } else { force(x) });
        let curve = keeps_its_promises(&table, 1e-4);
        let error = curve.fit().unwrap().worst_n;
        let extrema = Landscape::of(&curve).extrema;
        for pair in extrema.windows(2) {
            assert!((pair[0].force - pair[1].force).abs() > 2.0 * error, "{pair:?} {error}");
        }
        assert_eq!(extrema.is_empty(), hump == 0.0, "{extrema:?}");
    }
}

#[test]
fn a_corner_on_a_sample_is_found_and_one_between_samples_is_bracketed() {
    let bent =
        |at: f64| move |x: f64| if x > at { 5.0 * (x - at) + (x - at).powi(2) } else { 0.5 * (x - at) };
    let curve = keeps_its_promises(&sampled(-1.0, 1.0, 41, bent(0.25)), 1e-4);
    let corners = Landscape::of(&curve).kinks;
    assert_eq!(corners.len(), 1, "{corners:?}");
    assert_eq!(curve.pieces().len(), 2);
    assert!((corners[0].x - 0.25).abs() < 1e-15);
    close(corners[0].stiffness_left, 0.5, 1e-9);
    close(corners[0].stiffness_right, 5.0, 1e-9);
    let curve = keeps_its_promises(&sampled(-1.0, 1.0, 41, bent(0.27)), 1e-4);
    assert!(curve.pieces().len() <= 4, "{:?}", curve.breaks());
    assert!(curve.breaks().iter().all(|b| (b - 0.27).abs() < 0.1), "{:?}", curve.breaks());
}

#[test]
fn smooth_tables_have_no_corners() {
    type Shape = fn(f64) -> f64;
    let shapes: [Shape; 5] = [
        |x| (3.0 * x).sin(),
        |x| x.exp() - 1.0,
        |x| (5.0 * x).tanh() - x,
        |x| 1.0 / (1.2 - x),
        |x| (x + 1.01).ln(),
    ];
    for (i, shape) in shapes.into_iter().enumerate() {
        for points in [12, 20, 40, 150, 1000] {
            for tolerance in [1e-2, 1e-4, 1e-6, 1e-9] {
                let curve = keeps_its_promises(&sampled(-1.0, 1.0, points, shape), tolerance);
                let corners = Landscape::of(&curve).kinks;
                assert!(corners.is_empty(), "shape {i}, {points} points, {tolerance:e}: {corners:?}");
                let error = (0..=5000)
                    .map(|k| -1.0 + k as f64 / 2500.0)
                    .map(|x| (curve.force(x) - shape(x)).abs())
                    .fold(0.0, f64::max);
                if points >= 150 && i < 3 {
                    let allowed = 3.0 * tolerance * curve.fit().unwrap().scale_n + 1e-7;
                    assert!(error < allowed, "shape {i}, {points} points, {tolerance:e}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn a_monostable_table_is_relative_to_its_largest_force() {
    let table = sampled(-1.0, 2.0, 31, |x| 3.0 * x + 0.1 * x * x);
    assert_eq!(force_scale(&table), 6.4);
    let curve = keeps_its_promises(&table, 1e-4);
    let mechanism = Mechanism::new(curve);
    assert_eq!(mechanism.landscape.equilibria.len(), 1);
    close(mechanism.damping_stiffness().unwrap(), 3.0, 1e-9);
    assert!((mechanism.landscape.crossing_position().unwrap()).abs() < 1e-12);
}

#[test]
fn noise_about_zero_makes_no_wells() {
    let mut state = 1_u64;
    let mut noise = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut table = sampled(-1.0, 1.0, 501, |x| 2.0 * x.powi(3));
    table.force.iter_mut().for_each(|f| *f += 1e-2 * noise());
    assert!(force_scale(&table) > 1.9);
    let curve = keeps_its_promises(&table, 1e-2);
    assert!(curve.pieces().len() <= 3, "{}", curve.pieces().len());
    // Asked to follow the noise, it does, and says so.
    let rough = keeps_its_promises(&table, 1e-5);
    assert!(rough.fit().unwrap().warnings.iter().any(|w| w.contains("pieces")), "{:?}", rough.fit());
}

#[test]
fn no_force_at_all_is_a_table_too() {
    let curve = keeps_its_promises(&sampled(-1.0, 1.0, 11, |_| 0.0), 1e-4);
    assert_eq!(Landscape::of(&curve), Landscape::default());
    // A dead zone between two springs: the force vanishes on an interval, which is no equilibrium.
    let dead = |x: f64| if x.abs() < 0.5 { 0.0 } else { 4.0 * (x - 0.5 * x.signum()) };
    let mechanism = Mechanism::new(keeps_its_promises(&sampled(-1.0, 1.0, 41, dead), 1e-4));
    assert!(mechanism.landscape.equilibria.is_empty(), "{:?}", mechanism.landscape.equilibria);
    assert_eq!(mechanism.landscape.kinks.len(), 2);
}

#[test]
fn the_unit_of_the_table_does_not_matter() {
    let table = ForceTable::parse(PROTOTYPE).unwrap();
    let pieces = fit(&table, 1e-4).unwrap().breaks().to_vec();
    for (length, force) in [(1e-9, 1.0), (1e9, 1e-6), (1e3, 1e12)] {
        let scaled = ForceTable {
            x: table.x.iter().map(|x| x * length).collect(),
            force: table.force.iter().map(|f| f * force).collect(),
        };
        let curve = keeps_its_promises(&scaled, 1e-4);
        assert_eq!(curve.breaks().len(), pieces.len());
        for (a, b) in curve.breaks().iter().zip(&pieces) {
            close(*a, b * length, 1e-14);
        }
    }
}

#[test]
fn a_large_table_is_fitted() {
    let table = sampled(-1.0, 1.0, 100_000, |x| (7.0 * x).sin() + x.abs().powi(3));
    let curve = keeps_its_promises(&table, 1e-4);
    assert!(curve.pieces().len() < 12, "{}", curve.pieces().len());
}

#[test]
fn millimetres_draw_a_warning() {
    let table = sampled(-8.0, 8.0, 33, |x| x * x * x - 40.0 * x);
    let curve = keeps_its_promises(&table, 1e-4);
    let [warning] = &curve.fit().unwrap().warnings[..] else { panic!("{:?}", curve.fit()) };
    assert!(warning.contains("-8 m to 8 m"), "{warning}");
    assert!(warning.contains("divide"), "{warning}");
}

#[test]
fn numbers_at_the_ends_of_the_range_are_an_answer_or_an_error() {
    let mut fitted = 0;
    for length in [1e-300, 1e-150, 1e150, 1e300] {
        for force in [1e-300, 1e300] {
            let table = sampled(-length, length, 12, |x| force * ((x / length).powi(3) - 0.3 * x / length));
            if let Ok(curve) = fit(&table, 1e-4) {
                fitted += 1;
                assert!(curve.pieces().iter().all(|p| p.coefficients.iter().all(|c| c.is_finite())));
                Landscape::of(&curve);
            }
        }
    }
    assert!(fitted >= 1, "{fitted} of 8");
}

#[test]
fn a_position_far_off_is_met_as_well() {
    for far in [1e3, 1e9, 1e17, 1e61, 1e150] {
        for force in [4.0, -0.5] {
            let text = format!("x_m,force_n\n2,1\n4,2\n5,4\n{far},{force}\n");
            let curve = fit(&ForceTable::parse(&text).unwrap(), 1e-4).unwrap();
            assert!(curve.fit().unwrap().worst_n <= 1e-4 * 4.0, "{:?} at {far}", curve.fit());
        }
    }
}

fn text_of(table: &ForceTable) -> String {
    let rows = table.x.iter().zip(&table.force).map(|(x, f)| format!("{x},{f}\n"));
    "x_m,force_n\n".chars().chain(rows.collect::<String>().chars()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]
    /// Random tables, smooth or not, are followed or refused; the landscape agrees with the signs of the
    /// force.
    #[test]
    fn any_table_is_followed(
        steps in prop::collection::vec(1e-3..1.0_f64, 4..60),
        rough in prop::collection::vec(-1.0..1.0_f64, 60),
        roughness in prop::sample::select(vec![0.0, 1e-6, 1e-3, 1.0]),
        digits in 1..8_i32,
    ) {
        let mut x = -0.3 * steps.iter().sum::<f64>();
        let mut table = ForceTable { x: Vec::new(), force: Vec::new() };
        for (step, r) in steps.iter().zip(&rough) {
            x += step;
            table.x.push(x);
            table.force.push((1.3 * x).sin() + 0.02 * x * x + roughness * r);
        }
        let curve = keeps_its_promises(&table, 10.0_f64.powi(-digits));
        let read = ForceTable::parse(&text_of(&table));
        prop_assert_eq!(read.as_ref(), Ok(&table));
        let landscape = Landscape::of(&curve);
        let mut last = (curve.domain().0, curve.force(curve.domain().0));
        for i in 1..=400 {
            let at = curve.domain().0 + (curve.domain().1 - curve.domain().0) * f64::from(i) / 400.0;
            let at = at.min(curve.domain().1);
            let force = curve.force(at);
            if last.1 * force < 0.0 {
                prop_assert!(landscape.equilibria.iter().any(|e| e.x >= last.0 && e.x <= at));
            }
            last = (at, force);
        }
        for e in &landscape.equilibria {
            prop_assert!(curve.force(e.x).abs() <= 1e-10 * (1.0 + roughness));
        }
    }
}
