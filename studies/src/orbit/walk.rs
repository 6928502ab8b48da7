//! Continuation of a branch of periodic orbits: around folds by pseudo-arclength, and across grazings.

use nalgebra::Vector4;

use super::corrector::{Corrector, Point};
use super::events::{BranchEvent, between, differ};
use super::grazing::{Beside, Grazing, grazings};
use super::{BranchAnswer, BranchEnd, BranchOptions, NoOrbit, OrbitAnswer, SAME};
use crate::dynamics::{MapState, Model};
use crate::study::Task;

/// First step, in the units of the branch.
const FIRST: f64 = 2e-3;
/// Step below which the branch ends.
const SHORTEST: f64 = 1e-9;

/// Step below which a change of the orbit is accepted although its event was not located.
const UNLOCATED: f64 = 1e-6;

/// Shorter steps in a row after which the branch ends: rounding, grown by the map, lets none be longer.
const CRAWL: usize = 400;

/// Cosine of the largest angle between the tangents at both ends of a step, and between step and tangent.
const STRAIGHT: f64 = 0.9;

/// Largest change in a step of the displacement of an orbit with a rest, as a share of the room.
const CHANGE: f64 = 0.1;

/// Distances from a grazing at which the branch is continued, in the order of trial.
const PAST_A_GRAZING: [f64; 6] = [1e-4, 3e-4, 1e-3, 3e-3, 3e-5, 1e-5];
/// Smallest distance from a grazing of an orbit that misses the stop, for the derivatives to be exact.
const MIN_MISSING: f64 = 1e-6;
/// The same of an orbit that touches the stop.
const MIN_TOUCHING: f64 = 1e-5;

/// Distance from an end of the range at which a value is at that end, as a share of the range.
pub(super) const AT_AN_END: f64 = 1e-12;

/// A point with the tangent of the branch there.
pub(super) type Directed = (Point, Vector4<f64>);

/// Events in order, each with its point and, if it is known, the state at the phase of the rows.
type Events = Vec<(BranchEvent, Point, Option<MapState>)>;

/// The part of the branch from the last point to the next.
struct Stretch {
    events: Events,
    /// The point at its end; `None` if the branch ends at the last event.
    next: Option<Directed>,
    is_last: bool,
}

/// A row of the branch before it is added, with its state at the phase of the rows.
struct Row {
    event: Option<BranchEvent>,
    orbit: OrbitAnswer,
    value: f64,
}

pub(super) struct Walk<'a> {
    /// Its phase of the drive is kept away from impacts, at which a state has no derivative by the field.
    corrector: Corrector<'a>,
    branch: BranchAnswer,
    /// The range, and its ends in its unit.
    range: [f64; 2],
    ends: [f64; 2],
    /// Length in m to which changes of the displacement are compared: half the distance of the stops, if that
    /// is less than the length scale.
    room: f64,
    /// Whether the stops are compliant; then the map is smooth at a grazing.
    compliant: bool,
    options: BranchOptions,
    /// The coordinates of the rows, each with its arc length from the first.
    rows: Vec<(Vector4<f64>, f64)>,
    meets: bool,
    at: Directed,
}

impl<'a> Walk<'a> {
    /// A continuation of a branch over a field, within a range, from a point at which the model is `model`.
    pub fn new(
        corrector: Corrector<'a>,
        field: &str,
        (from, to): (f64, f64),
        model: &Model,
        first: Directed,
        options: BranchOptions,
    ) -> Self {
        let range = [from.min(to), from.max(to)];
        let length = corrector.units.length;
        let room = match model.stop_positions() {
            (Some(left), Some(right)) => length.min(0.5 * (right - left)),
            _ => length,
        };
        let branch = BranchAnswer {
            field: field.to_owned(),
            values: Vec::new(),
            orbits: Vec::new(),
            events: Vec::new(),
            end: BranchEnd::Points,
            unlocated: Vec::new(),
            unbegun: Vec::new(),
        };
        let mut walk = Self {
            branch,
            range,
            ends: range.map(|end| end / corrector.units.range),
            room,
            compliant: model.compliant().is_some(),
            options,
            rows: Vec::new(),
            meets: false,
            at: first.clone(),
            corrector,
        };
        walk.row(None, &first.0, None).into_iter().for_each(|row| walk.add(row));
        walk
    }

    /// Walks until the branch ends, and returns it with its end.
    pub fn run_out(mut self, task: &Task) -> Result<BranchAnswer, NoOrbit> {
        if self.rows.is_empty() {
            return Err(NoOrbit::Unrepeated);
        }
        self.branch.end = self.end(task)?;
        Ok(self.branch)
    }

    fn end(&mut self, task: &Task) -> Result<BranchEnd, NoOrbit> {
        let mut step = FIRST.min(self.options.step);
        let mut crawled = 0;
        while self.branch.values.len() < self.options.count {
            task.check_cancelled()?;
            (task.tick)();
            self.keep_clear(&[]);
            let (found, beyond) = self.predicted(step);
            let next = found.filter(|next| self.follows(next));
            let stretch = match &next {
                Some(next) if !self.touches_otherwise(&next.0) => self.smooth(next, beyond.is_some()),
                _ => self.over_a_grazing(next.as_ref(), beyond),
            };
            let stretch = stretch.or_else(|| {
                let next = next.filter(|_| step < UNLOCATED)?;
                match self.branch.unlocated.last_mut() {
                    Some(last) if last.1 == self.at.0.value => last.1 = next.0.value,
                    _ => self.branch.unlocated.push((self.at.0.value, next.0.value)),
                }
                Some(Stretch { events: Vec::new(), next: Some(next), is_last: beyond.is_some() })
            });
            let found = stretch.and_then(|stretch| Some((self.rows_of(&stretch)?, stretch)));
            if let Some((mut rows, mut stretch)) = found {
                let is_half = |event: &(BranchEvent, Point, _)| event.1.orbit.period < self.corrector.periods;
                let joins = stretch.events.iter().position(is_half);
                if let Some(place) = joins {
                    // beyond it the motions are the same ones half their period later
                    stretch.events.truncate(place + 1);
                    rows.truncate(place + 1);
                    stretch.next = None;
                }
                let grazes = stretch.events.iter().any(|event| event.0 == BranchEvent::Grazing);
                let is_last = stretch.is_last;
                let goes_on = self.go_along(rows, stretch.next);
                let ends = [
                    (self.meets, BranchEnd::Closed),
                    (joins.is_some(), BranchEnd::Joined),
                    (is_last, BranchEnd::Range),
                    (!goes_on, BranchEnd::Grazing),
                    (self.is_closed(step), BranchEnd::Closed),
                ];
                if let Some((_, end)) = ends.into_iter().find(|(is_end, _)| *is_end) {
                    return Ok(end);
                }
                crawled = if step < UNLOCATED { crawled + 1 } else { 0 };
                if crawled == CRAWL {
                    return Ok(BranchEnd::Lost);
                }
                step = if grazes && !self.compliant {
                    PAST_A_GRAZING[0].min(self.options.step)
                } else {
                    (step * 1.3).min(self.options.step)
                };
                continue;
            }
            step *= 0.5;
            if step < SHORTEST {
                let leaps = self.at.0.forgets() && self.lasts_beyond();
                // where chatter no longer ends in rest at both stops it may do so at one
                if leaps && self.corrector.mirrored && self.forgets_its_mirror_image() {
                    step = FIRST;
                    continue;
                }
                let leaves = beyond.is_some_and(|end| (self.at.0.at.w - end).abs() < SHORTEST);
                return Ok(match leaves {
                    true => BranchEnd::Range,
                    false if leaps => BranchEnd::Leap,
                    false => BranchEnd::Lost,
                });
            }
        }
        Ok(BranchEnd::Points)
    }

    /// The point after a step, or at the end of the range where that lies before it: then with that end.
    fn predicted(&self, step: f64) -> (Option<Directed>, Option<f64>) {
        let (point, along) = &self.at;
        let guess = point.at + along * step;
        if let Some(end) = self.end_before(guess.w) {
            return (self.last(end), Some(end));
        }
        let Some(next) = self.corrector.correct(guess, along) else { return (None, None) };
        if let Some(end) = self.end_before(next.at.w) {
            return (self.last(end), Some(end));
        }
        let onward = self.corrector.tangent(&next, along);
        (onward.map(|onward| (next, onward)), None)
    }

    /// The end of the range beyond which a value of the field lies.
    fn end_before(&self, to: f64) -> Option<f64> {
        let [low, high] = self.ends;
        if to < low { Some(low) } else { (to > high).then_some(high) }
    }

    /// The point at an end of the range.
    fn last(&self, end: f64) -> Option<Directed> {
        let (point, along) = &self.at;
        let across = Vector4::w();
        let share = (end - point.at.w) / along.w;
        let next = self.corrector.correct(point.at + along * share, &across)?;
        let onward = self.corrector.tangent(&next, along)?;
        // at an end already, the branch first goes round the fold just before it
        (SHORTEST..=2.0 * self.options.step).contains(&(next.at - point.at).norm()).then_some((next, onward))
    }

    /// Whether a point continues the branch: the point and its tangent lie in the direction of the branch.
    fn follows(&self, (next, onward): &Directed) -> bool {
        let (point, along) = &self.at;
        // a motion that is a function of the field does not turn back
        let turns = point.forgets() && next.forgets() && onward.w * along.w < 0.0;
        !turns && onward.dot(along) > STRAIGHT && self.is_ahead(next) && self.is_near(next)
    }

    fn is_ahead(&self, next: &Point) -> bool {
        let (point, along) = &self.at;
        let step = next.at - point.at;
        step.dot(along) > STRAIGHT * step.norm()
    }

    /// Whether a motion that rests on its way, and begins anew at each release, is where the last one was.
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

    /// Whether an orbit has different contacts with the stops from the last one; between orbits with rests
    /// this is not a bifurcation.
    fn touches_otherwise(&self, next: &Point) -> bool {
        let point = &self.at.0;
        differ(&point.orbit, &next.orbit) && !(point.forgets() && next.forgets())
    }

    /// The stretch to a point up to which the map is smooth.
    fn smooth(&self, next: &Directed, is_last: bool) -> Option<Stretch> {
        let (point, along) = &self.at;
        let events = between(&self.corrector, point, along, &next.0, &next.1)?;
        let events = events.into_iter().map(|(event, point)| (event, point, None)).collect();
        Some(Stretch { events, next: Some(next.clone()), is_last })
    }

    /// The stretch over the nearest grazing ahead, to a motion on its other side; to `next` with compliant
    /// stops. `beyond` is an end of the range that the step would pass.
    fn over_a_grazing(&mut self, next: Option<&Directed>, beyond: Option<f64>) -> Option<Stretch> {
        let (point, _) = &self.at;
        if point.forgets() {
            return None;
        }
        let mut ahead = grazings(&self.corrector, point);
        if self.compliant {
            ahead.extend(grazings(&self.corrector, &next?.0));
        }
        let distance = |grazing: &Grazing| (grazing.point.at - point.at).norm();
        ahead.retain(|(grazing, _)| {
            let within = self.end_before(grazing.point.at.w).is_none();
            within && distance(grazing) <= self.options.step && self.is_ahead(&grazing.point)
        });
        let nearest = ahead.into_iter().min_by(|a, b| distance(&a.0).total_cmp(&distance(&b.0)));
        let (grazing, beside) = nearest?;
        let times = grazing.touch.times(&self.corrector);
        let row = grazing.touch.at_phase(&self.corrector, &grazing.point, self.options.phase);
        let event = (BranchEvent::Grazing, grazing.point.clone(), row);
        if self.compliant {
            let mut stretch = self.smooth(next?, beyond.is_some())?;
            let along = &self.at.1;
            let before = stretch.events.iter().filter(|other| (other.1.at - event.1.at).dot(along) < 0.0);
            let place = before.count();
            stretch.events.insert(place, event);
            return Some(stretch);
        }
        if self.corrector.clear_phase(point, &times).is_some() {
            drop(grazing);
            self.keep_clear(&times);
            return None;
        }
        let mut events = self.up_to(&grazing, beside)?;
        events.push(event);
        let (after, next) = self.on_from(&grazing, beside.other());
        events.extend(after);
        let is_last = next.is_none()
            && self.ends.iter().any(|end| (grazing.point.at.w - end).abs() <= PAST_A_GRAZING[0]);
        Some(Stretch { events, next, is_last })
    }

    /// The events up to a grazing; `None` if the branch does not lead to it.
    fn up_to(&self, grazing: &Grazing, beside: Beside) -> Option<Events> {
        let (point, along) = &self.at;
        let least = least(beside);
        let distance = (grazing.point.at - point.at).norm();
        if distance <= 2.0 * least {
            return Some(Vec::new());
        }
        let near = grazing.beside(beside, least)?;
        let onward = self.corrector.tangent(&near, along)?;
        let near = (near, onward);
        if differ(&point.orbit, &near.0.orbit) || !self.follows(&near) {
            return None;
        }
        Some(self.smooth(&near, false)?.events)
    }

    /// The events after a grazing, and a point on the branch beyond it.
    fn on_from(&self, grazing: &Grazing, beside: Beside) -> (Events, Option<Directed>) {
        let directed = |distance: f64| {
            let point = grazing.beside(beside, distance)?;
            let within = self.end_before(point.at.w).is_none();
            let onward = self.corrector.tangent(&point, &(point.at - grazing.point.at))?;
            within.then_some((point, onward))
        };
        let nearest = directed(least(beside));
        for distance in PAST_A_GRAZING {
            let Some(far) = directed(distance) else { continue };
            // the derivatives of two very slow impacts are lost in rounding
            let near = nearest.clone().or_else(|| directed(0.1 * distance)).unwrap_or_else(|| far.clone());
            if differ(&near.0.orbit, &far.0.orbit) {
                continue;
            }
            if let Some(events) = between(&self.corrector, &near.0, &near.1, &far.0, &far.1) {
                let events = events.into_iter().map(|(event, point)| (event, point, None)).collect();
                return (events, Some(far));
            }
        }
        (Vec::new(), nearest)
    }

    /// The rows of a stretch; `None` if the motion of one does not come back to its state.
    fn rows_of(&self, stretch: &Stretch) -> Option<Vec<Row>> {
        let rows = stretch.events.iter().map(|(event, point, row)| self.row(Some(*event), point, *row));
        rows.chain(stretch.next.iter().map(|(point, _)| self.row(None, point, None))).collect()
    }

    /// The row of a point, with its state at the phase of the rows if known.
    fn row(&self, event: Option<BranchEvent>, point: &Point, state: Option<MapState>) -> Option<Row> {
        let moved = || self.corrector.at_phase(&point.orbit, point.value, self.options.phase);
        let known = state.map(|state| OrbitAnswer { state, ..point.orbit.clone() });
        let (orbit, value) = (known.or_else(moved)?, point.value);
        let rows = Corrector { mirrored: false, phase: self.options.phase, ..self.corrector };
        // from a grazing state rounding decides whether the motion strikes the stop; `Touch` has checked it
        let comes_back =
            event == Some(BranchEvent::Grazing) || rows.map(value).is_some_and(|map| orbit.comes_back(&map));
        comes_back.then_some(Row { event, orbit, value })
    }

    /// Adds rows and goes to the point after them; false where there is none, and the branch ends.
    fn go_along(&mut self, rows: Vec<Row>, next: Option<Directed>) -> bool {
        for row in rows {
            if !self.meets {
                self.add(row);
            }
        }
        let Some(next) = next else { return false };
        self.at = next;
        true
    }

    /// Adds a row; without an event at a motion met before.
    fn add(&mut self, Row { event, orbit, value }: Row) {
        let at = self.corrector.at(orbit.state, value);
        let far = self.rows.last().map_or(0.0, |(last, far)| far + (at - last).norm());
        // the branch comes to the same motion again only at an event, and not beside it
        let left = self.rows.iter().take_while(|(_, along)| far - along > self.options.step);
        self.meets |= left.into_iter().any(|(row, _)| (at - row).amax() <= SAME);
        let event = event.filter(|_| !self.meets);
        self.rows.push((at, far));
        // a motion at an end is off it by the rounding of the unit
        let far = |end: f64| (value - end).abs();
        let is_at = |end: &f64| far(*end) <= AT_AN_END * (self.corrector.units.range + end.abs() * 1e-3);
        let end = self.range.into_iter().find(|end| event.is_none() && is_at(end));
        self.branch.values.push(end.unwrap_or(value));
        self.branch.orbits.push(orbit);
        self.branch.events.push(event);
    }

    /// Takes states at another phase of the drive where an impact, or one of the times `also` in forcing
    /// periods after a strobe, comes near to the present one.
    fn keep_clear(&mut self, also: &[f64]) {
        let (point, along) = &self.at;
        let Some(phase) = self.corrector.clear_phase(point, also) else { return };
        let Some(orbit) = self.corrector.at_phase(&point.orbit, point.value, phase) else { return };
        let upwards = Vector4::w() * along.w.signum();
        let corrector = Corrector { phase, ..self.corrector };
        let next = corrector.correct(corrector.at(orbit.state, point.value), &upwards);
        if let Some(next) = next
            && let Some(onward) = corrector.tangent(&next, &upwards)
        {
            (self.corrector, self.at) = (corrector, (next, onward));
        }
    }

    /// Whether a motion just beyond the present value of the field lasts for its period, wherever it leads.
    fn lasts_beyond(&self) -> bool {
        let (point, along) = &self.at;
        self.corrector.evaluate(&(point.at + Vector4::w() * along.w.signum() * UNLOCATED)).is_some()
    }

    /// Continues from the present motion without the mirror condition; false where that finds no motion.
    fn forgets_its_mirror_image(&mut self) -> bool {
        let (point, along) = &self.at;
        let corrector = Corrector { mirrored: false, ..self.corrector };
        let upwards = Vector4::w() * along.w.signum();
        let Some(point) = corrector.correct(point.at, &upwards) else { return false };
        let Some(onward) = corrector.tangent(&point, along) else { return false };
        (self.corrector, self.at) = (corrector, (point, onward));
        true
    }

    /// Whether the last motion is the first one to within the length of a step.
    fn is_closed(&self, step: f64) -> bool {
        let Some(((last, _), (first, _))) = self.rows.last().zip(self.rows.first()) else { return false };
        let farthest = self.rows.iter().map(|(row, _)| (row - first).norm()).fold(0.0, f64::max);
        (last - first).norm() < 0.5 * step && farthest > 10.0 * step
    }
}

/// The smallest distance from a grazing of an orbit on this side.
fn least(beside: Beside) -> f64 {
    match beside {
        Beside::Missing => MIN_MISSING,
        Beside::Touching => MIN_TOUCHING,
    }
}
