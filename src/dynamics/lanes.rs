//! Many runs at once: how do several masses fly in step, each with its own time and its own step?
//!
//! Each lane holds a motion. As long as it flies freely, what costs the time of a step (the series, the end of it,
//! the check against the equation, the drive, the integral of the squared velocity) is done for all lanes by the same
//! instructions; everything else, and every step on which something happens, is done by the motion alone, as if it had
//! no company. A lane whose run has ended takes up the next. The arithmetic is that of a motion alone, operation for
//! operation, so the result has the same bits whatever the width, the company and the processor.
//!
//! The width is that of the processor at hand, found out when it runs.

use super::clock::Instant;
use super::equation::{Equation, PieceForce};
use super::glide::Glide;
use super::model::{Model, Request};
use super::motion::{Begun, Contact, Motion, Step};
use super::prepare::{Form, clock, form};
use super::result::{Outcome, Run};
use super::series::{SEEDED, Series, State, natural_steps};
use super::taylor;
use super::tone::{Sine, Swing};
use crate::numeric::{GaussLegendre, Lanes, Number, Scalar};

/// One motion under a sine, without a ledger.
type Flight<'a> = Motion<'a, f64, Sine<f64>, false>;

/// A run and what it is made of.
struct Prepared<'a> {
    model: &'a Model,
    equation: Equation<f64>,
    drive: Sine<f64>,
    place: usize,
}

/// Runs several models, as [`Model::run`] does, with nothing listed; the results in their order.
///
/// Those that cannot share their steps with others are run alone.
pub(crate) fn run_all(models: &[Model], request: &Request) -> Vec<Run> {
    let mut runs: Vec<Option<Run>> = models.iter().map(|_| None).collect();
    let mut together = Vec::new();
    for (place, model) in models.iter().enumerate() {
        let unit = model.scales.unit();
        match form(model, &clock(model, unit)) {
            Form::Sine(drive) if model.compliant.is_none() && !model.motionless => {
                together.push(Prepared { model, equation: Equation::new(model, unit), drive, place });
            }
            _ => runs[place] = Some(model.run(request)),
        }
    }
    // Motions of one order share their steps; tolerances differ only where a sweep is over them.
    together.sort_by(|a, b| b.model.tolerance.total_cmp(&a.model.tolerance));
    for alike in together.chunk_by(|a, b| a.model.tolerance == b.model.tolerance) {
        let watch = cpu_time::ThreadTime::now();
        fly_together(alike, request, &mut runs);
        let share = watch.elapsed().as_secs_f64() / alike.len() as f64;
        for own in alike {
            if let Some(run) = &mut runs[own.place] {
                run.summary.cpu_s = share;
            }
        }
    }
    runs.into_iter().zip(models).map(|(run, model)| run.unwrap_or_else(|| model.run(request))).collect()
}

/// Runs models of one tolerance in as many lanes as the processor has.
fn fly_together(prepared: &[Prepared], request: &Request, runs: &mut [Option<Run>]) {
    if prepared.len() == 1 {
        return; // alone
    }
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if let Some(wide) = pulp::x86::V4::try_new() {
            return wide.vectorize(
                #[inline(always)]
                || Bundle::<8>::new(prepared, request, runs).run(),
            );
        }
        if let Some(wide) = pulp::x86::V3::try_new() {
            return wide.vectorize(
                #[inline(always)]
                || Bundle::<8>::new(prepared, request, runs).run(),
            );
        }
    }
    Bundle::<4>::new(prepared, request, runs).run();
}

/// A lane: a motion, and what it began as.
struct Lane<'a> {
    index: usize,
    motion: Box<Flight<'a>>,
    begun: Begun<f64>,
    /// Time to the end of its run.
    left: f64,
}

/// What the lanes have in common while they last, in columns.
struct Columns<const W: usize> {
    force: PieceForce<Lanes<W>>,
    origin: Lanes<W>,
    damping: Lanes<W>,
    curvature: Lanes<W>,
    amplitude: Lanes<W>,
    frequency: [f64; W],
    turn: [f64; W],
    quarter: [bool; W],
    speed_log2: [f64; W],
    longest: [f64; W],
    allowed: [f64; W],
    /// Which run and which arena each column is of.
    of: [(usize, usize); W],
}

struct Bundle<'a, 'r, const W: usize> {
    prepared: &'a [Prepared<'a>],
    request: &'a Request<'a>,
    runs: &'r mut [Option<Run>],
    next: usize,
    lanes: [Option<Lane<'a>>; W],
    series: Box<Series<Lanes<W>>>,
    columns: Columns<W>,
    rule: GaussLegendre<Lanes<W>>,
    order: usize,
    tolerance_log2: f64,
}

impl<'a, 'r, const W: usize> Bundle<'a, 'r, W> {
    fn new(prepared: &'a [Prepared<'a>], request: &'a Request<'a>, runs: &'r mut [Option<Run>]) -> Self {
        let zero = Lanes([0.0; W]);
        let columns = Columns {
            force: PieceForce::new(vec![zero], false),
            origin: zero,
            damping: zero,
            curvature: zero,
            amplitude: zero,
            frequency: [0.0; W],
            turn: [0.0; W],
            quarter: [false; W],
            speed_log2: [0.0; W],
            longest: [1.0; W],
            allowed: [0.0; W],
            of: [(usize::MAX, 0); W],
        };
        let mut bundle = Self {
            prepared,
            request,
            runs,
            next: 0,
            lanes: [const { None }; W],
            series: Box::new(Series::new()),
            columns,
            rule: GaussLegendre::<f64>::new(1).map(|value| Lanes([value; W])),
            order: 0,
            tolerance_log2: 0.0,
        };
        for lane in 0..W {
            bundle.take_up(lane);
        }
        if let Some(first) = bundle.lanes.iter().flatten().next() {
            let settings = &first.motion.settings;
            (bundle.order, bundle.tolerance_log2) = (settings.order, settings.tolerance_log2);
            let rule = first.motion.record.rule_of_steps();
            bundle.rule = rule.map(|value| Lanes([value; W]));
        }
        bundle
    }

    /// Puts the next run into a lane.
    fn take_up(&mut self, lane: usize) {
        self.lanes[lane] = self.prepared.get(self.next).map(|own| {
            let clock = clock(own.model, own.equation.unit);
            let (model, request) = (own.model, self.request);
            let motion = Motion::new(model, request, model.tolerance, &own.equation, clock, &own.drive);
            let mut motion = Box::new(motion.with_recurrence(model.recurrence, model));
            let begun = motion.begin(model);
            Lane { index: self.next, motion, begun, left: 0.0 }
        });
        self.next += 1;
    }

    /// Ends the run of a lane and takes up the next.
    fn end(&mut self, lane: usize, outcome: Outcome) {
        if let Some(Lane { index, motion, begun, .. }) = self.lanes[lane].take() {
            let own = &self.prepared[index];
            self.runs[own.place] = Some(motion.finish(own.model, &begun, outcome));
        }
        self.take_up(lane);
    }

    #[inline(always)]
    fn run(mut self) {
        loop {
            let (mut flying, mut shape) = (false, None);
            for lane in 0..W {
                flying |= self.bring_to_flight(lane, &mut shape);
            }
            if !flying {
                return;
            }
            self.fly();
        }
    }

    /// Goes on with a lane by itself until it flies freely, under a force of the shape that the others have; false where
    /// there is nothing more to run.
    #[inline(always)]
    fn bring_to_flight(&mut self, lane: usize, shape: &mut Option<(usize, bool)>) -> bool {
        loop {
            let Some(own) = &mut self.lanes[lane] else { return false };
            let left = match own.motion.left() {
                Ok(left) => left,
                Err(outcome) => {
                    self.end(lane, outcome);
                    continue;
                }
            };
            let motion = &mut own.motion;
            if motion.contact == Contact::Free && motion.touch.is_none() {
                let force = &motion.equation.arenas[motion.arena].force;
                let own_shape = (force.coefficients().len(), force.is_odd());
                if *shape.get_or_insert(own_shape) == own_shape {
                    own.left = left;
                    self.fill(lane, own_shape);
                    return true;
                }
            }
            if let Some(outcome) = motion.proceed(left).or_else(|| motion.spent()) {
                self.end(lane, outcome);
            }
        }
    }

    /// Fills the columns of a lane.
    #[inline(always)]
    fn fill(&mut self, lane: usize, (count, odd): (usize, bool)) {
        let Some(Lane { index, motion, .. }) = &self.lanes[lane] else { return };
        let arena = &motion.equation.arenas[motion.arena];
        let columns = &mut self.columns;
        if columns.force.coefficients().len() != count || columns.force.is_odd() != odd {
            columns.force = PieceForce::new(vec![Lanes([0.0; W]); count], odd);
            columns.of = [(usize::MAX, 0); W];
        }
        if columns.of[lane] != (*index, motion.arena) {
            columns.of[lane] = (*index, motion.arena);
            for (degree, own) in arena.force.coefficients().iter().enumerate() {
                columns.force.coefficient_mut(degree).0[lane] = *own;
            }
            let tone = &motion.drive.tone;
            let settings = &motion.settings;
            columns.origin.0[lane] = arena.origin;
            columns.damping.0[lane] = motion.equation.damping;
            columns.curvature.0[lane] = tone.curvature();
            columns.amplitude.0[lane] = tone.amplitude;
            columns.frequency[lane] = tone.frequency;
            columns.turn[lane] = tone.phase;
            columns.quarter[lane] = tone.quarter;
            columns.speed_log2[lane] = settings.speed_log2;
            columns.longest[lane] = settings.longest;
            columns.allowed[lane] = settings.residual_of_a_full_step();
        }
    }

    /// One step of every lane that flies.
    #[allow(clippy::needless_range_loop)] // a lane is a place in every column
    #[inline(always)]
    fn fly(&mut self) {
        let zero = Lanes([0.0; W]);
        let (mut x, mut v, mut value, mut slope, mut left) = (zero, zero, zero, zero, zero);
        for lane in 0..W {
            let Some(Lane { motion, left: own, .. }) = &self.lanes[lane] else { continue };
            (x.0[lane], v.0[lane]) = (motion.x, motion.v);
            (value.0[lane], slope.0[lane]) = motion.drive.looked(&motion.at, &motion.roll);
            left.0[lane] = *own;
        }
        let Self { series, columns, order, tolerance_log2, lanes, rule, .. } = self;
        let order = *order;
        let swing = Swing { curvature: columns.curvature };
        swing.seed(columns.amplitude * value, columns.amplitude * slope, &mut series.a);
        series.begin(x - columns.origin, v);
        series.extend_to(order, &columns.force, columns.damping, &swing, &mut ());

        // How far, and where that leads in time.
        let y = &series.y;
        let steps = natural_steps(order, |k| y[k].0, &columns.speed_log2, *tolerance_log2, &columns.longest);
        let mut h = Lanes(steps);
        let mut arrives = [false; W];
        let mut ends = [Instant { cycle: 0, phase: 0.0 }; W];
        let mut inside = [None; W];
        let mut measured = false;
        for lane in 0..W {
            let Some(Lane { motion, .. }) = &lanes[lane] else { continue };
            if left.0[lane] <= h.0[lane] {
                h.0[lane] = left.0[lane];
                arrives[lane] = true;
            }
            ends[lane] = motion.clock.advance(&motion.at, h.0[lane]);
            inside[lane] = motion.record.wholly_inside(&motion.at, h.0[lane]);
            measured |= inside[lane] == Some(true);
        }

        // The end of the step, and whether it holds.
        let State { y: end_y, v: end_v, acceleration, bound } = series.state(h);
        let (mut value, mut slope) = (zero, zero);
        for lane in 0..W {
            let turns = ends[lane].phase * columns.frequency[lane] + columns.turn[lane];
            let (s, c) = f64::sin_cos_turns(turns);
            let omega = std::f64::consts::TAU * columns.frequency[lane];
            value.0[lane] = if columns.quarter[lane] { c } else { s };
            slope.0[lane] = if columns.quarter[lane] { -(s * omega) } else { c * omega };
        }
        let base = columns.amplitude * value;
        let sum = (acceleration + columns.damping * end_v) + base;
        let residual = (columns.force.at(end_y) + sum).abs() * h;
        let squared = if measured {
            taylor::integrals::<_, false>(&series.y[..=order], &[], rule, zero, h).0
        } else {
            zero
        };

        let mut ended = [None; W];
        for lane in 0..W {
            let Some(Lane { motion, left, .. }) = &mut lanes[lane] else { continue };
            let flow = if !(residual.0[lane] <= columns.allowed[lane]) || !(h.0[lane] > 0.0) {
                motion.fly(*left)
            } else {
                motion.evaluations += 1;
                motion.roll = Some((ends[lane], (value.0[lane], slope.0[lane])));
                let arena = &motion.equation.arenas[motion.arena];
                let state = State {
                    y: end_y.0[lane],
                    v: end_v.0[lane],
                    acceleration: acceleration.0[lane],
                    bound: bound.0[lane],
                };
                let start = series.y[0].0[lane] + arena.origin;
                let glide = Glide {
                    at: motion.at,
                    length: h.0[lane],
                    start,
                    end: state.y + arena.origin,
                    bound: state.bound,
                    limits: (arena.low, arena.high),
                    inside: inside[lane],
                    squared: squared.0[lane],
                };
                let clear = (motion.x - arena.low > state.bound) & (arena.high - motion.x > state.bound);
                let arrival = if arrives[lane] { motion.end } else { ends[lane] };
                if clear && state.v.is_finite() && motion.record.glide(&glide) {
                    motion.steps += 1;
                    motion.at = arrival;
                    motion.x = glide.end;
                    motion.v = state.v;
                    motion.turned_back = false;
                    None
                } else {
                    let alone = &mut motion.series;
                    for k in 0..=order {
                        alone.y[k] = series.y[k].0[lane];
                    }
                    for k in 0..(order - 1).max(SEEDED) {
                        alone.a[k] = series.a[k].0[lane];
                    }
                    alone.known = order + 1;
                    let arrival = arrives[lane].then_some(motion.end);
                    motion.take(&Step { length: h.0[lane], arrival, end: state })
                }
            };
            ended[lane] = flow.or_else(|| motion.spent());
        }
        for (lane, outcome) in ended.into_iter().enumerate() {
            if let Some(outcome) = outcome {
                self.end(lane, outcome);
            }
        }
    }
}
