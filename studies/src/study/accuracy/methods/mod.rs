//! Four common methods, on any scene, for comparison with the program's own.
//!
//! They serve this comparison alone. Of a request they take sample times, events, of which they keep impacts,
//! and cancellation. Fixed steps *clamp and bounce*, as in games and small teaching applets:
//! a step that ends beyond a stop is put onto it and its velocity reversed. Contact is then seen up to a step
//! late, so that the times of impacts are first order in the step whatever the scheme.

mod dormand_prince;
mod fixed;
mod tally;

use std::sync::atomic::Ordering;

pub use dormand_prince::dormand_prince;
pub use fixed::fixed_step;

use crate::dynamics::{Event, EventKind, Request, Run, Sample, Summary};

/// A scheme of fixed step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Semi-implicit (symplectic) Euler: velocity first, then displacement by the new velocity. First order.
    SemiImplicitEuler,
    /// Velocity Verlet; where the force depends on the velocity, its new value is predicted by an Euler step.
    /// Second order.
    VelocityVerlet,
    /// The classical method of Runge and Kutta (Kutta 1901). Fourth order between impacts.
    RungeKutta4,
}

impl Scheme {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::SemiImplicitEuler, Self::VelocityVerlet, Self::RungeKutta4];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::SemiImplicitEuler => "semi-implicit Euler",
            Self::VelocityVerlet => "velocity Verlet",
            Self::RungeKutta4 => "RK4",
        }
    }
}

/// Statistics of a run by one of these methods or by the program. SI.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Statistics {
    /// Displacement at the end in m.
    pub final_x: f64,
    /// RMS velocity from the begin of the settled window to the end in m/s, by trapezoids over fixed steps
    /// and by Gauss's rule over the continuous extension of adaptive ones; `None` if the run ended before it.
    pub rms_velocity: Option<f64>,
    /// Impacts over the whole run.
    pub impacts: u64,
    /// Crossings of the barrier over the whole run, as seen from step to step.
    pub crossings: u64,
    /// Accepted steps.
    pub steps: u64,
    /// Evaluations of the force; of the program Taylor expansions.
    pub evaluations: u64,
    /// CPU time in s.
    pub cpu_s: f64,
    /// Time in s at which the run ended early (it left the force curve, a number was not finite, it was
    /// cancelled); `None` if it did not.
    pub ended_at: Option<f64>,
}

fn is_cancelled(request: &Request) -> bool {
    request.cancel.is_some_and(|flag| flag.load(Ordering::Relaxed))
}

/// What a run by one of these methods returns.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MethodRun {
    /// The state at the requested times up to the end, on a straight line between steps.
    pub samples: Vec<Sample>,
    /// Impacts in order of time, where they were asked for.
    pub impacts: Vec<Event>,
    /// The numbers of the run.
    pub statistics: Statistics,
}

impl From<&Summary> for Statistics {
    /// The numbers of a run of the program.
    fn from(summary: &Summary) -> Self {
        Self {
            final_x: summary.final_x,
            rms_velocity: summary.rms_velocity,
            impacts: summary.total_impacts,
            crossings: summary.total_crossings,
            steps: summary.steps,
            evaluations: summary.evaluations,
            cpu_s: summary.cpu_s,
            ended_at: summary.outcome.ended_at(),
        }
    }
}

impl From<Run> for MethodRun {
    /// A run of the program in the same terms.
    fn from(run: Run) -> Self {
        Self {
            statistics: Statistics::from(&run.summary),
            samples: run.samples,
            impacts: run.events.into_iter().filter(|event| event.kind == EventKind::Impact).collect(),
        }
    }
}
