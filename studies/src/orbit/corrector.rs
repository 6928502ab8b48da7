//! Points of a branch of periodic orbits, by Newton's method in planes across the branch (pseudo-arclength
//! continuation; Keller 1977).

use std::sync::atomic::AtomicBool;

use nalgebra::{Const, DimMin, SMatrix, SVector, Vector3, Vector4};

use super::{OrbitAnswer, SAME, allowed, map_of};
use crate::dynamics::{Event, EventKind, Jacobian, MapState, Model, Outcome, Passage, Side, StroboscopicMap};
use crate::study::Family;

const MAX_STEPS: usize = 24;

/// Half the step of the central difference of the map by the field, as a share of its range. The truncation
/// error grows with the square of the step, the effect of rounding with its inverse.
const DIFFERENCE: f64 = 3e-8;
/// Stretching of the map by the state above which a smaller step is used.
const MAX_STRETCH: f64 = 1e3;
/// Relative difference of impact speeds between both sides above which a smaller step is used: near a grazing
/// contact the map changes like the square root of the distance.
const SAME_SPEED: f64 = 0.1;
const MIN_DIFFERENCE: f64 = 1e-14;

/// Time in forcing periods below which an event at a stop is too near to a strobe.
const NEAR_AN_EVENT: f64 = 0.02;
/// Number of phases among which that farthest from all events is chosen.
const PHASES: u32 = 64;

/// Parts of a forcing period at which two motions are compared.
const QUARTERS: [f64; 3] = [0.25, 0.5, 0.75];

/// Largest correction of a predicted point, in the units.
const MAX_CORRECTION: f64 = 0.2;

/// Residual or step, in the units, below which Newton's method ends as soon as steps no longer shrink.
const CLOSE: f64 = 1e-10;
/// Accuracy of the points of a branch.
const GOOD: Accuracy = Accuracy { change: 1e-12, step: 1e-10 };

/// Residual and step, in the units, below each of which Newton's method ends at once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Accuracy {
    pub change: f64,
    pub step: f64,
}

/// Units of the coordinates of a point: length in m, speed in m/s, state of the circuit in A or V (1 without
/// one), and the range of the field.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Units {
    pub length: f64,
    pub speed: f64,
    pub electrical: f64,
    pub range: f64,
}

impl Units {
    pub fn of(model: &Model, range: f64) -> Self {
        let scales = model.scales();
        let electrical = model.electrical_scale().unwrap_or(1.0);
        Self { length: scales.length, speed: scales.speed, electrical, range }
    }

    pub fn of_state(&self) -> [f64; 3] {
        [self.length, self.speed, self.electrical]
    }

    /// Difference of two states in the units.
    pub fn apart(&self, from: MapState, to: MapState) -> [f64; 3] {
        let Self { length, speed, electrical, .. } = *self;
        let charged = (to.electrical - from.electrical) / electrical;
        [(to.x - from.x) / length, (to.v - from.v) / speed, charged]
    }

    /// A state moved by this difference in the units.
    pub fn moved(&self, state: MapState, by: [f64; 3]) -> MapState {
        let MapState { x, v, electrical } = state;
        MapState {
            x: x + by[0] * self.length,
            v: v + by[1] * self.speed,
            electrical: electrical + by[2] * self.electrical,
        }
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Point {
    /// Displacement, velocity, state of the circuit and field in the units. Without a circuit its state is 0,
    /// and so are its derivatives.
    pub at: Vector4<f64>,
    pub value: f64,
    pub orbit: OrbitAnswer,
    /// Derivatives of the corrector's map by the state, and their determinant.
    pub by_state: Jacobian,
    pub determinant: f64,
    /// Derivative of that map by the field, in the units.
    pub by_field: [f64; 3],
}

impl Point {
    /// Whether the mass rests during the motion, which then no longer depends on its start.
    pub fn forgets(&self) -> bool {
        self.orbit.passage.rested
    }
}

/// M equations in N = M + 1 unknowns, evaluated at a guess.
pub(crate) struct Equations<const N: usize, const M: usize, T> {
    /// Where they are evaluated: at the guess, or at the nearest admissible point.
    pub at: SVector<f64, N>,
    /// Residuals, which must become 0.
    pub off: [f64; M],
    /// Derivatives of the residuals by the unknowns.
    pub slopes: [SVector<f64, N>; M],
    pub of: T,
}

/// The solution of M equations in N = M + 1 unknowns in the plane through a guess and normal to `across`, by
/// Newton's method, with the length of the last step; `None` if it does not converge.
pub(crate) fn newton<const N: usize, const M: usize, T>(
    guess: SVector<f64, N>,
    across: &SVector<f64, N>,
    accuracy: Accuracy,
    evaluate: impl Fn(&SVector<f64, N>) -> Option<Equations<N, M, T>>,
) -> Option<(T, SVector<f64, N>, f64)>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let mut at = guess;
    let mut best = f64::INFINITY;
    for _ in 0..MAX_STEPS {
        let equations = evaluate(&at)?;
        at = equations.at;
        let off = equations.off;
        let last = -across.dot(&(at - guess));
        let right = SVector::from_fn(|i, _| off.get(i).map_or(last, |off| -off));
        let step = bordered(&equations.slopes, across).lu().solve(&right)?;
        let length = step.amax();
        let close = off.iter().all(|part| part.abs() <= CLOSE);
        let exact = off.iter().all(|part| part.abs() <= accuracy.change);
        if exact || length <= accuracy.step || (close || length <= CLOSE) && length >= 0.5 * best {
            return Some((equations.of, at, length));
        }
        if !(length.is_finite() && (at + step - guess).amax() <= MAX_CORRECTION) {
            return None;
        }
        best = best.min(length);
        at += step;
    }
    None
}

/// The matrix of these rows, the last of which is `last`.
fn bordered<const N: usize>(rows: &[SVector<f64, N>], last: &SVector<f64, N>) -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| rows.get(i).unwrap_or(last)[j])
}

/// The tangent of the curve of solutions of equations with these derivatives, in the direction of `along`.
pub(crate) fn tangent<const N: usize>(
    slopes: &[SVector<f64, N>],
    along: &SVector<f64, N>,
) -> Option<SVector<f64, N>>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let last = SVector::from_fn(|i, _| if i + 1 == N { 1.0 } else { 0.0 });
    let tangent = bordered(slopes, along).lu().solve(&last)?.try_normalize(0.0)?;
    tangent.iter().all(|part| part.is_finite()).then_some(tangent)
}

/// Data that all points of a branch share.
///
/// A point is a fixed point of the corrector's map: for motions that equal their mirror images, at values of
/// the field at which the scene does too, it is the mirrored map over half a period. Its multipliers are
/// roots of those over the period; -1 breaks the symmetry.
#[derive(Clone, Copy)]
pub(crate) struct Corrector<'a> {
    pub family: &'a Family<'a>,
    pub phase: f64,
    pub periods: u32,
    pub mirrored: bool,
    pub units: Units,
    /// Set by another thread to cancel a passage, which then counts as one that ends early.
    pub cancel: &'a AtomicBool,
}

impl Corrector<'_> {
    /// The model at a value of the field; `None` if the value makes no valid scene or, where the map is
    /// mirrored, one whose mirror image is another scene.
    pub fn model(&self, value: f64) -> Option<Model> {
        let model = self.family.model(value).ok()?;
        (!self.mirrored || model.mirrors_in_half_a_period()).then_some(model)
    }

    /// The stroboscopic map of that model.
    pub fn map(&self, value: f64) -> Option<StroboscopicMap<'_>> {
        map_of(&self.model(value)?, self.phase, self.cancel)
    }

    /// Whether an orbit equals its mirror image, and the scenes next to this value equal theirs.
    pub fn keeps_mirrored(&self, orbit: &OrbitAnswer, value: f64) -> bool {
        let mirrored = Self { mirrored: true, ..*self };
        let has_map = |share: f64| mirrored.model(value + share * self.units.range).is_some();
        let off = || Self::asymmetry(&mirrored.map(value)?, orbit);
        [-DIFFERENCE, DIFFERENCE].into_iter().any(has_map) && off().is_some_and(|off| off.amax() <= SAME)
    }

    /// Number of forcing periods of the map of the corrector.
    pub fn flight(&self) -> f64 {
        f64::from(self.periods) * if self.mirrored { 0.5 } else { 1.0 }
    }

    /// A state after these forcing periods, mirrored if the map is.
    pub fn image(&self, state: MapState) -> MapState {
        if self.mirrored { mirrored(state) } else { state }
    }

    /// Difference of a motion from its mirror image half its period later, relative to the scales; `None` if
    /// the mirror image is not a motion of the scene, or the motion ends early.
    pub fn asymmetry(map: &StroboscopicMap, orbit: &OrbitAnswer) -> Option<Vector3<f64>> {
        let model = map.model();
        if !model.mirrors_in_half_a_period() || orbit.period.is_multiple_of(2) {
            return None;
        }
        let half = map.pass_between(orbit.state, (0.0, 0.5 * f64::from(orbit.period)));
        let off = Units::of(model, 1.0).apart(mirrored(orbit.state), (&half).into());
        (half.outcome == Outcome::Done).then(|| Vector3::from(off))
    }

    /// Difference in the units between the states of an orbit half its period apart; `None` if that is not a
    /// whole number of forcing periods, or the motion ends early.
    pub fn halfway(&self, map: &StroboscopicMap, orbit: &OrbitAnswer) -> Option<Vector3<f64>> {
        if !orbit.period.is_multiple_of(2) {
            return None;
        }
        let half = map.pass_between(orbit.state, (0.0, f64::from(orbit.period / 2)));
        let off = self.units.apart(orbit.state, (&half).into());
        (half.outcome == Outcome::Done).then(|| Vector3::from(off))
    }

    /// The orbit at another phase of the drive; `None` if it ends early.
    pub fn at_phase(&self, orbit: &OrbitAnswer, value: f64, phase: f64) -> Option<OrbitAnswer> {
        if phase == self.phase {
            return Some(orbit.clone());
        }
        let passage = self.map(value)?.pass_between(orbit.state, (0.0, (phase - self.phase).rem_euclid(1.0)));
        (passage.outcome == Outcome::Done)
            .then(|| OrbitAnswer { state: MapState::from(&passage), ..orbit.clone() })
    }

    /// The phase that is farthest from all events at stops and from the times `also` (in forcing periods);
    /// `None` if the present phase is far enough from them, or if no other one is much better.
    pub fn clear_phase(&self, point: &Point, also: &[f64]) -> Option<f64> {
        let map = self.map(point.value)?;
        let whole = f64::from(self.periods);
        let time = |event: &Event| (event.t - map.first_strobe()) / map.period();
        let mut times: Vec<f64> = point.orbit.events_at_stops().map(time).collect();
        times.extend(also);
        let room = |later: f64| {
            let far = times.iter().map(|time| (time - later).rem_euclid(whole));
            far.map(|far| far.min(whole - far)).fold(f64::INFINITY, f64::min)
        };
        if room(0.0) > NEAR_AN_EVENT {
            return None;
        }
        let choices = (1..PHASES).map(|choice| f64::from(choice) / f64::from(PHASES));
        let best = choices.max_by(|a, b| room(*a).total_cmp(&room(*b)))?;
        (room(best) > 2.0 * room(0.0)).then_some((self.phase + best).rem_euclid(1.0))
    }

    /// Displacements in m at the quarters of each forcing period of a motion; `None` if it ends early.
    pub fn displacements(&self, point: &Point) -> Option<Vec<f64>> {
        let map = self.map(point.value)?;
        let done = |passage: Passage| (passage.outcome == Outcome::Done).then(|| MapState::from(&passage));
        let mut state = point.orbit.state;
        let mut all = Vec::new();
        for _ in 0..self.periods {
            all.push(state.x);
            for part in QUARTERS {
                all.push(done(map.pass_between(state, (0.0, part)))?.x);
            }
            state = done(map.pass(state, 1))?;
        }
        Some(all)
    }

    /// The coordinates of a state at a value of the field.
    pub fn at(&self, state: MapState, value: f64) -> Vector4<f64> {
        let Units { length, speed, electrical, range } = self.units;
        Vector4::new(state.x / length, state.v / speed, state.electrical / electrical, value / range)
    }

    fn state(&self, at: &Vector4<f64>) -> MapState {
        let Units { length, speed, electrical, .. } = self.units;
        MapState { x: at.x * length, v: at.y * speed, electrical: at.z * electrical }
    }

    /// The derivative of the map by the field for a passage from a state, in the units; one-sided if one side
    /// is not a valid scene. `by_state` are the derivatives by the state.
    fn by_field(
        &self,
        state: MapState,
        passage: &Passage,
        by_state: &Jacobian,
        value: f64,
    ) -> Option<[f64; 3]> {
        let stretch = match passage.strikes() {
            false => self.slopes(by_state, [0.0; 3]).iter().map(|row| row.amax()).fold(0.0, f64::max),
            true => 0.0,
        };
        let mut step = DIFFERENCE * (MAX_STRETCH / stretch).min(1.0) * self.units.range;
        let map = |value: f64| {
            let passage = self.map(value)?.pass_between(state, (0.0, self.flight()));
            (passage.outcome == Outcome::Done).then_some((passage, value))
        };
        loop {
            let (above, below) = match (map(value + step), map(value - step)) {
                (Some(above), Some(below)) => (above, below),
                (Some(above), None) => (above, map(value)?),
                (None, Some(below)) => (map(value)?, below),
                (None, None) => return None,
            };
            let alike = [&above, &below].iter().all(|side| strike_alike(passage, &side.0));
            if alike || step < MIN_DIFFERENCE * self.units.range {
                let over = (above.1 - below.1) / self.units.range;
                let end = |side: &Passage| self.units.apart(state, self.image(side.into()));
                let (above, below) = (end(&above.0), end(&below.0));
                return Some(std::array::from_fn(|i| (above[i] - below[i]) / over));
            }
            step *= 0.1;
        }
    }

    /// Derivatives of the residual, the change of a state by the map, by the coordinates.
    pub fn slopes(&self, by_state: &Jacobian, by_field: [f64; 3]) -> [Vector4<f64>; 3] {
        let by_state = by_state.in_units(self.units.of_state());
        std::array::from_fn(|i| {
            let mut row = by_state.rows()[i];
            row[i] -= 1.0;
            Vector4::new(row[0], row[1], row[2], by_field[i])
        })
    }

    /// The point of the branch in the plane through `guess` and normal to `across`, if the method converges.
    pub fn correct(&self, guess: Vector4<f64>, across: &Vector4<f64>) -> Option<Point> {
        let evaluate = |at: &Vector4<f64>| {
            let point = self.evaluate(at)?;
            Some(Equations {
                at: point.at,
                off: self.units.apart(point.orbit.state, (&point.orbit.passage).into()),
                slopes: self.slopes(&point.by_state, point.by_field),
                of: point,
            })
        };
        newton(guess, across, GOOD, evaluate).map(|(point, ..)| point)
    }

    /// The tangent of the branch at a point, with a positive component along `along`.
    pub fn tangent(&self, point: &Point, along: &Vector4<f64>) -> Option<Vector4<f64>> {
        tangent(&self.slopes(&point.by_state, point.by_field), along)
    }

    /// The determinant of the derivatives `by_state` of the corrector's map, from that of the flight where it
    /// is known. The mirror image turns the sign of each coordinate.
    pub fn determinant(&self, of_flight: Option<f64>, by_state: &Jacobian) -> f64 {
        match of_flight {
            Some(determinant) if self.mirrored && by_state.size() == 3 => -determinant,
            Some(determinant) => determinant,
            None => by_state.determinant(),
        }
    }

    /// The motion through a state, which need not be periodic; `None` if it ends early or has no derivatives.
    pub fn evaluate(&self, at: &Vector4<f64>) -> Option<Point> {
        let value = at.w * self.units.range;
        let map = self.map(value)?;
        let state = allowed(map.model(), self.state(at));
        let (passage, jacobian) = map.pass_part_with_jacobian(state, (0.0, self.flight()));
        if !jacobian.is_finite() || passage.outcome != Outcome::Done {
            return None;
        }
        let by_state = if self.mirrored { jacobian.mirrored() } else { jacobian };
        let by_field = self.by_field(state, &passage, &by_state, value)?;
        let determinant = self.determinant(passage.determinant, &by_state);
        let (passage, jacobian) = match self.mirrored {
            true => (passage.with_mirror_image(self.flight() * map.period()), by_state.after(&by_state)),
            false => (passage, jacobian),
        };
        let circuit = map.model().circuit_state();
        let orbit = OrbitAnswer { period: self.periods, state, passage, jacobian, circuit };
        Some(Point { at: self.at(state, value), value, orbit, by_state, determinant, by_field })
    }
}

fn mirrored(MapState { x, v, electrical }: MapState) -> MapState {
    MapState { x: -x, v: -v, electrical: 0.0 - electrical }
}

/// Whether two motions from one state strike the stops in the same order at similar speeds. Motions that rest
/// count as alike, since the number of their listed impacts is arbitrary.
fn strike_alike(a: &Passage, b: &Passage) -> bool {
    fn impacts(passage: &Passage) -> impl Iterator<Item = (Side, f64)> {
        let hits = |event: &&Event| event.kind == EventKind::Impact;
        passage.events.iter().filter(hits).map(|event| (event.side, event.v_in))
    }
    if a.rests() > 0 || b.rests() > 0 {
        return true;
    }
    let as_hard =
        |(a, b): ((Side, f64), (Side, f64))| a.0 == b.0 && (a.1 - b.1).abs() <= SAME_SPEED * a.1.abs();
    impacts(a).count() == impacts(b).count() && impacts(a).zip(impacts(b)).all(as_hard)
}
