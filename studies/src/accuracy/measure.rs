//! Digits that the conditioning of a problem allows, and digits reached.
//!
//! The digits allowed follow from the problem, not from the result: an error bound is the sum, over the
//! steps of a run, of the error of one step ([`STEP_ERROR`]) times the sensitivity of the answer to it.
//! The second factor is the problem's conditioning; each case derives it from the closed form or, where
//! there is none, takes it from the reference: the answer's change under small relative changes of the
//! data ([`Bench::reference`]).

use std::f64::consts::TAU;

use super::Stopped;
use super::setup::Setup;
use crate::dynamics::{Event, EventKind, Model, Request, Run, Sample, Summary};
use crate::numeric::elementary;
use crate::scene::{FieldPath, numeric_fields};
use crate::study::{Task, finished};

/// Largest error of the state in one step, relative to the scene's length and speed: four spacings of the
/// doubles at 1. At the tolerance 1e-14 one is the series cut off (a fiftieth of the tolerance, 2e-16), one
/// the rounding of the sums of displacement and velocity, two those of the force and its coefficients, which
/// are data rounded once to the units of a run.
pub const STEP_ERROR: f64 = 4.0 * f64::EPSILON;

/// Tolerance of runs in double-double arithmetic.
pub const REFERENCE_TOLERANCE: f64 = 1e-27;

/// Relative change of a datum from which a sensitivity is taken: small enough to be linear, large enough that
/// the doubles of a run's results resolve the difference to seven digits.
pub(super) const CHANGE: f64 = 1.0 / (1_u64 << 30) as f64;

/// The same for chaos, where the larger change saturates within twenty periods: four spacings of the doubles,
/// so that rounding alters the change by at most an eighth.
pub(super) const SMALL_CHANGE: f64 = 1.0 / (1_u64 << 50) as f64;

/// Result for one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Check {
    /// A number: its error and the error that the conditioning allows, both relative to what the case names.
    Error {
        /// Error reached.
        error: f64,
        /// Error allowed.
        allowed: f64,
    },
    /// A fact that holds or not, such as a number of impacts.
    Fact(bool),
}

impl Check {
    /// A number, whose allowed error is at least two spacings of the doubles in which it is given.
    fn number(error: f64, allowed: f64) -> Self {
        Self::Error { error, allowed: allowed.max(2.0 * f64::EPSILON) }
    }

    /// Whether the check passes.
    pub fn passes(self) -> bool {
        match self {
            Self::Error { error, allowed } => error <= allowed,
            Self::Fact(holds) => holds,
        }
    }

    /// Decimal digits allowed, 0 to 16; `None` for a fact.
    pub fn digits_allowed(self) -> Option<f64> {
        if let Self::Error { allowed, .. } = self { Some(digits(allowed)) } else { None }
    }

    /// Decimal digits reached, 0 to 16; `None` for a fact.
    pub fn digits_reached(self) -> Option<f64> {
        if let Self::Error { error, .. } = self { Some(digits(error)) } else { None }
    }

    /// The error as a share of that allowed; a fact comes before all numbers if it fails, else after them.
    fn share(self) -> f64 {
        match self {
            Self::Fact(false) => f64::INFINITY,
            Self::Fact(true) => -1.0,
            Self::Error { error, .. } if error.is_nan() => f64::INFINITY,
            Self::Error { error, allowed } => error / allowed,
        }
    }
}

/// Decimal digits of a relative error: those of a double at most.
fn digits(error: f64) -> f64 {
    if error.is_nan() { 0.0 } else { (-elementary::log10(error)).clamp(0.0, 16.0) }
}

/// One run of a case with its checks.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// Which of the case's runs.
    pub name: &'static str,
    /// Steps of the run.
    pub steps: u64,
    /// Taylor expansions.
    pub evaluations: u64,
    /// CPU time of the run in s.
    pub cpu_s: f64,
    /// The checks by quantity.
    pub checks: Vec<(&'static str, Check)>,
}

impl Variant {
    /// The check with the smallest margin: one that fails, else the number nearest to its bound, else a fact.
    pub fn tightest(&self) -> Option<(&'static str, Check)> {
        self.checks.iter().copied().max_by(|a, b| a.1.share().total_cmp(&b.1.share()))
    }
}

/// A run of a case, and the checks of it so far.
pub(super) struct Trial {
    pub variant: Variant,
    pub model: Model,
    pub run: Run,
}

pub(super) type Trials = Result<Vec<Trial>, Stopped>;

impl Trial {
    /// The sum of the errors of all steps, as it is where no error grows.
    pub fn added(&self) -> f64 {
        self.run.summary.steps as f64 * STEP_ERROR
    }

    pub fn impacts(&self) -> impl Iterator<Item = &Event> {
        self.run.events.iter().filter(|event| event.kind == EventKind::Impact)
    }

    /// Time in s of the first event of a kind; NaN without one.
    pub fn first(&self, kind: EventKind) -> f64 {
        self.run.events.iter().find(|event| event.kind == kind).map_or(f64::NAN, |event| event.t)
    }

    /// Adds a number's error and the allowed error.
    pub fn number(&mut self, quantity: &'static str, error: f64, allowed: f64) {
        self.variant.checks.push((quantity, Check::number(error, allowed)));
    }

    pub fn fact(&mut self, quantity: &'static str, holds: bool) {
        self.variant.checks.push((quantity, Check::Fact(holds)));
    }

    /// Adds the pair of error and allowed error with the largest ratio; a failed fact if there is no pair.
    pub fn worst(&mut self, quantity: &'static str, pairs: Vec<(f64, f64)>) {
        let checks = pairs.into_iter().map(|(error, allowed)| Check::number(error, allowed));
        let worst = checks.max_by(|a, b| a.share().total_cmp(&b.share()));
        self.variant.checks.push((quantity, worst.unwrap_or(Check::Fact(false))));
    }

    /// Adds the time of the first event of a kind; the error allowed is relative to `exact` in s.
    pub fn time(&mut self, quantity: &'static str, kind: EventKind, exact: f64, allowed: f64) {
        self.number(quantity, off(self.first(kind), exact, exact), allowed);
    }

    /// Adds the error of the displacement at the end, relative to `scale` in m.
    pub fn final_x(&mut self, quantity: &'static str, exact: f64, scale: f64, allowed: f64) {
        self.number(quantity, off(self.run.summary.final_x, exact, scale), allowed);
    }

    /// Adds the residual of the ledger.
    pub fn energy_balance(&mut self) {
        let residual = self.run.summary.ledger.map_or(f64::NAN, |ledger| ledger.energy_residual);
        self.number("energy balance", residual, self.added());
    }

    /// Compares times of impacts, as `impacts` takes them from a run, with the reference, and their number.
    pub fn impacts_beside(&mut self, reference: &Reference, impacts: impl Fn(&Run) -> Vec<f64>) {
        let found = impacts(&self.run);
        self.beside("impact times", &found, reference, &reference.numbers);
        self.fact("all impacts", found.len() == reference.numbers.len() && !found.is_empty());
    }

    /// Compares numbers of the run with the reference, each relative to its scale, and adds the worst.
    pub fn beside(&mut self, quantity: &'static str, numbers: &[f64], reference: &Reference, scales: &[f64]) {
        self.worst(quantity, pairs(numbers, &reference.numbers, &reference.allowed(self), scales));
    }

    /// Adds the sample of a linear system that uses the largest share of the error allowed. The errors of the
    /// steps up to it add up without growth, and the phase of the drive, whose highest frequency in Hz is
    /// `fastest`, is a product of two doubles. `exact` returns displacement, velocity, and the relative error
    /// of the electrical state if there is one.
    pub fn linear(
        &mut self,
        quantity: &'static str,
        fastest: f64,
        exact: impl Fn(&Sample) -> (f64, f64, Option<f64>),
    ) {
        let (scales, steps) = (self.model.scales(), self.run.summary.steps as f64);
        let pair = |sample: &Sample| {
            let (x, v, electrical) = exact(sample);
            let mechanical = off(sample.x, x, scales.length).max(off(sample.v, v, scales.speed));
            // at least one step
            let progress = (sample.t / self.model.duration()).max(1.0 / steps);
            let phase = TAU * fastest * sample.t * f64::EPSILON;
            let error = electrical.map_or(mechanical, |electrical| mechanical.max(electrical));
            (error, steps * STEP_ERROR * progress + phase)
        };
        self.worst(quantity, self.run.samples.iter().map(pair).collect());
    }
}

/// Numbers of a scene's run in double-double arithmetic, and their sensitivities to its data.
pub(super) struct Reference {
    pub numbers: Vec<f64>,
    pub sensitivities: Vec<f64>,
}

impl Reference {
    /// Errors that a run of the scene may have in the numbers: a [`STEP_ERROR`] of all data in every step; a
    /// change of a datum acts once a time scale, so that shorter steps count for more.
    pub fn allowed(&self, trial: &Trial) -> Vec<f64> {
        let model = &trial.model;
        let per_scale = trial.run.summary.steps as f64 * model.scales().time / model.duration();
        let error = STEP_ERROR * per_scale.max(1.0);
        self.sensitivities.iter().map(|sensitivity| sensitivity * error).collect()
    }
}

/// Runs of the cases, in doubles and in double-doubles.
pub(super) struct Bench<'a> {
    pub task: &'a Task<'a>,
}

impl Bench<'_> {
    fn request<'b>(&'b self, times: &'b [f64]) -> Request<'b> {
        let cancel = Some(self.task.cancel);
        Request { sample_times: times, events: true, ledger: true, cancel, ..Request::default() }
    }

    /// A run with events, ledger and samples at `times`, ascending.
    pub fn run(&self, name: &'static str, setup: &Setup, times: &[f64]) -> Result<Trial, Stopped> {
        self.run_as(name, setup, &self.request(times))
    }

    /// A run that keeps statistics alone.
    pub fn run_bare(&self, name: &'static str, setup: &Setup) -> Result<Trial, Stopped> {
        self.run_as(name, setup, &Request { events: false, ledger: false, ..self.request(&[]) })
    }

    fn run_as(&self, name: &'static str, setup: &Setup, request: &Request) -> Result<Trial, Stopped> {
        let model = setup.model()?;
        let run = self.unless_cancelled(model.run(request))?;
        let Summary { steps, evaluations, cpu_s, .. } = run.summary;
        Ok(Trial { variant: Variant { name, steps, evaluations, cpu_s, checks: Vec::new() }, model, run })
    }

    /// A run in double-double arithmetic.
    pub fn exact(&self, setup: &Setup, times: &[f64]) -> Result<Run, Stopped> {
        self.unless_cancelled(setup.model()?.run_reference(&self.request(times), REFERENCE_TOLERANCE))
    }

    fn unless_cancelled(&self, run: Run) -> Result<Run, Stopped> {
        finished(run).filter(|_| !self.task.is_cancelled()).ok_or(Stopped::Cancelled)
    }

    /// Numbers of a run, and their sensitivities to its data: for each number the sum, over the data, of
    /// |change of the number| per relative change of the datum, by runs in double-double arithmetic with the
    /// datum changed by `change`.
    ///
    /// The data are mass, start velocity, amplitude, damping, restitution, and a transducer's numbers, as far
    /// as the scene has them: a change of the mass is one of every acceleration all along the run, one of the
    /// restitution of every rebound, so that errors made on the way are covered and not only those of the
    /// start. `numbers` must return the same quantities in the same order for every run.
    pub fn reference(
        &self,
        setup: &Setup,
        times: &[f64],
        change: f64,
        numbers: impl Fn(&Run) -> Vec<f64>,
    ) -> Result<Reference, Stopped> {
        let base = numbers(&self.exact(setup, times)?);
        let mut sensitivities = vec![0.0; base.len()];
        for changed in changed(setup, change) {
            let values = numbers(&self.exact(&changed, times)?);
            for (i, sum) in sensitivities.iter_mut().enumerate() {
                *sum += values.get(i).map_or(f64::INFINITY, |value| (value - base[i]).abs() / change);
            }
        }
        Ok(Reference { numbers: base, sensitivities })
    }
}

/// Ends of the fields of a drive that are amplitudes.
const AMPLITUDES: &[&str] =
    &["accel_g", "amplitude_g", "amplitude_m_per_s2", "amplitude_n", ".from_g", ".to_g", "rms_g"];

/// The scene with one datum changed at a time: mass, speed, drive, damping, restitution and electrical data,
/// each given by the begin and the ends of its field paths.
fn changed(setup: &Setup, change: f64) -> Vec<Setup> {
    let (more, less) = (1.0 + change, 1.0 - change);
    let data: [(&str, &[&str], f64); 9] = [
        ("mass_g", &[""], more),
        ("start.v_m_per_s", &[""], more),
        ("excitation.", AMPLITUDES, more),
        ("damping.", &[""], more),
        ("stops.restitution", &[""], less),
        ("start.electrical", &[""], more),
        ("transducer.coupling", &[""], more),
        ("transducer.", &["inductance_mh", "capacitance_nf"], more),
        ("transducer.", &["ohm"], more),
    ];
    let fields = numeric_fields(&setup.scene);
    let with = |(begin, ends, by): (&str, &[&str], f64)| {
        let mut changed = setup.clone();
        let datum = |field: &&String| field.starts_with(begin) && ends.iter().any(|end| field.ends_with(end));
        for field in fields.iter().filter(datum).map(|field| FieldPath::new(field)) {
            // a restitution of 1 stays elastic
            if let Some(value) = field.get(&setup.scene).filter(|value| by > 1.0 || *value < 1.0) {
                let _ = field.set(&mut changed.scene, value * by);
            }
        }
        (changed.scene != setup.scene).then_some(changed)
    };
    data.into_iter().filter_map(with).collect()
}

/// Times in s of the events of one kind.
pub(super) fn times(run: &Run, kind: EventKind) -> Vec<f64> {
    run.events.iter().filter(|event| event.kind == kind).map(|event| event.t).collect()
}

/// Times in s of the impacts faster than `least` in m/s.
pub(super) fn impacts_above(least: f64, run: &Run) -> Vec<f64> {
    let is_hard = |event: &&Event| event.kind == EventKind::Impact && event.v_in.abs() > least;
    run.events.iter().filter(is_hard).map(|event| event.t).collect()
}

/// Times in s of the impacts above 1 cm/s.
pub(super) fn hard_impacts(run: &Run) -> Vec<f64> {
    impacts_above(1e-2, run)
}

pub(super) fn off(value: f64, exact: f64, scale: f64) -> f64 {
    (value - exact).abs() / scale
}

/// Errors of values and errors allowed, each relative to its scale, as far as all four go.
pub(super) fn pairs(values: &[f64], exact: &[f64], allowed: &[f64], scales: &[f64]) -> Vec<(f64, f64)> {
    let all = values.iter().zip(exact).zip(allowed).zip(scales);
    all.map(|(((value, exact), allowed), scale)| (off(*value, *exact, *scale), allowed / scale)).collect()
}
