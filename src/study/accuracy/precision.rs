//! Work against precision: three problems, and what each method pays for its digits.

use super::Stopped;
use super::measure::REFERENCE_TOLERANCE;
use super::methods::{Keep, Scheme, Statistics, dormand_prince, fixed_step};
use super::scenes::Setup;
use crate::dynamics::{Event, EventKind, Model, Outcome, Request};
use crate::study::Task;

/// The name of the program's own method.
pub const OWN: &str = "Taylor series";

const DORMAND_PRINCE: &str = "Dormand-Prince 5(4)";

/// Impacts faster than this in m/s count for the error.
const HARD: f64 = 1e-2;

/// Time in s for which a run is repeated to measure its CPU time.
pub(super) const MEASURED_FOR: f64 = 0.02;
/// Most repetitions of such a run.
const MOST_REPEATS: usize = 25;

/// Progress reports of a problem: the reference, the program's method, Dormand-Prince and each scheme.
pub(super) const PARTS: usize = 3 + Scheme::ALL.len();

/// How a problem's error is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Error {
    /// Of the final displacement, over this length in m.
    FinalDisplacement(f64),
    /// The worst of the times of the impacts above 1 cm/s, in forcing periods, and the relative error of the
    /// RMS velocity.
    ImpactsAndRms,
}

/// A problem on which methods are compared.
#[derive(Debug, Clone, Copy)]
pub struct Problem {
    /// The word that selects it.
    pub name: &'static str,
    /// What is run, in a few words for a heading.
    pub heading: &'static str,
    /// What is run.
    pub problem: &'static str,
    /// What the error is.
    pub error: &'static str,
    preset: &'static str,
    changes: &'static [&'static str],
    measure: Error,
}

const IMPACTS_AND_RMS: &str = "the worse of the times of the impacts above 1 cm/s, in forcing periods, each \
                               that of the nearest impact of the run on the same stop, and the relative \
                               error of the RMS velocity";

/// The three problems.
pub const PROBLEMS: &[Problem] = &[
    Problem {
        name: "p1",
        heading: "cubic well, no stops (p1)",
        problem: "nominal cubic well without stops, 1.1 g at 3 Hz from rest, 10 s",
        error: "final displacement over the well's distance",
        preset: "nominal-cubic",
        changes: &["stops=None", "excitation.amplitude_g=1.1"],
        measure: Error::FinalDisplacement(7e-3),
    },
    Problem {
        name: "p2",
        heading: "cubic well, stops (p2)",
        problem: "nominal cubic well, stops at 4 mm, e = 0.36, 1.5 g at 3 Hz from rest, 10 s: 780 impacts, \
                  60 rests",
        error: IMPACTS_AND_RMS,
        preset: "nominal-cubic",
        changes: &[],
        measure: Error::ImpactsAndRms,
    },
    Problem {
        name: "flexures",
        heading: "flexures, stops",
        problem: "the prototype's flexures (preset paper), stops at 1.5 mm, e = 0.36, 1 g at 3 Hz from rest, \
                  10 s",
        error: IMPACTS_AND_RMS,
        preset: "paper",
        changes: &[],
        measure: Error::ImpactsAndRms,
    },
];

/// Setting of a method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setting {
    /// Local error allowed, relative to the scene's scales.
    Tolerance(f64),
    /// Step in s.
    Step(f64),
}

/// One run of one method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Name of the problem.
    pub problem: &'static str,
    /// Name of the method.
    pub method: &'static str,
    /// Its setting.
    pub setting: Setting,
    /// Error, as the problem defines it.
    pub error: f64,
    /// Steps.
    pub steps: u64,
    /// Evaluations of the force, or Taylor expansions.
    pub evaluations: u64,
    /// CPU time in s: the median of a few runs that keep statistics alone.
    pub cpu_s: f64,
}

/// What an error is computed from.
struct Answer {
    final_x: f64,
    rms: f64,
    impacts: Vec<Event>,
}

impl Problem {
    /// The problem as run.
    pub fn model(&self) -> Result<Model, Stopped> {
        Setup::preset(self.preset, self.changes)?.model()
    }

    /// Tolerances 1e-3 to 1e-14 for the program's method and Dormand-Prince, steps of 1/60 s down to 5 us for
    /// the others.
    pub(super) fn measure(&self, task: &Task) -> Result<Vec<Point>, Stopped> {
        let model = self.model()?;
        let cancelled = || if task.is_cancelled() { Err(Stopped::Cancelled) } else { Ok(()) };
        let request = Request { events: true, cancel: Some(task.cancel), ..Request::default() };
        let answer = |run: crate::dynamics::Run| Answer {
            final_x: run.summary.final_x,
            rms: run.summary.rms_velocity.unwrap_or(f64::NAN),
            impacts: run.events.into_iter().filter(|event| event.kind == EventKind::Impact).collect(),
        };
        let exact = answer(model.run_reference(&request, REFERENCE_TOLERANCE));
        (task.tick)();
        let mut points = Vec::new();
        let point = |method, setting, error, statistics: &Statistics, cpu_s| Point {
            problem: self.name,
            method,
            setting,
            error,
            steps: statistics.steps,
            evaluations: statistics.evaluations,
            cpu_s,
        };
        for tolerance in tolerances() {
            cancelled()?;
            let model_at_tolerance = model.with_tolerance(tolerance);
            let run = model_at_tolerance.run(&request);
            let Outcome::Done = run.summary.outcome else { return Err(Stopped::Cancelled) };
            let summary = run.summary;
            let statistics = Statistics {
                steps: summary.steps,
                evaluations: summary.evaluations,
                ..Statistics::default()
            };
            let error = self.error_of(&model, &answer(run), &exact);
            let cpu_s = median(|| model_at_tolerance.run(&Request::default()).summary.cpu_s);
            points.push(point(OWN, Setting::Tolerance(tolerance), error, &statistics, cpu_s));
        }
        (task.tick)();
        let keep = Keep { impacts: true, cancel: Some(task.cancel), ..Keep::default() };
        let mut of = |method, setting, run: &dyn Fn(&Keep) -> super::methods::MethodRun| {
            let result = run(&keep);
            cancelled()?;
            let statistics = result.statistics;
            let answer = Answer {
                final_x: statistics.final_x,
                rms: statistics.rms_velocity.unwrap_or(f64::NAN),
                impacts: result.impacts,
            };
            let error = match statistics.ended_at {
                Some(_) => f64::NAN,
                None => self.error_of(&model, &answer, &exact),
            };
            let bare = Keep { impacts: false, ..keep };
            points.push(point(method, setting, error, &statistics, median(|| run(&bare).statistics.cpu_s)));
            Ok(())
        };
        for tolerance in tolerances() {
            of(DORMAND_PRINCE, Setting::Tolerance(tolerance), &|keep| {
                dormand_prince(&model, tolerance, keep)
            })?;
        }
        (task.tick)();
        for scheme in Scheme::ALL {
            for half_decades in 0..8 {
                let step = 10_f64.powf(-0.5 * f64::from(half_decades)) / 60.0;
                of(scheme.name(), Setting::Step(step), &|keep| fixed_step(&model, scheme, step, keep))?;
            }
            (task.tick)();
        }
        Ok(points)
    }

    fn error_of(&self, model: &Model, found: &Answer, exact: &Answer) -> f64 {
        let rms = (found.rms / exact.rms - 1.0).abs();
        match self.measure {
            Error::FinalDisplacement(length) => (found.final_x - exact.final_x).abs() / length,
            Error::ImpactsAndRms => {
                let period = model.forcing_period().unwrap_or(model.duration());
                let hard = exact.impacts.iter().filter(|impact| impact.v_in.abs() > HARD);
                let late = hard.map(|impact| nearest(&found.impacts, impact) / period).fold(0.0, f64::max);
                if rms.is_nan() { rms } else { late.max(rms) }
            }
        }
    }
}

/// Time in s from an impact to the nearest of `impacts`, ascending in time, on the same stop; infinite
/// without any.
fn nearest(impacts: &[Event], impact: &Event) -> f64 {
    let after = impacts.partition_point(|event| event.t < impact.t);
    let same = |event: &&Event| event.side == impact.side;
    let before = impacts[..after].iter().rfind(same);
    let after = impacts[after..].iter().find(same);
    before.into_iter().chain(after).map(|event| (event.t - impact.t).abs()).fold(f64::INFINITY, f64::min)
}

fn tolerances() -> impl Iterator<Item = f64> {
    // as written: a power of ten by multiplication is off by an ulp
    [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14].into_iter()
}

/// The median of measured times.
pub(super) fn median(mut measure: impl FnMut() -> f64) -> f64 {
    let mut times = vec![measure()];
    while times.len() < MOST_REPEATS && times.iter().sum::<f64>() < MEASURED_FOR {
        times.push(measure());
    }
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
