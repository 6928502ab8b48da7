//! Elastica with exact answers (elliptic integrals), reached as limits: flexures so thin that they neither
//! stretch nor shear, and a second group so stiff or so soft that it does nothing.

use std::f64::consts::PI;

use super::*;

/// Bending stiffness of one flexure of a group.
fn bending(geometry: &Geometry, group: &Group) -> f64 {
    geometry.young * group.width * geometry.thickness.powi(3) / 12.0
}

/// Thin as they are, the wider group yields nothing of the preload. Clamped-clamped, post-buckled, with its
/// ends in line.
#[test]
fn a_buckled_elastica() {
    for (shortening, load, middle) in
        [(2.7 / 27.7, 1.05156984528, 0.192607640414), (0.2, 1.11273871988, 0.266318588006)]
    {
        let mut geometry = Geometry { thickness: 1e-6, preload: shortening, ..prototype() };
        geometry.buckling = Group { count: 1, length: 1.0, width: 0.1 };
        geometry.parallel = Group { count: 2, length: 1.0, width: 0.3 };
        let state = solve(&geometry).1.state(0.0).unwrap();
        let euler = 4.0 * PI * PI * bending(&geometry, &geometry.buckling);
        near_relative(state.axial / euler, load, 1e-9);
        near_relative(state.bump, middle, 1e-9);
    }
}

/// The same for a group of several, for the group called parallel, and for any size.
#[test]
fn a_buckled_elastica_in_the_other_group() {
    for (scale, count) in [(1e-9, 1), (1.0, 4), (1e9, 50)] {
        let mut geometry = Geometry { thickness: 1e-6 * scale, preload: 0.2 * scale, ..prototype() };
        geometry.parallel = Group { count, length: scale, width: 0.1 * scale };
        geometry.buckling = Group { count, length: scale, width: 0.5 * scale };
        let state = solve(&geometry).1.state(0.0).unwrap();
        let euler = 4.0 * PI * PI * bending(&geometry, &geometry.parallel) / (scale * scale);
        near_relative(state.axial / (euler * count as f64), 1.11273871988, 1e-9);
        near_relative(state.bump / scale, 0.266318588006, 1e-9);
    }
}

/// How the limit is reached: what stretching takes up of the preload goes with the thickness squared.
#[test]
fn stretching_goes_with_the_square_of_the_thickness() {
    let load = |thickness: f64| {
        let mut geometry = Geometry { thickness, preload: 0.2, ..prototype() };
        geometry.buckling = Group { count: 1, length: 1.0, width: 0.1 };
        geometry.parallel = Group { count: 2, length: 1.0, width: 0.3 };
        let state = solve(&geometry).1.state(0.0).unwrap();
        state.axial / (4.0 * PI * PI * bending(&geometry, &geometry.buckling))
    };
    let exact = 1.11273871988;
    let (coarse, fine) = (load(2e-3) - exact, load(1e-3) - exact);
    near_relative(coarse / fine, 4.0, 1e-4);
    near(fine - (coarse - fine) / 3.0, 0.0, 1e-9);
}

/// Two equal groups with twice the shortening of a guided elastica as preload: held there, both are free of
/// axial force.
#[test]
fn two_guided_elastica() {
    let shortening = 0.165409844700;
    let mut geometry = Geometry { thickness: 1e-6, preload: 2.0 * shortening, ..prototype() };
    geometry.parallel = Group { count: 1, length: 1.0, width: 1.0 };
    geometry.buckling = geometry.parallel.clone();
    let state = solve(&geometry).1.state(0.5).unwrap();
    let unit = bending(&geometry, &geometry.parallel);
    near_relative(state.force / unit, 2.0 * 8.18601464940, 1e-8);
    assert!(state.axial.abs() < 2e-2 * unit && state.bump == 0.0, "{}", state.axial / unit);
    near(state.lines[0].points.last().unwrap()[1], 1.0 - shortening, 1e-10);
}

/// Without preload and for a small displacement each flexure is Timoshenko's guided beam.
#[test]
fn a_guided_beam_that_shears() {
    for thickness in [1e-3, 0.01, 0.1] {
        let mut geometry = Geometry { thickness, preload: 0.0, poisson: 0.3, ..prototype() };
        geometry.parallel = Group { count: 3, length: 1.0, width: 2.0 };
        geometry.buckling = Group { count: 2, length: 1.5, width: 1.0 };
        let stiffness = |group: &Group| {
            let shear = 5.0 / 6.0 * geometry.young / 2.6 * group.width * thickness;
            let each = group.length.powi(3) / (12.0 * bending(&geometry, group)) + group.length / shear;
            group.count as f64 / each
        };
        let expected = stiffness(&geometry.parallel) + stiffness(&geometry.buckling);
        let (curve, flexures) = solve(&geometry);
        near_relative(flexures.state(0.0).unwrap().stiffness, expected, 1e-12);
        near_relative(curve.stiffness(0.0), expected, 1e-8);
    }
}
