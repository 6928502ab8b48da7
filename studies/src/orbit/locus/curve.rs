//! The equations of a locus, and its points by Newton's method.

use std::sync::atomic::AtomicBool;

use nalgebra::{Vector4, Vector5};

use super::super::Units;
use super::super::corrector::{Accuracy, Corrector, Equations, Point, newton, tangent};
use super::super::events::{characteristic, differ, has, is_at};
use super::super::grazing::{EXACT, FINEST, Grazing, Touch, grazings};
use super::{BranchEvent, BranchOptions, FieldRange, LocusEnd, OrbitAnswer};
use crate::scene::FieldPath;
use crate::study::Family;

/// Half the largest step of the central differences of the characteristic polynomial; tenths and hundredths
/// of it are tried where the contacts with the stops change within it.
const DIFFERENCE: f64 = 1e-6;
/// The same relative to the square of the speed of the gentlest impact: the depth at which the stop cuts the
/// motion off, by which the polynomial changes.
const SHARE_OF_DEPTH: f64 = 1e-2;
/// Half the step of the central difference of the map by the second field.
const FIELD_DIFFERENCE: f64 = 1e-7;

/// Largest distance over the first field, in its range, of the end of a locus from an orbit that grazes.
const BESIDE_A_GRAZING: f64 = 2e-3;

/// Largest gap in the units of an orbit that grazes at two instants.
const AT_BOTH: f64 = 1e-6;

/// Largest unit of a field relative to its first value: in a larger one its digits would be lost.
const LONGEST_RANGE: f64 = 100.0;

/// Accuracy of the points of a locus.
const GOOD: Accuracy = Accuracy { change: 1e-13, step: 1e-11 };

pub(super) struct Curve<'a> {
    /// Its family has not the second field's value; see [`Curve::at_second`].
    pub corrector: Corrector<'a>,
    path: FieldPath,
    /// Unit of the second field.
    pub range: f64,
    pub of: BranchEvent,
    has_circuit: bool,
    touch: Option<Touch>,
}

#[derive(Clone)]
pub(super) struct Spot {
    /// Displacement, velocity, state of the circuit and both fields in the units; of a grazing the time of
    /// the touch in forcing periods and 0 in place of displacement and velocity.
    pub at: Vector5<f64>,
    pub point: Point,
    pub slopes: [Vector5<f64>; 4],
    /// The tangent.
    pub along: Vector5<f64>,
}

/// Unit of a field that is followed over this range.
fn unit_of((from, to): (f64, f64)) -> f64 {
    let length = (to - from).abs();
    if from == 0.0 { length } else { length.min(LONGEST_RANGE * from.abs()) }
}

fn first_four(at: &Vector5<f64>) -> Vector4<f64> {
    Vector4::new(at[0], at[1], at[2], at[3])
}

fn with_fifth(at: &Vector4<f64>, fifth: f64) -> Vector5<f64> {
    Vector5::new(at[0], at[1], at[2], at[3], fifth)
}

impl<'a> Curve<'a> {
    /// The equations near an orbit of a branch, and their first point, or why there is none.
    pub fn new(
        family: &'a Family<'a>,
        orbit: &OrbitAnswer,
        value: f64,
        range: (f64, f64),
        (of, second): (BranchEvent, &FieldRange),
        options: &BranchOptions,
        cancel: &'a AtomicBool,
    ) -> Result<(Self, Spot), LocusEnd> {
        let path = FieldPath::new(&second.field);
        let unit = unit_of(second.range);
        let upwards = Vector5::ith(4, (second.range.1 - second.range.0).signum());
        let shifted = family.with(&path, second.range.0);
        let model = shifted.model(value).map_err(|_| LocusEnd::Lost)?;
        let units = Units::of(&model, unit_of(range));
        let (phase, periods) = (options.phase, orbit.period);
        let corrector = Corrector { family, phase, periods, mirrored: false, units, cancel };
        let at_second = |share: f64| family.with(&path, second.range.0 + share * unit);
        let has_mirrored_map = |share: f64| {
            let corrector = Corrector { family: &at_second(share), mirrored: true, ..corrector };
            corrector.model(value).is_some()
        };
        let mirrored = of != BranchEvent::Flip
            && Corrector { family: &shifted, ..corrector }.keeps_mirrored(orbit, value)
            && [-FIELD_DIFFERENCE, FIELD_DIFFERENCE].into_iter().any(has_mirrored_map);
        if of == BranchEvent::Symmetry && !mirrored {
            return Err(LocusEnd::Unmirrored);
        }
        let corrector = Corrector { mirrored, ..corrector };
        let has_circuit = orbit.circuit.is_some();
        let curve = Self { corrector, path, range: unit, of, has_circuit, touch: None };
        let at = with_fifth(&curve.corrector.at(orbit.state, value), second.range.0 / unit);
        let point = curve.at_second(at[4], |corrector| corrector.evaluate(&first_four(&at)));
        let mut point = point.ok_or(LocusEnd::Lost)?;
        // the motion from the state of one that touches may miss the stop or strike it, by rounding
        point.orbit.passage.misses.extend(&orbit.passage.misses);
        curve.begun(at, point, &upwards).ok_or(LocusEnd::Lost)
    }

    /// These equations with the phase of the drive away from events at the stops, and their point near an
    /// orbit; `along` has the direction of its tangent.
    fn begun(mut self, mut at: Vector5<f64>, mut point: Point, along: &Vector5<f64>) -> Option<(Self, Spot)> {
        let touches: Vec<f64> = match self.of {
            BranchEvent::Grazing => {
                let ahead = self.at_second(at[4], |corrector| touch_near(corrector, &point))?;
                ahead.times(&self.corrector).to_vec()
            }
            _ => Vec::new(),
        };
        let phase = self.at_second(at[4], |corrector| corrector.clear_phase(&point, &touches));
        if let Some(phase) = phase {
            let orbit =
                self.at_second(at[4], |corrector| corrector.at_phase(&point.orbit, point.value, phase))?;
            self.corrector.phase = phase;
            let there = self.corrector.at(orbit.state, point.value);
            at = with_fifth(&there, at[4]);
            let misses = std::mem::take(&mut point.orbit.passage.misses);
            point = self.at_second(at[4], |corrector| corrector.evaluate(&there))?;
            point.orbit.passage.misses.extend(misses);
        }
        if self.of == BranchEvent::Grazing {
            let touch = self.at_second(at[4], |corrector| touch_near(corrector, &point))?;
            at = with_fifth(&touch.solution, at[4]);
            self.touch = Some(touch);
        }
        // at another phase the tangent has another direction in the state, and the same in the fields
        let along = across_fields(along);
        let spot = self.correct(at, &along)?;
        let along = tangent(&spot.slopes, &along)?;
        Some((self, Spot { along, ..spot }))
    }

    /// The result of `of` with the corrector at a value of the second field in its unit.
    fn at_second<T>(&self, second: f64, of: impl FnOnce(&Corrector) -> T) -> T {
        let family = self.corrector.family.with(&self.path, second * self.range);
        of(&Corrector { family: &family, ..self.corrector })
    }

    /// The orbit of a point with its state at a phase of the drive in forcing periods; `None` if the motion
    /// from that state ends early or does not come back to it.
    pub fn orbit_at(&self, spot: &Spot, phase: f64) -> Option<OrbitAnswer> {
        let Point { orbit, value, .. } = &spot.point;
        self.at_second(spot.at[4], |corrector| match &self.touch {
            Some(touch) => {
                let state = touch.at(first_four(&spot.at)).at_phase(corrector, &spot.point, phase)?;
                Some(OrbitAnswer { state, ..orbit.clone() })
            }
            None => {
                let moved = corrector.at_phase(orbit, *value, phase)?;
                let rows = Corrector { mirrored: false, phase, ..*corrector };
                moved.comes_back(&rows.map(*value)?).then_some(moved)
            }
        })
    }

    /// The same locus with states at another phase of the drive, where an event at a stop comes near to the
    /// present one; `None` where none does, or where the point is not found at the other phase.
    pub fn cleared(&self, spot: &Spot) -> Option<(Self, Spot)> {
        let Spot { at, point, along, .. } = spot;
        let touches = self.touch.as_ref().map(|touch| touch.at(first_four(at)).times(&self.corrector));
        let touches = touches.as_slice().as_flattened();
        self.at_second(at[4], |corrector| corrector.clear_phase(point, touches))?;
        let strobe = with_fifth(&self.corrector.at(point.orbit.state, point.value), at[4]);
        let curve = Self { path: self.path.clone(), touch: None, ..*self };
        curve.begun(strobe, point.clone(), along)
    }

    /// Ignores stops around the near misses of this point from here on.
    pub fn reopen(&mut self, spot: &Spot) {
        if let Some(touch) = &self.touch {
            let touch = touch.at(first_four(&spot.at));
            let opened = self.at_second(spot.at[4], |corrector| touch.reopened(corrector, &spot.point));
            self.touch = Some(opened.unwrap_or(touch));
        }
    }

    /// Whether an orbit at the same value of the second field grazes a stop right beside this point; of an
    /// orbit that grazes, whether it grazes once more.
    pub fn is_beside_a_grazing(&self, spot: &Spot) -> bool {
        if self.touch.is_some() {
            let OrbitAnswer { passage, .. } = &spot.point.orbit;
            let gaps = passage.misses.iter().filter(|miss| miss.gap <= AT_BOTH * self.corrector.units.length);
            return gaps.count() > if self.corrector.mirrored { 2 } else { 1 };
        }
        self.at_second(spot.at[4], |corrector| {
            let beside = grazings(corrector, &spot.point).into_iter();
            let far = beside.map(|(grazing, _)| (grazing.point.at.w - spot.point.at.w).abs());
            far.fold(f64::INFINITY, f64::min) <= BESIDE_A_GRAZING
        })
    }

    /// The point in the plane through a guess and normal to `across`.
    pub fn correct(&self, guess: Vector5<f64>, across: &Vector5<f64>) -> Option<Spot> {
        let Some(touch) = &self.touch else {
            let evaluate = |at: &Vector5<f64>| self.smooth(at);
            let ((point, slopes), at, _) = newton(guess, across, GOOD, evaluate)?;
            // the multiplier over the period, which the row has, is the square of that to the mirror image
            let over_period = if self.corrector.mirrored { 1.0 } else { self.unit() };
            let holds = is_at(&point, self.unit()) && has(&point.orbit.multipliers(), over_period);
            return holds.then_some(Spot { at, point, slopes, along: *across });
        };
        let look = |at: &Vector5<f64>| self.grazing(touch, at);
        let (slopes, at, left) = newton(guess, across, FINEST, look)?;
        let point = self.at_second(at[4], |corrector| {
            let touch = touch.at(first_four(&at));
            (left <= EXACT).then(|| touch.orbit(corrector))?
        })?;
        Some(Spot { at, point, slopes, along: *across })
    }

    /// The multiplier of the corrector's map on the locus.
    fn unit(&self) -> f64 {
        if self.of == BranchEvent::Fold { 1.0 } else { -1.0 }
    }

    /// The equations of a periodic orbit with a multiplier of 1 or -1.
    fn smooth(&self, at: &Vector5<f64>) -> Option<Equations<5, 4, (Point, [Vector5<f64>; 4])>> {
        let evaluate = |at: &Vector5<f64>| {
            self.at_second(at[4], |corrector| {
                let point = corrector.evaluate(&first_four(at))?;
                let off = corrector.units.apart(point.orbit.state, (&point.orbit.passage).into());
                let at_unit = characteristic(&point, self.unit());
                Some((point, off, at_unit))
            })
        };
        let (point, off, at_unit) = evaluate(at)?;
        let by_rest = self.corrector.slopes(&point.by_state, point.by_field);
        let difference = |axis: usize, half: f64| {
            let step = Vector5::ith(axis, half);
            let (above, below) = (evaluate(&(at + step))?, evaluate(&(at - step))?);
            let alike = !differ(&above.0.orbit, &point.orbit) && !differ(&below.0.orbit, &point.orbit);
            // a state may have been moved to the nearest admissible one
            let over = if axis == 4 { 2.0 * half } else { (above.0.at - below.0.at).sum() };
            let by = |a: f64, b: f64| (a - b) / over;
            let maps = [0, 1, 2].map(|i| by(above.1[i], below.1[i]));
            (alike && over != 0.0).then(|| (maps, by(above.2, below.2)))
        };
        let gentlest = point.orbit.gentlest_impact().unwrap_or(f64::INFINITY) / self.corrector.units.speed;
        let largest = DIFFERENCE.min(SHARE_OF_DEPTH * gentlest * gentlest);
        let mut last = Vector5::zeros();
        let mut by_second = [0.0; 3];
        for axis in 0..5 {
            if axis == 2 && !self.has_circuit {
                continue;
            }
            let halves = [largest, 0.1 * largest, 0.01 * largest];
            let (maps, slope) = halves.into_iter().find_map(|half| difference(axis, half))?;
            last[axis] = slope;
            if axis == 4 {
                by_second = difference(axis, FIELD_DIFFERENCE).map_or(maps, |(maps, _)| maps);
            }
        }
        let row = |i: usize| with_fifth(&by_rest[i], by_second[i]);
        let slopes = [row(0), row(1), row(2), last];
        let at = with_fifth(&point.at, at[4]);
        Some(Equations { at, off: [off[0], off[1], off[2], at_unit], slopes, of: (point, slopes) })
    }

    fn grazing(&self, touch: &Touch, at: &Vector5<f64>) -> Option<Equations<5, 4, [Vector5<f64>; 4]>> {
        let off = |at: &Vector5<f64>| {
            let touch = touch.at(first_four(at));
            self.at_second(at[4], |corrector| touch.residual(corrector))
        };
        let here = off(at)?;
        let mut slopes = [Vector5::zeros(), Vector5::zeros(), Vector5::zeros(), Vector5::ith(1, 1.0)];
        for axis in [0, 2, 3, 4] {
            if axis == 2 && !self.has_circuit {
                slopes[2][2] = -1.0;
                continue;
            }
            let step = Vector5::ith(axis, FIELD_DIFFERENCE);
            let side = |sign: f64| off(&(at + step * sign)).map(|off| (off, sign * FIELD_DIFFERENCE));
            let (above, below) = match (side(1.0), side(-1.0)) {
                (None, None) => return None,
                (above, below) => (above.unwrap_or((here, 0.0)), below.unwrap_or((here, 0.0))),
            };
            for (i, row) in slopes.iter_mut().take(3).enumerate() {
                row[axis] = (above.0[i] - below.0[i]) / (above.1 - below.1);
            }
        }
        Some(Equations { at: *at, off: [here[0], here[1], here[2], at[1]], slopes, of: slopes })
    }
}

/// The touch of the grazing orbit nearest to an orbit over the field.
fn touch_near(corrector: &Corrector, point: &Point) -> Option<Touch> {
    let all = grazings(corrector, point).into_iter().map(|(grazing, _)| grazing);
    let far = |grazing: &Grazing| (grazing.point.at.w - point.at.w).abs();
    let nearest = all.min_by(|a, b| far(a).total_cmp(&far(b)))?;
    Some(nearest.touch)
}

/// The part of a direction by both fields, or by the second if that is too small.
fn across_fields(along: &Vector5<f64>) -> Vector5<f64> {
    let fields = Vector5::new(0.0, 0.0, 0.0, along[3], along[4]);
    fields.try_normalize(1e-12).unwrap_or(Vector5::ith(4, 1.0))
}
