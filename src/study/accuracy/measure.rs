//! Digits that the conditioning of a problem allows, and digits reached.
//!
//! The digits allowed follow from the problem, not from the result: an error bound is the sum, over the
//! steps of a run, of the error of one step ([`STEP_ERROR`]) times the sensitivity of the answer to it.
//! The second factor is the problem's conditioning; each case derives it from the closed form or, where
//! there is none, takes it from the reference: the answer's change under small relative changes of the
//! data ([`Bench::sensitivity`]).

use std::sync::atomic::Ordering;

use super::Stopped;
use super::scenes::Setup;
use crate::dynamics::{Model, Outcome, Request, Run};
use crate::scene::{FieldPath, numeric_fields};
use crate::study::Task;

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
    /// Whether the check passes.
    pub fn passes(self) -> bool {
        match self {
            Self::Error { error, allowed } => error <= allowed,
            Self::Fact(holds) => holds,
        }
    }

    /// Decimal digits allowed, 0 to 16; `None` for a fact.
    pub fn digits_allowed(self) -> Option<f64> {
        match self {
            Self::Error { allowed, .. } => Some(digits(allowed)),
            Self::Fact(_) => None,
        }
    }

    /// Decimal digits reached, 0 to 16; `None` for a fact.
    pub fn digits_reached(self) -> Option<f64> {
        match self {
            Self::Error { error, .. } => Some(digits(error)),
            Self::Fact(_) => None,
        }
    }
}

/// Decimal digits of a relative error: those of a double at most.
fn digits(error: f64) -> f64 {
    if error.is_nan() { 0.0 } else { (-error.log10()).clamp(0.0, 16.0) }
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
    /// A variant of `run` without checks.
    pub(super) fn of(name: &'static str, run: &Run) -> Self {
        let summary = &run.summary;
        Self {
            name,
            steps: summary.steps,
            evaluations: summary.evaluations,
            cpu_s: summary.cpu_s,
            checks: Vec::new(),
        }
    }

    /// Adds a number's error and the allowed error, at least two spacings of the doubles in which the number
    /// is given.
    pub(super) fn number(mut self, quantity: &'static str, error: f64, allowed: f64) -> Self {
        let allowed = allowed.max(2.0 * f64::EPSILON);
        self.checks.push((quantity, Check::Error { error, allowed }));
        self
    }

    /// Adds the pair of error and allowed error with the largest ratio; a failed fact if there is no pair.
    pub(super) fn worst(self, quantity: &'static str, pairs: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let floor = 2.0 * f64::EPSILON;
        let shares = pairs.into_iter().map(|(error, allowed)| (error, allowed.max(floor)));
        let share = |pair: &(f64, f64)| if pair.0.is_nan() { f64::INFINITY } else { pair.0 / pair.1 };
        match shares.max_by(|a, b| share(a).total_cmp(&share(b))) {
            Some((error, allowed)) => self.number(quantity, error, allowed),
            None => self.fact(quantity, false),
        }
    }

    pub(super) fn fact(mut self, quantity: &'static str, holds: bool) -> Self {
        self.checks.push((quantity, Check::Fact(holds)));
        self
    }

    /// The check with the smallest margin: one that fails, else the number nearest to its bound, else a fact.
    pub fn tightest(&self) -> Option<(&'static str, Check)> {
        let share = |check: &Check| match *check {
            Check::Fact(false) => f64::INFINITY,
            Check::Fact(true) => -1.0,
            Check::Error { error, .. } if error.is_nan() => f64::INFINITY,
            Check::Error { error, allowed } => error / allowed,
        };
        self.checks.iter().copied().max_by(|a, b| share(&a.1).total_cmp(&share(&b.1)))
    }
}

/// Runs of the cases, in doubles and in double-doubles.
pub(super) struct Bench<'a> {
    task: &'a Task<'a>,
}

impl<'a> Bench<'a> {
    pub fn new(task: &'a Task<'a>) -> Self {
        Self { task }
    }

    fn request<'b>(&'b self, times: &'b [f64]) -> Request<'b> {
        Request {
            sample_times: times,
            events: true,
            ledger: true,
            cancel: Some(self.task.cancel),
            ..Request::default()
        }
    }

    /// A run with events, ledger and samples at `times`, ascending.
    pub fn run(&self, model: &Model, times: &[f64]) -> Result<Run, Stopped> {
        self.unless_cancelled(model.run(&self.request(times)))
    }

    /// A run that keeps statistics alone.
    pub fn run_bare(&self, model: &Model) -> Result<Run, Stopped> {
        self.unless_cancelled(model.run(&Request { events: false, ledger: false, ..self.request(&[]) }))
    }

    /// A run in double-double arithmetic.
    pub fn reference(&self, model: &Model, times: &[f64]) -> Result<Run, Stopped> {
        self.unless_cancelled(model.run_reference(&self.request(times), REFERENCE_TOLERANCE))
    }

    fn unless_cancelled(&self, run: Run) -> Result<Run, Stopped> {
        let cancelled = matches!(run.summary.outcome, Outcome::Cancelled { .. });
        if cancelled || self.task.cancel.load(Ordering::Relaxed) { Err(Stopped::Cancelled) } else { Ok(run) }
    }

    /// Sensitivities of numbers of a run to its data: for each number the sum, over the data, of |change of
    /// the number| per relative change of the datum, by runs in double-double arithmetic with the datum
    /// changed by [`CHANGE`].
    ///
    /// The data are mass, start velocity, amplitude, damping, restitution, and a transducer's numbers, as far
    /// as the scene has them: a change of the mass is one of every acceleration all along the run, one of the
    /// restitution of every rebound, so that errors made on the way are covered and not only those of the
    /// start. `numbers` must return the same quantities in the same order for every run.
    pub fn sensitivity(
        &self,
        setup: &Setup,
        times: &[f64],
        numbers: impl Fn(&Run) -> Vec<f64>,
    ) -> Result<Vec<f64>, Stopped> {
        self.sensitivity_by(CHANGE, setup, times, numbers)
    }

    /// The same by a relative change of `change`.
    pub fn sensitivity_by(
        &self,
        change: f64,
        setup: &Setup,
        times: &[f64],
        numbers: impl Fn(&Run) -> Vec<f64>,
    ) -> Result<Vec<f64>, Stopped> {
        let base = numbers(&self.reference(&setup.model()?, times)?);
        let mut sums = vec![0.0; base.len()];
        for changed in changed(setup, change) {
            let values = numbers(&self.reference(&changed.model()?, times)?);
            for (i, sum) in sums.iter_mut().enumerate() {
                *sum += values.get(i).map_or(f64::INFINITY, |value| (value - base[i]).abs() / change);
            }
        }
        Ok(sums)
    }

    /// Errors that a run of this scene may have in numbers with these sensitivities: a [`STEP_ERROR`] of all
    /// data in every step, of which there are `steps` in the run; a change of a datum acts once a time scale,
    /// so that shorter steps count for more.
    pub fn allowed(model: &Model, steps: u64, sensitivities: &[f64]) -> Vec<f64> {
        let per_scale = steps as f64 * model.scales().time / model.duration();
        let error = STEP_ERROR * per_scale.max(1.0);
        sensitivities.iter().map(|sensitivity| sensitivity * error).collect()
    }
}

/// The scene with one datum changed at a time: mass, speed, drive, damping, restitution and electrical data,
/// each given by the begin and the ends of its field paths.
fn changed(setup: &Setup, change: f64) -> Vec<Setup> {
    let (more, less) = (1.0 + change, 1.0 - change);
    let data: [(&str, &[&str], f64); 9] = [
        ("mass_g", &[""], more),
        ("start.v_m_per_s", &[""], more),
        ("excitation.", &["accel_g", "amplitude_g", ".from_g", ".to_g", "rms_g"], more),
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
        let is_meant =
            |field: &&String| field.starts_with(begin) && ends.iter().any(|end| field.ends_with(end));
        for field in fields.iter().filter(is_meant).map(|field| FieldPath::new(field)) {
            // a restitution of 1 stays elastic
            if let Some(value) = field.get(&setup.scene).filter(|value| by > 1.0 || *value < 1.0) {
                let _ = field.set(&mut changed.scene, value * by);
            }
        }
        (changed.scene != setup.scene).then_some(changed)
    };
    data.into_iter().filter_map(with).collect()
}

/// |value - exact| relative to `scale`.
pub(super) fn off(value: f64, exact: f64, scale: f64) -> f64 {
    (value - exact).abs() / scale
}
