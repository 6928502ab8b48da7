//! Accuracy of runs, and its cost.
//!
//! - Any scene ([`scene`]): the error of its run, the time up to which its path can be trusted, and the
//!   effect of a fixed step.
//! - Three problems ([`PROBLEMS`]): work against precision, compared with other common methods ([`methods`]).
//!   The error is measured against the program's own integrator in double-double arithmetic.
//! - Hard cases ([`HARD_CASES`]), which break integrators of impacts: each has its answer ([`exact`] where
//!   there is a closed form) and the digits that its conditioning allows.

mod cases;
mod chart;
pub mod exact;
mod measure;
pub mod methods;
mod precision;
mod report;
pub mod scene;
mod setup;

use crate::numeric::number_text;
use crate::questions::{Error, Progress, Simulation};
use crate::study::{Said, Table};
pub use cases::{HARD_CASES, HardCase};
pub use chart::{accuracy_chart, cost_panel, scene_accuracy_chart, steps_panel};
pub use measure::{Check, REFERENCE_TOLERANCE, STEP_ERROR, Variant};
use methods::Scheme;
pub use precision::{OWN, PROBLEMS, Point, Problem};
pub use report::{Report, Selection, accuracy, description, names};
use scene::{StepSize, Tolerances, Trust, Unfit, scene_table, step_name, step_size, tolerances, trust};
pub use setup::Stopped;

/// The error of the run of a scene, the cost of its digits, and the effect of fixed steps.
///
/// The table of the answer has one row per run: those at the tolerances 1e-3, 1e-6, 1e-9 and 1e-12 and at
/// that of the scene, then those in fixed steps, method by method: `method`, `tolerance`, `step_s`, `error_m`
/// (largest error of the displacement), `trusted_s` (missing if the path can be trusted for all of the time
/// compared), `compared_s`, `steps`, `evaluations`, `cpu_s`, `rms_velocity_m_per_s`, `impacts`, `late_s`,
/// `latest_s` (how late the mass arrives at its stops), `arrivals`, `outcome`.
///
/// Method: the runs are compared with one whose tolerance is a hundredth of the tightest, in double-double
/// arithmetic where that is below 1e-14. A path is trusted until it is off by a hundredth of the travel. In a
/// fixed step that ends beyond a stop the mass is put onto the stop and bounces there, as in many games.
///
/// Errors: [`Error::Argument`] for a step below 1e-6 or above 1 s, or of a scene with compliant stops or with
/// an electrical state; [`Error::Cancelled`]. A run that ends early is compared as far as it goes.
///
/// ```
/// use interwell_studies::questions::{Accuracy, Progress, Scheme, Simulation};
///
/// // A step of 1/60 s is far too long for impacts on stops.
/// let question = Accuracy { step_s: vec![1.0 / 60.0], method: vec![Scheme::VelocityVerlet] };
/// let answer = question.run(&Simulation::preset("bouncing-ball")?, &Progress::none())?;
/// let errors = answer.table();
/// let errors = errors.numbers("error_m").unwrap();
/// assert!(errors[errors.len() - 1] > 1e3 * answer.trust.error);
/// # Ok::<(), interwell_studies::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Accuracy {
    /// Fixed steps in s, 1e-6 to 1.
    pub step_s: Vec<f64>,
    /// The methods that take them; all if none is named.
    pub method: Vec<Scheme>,
}

/// The answer of [`Accuracy::run`].
#[derive(Debug, Clone, PartialEq)]
pub struct AccuracyAnswer {
    /// The error of the run of the scene.
    pub trust: Trust,
    /// The runs at several tolerances.
    pub tolerances: Tolerances,
    /// The runs in fixed steps.
    pub stepped: Vec<StepSize>,
}

/// The shortest and the longest step in s.
const STEPS_S: std::ops::RangeInclusive<f64> = 1e-6..=1.0;

impl Accuracy {
    /// Makes the runs one after the other, since their time is measured.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<AccuracyAnswer, Error> {
        self.check()?;
        let trust = Self::trust(simulation, None, progress)?;
        let tolerances = Self::tolerances(simulation, progress)?;
        let is_chosen = |scheme: &Scheme| self.method.is_empty() || self.method.contains(scheme);
        let methods = Scheme::ALL.into_iter().filter(is_chosen);
        let runs = methods.flat_map(|scheme| self.step_s.iter().map(move |step| (scheme, *step)));
        let stepped = runs.map(|(scheme, step)| Self::step_size(simulation, scheme, step, progress));
        Ok(AccuracyAnswer { trust, tolerances, stepped: stepped.collect::<Result<_, _>>()? })
    }

    /// Refuses steps that are too short or too long.
    #[doc(hidden)]
    pub fn check(&self) -> Result<(), Error> {
        self.step_s.iter().find(|step| !STEPS_S.contains(step)).map_or(Ok(()), |step| {
            let (least, most) = (STEPS_S.start(), STEPS_S.end());
            let problem = format!("no step; give seconds from {least:e} to {most}, such as 0.001 or 1/60");
            Err(Error::number("step_s", *step, problem))
        })
    }

    /// The error of a run of the scene, or of one that lasts for another time in s.
    #[doc(hidden)]
    pub fn trust(
        simulation: &Simulation,
        lasting_s: Option<f64>,
        progress: &Progress,
    ) -> Result<Trust, Error> {
        let model = simulation.model();
        let longer = lasting_s.map(|duration| model.with_duration(duration, model.settle()));
        trust(longer.as_ref().unwrap_or(model), progress.stop()).ok_or(Error::Cancelled)
    }

    /// The runs at several tolerances.
    #[doc(hidden)]
    pub fn tolerances(simulation: &Simulation, progress: &Progress) -> Result<Tolerances, Error> {
        tolerances(simulation.model(), progress.stop()).ok_or(Error::Cancelled)
    }

    /// The run by a method in a fixed step in s.
    #[doc(hidden)]
    pub fn step_size(
        simulation: &Simulation,
        scheme: Scheme,
        step: f64,
        progress: &Progress,
    ) -> Result<StepSize, Error> {
        step_size(simulation.model(), scheme, step, progress.stop()).map_err(|unfit| match unfit {
            Unfit::Cancelled => Error::Cancelled,
            _ => Error::argument("step_s", number_text(step), unfit),
        })
    }
}

impl AccuracyAnswer {
    /// One row per run, with the columns named at [`Accuracy`].
    pub fn table(&self) -> Table {
        scene_table(&self.tolerances, &self.stepped)
    }

    /// The error of the run in a sentence, then the effects of each fixed step.
    pub fn words(&self) -> Vec<String> {
        let Self { trust, stepped, .. } = self;
        let of_run = match trust.short(0.0) {
            Some(short) => format!("{short}. {}", trust.long(0.0)),
            None => format!("The run ends early ({}), after {} s.", trust.outcome.name(), trust.span),
        };
        let of_step = |run: &StepSize| {
            let (name, step, effects) = (run.scheme.name(), step_name(run.step), run.sentences().join(" "));
            format!("{name} in steps of {step}: {effects}")
        };
        std::iter::once(of_run).chain(stepped.iter().map(of_step)).collect()
    }
}

/// Runs problems and hard cases whose answers are known.
#[doc(hidden)]
pub fn check_accuracy(selection: &Selection, progress: &Progress) -> Result<Report, Error> {
    let report = progress.task(Some(selection.parts()), |task| accuracy(selection, task));
    report.map_err(|stopped| match stopped {
        Stopped::Cancelled => Error::Cancelled,
        Stopped::Scene(problem) => {
            let problem = format!("cannot be run: {problem}");
            Error::Failed { scene: "a scene of the study".to_owned(), problem: Said::new(problem) }
        }
    })
}
