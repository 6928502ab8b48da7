//! Batched runs: the event-free steps of several motions by the same instructions.
//!
//! Each lane holds a motion, with its own time and its own step length. As long as the steps of a lane are
//! event-free, all that they need (series, step length, end state, residual, clock and drive, sums and
//! extremes of the settled window) lies in columns and is computed for all lanes by the same instructions. A
//! step on which an event is possible (a surface or the barrier near by, a turning point that may be an
//! extreme, a border of the window, a stroboscopic state) is not taken there: the lane is stored back to its
//! motion, which takes that step alone, and is then loaded again. The lanes of a group hold forces of one
//! shape; a motion that enters a piece of the curve with another shape waits for a lane of that group. A run
//! that has ended makes room for the next. The arithmetic is that of a motion alone, operation for operation,
//! so the result has the same bits for any width, batch and processor.
//!
//! The width is chosen at run time by the processor.

mod batch;
mod columns;

use std::sync::atomic::AtomicBool;

use crate::dynamics::drive::form::{Form, clock, form};
use crate::dynamics::equation::Equation;
use crate::dynamics::model::Model;
use crate::dynamics::result::{Arrival, Pursuit, Request, Run};
use crate::dynamics::run::pursue::pursue_alone;
use crate::system::clock::ThreadClock;
use batch::{Batch, Ended, Prepared};

/// Lanes where registers hold eight numbers: two registers a column, so that one addition need not wait for
/// the last.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
const WIDEST: usize = 16;

impl Model {
    /// Runs several models with nothing listed, many at once where the processor can: what [`run`](Self::run)
    /// gives for each, bit for bit, in their order; `until_settled` as in [`Request`]. The CPU time of all is
    /// shared evenly between them.
    pub fn run_all(models: &[Self], until_settled: Option<f64>, cancel: Option<&AtomicBool>) -> Vec<Run> {
        Self::run_together(models, &Request { cancel, until_settled, ..Request::default() })
    }

    /// The same with what `request` asks of each. With a ledger, events or samples they are run one by one.
    pub fn run_together(models: &[Self], request: &Request) -> Vec<Run> {
        run_all(models, request, usize::MAX)
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

/// Runs several models, as [`Model::run`] does; the results in their order.
///
/// Those that cannot share their steps with others are run alone. No more than `most` lanes are used.
fn run_all(models: &[Model], request: &Request, most: usize) -> Vec<Run> {
    let mut runs: Vec<Option<Run>> = models.iter().map(|_| None).collect();
    let mut shared = Vec::new();
    let batches = !request.ledger && !request.events && request.sample_times.is_empty();
    for (place, model) in models.iter().enumerate() {
        let unit = model.scales.unit();
        match form(model, &clock(model, unit)) {
            Form::Sine(drive) if batches && model.compliant.is_none() && !model.motionless => {
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
