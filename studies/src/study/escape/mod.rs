//! Escape from a well under noise: when runs that differ in the seed of their noise first leave the well.
//!
//! Run number i of a cell, from 0, has the seed of the scene plus i, in each noise of its excitation. So one
//! of the runs can be repeated alone with that seed, the runs do not depend on threads, and all cells of a
//! grid have the same random numbers, whose scatter then hardly shows in the differences between cells.
//!
//! A run begins in the start of the scene and ends with its escape, or at the time `within`. The estimate of
//! the rate ([`Rate`]) assumes exponential waiting times, which hold once the time to escape is much longer
//! than the time in which the motion forgets its start.

mod kramers;
mod probability;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::grid_study::{Built, Cells};
use super::thresholds::NoThresholds;
use super::walk::{choice_fault, excitation_fault};
use super::{Cancelled, Table, Task};
use crate::dynamics::{Model, Outcome, Request};
use crate::mechanics::Mechanism;
use crate::numeric::{Rate, Waiting, median};
use crate::scene::{Excitation, Fault, Scene, Start};
use crate::system::threads::Pool;
pub use kramers::{NoKramers, depopulation, kramers_rate};
pub use probability::{Chance, probable_threshold_table};

/// Largest seed of a noise, after which the seeds of further runs continue from 0.
const MAX_SEED: u64 = 1 << 53;

words! {
    /// What counts as an escape.
    Until {
        /// The mass first crosses the top of the barrier. In half of these crossings under strong damping it
        /// falls back.
        Crossing = "crossing",
        /// The mass first reaches the well behind the barrier: its equilibrium or, if a stop stands before
        /// that, the middle between the barrier and the stop.
        Well = "well",
    }
}

/// The runs of an escape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EscapeOptions {
    /// Number of runs, each with another seed, at least 1.
    pub runs: u64,
    /// Time in s at which a run ends without an escape.
    pub within: f64,
    /// What counts as an escape.
    pub until: Until,
}

/// The waiting time of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Waited {
    waiting: Waiting,
    /// Whether the run ended before its time without an escape, as where the mass leaves a table.
    ended_early: bool,
}

/// The waiting times of a cell, and its rate by Kramers; `None` if the mechanism was not solved.
type Escapes = Option<(Vec<Waited>, Result<f64, NoKramers>)>;

/// Escapes in every cell, with the columns of [`Escape`](crate::questions::Escape). Ticks for each
/// run. All cells are checked before the first run.
pub fn escape_table(
    cells: &Cells,
    options: &EscapeOptions,
    pool: &Pool,
    task: &Task,
) -> Result<Table, NoThresholds> {
    let fault = |scene: &Scene, mechanism: &Arc<Mechanism>| {
        let prepared = prepared(scene, 0, options.within);
        match Model::build(&prepared, Arc::clone(mechanism)) {
            Ok(model) => Some(vec![escape_fault(&model, &prepared)?]),
            Err(faults) => Some(faults),
        }
    };
    cells.check(pool, task, fault)?;
    let model = |scene: &Scene, built: Built, run: u64| {
        let prepared = prepared(scene, run, options.within);
        built.ok().and_then(|mechanism| Model::build(&prepared, mechanism).ok())
    };
    let wait = |scene: &Scene, built: Built, run: u64| {
        let model = model(scene, built, run);
        let waited = model.map(|model| waited(&model, options.until, task.cancel)).transpose()?;
        (task.tick)();
        Ok(waited)
    };
    let kramers = |scene: &Scene, built: Built, run: u64| {
        Ok(model(scene, built, run).map(|model| match options.until {
            Until::Well => kramers_rate(&model),
            Until::Crossing => Err(NoKramers::Until),
        }))
    };
    let runs = options.runs as usize;
    let waited = cells.map(runs, pool, task, wait)?;
    let rates = cells.map(1, pool, task, kramers)?;
    let of_cell = |cell: &[Option<Waited>]| cell.iter().copied().collect::<Option<Vec<Waited>>>();
    let found: Vec<Escapes> =
        waited.chunks(runs).map(of_cell).zip(rates).map(|(waited, rate)| waited.zip(rate)).collect();
    Ok(with_columns(cells.table(), options, &found))
}

fn with_columns(table: Table, options: &EscapeOptions, found: &[Escapes]) -> Table {
    let count = |of: fn(&Waited) -> bool| {
        move |cell: &Escapes| cell.as_ref().map(|(all, _)| all.iter().filter(|one| of(one)).count() as u64)
    };
    let observed = |cell: &Escapes| {
        let (waited, _) = cell.as_ref()?;
        Some(waited.iter().map(|one| one.waiting.time).sum::<f64>())
    };
    let escaped = count(|one| one.waiting.happened);
    let rate = |of: fn(&Rate) -> f64| {
        move |cell: &Escapes| {
            let observed = observed(cell).filter(|time| *time > 0.0)?;
            Some(of(&Rate::of(escaped(cell)?, observed)))
        }
    };
    // the mean waiting time is the inverse of the rate, without an end where that is 0
    let mean = |of: fn(&Rate) -> f64| {
        let rate = rate(of);
        move |cell: &Escapes| rate(cell).filter(|rate| *rate > 0.0).map(|rate| 1.0 / rate)
    };
    let half = |cell: &Escapes| {
        let waiting: Vec<Waiting> = cell.as_ref()?.0.iter().map(|one| one.waiting).collect();
        median(&waiting)
    };
    table
        .each("runs", found, |cell| cell.as_ref().map(|_| options.runs))
        .each("escaped", found, escaped)
        .each("ended_early", found, count(|one| one.ended_early))
        .each("observed_s", found, observed)
        .each("escape_rate_per_s", found, rate(|rate| rate.value))
        .each("escape_rate_low_per_s", found, rate(|rate| rate.low))
        .each("escape_rate_high_per_s", found, rate(|rate| rate.high))
        .each("mean_first_passage_s", found, mean(|rate| rate.value))
        .each("mean_first_passage_low_s", found, mean(|rate| rate.high))
        .each("mean_first_passage_high_s", found, mean(|rate| rate.low))
        .each("median_first_passage_s", found, half)
        .each("kramers_rate_per_s", found, |cell| cell.as_ref()?.1.ok())
        .each("kramers_fails", found, |cell| {
            let fails = cell.as_ref().and_then(|cell| cell.1.err());
            fails.map_or("", NoKramers::name)
        })
}

/// The scene of run number `run`, which ends at the time `within` in s.
fn prepared(scene: &Scene, run: u64, within: f64) -> Scene {
    let mut scene = scene.clone();
    reseed(&mut scene.excitation, run);
    // without a settled window, since its averages are not used
    (scene.run.duration_s, scene.run.settle_s) = (within, Some(within));
    scene
}

fn reseed(excitation: &mut Excitation, run: u64) {
    match excitation {
        Excitation::Noise { seed, .. } => *seed = (*seed + run) % (MAX_SEED + 1),
        Excitation::Sum(terms) => terms.iter_mut().for_each(|term| reseed(term, run)),
        _ => {}
    }
}

/// Why there is no escape to wait for.
fn escape_fault(model: &Model, scene: &Scene) -> Option<Fault> {
    if model.excitation().noises.is_empty() {
        let problem = "has no noise, so that all runs are the same: take \
                       excitation=Noise(rms_g:0.3,low_hz:1,high_hz:20,seed:1), or a Sum with one";
        return Some(excitation_fault(scene, problem.into()));
    }
    if model.mechanism().landscape.barrier.is_none() {
        let problem = "has one well or none, so that there is no barrier to cross: take one with two wells";
        return Some(choice_fault(scene, "mechanism", problem.into()));
    }
    let Some(barrier) = model.crossing_level() else {
        let problem = "lets the mass cross no barrier: take stops on both sides of it";
        return Some(choice_fault(scene, "stops", problem.into()));
    };
    let on_top = model.start().0 == barrier;
    on_top.then(|| match scene.start {
        Start::At { x_mm, .. } => {
            let problem = "lies on the barrier, so that there is no well to leave";
            Fault::new("start.x_mm", x_mm.to_string(), problem)
        }
        Start::Rest => Fault::new("start", "Rest", "lies on the barrier: give a start in a well by At(..)"),
    })
}

/// Position in m of the well behind the barrier, or the middle between the barrier and a stop before it.
fn well_behind(model: &Model, barrier: f64) -> Option<f64> {
    let wells = model.mechanism().landscape.wells();
    let (left, right) = model.stop_positions();
    let (well, stop) = match model.start().0 < barrier {
        true => (wells.iter().find(|well| well.x > barrier)?.x, right),
        false => (wells.iter().rfind(|well| well.x < barrier)?.x, left),
    };
    let stands_before = |stop: &f64| (stop - barrier).abs() <= (well - barrier).abs();
    Some(stop.filter(stands_before).map_or(well, |stop| 0.5 * (barrier + stop)))
}

/// Runs the model, which lasts for the time of the waiting, up to its escape.
fn waited(model: &Model, until: Until, cancel: &AtomicBool) -> Result<Waited, Cancelled> {
    let level = match until {
        Until::Crossing => model.crossing_level(),
        Until::Well => model.crossing_level().and_then(|barrier| well_behind(model, barrier)),
    };
    let request = Request { until_crossing: true, cancel: Some(cancel), ..Request::default() };
    let stayed =
        |time: f64, ended_early: bool| Waited { waiting: Waiting { time, happened: false }, ended_early };
    let within = model.duration();
    let Some(level) = level else { return Ok(stayed(within, false)) };
    let summary = model.with_crossing_level(level).run(&request).summary;
    let first = summary.firsts.and_then(|firsts| firsts.crossing).map(|first| first.t);
    match (first, summary.outcome) {
        (Some(time), _) => Ok(Waited { waiting: Waiting { time, happened: true }, ended_early: false }),
        (None, Outcome::Cancelled { .. }) => Err(Cancelled),
        (None, outcome) => Ok(stayed(outcome.ended_at().unwrap_or(within), outcome != Outcome::Done)),
    }
}
