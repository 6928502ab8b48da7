//! Runs from event to event, up to the end or until the goal of a pursuit is reached.

pub(crate) mod ending;
pub(crate) mod event_free;
mod recurrence;
mod settling;

use crate::dynamics::clock::Instant;
use crate::dynamics::drive::Drive;
use crate::dynamics::drive::form::{Kernel, general, with_drive};
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::goal::Goal;
use crate::dynamics::result::{Arrival, MapState, Outcome, Pursued, Pursuit, Request, Run};
use crate::dynamics::step::stepper::Settings;
use crate::dynamics::step::work::Costs;
use crate::numeric::{DoubleDouble, Scalar};
use crate::system::clock::ThreadClock;
use event_free::FastPath;

impl Model {
    /// Runs the model once.
    ///
    /// Returns samples, events and statistics in SI. Never fails: if a run cannot continue, its outcome says
    /// so. The motion does not depend on the request or on threads.
    pub fn run(&self, request: &Request) -> Run {
        let watch = ThreadClock::start();
        let Kernel { equation, clock, drive } = Kernel::<f64>::new(self);
        let mut run = with_drive!(&drive, drive => {
            Motion::new(self, request, self.tolerance, &equation, clock, drive)
                .with_recurrence(self.recurrence)
                .run()
        });
        run.summary.cpu_s = watch.seconds();
        run
    }

    /// Cost of a step of free flight at a tolerance, and the part of it due to the excitation, in units
    /// of work.
    #[doc(hidden)]
    pub fn cost_of_a_step(&self, tolerance: f64) -> (u64, u64) {
        let Kernel { equation, drive, .. } = Kernel::<f64>::new(self);
        let order = Settings::<f64>::new(self, equation.unit, tolerance).order;
        with_drive!(&drive, drive => {
            (Costs::new::<f64, _>(order, equation.degree(), drive).step, drive.cost(order))
        })
    }

    /// Runs the model once in double-double arithmetic, some 31 digits, at the given `tolerance` (1e-28 is
    /// sensible): the reference for a run in doubles. It is about a hundred times slower, and no part of it
    /// is completed from a recurrence.
    pub fn run_reference(&self, request: &Request, tolerance: f64) -> Run {
        let watch = ThreadClock::start();
        let (equation, clock, drive) = general::<DoubleDouble>(self);
        let mut run = Motion::new(self, request, tolerance, &equation, clock, &drive).run();
        run.summary.cpu_s = watch.seconds();
        run
    }
}

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// Runs from start to end.
    fn run(mut self) -> Run {
        self.begin();
        let outcome = self.run_to_end();
        self.finish(outcome)
    }

    /// Runs from event to event until the run has ended.
    pub fn run_to_end(&mut self) -> Outcome {
        loop {
            let left = match self.left() {
                Ok(left) => left,
                Err(outcome) => return outcome,
            };
            let flow = match self.event_free_steps() {
                FastPath::Paused => None,
                FastPath::EventPossible(step) => self.take(&step),
                FastPath::TooLong(length) => {
                    let left = self.stepper.left(&self.state);
                    let step = self.stepper.shorten(&self.state, length, left);
                    self.take_any(step)
                }
                FastPath::NotTaken => self.proceed(left),
            };
            if let Some(outcome) = flow.or_else(|| self.spent()) {
                return outcome;
            }
        }
    }

    /// The time to the end of the run, or how it has ended. A motion that recurs is completed first.
    #[inline]
    pub fn left(&mut self) -> Result<T, Outcome> {
        if let Some(label) = self.label.take() {
            self.handle_release(label);
        }
        if self.record.has_arrived() {
            return Err(Outcome::Done);
        }
        let mut left = self.stepper.left(&self.state);
        if !(left > T::zero()) {
            if self.record.cut_short {
                return Err(Outcome::Cancelled { at: self.stepper.seconds(&self.state) });
            }
            if !self.begin_next_window() {
                return Err(Outcome::Done);
            }
            left = self.stepper.left(&self.state);
        }
        self.mark();
        Ok(left)
    }

    /// At the end of a settled window, begins another one if the motion does not repeat yet and the run may
    /// be extended. Returns whether it has begun.
    fn begin_next_window(&mut self) -> bool {
        let Some(until) = self.until_settled else { return false };
        self.record.last_strobe(&self.state);
        self.judge();
        if self.record.classifier.period().is_some() {
            return false;
        }
        let Some(end) = self.record.next_window(until) else { return false };
        self.stepper.end = end;
        self.recurs = self.may_recur;
        true
    }
}

impl<'a, T: Scalar, D: Drive<T>> Motion<'a, T, D> {
    /// Puts the motion at the start of a pursuit and sets the end of the pursuit. A release from rest ends
    /// it, so it is never completed from a recurrence.
    pub fn pursuing(mut self, pursuit: &Pursuit<'a>) -> Self {
        let unit = self.stepper.equation.unit;
        let MapState { x, v, electrical } = pursuit.start;
        let circuit = self.record.model.circuit().map_or(0.0, |circuit| circuit.state(electrical) * unit);
        let start = [T::of(x), T::of(v * unit), T::of(circuit)];
        self.put(start, Instant { cycle: 0, phase: T::zero() });
        self.stepper.work.limit(pursuit.max_work);
        self.stepper.end = self.record.pursue(Goal::new(*pursuit), pursuit.max_periods);
        // what follows a release also depends on a circuit, so that no label identifies it
        (self.recurs, self.until_settled) = (self.stepper.drive.circuit().is_none(), None);
        self
    }

    /// Result of the pursuit.
    pub fn arrived(mut self, outcome: Outcome) -> Pursued {
        let work = self.stepper.work.done;
        let goal = self.record.goal.take();
        let (reached, trail) = goal.map(|goal| (goal.reached, goal.trail)).unwrap_or_default();
        let (arrival, periods) = reached.filter(|_| outcome == Outcome::Done).unzip();
        let unsettled = || Arrival::Unsettled(Box::new(self.finish(outcome).summary));
        Pursued { arrival: arrival.unwrap_or_else(unsettled), periods, trail, work }
    }
}

/// Pursues one motion outside a batch.
pub(crate) fn pursue_alone(model: &Model, pursuit: &Pursuit, request: &Request) -> Pursued {
    let Kernel { equation, clock, drive } = Kernel::<f64>::new(model);
    with_drive!(&drive, drive => {
        let motion = Motion::new(model, request, model.tolerance, &equation, clock, drive);
        let mut motion = motion.pursuing(pursuit);
        motion.begin();
        let outcome = motion.run_to_end();
        motion.arrived(outcome)
    })
}
