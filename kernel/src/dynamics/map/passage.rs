//! A part of a motion between two strobes, and its events.

use std::sync::atomic::AtomicBool;

use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::{End, EndKind, Equation, Mode};
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::recorder::Recorder;
use crate::dynamics::result::{Event, EventKind, Outcome, Request, Side};
use crate::dynamics::series::Series;
use crate::dynamics::state::{Contact, MotionState, Opening};
use crate::dynamics::step::stepper::{ROUNDINGS, Stepper};
use crate::numeric::{PolynomialRoots, Scalar, elementary};

/// The motion between two strobes, as [`StroboscopicMap::pass`](super::StroboscopicMap::pass) gives it.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// Displacement in m and velocity in m/s at the end.
    pub state: (f64, f64),
    /// State of the circuit at the end, in A or V; 0 without one.
    pub electrical: f64,
    /// Events in order of time, in s from the start of the drive. A mass that rests on a stop from the
    /// beginning has no event for that.
    pub events: Vec<Event>,
    /// Determinant of the map from the start to here, computed without integration: exp(-(c/m + d) t), d the
    /// rate at which the circuit decays, times the squared restitution of each impact; 0 if the mass has
    /// rested. `None` with compliant stops, whose loss depends on the motion.
    pub determinant: Option<f64>,
    /// Whether the mass has rested on a stop. Its later motion then does not depend on the displacement and
    /// the velocity at the start.
    pub rested: bool,
    /// Points at which the mass turned back before a stop without touching it, in order of time. The
    /// beginning of a motion from rest is not one of them.
    pub misses: Vec<Miss>,
    /// `Done`, or how the motion ended early.
    pub outcome: Outcome,
    /// Number of impacts faster than [`min_impact_speed`](Model::min_impact_speed), with the contacts of
    /// compliant stops.
    pub impacts: u64,
}

/// A point at which the mass turned back before a stop without touching it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Miss {
    /// Time in s from the start of the drive.
    pub t: f64,
    /// Side of the stop.
    pub side: Side,
    /// Distance from the stop in m.
    pub gap: f64,
}

impl Passage {
    /// Smallest distance in m between a stop and a point at which the mass turned back without touching it;
    /// `None` if there is no such point.
    pub fn nearest_miss(&self) -> Option<f64> {
        self.misses.iter().map(|miss| miss.gap).reduce(f64::min)
    }

    /// This passage followed by its mirror image, `later` seconds after it; the final state is mirrored.
    #[must_use]
    pub fn with_mirror_image(mut self, later: f64) -> Self {
        let image = |event: &Event| Event {
            t: event.t + later,
            side: event.side.other(),
            v_in: -event.v_in,
            v_out: -event.v_out,
            ..*event
        };
        let events: Vec<Event> = self.events.iter().map(image).collect();
        let image = |miss: &Miss| Miss { t: miss.t + later, side: miss.side.other(), ..*miss };
        let misses: Vec<Miss> = self.misses.iter().map(image).collect();
        self.events.extend(events);
        self.misses.extend(misses);
        self.state = (-self.state.0, -self.state.1);
        self.electrical = 0.0 - self.electrical;
        self.determinant = self.determinant.map(|half| half * half);
        self.impacts *= 2;
        self
    }

    fn count(&self, kinds: [EventKind; 2]) -> u64 {
        self.events.iter().filter(|event| kinds.contains(&event.kind)).count() as u64
    }

    /// Whether the mass has hit a stop, at any speed.
    pub fn strikes(&self) -> bool {
        self.count([EventKind::Impact, EventKind::Contact]) > 0
    }

    /// Times the mass came to rest on a stop.
    pub fn rests(&self) -> u64 {
        self.count([EventKind::Rest; 2])
    }

    /// Crossings of the barrier.
    pub fn crossings(&self) -> u64 {
        self.count([EventKind::Crossing; 2])
    }
}

/// A passage, and the state at its end in kernel units, with that of the circuit.
pub(super) struct Traced<T> {
    pub passage: Passage,
    pub end: [T; 3],
}

/// Integrates the motion between two instants, from a state in kernel units, unless `cancel` is set. Misses
/// are only listed if `with_misses`, since they take time.
pub(super) fn trace<T: Scalar, D: Drive<T>>(
    model: &Model,
    equation: &Equation<T>,
    clock: Clock<T>,
    drive: &D,
    start: [T; 3],
    (from, to): (Instant<T>, Instant<T>),
    (with_misses, cancel): (bool, Option<&AtomicBool>),
) -> Traced<T> {
    let request = Request { events: true, cancel, ..Request::default() };
    let mut motion = Motion::new(model, &request, model.tolerance, equation, clock, drive);
    motion.stepper.end = to;
    motion.record.next_strobe = None;
    motion.put(start, from);
    motion.place_at_start();
    if matches!(motion.state.contact, Contact::Resting(_)) {
        motion.record.events = Some(Vec::new());
        motion.record.counts.total_impacts = 0;
        motion.state.v = T::zero();
    }
    let mut misses = Vec::new();
    let outcome = loop {
        let left = motion.stepper.left(&motion.state);
        if !(left > T::zero()) {
            break Outcome::Done;
        }
        // at each step, since a short passage does not reach the next check of `spent`
        if motion.stepper.work.is_cancelled() {
            break Outcome::Cancelled { at: motion.stepper.seconds(&motion.state) };
        }
        let (before, steps, sums) = (motion.state, motion.steps, motion.record.counts.sums);
        let flow = motion.proceed(left);
        let flown = before.contact == Contact::Free
            && motion.steps > steps
            && motion.record.counts.sums == sums
            && flow.is_none();
        if flown && with_misses {
            let Stepper { series, clock, .. } = &motion.stepper;
            add_misses(motion.stepper.mode(&before), series, clock, (&before, motion.state.at), &mut misses);
        }
        if let Some(outcome) = flow.or_else(|| motion.spent()) {
            break outcome;
        }
    };
    traced(equation, motion.record, from, &motion.state, misses, outcome)
}

/// The passage that a motion has made since the instant `from`.
fn traced<T: Scalar>(
    equation: &Equation<T>,
    record: Recorder<T>,
    from: Instant<T>,
    &MotionState { at, x, v, circuit, .. }: &MotionState<T>,
    misses: Vec<Miss>,
    outcome: Outcome,
) -> Traced<T> {
    let model = record.model;
    let rested = record.counts.rests > 0;
    let impacts = record.counts.total_impacts;
    let events = record.events.unwrap_or_default();
    let time = record.clock.between(&from, &at).to_f64() * equation.unit;
    let determinant = equation.compliant.is_none().then(|| match rested {
        true => 0.0,
        false => elementary::exp(model.contraction(time)) * squared_restitutions(model, &events),
    });
    let state = (x.to_f64(), v.to_f64() / equation.unit);
    let electrical = model.circuit().map_or(0.0, |known| known.amount * circuit.to_f64() / equation.unit);
    let passage = Passage { state, electrical, events, determinant, rested, misses, outcome, impacts };
    Traced { passage, end: [x, v, circuit] }
}

/// The product of the squared restitution of each impact.
fn squared_restitutions(model: &Model, events: &[Event]) -> f64 {
    let restitution = |side: Side| model.stop(side).map_or(1.0, |stop| stop.restitution);
    let impacts = events.iter().filter(|event| event.kind == EventKind::Impact);
    impacts.map(|event| restitution(event.side).powi(2)).product()
}

/// Adds the points before a stop at which the mass turned back during a step in a mode, from the state
/// `before` up to the instant `until`.
fn add_misses<T: Scalar>(
    mode: &Mode<T>,
    series: &Series<T>,
    clock: &Clock<T>,
    (before, until): (&MotionState<T>, Instant<T>),
    misses: &mut Vec<Miss>,
) {
    let is_stop = |end: End| matches!(mode.end(end).1, EndKind::Stop | EndKind::Compliant);
    if !is_stop(End::Low) && !is_stop(End::High) {
        return;
    }
    let length = clock.between(&before.at, &until).to_f64();
    // at a surface that the mass leaves, coefficients that are 0 by definition may differ from 0 by rounding
    let opening = before.touch.map(|touch| touch.opening).filter(|opening| *opening != Opening::Ignored);
    let multiplicity = opening.map_or(1, |opening| opening as usize);
    let (mut velocity, mut power) = (Vec::with_capacity(series.known), 1.0);
    for (k, c) in series.coefficients().iter().enumerate().skip(1) {
        velocity.push(if k < multiplicity { 0.0 } else { k as f64 * c.to_f64() * power });
        power *= length;
    }
    // A mass that begins at rest has not turned there, and one that stands still to rounding does not turn.
    let Some(first) = velocity.iter().find(|coefficient| **coefficient != 0.0) else { return };
    let mut rises = *first > 0.0;
    let place = |t: f64| series.coefficients().iter().rev().fold(0.0, |sum, c| sum * t + c.to_f64());
    let (first, last) = (place(0.0), place(length));
    let rounding = ROUNDINGS * f64::EPSILON * before.x.to_f64().abs();
    PolynomialRoots::new(&velocity).each_sign_change(&mut |s| {
        let (end, side) = if rises { (End::High, Side::Right) } else { (End::Low, Side::Left) };
        rises = !rises;
        let y = place(s * length);
        let gap = (mode.end(end).0.to_f64() - (mode.origin.to_f64() + y)).abs();
        let moves = (y - first).abs().max((y - last).abs()) > rounding;
        if s < 1.0 && moves && gap > 0.0 && is_stop(end) {
            let t = clock.seconds(&clock.advance(&before.at, T::of(s * length)));
            misses.push(Miss { t, side, gap });
        }
        true
    });
}
