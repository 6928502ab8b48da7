//! Batched runs: the event-free steps of several motions by the same instructions.
//!
//! Each lane holds a motion, with its own time and its own step length. As long as the steps of a lane are
//! event-free, all that they need (series, step length, end state, residual, clock and drive, sums and
//! extremes of the settled window) lies in columns and is computed for all lanes by the same instructions. A
//! step on which an event is possible (a surface or the barrier near by, a turning point that may be an
//! extreme, a border of the window, a stroboscopic state) is not taken there: the lane is stored back to its
//! motion, which takes that step alone, and is then loaded again. A lane whose run has ended starts the next
//! run. The arithmetic is that of a motion alone, operation for operation, so the result has the same bits
//! for any width, batch and processor.
//!
//! The width is chosen at run time by the processor.

mod columns;

use std::sync::atomic::AtomicBool;

use crate::dynamics::drive::form::{Form, clock, form};
use crate::dynamics::drive::tone::Sine;
use crate::dynamics::equation::Equation;
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::result::{Arrival, Outcome, Pursuit, Request, Run};
use crate::dynamics::run::ending::Begun;
use crate::dynamics::run::pursue::pursue_alone;
use crate::dynamics::series::{SEEDED, Series};
use crate::dynamics::state::Contact;
use crate::dynamics::step::stepper::Step;
use crate::numeric::{GaussLegendre, Lanes, Scalar};
use crate::system::clock::ThreadClock;
use columns::{Columns, LaneMotion, Trial};

/// Lanes where registers hold eight numbers: two registers a column, so that one addition need not wait for
/// the last.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
const WIDEST: usize = 16;

/// Steps of the batch between two checks of the budget and the cancel flag.
const BATCH_STEPS: u64 = 256;

/// A run and what it is made of.
struct Prepared<'a> {
    model: &'a Model,
    equation: &'a Equation<f64>,
    drive: &'a Sine<f64>,
    /// Of a motion that is pursued.
    pursuit: Option<&'a Pursuit<'a>>,
    place: usize,
}

/// What is done with a motion that has ended: its place, the motion, what it began as, and its outcome.
type Ended<'r> = dyn FnMut(usize, LaneMotion, &Begun<f64>, Outcome) + 'r;

impl Model {
    /// Runs several models with nothing listed, many at once where the processor can: what [`run`](Self::run)
    /// gives for each, bit for bit, in their order; `until_settled` as in [`Request`]. The CPU time of all is
    /// shared evenly between them.
    pub fn run_all(models: &[Self], until_settled: Option<f64>, cancel: Option<&AtomicBool>) -> Vec<Run> {
        run_all(models, &Request { cancel, until_settled, ..Request::default() }, usize::MAX)
    }

    /// Pursues motions of this model from starts of their own, many at once where the processor can; what
    /// each has come to, in their order, the same bit for bit for any batch. The model's scales are those of
    /// all of them, so that motions that meet in one release from rest go on alike. Its start and duration do
    /// not matter. Precondition: its drive [repeats](Self::repeats), and the starts lie in its curve and
    /// between its stops.
    pub fn pursue(&self, pursuits: &[Pursuit], cancel: Option<&AtomicBool>) -> Vec<Arrival> {
        pursue_all(self, pursuits, &Request { cancel, ..Request::default() }, usize::MAX)
    }

    /// [`pursue`](Self::pursue) one by one or in 4, 8 or 16 lanes, for tests; none where the processor has
    /// not so many.
    #[doc(hidden)]
    pub fn pursue_in_lanes(&self, pursuits: &[Pursuit], width: usize) -> Option<Vec<Arrival>> {
        let request = Request::default();
        match width {
            1 => Some(pursue_alone(self, pursuits, &request)),
            _ => has_lanes(width).then(|| pursue_all(self, pursuits, &request, width)),
        }
    }

    /// [`run_all`](Self::run_all) in 4, 8 or 16 lanes, for tests; none where the processor has not so many.
    #[doc(hidden)]
    pub fn run_all_in_lanes(models: &[Self], width: usize) -> Option<Vec<Run>> {
        has_lanes(width).then(|| run_all(models, &Request::default(), width))
    }
}

/// Runs several models, as [`Model::run`] does, with nothing listed; the results in their order.
///
/// Those that cannot share their steps with others are run alone. No more than `most` lanes are used.
fn run_all(models: &[Model], request: &Request, most: usize) -> Vec<Run> {
    let mut runs: Vec<Option<Run>> = models.iter().map(|_| None).collect();
    let mut shared = Vec::new();
    for (place, model) in models.iter().enumerate() {
        let unit = model.scales.unit();
        match form(model, &clock(model, unit)) {
            Form::Sine(drive) if model.compliant.is_none() && !model.motionless => {
                shared.push((model, Equation::new(model, unit), drive, place));
            }
            _ => runs[place] = Some(model.run(request)),
        }
    }
    let prepared = shared.iter().map(|(model, equation, drive, place)| Prepared {
        model,
        equation,
        drive,
        pursuit: None,
        place: *place,
    });
    let mut batched: Vec<Prepared> = prepared.collect();
    // Motions of one order share their steps; tolerances differ only where a sweep is over them.
    batched.sort_by(|a, b| b.model.tolerance.total_cmp(&a.model.tolerance));
    for alike in batched.chunk_by(|a, b| a.model.tolerance == b.model.tolerance) {
        let watch = ThreadClock::start();
        run_batch(alike, request, most, &mut |place, motion, begun, outcome| {
            runs[place] = Some(motion.finish(&models[place], begun, outcome));
        });
        let share = watch.seconds() / alike.len() as f64;
        for own in alike {
            if let Some(run) = &mut runs[own.place] {
                run.summary.cpu_s = share;
            }
        }
    }
    runs.into_iter().zip(models).map(|(run, model)| run.unwrap_or_else(|| model.run(request))).collect()
}

/// Pursues motions of one model; what each has come to, in their order.
fn pursue_all(model: &Model, pursuits: &[Pursuit], request: &Request, most: usize) -> Vec<Arrival> {
    let unit = model.scales.unit();
    let drive = match form(model, &clock(model, unit)) {
        Form::Sine(drive) if model.compliant.is_none() && pursuits.len() > 1 => drive,
        _ => return pursue_alone(model, pursuits, request),
    };
    let equation = Equation::new(model, unit);
    let prepared = pursuits.iter().enumerate().map(|(place, pursuit)| Prepared {
        model,
        equation: &equation,
        drive: &drive,
        pursuit: Some(pursuit),
        place,
    });
    let prepared: Vec<Prepared> = prepared.collect();
    let mut arrivals: Vec<Option<Arrival>> = pursuits.iter().map(|_| None).collect();
    run_batch(&prepared, request, most, &mut |place, motion, begun, outcome| {
        arrivals[place] = Some(motion.arrived(model, begun, outcome));
    });
    arrivals.into_iter().flatten().collect()
}

/// Whether the processor at hand has so many lanes.
fn has_lanes(width: usize) -> bool {
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
fn run_batch(prepared: &[Prepared], request: &Request, most: usize, ended: &mut Ended) {
    debug_assert!(most >= 4, "every processor has 4 lanes");
    if prepared.len() == 1 {
        return; // alone
    }
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if most >= WIDEST
            && let Some(wide) = pulp::x86::V4::try_new()
        {
            return wide.vectorize(Wide(Batch::<WIDEST>::new(prepared, request, ended)));
        }
        if most >= 8
            && let Some(wide) = pulp::x86::V3::try_new()
        {
            return wide.vectorize(Wide(Batch::<8>::new(prepared, request, ended)));
        }
    }
    Batch::<4>::new(prepared, request, ended).run();
}

/// What is run by instructions that not every processor has. (A type of its own and no closure: a closure's
/// body would be compiled apart, for every processor.)
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
struct Wide<'a, 'r, const W: usize>(Batch<'a, 'r, W>);

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
    motion: Box<LaneMotion<'a>>,
    begun: Begun<f64>,
}

struct Batch<'a, 'r, const W: usize> {
    prepared: &'a [Prepared<'a>],
    request: &'a Request<'a>,
    ended: &'r mut Ended<'r>,
    next: usize,
    lanes: [Option<Lane<'a>>; W],
    columns: Box<Columns<W>>,
    series: Box<Series<Lanes<W>>>,
    rule: GaussLegendre<Lanes<W>>,
    order: usize,
    tolerance_log2: f64,
}

impl<'a, 'r, const W: usize> Batch<'a, 'r, W> {
    fn new(prepared: &'a [Prepared<'a>], request: &'a Request<'a>, ended: &'r mut Ended<'r>) -> Self {
        let most = prepared.iter().map(|own| own.equation.most_products()).max().unwrap_or(0);
        let mut bundle = Self {
            prepared,
            request,
            ended,
            next: 0,
            lanes: [const { None }; W],
            columns: Box::new(Columns::new()),
            series: Box::new(Series::new(most)),
            rule: f64::gauss_legendre(1).map(|value| Lanes([value; W])),
            order: 0,
            tolerance_log2: 0.0,
        };
        for lane in 0..W {
            bundle.start_next(lane);
        }
        if let Some(first) = bundle.lanes.iter().flatten().next() {
            let settings = &first.motion.stepper.settings;
            (bundle.order, bundle.tolerance_log2) = (settings.order, settings.tolerance_log2);
            let rule = first.motion.record.rule_of_steps();
            bundle.rule = rule.map(|value| Lanes([value; W]));
        }
        bundle
    }

    /// Puts the next run into a lane.
    fn start_next(&mut self, lane: usize) {
        self.lanes[lane] = self.prepared.get(self.next).map(|own| {
            let clock = clock(own.model, own.equation.unit);
            let (model, request) = (own.model, self.request);
            let motion = Motion::new(model, request, model.tolerance, own.equation, clock, own.drive);
            let mut motion = Box::new(match own.pursuit {
                Some(pursuit) => motion.pursuing(pursuit, model),
                None => motion.with_recurrence(model.recurrence, model),
            });
            let begun = motion.begin(model);
            Lane { index: self.next, motion, begun }
        });
        self.next += 1;
    }

    /// Ends the run of a lane and takes up the next.
    fn end(&mut self, lane: usize, outcome: Outcome) {
        if let Some(Lane { index, motion, begun }) = self.lanes[lane].take() {
            (self.ended)(self.prepared[index].place, *motion, &begun, outcome);
        }
        self.start_next(lane);
    }

    #[inline(always)]
    fn run(mut self) {
        let mut rounds = 0;
        loop {
            for lane in 0..W {
                if !self.columns.active[lane] {
                    self.prepare_lane(lane);
                }
            }
            if !self.columns.active.contains(&true) {
                return;
            }
            loop {
                let trial = self.columns.step(&mut self.series, &self.rule, self.order, self.tolerance_log2);
                rounds += 1;
                for lane in 0..W {
                    if trial.taken[lane] & self.columns.logged[lane] {
                        self.log_step(lane, &trial);
                    }
                }
                if rounds % BATCH_STEPS == 0 {
                    self.check_budgets();
                    break;
                }
                if trial.stopped.contains(&true) {
                    for lane in 0..W {
                        if trial.stopped[lane] {
                            self.store(lane, &trial);
                        }
                    }
                    break;
                }
            }
        }
    }

    /// Goes on with the motion of a lane alone until its steps are event-free and its force has the shape
    /// that the other lanes have, or no run is left.
    fn prepare_lane(&mut self, lane: usize) {
        while let Some(own) = &mut self.lanes[lane] {
            let left = match own.motion.left() {
                Ok(left) => left,
                Err(outcome) => {
                    self.end(lane, outcome);
                    continue;
                }
            };
            let motion = &mut own.motion;
            if motion.state.contact == Contact::Free
                && motion.stepper.flies_freely(&motion.state)
                && motion.has_budget_for(2 * BATCH_STEPS)
                && self.columns.load(lane, own.index, motion)
            {
                return;
            }
            if let Some(outcome) = motion.proceed(left).or_else(|| motion.spent()) {
                self.end(lane, outcome);
            }
        }
    }

    /// Stores a lane back to its motion, which takes the step on which an event is possible.
    fn store(&mut self, lane: usize, trial: &Trial<W>) {
        let Some(own) = &mut self.lanes[lane] else { return };
        let motion = &mut own.motion;
        self.columns.store(lane, motion);
        let left = motion.stepper.clock.between(&motion.state.at, &motion.stepper.end);
        let flow = if trial.holds[lane] && trial.length.0[lane] < left {
            copy_lane(&self.series, lane, self.order, &mut motion.stepper.series);
            let alone = &mut motion.stepper.series;
            alone.measured = self.columns.inside[lane].then(|| (trial.length.0[lane], trial.squared.0[lane]));
            motion.stepper.evaluations += 1;
            motion.stepper.cursor = Some(trial.drive_at_end(lane));
            motion.take(&Step { length: trial.length.0[lane], arrival: None, end: trial.end(lane) })
        } else {
            motion.fly(left)
        };
        if let Some(outcome) = flow.or_else(|| motion.spent()) {
            self.end(lane, outcome);
        }
    }

    /// Logs the step that a lane has just taken.
    fn log_step(&mut self, lane: usize, trial: &Trial<W>) {
        let Some(own) = &mut self.lanes[lane] else { return };
        let motion = &mut own.motion;
        copy_lane(&self.series, lane, self.order, &mut motion.stepper.series);
        let mode = motion.stepper.mode(&motion.state);
        let (length, end) = (trial.length.0[lane], trial.end(lane));
        let state = (end.y + mode.origin, end.v);
        let view = motion.stepper.view(&motion.state, (length, length), end.bound, state);
        if let Some(log) = &mut motion.log {
            log.add_step(&view);
        }
        self.columns.copy_state(lane, motion);
        motion.mark();
        self.columns.logged[lane] = motion.log.is_some();
    }

    /// Checks budgets and the cancel flag.
    fn check_budgets(&mut self) {
        for lane in 0..W {
            let Some(own) = &mut self.lanes[lane] else { continue };
            if !self.columns.active[lane] {
                continue;
            }
            let motion = &mut own.motion;
            self.columns.store(lane, motion);
            if motion.stepper.work.is_cancelled() {
                let outcome = Outcome::Cancelled { at: motion.stepper.clock.seconds(&motion.state.at) };
                self.end(lane, outcome);
            } else if motion.has_budget_for(2 * BATCH_STEPS) {
                self.columns.load(lane, own.index, motion);
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
