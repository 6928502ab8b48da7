//! Kernel of a live run: continues from a step's end, samples within a step, stops within one.
//!
//! A kernel is built once for a model. Each call makes a [`Motion`] from it and drops it afterwards, which
//! costs a few microseconds, so that the integrator needs no code for continuation.

use crate::dynamics::clock::Instant;
use crate::dynamics::drive::form::{Kernel, with_drive};
use crate::dynamics::drive::{Base, Drive};
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::recorder::Recorder;
use crate::dynamics::result::{Event, Outcome, Request, Sample};
use crate::dynamics::state::{Checkpoint, Contact};
use crate::numeric::decay;

/// Work of one call, in units of [`work`](crate::dynamics::step::work): some tens of milliseconds. Only a
/// chatter without end or a very expensive step needs more.
const WORK_PER_CALL: u64 = 2_000_000;

/// Energies in kernel units, per mass.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Sums {
    pub work: f64,
    pub squared_velocity: f64,
    pub impact: f64,
    pub circuit: f64,
}

impl Sums {
    pub fn minus(&self, other: &Self) -> Self {
        Self {
            work: self.work - other.work,
            squared_velocity: self.squared_velocity - other.squared_velocity,
            impact: self.impact - other.impact,
            circuit: self.circuit - other.circuit,
        }
    }
}

/// The steps of one call.
pub(crate) struct Stretch {
    pub samples: Vec<Sample>,
    pub events: Vec<Event>,
    pub head: Checkpoint<f64>,
    pub sums: Sums,
    /// State and energies at the beginning of the last step; `None` if no step was taken.
    pub last: Option<(Checkpoint<f64>, Sums)>,
    pub ended: Option<Outcome>,
    /// Whether the work of one call was used up.
    pub exhausted: bool,
}

impl Kernel<f64> {
    /// Seconds per kernel time unit.
    pub fn unit(&self) -> f64 {
        self.equation.unit
    }

    pub fn seconds(&self, checkpoint: &Checkpoint<f64>) -> f64 {
        self.clock.seconds(&checkpoint.state.at)
    }

    /// Acceleration of the base in m/s^2 at the instant of a checkpoint.
    pub fn base(&self, checkpoint: &Checkpoint<f64>) -> f64 {
        self.base_within(checkpoint.state.segment, &checkpoint.state.at)
    }

    /// Acceleration of the base in m/s^2 at a time in s.
    pub fn base_at(&self, t: f64) -> f64 {
        let at = self.clock.at(t);
        self.base_within(with_drive!(&self.drive, drive => self.segment(drive, &at)), &at)
    }

    /// Acceleration of the base in m/s^2 at an instant within a segment of the drive.
    fn base_within(&self, segment: usize, at: &Instant<f64>) -> f64 {
        with_drive!(&self.drive, drive => drive.in_si(at, segment, self.unit()))
    }

    fn segment<D: Drive<f64>>(&self, drive: &D, at: &Instant<f64>) -> usize {
        let mut segment = 0;
        while drive.segment_end(segment).is_some_and(|end| self.clock.between(at, &end) <= 0.0) {
            segment += 1;
        }
        segment
    }

    fn motion<'a, D: Drive<f64>>(
        &'a self,
        model: &'a Model,
        drive: &'a D,
        request: &Request<'a>,
        from: Option<&Checkpoint<f64>>,
    ) -> Motion<'a, f64, D> {
        let mut motion = Motion::new(model, request, model.tolerance, &self.equation, self.clock, drive);
        motion.record.next_strobe = None; // a live run is not classified
        if let Some(from) = from {
            motion.resume(from);
        }
        motion
    }

    /// The model's start at the time `now` in s, and the events that happen there at once.
    pub fn start(&self, model: &Model, now: f64) -> (Checkpoint<f64>, Vec<Event>) {
        let request = Request { events: true, ..Request::default() };
        with_drive!(&self.drive, drive => {
            let mut motion = self.motion(model, drive, &request, None);
            motion.state.at = self.clock.at(now);
            motion.state.segment = self.segment(drive, &motion.state.at);
            motion.place_at_start();
            (motion.checkpoint(), motion.record.events.unwrap_or_default())
        })
    }

    /// Steps from `head` until a step has passed `to` in s.
    pub fn proceed(&self, model: &Model, head: &Checkpoint<f64>, to: f64, times: &[f64]) -> Stretch {
        let request = Request { sample_times: times, events: true, ledger: true, ..Request::default() };
        let until = self.clock.at(to);
        with_drive!(&self.drive, drive => {
            let mut motion = self.motion(model, drive, &request, Some(head));
            let (mut last, mut ended) = (None, None);
            while ended.is_none()
                && self.clock.between(&motion.state.at, &until) >= 0.0
                && motion.stepper.work.done < WORK_PER_CALL
            {
                let left = motion.stepper.left(&motion.state);
                if !(left > 0.0) {
                    ended = Some(Outcome::Done);
                    break;
                }
                last = Some((motion.checkpoint(), sums(&motion.record)));
                ended = motion.proceed(left);
            }
            Stretch {
                head: motion.checkpoint(),
                sums: sums(&motion.record),
                last,
                ended,
                exhausted: ended.is_none() && self.clock.between(&motion.state.at, &until) >= 0.0,
                events: motion.record.events.unwrap_or_default(),
                samples: motion.record.samples,
            }
        })
    }

    /// Repeats the steps from `tail` to `head` for the samples at `times`, all before the head.
    pub fn resample(
        &self,
        model: &Model,
        tail: &Checkpoint<f64>,
        head: &Checkpoint<f64>,
        times: &[f64],
    ) -> Vec<Sample> {
        if matches!(tail.state.contact, Contact::Resting(_) | Contact::Motionless) {
            // It stands still; the search for its release need not be repeated.
            return times.iter().map(|t| self.standing(model, tail, *t)).collect();
        }
        if times.is_empty() {
            return Vec::new();
        }
        let request = Request { sample_times: times, ..Request::default() };
        with_drive!(&self.drive, drive => {
            let mut motion = self.motion(model, drive, &request, Some(tail));
            while self.clock.between(&motion.state.at, &head.state.at) > 0.0
                && motion.stepper.work.done < WORK_PER_CALL
            {
                let left = motion.stepper.left(&motion.state);
                if motion.proceed(left).is_some() {
                    break;
                }
            }
            motion.record.samples
        })
    }

    /// The sample at a time in s of a mass that has stood still since `tail`.
    fn standing(&self, model: &Model, tail: &Checkpoint<f64>, t: f64) -> Sample {
        let (at, state) = (self.clock.at(t), &tail.state);
        let electrical = model.circuit().map_or(0.0, |circuit| {
            let time = self.clock.between(&state.at, &at).max(0.0);
            let left = decay(circuit.decay * self.unit() * time).0;
            circuit.amount * (state.circuit * left) / self.unit()
        });
        let base_accel = self.base_within(state.segment, &at);
        Sample { t, x: state.x, v: 0.0, base_accel, phase: state.phase(), electrical }
    }

    /// The state at `now` in s and the energies from the tail to there, if `now` is between tail and head.
    pub fn present(
        &self,
        model: &Model,
        tail: &Checkpoint<f64>,
        head: &Checkpoint<f64>,
        now: f64,
    ) -> Option<(Checkpoint<f64>, Sums)> {
        let at = self.clock.at(now);
        if self.clock.between(&at, &head.state.at) <= 0.0 {
            return None;
        }
        let request = Request { ledger: true, ..Request::default() };
        with_drive!(&self.drive, drive => {
            let mut motion = self.motion(model, drive, &request, Some(tail));
            motion.stepper.end = at;
            while motion.stepper.work.done < WORK_PER_CALL {
                let left = motion.stepper.left(&motion.state);
                if !(left > 0.0) || motion.proceed(left).is_some() {
                    break;
                }
            }
            Some((motion.checkpoint(), sums(&motion.record)))
        })
    }
}

fn sums(record: &Recorder<f64>) -> Sums {
    let whole = &record.whole;
    Sums {
        work: whole.work.value(),
        squared_velocity: whole.squared_velocity.value(),
        impact: whole.impact.value(),
        circuit: whole.circuit.value(),
    }
}
