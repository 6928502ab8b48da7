//! Two methods that share nothing but the physics agree: the library's Galerkin solution and the integrated
//! differential equations of [`StrongForm`], in force, stiffness, energy, axial force, shape, and in the
//! place of the kink.

use super::strong_form::*;
use super::*;

/// How far apart the two may be.
struct Bounds {
    /// Force of a state, relative to the larger of the largest pull and the force.
    force: f64,
    /// Stiffness of a state, relative to the larger of its own and that at 0.
    stiffness: f64,
    /// Energy, relative to the depth of the wells.
    energy: f64,
}

const TIGHT: Bounds = Bounds { force: 1e-11, stiffness: 1e-9, energy: 1e-9 };

/// Compares states and curve at these positions, each given with the strong form's solution.
#[track_caller]
fn agree(geometry: &Geometry, all: &[Held], start: &Held, bounds: &Bounds) {
    let (curve, flexures) = solve(geometry);
    let landscape = Mechanism::new(curve.clone()).landscape;
    let pull = landscape.extrema.iter().fold(0.0_f64, |most, e| most.max(e.force.abs()));
    let barrier = landscape.barrier.unwrap().from_right_j;
    let slope = curve.stiffness(0.0).abs();
    let largest = start.bump[0].abs().max(start.bump[1].abs());
    for held in all {
        let state = flexures.state(held.x).unwrap();
        let scale = pull.max(held.force.abs());
        near(state.force, held.force, bounds.force * scale);
        near(curve.force(held.x), held.force, 1e-8 * scale);
        let bump = held.bump[0].abs().max(held.bump[1].abs());
        // Beside the kink the strong form's own stiffness has an error that grows with the cube of 1/bump.
        let loss = if bump > 0.0 && bump < 0.01 * largest { 1e4 } else { 1.0 };
        near(state.stiffness, held.stiffness, loss * bounds.stiffness * slope.max(held.stiffness.abs()));
        let potential = held.energy - start.energy;
        near(state.potential, potential, bounds.energy * barrier.max(potential));
        near(curve.potential(held.x), potential, 1e-8 * barrier.max(potential));
        near_relative(state.axial, held.axial, 1e-9);
        // The square of the bump is what the equations know.
        near(state.bump * state.bump, bump * bump, 1e-10 * geometry.buckling.length.powi(2));
        shapes_agree(geometry, &state, held);
    }
}

/// The ends of the centre lines, and the largest stress.
#[track_caller]
fn shapes_agree(geometry: &Geometry, state: &State, held: &Held) {
    let lengths = [geometry.parallel.length, geometry.buckling.length];
    let clamp = lengths[0] + lengths[1] - geometry.preload;
    for (g, name) in [(0, "parallel"), (1, "buckling")] {
        let line = &state.lines[g];
        assert_eq!(line.flexure, name);
        let [arc, along, across] = *line.points.last().unwrap();
        near_relative(arc, lengths[g], 1e-14);
        let shuttle = lengths[g] - held.shortening[g];
        near(along, if g == 0 { shuttle } else { clamp - shuttle }, 1e-10 * lengths[g]);
        near(across, state.x, 1e-10 * lengths[g]);
    }
    let modulus = geometry.young / if geometry.plane_strain { 1.0 - geometry.poisson.powi(2) } else { 1.0 };
    let stress = 0.5 * modulus * geometry.thickness * held.curvature[0].max(held.curvature[1]);
    // The moment has its maximum at a clamp or between two ends of cells.
    assert!(state.max_stress >= stress * (1.0 - 1e-3), "{} {stress}", state.max_stress);
    near_relative(state.max_stress, stress, 0.01);
}

/// Compares on both sides of the kink and at it, from 0 to 1.15 times its position.
fn agree_across_the_kink(geometry: &Geometry, bumped: usize, bounds: &Bounds) {
    let landscape = Mechanism::new(solve(geometry).0).landscape;
    let kink = landscape.kinks.last().unwrap().x;
    let most = landscape.extrema.last().unwrap().x;
    let mut inner = [0.0, 0.1, 0.3, 0.5, 0.8, 0.95, 1.0 - 1e-3, 1.0 - 1e-6].map(|part| part * kink).to_vec();
    inner.push(most.min(0.9 * kink));
    inner.sort_by(f64::total_cmp);
    let outer = [1.0 + 1e-6, 1.001, 1.01, 1.03, 1.08, 1.15 * (1.0 - 1e-15)].map(|part| part * kink);
    let cells = StrongForm::new(geometry, 32);
    let buckled = cells.buckled(&inner, bumped);
    let beside = &buckled[buckled.len() - 1];
    // Up the wall the flexures bend close to the clamps.
    let fine = StrongForm::new(geometry, 48);
    let beside_fine = fine.buckled(&[0.0, 0.5 * kink, beside.x], bumped).pop().unwrap();
    let taut = fine.taut(&beside_fine, &outer);
    let all: Vec<Held> = buckled.iter().chain(&taut).cloned().collect();
    agree(geometry, &all, &buckled[0], bounds);
    near_relative(kink, fine.kink(&beside_fine, bumped).x, 5e-11);
}

#[test]
fn the_prototype() {
    agree_across_the_kink(&prototype(), 1, &TIGHT);
}

#[test]
fn wide_strips() {
    agree_across_the_kink(&Geometry { plane_strain: true, poisson: 0.45, ..prototype() }, 1, &TIGHT);
}

#[test]
fn thick_flexures_stretch_and_shear() {
    let mut geometry = Geometry { thickness: 2e-3, preload: 4e-3, ..prototype() };
    geometry.parallel.width = 5e-3;
    agree_across_the_kink(&geometry, 1, &TIGHT);
}

#[test]
fn short_and_long_ones() {
    let mut geometry = Geometry { preload: 1e-3, thickness: 5e-5, ..prototype() };
    geometry.parallel.length = 60e-3;
    geometry.buckling.length = 8e-3;
    geometry.buckling.width = 2e-3;
    agree_across_the_kink(&geometry, 0, &TIGHT);
    geometry.parallel.width = 80e-3;
    agree_across_the_kink(&geometry, 1, &TIGHT);
}

/// The pair is so much softer than the two others that it is the one that buckles.
#[test]
fn a_soft_pair_buckles_itself() {
    let mut geometry = prototype();
    geometry.parallel = Group { count: 2, length: 30e-3, width: 4e-3 };
    geometry.buckling = Group { count: 2, length: 24e-3, width: 9e-3 };
    agree_across_the_kink(&geometry, 0, &TIGHT);
}

#[test]
fn two_buckling_flexures_and_a_soft_pair() {
    let mut geometry = prototype();
    geometry.parallel.width = 9e-3;
    geometry.buckling.count = 2;
    agree_across_the_kink(&geometry, 1, &TIGHT);
}

/// With a bow there is no kink, and one branch from the bulge to the wall.
#[test]
fn a_bowed_flexure() {
    let geometry = Geometry { initial_bow: 1e-4, ..prototype() };
    let end = solve(&geometry).0.domain().1;
    let kink = Mechanism::new(solve(&prototype()).0).landscape.kinks[1].x;
    let mut positions: Vec<f64> = (0..12).map(|i| end * f64::from(i) / 12.0).collect();
    positions.extend([1.0 - 1e-3, 1.0 - 1e-6, 1.0, 1.0 + 1e-6, 1.0 + 1e-3].map(|part| part * kink));
    positions.push(end);
    positions.sort_by(f64::total_cmp);
    let all = StrongForm::new(&geometry, 48).buckled(&positions, 1);
    agree(&geometry, &all, &all[0], &TIGHT);
}
