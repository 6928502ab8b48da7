//! Polynomial force curves: exact landscapes, independence of the unit of length, touching roots.

use interwell::mechanics::Landscape;
use interwell::scene;
use proptest::prelude::*;

use super::{build, close, fault_of, polynomial};

#[test]
fn a_cubic_has_its_exact_landscape() {
    let mechanism = build(scene::Mechanism::Cubic { linear_n_per_m: -40.0, cubic_n_per_m3: 40.0 / 49e-6 });
    assert_eq!(mechanism.curve.pieces().len(), 1);
    assert!(mechanism.curve.is_odd());
    assert_eq!(mechanism.curve.domain(), (f64::NEG_INFINITY, f64::INFINITY));
    let [left, top, right] = mechanism.landscape.equilibria[..] else { panic!("{:?}", mechanism.landscape) };
    close(right.x, 7e-3, 1e-15);
    assert_eq!(left.x, -right.x);
    assert_eq!(top.x, 0.0);
    assert!(left.stable && right.stable && !top.stable);
    close(right.stiffness_left, 80.0, 1e-14);
    assert_eq!(right.stiffness_left, right.stiffness_right);
    assert_eq!(top.stiffness_left, -40.0);
    let barrier = mechanism.landscape.barrier.unwrap();
    close(barrier.from_right_j, 10.0 * 49e-6, 1e-14);
    assert_eq!(barrier.from_left_j, barrier.from_right_j);
    assert_eq!((barrier.x, barrier.left_well, barrier.right_well), (0.0, left.x, right.x));
    let [most, least] = mechanism.landscape.extrema[..] else { panic!("{:?}", mechanism.landscape) };
    close(least.x, 7e-3 / 3.0_f64.sqrt(), 1e-14);
    close(most.force, 40.0 * 7e-3 * 2.0 / (3.0 * 3.0_f64.sqrt()), 1e-14);
    assert_eq!((most.x, most.force), (-least.x, -least.force));
    assert!(mechanism.landscape.kinks.is_empty());
    close(mechanism.damping_stiffness().unwrap(), 80.0, 1e-14);
    assert_eq!(mechanism.landscape.crossing_position(), Some(0.0));
}

#[test]
fn a_double_well_has_the_wells_and_the_barrier_it_names() {
    let mechanism = build(scene::Mechanism::DoubleWell { equilibrium_mm: 7.0, barrier_mj: 0.5 });
    close(mechanism.landscape.right_stable().unwrap().x, 7e-3, 1e-14);
    close(mechanism.landscape.barrier.unwrap().from_left_j, 0.5e-3, 1e-14);
    close(mechanism.damping_stiffness().unwrap(), 8.0 * 0.5e-3 / 49e-6, 1e-13);
}

#[test]
fn scaling_the_unit_of_length_scales_the_landscape() {
    for scale in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
        // F(x/scale): the wells -2, 0.5 and 3 with tops -1 and 1.
        let force = product(&[-2.0, -1.0, 0.5, 1.0, 3.0]);
        let scaled: Vec<f64> = force.iter().enumerate().map(|(i, c)| c / scale_power(scale, i)).collect();
        let mechanism = polynomial(&scaled);
        let found: Vec<f64> = mechanism.landscape.equilibria.iter().map(|e| e.x / scale).collect();
        assert_eq!(found.len(), 5, "{scale:e}: {found:?}");
        for (f, e) in found.iter().zip([-2.0, -1.0, 0.5, 1.0, 3.0]) {
            assert!((f - e).abs() < 1e-12, "{scale:e}: {found:?}");
        }
        let stable: Vec<bool> = mechanism.landscape.equilibria.iter().map(|e| e.stable).collect();
        assert_eq!(stable, [true, false, true, false, true]);
        assert_eq!(mechanism.landscape.extrema.len(), 4);
        let barrier = mechanism.landscape.barrier.unwrap();
        assert!((barrier.x / scale).abs() < 1.0 + 1e-12, "the one nearest to 0: {barrier:?}");
    }
}

fn scale_power(scale: f64, i: usize) -> f64 {
    (0..i).fold(1.0, |p, _| p * scale)
}

fn product(roots: &[f64]) -> Vec<f64> {
    roots.iter().fold(vec![1.0], |p, r| {
        let mut next = vec![0.0; p.len() + 1];
        for (i, c) in p.iter().enumerate() {
            next[i + 1] += c;
            next[i] -= r * c;
        }
        next
    })
}

#[test]
fn a_touching_is_an_equilibrium_but_not_a_stable_one() {
    // (x - 1)^2 (x + 1): stable nowhere but at -1.
    let mechanism = polynomial(&product(&[1.0, 1.0, -1.0]));
    let found: Vec<(f64, bool)> = mechanism.landscape.equilibria.iter().map(|e| (e.x, e.stable)).collect();
    assert_eq!(found, [(-1.0, true), (1.0, false)]);
    assert_eq!(mechanism.landscape.barrier, None);
}

#[test]
fn a_cubic_well_is_stable_without_stiffness() {
    let mechanism = polynomial(&[0.0, 0.0, 0.0, 2.0]);
    assert_eq!(mechanism.landscape.equilibria.len(), 1);
    assert!(mechanism.landscape.right_stable().unwrap().stable);
    assert_eq!(mechanism.damping_stiffness(), None);
    assert!(mechanism.landscape.extrema.is_empty(), "a level point is no extremum");
}

#[test]
fn no_force_and_a_constant_force_have_no_landscape() {
    for coefficients in [&[][..], &[0.0], &[0.0, 0.0, 0.0], &[9.81]] {
        let mechanism = polynomial(coefficients);
        assert_eq!(mechanism.landscape, Landscape::default());
        assert_eq!(mechanism.damping_stiffness(), None);
        assert_eq!(mechanism.landscape.crossing_position(), None);
    }
    assert!(polynomial(&[]).curve.is_odd());
    assert!(!polynomial(&[9.81]).curve.is_odd());
}

#[test]
fn too_many_coefficients_are_a_fault() {
    let described = scene::Mechanism::Polynomial { coefficients_si: vec![1.0; 17] };
    let fault = fault_of(&described);
    assert_eq!(fault.field, "mechanism.coefficients_si");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]
    /// The landscape of a polynomial is complete and alternates.
    #[test]
    fn polynomials_alternate(coefficients in prop::collection::vec(-2.0..2.0_f64, 1..10)) {
        let mechanism = polynomial(&coefficients);
        for pair in mechanism.landscape.equilibria.windows(2) {
            prop_assert!(pair[0].x < pair[1].x);
            prop_assert!(!(pair[0].stable && pair[1].stable));
        }
        let sign = |i: i32| mechanism.curve.force(f64::from(i) * 0.01).signum();
        let changes = (-1000..1000).filter(|i| sign(*i) * sign(i + 1) < 0.0);
        prop_assert!(mechanism.landscape.equilibria.len() >= changes.count());
    }
}
