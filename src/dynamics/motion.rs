//! How does the mass move from one event to the next?
//!
//! The run is a chain of free flights in one arena each and of rests on a stop. A step of a flight is a
//! Taylor series (`series`); its polynomial is also the dense output, and contacts, breaks and crossings are
//! roots of it, found with none missed. Chosen for that, and for its cost: on the nominal cubic without stops
//! six more digits cost 1.8 times the time (`benches/work_precision.rs` prints error and cost), where a
//! Runge-Kutta method of order 5 pays 16 times and would need a dense output of its own to look for contacts.
//!
//! Three habits keep events sound:
//!
//! - After a located event the state is put exactly on the surface, and the next step knows it ([`Touch`]):
//!   its gap polynomial starts with coefficients that are 0 by definition (one after a rebound or a break, two
//!   after a plastic impact, three after a release), so it is divided by that power of time and the same
//!   contact cannot be found again, however short the flight. Since x = D exactly, the gap needs no difference
//!   of large numbers: a flight of 1e-6 m/s is as exact, relatively, as one of 1 m/s.
//! - A pressed rebound announces its own length, 2 v / a; the series is then extended only until its terms are
//!   negligible over that length: four or five coefficients where a full step has sixteen. Its end is the one root of
//!   that series in the gap, found without a search (`rebound`).
//! - What remains of a chatter once it is short is summed in closed form (Nordmark and Piiroinen 2009).

use super::balance::{Reach, judged};
use super::clock::{Clock, Instant};
use super::drive::Drive;
use super::equation::{Compliant, End, Equation};
use super::flight::Flown;
use super::model::{Model, Request};
use super::path::{Path, StepView};
use super::penetration::Penetration;
use super::prepare::base_at;
use super::record::Recorder;
use super::recurrence::Label;
use super::result::{Outcome, Phase, Run};
use super::series::{Series, State};
use super::settings::Settings;
use super::summary::Ending;
use super::work::{ARRIVAL, Costs, IMPACT_BUDGET, WORK_BUDGET, Work};
use crate::numeric::Scalar;

/// A step halved so often is no step.
pub(super) const MOST_HALVINGS: u32 = 200;

/// A surface that the mass touches at the start of a step, and how many of the leading coefficients of the
/// gap are 0 by definition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Touch {
    pub end: End,
    pub order: usize,
}

/// Orders of a touch: the gap opens with the speed, the acceleration, or what follows them.
pub(super) const BY_SPEED: usize = 1;
pub(super) const BY_ACCELERATION: usize = 2;
pub(super) const BY_JERK: usize = 3;
/// Nothing up to the fourth coefficient opens the gap: what follows decides.
pub(super) const UNDECIDED: usize = 5;
/// The surface is not there for one step: neither side of a break claims a mass that stands on it.
pub(super) const HELD: usize = usize::MAX;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Contact {
    Free,
    /// At rest on the stop of this end.
    Resting(End),
    /// At rest in an equilibrium that nothing disturbs.
    Motionless,
    /// Pressing in the compliant stop of this end.
    Pressing(End),
    /// Behind its surface, with the stop not following: it would have to pull.
    Trailed(End),
}

/// How far a mass has pressed in a compliant stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Depth<T> {
    /// Root of the depth; 0 outside.
    pub root: T,
    /// The stop began or ceased to trail right here.
    pub turned: bool,
}

pub(super) struct Motion<'a, T: Scalar, D: Drive<T>, const LEDGER: bool> {
    pub equation: &'a Equation<T>,
    pub drive: &'a D,
    pub clock: Clock<T>,
    pub settings: Settings<T>,
    pub record: Recorder<'a, T, LEDGER>,
    pub series: Series<T>,
    pub roll: D::Rolling,
    pub segment: usize,
    pub at: Instant<T>,
    pub end: Instant<T>,
    pub x: T,
    pub v: T,
    pub arena: usize,
    pub touch: Option<Touch>,
    pub contact: Contact,
    /// When a release turned out to be none.
    pub refused: Option<Instant<T>>,
    /// Whether the mass has been handed across a break without moving.
    pub turned_back: bool,
    pub depth: Depth<T>,
    /// Workspace of contact with a compliant stop, made at the first.
    pub penetration: Option<Box<Penetration<T>>>,
    pub steps: u64,
    pub evaluations: u64,
    pub work: Work<'a>,
    pub costs: Costs,
    /// Since when, in which segment of the drive, a release has been searched for and not been found.
    pub searched: Option<(usize, Instant<T>)>,
    /// Whether the run may be completed from a cycle that comes back, and whether its mirror image would be a motion too.
    pub recurs: bool,
    pub symmetric: bool,
    /// The mass has just been let go, and how.
    pub label: Option<Label<T>>,
    /// Time in s up to which the run goes on until the motion repeats.
    until_settled: Option<f64>,
}

/// What a motion carries from one step to the next. The drive's rolling state is no part of it: it only keeps
/// what would be computed again, to the bit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Carried<T> {
    pub at: Instant<T>,
    pub x: T,
    pub v: T,
    pub arena: usize,
    pub segment: usize,
    pub touch: Option<Touch>,
    pub contact: Contact,
    pub refused: Option<Instant<T>>,
    pub turned_back: bool,
    pub depth: Depth<T>,
    pub barrier_side: i8,
}

impl<T: Scalar> Carried<T> {
    /// What a sample here is.
    pub fn phase(&self) -> Phase {
        match self.contact {
            Contact::Resting(End::Low) | Contact::Pressing(End::Low) | Contact::Trailed(End::Low) => {
                Phase::LeftStop
            }
            Contact::Resting(End::High) | Contact::Pressing(End::High) | Contact::Trailed(End::High) => {
                Phase::RightStop
            }
            // The stops stand on both sides of 0.
            Contact::Motionless if self.depth.root > T::zero() && self.x < T::zero() => Phase::LeftStop,
            Contact::Motionless if self.depth.root > T::zero() => Phase::RightStop,
            Contact::Free | Contact::Motionless => Phase::Free,
        }
    }
}

/// A step that has been chosen.
pub(super) struct Step<T> {
    pub length: T,
    /// The instant at which it ends, where that is the end of the run or of the drive's segment.
    pub arrival: Option<Instant<T>>,
    /// What the polynomial says of its end.
    pub end: State<T>,
}

/// What is kept of a run's first instant: the velocity, the arena and the place in it, and in J what a compliant stop
/// stores.
pub(super) struct Begun<T> {
    v: T,
    place: (usize, f64, f64),
}

/// Whether a step went on or the run ended.
pub(super) type Flow = Option<Outcome>;

impl<'a, T: Scalar, D: Drive<T>, const LEDGER: bool> Motion<'a, T, D, LEDGER> {
    pub fn new(
        model: &'a Model,
        request: &Request<'a>,
        tolerance: f64,
        equation: &'a Equation<T>,
        clock: Clock<T>,
        drive: &'a D,
    ) -> Self {
        let unit = equation.unit;
        let x = T::of(model.start.0);
        let v = T::of(model.start.1 * unit);
        let settings = Settings::new(model, unit, tolerance);
        let costs = Costs::new(settings.order, equation.most_products(), drive);
        let mut record = Recorder::new(model, clock, unit, settings.order, request, (x, v));
        record.samples_per_look = costs.samples_per_look();
        let until_settled = request.until_settled.filter(|_| model.can_settle());
        let end = if until_settled.is_some() { record.window_end() } else { clock.at(model.duration) };
        Self {
            equation,
            drive,
            clock,
            record,
            work: Work::new(request.cancel),
            costs,
            settings,
            series: Series::new(equation.most_products()),
            roll: D::Rolling::default(),
            segment: 0,
            at: Instant { cycle: 0, phase: T::zero() },
            end,
            x,
            v,
            arena: equation.arena_at(x, model.mechanism.curve.piece_index(model.start.0)),
            touch: None,
            contact: if model.motionless { Contact::Motionless } else { Contact::Free },
            refused: None,
            turned_back: false,
            depth: Depth { root: T::zero(), turned: false },
            penetration: None,
            steps: 0,
            evaluations: 0,
            searched: None,
            recurs: false,
            symmetric: false,
            label: None,
            until_settled,
        }
    }

    /// Where `recurs`, lets the run be completed from a cycle that comes back.
    pub fn with_recurrence(mut self, recurs: bool, model: &Model) -> Self {
        self.recurs = recurs;
        self.symmetric = recurs && model.is_symmetric();
        self
    }

    pub fn run(mut self, model: &Model) -> Run {
        let begun = self.begin(model);
        let outcome = loop {
            let left = match self.left() {
                Ok(left) => left,
                Err(outcome) => break outcome,
            };
            let flow = match self.glide() {
                Flown::On => None,
                Flown::To(step) => self.take(&step),
                Flown::Before(length) => {
                    let left = self.clock.between(&self.at, &self.end);
                    let step = self.shorten(length, left);
                    self.take_any(step)
                }
                Flown::Not => self.proceed(left),
            };
            if let Some(outcome) = flow.or_else(|| self.spent()) {
                break outcome;
            }
        };
        self.finish(model, &begun, outcome)
    }

    /// Puts the mass to its start.
    pub fn begin(&mut self, model: &Model) -> Begun<T> {
        let v = self.v;
        self.place_at_start();
        Begun { v, place: (self.arena, self.x.to_f64(), self.pressed_in_j(model)) }
    }

    /// The time to the end of the run, or how it has ended. A motion that has come back is completed first.
    #[inline]
    pub fn left(&mut self) -> Result<T, Outcome> {
        if let Some(label) = self.label.take() {
            self.let_go(label);
        }
        let mut left = self.clock.between(&self.at, &self.end);
        if !(left > T::zero()) {
            if self.record.cut_short {
                return Err(Outcome::Cancelled { at: self.clock.seconds(&self.at) });
            }
            if !self.goes_on() {
                return Err(Outcome::Done);
            }
            left = self.clock.between(&self.at, &self.end);
        }
        self.mark();
        Ok(left)
    }

    /// At the end of a settled window: whether the run goes on with another, since the motion does not repeat yet.
    fn goes_on(&mut self) -> bool {
        let Some(until) = self.until_settled else { return false };
        self.record.last_strobe(&self.at, (self.x, self.v));
        let next = match self.record.judge.has_settled() {
            true => None,
            false => self.record.next_window(until),
        };
        self.end = next.unwrap_or(self.end);
        next.is_some()
    }

    /// Whether it may take `steps` more of free flight without its budget being spent.
    pub fn has_budget_for(&self, steps: u64) -> bool {
        self.work.has_room_for(steps * self.costs.step)
    }

    /// How the run ends where its budget is spent, or it is told to.
    #[inline]
    pub fn spent(&mut self) -> Flow {
        let at = || self.clock.seconds(&self.at);
        if self.work.is_told_to_stop() {
            return Some(Outcome::Cancelled { at: at() });
        }
        if self.work.impacts() >= IMPACT_BUDGET {
            return Some(Outcome::ImpactBudget { at: at(), count: self.work.impacts() });
        }
        if self.work.done() >= WORK_BUDGET {
            return Some(Outcome::StepBudget { at: at(), count: self.steps });
        }
        None
    }

    /// Closes the record.
    pub fn finish(self, model: &Model, begun: &Begun<T>, outcome: Outcome) -> Run {
        let phase = self.carry().phase();
        let (start_v, potential) = (begun.v, self.potential_since(model, begun.place));
        let (drive, clock, segment, unit) = (self.drive, self.clock, self.segment, self.equation.unit);
        let (low, high) = self.record.places;
        let reach = Reach { low, high, speed: (2.0 * self.record.peak_kinetic).sqrt() / unit };
        let mut run = self.record.finish(
            &Ending { at: self.at, state: (self.x, self.v), start_v, phase, potential, outcome },
            |at| base_at(drive, &clock, segment, at, unit),
        );
        run.summary.steps = self.steps;
        run.summary.evaluations = self.evaluations;
        run.summary.outcome = judged(model, &run, reach);
        run
    }

    /// Change in J, since a start in an arena at a place, of the potential and of what a compliant stop stores.
    fn potential_since(&self, model: &Model, (arena, from, stored): (usize, f64, f64)) -> f64 {
        let piece = |arena: usize| &model.mechanism.curve.pieces()[self.equation.arenas[arena].piece];
        let (first, last, x) = (piece(arena), piece(self.arena), self.x.to_f64());
        let change = match std::ptr::eq(first, last) {
            true => first.potential_change(from, x),
            false => last.potential(x) - first.potential(from),
        };
        change + (self.pressed_in_j(model) - stored)
    }

    /// Energy in J that the pressed compliant stop stores.
    fn pressed_in_j(&self, model: &Model) -> f64 {
        let unit = self.equation.unit;
        let stored = |stop: &Compliant<T>| stop.stored(self.depth.root).to_f64() * model.mass / (unit * unit);
        self.equation.compliant.as_ref().map_or(0.0, stored)
    }

    /// Goes on by one step of flight or one rest; `left` is the time to the end of the run.
    #[inline]
    pub fn proceed(&mut self, left: T) -> Flow {
        match self.contact {
            Contact::Motionless => {
                self.stand(self.end, self.carry().phase());
                None
            }
            Contact::Resting(end) => {
                self.rest(end);
                None
            }
            Contact::Free => self.fly(left),
            Contact::Pressing(end) | Contact::Trailed(end) => self.press_in(end, left),
        }
    }

    /// What is carried from one step to the next: from it the motion goes on as if it had never been left.
    pub fn carry(&self) -> Carried<T> {
        Carried {
            at: self.at,
            x: self.x,
            v: self.v,
            arena: self.arena,
            segment: self.segment,
            touch: self.touch,
            contact: self.contact,
            refused: self.refused,
            turned_back: self.turned_back,
            depth: self.depth,
            barrier_side: self.record.barrier_side,
        }
    }

    /// Goes on from what another motion of the same scene carried.
    pub fn resume(&mut self, carried: &Carried<T>) {
        self.at = carried.at;
        self.x = carried.x;
        self.v = carried.v;
        self.arena = carried.arena;
        self.segment = carried.segment;
        self.touch = carried.touch;
        self.contact = carried.contact;
        self.refused = carried.refused;
        self.turned_back = carried.turned_back;
        self.depth = carried.depth;
        self.record.barrier_side = carried.barrier_side;
    }

    /// The end of the drive's segment or of the run, whichever comes first.
    pub fn segment_limit(&self) -> Instant<T> {
        match self.drive.segment_end(self.segment) {
            Some(border) if self.clock.between(&border, &self.end) > T::zero() => border,
            _ => self.end,
        }
    }

    /// One step of free flight; `left` is the time to the end of the run.
    pub fn fly(&mut self, left: T) -> Flow {
        if self.pass_segment_end() {
            return None;
        }
        let arena = &self.equation.arenas[self.arena];
        self.drive.seed(&self.clock, &self.at, self.segment, &mut self.series.a, &mut self.roll);
        self.evaluations += 1;

        let flight = match self.pressed_back() {
            Some((end, rates)) if self.sum_chatter(end, rates) => return None,
            pressed => pressed.and_then(|(end, rates)| self.short_flight(end, rates)),
        };
        self.series.begin(self.x - arena.origin, self.v);
        if let Some(flight) = flight {
            if let Some(flow) = self.rebound(flight, left) {
                return flow;
            }
            self.drive.seed(&self.clock, &self.at, self.segment, &mut self.series.a, &mut self.roll);
            self.series.begin(self.x - arena.origin, self.v);
        }
        let step = self.choose_step(flight, left);
        self.take_any(step)
    }

    /// Goes along the step that was chosen; none is the end of the run.
    fn take_any(&mut self, step: Option<Step<T>>) -> Flow {
        match step {
            Some(step) => self.take(&step),
            None => Some(Outcome::NotFinite { at: self.clock.seconds(&self.at) }),
        }
    }

    /// Goes along a step of flight up to its end or the first surface.
    pub fn take(&mut self, &Step { length: h, arrival, end }: &Step<T>) -> Flow {
        let arena = &self.equation.arenas[self.arena];
        match self.find_exit(h, &end) {
            Some((s, exit)) => {
                self.work.add(ARRIVAL);
                let (length, level) = (s * h, arena.end(exit).0);
                let state = (level, self.series.velocity(length));
                self.arrive((h, length), end.bound, state, None, Some(exit))
            }
            None => self.arrive((h, h), end.bound, (end.y + arena.origin, end.v), arrival, None),
        }
    }

    /// Tells of a step that was chosen `h` long, of which `length` is kept, and goes to its end: at the state `(x, v)` and,
    /// where that is known, the instant `arrival`, on the surface of the end `touched`.
    pub(super) fn arrive(
        &mut self,
        (h, length): (T, T),
        bound: T,
        (x, v): (T, T),
        arrival: Option<Instant<T>>,
        touched: Option<End>,
    ) -> Flow {
        let (arena, zero) = (&self.equation.arenas[self.arena], T::zero());
        if !(x.is_finite() && v.is_finite()) {
            return Some(Outcome::NotFinite { at: self.clock.seconds(&self.at) });
        }
        self.steps += 1;
        self.work.add(self.costs.step);
        let view = StepView {
            path: &self.series,
            origin: arena.origin,
            at: self.at,
            whole: h,
            length,
            duration: length,
            bound,
            limits: (arena.low, arena.high),
            x,
            v,
        };
        let (drive, clock, segment, unit) = (self.drive, self.clock, self.segment, self.equation.unit);
        self.record.step(&view, |at| base_at(drive, &clock, segment, at, unit));
        self.at = arrival.unwrap_or_else(|| self.clock.advance(&self.at, length));
        self.x = x;
        self.v = v;
        self.touch = None;
        self.turned_back &= length == zero;
        touched.and_then(|end| self.reach(end, length == zero))
    }
}
