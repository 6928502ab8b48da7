//! A walk along a locus by pseudo-arclength, with the points of codimension two on it.

use nalgebra::{Vector2, Vector5};

use super::super::corrector::tangent;
use super::super::events::{characteristic, differ, is_at, root_between};
use super::super::walk::AT_AN_END;
use super::curve::{Curve, Spot};
use super::{BranchEvent, BranchOptions, LocusEnd, LocusEvent, NoOrbit, OneLocus, OrbitAnswer};
use crate::numeric::elementary;
use crate::study::Task;

/// First step in the units.
const FIRST: f64 = 2e-3;

/// Step below which a locus ends.
const SHORTEST: f64 = 1e-9;

/// Cosine of the largest angle between the tangents at both ends of a step.
const STRAIGHT: f64 = 0.9;

/// At a cusp the fields turn back: smallest cosine, its sign turned, of the angle between their changes.
const OPPOSITE: f64 = 0.5;

/// Largest component of the tangent by a field at a cusp.
const AT_A_CUSP: f64 = 1e-3;

/// Length of the part of the tangent by both fields below which the phase of the drive is kept.
const UPRIGHT: f64 = 1e-2;

pub(super) struct Walk<'a> {
    pub curve: Curve<'a>,
    pub locus: OneLocus,
    pub at: Spot,
    /// The ranges of both fields.
    pub ranges: [(f64, f64); 2],
    /// Its phase is that of the rows.
    pub options: BranchOptions,
}

impl Walk<'_> {
    /// Walks until the locus ends, and returns it with its end.
    pub fn run_out(mut self, task: &Task) -> Result<OneLocus, NoOrbit> {
        self.locus.end = self.end(task)?;
        Ok(self.locus)
    }

    fn end(&mut self, task: &Task) -> Result<LocusEnd, NoOrbit> {
        let units = [self.curve.corrector.units.range, self.curve.range];
        let ends = [0, 1].map(|place| {
            let ((from, to), unit) = (self.ranges[place], units[place]);
            [from.min(to) / unit, from.max(to) / unit]
        });
        let (mut step, mut farthest) = (FIRST.min(self.options.step), 0.0_f64);
        let Some(first) = self.curve.orbit_at(&self.at, self.options.phase) else {
            return Ok(LocusEnd::Lost);
        };
        self.add(None, &self.at.clone(), first);
        while self.locus.orbits.len() < self.options.count {
            task.check_cancelled()?;
            (task.tick)();
            let next = self.predicted(step, &ends);
            let Some(((next, is_last), rows)) = next.and_then(|next| {
                let mut rows: Vec<_> =
                    self.events_to(&next.0)?.into_iter().map(|(event, spot)| (Some(event), spot)).collect();
                rows.push((None, next.0.clone()));
                let orbit = |(_, spot): &(_, Spot)| self.curve.orbit_at(spot, self.options.phase);
                let orbits = rows.iter().map(orbit).collect::<Option<Vec<OrbitAnswer>>>()?;
                Some((next, rows.into_iter().zip(orbits)))
            }) else {
                step *= 0.5;
                if step < SHORTEST {
                    return Ok(self.ended(&ends));
                }
                continue;
            };
            for ((event, spot), orbit) in rows {
                self.add(event, &spot, orbit);
            }
            self.at = next;
            if is_last {
                return Ok(LocusEnd::Range);
            }
            let far = self.far();
            farthest = farthest.max(far);
            if far < step && farthest > 10.0 * step {
                return Ok(LocusEnd::Closed);
            }
            self.keep_clear();
            step = (step * 1.3).min(self.options.step);
        }
        Ok(LocusEnd::Points)
    }

    /// Distance of the last row from the first in the units.
    fn far(&self) -> f64 {
        let OneLocus { orbits, values, .. } = &self.locus;
        let units = &self.curve.corrector.units;
        let (Some(first), Some(last)) = (orbits.first(), orbits.last()) else { return 0.0 };
        let by_fields = [units.range, self.curve.range];
        let fields = (0..2).map(|i| (values[values.len() - 1][i] - values[0][i]) / by_fields[i]);
        let state = units.apart(first.state, last.state);
        fields.chain(state).map(|part| part * part).sum::<f64>().sqrt()
    }

    /// The point after a step, or at the end of a range where that lies before it, and which of both it is.
    fn predicted(&self, step: f64, ends: &[[f64; 2]; 2]) -> Option<(Spot, bool)> {
        let Spot { at, along, .. } = &self.at;
        let beyond = |to: &Vector5<f64>| {
            let crossings = (0..2).filter_map(|place| {
                let [low, high] = ends[place];
                let (from, to) = (at[3 + place], to[3 + place]);
                let end = to.clamp(low, high);
                // the first point may lie at an end, and the locus continue inside
                (end != to && to != from).then(|| (3 + place, end, (end - from) / (to - from)))
            });
            crossings.min_by(|a, b| a.2.total_cmp(&b.2))
        };
        let guess = at + along * step;
        // beyond an end nothing is computed
        let next = if beyond(&guess).is_some() { None } else { Some(self.curve.correct(guess, along)?) };
        let to = next.as_ref().map_or(guess, |next| next.at);
        let (next, is_last) = match (beyond(&to), next) {
            (None, next) => (next?, false),
            (Some((axis, end, share)), _) => {
                let mut there = at + (to - at) * share;
                there[axis] = end;
                let last = self.curve.correct(there, &Vector5::ith(axis, 1.0))?;
                let inside = |place: usize| {
                    let [low, high] = ends[place];
                    (low - SHORTEST..=high + SHORTEST).contains(&last.at[3 + place])
                };
                let is_near = (last.at - at).norm() <= 2.0 * step;
                if !(is_near && inside(0) && inside(1)) {
                    return None;
                }
                (last, true)
            }
        };
        let onward = tangent(&next.slopes, along)?;
        let ahead = next.at - at;
        let follows = onward.dot(along) > STRAIGHT && ahead.dot(along) > STRAIGHT * ahead.norm();
        (follows && !differ(&next.point.orbit, &self.at.point.orbit))
            .then_some((Spot { along: onward, ..next }, is_last))
    }

    /// The events between the last point and the next in order; `None` if one is not found.
    fn events_to(&self, next: &Spot) -> Option<Vec<(LocusEvent, Spot)>> {
        let mut found = Vec::new();
        let chord = next.at - self.at.at;
        let length = chord.norm();
        let at = |share: f64| {
            let spot = self.curve.correct(self.at.at + chord * share, &(chord / length))?;
            let along = tangent(&spot.slopes, &self.at.along)?;
            Some(Spot { along, ..spot })
        };
        let mut search = |event: LocusEvent, of: &dyn Fn(&Spot) -> f64| -> Option<()> {
            let ends = (of(&self.at), of(next));
            if ends.0 * ends.1 < 0.0 {
                let (share, spot) = root_between(length, ends, at, of)?;
                found.push((share, event, spot));
            }
            Some(())
        };
        let at_unit = |unit: f64| move |spot: &Spot| characteristic(&spot.point, unit);
        match self.curve.of {
            BranchEvent::Grazing => {
                let is_mirrored = self.curve.corrector.mirrored;
                let flip = if is_mirrored { LocusEvent::GrazingSymmetry } else { LocusEvent::GrazingFlip };
                search(LocusEvent::GrazingFold, &at_unit(1.0))?;
                search(flip, &at_unit(-1.0))?;
            }
            BranchEvent::Fold => {
                // a locus that turns back over one field alone has no cusp
                let fields = |spot: &Spot| Vector2::new(spot.along[3], spot.along[4]);
                let (before, after) = (fields(&self.at), fields(next));
                if before.dot(&after) < -OPPOSITE * before.norm() * after.norm() {
                    for axis in [3, 4] {
                        search(LocusEvent::Cusp, &|spot| spot.along[axis])?;
                    }
                }
                search(LocusEvent::FoldFlip, &at_unit(-1.0))?;
            }
            BranchEvent::Flip => search(LocusEvent::FoldFlip, &at_unit(1.0))?,
            BranchEvent::Symmetry => {}
        }
        let is_one = |(_, event, spot): &(f64, LocusEvent, Spot)| match event {
            LocusEvent::Cusp => elementary::hypot(spot.along[3], spot.along[4]) <= AT_A_CUSP,
            LocusEvent::GrazingFold => is_at(&spot.point, 1.0),
            LocusEvent::FoldFlip => is_at(&spot.point, 1.0) && is_at(&spot.point, -1.0),
            LocusEvent::GrazingFlip | LocusEvent::GrazingSymmetry => is_at(&spot.point, -1.0),
            LocusEvent::GrazingTwice => false,
        };
        found.retain(|one| one.1 != LocusEvent::Cusp || is_one(one));
        if !found.iter().all(is_one) {
            return None;
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.dedup_by(|later, first| later.1 == first.1);
        Some(found.into_iter().map(|(_, event, spot)| (event, spot)).collect())
    }

    fn ended(&mut self, ends: &[[f64; 2]; 2]) -> LocusEnd {
        let at = self.at.at;
        let is_at_an_end = ends
            .iter()
            .zip([at[3], at[4]])
            .any(|(ends, value)| ends.iter().any(|end| (value - end).abs() <= 10.0 * SHORTEST));
        if is_at_an_end && self.locus.orbits.len() > 1 {
            return LocusEnd::Range;
        }
        if !self.curve.is_beside_a_grazing(&self.at) {
            return LocusEnd::Lost;
        }
        if let Some(event) = self.locus.events.last_mut() {
            *event = Some(match self.curve.of {
                BranchEvent::Flip => LocusEvent::GrazingFlip,
                BranchEvent::Symmetry => LocusEvent::GrazingSymmetry,
                BranchEvent::Fold => LocusEvent::GrazingFold,
                BranchEvent::Grazing => LocusEvent::GrazingTwice,
            });
        }
        LocusEnd::Grazing
    }

    /// Adds a row with the orbit of a point at the phase of the rows.
    fn add(&mut self, event: Option<LocusEvent>, spot: &Spot, orbit: OrbitAnswer) {
        let values = [spot.point.value, spot.at[4] * self.curve.range];
        // a motion at an end is off it by the rounding of the unit
        let (from, to) = self.ranges[1];
        let is_at = |end: &f64| (values[1] - end).abs() <= AT_AN_END * ((to - from).abs() + end.abs() * 1e-3);
        let second = [from, to].into_iter().find(is_at).unwrap_or(values[1]);
        self.locus.values.push([values[0], second]);
        self.locus.orbits.push(orbit);
        self.locus.events.push(event);
    }

    /// Takes states at another phase of the drive where an event at a stop comes near to the present one.
    fn keep_clear(&mut self) {
        let along = self.at.along;
        if elementary::hypot(along[3], along[4]) > UPRIGHT
            && let Some((curve, spot)) = self.curve.cleared(&self.at)
        {
            (self.curve, self.at) = (curve, spot);
        } else {
            self.curve.reopen(&self.at);
        }
    }
}
