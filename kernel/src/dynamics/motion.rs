//! Motion: the state, the stepper that advances it and the recorder that observes it.
//!
//! A run is a chain of free flights in one mode each and of rests on a stop. A step of a flight is a Taylor
//! series (`series`). Its polynomial is also the dense output; contacts, breaks and crossings are its roots,
//! and none is missed. This is the reason for the method, together with its cost: on the nominal cubic
//! without stops six more digits cost 1.8 times the time (`benches/work_precision.rs`); a Runge-Kutta method
//! of order 5 needs 16 times the time and a separate dense output to find contacts.
//!
//! After a located event the state is put exactly on the surface, which the next step takes into account
//! ([`Touch`]): the gap polynomial starts with coefficients that are 0 by definition (one after a rebound or
//! a break, two after a plastic impact, three after a release). It is divided by that power of time, so the
//! same contact cannot be found again, however short the flight. Since x = D exactly, the gap needs no
//! difference of large numbers: a flight at 1e-6 m/s has the same relative accuracy as one at 1 m/s.
//!
//! [`Touch`]: super::state::Touch

use super::clock::{Clock, Instant};
use super::drive::Drive;
use super::equation::Equation;
use super::model::Model;
use super::record::barrier::side_of;
use super::record::events::Call;
use super::record::log::Log;
use super::record::recorder::Recorder;
use super::result::Request;
use super::state::{Checkpoint, Contact, Label, MotionState, Start};
use super::step::stepper::{Settings, Stepper};
use super::step::work::Work;
use crate::numeric::Scalar;

pub(crate) struct Motion<'a, T: Scalar, D: Drive<T>> {
    pub stepper: Stepper<'a, T, D>,
    pub state: MotionState<T>,
    pub record: Recorder<'a, T>,
    /// The recorder calls since the first labelled release, if the run may recur.
    pub log: Option<Box<Log<T>>>,
    pub steps: u64,
    /// The segment of the drive and the instant since which the search has found no release.
    pub no_release_since: Option<(usize, Instant<T>)>,
    /// Whether windows may be completed from a recurrence.
    pub may_recur: bool,
    /// Whether the present window may still be completed from a recurrence.
    pub recurs: bool,
    /// Whether the mirror image of a motion is a motion.
    pub symmetric: bool,
    /// The identity of the release that has just happened.
    pub label: Option<Label<T>>,
    /// Latest time in s to which the run is extended until the motion repeats.
    pub until_settled: Option<f64>,
    pub start: Start<T>,
}

impl<'a, T: Scalar, D: Drive<T>> Motion<'a, T, D> {
    pub fn new(
        model: &'a Model,
        request: &Request<'a>,
        tolerance: f64,
        equation: &'a Equation<T>,
        clock: Clock<T>,
        drive: &'a D,
    ) -> Self {
        let unit = equation.unit;
        let (x, v) = (T::of(model.start.0), T::of(model.start.1 * unit));
        let mode = equation.mode_at(x, model.piece_index(model.start.0));
        let contact = if model.motionless { Contact::Motionless } else { Contact::Free };
        let settings = Settings::new(model, unit, tolerance);
        let mut record = Recorder::new(model, (clock, drive), unit, settings.order, request, (x, v));
        let until_settled = request.until_settled.filter(|_| model.can_settle());
        let end = if until_settled.is_some() { record.window.1 } else { clock.at(model.duration) };
        let mut state = MotionState::new((x, v), mode, contact);
        state.circuit =
            T::of(model.circuit().map_or(0.0, |circuit| circuit.state(model.start_electrical) * unit));
        let stepper = Stepper::new(equation, drive, clock, settings, end, Work::new(request.cancel));
        record.samples_per_check = stepper.costs.samples_per_check();
        Self {
            stepper,
            state,
            record,
            log: None,
            steps: 0,
            no_release_since: None,
            may_recur: false,
            recurs: false,
            symmetric: false,
            label: None,
            until_settled,
            start: Start::default(),
        }
    }

    /// Permits the run to be completed from a recurrence if `recurs`.
    pub fn with_recurrence(mut self, recurs: bool) -> Self {
        self.may_recur = recurs && self.stepper.drive.circuit().is_none();
        self.recurs = self.may_recur;
        self.symmetric = self.recurs && self.record.model.is_symmetric();
        self
    }

    /// Puts the mass, in free flight, at a displacement and a velocity at this instant, with this state of
    /// the circuit.
    pub fn put(&mut self, [x, v, circuit]: [T; 3], at: Instant<T>) {
        let piece = self.record.model.piece_index(x.to_f64());
        let mode = self.stepper.equation.mode_at(x, piece);
        self.state = MotionState { at, circuit, ..MotionState::new((x, v), mode, Contact::Free) };
        self.record.barrier_side = self.record.barrier.map_or(0, |barrier| side_of(x, barrier));
    }

    /// The present state, from which another motion of the same scene can continue.
    pub fn checkpoint(&self) -> Checkpoint<T> {
        Checkpoint { state: self.state, barrier_side: self.record.barrier_side }
    }

    /// Continues from a checkpoint of another motion of the same scene.
    pub fn resume(&mut self, point: &Checkpoint<T>) {
        self.state = point.state;
        self.record.barrier_side = point.barrier_side;
    }

    /// Passes a call to the recorder, and to the log if there is one.
    #[inline(always)] // so that unused fields of the call are not computed
    pub fn report(&mut self, call: Call<T>) {
        if let Some(log) = &mut self.log {
            log.add(call);
        }
        self.record.report(&call, self.state.segment);
    }
}
