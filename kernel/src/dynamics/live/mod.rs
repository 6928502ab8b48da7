//! Live run: a motion that is changed while it runs.
//!
//! The state at a time between two steps is computed by repeating the last step up to that time. When the
//! model changes, the state is kept as far as the new stops and the new curve allow, and the drive continues
//! in phase.

mod kernel;

use std::sync::Arc;

use crate::dynamics::drive::form::Kernel;
use crate::dynamics::model::excitation::TonePart;
use crate::dynamics::model::{MAX_PERIODS, Model};
use crate::dynamics::result::{Event, EventKind, Outcome, Phase, Sample, Side};
use crate::dynamics::state::{Checkpoint, Contact};
use crate::numeric::{DoubleDouble, Scalar};
use kernel::Sums;

/// Longest live run in kernel time units: some years for the prototype. The clock of an undriven scene is
/// that of [`Model::run`].
const HORIZON_UNITS: f64 = 8_589_934_592.0;

/// What [`Live::advance`] appends: samples and events of a time interval, each in order of time. The caller
/// may drain them at any time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LiveOutput {
    /// The state at the requested times, and right after every change.
    pub samples: Vec<Sample>,
    /// The events.
    pub events: Vec<Event>,
}

/// Energy balance of a live run since it began, in J. `stored` is the present energy less the initial one:
/// work + by hand - damping - impact - harvested - coil = stored.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LiveLedger {
    /// Work of the base on the mass.
    pub work_j: f64,
    /// Taken by damping.
    pub damping_j: f64,
    /// Taken by impacts.
    pub impact_j: f64,
    /// Taken by the load of a transducer.
    pub harvested_j: f64,
    /// Taken by its coil.
    pub coil_j: f64,
    /// Put in by changes: a stop dragged over the mass, a mass placed, another potential.
    pub by_hand_j: f64,
    /// Change of kinetic energy and potential.
    pub stored_j: f64,
}

/// A motion without a fixed end, whose model may be changed while it runs.
///
/// It is the integrator of [`Model::run`], which steps ahead of the time that it has been advanced to. Its
/// output does not depend on how often it is advanced: the steps have the same bits for any sequence of
/// calls. A [`change`](Self::change) of the model takes effect at the present time; energy that it adds or
/// removes (a stop dragged over the mass, a new potential, a mass put elsewhere) is in
/// [`LiveLedger::by_hand_j`].
///
/// ```
/// # use interwell_kernel as interwell;
/// # use interwell::{dynamics::Model, mechanics::Mechanism, scene::Document};
/// use interwell::dynamics::{Live, LiveOutput};
///
/// # let document = Document::preset("nominal-cubic")?;
/// # let mechanism = Mechanism::build(&document.scene.mechanism, &document.files)?;
/// # let model = Model::build(&document.scene, std::sync::Arc::new(mechanism)).unwrap();
/// let (mut live, mut output) = (Live::new(&model), LiveOutput::default());
/// live.advance(0.1, &[0.05, 0.1], &mut output);
/// assert_eq!(output.samples.len(), 2);
/// live.place(0.0, 0.0, &mut output); // the mass on top of the barrier
/// assert_eq!(live.state().x, 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Live {
    /// The present model, its drive shifted so that its phase is continuous through every change.
    model: Model,
    /// Duration, and start of the settled window, of the scene.
    scene_times: (f64, f64),
    kernel: Arc<Kernel<f64>>,
    /// Turns by which each tone is ahead of its scene.
    shifts: Vec<f64>,
    now: f64,
    /// The start of the step in which the present time lies.
    tail: Checkpoint<f64>,
    /// The end of that step.
    head: Checkpoint<f64>,
    /// Events of that step that are later than the present.
    pending: Vec<Event>,
    /// Energies up to the tail.
    past: LiveLedger,
    /// Energies of the step from the tail to the head.
    ahead: Sums,
    /// Kinetic energy and potential at the start in J.
    start_energy: f64,
    ended: Option<Outcome>,
}

impl Live {
    /// A run from the start of the model, at time 0. Events that happen at once (a start pressed on a stop
    /// rests) are delivered by the first [`advance`](Self::advance).
    pub fn new(model: &Model) -> Self {
        let scene_times = (model.duration, model.settle);
        let model = without_end(model.clone());
        let shifts = vec![0.0; model.excitation.tones.len()];
        let kernel = Arc::new(Kernel::new(&model));
        let (start, pending) = kernel.start(&model, 0.0);
        let start_energy = energy(&model, model.start) + model.electrical_energy(model.start_electrical);
        Self {
            kernel,
            shifts,
            scene_times,
            now: 0.0,
            tail: start,
            head: start,
            pending,
            past: LiveLedger::default(),
            ahead: Sums::default(),
            start_energy,
            ended: None,
            model,
        }
    }

    /// The present time in s.
    pub fn time(&self) -> f64 {
        self.now
    }

    /// The present model; its drive's phase is the live one.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// How the run ended, if it did: it cannot be advanced further.
    pub fn ended(&self) -> Option<Outcome> {
        self.ended.filter(|outcome| outcome.ended_at().is_some_and(|at| self.now >= at))
    }

    /// Advances to `to` in s and appends the samples at `times`, which ascend, are later than the present and
    /// not later than `to`, and the events up to `to`.
    ///
    /// Returns false if the work of one call was used up or the run ended before `to`; the present time is
    /// then the time reached, and there is no sample beyond it.
    pub fn advance(&mut self, to: f64, times: &[f64], into: &mut LiveOutput) -> bool {
        let to = to.min(self.model.duration);
        if !(to > self.now) {
            self.deliver(into);
            return true;
        }
        let (samples_from, mut reached) = (into.samples.len(), to);
        // the rest of the step that has already been taken
        let head_time = self.kernel.seconds(&self.head);
        let known = times.partition_point(|t| *t < head_time);
        into.samples.extend(self.kernel.resample(&self.model, &self.tail, &self.head, &times[..known]));
        if self.ended.is_none() {
            let stretch = self.kernel.proceed(&self.model, &self.head, to, &times[known..]);
            into.samples.extend(stretch.samples);
            self.pending.extend(stretch.events);
            if let Some((tail, before)) = stretch.last {
                self.past.add(&self.ahead, &self.model);
                self.past.add(&before, &self.model);
                self.ahead = stretch.sums.minus(&before);
                self.tail = tail;
                self.head = stretch.head;
            }
            self.ended = stretch.ended;
            if stretch.exhausted {
                reached = self.kernel.seconds(&self.tail);
            }
        }
        if let Some(end) = self.ended.and_then(Outcome::ended_at) {
            reached = reached.min(end);
        }
        self.now = reached.max(self.now);
        let kept = into.samples[samples_from..].partition_point(|sample| sample.t <= self.now);
        into.samples.truncate(samples_from + kept);
        self.deliver(into);
        reached >= to
    }

    /// Delivers the events that are due.
    fn deliver(&mut self, into: &mut LiveOutput) {
        let due = self.pending.partition_point(|event| event.t <= self.now);
        into.events.extend(self.pending.drain(..due));
    }

    /// Acceleration of the base in m/s^2 at a time in s, by the present drive.
    pub fn base_acceleration(&self, t: f64) -> f64 {
        self.kernel.base_at(t.max(0.0))
    }

    /// The state at the present time.
    pub fn state(&self) -> Sample {
        let (checkpoint, _) = self.present();
        self.sample(&checkpoint)
    }

    fn sample(&self, checkpoint: &Checkpoint<f64>) -> Sample {
        Sample {
            t: self.now,
            x: checkpoint.state.x,
            v: checkpoint.state.v / self.kernel.unit(),
            base_accel: self.kernel.base(checkpoint),
            phase: checkpoint.state.phase(),
            electrical: self.electrical(checkpoint),
        }
    }

    /// Electrical state of the transducer, in A or V; 0 without one.
    fn electrical(&self, checkpoint: &Checkpoint<f64>) -> f64 {
        let (state, unit) = (checkpoint.state.circuit, self.kernel.unit());
        self.model.circuit().map_or(0.0, |circuit| circuit.amount * state / unit)
    }

    /// Energy in J of a state: kinetic, potential, and that stored in the transducer.
    fn energy(&self, checkpoint: &Checkpoint<f64>) -> f64 {
        let v = checkpoint.state.v / self.kernel.unit();
        energy(&self.model, (checkpoint.state.x, v))
            + self.model.electrical_energy(self.electrical(checkpoint))
    }

    /// The state at the present time and the energies from the tail to there.
    fn present(&self) -> (Checkpoint<f64>, Sums) {
        self.kernel.present(&self.model, &self.tail, &self.head, self.now).unwrap_or((self.head, self.ahead))
    }

    /// The energies up to the present time.
    pub fn ledger(&self) -> LiveLedger {
        let (checkpoint, sums) = self.present();
        let mut ledger = self.past;
        ledger.add(&sums, &self.model);
        ledger.stored_j = self.energy(&checkpoint) - self.start_energy;
        ledger
    }

    /// Replaces the model from now on. The start, duration and settled window of `model` have no effect.
    ///
    /// Time continues, and with it every function of time (a record, a chirp, a ramp). Tones stay in phase
    /// even if their frequency changes. The mass keeps its place and speed; a stop that now lies on the other
    /// side of it carries it along and takes its speed, as does the end of the known curve.
    pub fn change(&mut self, model: &Model, into: &mut LiveOutput) {
        self.shifts = phase_shifts(&self.model, model, &self.shifts, self.now);
        self.scene_times = (model.duration, model.settle);
        let mut next = without_end(model.clone());
        for (tone, shift) in next.excitation.tones.iter_mut().zip(&self.shifts) {
            tone.phase = fraction(tone.phase + shift);
        }
        let state = self.state();
        self.continue_with(next, (state.x, state.v), state.phase, into);
    }

    /// Puts the mass at `x` in m with velocity `v` in m/s, as far as the stops permit. Nothing changes if a
    /// number or the energy of the new state is not finite.
    pub fn place(&mut self, x: f64, v: f64, into: &mut LiveOutput) {
        if !(x.is_finite() && v.is_finite()) {
            return;
        }
        let next = self.model.clone();
        if !energy(&next, next.held_within((x, v), 0.0)).is_finite() {
            return;
        }
        self.continue_with(next, (x, v), Phase::Free, into);
    }

    /// Continues with the model `next` from the `wanted` state, as far as its stops and curve permit.
    fn continue_with(&mut self, mut next: Model, wanted: (f64, f64), previous: Phase, into: &mut LiveOutput) {
        let (checkpoint, sums) = self.present();
        let before = self.energy(&checkpoint);
        self.past.add(&sums, &self.model);
        // A stop that is pressed in stays pressed in: it moves the mass only if it is moved over it.
        let depth = self.model.pressed_depth(wanted.0).filter(|_| previous != Phase::Free);
        let depth = depth.filter(|_| next.compliant.is_some()).map_or(0.0, |depth| depth.0);
        next.start = next.held_within(wanted, depth);
        next.motionless = false;
        next.start_electrical = next.electrical_after(&self.model, self.electrical(&checkpoint));
        let charged = next.electrical_energy(next.start_electrical);
        self.past.by_hand_j += energy(&next, next.start) + charged - before;
        let (was_compliant, is_compliant) = (self.model.compliant.is_some(), next.compliant.is_some());
        self.model = next;
        self.kernel = Arc::new(Kernel::new(&self.model));
        let (start, mut happened) = self.kernel.start(&self.model, self.now);
        // A rest that continues is not an event; the end of a rest is.
        let rests = start.state.phase();
        match previous {
            Phase::Free => {}
            _ if previous == rests && was_compliant == is_compliant => {
                happened.retain(|event| !matches!(event.kind, EventKind::Rest | EventKind::Contact));
            }
            _ => {
                let side = if previous == Phase::LeftStop { Side::Left } else { Side::Right };
                let kind = if was_compliant { EventKind::Separate } else { EventKind::Release };
                happened.insert(0, Event { t: self.now, kind, side, v_in: 0.0, v_out: 0.0 });
            }
        }
        (self.tail, self.head, self.pending) = (start, start, happened);
        self.ahead = Sums::default();
        self.ended = None;
        self.deliver(into);
        into.samples.push(self.sample(&start));
    }

    /// A model whose run begins at the present state and phase and lasts as long as the scene's: it shows how
    /// this motion continues. `None` under a ramp, a chirp or a record, which are functions of the time since
    /// the start.
    pub fn from_here(&self) -> Option<Model> {
        let drive = &self.model.excitation;
        if !drive.has_only_tones() || drive.tones.iter().any(|tone| tone.ramp.is_some()) {
            return None;
        }
        let mut model = self.model.clone();
        (model.duration, model.settle) = self.scene_times;
        for tone in &mut model.excitation.tones {
            let turns = DoubleDouble::product(tone.frequency, self.now);
            tone.phase = fraction(tone.phase + (turns - turns.floor()).to_f64());
        }
        let turns = model.forcing_period.map_or(0.0, |period| self.now / period);
        model.start_phase = (model.start_phase + turns).rem_euclid(1.0);
        let (checkpoint, _) = self.present();
        model.start = (checkpoint.state.x, checkpoint.state.v / self.kernel.unit());
        model.start_electrical = self.electrical(&checkpoint);
        model.motionless = checkpoint.state.contact == Contact::Motionless;
        Some(model)
    }
}

impl LiveLedger {
    /// The residual: work + by hand - damping - impact - harvested - coil - stored in J. Each term is
    /// integrated separately, so the residual is not 0 but as small as the tolerance makes it.
    pub fn residual_j(&self) -> f64 {
        let taken = self.damping_j + self.impact_j + (self.harvested_j + self.coil_j);
        self.work_j + self.by_hand_j - taken - self.stored_j
    }

    /// |residual| over the sum of the magnitudes of the terms; 0 if all are 0.
    pub fn energy_residual(&self) -> f64 {
        let Self { work_j, damping_j, impact_j, harvested_j, coil_j, by_hand_j, stored_j } = *self;
        let terms = [work_j, by_hand_j, damping_j, impact_j, harvested_j, coil_j, stored_j];
        let moved: f64 = terms.iter().map(|term| term.abs()).sum();
        if moved > 0.0 { self.residual_j().abs() / moved } else { 0.0 }
    }

    /// The difference from an `earlier` ledger.
    pub fn since(&self, earlier: &Self) -> Self {
        Self {
            work_j: self.work_j - earlier.work_j,
            damping_j: self.damping_j - earlier.damping_j,
            impact_j: self.impact_j - earlier.impact_j,
            harvested_j: self.harvested_j - earlier.harvested_j,
            coil_j: self.coil_j - earlier.coil_j,
            by_hand_j: self.by_hand_j - earlier.by_hand_j,
            stored_j: self.stored_j - earlier.stored_j,
        }
    }

    fn add(&mut self, sums: &Sums, model: &Model) {
        let unit = model.scales.unit();
        let energy = model.mass / (unit * unit);
        self.work_j += sums.work * energy;
        self.damping_j += model.damping * sums.squared_velocity / unit;
        self.impact_j += sums.impact * energy;
        if let Some(transducer) = &model.transducer {
            let squared = match &transducer.circuit {
                Some(circuit) => circuit.amount * circuit.amount * sums.circuit,
                None => sums.squared_velocity,
            };
            let (load, coil) = transducer.energies(squared / unit);
            self.harvested_j += load;
            self.coil_j += coil;
        }
    }
}

/// The model with a very long duration and an empty settled window.
fn without_end(mut model: Model) -> Model {
    let unit = model.scales.unit();
    let counted = MAX_PERIODS / model.excitation.fastest().unwrap_or(0.0);
    model.duration = (HORIZON_UNITS * unit).max(model.duration).min(counted);
    model.settle = model.duration;
    model
}

/// Kinetic energy and potential in J at a displacement and a velocity.
fn energy(model: &Model, (x, v): (f64, f64)) -> f64 {
    let (kinetic, potential) = model.energies(x, v);
    kinetic + potential
}

/// The turns by which each tone of `new` has to be ahead of its scene from `now` in s on, if those of `old`
/// were ahead by `shifts`. Tones correspond by their order; all shifts are 0 if the number of tones differs.
fn phase_shifts(old: &Model, new: &Model, shifts: &[f64], now: f64) -> Vec<f64> {
    let (from, to) = (&old.excitation.tones, &new.excitation.tones);
    if from.len() != to.len() {
        return vec![0.0; to.len()];
    }
    // a change of amplitude needs no correction; if the frequency f becomes f' at time t, the phase has to
    // grow by (f - f') t turns
    let shifted = |((from, to), shift): ((&TonePart, &TonePart), &f64)| {
        if from.frequency == to.frequency {
            return *shift;
        }
        let turns = DoubleDouble::product(from.frequency, now) - DoubleDouble::product(to.frequency, now);
        fraction(shift + (turns - turns.floor()).to_f64())
    };
    from.iter().zip(to).zip(shifts).map(shifted).collect()
}

/// Fraction of a turn, 0 <= fraction < 1.
fn fraction(turns: f64) -> f64 {
    let fraction = turns - turns.floor();
    if fraction < 1.0 { fraction } else { 0.0 }
}
