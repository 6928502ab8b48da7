//! The prototype's numbers: established with other codes, in `check` to the printed digits, and beside the
//! table of a solid model.

use interwell::mechanics::{ForceTable, Landscape, fit};

use super::*;

fn landscape(geometry: &Geometry) -> (ForceCurve, Landscape) {
    let (curve, _) = solve(geometry);
    let landscape = Landscape::of(&curve);
    (curve, landscape)
}

fn pull(geometry: &Geometry) -> f64 {
    -landscape(geometry).1.extrema.last().unwrap().force
}

#[test]
fn its_curve() {
    let (curve, landscape) = landscape(&prototype());
    near(curve.stiffness(0.0), -71.6, 0.05);
    let most = landscape.extrema.last().unwrap();
    near(most.force, -0.197, 5e-4);
    near(most.x, 4.15e-3, 5e-6);
    let [left, right] = landscape.kinks[..] else { panic!("{:?}", landscape.kinks) };
    assert_eq!(left.x, -right.x);
    near(right.x, 7.18e-3, 5e-6);
    near(right.stiffness_left, 137.0, 0.5);
    near(right.stiffness_right, 4000.0, 50.0);
    near(landscape.barrier.unwrap().from_right_j, 0.925e-3, 5e-7);
    let well = landscape.right_stable().unwrap();
    near(well.x - right.x, 2e-6, 0.5e-6);
    assert_eq!(landscape.damping_stiffness(), Some(right.stiffness_left));
    near(curve.force(8e-3), 25.0, 2.5);
    assert_eq!(landscape.equilibria.len(), 3);
    // Not the S-shaped branch.
    near(curve.force(4e-3), -0.1965, 5e-4);
    // One odd polynomial between the kinks.
    assert!(!curve.breaks().iter().any(|b| b.abs() < right.x));
    assert!(curve.pieces()[curve.piece_index(0.0)].coefficients.iter().step_by(2).all(|c| *c == 0.0));
    // Its coefficients fall off as a smooth function's do.
    assert!(curve.max_degree() <= 13);
}

#[test]
fn its_axial_force() {
    let (_, flexures) = solve(&prototype());
    near(flexures.state(0.0).unwrap().axial, 5.82, 5e-3);
}

#[test]
fn without_preload_it_has_one_well() {
    let (curve, landscape) = landscape(&Geometry { preload: 0.0, ..prototype() });
    near(curve.stiffness(0.0), 493.0, 0.5);
    assert_eq!((landscape.equilibria.len(), landscape.kinks.len(), landscape.barrier), (1, 0, None));
    near_relative(curve.domain().1, 2.6e-3, 1e-12);
}

/// Straight beams sway first, at 1.315 um of preload, and buckle into a bump at 1.377 um.
#[test]
fn two_wells_before_a_bump() {
    let at = |um: f64| landscape(&Geometry { preload: um * 1e-6, ..prototype() }).1;
    for (um, wells, kinks) in [(1.30, 1, 0), (1.313, 1, 0), (1.317, 2, 0), (1.374, 2, 0), (1.38, 2, 2)] {
        let landscape = at(um);
        let stable = landscape.equilibria.iter().filter(|e| e.stable).count();
        assert_eq!((stable, landscape.kinks.len()), (wells, kinks), "{um} um: {landscape:?}");
    }
}

#[test]
fn it_is_sensitive() {
    let mut longer = prototype();
    longer.parallel.length *= 1.01;
    near(pull(&longer) / pull(&prototype()), 1.23, 0.01);
    let bowed = Geometry { initial_bow: 1e-4, ..prototype() };
    near(pull(&bowed) / pull(&prototype()), 0.75, 0.03);
    // The kink is rounded away.
    assert!(landscape(&bowed).1.kinks.is_empty());
    // On either side: a smaller bow does less.
    let slight = Geometry { initial_bow: 1e-5, ..prototype() };
    assert!(pull(&bowed) < pull(&slight) && pull(&slight) < pull(&prototype()));
}

#[test]
fn a_vanishing_bow_changes_nothing_but_the_corner() {
    let (curve, _) = solve(&prototype());
    for bow in [1e-6, 1e-8, 1e-10] {
        let (bowed, _) = solve(&Geometry { initial_bow: bow, ..prototype() });
        for i in 0..60 {
            let x = 8.2e-3 * f64::from(i) / 60.0;
            // Beside the corner as the root of the bow, elsewhere as the bow itself.
            let allowed = 1e-6 + 1e3 * bow.powf(2.0 / 3.0);
            near(bowed.force(x), curve.force(x), allowed * curve.force(x).abs().max(1.0));
        }
    }
}

/// An independent model of the solid. The beams leave out what wide strips do sideways, which moves the wells
/// by 0.3 mm and with them the force between 5 mm and there.
#[test]
fn a_solid_model_is_near() {
    let table = ForceTable::parse(super::super::PROTOTYPE).unwrap();
    let solid = fit(&table, 1e-4).unwrap();
    let (curve, landscape) = landscape(&prototype());
    for i in 0..=50 {
        let x = 1e-4 * f64::from(i);
        near(curve.force(x), solid.force(x), 0.07 * 0.203);
    }
    near_relative(pull(&prototype()), 0.203, 0.04);
    near_relative(landscape.right_stable().unwrap().x, 6.88e-3, 0.05);
}

/// The stiffness that a damping ratio means is that inside the kink wherever the well lies, so that it
/// follows the preload smoothly.
#[test]
fn the_damping_stiffness_follows_the_preload() {
    let stiffness = |mm: f64| {
        let landscape = landscape(&Geometry { preload: mm * 1e-3, ..prototype() }).1;
        landscape.damping_stiffness().unwrap()
    };
    let all: Vec<f64> = (0..=40).map(|i| stiffness(1.0 + 0.05 * f64::from(i))).collect();
    for (i, three) in all.windows(3).enumerate() {
        let bend = (three[0] - 2.0 * three[1] + three[2]).abs();
        assert!(bend < 0.02 * three[1], "{i}: {three:?}");
    }
}
