//! Branch switching: from a flip to the motions of twice the period, from a breaking of the symmetry to the
//! motions that are not their own mirror images, and from these to those that are.

use std::sync::atomic::AtomicBool;

use nalgebra::{Matrix3, Vector4};

use super::corrector::{Corrector, Point};
use super::events::{BranchEvent, characteristic};
use super::walk::{Directed, Walk};
use super::{BranchAnswer, BranchOptions, NoOrbit, SAME, Units, map_of};
use crate::study::{Family, Task};

/// Distances of the first motion of a branch from the event, in the units, in the order of trial. In a
/// cascade of doublings each branch comes to its own doubling sooner than the one before.
const DISTANCES: [f64; 7] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 3e-2];

/// Share of that distance by which the first motion must differ from those of the branch left.
const AWAY: f64 = 0.1;

/// Largest distance in the units between the same event on two branches.
const AT_ONCE: f64 = 1e-6;

/// The start of a branch: its first motion, with the direction in which it continues.
type Start<'a> = (Corrector<'a>, Directed);

/// A branch, the branches that begin at its flips and breakings of the symmetry, those that begin on them,
/// and so on to this number of levels. Each is followed to an end of the range, or to where it joins another
/// branch.
///
/// A branch leaves in the direction of the eigenvector of the multiplier -1, of the map over a period or from
/// a motion to its mirror image (Kuznetsov 2004, section 10.2.2). Its first motion is found by Newton's
/// method in the plane across that direction, and differs from those of the branch that it leaves. Ticks once
/// per orbit.
pub fn switched(
    family: &Family,
    branch: BranchAnswer,
    range: (f64, f64),
    levels: u32,
    options: &BranchOptions,
    task: &Task,
) -> Result<Vec<BranchAnswer>, NoOrbit> {
    task.unless_cancelled(|| {
        let mut all = vec![branch];
        let mut begin = 0;
        for _ in 0..levels {
            let end = all.len();
            for number in begin..end {
                for place in 0..all[number].values.len() {
                    let begun = starts(family, &all, (number, place), range, options, task.cancel);
                    if begun.is_none() {
                        let value = all[number].values[place];
                        all[number].unbegun.push(value);
                    }
                    for (corrector, first) in begun.into_iter().flatten() {
                        let model = family.model(first.0.value).map_err(|_| NoOrbit::NotConverged)?;
                        let field = &all[number].field;
                        let walk = Walk::new(corrector, field, range, &model, first, *options);
                        match walk.run_out(task) {
                            Err(NoOrbit::Unrepeated) => {}
                            found => all.push(found?),
                        }
                    }
                }
            }
            begin = end;
        }
        Ok(all)
    })
}

/// The branches that begin at a row of a branch, if that is an event at which no other branch begins or ends;
/// `None` if one begins there and is not found.
fn starts<'a>(
    family: &'a Family<'a>,
    all: &[BranchAnswer],
    (number, place): (usize, usize),
    range: (f64, f64),
    options: &BranchOptions,
    cancel: &'a AtomicBool,
) -> Option<Vec<Start<'a>>> {
    let from = &all[number];
    let (orbit, value) = (&from.orbits[place], from.values[place]);
    let is_flip = from.events[place] == Some(BranchEvent::Flip);
    if !is_flip && from.events[place] != Some(BranchEvent::Symmetry) {
        return Some(Vec::new());
    }
    let model = family.model(value).ok()?;
    let units = Units::of(&model, (range.1 - range.0).abs());
    let (phase, periods) = (options.phase, orbit.period);
    let base = Corrector { family, phase, periods, mirrored: !is_flip, units, cancel };
    let at = base.at(orbit.state, value);
    let is_known = all.iter().enumerate().filter(|(other, _)| *other != number).any(|(_, other)| {
        let rows = other.orbits.iter().zip(&other.values).zip(&other.events);
        rows.filter(|(_, event)| event.is_some())
            .any(|((orbit, value), _)| (base.at(orbit.state, *value) - at).amax() <= AT_ONCE)
    });
    if is_known {
        return Some(Vec::new());
    }
    let (base, point) = cleared(base, at)?;
    let sideways = |up: f64| Some((base, (point.clone(), base.tangent(&point, &(Vector4::w() * up))?)));
    let is_symmetric = |place: usize| {
        let (orbit, value) = (from.orbits.get(place)?, from.values.get(place)?);
        let map = map_of(&family.model(*value).ok()?, options.phase, cancel)?;
        Some(Corrector::asymmetry(&map, orbit)?.amax() <= SAME)
    };
    let beside = [place.wrapping_sub(1), place + 1].into_iter().find_map(is_symmetric);
    Some(match beside {
        // motions that are not their own mirror images meet the branch of those that are
        Some(false) if !is_flip => [-1.0, 1.0].into_iter().filter_map(sideways).collect(),
        _ => vec![begun(&base, &point, is_flip)?],
    })
}

/// The point of an event, at a phase of the drive away from impacts.
fn cleared<'a>(base: Corrector<'a>, at: Vector4<f64>) -> Option<(Corrector<'a>, Point)> {
    let point = base.evaluate(&at)?;
    let Some(phase) = base.clear_phase(&point, &[]) else { return Some((base, point)) };
    let state = base.at_phase(&point.orbit, point.value, phase)?.state;
    let moved = Corrector { phase, ..base };
    let point = moved.correct(moved.at(state, point.value), &Vector4::w())?;
    Some((moved, point))
}

/// The first motion of the branch that leaves an event in the direction of the multiplier -1.
fn begun<'a>(base: &Corrector<'a>, point: &Point, is_flip: bool) -> Option<Start<'a>> {
    let rows = point.by_state.in_units(base.units.of_state());
    let singular = Matrix3::from_fn(|i, j| rows.rows()[i][j]) + Matrix3::identity();
    let turns = singular.svd(false, true).v_t?;
    let direction = turns.row(2);
    let along = base.tangent(point, &Vector4::w())?;
    let direction = Vector4::new(direction[0], direction[1], direction[2], 0.0);
    let across = (direction - along * direction.dot(&along)).try_normalize(0.0)?;
    let periods = if is_flip { 2 * base.periods } else { base.periods };
    let corrector = Corrector { periods, mirrored: false, ..*base };
    // where the branch begins, its map is that of the event twice
    let twice =
        point.by_state.after(&point.by_state).characteristic(-1.0, point.determinant * point.determinant);
    DISTANCES.into_iter().find_map(|distance| {
        let first = corrector.correct(point.at + direction * distance, &across)?;
        let map = corrector.map(first.value)?;
        let off = match is_flip {
            true => corrector.halfway(&map, &first.orbit)?,
            false => Corrector::asymmetry(&map, &first.orbit)?,
        };
        let is_near = (first.at - point.at).norm() <= 3.0 * distance;
        let is_before_its_flip = characteristic(&first, -1.0) * twice > 0.0;
        let onward = corrector.tangent(&first, &across)?;
        (is_near && is_before_its_flip && off.norm() > AWAY * distance)
            .then_some((corrector, (first, onward)))
    })
}
