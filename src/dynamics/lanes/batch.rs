//! Batch: lanes that hold a motion each, and the steps that they take together.

use super::columns::{Columns, LaneMotion, Trial};
use crate::dynamics::drive::form::clock;
use crate::dynamics::drive::tone::Sine;
use crate::dynamics::equation::Equation;
use crate::dynamics::model::Model;
use crate::dynamics::motion::Motion;
use crate::dynamics::result::{Outcome, Pursuit, Request};
use crate::dynamics::run::ending::Begun;
use crate::dynamics::series::{SEEDED, Series};
use crate::dynamics::state::Contact;
use crate::dynamics::step::stepper::Step;
use crate::numeric::{GaussLegendre, Lanes, Scalar};

/// Steps of the batch between two checks of the budget and the cancel flag.
const BATCH_STEPS: u64 = 256;

/// Fewer motions than this go on faster one after the other: a step of all lanes takes as long as some five
/// steps alone, however many lanes are in use.
const FEWEST: usize = 5;

/// A run and what it is made of.
pub(super) struct Prepared<'a> {
    pub model: &'a Model,
    pub equation: &'a Equation<f64>,
    pub drive: &'a Sine<f64>,
    /// Of a motion that is pursued.
    pub pursuit: Option<&'a Pursuit<'a>>,
    pub place: usize,
}

/// What is done with a motion that has ended: its place, the motion, what it began as, and its outcome.
pub(super) type Ended<'r> = dyn FnMut(usize, LaneMotion, &Begun<f64>, Outcome) + 'r;

/// A lane: a motion, and what it began as.
pub(super) struct Lane<'a> {
    index: usize,
    motion: Box<LaneMotion<'a>>,
    begun: Begun<f64>,
}

pub(super) struct Batch<'a, 'r, const W: usize> {
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
    pub fn new(prepared: &'a [Prepared<'a>], request: &'a Request<'a>, ended: &'r mut Ended<'r>) -> Self {
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
    pub fn run(mut self) {
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
            if self.next >= self.prepared.len() && self.lanes.iter().flatten().count() < FEWEST.min(W / 2) {
                return self.finish_alone();
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

    /// Goes on with each motion alone to its end.
    #[inline(never)] // once a batch
    fn finish_alone(&mut self) {
        for lane in 0..W {
            let Some(own) = &mut self.lanes[lane] else { continue };
            if self.columns.active[lane] {
                self.columns.store(lane, &mut own.motion);
            }
            let outcome = own.motion.go_on();
            self.end(lane, outcome);
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
