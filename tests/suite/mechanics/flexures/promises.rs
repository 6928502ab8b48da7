//! Promised accuracy at many places of which no curve was made.

use super::verdict::Verdict;
use super::*;

/// Evenly spread and yet in step with nothing: the golden ratio's multiples.
fn places(count: usize) -> Vec<f64> {
    (1..=count).map(|i| (i as f64 * 0.618_033_988_749_894_9).fract()).collect()
}

#[track_caller]
fn holds(geometry: &Geometry, tolerance: f64, count: usize) {
    let solved = Flexures::solve(geometry, tolerance).unwrap_or_else(|e| panic!("{e}\n{geometry:?}"));
    let verdict = Verdict::of(geometry, tolerance, &solved, &places(count));
    assert!(verdict.faults.is_empty(), "tolerance {tolerance:e}, {geometry:?}\n{:#?}", verdict.faults);
}

#[test]
fn the_prototype_at_every_tolerance() {
    for tolerance in [1e-6, 1e-7, 1e-8, 1e-9] {
        holds(&prototype(), tolerance, 300);
    }
}

#[test]
fn one_well_and_bows() {
    for tolerance in [1e-6, 1e-8] {
        holds(&Geometry { preload: 0.0, ..prototype() }, tolerance, 100);
        holds(&Geometry { preload: 1.35e-6, ..prototype() }, tolerance, 100);
        for bow in [1e-6, 1e-4, 1e-3] {
            holds(&Geometry { initial_bow: bow, ..prototype() }, tolerance, 100);
        }
    }
}

/// Geometries that were hard once. The wells lie beyond 1.15 times the kink; the pair buckles; the slope
/// bends away from what the force's error shows; the wells are shallow and near the middle.
#[test]
fn hard_ones() {
    let group = |count, length, width| Group { count, length, width };
    let shaped = |preload, thickness, parallel, buckling| Geometry {
        preload,
        thickness,
        parallel,
        buckling,
        ..prototype()
    };
    let thick = shaped(0.35e-3, 0.31e-3, group(1, 8.84e-3, 9.15e-3), group(1, 5.88e-3, 1.78e-3));
    let soft_pair = shaped(1e-3, 5e-5, group(2, 60e-3, 20e-3), group(1, 8e-3, 2e-3));
    let shallow = shaped(3.7058e-3, 48.65e-6, group(2, 30.28e-3, 2.302e-3), group(1, 30.06e-3, 37.05e-3));
    let bowed = Geometry {
        initial_bow: 0.2e-3,
        ..shaped(11.2e-3, 75e-6, group(4, 97e-3, 1.44e-3), group(1, 87.5e-3, 1.31e-3))
    };
    for geometry in [thick, soft_pair, shallow, bowed] {
        holds(&geometry, 1e-6, 60);
        holds(&geometry, 1e-8, 60);
    }
}

/// Wells beyond the kink are on the curve, with room behind them.
#[test]
fn the_curve_reaches_its_wells() {
    let geometry = Geometry {
        preload: 0.35e-3,
        thickness: 0.31e-3,
        parallel: Group { count: 1, length: 8.84e-3, width: 9.15e-3 },
        buckling: Group { count: 1, length: 5.88e-3, width: 1.78e-3 },
        ..prototype()
    };
    let (curve, _) = solve(&geometry);
    let landscape = Mechanism::new(curve.clone()).landscape;
    let well = landscape.right_stable().expect("two wells").x;
    assert!(well > 1.15 * landscape.kinks[1].x && curve.domain().1 > 1.09 * well);
}

/// At the kink a state has the inner stiffness, whatever the rounding of its position.
#[test]
fn a_state_at_the_kink_is_the_inner_one() {
    for i in 0..200 {
        let mut geometry = prototype();
        geometry.preload = (1.0 + 0.01 * f64::from(i)) * 1e-3;
        geometry.buckling.length = 27.7e-3 + 1e-5 * f64::from(i % 17);
        let (curve, flexures) = solve(&geometry);
        let kink = Mechanism::new(curve).landscape.kinks[1];
        let state = flexures.state(kink.x).unwrap();
        near_relative(state.stiffness, kink.stiffness_left, 1e-4);
        assert_eq!(flexures.state(-kink.x).unwrap().stiffness, state.stiffness);
    }
}

/// What is reported is not better than what is found at other places by more than a small factor.
#[test]
fn reported_errors_are_the_errors() {
    for (geometry, tolerance) in [
        (prototype(), 1e-6),
        (prototype(), 1e-8),
        (Geometry { initial_bow: 1e-4, ..prototype() }, 1e-8),
        (Geometry { preload: 0.5e-3, ..prototype() }, 1e-7),
    ] {
        let (curve, flexures) = Flexures::solve(&geometry, tolerance).unwrap();
        let landscape = Mechanism::new(curve.clone()).landscape;
        let inside = landscape.kinks.last().map_or(landscape.right_stable().unwrap().x, |kink| kink.x);
        let pull = landscape.extrema.last().unwrap().force.abs();
        let (mut force, mut stiffness) = (0.0_f64, 0.0_f64);
        for place in places(150) {
            let state = flexures.state(place * inside).unwrap();
            force = force.max((curve.force(state.x) - state.force).abs() / pull);
            let off = (curve.stiffness(state.x) - state.stiffness).abs();
            stiffness = stiffness.max(off / curve.stiffness(0.0).abs());
        }
        let accuracy = flexures.accuracy();
        assert!(force < 3.0 * accuracy.force, "{force:e} {accuracy:?}");
        assert!(stiffness < 5.0 * accuracy.stiffness, "{stiffness:e} {accuracy:?}");
    }
}
