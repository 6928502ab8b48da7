//! Landscapes of curves with kinks: equilibria on or beside a kink and the stiffness that damping and scales
//! refer to.

use std::sync::Arc;

use interwell::dynamics::{Model, Scales};
use interwell::mechanics::{Equilibrium, ForceCurve, Kink, Landscape, Mechanism, Piece};
use interwell::scene::{Document, Files};

use super::{PROTOTYPE, close};

/// Straight lines through the given points.
fn chain(points: &[(f64, f64)]) -> ForceCurve {
    let pieces = points
        .windows(2)
        .map(|p| Piece {
            origin: p[0].0,
            coefficients: vec![p[0].1, (p[1].1 - p[0].1) / (p[1].0 - p[0].0)],
            potential_at_origin: 0.0,
        })
        .collect();
    let breaks = points[1..points.len() - 1].iter().map(|p| p.0).collect();
    ForceCurve::from_pieces(pieces, breaks, (points[0].0, points[points.len() - 1].0), false, None).unwrap()
}

#[test]
fn an_equilibrium_may_lie_on_a_corner() {
    let landscape =
        Landscape::of(&chain(&[(-2.0, -4.0), (-1.0, 0.0), (0.0, 1.0), (1.0, 0.0), (2.0, -1.0), (3.0, 5.0)]));
    let found: Vec<(f64, bool)> = landscape.equilibria.iter().map(|e| (e.x, e.stable)).collect();
    assert_eq!(found.len(), 3, "{found:?}");
    assert_eq!(found[..2], [(-1.0, true), (1.0, false)]);
    close(found[2].0, 2.0 + 1.0 / 6.0, 1e-15);
    assert_eq!((landscape.equilibria[0].stiffness_left, landscape.equilibria[0].stiffness_right), (4.0, 1.0));
    let extrema: Vec<f64> = landscape.extrema.iter().map(|e| e.x).collect();
    assert_eq!(extrema, [0.0, 2.0]);
    let barrier = landscape.barrier.unwrap();
    close(barrier.from_left_j, 1.0, 1e-15);
    assert_eq!(landscape.kinks.len(), 3, "{:?}", landscape.kinks);
}

#[test]
fn the_ends_of_the_domain_are_known_from_one_side() {
    let landscape = Landscape::of(&chain(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)]));
    let found: Vec<(f64, bool)> = landscape.equilibria.iter().map(|e| (e.x, e.stable)).collect();
    assert_eq!(found, [(0.0, false), (2.0, false)]);
    assert!(landscape.equilibria[0].stiffness_left.is_nan());
    assert_eq!(landscape.equilibria[0].stiffness_right, 1.0);
}

#[test]
fn the_damping_stiffness_does_not_jump_while_an_equilibrium_crosses_a_corner() {
    let landscape = |shift: f64| {
        Landscape::of(&chain(&[(-1.0, 1.0), (1.0, -1.0 + shift), (2.0, 1.0 + shift), (3.0, 40.0 + shift)]))
    };
    // The well at 1.5 - shift/2, then on the corner at 2, then beyond.
    let before = landscape(-1.0 + 1e-9);
    assert_eq!(before.kinks.len(), 2);
    for shift in [-0.9, -1.0 + 1e-9, -1.0, -1.0 - 1e-9, -1.1] {
        let shifted = landscape(shift);
        let well = shifted.right_stable().unwrap();
        assert_eq!(well.x > 2.0, shift < -1.0);
        close(shifted.damping_stiffness().unwrap(), 2.0, 1e-12);
    }
}

#[test]
fn either_well_has_its_own_inner_stiffness() {
    let landscape = Landscape::of(&chain(&[
        (-3.0, -4.0),
        (-2.0, 0.5),
        (-1.0, 1.0),
        (1.0, -1.0),
        (2.0, -0.1),
        (3.0, 40.0),
    ]));
    let inner: Vec<f64> =
        landscape.equilibria.iter().filter(|e| e.stable).map(|e| landscape.inner_stiffness(e)).collect();
    // The left well lies beyond its corner at -2, the right one beyond that at 2.
    assert_eq!(inner.len(), 2);
    close(inner[0], 0.5, 1e-12);
    close(inner[1], 0.9, 1e-12);
}

#[test]
fn the_damping_stiffness_looks_inward_from_either_side() {
    let well = |x: f64, left: f64, right: f64| Equilibrium {
        x,
        stable: true,
        stiffness_left: left,
        stiffness_right: right,
    };
    let corner = |x: f64, left: f64, right: f64| Kink { x, stiffness_left: left, stiffness_right: right };
    let of = |w: Equilibrium, kinks: Vec<Kink>| {
        Landscape { equilibria: vec![w], kinks, ..Default::default() }.damping_stiffness()
    };
    assert_eq!(of(well(1.0, 5.0, 5.0), vec![corner(2.0, 7.0, 9.0)]), Some(5.0));
    assert_eq!(of(well(1.0, 5.0, 5.0), vec![corner(0.99, 3.0, 5.0)]), Some(3.0));
    assert_eq!(of(well(1.0, 5.0, 5.0), vec![corner(0.5, -3.0, 5.0)]), Some(5.0));
    assert_eq!(of(well(1.0, 3.0, 5.0), vec![corner(1.0, 3.0, 5.0)]), Some(3.0));
    assert_eq!(of(well(-1.0, 5.0, 3.0), vec![corner(-1.0, 5.0, 3.0)]), Some(3.0));
    assert_eq!(of(well(-1.0, 5.0, 5.0), vec![corner(-0.9, 5.0, 2.0)]), Some(2.0));
    assert_eq!(of(well(0.0, 3.0, 5.0), vec![corner(0.0, 3.0, 5.0)]), Some(3.0));
    assert_eq!(of(well(1.0, 0.0, 0.0), vec![]), None);
}

/// An odd curve with a kink at 1, slopes `inner` and `outer` there, and the well `past` beyond it.
fn kinked(inner: f64, outer: f64, past: f64) -> Mechanism {
    // a x + b x^3 inside, a straight line outside.
    let (force, slope) = (-outer * past, inner);
    let b = 0.5 * (slope - force);
    let a = force - b;
    let piece = |origin, coefficients| Piece { origin, coefficients, potential_at_origin: 0.0 };
    let right = piece(1.0, vec![force, outer]);
    let pieces = vec![right.mirrored(), piece(0.0, vec![0.0, a, 0.0, b]), right];
    Mechanism::new(ForceCurve::from_pieces(pieces, vec![-1.0, 1.0], (-2.0, 2.0), true, None).unwrap())
}

#[test]
fn a_kink_beside_a_well_gives_it_two_stiffnesses() {
    for past in [1e-4, 9e-3, 0.0] {
        let landscape = kinked(137.0, 4000.0, past).landscape;
        let kink = landscape.kink_at_right_well().unwrap();
        close(kink.inner, 137.0, 1e-12);
        close(kink.outer, 4000.0, 1e-12);
        assert_eq!(landscape.damping_kink().map(|kink| kink.x), Some(1.0));
        close(landscape.damping_stiffness().unwrap(), 137.0, 1e-12);
    }
    // Far beyond the kink a small pluck does not meet it; the ratio still means the inner slope.
    let landscape = kinked(137.0, 4000.0, 0.02).landscape;
    assert_eq!(landscape.kink_at_right_well(), None);
    close(landscape.damping_stiffness().unwrap(), 137.0, 1e-12);
    // Just inside it, the slope that counts is that of the well itself, and the kink is still beside it.
    let landscape = kinked(137.0, 4000.0, -1e-4).landscape;
    assert!(landscape.right_stable().unwrap().x < 1.0);
    assert_eq!(landscape.damping_kink(), None);
    close(landscape.kink_at_right_well().unwrap().inner, 137.0, 1e-12);
    // Well inside it, as in the prototype's table.
    let table = Mechanism::from_table(PROTOTYPE, 1e-4).unwrap().landscape;
    assert_eq!((table.kink_at_right_well(), table.damping_kink()), (None, None));
}

#[test]
fn the_scales_do_not_jump_while_a_well_crosses_its_kink() {
    // All that a run in the unit of 1 m is relative to, beside the tolerance: it follows the well, by
    // micrometres, and the slope inside the kink, 137 N/m, not the wall of 4000 N/m in which the well lies
    // once it is beyond.
    let text = "(title: \"t\", mass_g: 15.2, mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1), \
                damping: Ratio(0.023), run: (duration_s: 1))";
    let scene = Document::from_text("t", text, Files::default()).unwrap().scene;
    let scales = |past: f64| -> Scales {
        Model::build(&scene, Arc::new(kinked(137.0, 4000.0, past))).unwrap().scales()
    };
    let at = scales(0.0);
    for past in [-1e-6, -1e-9, 1e-9, 1e-6] {
        let moved = scales(past);
        close(moved.length, at.length, 1e-4);
        close(moved.speed, at.speed, 1e-4);
        close(moved.time, at.time, 1e-4);
    }
    close(at.time, (15.2e-3_f64 / 137.0).sqrt(), 1e-9);
}
