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
use super::{OrbitAnswer, map_of};
use crate::dynamics::{
    Event, EventKind, Jacobian, MapState, Miss, Model, Outcome, Passage, Side, StroboscopicMap,
};

/// Largest gap at which a stop may be grazed nearby, as a share of the length scale.
const SMALL_GAP: f64 = 0.1;

/// Turning points and impacts of an orbit that are tried, those with the smallest gaps and speeds first.
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
pub(super) const FINEST: Accuracy = Accuracy { change: 0.0, step: 1e-15 };

/// Time in forcing periods within which a turning point at a stop is the touch itself.
const AT_ONCE: f64 = 1e-4;

/// Speed of an impact, in the units, below which it is the touch itself: half its square is about [`EXACT`].
pub(super) const GENTLEST: f64 = 1e-4;

/// Accuracy of the grazing orbit in the units: of the state at the stop, of the return, and of the last step.
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

#[derive(Debug, Clone)]
pub(super) struct Touch {
    side: Side,
    /// Times in forcing periods after a strobe around which stops are ignored, with half the length of each.
    open: Vec<(f64, f64)>,
    /// Time in forcing periods after a strobe, 0, state of the circuit then and field in their units.
    pub solution: Vector4<f64>,
}

/// An orbit that touches a stop without speed.
pub(super) struct Grazing<'a> {
    corrector: &'a Corrector<'a>,
    pub touch: Touch,
    /// The orbit, with the derivatives on the side that misses the stop.
    pub point: Point,
}

/// The maps with stops and without them at a value of the field.
struct Maps<'a> {
    corrector: &'a Corrector<'a>,
    with: StroboscopicMap<'a>,
    without: StroboscopicMap<'a>,
}

/// The grazing orbits near an orbit that nearly touches a stop or strikes it gently, and the side it lies on.
pub(super) fn grazings<'a>(corrector: &'a Corrector<'a>, near: &Point) -> Vec<(Grazing<'a>, Beside)> {
    let contacts = near.orbit.contacts();
    if near.orbit.passage.misses.is_empty() && contacts.is_empty() {
        return Vec::new();
    }
    let Some(map) = corrector.map(near.value) else { return Vec::new() };
    let units = &corrector.units;
    let time = |t: f64| time_of(corrector, &map, t);
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
    let grazing = |(t, side, _, beside): (f64, Side, f64, Beside)| {
        let solution = Vector4::new(t, 0.0, circuit_at(t)?, near.at.w);
        let touch = Touch { side, open: openings(corrector, &map, near, t), solution };
        let unsolved = Grazing { corrector, touch, point: near.clone() };
        Some((unsolved.solved()?, beside))
    };
    turns.into_iter().filter_map(grazing).collect()
}

/// Time in forcing periods of an event of an orbit at the time t in s.
fn time_of(corrector: &Corrector, map: &StroboscopicMap, t: f64) -> f64 {
    ((t - map.first_strobe()) / map.period()).rem_euclid(f64::from(corrector.periods))
}

/// Distance of two times within a flight, whose end is followed by its beginning.
fn apart(a: f64, b: f64, flight: f64) -> f64 {
    let far = (a - b).rem_euclid(flight);
    far.min(flight - far)
}

/// The intervals around the near misses of an orbit and its touch at the time `t` in which stops are ignored.
fn openings(corrector: &Corrector, map: &StroboscopicMap, near: &Point, t: f64) -> Vec<(f64, f64)> {
    let flight = corrector.flight();
    let apart = |a: f64, b: f64| apart(a, b, flight);
    // by rounding the touch may be an impact
    let is_touch = |event: &Event| {
        let far = apart(time_of(corrector, map, event.t), t);
        far <= 1e-9 || far <= AT_ONCE && event.v_in.abs() <= GENTLEST * corrector.units.speed
    };
    let others = near.orbit.events_at_stops().filter(|event| !is_touch(event));
    let others: Vec<f64> = others.map(|event| time_of(corrector, map, event.t)).collect();
    let room = |at: f64| others.iter().map(|other| 0.5 * apart(at, *other)).fold(0.25 * flight, f64::min);
    let misses = near.orbit.passage.misses.iter();
    let misses = misses.filter(|miss| miss.gap / corrector.units.length < SMALL_GAP);
    misses.map(|miss| time_of(corrector, map, miss.t)).chain([t]).map(|at| (at, room(at))).collect()
}

impl<'a> Maps<'a> {
    fn of(corrector: &'a Corrector<'a>, value: f64) -> Option<Self> {
        let model = corrector.model(value)?;
        let map = |model: &Model| map_of(model, corrector.phase, corrector.cancel);
        Some(Self { corrector, with: map(&model)?, without: map(&model.without_stops())? })
    }
}

impl Touch {
    /// The times of the touch in forcing periods after a strobe.
    pub fn times(&self, corrector: &Corrector) -> [f64; 2] {
        [self.solution.x, self.solution.x + corrector.flight()]
    }

    pub fn at(&self, solution: Vector4<f64>) -> Self {
        Self { solution, ..self.clone() }
    }

    /// The touch near that of an orbit, with stops ignored around the near misses of that orbit.
    pub fn reopened(&self, corrector: &Corrector, near: &Point) -> Option<Self> {
        let map = corrector.map(near.value)?;
        Some(Self { open: openings(corrector, &map, near, self.solution.x), ..self.clone() })
    }

    /// The residual of the orbit that grazes, in the units.
    pub fn residual(&self, corrector: &Corrector) -> Option<[f64; 3]> {
        let maps = Maps::of(corrector, self.solution.w * corrector.units.range)?;
        self.off(&maps, &self.solution, Beside::Missing)
    }

    /// The orbit that grazes; `None` if it does not touch the stop or does not return.
    pub fn orbit(&self, corrector: &Corrector) -> Option<Point> {
        let value = self.solution.w * corrector.units.range;
        let maps = Maps::of(corrector, value)?;
        let [start, _] = self.ends(&maps, &self.solution, Beside::Missing)?;
        let state = self.fly(&maps, start, (self.solution.x, self.solution.x.ceil()))?;
        self.at_strobe(&maps, state, value)
    }

    /// The state of the orbit that grazes at another phase of the drive.
    pub fn at_phase(&self, corrector: &Corrector, point: &Point, phase: f64) -> Option<MapState> {
        let maps = Maps::of(corrector, point.value)?;
        self.fly(&maps, point.orbit.state, (0.0, (phase - corrector.phase).rem_euclid(1.0)))
    }

    /// A span of time in parts, each with a flag whether it has stops.
    fn parts(&self, maps: &Maps, (from, to): (f64, f64)) -> Vec<(bool, (f64, f64))> {
        const ROUNDING: f64 = 1e-9;
        let flight = maps.corrector.flight();
        let mut parts = Vec::new();
        let mut at = from;
        while at < to {
            let (mut opens, mut closes) = (to, None::<f64>);
            for (middle, room) in &self.open {
                let since = (at - (middle - room) + ROUNDING).rem_euclid(flight) - ROUNDING;
                if since < 2.0 * room - ROUNDING {
                    let end = at + 2.0 * room - since;
                    closes = Some(closes.map_or(end, |other| other.max(end)));
                } else {
                    opens = opens.min(at + flight - since);
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
        self.parts(maps, span).into_iter().try_fold(state, |state, (stops, span)| {
            let map = if stops { &maps.with } else { &maps.without };
            let passage = map.pass_between(state, span);
            (passage.outcome == Outcome::Done).then(|| MapState::from(&passage))
        })
    }

    /// The state that leaves the grazing, and the state that must be reached after the flight.
    fn ends(&self, maps: &Maps, at: &Vector4<f64>, beside: Beside) -> Option<[MapState; 2]> {
        let stop = maps.with.model().stop(self.side)?;
        let units = &maps.corrector.units;
        let toward = if self.side == Side::Left { -at.y } else { at.y };
        let electrical = at.z * units.electrical;
        let state = |x: f64, v: f64| MapState { x, v, electrical };
        Some(match beside {
            Beside::Missing => [state(stop.x - toward * units.length, 0.0); 2],
            Beside::Touching => {
                let speed = toward * units.speed;
                [state(stop.x, -stop.restitution * speed), state(stop.x, speed)]
            }
        })
    }

    /// The residual after a flight that begins at a time with a gap or speed, in the units.
    fn off(&self, maps: &Maps, at: &Vector4<f64>, beside: Beside) -> Option<[f64; 3]> {
        let [start, back] = self.ends(maps, at, beside)?;
        let end = self.fly(maps, start, (at.x, at.x + maps.corrector.flight()))?;
        Some(maps.corrector.units.apart(back, maps.corrector.image(end)))
    }

    /// The grazing orbit from its state at a strobe; `None` if it does not touch the stop or does not return.
    fn at_strobe(&self, maps: &Maps, state: MapState, value: f64) -> Option<Point> {
        let corrector = maps.corrector;
        let flight = corrector.flight();
        let identity = Jacobian::identity(maps.with.model().has_electrical_state());
        let (mut at, mut by_state, mut rested) = (state, identity, false);
        let (mut events, mut misses, mut impacts, mut determinant) = (Vec::new(), Vec::new(), 0, Some(1.0));
        for (stops, span) in self.parts(maps, (0.0, flight)) {
            let map = if stops { &maps.with } else { &maps.without };
            let (passage, part) = map.pass_part_with_jacobian(at, span);
            if passage.outcome != Outcome::Done {
                return None;
            }
            let before = std::mem::replace(&mut at, MapState::from(&passage));
            misses.extend(if stops { passage.misses } else { missed(maps, before, span)? });
            by_state = part.after(&by_state);
            rested |= passage.rested;
            events.extend(passage.events);
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
        let gap = (x - maps.with.model().stop(self.side)?.x).abs();
        let t = maps.with.first_strobe() + time * maps.with.period();
        misses.retain(|miss| apart(time_of(corrector, &maps.with, miss.t), time, flight) > AT_ONCE);
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
        let orbit = OrbitAnswer { period: corrector.periods, state, passage, jacobian, circuit };
        let determinant = corrector.determinant(determinant, &by_state);
        let at = corrector.at(state, value);
        Some(Point { at, value, orbit, by_state, determinant, by_field: [0.0; 3] })
    }
}

/// The near misses of the motion from a state, with the touches; `None` if it strikes a stop hard.
fn missed(maps: &Maps, from: MapState, span: (f64, f64)) -> Option<Vec<Miss>> {
    let Passage { events, mut misses, .. } = maps.with.pass_between(from, span);
    let touches = events.iter().filter(|event| event.kind == EventKind::Impact);
    misses.extend(touches.clone().map(|event| Miss { t: event.t, side: event.side, gap: 0.0 }));
    let is_gentle = |event: &Event| event.v_in.abs() <= GENTLEST * maps.corrector.units.speed;
    touches.into_iter().all(is_gentle).then_some(misses)
}

impl Grazing<'_> {
    /// The grazing orbit near this guess; `None` if Newton's method does not find it.
    fn solved(mut self) -> Option<Self> {
        let guess = self.touch.solution;
        let (solution, left) = self.solve(guess, Beside::Missing)?;
        let (_, room) = *self.touch.open.last()?;
        if left > EXACT || (solution.x - guess.x).abs() > room {
            return None;
        }
        self.touch.solution = solution;
        self.point = self.touch.orbit(self.corrector)?;
        Some(self)
    }

    /// The orbit with a gap or speed in the units, from a guess, and the length of the last step.
    fn solve(&self, guess: Vector4<f64>, beside: Beside) -> Option<(Vector4<f64>, f64)> {
        let look = |at: &Vector4<f64>| {
            let maps = |z: f64| Maps::of(self.corrector, z * self.corrector.units.range);
            let here = maps(at.w)?;
            let off = self.touch.off(&here, at, beside)?;
            let side = |step: Vector4<f64>| {
                let to = at + step;
                let other = if step.w == 0.0 { None } else { Some(maps(to.w)?) };
                Some((self.touch.off(other.as_ref().unwrap_or(&here), &to, beside)?, step.sum()))
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

    /// The orbit on one side of the grazing at about this distance in the units.
    pub fn beside(&self, beside: Beside, distance: f64) -> Option<Point> {
        let (first, _) = self.solve(self.touch.solution + Vector4::y() * FIRST, beside)?;
        let rate = (self.strobe(&first, beside)? - self.point.at).norm() / FIRST;
        let size = distance / rate;
        if !(size < LARGEST) {
            return None;
        }
        let (there, _) =
            self.solve(self.touch.solution + (first - self.touch.solution) * (size / FIRST), beside)?;
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
                beside == Beside::Touching && (side == self.touch.side || self.corrector.mirrored);
            touches(point, side) == touches(&self.point, side) + usize::from(touches_once_more)
        })
    }

    /// The coordinates at a strobe of an orbit near the grazing one.
    fn strobe(&self, at: &Vector4<f64>, beside: Beside) -> Option<Vector4<f64>> {
        let value = at.w * self.corrector.units.range;
        let maps = Maps::of(self.corrector, value)?;
        let [start, _] = self.touch.ends(&maps, at, beside)?;
        let passage = maps.with.pass_between(start, (at.x, at.x.ceil()));
        (passage.outcome == Outcome::Done).then(|| self.corrector.at((&passage).into(), value))
    }
}
