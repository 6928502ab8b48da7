//! Batched runs: the event-free steps of several motions by the same instructions.
//!
//! Each lane holds a motion with its own time and step length. While the steps of a lane are event-free,
//! their data (series, step length, end state, residual, clock and drive, sums and extremes of the settled
//! window) lies in columns and is computed for all lanes by the same instructions. Breaks of the force curve
//! and turning points are found there too, if a step has one. A step on which another event is possible (near
//! a stop or the barrier, a border of the window, a stroboscopic state) is not taken in the lane: the lane is
//! stored back to its motion, which takes that step alone and is then loaded again. The lanes of a group hold
//! forces of one degree; a motion that enters a piece of the curve of another degree waits for a lane of the
//! group of that degree. A run that has ended makes room for the next. The arithmetic is that of a single
//! motion, operation for operation, so the result has the same bits for any width, batch and processor.
//!
//! The width is chosen at run time by the processor.

mod batch;
mod columns;
mod trial;

use std::cell::OnceCell;
use std::sync::atomic::AtomicBool;

use crate::dynamics::drive::form::{Form, clock, form};
use crate::dynamics::drive::tone::Sine;
use crate::dynamics::equation::Equation;
use crate::dynamics::model::Model;
use crate::dynamics::result::{Outcome, Pursued, Pursuit, Request, Run};
use crate::dynamics::run::pursue_alone;
use crate::system::clock::ThreadClock;
use crate::system::threads::UnderWay;
use batch::{Batch, Prepared, Source};
use columns::LaneMotion;

/// Number of lanes if registers hold eight numbers: two registers per column, to hide the latency of
/// additions.
const MAX_LANES: usize = 16;

/// Number of runs whose data are allocated together and freed when all of them have ended.
const RUNS_PER_BLOCK: usize = 1024;

impl Model {
    /// [`run_together`](Self::run_together) without any lists; `until_settled` as in [`Request`].
    pub fn run_all(models: &[Self], until_settled: Option<f64>, cancel: Option<&AtomicBool>) -> Vec<Run> {
        Self::run_together(models, &Request { cancel, until_settled, ..Request::default() })
    }

    /// Runs several models, with `request` for each, in as many lanes as the processor has. Returns in order
    /// what [`run`](Self::run) gives for each, bit for bit. The CPU time is shared evenly between the runs.
    /// With a ledger, events or samples, the models are run one by one.
    pub fn run_together(models: &[Self], request: &Request) -> Vec<Run> {
        run_all(models, request, MAX_LANES)
    }

    /// Like [`run_together`](Self::run_together), but takes models one by one while others are running, so
    /// that several threads can share them. `next` gets the work in progress on this thread and returns a
    /// number, a model and its request. `None` means that no model is available now; with no work in
    /// progress, it means that there will be no more. `ended` gets each run with its number and model as soon
    /// as the run has ended. No CPU time is measured.
    #[doc(hidden)]
    pub fn run_from<'q>(
        next: &mut dyn FnMut(UnderWay) -> Option<(usize, Self, Request<'q>)>,
        ended: &mut dyn FnMut(usize, &Self, Run),
    ) {
        run_from(MAX_LANES, next, ended);
    }

    /// Pursues motions of this model from given starts, in as many lanes as the processor has. `next` returns
    /// the index of the next pursuit, as for [`run_from`](Self::run_from); `ended` gets the index and result
    /// of each. A result has the same bits whatever else runs in the batch. All use the model's scales, so
    /// that motions that meet in one release from rest have the same continuation. The model's start and
    /// duration have no effect. Precondition: its drive [repeats](Self::repeats), and the starts lie in its
    /// curve and between its stops.
    #[doc(hidden)]
    pub fn pursue(
        &self,
        pursuits: &[Pursuit],
        cancel: Option<&AtomicBool>,
        next: &mut dyn FnMut(UnderWay) -> Option<usize>,
        ended: &mut dyn FnMut(usize, Pursued),
    ) {
        pursue(self, pursuits, &Request { cancel, ..Request::default() }, MAX_LANES, next, ended);
    }

    /// [`pursue`](Self::pursue) one by one or in 4, 8 or 16 lanes, for tests; `None` if the processor lacks
    /// them.
    #[doc(hidden)]
    pub fn pursue_in_lanes(&self, pursuits: &[Pursuit], width: usize) -> Option<Vec<Pursued>> {
        let request = Request::default();
        if width == 1 {
            return Some(pursuits.iter().map(|pursuit| pursue_alone(self, pursuit, &request)).collect());
        }
        let (mut all, mut pursued) = (0..pursuits.len(), vec![None; pursuits.len()]);
        let mut ended = |place: usize, end| pursued[place] = Some(end);
        has_lanes(width).then(|| pursue(self, pursuits, &request, width, &mut |_| all.next(), &mut ended))?;
        pursued.into_iter().collect()
    }

    /// [`run_together`](Self::run_together) in 4, 8 or 16 lanes, for tests; `None` if there are none.
    #[doc(hidden)]
    pub fn run_all_in_lanes(models: &[Self], width: usize) -> Option<Vec<Run>> {
        has_lanes(width).then(|| run_all(models, &Request::default(), width))
    }
}

/// Runs several models, as [`Model::run`] does, in at most `max_lanes` lanes. Returns the results in order.
fn run_all(models: &[Model], request: &Request, max_lanes: usize) -> Vec<Run> {
    let watch = ThreadClock::start();
    let mut runs: Vec<Option<Run>> = models.iter().map(|_| None).collect();
    let mut all = models.iter().cloned().enumerate().map(|(place, model)| (place, model, *request));
    let mut next =
        |under_way: UnderWay| if !under_way.full || all.len() <= MAX_LANES { all.next() } else { None };
    run_from(max_lanes, &mut next, &mut |place, _, run| runs[place] = Some(run));
    let share = watch.seconds() / models.len() as f64;
    runs.iter_mut().flatten().for_each(|run| run.summary.cpu_s = share);
    runs.into_iter().flatten().collect()
}

fn run_from<'q>(
    max_lanes: usize,
    next: &mut dyn FnMut(UnderWay) -> Option<(usize, Model, Request<'q>)>,
    ended: &mut dyn FnMut(usize, &Model, Run),
) {
    let mut finished = false;
    while !finished {
        let slots: Vec<OnceCell<Box<PreparedRun>>> = (0..RUNS_PER_BLOCK).map(|_| OnceCell::new()).collect();
        let mut runs = Runs { slots: slots.iter(), next, ended };
        run_batch(&mut runs, max_lanes);
        finished = runs.slots.len() > 0;
    }
}

struct PreparedRun<'q> {
    model: Model,
    request: Request<'q>,
    equation: Equation<f64>,
    drive: Sine<f64>,
}

/// Runs of models. A model whose steps cannot be taken in lanes is run alone.
struct Runs<'a, 'q, 'r> {
    slots: std::slice::Iter<'a, OnceCell<Box<PreparedRun<'q>>>>,
    next: &'r mut dyn FnMut(UnderWay) -> Option<(usize, Model, Request<'q>)>,
    ended: &'r mut dyn FnMut(usize, &Model, Run),
}

impl<'a> Source<'a> for Runs<'a, '_, '_> {
    fn next(&mut self, under_way: UnderWay) -> Option<Prepared<'a>> {
        let slot = self.slots.as_slice().first()?;
        loop {
            let (place, model, request) = (self.next)(under_way)?;
            let listed = request.ledger || request.events || request.until_crossing;
            let lists = listed || !request.sample_times.is_empty();
            let shares = !lists && model.compliant.is_none() && !model.motionless;
            let unit = model.scales.unit();
            match shares.then(|| form(&model, &clock(&model, unit))) {
                Some(Form::Sine(drive)) => {
                    self.slots.next();
                    let equation = Equation::new(&model, unit);
                    let run = slot.get_or_init(|| Box::new(PreparedRun { model, request, equation, drive }));
                    let PreparedRun { model, request, equation, drive } = &**run;
                    return Some(Prepared { model, request, equation, drive, pursuit: None, place });
                }
                _ => (self.ended)(place, &model, model.run(&request)),
            }
        }
    }

    fn ended(&mut self, run: &Prepared<'a>, motion: LaneMotion<'a>, outcome: Outcome) {
        (self.ended)(run.place, run.model, motion.finish(outcome));
    }
}

fn pursue(
    model: &Model,
    pursuits: &[Pursuit],
    request: &Request,
    max_lanes: usize,
    next: &mut dyn FnMut(UnderWay) -> Option<usize>,
    ended: &mut dyn FnMut(usize, Pursued),
) {
    let unit = model.scales.unit();
    match form(model, &clock(model, unit)) {
        Form::Sine(drive) if model.compliant.is_none() => {
            let equation = Equation::new(model, unit);
            let prepared = |place: usize| Prepared {
                model,
                request,
                equation: &equation,
                drive: &drive,
                pursuit: Some(&pursuits[place]),
                place,
            };
            run_batch(&mut Pursuits { prepared, next, ended }, max_lanes);
        }
        _ => {
            while let Some(place) = next(UnderWay::default()) {
                ended(place, pursue_alone(model, &pursuits[place], request));
            }
        }
    }
}

struct Pursuits<'r, P> {
    prepared: P,
    next: &'r mut dyn FnMut(UnderWay) -> Option<usize>,
    ended: &'r mut dyn FnMut(usize, Pursued),
}

impl<'a, P: Fn(usize) -> Prepared<'a>> Source<'a> for Pursuits<'_, P> {
    fn next(&mut self, under_way: UnderWay) -> Option<Prepared<'a>> {
        (self.next)(under_way).map(&self.prepared)
    }

    fn ended(&mut self, run: &Prepared<'a>, motion: LaneMotion<'a>, outcome: Outcome) {
        (self.ended)(run.place, motion.arrived(outcome));
    }
}

fn has_lanes(width: usize) -> bool {
    match width {
        4 => true,
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        8 => pulp::x86::V3::is_available(),
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        MAX_LANES => pulp::x86::V4::is_available(),
        _ => false,
    }
}

/// Executes the runs of a source in as many lanes as the processor has, at most `max_lanes`.
fn run_batch<'a>(source: &mut dyn Source<'a>, max_lanes: usize) {
    debug_assert!(max_lanes >= 4, "every processor has 4 lanes");
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if max_lanes >= MAX_LANES
            && let Some(wide) = pulp::x86::V4::try_new()
        {
            return wide.vectorize(Wide(Batch::<MAX_LANES>::new(source)));
        }
        if max_lanes >= 8
            && let Some(wide) = pulp::x86::V3::try_new()
        {
            return wide.vectorize(Wide(Batch::<8>::new(source)));
        }
    }
    Batch::<4>::new(source).run();
}

/// A batch to be run by instructions that not every processor has. It is a type and not a closure, since the
/// body of a closure would be compiled separately for the baseline processor.
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
