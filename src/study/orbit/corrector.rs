//! Points of a branch of periodic motions, by Newton's method in a plane across it (pseudo-arclength; Keller
//! 1977).

use nalgebra::{Matrix3, Vector3};

use super::{Orbit, allowed, map_of};
use crate::dynamics::{EventKind, Outcome, Passage, StroboscopicMap};
use crate::study::family::Family;

/// The most steps to a point.
const MOST_STEPS: usize = 24;

/// Half the distance over which the map is differenced by the field, as a share of its range, where it
/// stretches what is near to it by less than that much. The direction of the branch is what is left of
/// numbers as large as that: the error of the quotient grows with the square of the distance, that of the
/// map's rounding with its inverse. Where the map stretches more the distance is less, unless the mass
/// strikes a stop: then a touch may be what stretches, and nearer to it nothing is gained.
const DIFFERENCE: f64 = 3e-8;
const STRETCHED: f64 = 1e3;

/// The time in forcing periods up to which an event at a stop is near, and the phases that are looked at.
const NEAR_AN_EVENT: f64 = 0.02;
const CHOICES: u32 = 64;

/// How far beside a motion that touches a stop without speed the map is differentiated.
const BESIDE: f64 = 1e-5;

/// Parts of a forcing period at which a motion is compared with another.
const QUARTERS: [f64; 3] = [0.25, 0.5, 0.75];

/// The largest correction of a predicted point.
const LARGEST: f64 = 0.2;

/// The change of a point by the map, in its units, that is left to rounding.
const CLOSE: f64 = 1e-10;
const ROUNDING: f64 = 1e-12;

/// The step below which nothing is gained any more.
const SMALLEST_STEP: f64 = 1e-10;

/// What a point's coordinates are measured in: length in m, speed in m/s, and the range of the field.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    pub length: f64,
    pub speed: f64,
    pub range: f64,
}

/// A periodic motion on a branch.
#[derive(Debug, Clone)]
pub(super) struct Point {
    /// Displacement, velocity and field in their units.
    pub at: Vector3<f64>,
    /// Value of the field.
    pub value: f64,
    pub orbit: Orbit,
    /// Derivative of the map by the field, in the units.
    by_field: [f64; 2],
}

impl Point {
    /// Whether the mass rests on its way, which makes it forget its past: the motion is then a function of
    /// the field alone.
    pub fn forgets(&self) -> bool {
        self.orbit.determinant() == 0.0
    }
}

/// What all points of a branch share.
pub(super) struct Corrector<'a> {
    pub family: &'a Family<'a>,
    pub phase: f64,
    pub periods: u32,
    pub units: Units,
}

impl Corrector<'_> {
    fn map(&self, value: f64) -> Option<StroboscopicMap> {
        map_of(&self.family.model(value).ok()?, self.phase)
    }

    /// The same motion at another phase of the drive; none where it ends early.
    pub fn at_phase(&self, orbit: &Orbit, value: f64, phase: f64) -> Option<Orbit> {
        if phase == self.phase {
            return Some(orbit.clone());
        }
        let passage = self.map(value)?.pass_part(orbit.state, (phase - self.phase).rem_euclid(1.0));
        (passage.outcome == Outcome::Done).then(|| Orbit { state: passage.state, ..orbit.clone() })
    }

    /// How much later in forcing periods states should be taken, where an event at a stop is near to where
    /// they are: as far from all of them as can be.
    pub fn clear_phase(&self, point: &Point) -> Option<f64> {
        let map = self.map(point.value)?;
        let whole = f64::from(self.periods);
        let events = point.orbit.passage.events.iter().filter(|event| event.kind != EventKind::Crossing);
        let times: Vec<f64> = events.map(|event| (event.t - map.first_strobe()) / map.period()).collect();
        let room = |later: f64| {
            let far = times.iter().map(|time| (time - later).rem_euclid(whole));
            far.map(|far| far.min(whole - far)).fold(f64::INFINITY, f64::min)
        };
        if room(0.0) > NEAR_AN_EVENT {
            return None;
        }
        let choices = (1..CHOICES).map(|own| f64::from(own) / f64::from(CHOICES));
        let best = choices.max_by(|a, b| room(*a).total_cmp(&room(*b)))?;
        (room(best) > 2.0 * room(0.0)).then_some(best)
    }

    /// Displacements in m at the quarters of each forcing period of a motion; none where it ends early.
    pub fn displacements(&self, point: &Point) -> Option<Vec<f64>> {
        let map = self.map(point.value)?;
        let done = |passage: Passage| (passage.outcome == Outcome::Done).then_some(passage.state);
        let mut state = point.orbit.state;
        let mut all = Vec::new();
        for _ in 0..self.periods {
            all.push(state.0);
            for part in QUARTERS {
                all.push(done(map.pass_part(state, part))?.0);
            }
            state = done(map.pass(state, 1))?;
        }
        Some(all)
    }

    /// The coordinates of a state at a value of the field.
    pub fn at(&self, state: (f64, f64), value: f64) -> Vector3<f64> {
        let Units { length, speed, range } = self.units;
        Vector3::new(state.0 / length, state.1 / speed, value / range)
    }

    fn state(&self, at: &Vector3<f64>) -> (f64, f64) {
        (at.x * self.units.length, at.y * self.units.speed)
    }

    /// Change of a state by the map in the units; none where the motion ends early.
    fn change(&self, map: &StroboscopicMap, state: (f64, f64)) -> Option<[f64; 2]> {
        let passage = map.pass(state, self.periods);
        (passage.outcome == Outcome::Done).then(|| self.off(passage.state, state))
    }

    fn off(&self, to: (f64, f64), from: (f64, f64)) -> [f64; 2] {
        [(to.0 - from.0) / self.units.length, (to.1 - from.1) / self.units.speed]
    }

    /// The derivative of the map by the field, in the units; from one side where the other is no scene.
    fn by_field(&self, state: (f64, f64), value: f64, stretch: f64) -> Option<[f64; 2]> {
        let step = DIFFERENCE * (STRETCHED / stretch).min(1.0) * self.units.range;
        let side = |value: f64| self.map(value).and_then(|map| Some((self.change(&map, state)?, value)));
        let here = || side(value);
        let (above, below) = match (side(value + step), side(value - step)) {
            (Some(above), Some(below)) => (above, below),
            (Some(above), None) => (above, here()?),
            (None, Some(below)) => (here()?, below),
            (None, None) => return None,
        };
        let over = (above.1 - below.1) / self.units.range;
        Some([(above.0[0] - below.0[0]) / over, (above.0[1] - below.0[1]) / over])
    }

    /// Derivatives of the change of a state by the map, the last row being `across`.
    fn matrix(&self, orbit: &Orbit, by_field: [f64; 2], across: &Vector3<f64>) -> Matrix3<f64> {
        let Units { length, speed, .. } = self.units;
        let [[a, b], [c, d]] = orbit.jacobian.rows;
        let (b, c) = (b * speed / length, c * length / speed);
        Matrix3::new(a - 1.0, b, by_field[0], c, d - 1.0, by_field[1], across.x, across.y, across.z)
    }

    /// The point of the branch in the plane through `guess` across a direction; none where the method does
    /// not converge.
    pub fn correct(&self, guess: Vector3<f64>, across: &Vector3<f64>) -> Option<Point> {
        let mut at = guess;
        let mut best = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let point = self.look(&at)?;
            at = point.at;
            let off = self.off(point.orbit.passage.state, point.orbit.state);
            let matrix = self.matrix(&point.orbit, point.by_field, across);
            let right = Vector3::new(-off[0], -off[1], -across.dot(&(at - guess)));
            let step = matrix.lu().solve(&right)?;
            let length = step.amax();
            let close = off.iter().all(|own| own.abs() <= CLOSE);
            let exact = off.iter().all(|own| own.abs() <= ROUNDING);
            if exact || length <= SMALLEST_STEP || (close || length <= CLOSE) && length >= 0.5 * best {
                return Some(point);
            }
            if !(length.is_finite() && (at + step - guess).amax() <= LARGEST) {
                return None;
            }
            best = best.min(length);
            at += step;
        }
        None
    }

    /// The motion at a place so near to a point that nothing else of it changes, where it touches a stop.
    pub fn moved(&self, point: Point, at: Vector3<f64>) -> Point {
        let mut orbit = Orbit { state: self.state(&at), ..point.orbit };
        orbit.passage.nearest_miss = Some(0.0);
        Point { at, value: at.z * self.units.range, orbit, ..point }
    }

    /// The direction of the branch at a point, on the side of `along`.
    pub fn tangent(&self, point: &Point, along: &Vector3<f64>) -> Option<Vector3<f64>> {
        let matrix = self.matrix(&point.orbit, point.by_field, along);
        let tangent = matrix.lu().solve(&Vector3::new(0.0, 0.0, 1.0))?;
        let tangent = tangent.try_normalize(0.0)?;
        tangent.iter().all(|own| own.is_finite()).then_some(tangent)
    }

    /// Directions in which a branch may go on from a motion that touches a stop without speed.
    ///
    /// On the side without the touch the map is smooth, and the branch goes along the null vector of its
    /// derivatives. On the side with it they are all but of rank 1: what a touch does to the state, times how
    /// deep the state would have it (Nordmark 1991). The branch leaves along the surface of grazing, so that
    /// what is left of the change of a state is of that one direction.
    pub fn directions_past(&self, grazing: &Point) -> Vec<Vector3<f64>> {
        let rows = |orbit: &Orbit, by_field: [f64; 2]| {
            let matrix = self.matrix(orbit, by_field, &Vector3::zeros());
            [0, 1].map(|row| Vector3::new(matrix[(row, 0)], matrix[(row, 1)], matrix[(row, 2)]))
        };
        let own = rows(&grazing.orbit, grazing.by_field);
        let mut found = Vec::new();
        let sides = [1.0, -1.0].into_iter().flat_map(|sign| (0..3).map(move |axis| (sign, axis)));
        for (sign, axis) in sides {
            let mut at = grazing.at;
            at[axis] += sign * BESIDE;
            let Some(beside) = self.look(&at) else { continue };
            let other = rows(&beside.orbit, beside.by_field);
            let largest = if other[0].norm() > other[1].norm() { other[0] } else { other[1] };
            let depth = largest.normalize();
            let touch = (other[0].dot(&depth), other[1].dot(&depth));
            let across = own[0] * touch.1 - own[1] * touch.0;
            for direction in [other[0].cross(&other[1]), across.cross(&depth)] {
                if let Some(direction) = direction.try_normalize(0.0).filter(|own| own.norm().is_finite()) {
                    found.extend([direction, -direction]);
                }
            }
        }
        found
    }

    /// The motion through a state, which need not come back, with its derivatives; none where it ends early
    /// or has none.
    fn look(&self, at: &Vector3<f64>) -> Option<Point> {
        let value = at.z * self.units.range;
        let map = self.map(value)?;
        let state = allowed(map.model(), self.state(at));
        let (passage, jacobian) = map.pass_with_jacobian(state, self.periods);
        let finite = jacobian.rows.as_flattened().iter().all(|own| own.is_finite());
        if !finite || passage.outcome != Outcome::Done {
            return None;
        }
        let orbit = Orbit { period: self.periods, state, passage, jacobian };
        let stretch = match orbit.passage.strikes() {
            false => self.matrix(&orbit, [0.0; 2], &Vector3::zeros()).amax(),
            true => 0.0,
        };
        let by_field = self.by_field(state, value, stretch)?;
        Some(Point { at: self.at(state, value), value, orbit, by_field })
    }
}
