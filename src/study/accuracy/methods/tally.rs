//! Events, samples and statistics of a run by another method.

use super::problem::Problem;
use super::{Keep, MethodRun};
use crate::dynamics::{Event, EventKind, Phase, Sample, Side};

/// Time, displacement and velocity in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TimedState {
    pub t: f64,
    pub x: f64,
    pub v: f64,
}

/// Collects samples, impacts and sums from one step to the next.
pub(super) struct Tally<'a> {
    keep: &'a Keep<'a>,
    run: MethodRun,
    next: usize,
    squares: f64,
    settle: f64,
    barrier: Option<f64>,
    side: bool,
    /// The speed in m/s above which an impact counts.
    least_speed: f64,
}

impl<'a> Tally<'a> {
    pub fn new(problem: &Problem, keep: &'a Keep<'a>) -> Self {
        let barrier = problem.model.crossing_level();
        Self {
            keep,
            least_speed: problem.model.least_impact_speed(),
            run: MethodRun::default(),
            next: 0,
            squares: 0.0,
            settle: problem.model.settle(),
            barrier,
            side: barrier.is_some_and(|top| problem.start.0 > top),
        }
    }

    /// Records a step from `a` to `b`; `phase` is that of the mass in it, `squares` the integral of v^2
    /// over it.
    pub fn step(&mut self, problem: &Problem, a: TimedState, b: TimedState, phase: Phase, squares: f64) {
        let h = b.t - a.t;
        while let Some(t) = self.keep.sample_times.get(self.next).copied().filter(|t| *t < b.t) {
            let share = if h > 0.0 { (t - a.t) / h } else { 0.0 };
            self.sample(problem, t, a.x + share * (b.x - a.x), a.v + share * (b.v - a.v), phase);
        }
        let inside = (b.t - self.settle.max(a.t)).max(0.0);
        if inside > 0.0 {
            // a step across the begin of the window counts in part
            self.squares += squares * if inside < h { inside / h } else { 1.0 };
            self.run.statistics.max_abs_x = self.run.statistics.max_abs_x.max(a.x.abs()).max(b.x.abs());
        }
        if let Some(top) = self.barrier
            && (b.x > top) != self.side
            && b.x != top
        {
            self.side = !self.side;
            self.run.statistics.crossings += 1;
        }
    }

    fn sample(&mut self, problem: &Problem, t: f64, x: f64, v: f64, phase: Phase) {
        self.run.samples.push(Sample { t, x, v, base_accel: problem.base(t), phase, electrical: 0.0 });
        self.next += 1;
    }

    /// Records an impact on the stop of `side`.
    pub fn impact(&mut self, t: f64, side: Side, v_in: f64, v_out: f64) {
        self.run.statistics.impacts += u64::from(v_in.abs() > self.least_speed);
        if self.keep.impacts {
            self.run.impacts.push(Event { t, kind: EventKind::Impact, side, v_in, v_out });
        }
    }

    /// The finished run, which ends in the state `last`.
    pub fn finish(
        mut self,
        problem: &Problem,
        last: TimedState,
        phase: Phase,
        counts: (u64, u64),
    ) -> MethodRun {
        let duration = problem.model.duration();
        let ended = last.t < duration;
        while let Some(t) = self.keep.sample_times.get(self.next).copied().filter(|t| *t <= last.t) {
            self.sample(problem, t, last.x, last.v, phase);
        }
        let statistics = &mut self.run.statistics;
        (statistics.final_x, statistics.final_v) = (last.x, last.v);
        (statistics.steps, statistics.evaluations) = counts;
        statistics.ended_at = ended.then_some(last.t);
        let window = last.t - self.settle;
        statistics.rms_velocity = (window > 0.0).then(|| (self.squares / window).sqrt());
        self.run
    }
}
