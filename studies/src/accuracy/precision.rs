//! Work against precision: three problems, each run by every method at several settings.

use super::Stopped;
use super::measure::REFERENCE_TOLERANCE;
use super::methods::{MethodRun, Scheme, Statistics, dormand_prince, fixed_step};
use super::setup::Setup;
use crate::dynamics::{Event, Model, Request};
use crate::numeric::elementary;
use crate::study::Task;

/// The name of the program's own method.
pub const OWN: &str = "Taylor series";

/// Impacts faster than this in m/s count for the error.
const HARD: f64 = 1e-2;

/// Time in s for which a run is repeated to measure its CPU time.
pub(super) const MEASURED_FOR: f64 = 0.02;
const MAX_REPEATS: usize = 25;

/// Progress reports of a problem: the reference, the program's method, Dormand-Prince and each scheme.
pub(super) const PARTS: usize = 3 + Scheme::ALL.len();

/// A problem on which methods are compared.
#[derive(Debug, Clone, Copy)]
pub struct Problem {
    /// The word that selects it.
    pub name: &'static str,
    /// What is run, in a few words for a heading.
    pub heading: &'static str,
    preset: &'static str,
    changes: &'static [&'static str],
    /// The length in m over which the error of the final displacement is given; without one the error is the
    /// worst of the times of the impacts above 1 cm/s, in forcing periods, and the relative error of the RMS
    /// velocity.
    length: Option<f64>,
}

/// The three problems.
pub const PROBLEMS: &[Problem] = &[
    Problem {
        name: "p1",
        heading: "cubic well, no stops (p1)",
        preset: "nominal-cubic",
        changes: &["stops=None", "excitation.amplitude_g=1.1"],
        length: Some(7e-3),
    },
    Problem {
        name: "p2",
        heading: "cubic well, stops (p2)",
        preset: "nominal-cubic",
        changes: &[],
        length: None,
    },
    Problem { name: "flexures", heading: "flexures, stops", preset: "paper", changes: &[], length: None },
];

/// One run of one method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Name of the problem.
    pub problem: &'static str,
    /// Name of the method.
    pub method: &'static str,
    /// Local error allowed, relative to the scene's scales; `None` for a fixed step.
    pub tolerance: Option<f64>,
    /// Fixed step in s.
    pub step: Option<f64>,
    /// Error, as the problem defines it.
    pub error: f64,
    /// Its numbers; the CPU time is the median of a few runs that keep statistics alone.
    pub statistics: Statistics,
}

impl Problem {
    /// Tolerances 1e-3 to 1e-14 for the adaptive methods, steps of 1/60 s down to 5 us for the others.
    pub(super) fn measure(&self, task: &Task) -> Result<Vec<Point>, Stopped> {
        let model = Setup::preset(self.preset, self.changes)?.model()?;
        let request = Request { events: true, cancel: Some(task.cancel), ..Request::default() };
        let exact = MethodRun::from(model.run_reference(&request, REFERENCE_TOLERANCE));
        (task.tick)();
        let bare = Request { events: false, ..request };
        let mut points = Vec::new();
        // as written: a power of ten by multiplication is off by an ulp
        let tolerances = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14];
        let steps: [f64; 8] = std::array::from_fn(|i| elementary::powf(10.0, -0.5 * i as f64) / 60.0);
        let mut measure = |method, is_adaptive: bool, run: &dyn Fn(f64, &Request) -> MethodRun| {
            for value in if is_adaptive { &tolerances[..] } else { &steps }.iter().copied() {
                let found = run(value, &request);
                if task.is_cancelled() {
                    return Err(Stopped::Cancelled);
                }
                let cpu_s = median(|| run(value, &bare).statistics.cpu_s);
                points.push(Point {
                    problem: self.name,
                    method,
                    tolerance: is_adaptive.then_some(value),
                    step: (!is_adaptive).then_some(value),
                    error: self.error_of(&model, &found, &exact),
                    statistics: Statistics { cpu_s, ..found.statistics },
                });
            }
            (task.tick)();
            Ok(())
        };
        measure(OWN, true, &|tolerance, request| model.with_tolerance(tolerance).run(request).into())?;
        measure("Dormand-Prince 5(4)", true, &|tolerance, request| {
            dormand_prince(&model, tolerance, request)
        })?;
        for scheme in Scheme::ALL {
            measure(scheme.name(), false, &|step, request| fixed_step(&model, scheme, step, request))?;
        }
        Ok(points)
    }

    /// The error of a run; NaN if it ended early.
    fn error_of(&self, model: &Model, found: &MethodRun, exact: &MethodRun) -> f64 {
        let (statistics, exactly) = (&found.statistics, &exact.statistics);
        let Some(rms) = statistics.rms_velocity.filter(|_| statistics.ended_at.is_none()) else {
            return f64::NAN;
        };
        if let Some(length) = self.length {
            return (statistics.final_x - exactly.final_x).abs() / length;
        }
        let rms = (rms / exactly.rms_velocity.unwrap_or(f64::NAN) - 1.0).abs();
        let period = model.forcing_period().unwrap_or(model.duration());
        let hard = exact.impacts.iter().filter(|impact| impact.v_in.abs() > HARD);
        let late = hard.map(|impact| nearest(&found.impacts, impact) / period).fold(0.0, f64::max);
        if rms.is_nan() { rms } else { late.max(rms) }
    }
}

/// Time in s from an impact to the nearest of `impacts`, ascending, on the same stop; infinite without any.
fn nearest(impacts: &[Event], impact: &Event) -> f64 {
    let after = impacts.partition_point(|event| event.t < impact.t);
    let same = |event: &&Event| event.side == impact.side;
    let before = impacts[..after].iter().rfind(same);
    let after = impacts[after..].iter().find(same);
    before.into_iter().chain(after).map(|event| (event.t - impact.t).abs()).fold(f64::INFINITY, f64::min)
}

pub(super) fn median(mut measure: impl FnMut() -> f64) -> f64 {
    let mut times = vec![measure()];
    while times.len() < MAX_REPEATS && times.iter().sum::<f64>() < MEASURED_FOR {
        times.push(measure());
    }
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
