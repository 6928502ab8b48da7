//! Periodic orbits that graze a stop, and the orbits near them on both sides of the grazing.
//!
//! An orbit that turns back at the time t, at a gap g before a stop at s, leaves the state (s - g, 0) and
//! returns to it one period later. An orbit that strikes the stop at a speed u leaves (s, -e u) and returns
//! to (s, u). A circuit is then in a state w, to which it returns. If the stop is ignored near t, both
//! flights are smooth functions of t, of g or u, of w and of the field, and for g = 0 or u = 0 they are the
//! same orbit, which grazes the stop. So Newton's method finds it from either side, and the two parts of the
//! branch that meet there can be started from it, although the stroboscopic map changes like the square root
//! of the distance from it (Nordmark 1991). For a symmetric orbit half a period is computed, so that it
//! grazes both stops at once.

use std::ops::Range;

use nalgebra::Vector4;

use super::corrector::{Accuracy, Corrector, Equations, Point, newton};
use super::{Orbit, map_of};
use crate::dynamics::{Event, EventKind, Jacobian, MapState, Miss, Outcome, Passage, Side, StroboscopicMap};

/// Largest gap at which a stop may be grazed nearby, as a share of the length scale.
const SMALL_GAP: f64 = 0.1;

/// Largest number of turning points and impacts of an orbit that are tried, those with the smallest gaps and
/// speeds first.
const MAX_CANDIDATES: usize = 4;

/// Half the step of the central difference of a flight, in the units; few digits are needed.
const DIFFERENCE: f64 = 1e-7;

/// Gap or speed in the units at which the distance from the grazing orbit is measured first.
const FIRST: f64 = 1e-7;

/// Largest gap or speed, in the units, of an orbit near the grazing one.
const LARGEST: f64 = 0.3;

/// Range of the distance from the grazing orbit, relative to the requested one.
const DISTANCES: Range<f64> = 0.3..3.0;

/// Accuracy that is limited by rounding only.
const FINEST: Accuracy = Accuracy { change: 0.0, step: 1e-15 };

/// Accuracy of the grazing orbit in the units: of the state at the stop, of the return after a period, and of
/// the last step.
pub(super) const EXACT: f64 = 1e-9;

/// The side of a grazing on which an orbit lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Beside {
    Missing,
    Touching,
}

impl Beside {
    pub fn other(self) -> Self {
        match self {
            Self::Missing => Self::Touching,
            Self::Touching => Self::Missing,
        }
    }
}

/// An orbit that touches a stop without speed.
pub(super) struct Grazing<'a> {
    corrector: &'a Corrector<'a>,
    side: Side,
    /// Times in forcing periods after a strobe around which stops are ignored, with half the length of each
    /// interval.
    open: Vec<(f64, f64)>,
    /// Time in forcing periods after a strobe, 0, state of the circuit then and field in their units.
    solution: Vector4<f64>,
    /// The orbit, with the derivatives on the side that misses the stop.
    pub point: Point,
}

/// The maps with stops and without them.
struct Maps {
    with: StroboscopicMap,
    without: StroboscopicMap,
}

/// The grazing orbits near an orbit that turns back close to a stop or strikes it gently, and the side on
/// which that orbit lies.
pub(super) fn grazings<'a>(corrector: &'a Corrector<'a>, near: &Point) -> Vec<(Grazing<'a>, Beside)> {
    let contacts = near.orbit.contacts();
    if near.orbit.passage.misses.is_empty() && contacts.is_empty() {
        return Vec::new();
    }
    let Some(map) = corrector.map(near.value) else { return Vec::new() };
    let units = &corrector.units;
    let whole = f64::from(corrector.periods);
    let time = |t: f64| ((t - map.first_strobe()) / map.period()).rem_euclid(whole);
    let misses = near.orbit.passage.misses.iter();
    let misses = misses.map(|miss| (time(miss.t), miss.side, miss.gap / units.length, Beside::Missing));
    let misses = misses.filter(|miss| miss.2 < SMALL_GAP);
    let impacts = contacts.iter().filter(|event| event.kind == EventKind::Impact);
    let speed = |event: &Event| event.v_in.abs() / units.speed;
    let impacts = impacts.map(|event| (time(event.t), event.side, speed(event), Beside::Touching));
    // times, sides, gaps or speeds
    let mut turns: Vec<(f64, Side, f64, Beside)> = misses.clone().chain(impacts).collect();
    // a gap scales like the square of a speed
    let depth = |(_, _, size, beside): &(f64, Side, f64, Beside)| match beside {
        Beside::Missing => *size,
        Beside::Touching => size * size,
    };
    let flight = corrector.flight();
    let circuit_at = |t: f64| {
        let passage = map.pass_between(near.orbit.state, (0.0, t));
        (passage.outcome == Outcome::Done).then_some(passage.electrical / units.electrical)
    };
    // the first half of a symmetric orbit contains all contacts
    turns.retain(|turn| turn.0 < flight);
    turns.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    turns.truncate(MAX_CANDIDATES);
    let apart = |a: f64, b: f64| {
        let far = (a - b).rem_euclid(flight);
        far.min(flight - far)
    };
    let grazing = |(t, side, _, beside): (f64, Side, f64, Beside)| {
        let others = near.orbit.events_at_stops().map(|event| time(event.t));
        let others: Vec<f64> = others.filter(|other| apart(*other, t) > 1e-9).collect();
        let room = |at: f64| others.iter().map(|other| 0.5 * apart(at, *other)).fold(0.25 * flight, f64::min);
        let open = misses.clone().map(|miss| miss.0).chain([t]).map(|at| (at, room(at))).collect();
        let solution = Vector4::new(t, 0.0, circuit_at(t)?, near.at.w);
        let unsolved = Grazing { corrector, side, open, solution, point: near.clone() };
        Some((unsolved.solved()?, beside))
    };
    turns.into_iter().filter_map(grazing).collect()
}

impl Maps {
    fn of(corrector: &Corrector, value: f64) -> Option<Self> {
        let model = corrector.family.model(value).ok()?;
        let without = map_of(&model.without_stops(), corrector.phase)?;
        Some(Self { with: map_of(&model, corrector.phase)?, without })
    }
}

impl Grazing<'_> {
    /// The grazing orbit near this guess; `None` if Newton's method does not find it.
    fn solved(mut self) -> Option<Self> {
        let guess = self.solution;
        let (solution, left) = self.solve(guess, Beside::Missing)?;
        let range = self.corrector.units.range;
        let (_, room) = *self.open.last()?;
        if left > EXACT || (solution.x - guess.x).abs() > room {
            return None;
        }
        self.solution = solution;
        let maps = Maps::of(self.corrector, solution.w * range)?;
        let [start, _] = self.ends(&maps, &solution, Beside::Missing)?;
        let state = self.fly(&maps, start, (solution.x, solution.x.ceil()))?;
        self.point = self.at_strobe(&maps, state, solution.w * range)?;
        Some(self)
    }

    /// The times of the grazing in forcing periods after a strobe.
    pub fn times(&self) -> [f64; 2] {
        [self.solution.x, self.solution.x + self.corrector.flight()]
    }

    /// Position in m and restitution of the stop.
    fn stop(&self, maps: &Maps) -> Option<(f64, f64)> {
        let pair = maps.with.model().stops()?;
        let stop = if self.side == Side::Left { pair.left } else { pair.right }?;
        Some((stop.x, stop.restitution))
    }

    /// A span of time in parts, each with a flag whether it has stops.
    fn parts(&self, (from, to): (f64, f64)) -> Vec<(bool, (f64, f64))> {
        const ROUNDING: f64 = 1e-9;
        let mut parts = Vec::new();
        let mut at = from;
        while at < to {
            let (mut opens, mut closes) = (to, None::<f64>);
            for (middle, room) in &self.open {
                let since = (at - (middle - room) + ROUNDING).rem_euclid(self.corrector.flight()) - ROUNDING;
                if since < 2.0 * room - ROUNDING {
                    let end = at + 2.0 * room - since;
                    closes = Some(closes.map_or(end, |other| other.max(end)));
                } else {
                    opens = opens.min(at + self.corrector.flight() - since);
                }
            }
            let until = closes.map_or(opens, |closes| closes.min(to));
            parts.push((closes.is_none(), (at, until)));
            at = until;
        }
        parts
    }

    /// The state after a span of time, with stops ignored near the grazing.
    fn fly(&self, maps: &Maps, state: MapState, span: (f64, f64)) -> Option<MapState> {
        self.parts(span).into_iter().try_fold(state, |state, (stops, span)| {
            let map = if stops { &maps.with } else { &maps.without };
            let passage = map.pass_between(state, span);
            (passage.outcome == Outcome::Done).then(|| MapState::from(&passage))
        })
    }

    /// The state that leaves the grazing, and the state that must be reached after the flight.
    fn ends(&self, maps: &Maps, at: &Vector4<f64>, beside: Beside) -> Option<[MapState; 2]> {
        let (stop, restitution) = self.stop(maps)?;
        let units = &self.corrector.units;
        let toward = if self.side == Side::Left { -at.y } else { at.y };
        let electrical = at.z * units.electrical;
        let state = |x: f64, v: f64| MapState { x, v, electrical };
        Some(match beside {
            Beside::Missing => [state(stop - toward * units.length, 0.0); 2],
            Beside::Touching => {
                let speed = toward * units.speed;
                [state(stop, -restitution * speed), state(stop, speed)]
            }
        })
    }

    /// The residual after a flight that begins at a time with a gap or speed, in the units.
    fn off(&self, maps: &Maps, at: &Vector4<f64>, beside: Beside) -> Option<[f64; 3]> {
        let [start, back] = self.ends(maps, at, beside)?;
        let end = self.fly(maps, start, (at.x, at.x + self.corrector.flight()))?;
        Some(self.corrector.units.apart(back, self.corrector.image(end)))
    }

    /// The orbit with a gap or speed in the units, from a guess, and the length of the last step.
    fn solve(&self, guess: Vector4<f64>, beside: Beside) -> Option<(Vector4<f64>, f64)> {
        let look = |at: &Vector4<f64>| {
            let maps = |z: f64| Maps::of(self.corrector, z * self.corrector.units.range);
            let here = maps(at.w)?;
            let off = self.off(&here, at, beside)?;
            let side = |step: Vector4<f64>| {
                let to = at + step;
                let other = if step.w == 0.0 { None } else { Some(maps(to.w)?) };
                Some((self.off(other.as_ref().unwrap_or(&here), &to, beside)?, step.sum()))
            };
            let slope = |step: Vector4<f64>| {
                let (above, below) = match (side(step), side(-step)) {
                    (None, None) => return None,
                    (above, below) => (above.unwrap_or((off, 0.0)), below.unwrap_or((off, 0.0))),
                };
                Some([0, 1, 2].map(|i| (above.0[i] - below.0[i]) / (above.1 - below.1)))
            };
            let by_time = slope(Vector4::x() * DIFFERENCE)?;
            let by_field = slope(Vector4::w() * DIFFERENCE)?;
            let by_circuit = match here.with.model().has_electrical_state() {
                true => slope(Vector4::z() * DIFFERENCE)?,
                false => [0.0, 0.0, -1.0],
            };
            // the gap or speed is fixed
            let slopes = [0, 1, 2].map(|i| Vector4::new(by_time[i], 0.0, by_circuit[i], by_field[i]));
            Some(Equations { at: *at, off, slopes, of: () })
        };
        newton(guess, &Vector4::y(), FINEST, look).map(|((), at, left)| (at, left))
    }

    /// The grazing orbit from its state at a strobe; `None` if it does not touch the stop or does not return.
    fn at_strobe(&self, maps: &Maps, state: MapState, value: f64) -> Option<Point> {
        let corrector = self.corrector;
        let flight = corrector.flight();
        let identity = Jacobian::identity(maps.with.model().has_electrical_state());
        let (mut at, mut by_state, mut rested) = (state, identity, false);
        let (mut events, mut misses, mut impacts, mut determinant) = (Vec::new(), Vec::new(), 0, Some(1.0));
        for (stops, span) in self.parts((0.0, flight)) {
            let map = if stops { &maps.with } else { &maps.without };
            let (passage, part) = map.pass_part_with_jacobian(at, span);
            if passage.outcome != Outcome::Done {
                return None;
            }
            at = MapState::from(&passage);
            by_state = part.after(&by_state);
            rested |= passage.rested;
            events.extend(passage.events);
            misses.extend(passage.misses);
            impacts += passage.impacts;
            determinant = determinant.zip(passage.determinant).map(|(before, part)| before * part);
        }
        // the contact within the flight, at the other stop if the motion is mirrored an odd number of times
        let flights = (self.solution.x / flight).floor();
        let time = self.solution.x - flights * flight;
        let MapState { mut x, v, .. } = self.fly(maps, state, (0.0, time))?;
        let mut side = self.side;
        if corrector.mirrored && flights % 2.0 != 0.0 {
            (side, x) = (side.other(), -x);
        }
        let gap = (x - self.stop(maps)?.0).abs();
        let t = maps.with.first_strobe() + time * maps.with.period();
        misses.push(Miss { t, side, gap });
        let units = &corrector.units;
        let off = corrector.units.apart(state, corrector.image(at));
        let offsets = [off[0], off[1], off[2], gap / units.length, v / units.speed].map(f64::abs);
        if !offsets.iter().all(|part| *part <= EXACT) {
            return None;
        }
        let mut passage = Passage {
            state: (at.x, at.v),
            electrical: at.electrical,
            events,
            determinant,
            rested,
            misses,
            outcome: Outcome::Done,
            impacts,
        };
        let mut jacobian = by_state;
        if corrector.mirrored {
            passage = passage.with_mirror_image(flight * maps.with.period());
            (by_state, jacobian) = (by_state.mirrored(), by_state.after(&by_state));
        }
        let circuit = maps.with.model().circuit_state();
        let orbit = Orbit { period: corrector.periods, state, passage, jacobian, circuit };
        let determinant = determinant.unwrap_or_else(|| by_state.determinant());
        let at = corrector.at(state, value);
        Some(Point { at, value, orbit, by_state, determinant, by_field: [0.0; 3] })
    }

    /// The state at another phase of the drive.
    pub fn at_phase(&self, phase: f64) -> Option<MapState> {
        let maps = Maps::of(self.corrector, self.point.value)?;
        self.fly(&maps, self.point.orbit.state, (0.0, (phase - self.corrector.phase).rem_euclid(1.0)))
    }

    /// The orbit on one side of the grazing at about this distance in the units.
    pub fn beside(&self, beside: Beside, distance: f64) -> Option<Point> {
        let (first, _) = self.solve(self.solution + Vector4::y() * FIRST, beside)?;
        let rate = (self.strobe(&first, beside)? - self.point.at).norm() / FIRST;
        let size = distance / rate;
        if !(size < LARGEST) {
            return None;
        }
        let (there, _) = self.solve(self.solution + (first - self.solution) * (size / FIRST), beside)?;
        let at = self.strobe(&there, beside)?;
        let away = (at - self.point.at).try_normalize(0.0)?;
        let point = self.corrector.correct(at, &away)?;
        let far = (at - self.point.at).norm();
        let is_there = (DISTANCES.start * distance..DISTANCES.end * distance).contains(&far)
            && (point.at - at).norm() <= 0.1 * distance;
        (is_there && self.is_beside(&point, beside)).then_some(point)
    }

    /// Whether an orbit has the contacts of the grazing one, with one more if it is on the touching side.
    fn is_beside(&self, point: &Point, beside: Beside) -> bool {
        let touches = |point: &Point, side: Side| {
            let contacts = point.orbit.contacts();
            contacts.iter().filter(|event| event.side == side).count()
        };
        [Side::Left, Side::Right].into_iter().all(|side| {
            let touches_once_more =
                beside == Beside::Touching && (side == self.side || self.corrector.mirrored);
            touches(point, side) == touches(&self.point, side) + usize::from(touches_once_more)
        })
    }

    /// The coordinates at a strobe of an orbit near the grazing one.
    fn strobe(&self, at: &Vector4<f64>, beside: Beside) -> Option<Vector4<f64>> {
        let value = at.w * self.corrector.units.range;
        let maps = Maps::of(self.corrector, value)?;
        let [start, _] = self.ends(&maps, at, beside)?;
        let passage = maps.with.pass_between(start, (at.x, at.x.ceil()));
        (passage.outcome == Outcome::Done).then(|| self.corrector.at((&passage).into(), value))
    }
}
