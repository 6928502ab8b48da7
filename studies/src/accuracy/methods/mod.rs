//! Four common methods, on any scene, for comparison with the program's own.
//!
//! Of a request they use the sample times, the events (they keep impacts) and the cancellation. Fixed steps
//! *clamp and bounce*, as in games and small teaching applets: a step that ends beyond a stop is put onto it
//! and its velocity reversed. A contact is then found up to a step late, so that the times of impacts are of
//! first order in the step with every scheme.

mod dormand_prince;
mod fixed;

use std::f64::consts::TAU;
use std::sync::atomic::Ordering;

use serde::{Deserialize, Serialize};

pub use dormand_prince::dormand_prince;
pub use fixed::fixed_step;

use crate::dynamics::{Event, EventKind, Model, Request, Run, Side, Summary};
use crate::numeric::elementary;
use crate::system::clock::ThreadClock;

words! {
    /// A scheme of fixed step.
    Scheme {
        /// Semi-implicit (symplectic) Euler: velocity first, then displacement by it. First order.
        SemiImplicitEuler = "semi-implicit Euler",
        /// Velocity Verlet; where the force depends on the velocity, its new value is predicted by an Euler
        /// step. Second order.
        VelocityVerlet = "velocity Verlet",
        /// The classical method of Runge and Kutta (Kutta 1901). Fourth order between impacts.
        RungeKutta4 = "RK4",
    }
}

impl Scheme {
    /// Its word on a command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::SemiImplicitEuler => "euler",
            Self::VelocityVerlet => "verlet",
            Self::RungeKutta4 => "rk4",
        }
    }
}

/// Statistics of a run by one of these methods or by the program. SI.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
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

/// The result of a run by one of these methods.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MethodRun {
    /// Time in s and displacement in m at the requested times up to the end, on straight lines between steps.
    pub path: Vec<(f64, f64)>,
    /// Impacts in order of time, where they were asked for.
    pub impacts: Vec<Event>,
    /// The numbers of the run.
    pub statistics: Statistics,
}

impl From<&Summary> for Statistics {
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
    fn from(run: Run) -> Self {
        Self {
            statistics: Statistics::from(&run.summary),
            path: path(&run),
            impacts: run.events.into_iter().filter(|event| event.kind == EventKind::Impact).collect(),
        }
    }
}

/// Times in s and displacements in m of the samples of a run.
pub(super) fn path(run: &Run) -> Vec<(f64, f64)> {
    run.samples.iter().map(|sample| (sample.t, sample.x)).collect()
}

/// The equation of motion of a model, evaluated directly: library sines, force curve, no series.
#[derive(Clone, Copy)]
struct Problem<'a> {
    pub model: &'a Model,
    /// Left and right stop: position in m and restitution; at infinity if there is none.
    pub stops: [(f64, f64); 2],
    pub start: TimedState,
    domain: (f64, f64),
    single: Option<&'a [f64]>,
}

impl<'a> Problem<'a> {
    pub fn new(model: &'a Model) -> Self {
        let at =
            |side: Side, open: f64| model.stop(side).map_or((open, 1.0), |stop| (stop.x, stop.restitution));
        let (x, v) = model.start();
        let curve = &model.mechanism().curve;
        Self {
            model,
            stops: [at(Side::Left, f64::NEG_INFINITY), at(Side::Right, f64::INFINITY)],
            start: TimedState { t: 0.0, x, v },
            domain: curve.domain(),
            single: match curve.pieces() {
                [piece] if piece.origin == 0.0 => Some(&piece.coefficients),
                _ => None,
            },
        }
    }

    /// Position in m and restitution of a stop; at infinity if there is none.
    pub fn stop(&self, side: Side) -> (f64, f64) {
        self.stops[usize::from(side == Side::Right)]
    }

    /// Base acceleration in m/s^2 at `t` in s.
    pub fn base(&self, t: f64) -> f64 {
        let drive = &self.model.excitation();
        let mut sum = drive.constant;
        for tone in &drive.tones {
            let turns = tone.frequency * t + tone.phase;
            let amplitude = match tone.ramp {
                Some((from, over)) if t < over => from + (tone.amplitude - from) * t / over,
                _ => tone.amplitude,
            };
            let angle = TAU * turns;
            sum += amplitude * if tone.quarter { elementary::cos(angle) } else { elementary::sin(angle) };
        }
        for chirp in &drive.chirps {
            let turns = if t < chirp.over {
                chirp.from * t + (chirp.to - chirp.from) * t * t / (2.0 * chirp.over)
            } else {
                0.5 * (chirp.from + chirp.to) * chirp.over + chirp.to * (t - chirp.over)
            };
            sum += chirp.amplitude * elementary::sin(TAU * turns);
        }
        for record in &drive.records {
            let after = record.times.partition_point(|at| *at <= t);
            if after > 0 && after < record.times.len() {
                let (t0, t1) = (record.times[after - 1], record.times[after]);
                let (a0, a1) = (record.accelerations[after - 1], record.accelerations[after]);
                sum += a0 + (a1 - a0) * (t - t0) / (t1 - t0);
            }
        }
        sum
    }

    /// Acceleration in m/s^2 at t, x, v in SI.
    pub fn acceleration(&self, t: f64, x: f64, v: f64) -> f64 {
        let force = match self.single {
            Some(coefficients) => coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c),
            // a stage may lie beyond the end of the curve, where a run ends
            None => self.model.mechanism().curve.force(x.clamp(self.domain.0, self.domain.1)),
        };
        -(force + self.model.total_damping() * v) / self.model.mass() - self.base(t)
    }

    /// Whether the run may continue from here.
    pub fn is_inside(&self, x: f64, v: f64) -> bool {
        x >= self.domain.0 && x <= self.domain.1 && v.is_finite()
    }
}

/// Time, displacement and velocity in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TimedState {
    pub t: f64,
    pub x: f64,
    pub v: f64,
}

/// Collects path, impacts and sums from one step to the next.
struct Tally<'a> {
    problem: Problem<'a>,
    request: &'a Request<'a>,
    watch: ThreadClock,
    pub run: MethodRun,
    squares: f64,
    is_beyond_barrier: bool,
}

impl<'a> Tally<'a> {
    pub fn new(problem: Problem<'a>, request: &'a Request<'a>) -> Self {
        let barrier = problem.model.crossing_level();
        Self {
            problem,
            request,
            watch: ThreadClock::start(),
            run: MethodRun::default(),
            squares: 0.0,
            is_beyond_barrier: barrier.is_some_and(|top| problem.start.x > top),
        }
    }

    /// Records a step from `a` to `b`; `squares` is the integral of v^2 over it.
    pub fn step(&mut self, a: TimedState, b: TimedState, squares: f64) {
        self.run.statistics.steps += 1;
        let h = b.t - a.t;
        while let Some(t) = self.next_time().filter(|t| *t < b.t) {
            let share = if h > 0.0 { (t - a.t) / h } else { 0.0 };
            self.run.path.push((t, a.x + share * (b.x - a.x)));
        }
        let inside = (b.t - self.problem.model.settle().max(a.t)).max(0.0);
        if inside > 0.0 {
            // a step across the begin of the window counts in part
            self.squares += squares * if inside < h { inside / h } else { 1.0 };
        }
        if let Some(top) = self.problem.model.crossing_level()
            && (b.x > top) != self.is_beyond_barrier
            && b.x != top
        {
            self.is_beyond_barrier = !self.is_beyond_barrier;
            self.run.statistics.crossings += 1;
        }
    }

    fn next_time(&self) -> Option<f64> {
        self.request.sample_times.get(self.run.path.len()).copied()
    }

    /// Records an impact on the stop of `side`.
    pub fn impact(&mut self, t: f64, side: Side, v_in: f64, v_out: f64) {
        self.run.statistics.impacts += u64::from(v_in.abs() > self.problem.model.min_impact_speed());
        if self.request.events {
            self.run.impacts.push(Event { t, kind: EventKind::Impact, side, v_in, v_out });
        }
    }

    /// The finished run, which ends in the state `last`.
    pub fn finish(mut self, last: TimedState) -> MethodRun {
        while let Some(t) = self.next_time().filter(|t| *t <= last.t) {
            self.run.path.push((t, last.x));
        }
        let model = self.problem.model;
        let window = last.t - model.settle();
        let statistics = &mut self.run.statistics;
        statistics.final_x = last.x;
        statistics.ended_at = (last.t < model.duration()).then_some(last.t);
        statistics.rms_velocity = (window > 0.0).then(|| (self.squares / window).sqrt());
        statistics.cpu_s = self.watch.seconds();
        self.run
    }
}
