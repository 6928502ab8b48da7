//! Branch of periodic motions over a field, followed through folds by pseudo-arclength (Keller 1977).

use std::fmt;

use nalgebra::Vector3;

use super::corrector::{Corrector, Point, Units};
use super::events::{BranchEvent, between, differ, grazes};
use super::{NoOrbit, Orbit, SAME, orbit, with_orbits};
use crate::scene::column_names;
use crate::study::family::Family;
use crate::study::{Table, Task};

/// Steps of the walk in the units of the branch: the first, the longest, and the one below which it does not
/// go on.
const FIRST: f64 = 2e-3;
const LONGEST: f64 = 1e-2;
const SHORTEST: f64 = 1e-9;

/// The step below which a branch near a grazing is looked for on its other side: there the map changes as
/// the root of the distance, and steps would become ever shorter.
const NEAR_A_GRAZING: f64 = 1e-5;

/// Cosine of the angle by which the direction may turn in a step, and by which a step may lie beside it.
const STRAIGHT: f64 = 0.9;

/// The change in a step of where a mass is that rests on its way, as a share of its room.
const CHANGE: f64 = 0.1;

const MOST_POINTS: usize = 5000;

/// Distances at which another motion is looked for where the branch comes to a grazing.
const AROUND: [f64; 4] = [3e-3, 1e-3, 1e-4, 1e-5];

/// Why a branch ended.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum BranchEnd {
    /// At an end of the range.
    Range,
    /// It came back to where it had been.
    Closed,
    /// The motion touches a stop without speed, and no motion near to it goes on.
    Grazing,
    /// A motion that rests on its way leaps to another one: the mass, released as before, no longer goes
    /// where it went, as where it just fails to pass the barrier.
    Leap,
    /// Newton's method finds no motion near the last one: it leaps, changes too fast, or ends early.
    Lost,
    /// At the most points.
    Points,
}

impl fmt::Display for BranchEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Range => "at an end of the range",
            Self::Closed => "where it had been before",
            Self::Grazing => "where the motion touches a stop without speed, and none near to it goes on",
            Self::Leap => "where the motion leaps to another one",
            Self::Lost => {
                "where no motion near the last one was found: it may leap to another, change too \
                 fast, or end early"
            }
            Self::Points => "after 5000 motions",
        })
    }
}

/// A branch: its motions in order, each with the value of the field and what happens there.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Branch {
    /// The field that changes.
    pub field: String,
    /// Its value at each motion.
    pub values: Vec<f64>,
    /// The motions.
    pub orbits: Vec<Orbit>,
    /// What happens there.
    pub events: Vec<Option<BranchEvent>>,
    /// Why the branch ended after the last.
    pub end: BranchEnd,
}

impl Branch {
    /// A row a motion: the field, what [`orbit_table`](super::orbit_table) has, and `event`.
    pub fn table(&self) -> Table {
        let column = column_names(&[&self.field]).concat();
        let table = Table::new().with(column, self.values.iter().copied().collect());
        let name = |event: &Option<BranchEvent>| event.map_or("", BranchEvent::name);
        with_orbits(table, &self.orbits).each("event", &self.events, name)
    }
}

/// The branch of periodic motions of a family over `field` from one value towards another, on from the motion
/// that a run comes to at the first; `phase` in forcing periods, `period` where one is asked for.
///
/// Ticks once a motion. An error is one of the first motion.
pub fn branch(
    family: &Family,
    field: &str,
    (from, to): (f64, f64),
    (phase, period): (f64, Option<u32>),
    task: &Task,
) -> Result<Branch, NoOrbit> {
    let model = family.model(from).map_err(|_| NoOrbit::NotConverged)?;
    let first = orbit(&model, phase, period, task.cancel)?;
    let scales = model.scales();
    let units = Units { length: scales.length, speed: scales.speed, range: (to - from).abs() };
    let corrector = Corrector { family, phase, periods: first.period, units };
    let upwards = Vector3::new(0.0, 0.0, (to - from).signum());
    let point = corrector.correct(corrector.at(first.state, from), &upwards).ok_or(NoOrbit::NotConverged)?;
    let along = corrector.tangent(&point, &upwards).ok_or(NoOrbit::Grazing)?;
    let branch = Branch {
        field: field.to_owned(),
        values: Vec::new(),
        orbits: Vec::new(),
        events: Vec::new(),
        end: BranchEnd::Points,
    };
    let range = [from.min(to), from.max(to)];
    let ends = range.map(|own| own / units.range);
    let room = match model.stop_positions() {
        (Some(left), Some(right)) => scales.length.min(0.5 * (right - left)),
        _ => scales.length,
    };
    let mut walk = Walk {
        corrector,
        branch,
        range,
        ends,
        room,
        phase,
        told: Vec::new(),
        meets: false,
        at: (point, along),
    };
    walk.add(None, &walk.at.0.clone());
    walk.branch.end = walk.run_out(task)?;
    Ok(walk.branch)
}

/// A walk along a branch.
struct Walk<'a> {
    /// At a phase of the drive away from impacts, where a state has no derivative by the field.
    corrector: Corrector<'a>,
    branch: Branch,
    /// The range, and its ends in its unit.
    range: [f64; 2],
    ends: [f64; 2],
    /// A length in m that is a share of the room that the mass has.
    room: f64,
    /// The phase at which motions are told, in forcing periods.
    phase: f64,
    /// The motions there, with their distance along the branch from the first.
    told: Vec<(Vector3<f64>, f64)>,
    /// Whether the last of them is one that the branch had left behind.
    meets: bool,
    /// The last point, and the direction there.
    at: (Point, Vector3<f64>),
}

impl Walk<'_> {
    /// Goes on until the branch ends.
    fn run_out(&mut self, task: &Task) -> Result<BranchEnd, NoOrbit> {
        let mut step = FIRST;
        while self.branch.values.len() < MOST_POINTS {
            if task.is_cancelled() {
                return Err(NoOrbit::Cancelled);
            }
            (task.tick)();
            self.keep_clear();
            let (point, along) = &self.at;
            let guess = point.at + along * step;
            let mut beyond = self.end_before(guess.z);
            let mut found = None;
            if beyond.is_none()
                && let Some(point) = self.corrector.correct(guess, along)
            {
                beyond = self.end_before(point.at.z);
                found = self.corrector.tangent(&point, along).map(|onward| (point, onward));
            }
            if let Some(end) = beyond {
                found = self.last(end);
            }
            let leaps = found.is_some() && self.at.0.forgets();
            match found.filter(|next| self.follows(next)) {
                Some(next) => {
                    self.go_to(next);
                    if beyond.is_some() {
                        return Ok(BranchEnd::Range);
                    }
                    if self.is_closed(step) {
                        return Ok(BranchEnd::Closed);
                    }
                    step = (step * 1.3).min(LONGEST);
                }
                None => step *= 0.5,
            }
            let at_a_grazing = step < NEAR_A_GRAZING && grazes(&self.at.0, &self.corrector.units);
            if at_a_grazing && let Some((next, is_last)) = self.past_a_grazing() {
                self.go_to(next);
                if is_last {
                    return Ok(BranchEnd::Range);
                }
                if self.is_closed(0.0) {
                    return Ok(BranchEnd::Closed);
                }
                step = FIRST * 0.1;
            } else if step < SHORTEST {
                let leaves = beyond.is_some_and(|end| (self.at.0.at.z - end).abs() < SHORTEST);
                return Ok(match self.branch.events.last_mut() {
                    _ if leaves => BranchEnd::Range,
                    // each impact of a mass that chatters may be gentle
                    _ if leaps => BranchEnd::Leap,
                    Some(event) if at_a_grazing => {
                        *event = Some(BranchEvent::Grazing);
                        BranchEnd::Grazing
                    }
                    _ => BranchEnd::Lost,
                });
            }
        }
        Ok(BranchEnd::Points)
    }

    /// The end of the range beyond which a value of the field lies.
    fn end_before(&self, to: f64) -> Option<f64> {
        let [low, high] = self.ends;
        if to < low { Some(low) } else { (to > high).then_some(high) }
    }

    /// The point at an end of the range.
    fn last(&self, end: f64) -> Option<(Point, Vector3<f64>)> {
        let (point, along) = &self.at;
        let across = Vector3::new(0.0, 0.0, 1.0);
        let share = (end - point.at.z) / along.z;
        let next = self.corrector.correct(point.at + along * share, &across)?;
        let onward = self.corrector.tangent(&next, along)?;
        // at an end already, the branch first goes round the fold just before it
        (SHORTEST..=2.0 * LONGEST).contains(&(next.at - point.at).norm()).then_some((next, onward))
    }

    /// Whether a point continues the branch: it lies in its direction, and so does its own direction.
    fn follows(&self, (next, onward): &(Point, Vector3<f64>)) -> bool {
        let (point, along) = &self.at;
        let step = next.at - point.at;
        // a motion that is a function of the field does not turn back
        let turns = point.forgets() && next.forgets() && onward.z * along.z < 0.0;
        !turns
            && onward.dot(along) > STRAIGHT
            && step.dot(along) > STRAIGHT * step.norm()
            && self.is_near(next)
    }

    /// Whether a motion that rests on its way, which begins anew at each release whatever it was before, is
    /// where the last one was all the time.
    fn is_near(&self, next: &Point) -> bool {
        let point = &self.at.0;
        if !point.forgets() && !next.forgets() {
            return true;
        }
        let all = |point: &Point| self.corrector.displacements(point);
        let Some((before, after)) = all(point).zip(all(next)) else { return false };
        let far = before.iter().zip(&after).map(|(a, b)| (a - b).abs());
        far.fold(0.0, f64::max) <= CHANGE * self.room
    }

    fn go_to(&mut self, next: (Point, Vector3<f64>)) {
        let (point, along) = &self.at;
        for (event, there) in between(&self.corrector, (point, along.z), (&next.0, next.1.z)) {
            self.add(Some(event), &there);
        }
        if !self.meets {
            self.add(None, &next.0);
        }
        self.at = next;
    }

    /// Adds a motion, told at the phase that was asked for.
    fn add(&mut self, event: Option<BranchEvent>, point: &Point) {
        let told = self.corrector.at_phase(&point.orbit, point.value, self.phase);
        let told = told.unwrap_or_else(|| point.orbit.clone());
        let at = self.corrector.at(told.state, point.value);
        let far = self.told.last().map_or(0.0, |(last, far)| far + (at - last).norm());
        // only where something happens does it come to the same motion again, and not beside it
        let left = self.told.iter().take_while(|(_, own)| far - own > LONGEST);
        self.meets |= left.into_iter().any(|(own, _)| (at - own).amax() <= SAME);
        self.told.push((at, far));
        let [low, high] = self.range;
        // a motion at an end is so but for the rounding of its unit
        self.branch.values.push(if event.is_none() { point.value.clamp(low, high) } else { point.value });
        self.branch.orbits.push(told);
        self.branch.events.push(event);
    }

    /// Takes states at another phase of the drive where an impact comes near to the present one.
    fn keep_clear(&mut self) {
        let (point, along) = &self.at;
        let Some(later) = self.corrector.clear_phase(point) else { return };
        let phase = (self.corrector.phase + later).rem_euclid(1.0);
        let Some(orbit) = self.corrector.at_phase(&point.orbit, point.value, phase) else { return };
        let upwards = Vector3::new(0.0, 0.0, along.z.signum());
        let corrector = Corrector { phase, ..self.corrector };
        let next = corrector.correct(corrector.at(orbit.state, point.value), &upwards);
        if let Some(next) = next
            && let Some(onward) = corrector.tangent(&next, &upwards)
        {
            (self.corrector, self.at) = (corrector, (next, onward));
        }
    }

    /// Whether the last motion is the first one, but for the length of a step, or the branch has met itself.
    fn is_closed(&self, step: f64) -> bool {
        let Some(((last, _), (first, _))) = self.told.last().zip(self.told.first()) else { return false };
        let farthest = self.told.iter().map(|(own, _)| (own - first).norm()).fold(0.0, f64::max);
        self.meets || (last - first).norm() < 0.5 * step && farthest > 10.0 * step
    }

    /// A motion that touches the stops otherwise, near the last one, with the direction away from it; and
    /// whether it is the one at the end of the range, beyond which the branch goes.
    fn past_a_grazing(&self) -> Option<((Point, Vector3<f64>), bool)> {
        let (last, _) = &self.at;
        let directions = self.corrector.directions_past(last);
        let starts = AROUND.iter().flat_map(|far| directions.iter().map(move |own| (*far, own)));
        for (distance, direction) in starts {
            let beside = |point: &Point| {
                let far = (point.at - last.at).norm();
                far <= 3.0 * distance && differ(last, point) && self.is_near(point)
            };
            let found = self.corrector.correct(last.at + direction * distance, direction);
            let Some(mut point) = found.filter(|own| beside(own)) else { continue };
            let away = point.at - last.at;
            if away.norm() < 0.3 * distance {
                continue;
            }
            let beyond = self.end_before(point.at.z);
            if let Some(end) = beyond {
                let guess = last.at + away * ((end - last.at.z) / away.z);
                let Some(own) = self.corrector.correct(guess, &Vector3::z()).filter(&beside) else {
                    continue;
                };
                point = own;
            }
            if let Some(onward) = self.corrector.tangent(&point, &away.normalize()) {
                return Some(((point, onward), beyond.is_some()));
            }
        }
        None
    }
}
