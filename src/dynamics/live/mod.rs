//! Live run: a motion that is changed while it runs.
//!
//! A [`Live`] run is the integrator of [`Model::run`] without an end: it steps ahead of the time that it has
//! been advanced to, and what it hands out never depends on how often it was asked. So a run that is advanced
//! in any pieces takes the same steps as one that is not, to the bit; a time between two steps is looked
//! at by taking the last step once more, up to there.
//!
//! A change of the model takes effect at the present time: the state is kept as far as the new stops and the
//! new curve allow, and the drive goes on in phase. Whatever energy a change puts in or takes out by itself
//! (a stop dragged over the mass, a new potential under it, a mass put elsewhere) is in the ledger as moved
//! by hand.

mod kernel;
mod phase;

use crate::dynamics::model::Model;
use crate::dynamics::result::{Event, EventKind, Outcome, Phase, Sample, Side};
use crate::dynamics::state::{Checkpoint, Contact};
use kernel::{Kernel, Sums};

/// Longest live run in kernel time units: some years of the prototype. The clock of an undriven scene is
/// still the one that [`Model::run`] has.
const HORIZON_UNITS: f64 = 8_589_934_592.0;

/// Periods of the fastest tone that the clock counts exactly.
const MOST_PERIODS: f64 = 9e15;

/// Samples and events of a stretch of time, each ascending. The caller may drain them as it likes.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct LiveOutput {
    /// The state at the times asked for, and right after every change.
    pub samples: Vec<Sample>,
    /// What happened.
    pub events: Vec<Event>,
}

/// Energy balance of a live run since it began, in J. `stored` is what is there now less what was there at
/// the start: work + by hand - damping - impact - harvested - coil = stored.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
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

/// A run that is continued from its present state; see the module.
#[derive(Debug, Clone)]
pub struct Live {
    /// The model as it acts now, its drive shifted so that its phase went on through every change.
    model: Model,
    /// Duration and begin of the settled window that the scene asked for.
    asked: (f64, f64),
    kernel: Kernel,
    /// Turns by which each tone is ahead of its scene.
    shifts: Vec<f64>,
    now: f64,
    /// The begin of the step in which the present time lies, and its end.
    tail: Checkpoint<f64>,
    head: Checkpoint<f64>,
    /// Events of that step that are still to come.
    coming: Vec<Event>,
    /// Energies up to the tail, and of the step from there to the head.
    past: LiveLedger,
    ahead: Sums,
    /// Kinetic energy and potential at the start in J.
    start_energy: f64,
    ended: Option<Outcome>,
}

impl Live {
    /// A run from the model's own start, at time 0. What happens at once (a start pressed on a stop rests)
    /// comes with the first [`advance`](Self::advance).
    pub fn new(model: &Model) -> Self {
        let asked = (model.duration, model.settle);
        let model = without_end(model.clone());
        let shifts = vec![0.0; model.excitation.tones.len()];
        let kernel = Kernel::new(&model);
        let (start, coming) = kernel.start(&model, 0.0);
        let start_energy = energy(&model, model.start) + model.charged(model.start_electrical);
        Self {
            kernel,
            shifts,
            asked,
            now: 0.0,
            tail: start,
            head: start,
            coming,
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

    /// The model as it acts now; its drive's phase is the live one.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// How the run ended, where it did: it cannot be advanced further.
    pub fn ended(&self) -> Option<Outcome> {
        self.ended.filter(|outcome| outcome.ended_at().is_some_and(|at| self.now >= at))
    }

    /// Advances to `to` in s and appends what happens on the way: samples at `times`, ascending, later than
    /// the present and not later than `to`, and the events up to `to`.
    ///
    /// False where the work of one call was used up or the run ended before `to`; the present time then says
    /// how far it came, and no sample beyond it was made.
    pub fn advance(&mut self, to: f64, times: &[f64], into: &mut LiveOutput) -> bool {
        let to = to.min(self.model.duration);
        if !(to > self.now) {
            self.deliver(into);
            return true;
        }
        let (samples_from, mut reached) = (into.samples.len(), to);
        // the rest of the step that has been taken already
        let head_time = self.kernel.seconds(&self.head);
        let known = times.partition_point(|t| *t < head_time);
        self.kernel.look(&self.model, &self.tail, &self.head, &times[..known], &mut into.samples);
        if self.ended.is_none() {
            let stretch = self.kernel.proceed(&self.model, &self.head, to, &times[known..]);
            into.samples.extend(stretch.samples);
            self.coming.extend(stretch.events);
            if let Some((tail, before)) = stretch.last {
                self.past.add(&self.ahead, &self.model);
                self.past.add(&before, &self.model);
                self.ahead = stretch.sums.less(&before);
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

    /// The events that are due.
    fn deliver(&mut self, into: &mut LiveOutput) {
        let due = self.coming.partition_point(|event| event.t <= self.now);
        into.events.extend(self.coming.drain(..due));
    }

    /// Acceleration of the base in m/s^2 at a time in s, as the drive is now.
    pub fn base_acceleration(&self, t: f64) -> f64 {
        self.kernel.base_at(t.max(0.0))
    }

    /// The state at the present time.
    pub fn state(&self) -> Sample {
        let (carried, _) = self.present();
        self.sample(&carried)
    }

    fn sample(&self, carried: &Checkpoint<f64>) -> Sample {
        Sample {
            t: self.now,
            x: carried.state.x,
            v: carried.state.v / self.kernel.unit(),
            base_accel: self.kernel.base(carried),
            phase: carried.state.phase(),
            electrical: self.electrical(carried),
        }
    }

    /// Electrical state of the transducer, in A or V; 0 where it has none.
    fn electrical(&self, carried: &Checkpoint<f64>) -> f64 {
        self.model
            .circuit()
            .map_or(0.0, |circuit| circuit.amount * carried.state.circuit / self.kernel.unit())
    }

    /// The state at the present time and the energies from the tail to there.
    fn present(&self) -> (Checkpoint<f64>, Sums) {
        self.kernel.present(&self.model, &self.tail, &self.head, self.now).unwrap_or((self.head, self.ahead))
    }

    /// The energies up to the present time.
    pub fn ledger(&self) -> LiveLedger {
        let (carried, sums) = self.present();
        let mut ledger = self.past;
        ledger.add(&sums, &self.model);
        let v = carried.state.v / self.kernel.unit();
        let now = energy(&self.model, (carried.state.x, v)) + self.model.charged(self.electrical(&carried));
        ledger.stored_j = now - self.start_energy;
        ledger
    }

    /// From now on the mass moves as `model` says. Its start, duration and settled window do not act.
    ///
    /// The time goes on, and with it whatever is a function of time (a record, a chirp, a ramp). Tones go on
    /// in phase also where their frequency changes. The mass keeps its place and speed; a stop that now lies
    /// on the other side of it carries it along, as the end of the known curve does, and takes its speed.
    pub fn change(&mut self, model: &Model, into: &mut LiveOutput) {
        self.shifts = phase::shifts(&self.model, model, &self.shifts, self.now);
        self.asked = (model.duration, model.settle);
        let mut next = without_end(model.clone());
        phase::shift(&mut next.excitation, &self.shifts);
        let state = self.state();
        self.go_on(next, (state.x, state.v), state.phase, into);
    }

    /// Puts the mass to `x` in m with velocity `v` in m/s, as far as the stops let it. What is no number
    /// changes nothing, nor does a state whose energy is none.
    pub fn place(&mut self, x: f64, v: f64, into: &mut LiveOutput) {
        if !(x.is_finite() && v.is_finite()) {
            return;
        }
        let next = self.model.clone();
        if !energy(&next, next.held_within((x, v), 0.0)).is_finite() {
            return;
        }
        self.go_on(next, (x, v), Phase::Free, into);
    }

    fn go_on(&mut self, mut next: Model, wanted: (f64, f64), was: Phase, into: &mut LiveOutput) {
        let (carried, sums) = self.present();
        let before = energy(&self.model, (carried.state.x, carried.state.v / self.kernel.unit()))
            + self.model.charged(self.electrical(&carried));
        self.past.add(&sums, &self.model);
        // Where a stop was pressed in, it stays so: only what a stop is moved over is carried along.
        let depth = self.model.pressed_depth(wanted.0).filter(|_| was != Phase::Free);
        let depth = depth.filter(|_| next.compliant.is_some()).map_or(0.0, |depth| depth.0);
        next.start = next.held_within(wanted, depth);
        next.motionless = false;
        next.start_electrical = next.taken_over(&self.model, self.electrical(&carried));
        let charged = next.charged(next.start_electrical);
        self.past.by_hand_j += energy(&next, next.start) + charged - before;
        let (gave, gives) = (self.model.compliant.is_some(), next.compliant.is_some());
        self.model = next;
        self.kernel = Kernel::new(&self.model);
        let (start, mut happened) = self.kernel.start(&self.model, self.now);
        // Resting on is no event, and letting go is one.
        let rests = start.state.phase();
        match was {
            Phase::Free => {}
            _ if was == rests && gave == gives => {
                happened.retain(|event| !matches!(event.kind, EventKind::Rest | EventKind::Contact));
            }
            _ => {
                let side = if was == Phase::LeftStop { Side::Left } else { Side::Right };
                let kind = if gave { EventKind::Separate } else { EventKind::Release };
                happened.insert(0, Event { t: self.now, kind, side, v_in: 0.0, v_out: 0.0 });
            }
        }
        (self.tail, self.head, self.coming) = (start, start, happened);
        self.ahead = Sums::default();
        self.ended = None;
        self.deliver(into);
        into.samples.push(self.sample(&start));
    }

    /// A model whose run begins at the present state and phase and lasts as long as the scene's own: what
    /// will become of this motion. None under a ramp, a chirp or a record, which are functions of the time
    /// since the start.
    pub fn from_here(&self) -> Option<Model> {
        let drive = &self.model.excitation;
        let repeats = drive.chirps.is_empty() && drive.records.is_empty();
        if !repeats || drive.tones.iter().any(|tone| tone.ramp.is_some()) {
            return None;
        }
        let mut model = self.model.clone();
        (model.duration, model.settle) = self.asked;
        phase::advance(&mut model.excitation, self.now);
        let turns = model.forcing_period.map_or(0.0, |period| self.now / period);
        model.start_phase = (model.start_phase + turns).rem_euclid(1.0);
        let (carried, _) = self.present();
        model.start = (carried.state.x, carried.state.v / self.kernel.unit());
        model.start_electrical = self.electrical(&carried);
        model.motionless = carried.state.contact == Contact::Motionless;
        Some(model)
    }
}

impl LiveLedger {
    /// What is left over: work + by hand - damping - impact - harvested - coil - stored in J. Each term is
    /// integrated on its own, so it is not 0 but as small as the tolerance makes it.
    pub fn residual_j(&self) -> f64 {
        let taken = self.damping_j + self.impact_j + (self.harvested_j + self.coil_j);
        self.work_j + self.by_hand_j - taken - self.stored_j
    }

    /// |residual| over the sum of the magnitudes moved; 0 where nothing moved.
    pub fn energy_residual(&self) -> f64 {
        let Self { work_j, damping_j, impact_j, harvested_j, coil_j, by_hand_j, stored_j } = *self;
        let terms = [work_j, by_hand_j, damping_j, impact_j, harvested_j, coil_j, stored_j];
        let moved: f64 = terms.iter().map(|term| term.abs()).sum();
        if moved > 0.0 { self.residual_j().abs() / moved } else { 0.0 }
    }

    /// What was added to it since it was `earlier`.
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

/// The model with a duration that no one waits for; nothing of it is settled.
fn without_end(mut model: Model) -> Model {
    let unit = model.scales.unit();
    let counted = MOST_PERIODS / model.excitation.fastest().unwrap_or(0.0);
    model.duration = (HORIZON_UNITS * unit).max(model.duration).min(counted);
    model.settle = model.duration;
    model
}

/// Kinetic energy and potential in J at a displacement and a velocity.
fn energy(model: &Model, (x, v): (f64, f64)) -> f64 {
    let (kinetic, potential) = model.energies(x, v);
    kinetic + potential
}
