//! Many runs at once: how do several masses fly in step, each with its own time and its own step?
//!
//! Each lane holds a motion. As long as it flies freely, all that its steps need (the series, how far it holds, where
//! it leads, the check against the equation, clock and drive, the sums and extremes of the settled window) lies in
//! columns and is done for all lanes by the same instructions. A step on which something may happen (a surface or the
//! top near by, a turning point that may be an extreme, a border of the window, a strobe) is not taken there: the lane
//! lands, its motion does that step as if it had no company, and flies on. A lane whose run has ended takes up the next.
//! The arithmetic is that of a motion alone, operation for operation, so the result has the same bits whatever the
//! width, the company and the processor.
//!
//! The width is that of the processor at hand, found out when it runs.

mod columns;

use super::equation::Equation;
use super::model::{Model, Request};
use super::motion::{Begun, Contact, Motion, Step};
use super::path::StepView;
use super::prepare::{Form, clock, form};
use super::result::{Outcome, Run};
use super::series::{SEEDED, Series};
use super::tone::Sine;
use crate::numeric::{GaussLegendre, Lanes, Scalar};
use columns::{Columns, Trial};

/// Lanes where registers hold eight numbers: two registers a column, so that one addition need not wait for the last.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
const WIDEST: usize = 16;

/// Steps of the company between two looks at what no step looks at: the budget, and whether the run is to go on.
const STRIDE: u64 = 256;

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
/// Those that cannot share their steps with others are run alone. No more than `most` lanes are used.
pub(crate) fn run_all(models: &[Model], request: &Request, most: usize) -> Vec<Run> {
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
        fly_together(alike, request, most, &mut runs);
        let share = watch.elapsed().as_secs_f64() / alike.len() as f64;
        for own in alike {
            if let Some(run) = &mut runs[own.place] {
                run.summary.cpu_s = share;
            }
        }
    }
    runs.into_iter().zip(models).map(|(run, model)| run.unwrap_or_else(|| model.run(request))).collect()
}

/// Whether the processor at hand has so many lanes.
pub(crate) fn has_lanes(width: usize) -> bool {
    match width {
        4 => true,
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        8 => pulp::x86::V3::is_available(),
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        WIDEST => pulp::x86::V4::is_available(),
        _ => false,
    }
}

/// Runs models of one tolerance in as many lanes as the processor has, at most `most`.
fn fly_together(prepared: &[Prepared], request: &Request, most: usize, runs: &mut [Option<Run>]) {
    debug_assert!(most >= 4, "every processor has 4 lanes");
    if prepared.len() == 1 {
        return; // alone
    }
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if most >= WIDEST
            && let Some(wide) = pulp::x86::V4::try_new()
        {
            return wide.vectorize(Wide(Bundle::<WIDEST>::new(prepared, request, runs)));
        }
        if most >= 8
            && let Some(wide) = pulp::x86::V3::try_new()
        {
            return wide.vectorize(Wide(Bundle::<8>::new(prepared, request, runs)));
        }
    }
    Bundle::<4>::new(prepared, request, runs).run();
}

/// What is run by instructions that not every processor has. (A type of its own and no closure: a closure's body would
/// be compiled apart, for every processor.)
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
struct Wide<'a, 'r, const W: usize>(Bundle<'a, 'r, W>);

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
impl<const W: usize> pulp::NullaryFnOnce for Wide<'_, '_, W> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.run();
    }
}

/// A lane: a motion, and what it began as.
struct Lane<'a> {
    index: usize,
    motion: Box<Flight<'a>>,
    begun: Begun<f64>,
}

struct Bundle<'a, 'r, const W: usize> {
    prepared: &'a [Prepared<'a>],
    request: &'a Request<'a>,
    runs: &'r mut [Option<Run>],
    next: usize,
    lanes: [Option<Lane<'a>>; W],
    columns: Box<Columns<W>>,
    series: Box<Series<Lanes<W>>>,
    rule: GaussLegendre<Lanes<W>>,
    order: usize,
    tolerance_log2: f64,
}

impl<'a, 'r, const W: usize> Bundle<'a, 'r, W> {
    fn new(prepared: &'a [Prepared<'a>], request: &'a Request<'a>, runs: &'r mut [Option<Run>]) -> Self {
        let most = prepared.iter().map(|own| own.equation.most_products()).max().unwrap_or(0);
        let mut bundle = Self {
            prepared,
            request,
            runs,
            next: 0,
            lanes: [const { None }; W],
            columns: Box::new(Columns::new()),
            series: Box::new(Series::new(most)),
            rule: f64::gauss_legendre(1).map(|value| Lanes([value; W])),
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
            Lane { index: self.next, motion, begun }
        });
        self.next += 1;
    }

    /// Ends the run of a lane and takes up the next.
    fn end(&mut self, lane: usize, outcome: Outcome) {
        if let Some(Lane { index, motion, begun }) = self.lanes[lane].take() {
            let own = &self.prepared[index];
            self.runs[own.place] = Some(motion.finish(own.model, &begun, outcome));
        }
        self.take_up(lane);
    }

    #[inline(always)]
    fn run(mut self) {
        let mut rounds = 0;
        loop {
            for lane in 0..W {
                if !self.columns.flying[lane] {
                    self.bring_to_flight(lane);
                }
            }
            if !self.columns.flying.contains(&true) {
                return;
            }
            loop {
                let trial = self.columns.step(&mut self.series, &self.rule, self.order, self.tolerance_log2);
                rounds += 1;
                for lane in 0..W {
                    if trial.taken[lane] & self.columns.kept[lane] {
                        self.keep(lane, &trial);
                    }
                }
                if rounds % STRIDE == 0 {
                    self.look_round();
                    break;
                }
                if trial.landed.contains(&true) {
                    for lane in 0..W {
                        if trial.landed[lane] {
                            self.land(lane, &trial);
                        }
                    }
                    break;
                }
            }
        }
    }

    /// Goes on with a lane by itself until it flies freely, under a force of the shape that the others have, or there is
    /// nothing more to run.
    fn bring_to_flight(&mut self, lane: usize) {
        while let Some(own) = &mut self.lanes[lane] {
            let left = match own.motion.left() {
                Ok(left) => left,
                Err(outcome) => {
                    self.end(lane, outcome);
                    continue;
                }
            };
            let motion = &mut own.motion;
            if motion.contact == Contact::Free
                && motion.flies_freely()
                && motion.has_budget_for(2 * STRIDE)
                && self.columns.fill(lane, own.index, motion)
            {
                return;
            }
            if let Some(outcome) = motion.proceed(left).or_else(|| motion.spent()) {
                self.end(lane, outcome);
            }
        }
    }

    /// Gives a lane back to its motion, and takes by it the step on which something may happen.
    fn land(&mut self, lane: usize, trial: &Trial<W>) {
        let Some(own) = &mut self.lanes[lane] else { return };
        let motion = &mut own.motion;
        self.columns.land(lane, motion);
        let left = motion.clock.between(&motion.at, &motion.end);
        let flow = if trial.holds[lane] && trial.length.0[lane] < left {
            copy_lane(&self.series, lane, self.order, &mut motion.series);
            let alone = &mut motion.series;
            alone.measured = self.columns.inside[lane].then(|| (trial.length.0[lane], trial.squared.0[lane]));
            motion.evaluations += 1;
            motion.roll = Some(trial.drive_at_end(lane));
            motion.take(&Step { length: trial.length.0[lane], arrival: None, end: trial.end(lane) })
        } else {
            motion.fly(left)
        };
        if let Some(outcome) = flow.or_else(|| motion.spent()) {
            self.end(lane, outcome);
        }
    }

    /// Keeps the step that a lane has just taken.
    fn keep(&mut self, lane: usize, trial: &Trial<W>) {
        let Some(own) = &mut self.lanes[lane] else { return };
        let motion = &mut own.motion;
        copy_lane(&self.series, lane, self.order, &mut motion.series);
        let arena = &motion.equation.arenas[motion.arena];
        let (length, end) = (trial.length.0[lane], trial.end(lane));
        let view = StepView {
            path: &motion.series,
            origin: arena.origin,
            at: motion.at,
            whole: length,
            length,
            duration: length,
            bound: end.bound,
            limits: (arena.low, arena.high),
            x: end.y + arena.origin,
            v: end.v,
        };
        if let Some(log) = &mut motion.record.log {
            log.add_step(&view);
        }
        self.columns.follow(lane, motion);
        motion.mark();
        self.columns.kept[lane] = motion.record.log.is_some();
    }

    /// Looks at what is not looked at in flight: whether the run is to go on.
    fn look_round(&mut self) {
        for lane in 0..W {
            let Some(own) = &mut self.lanes[lane] else { continue };
            if !self.columns.flying[lane] {
                continue;
            }
            let motion = &mut own.motion;
            self.columns.land(lane, motion);
            if motion.work.is_cancelled() {
                let outcome = Outcome::Cancelled { at: motion.clock.seconds(&motion.at) };
                self.end(lane, outcome);
            } else if motion.has_budget_for(2 * STRIDE) {
                self.columns.fill(lane, own.index, motion);
            }
        }
    }
}

/// Makes the series of one lane that of a motion alone.
fn copy_lane<const W: usize>(all: &Series<Lanes<W>>, lane: usize, order: usize, alone: &mut Series<f64>) {
    for k in 0..=order {
        alone.y[k] = all.y[k].0[lane];
    }
    for k in 0..(order - 1).max(SEEDED) {
        alone.a[k] = all.a[k].0[lane];
    }
    alone.known = order + 1;
}
