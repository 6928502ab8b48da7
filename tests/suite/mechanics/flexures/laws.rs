//! Laws that hold for any flexures: symmetry, one path, scaling, energy as the integral of force, stiffness
//! as its derivative.

use super::super::integral;
use super::*;

fn soft_pair() -> Geometry {
    let mut geometry = prototype();
    geometry.parallel = Group { count: 2, length: 30e-3, width: 4e-3 };
    geometry.buckling = Group { count: 2, length: 24e-3, width: 9e-3 };
    geometry
}

fn some() -> [Geometry; 4] {
    [
        prototype(),
        soft_pair(),
        Geometry { initial_bow: 1e-4, ..prototype() },
        Geometry { preload: 0.0, plane_strain: true, ..prototype() },
    ]
}

fn places(end: f64, count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| end * (i as f64 + 0.37) / count as f64)
}

/// The largest pull between the wells, or 0.
fn pull(curve: &ForceCurve) -> f64 {
    let landscape = Mechanism::new(curve.clone()).landscape;
    landscape.extrema.iter().fold(0.0_f64, |most, e| most.max(e.force.abs()))
}

#[test]
fn curve_and_states_are_odd_bit_for_bit() {
    for geometry in some() {
        let (curve, flexures) = solve(&geometry);
        super::super::mirrors_bit_for_bit(&curve);
        for x in places(curve.domain().1, 9) {
            let (right, left) = (flexures.state(x).unwrap(), flexures.state(-x).unwrap());
            assert_eq!((left.x, left.force), (-right.x, -right.force));
            assert_eq!((left.potential, left.stiffness), (right.potential, right.stiffness));
            assert_eq!(left.axial, right.axial);
            near(left.bump, right.bump, 1e-15);
            for (a, b) in left.lines.iter().zip(&right.lines) {
                let ends = (a.points.last().unwrap(), b.points.last().unwrap());
                near(ends.0[1], ends.1[1], 1e-15);
                near(ends.0[2], -ends.1[2], 1e-15);
            }
        }
        near(flexures.state(0.0).unwrap().potential, 0.0, 1e-15 * geometry.preload * 100.0);
    }
}

/// What a state is does not depend on what was looked at before it, nor on the states that the curve was made
/// of.
#[test]
fn there_is_no_hysteresis() {
    for geometry in some() {
        let (curve, flexures) = solve(&geometry);
        let (_, other) = Flexures::solve(&geometry, 1e-6).unwrap();
        let end = curve.domain().1;
        let out: Vec<State> = places(end, 15).map(|x| flexures.state(x).unwrap()).collect();
        let mut back: Vec<State> = places(end, 15)
            .collect::<Vec<f64>>()
            .into_iter()
            .rev()
            .map(|x| flexures.state(x).unwrap())
            .collect();
        back.reverse();
        assert_eq!(out, back);
        for state in out {
            let same = other.state(state.x).unwrap();
            near(same.force, state.force, 1e-11 * pull(&curve).max(state.force.abs()));
            near_relative(same.axial + 1e-3, state.axial + 1e-3, 1e-10);
        }
    }
}

#[test]
fn forces_go_with_youngs_modulus() {
    let (curve, flexures) = solve(&prototype());
    // A power of two goes through every sum unharmed.
    let (double, _) = solve(&Geometry { young: 2.0 * prototype().young, ..prototype() });
    let (other, others) = solve(&Geometry { young: 3.7 * prototype().young, ..prototype() });
    assert_eq!(double.breaks(), curve.breaks());
    for x in places(curve.domain().1, 40) {
        assert_eq!(double.force(x), 2.0 * curve.force(x));
        near(other.force(x) / 3.7, curve.force(x), 1e-8 * curve.force(x).abs().max(0.197));
    }
    // The pieces of the wall may be cut elsewhere; the states are the same.
    let (state, scaled) = (flexures.state(4e-3).unwrap(), others.state(4e-3).unwrap());
    near_relative(scaled.force, 3.7 * state.force, 1e-12);
    near_relative(scaled.axial, 3.7 * state.axial, 1e-13);
    near_relative(scaled.max_stress, 3.7 * state.max_stress, 1e-11);
    near_relative(scaled.bump, state.bump, 1e-12);
}

#[test]
fn forces_of_thin_flexures_go_with_the_cube_of_the_thickness() {
    let reduced = |thickness: f64| {
        let (_, flexures) = solve(&Geometry { thickness, ..prototype() });
        flexures.state(4e-3).unwrap().force / thickness.powi(3)
    };
    let [a, b, c] = [4e-5, 2e-5, 1e-5].map(reduced);
    // What is left is the stretching, of second order.
    near_relative((a - b) / (b - c), 4.0, 1e-3);
    near_relative(reduced(1e-8), c - (b - c) / 3.0, 1e-7);
}

/// F/(E L^2) of similar mechanisms is the same: nothing has a size of its own.
#[test]
fn size_does_not_matter() {
    let (curve, flexures) = solve(&prototype());
    let middle = flexures.state(4e-3).unwrap();
    for scale in [1e-9, 1e-3, 1e9] {
        let geometry = scaled(scale);
        let (other, others) = solve(&geometry);
        let unit = geometry.young / prototype().young * scale * scale;
        near_relative(other.domain().1, scale * curve.domain().1, 1e-12);
        assert_eq!(other.pieces().len(), curve.pieces().len());
        for x in places(curve.domain().1, 20) {
            near(other.force(scale * x) / unit, curve.force(x), 1e-8 * curve.force(x).abs().max(0.197));
        }
        let state = others.state(4e-3 * scale).unwrap();
        near_relative(state.force / unit, middle.force, 1e-11);
        near_relative(state.potential / (unit * scale), middle.potential, 1e-10);
        near_relative(state.bump / scale, middle.bump, 1e-11);
    }
}

#[test]
fn energy_is_the_integral_of_the_force() {
    for geometry in some() {
        let (curve, flexures) = solve(&geometry);
        let force = |x: f64| flexures.state(x).unwrap().force;
        let ends: Vec<f64> = [0.0]
            .into_iter()
            .chain(curve.breaks().iter().copied().filter(|b| *b > 0.0))
            .chain([curve.domain().1])
            .collect();
        let landscape = Mechanism::new(curve.clone()).landscape;
        let barrier = landscape.barrier.map_or(0.0, |barrier| barrier.from_right_j);
        let (mut work, mut work_of_curve) = (0.0, 0.0);
        for pair in ends.windows(2) {
            work += integral(force, pair[0], pair[1]);
            work_of_curve += integral(|x| curve.force(x), pair[0], pair[1]);
            let potential = flexures.state(pair[1]).unwrap().potential;
            let scale = barrier.max(potential.abs());
            near(work, potential, 2e-9 * scale);
            near(work_of_curve, potential, 1e-8 * scale);
            near(curve.potential(pair[1]), work_of_curve, 1e-12 * scale);
        }
    }
}

#[test]
fn stiffness_is_the_derivative_of_the_force() {
    for geometry in some() {
        let (curve, flexures) = solve(&geometry);
        let force = |x: f64| flexures.state(x).unwrap().force;
        let (end, slope) = (curve.domain().1, curve.stiffness(0.0).abs());
        let kink = Mechanism::new(curve.clone()).landscape.kinks.last().map_or(7.18e-3, |kink| kink.x);
        for x in places(end, 11) {
            let h = 0.005 * (x - kink).abs().min(end - x);
            // Central differences of sixth order.
            let sum = 45.0 * (force(x + h) - force(x - h)) - 9.0 * (force(x + 2.0 * h) - force(x - 2.0 * h))
                + force(x + 3.0 * h)
                - force(x - 3.0 * h);
            let (expected, stiffness) = (sum / (60.0 * h), flexures.state(x).unwrap().stiffness);
            near(stiffness, expected, 1e-7 * slope.max(stiffness.abs()));
            near(curve.stiffness(x), stiffness, 1e-6 * slope.max(stiffness.abs()));
        }
    }
}
