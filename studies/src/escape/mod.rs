//! Escape from a well under noise: how often, and when, motions of different seeds leave it.
//!
//! Run number i of a cell, from 0, has the seed of the scene plus i, in each noise of its excitation. So one
//! of the runs can be repeated alone with that seed, the runs do not depend on threads, and all cells of a
//! grid have the same random numbers, whose scatter then hardly shows in the differences between cells.
//!
//! A run begins in the start of the scene and ends with its escape, or at the time `within`. The estimate of
//! the rate ([`Rate`]) assumes exponential waiting times, which hold once the time to escape is much longer
//! than the time in which the motion forgets its start.

mod chart;
mod kramers;

use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Args;
use serde::{Deserialize, Serialize};

use crate::dynamics::{Model, Outcome, Request};
use crate::mechanics::Mechanism;
use crate::numeric::{Rate, Waiting, median};
use crate::output::{NoPicture, can_show_over_field};
use crate::questions::{Error, Progress};
use crate::scene::{Excitation, Fault, Scene, Start, field_info};
use crate::study::{
    Answered, Built, Cancelled, Cells, ColumnOf, Grid, Heading, NoThresholds, Over, Scenes, Study, Table,
    Task, Values, choice_fault, column, excitation_fault, number, study_methods, whole,
};
use crate::system::threads::Pool;
pub use kramers::{NoKramers, depopulation, kramers_rate};

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

/// How often a motion under noise leaves its well, and after which time.
///
/// Runs that differ in the seed of the noise, for one scene or in every cell of a grid.
///
/// # Method
///
/// The rate is the number of escapes over the time observed in all runs, those without an escape
/// included, which is the estimate of largest likelihood for exponential waiting times; its interval is that
/// of chi-squared quantiles (Garwood 1936; Epstein and Sobel 1953; Cox 1953). The median is that of Kaplan
/// and Meier (1958). Run number i, from 0, has the seed of the scene plus i. The relative width of the
/// interval falls with the square root of the number of escapes.
///
/// Kramers' rate is (sqrt(g^2/4 + w_b^2) - g/2)/w_b * w_0/(2 pi) * exp(-E/k_B T) with the rates w_0 of the
/// well and w_b of the barrier, g = c/m and the height E of the barrier over the well (Kramers 1940; Hänggi,
/// Talkner and Borkovec 1990, equation 4.33), times a factor that leads over to weak damping (Mel'nikov and
/// Meshkov 1986). Noise with the two-sided spectral density S = rms^2/(2 (high - low)) of the base
/// acceleration acts as k_B T = m^2 S/(2 c). The rate is missing where it does not hold, and `kramers_fails`
/// says why.
///
/// # Errors
///
/// [`Error::Argument`] for a wrong number of runs or time; [`Error::Cells`] for cells without noise,
/// with one well, or whose start lies on the barrier.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Escape, Progress, Simulation};
///
/// let simulation = Simulation::from_text("example.ron", r#"(
///     title: "Two wells under noise",
///     mass_g: 10.0,
///     mechanism: DoubleWell(equilibrium_mm: 1.0, barrier_mj: 0.00123),
///     damping: Coefficient(c_n_s_per_m: 0.314),
///     excitation: Noise(rms_g: 0.05, low_hz: 0.0, high_hz: 60.0, seed: 1, lines: 200),
///     run: (duration_s: 20.0, tolerance: 1e-6),
/// )"#)?;
/// let table = Escape { runs: 20, ..Escape::default() }.run(&simulation, &Progress::none())?;
/// let number = |name: &str| table.numbers(name).unwrap()[0];
/// assert!(number("escape_rate_low_per_s") < number("kramers_rate_per_s"));
/// assert!(number("kramers_rate_per_s") < number("escape_rate_high_per_s"));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(after_help = EXAMPLES)]
#[group(skip)]
pub struct Escape {
    /// The fields of the grid, the slowest first; if there are none, the table has one row.
    #[arg(skip)]
    pub over: Over,
    /// Runs of each cell, each with another seed of the noise, 1 to 1000000
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value_t = Self::RUNS)]
    #[arg(value_parser = whole::<u64>(RUNS))]
    pub runs: u64,
    /// Time in s at which a run without an escape ends [default: the duration of the scene's run]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    #[arg(value_parser = number("give a time in s, such as 100"))]
    pub within: Option<f64>,
    /// What counts as an escape
    #[arg(long, value_name = "ESCAPE", default_value = "well")]
    pub until: Until,
}

const EXAMPLES: &str = "\
Examples:
  interwell --headless escape paper --set 'excitation=Noise(rms_g:0.8,low_hz:0.5,high_hz:20,seed:1)' --runs 50
  interwell --headless escape my-noise.ron --runs 200 --within 100 --over excitation.rms_g=0.2:0.6:0.05 \\
      --plot rate.png
  interwell --headless escape my-noise.ron --until crossing --over stops.travel_limit_mm=2:6:0.5 --out e.csv

Run number i, from 0, has the seed of the scene plus i: `simulate --set excitation.seed=..` repeats one.";

impl Default for Escape {
    fn default() -> Self {
        Self { over: Vec::new(), runs: Self::RUNS, within: None, until: Until::Well }
    }
}

/// Numbers of runs that can be asked for.
pub(crate) const RUNS: RangeInclusive<u64> = 1..=1_000_000;

/// Largest number of runs of all cells together.
const MAX_RUNS: u64 = 10_000_000;

impl Escape {
    /// Default number of runs.
    pub const RUNS: u64 = 100;
}

study_methods!(Escape);

impl Study for Escape {
    const NAME: &'static str = "escape";
    const SCENE: &'static str = "Scene file or built-in scene; its excitation is a noise, or a sum with one";
    const PARTS: &'static str = "runs";
    const PYTHON: &'static str = "\
>>> noisy = scene.set(excitation=\"Noise(rms_g: 1, low_hz: 0.5, high_hz: 10, seed: 5)\")
>>> table = noisy.escape(runs=8, within=4)
>>> bool(table[\"escape_rate_low_per_s\"][0] <= table[\"escape_rate_high_per_s\"][0])
True";

    fn over(&self) -> &Over {
        &self.over
    }

    fn check(&self, scenes: &Scenes) -> Result<(), Error> {
        check_runs(self.runs, self.within(scenes.scene()), scenes.grid)
    }

    fn answer(&self, scenes: &Scenes, progress: &Progress) -> Result<Answered, Error> {
        let (cells, runs) = (scenes.cells(), scenes.grid.cells() * self.runs);
        let table = progress.shared(runs, |pool, task| self.followed(&cells, pool, task))?;
        let table = table.map_err(|end| scenes.no_table(end))?;
        let (study, within) = (self.clone(), self.within(scenes.scene()));
        let x = scenes.grid.columns().first().cloned().unwrap_or_default();
        let answer = Answered::new(table);
        let remarks = [described(&answer.table)];
        Ok(answer.told(remarks).drawn(move |rows, framing| Ok(study.drawn(&x, within, rows, framing.ranges))))
    }

    fn can_draw(&self, grid: &Grid) -> Result<(), NoPicture> {
        can_show_over_field(grid, "escapes")
    }

    fn columns() -> Vec<Vec<Heading>> {
        vec![Self::default().columns().into_iter().map(|column| column.heading).collect()]
    }
}

/// The waiting time of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Waited {
    pub waiting: Waiting,
    /// Whether the run ended before its time without an escape, as where the mass leaves a table.
    ended_early: bool,
}

/// The waiting times of a cell, and its rate by Kramers; `None` if the mechanism was not solved.
type Escapes = Option<(Vec<Waited>, Result<f64, NoKramers>)>;

/// The columns of a table of escapes.
type Columns<'a> = Vec<ColumnOf<'a, Escapes>>;

impl Escape {
    /// Time in s at which a run of `scene` without an escape ends.
    fn within(&self, scene: &Scene) -> f64 {
        self.within.unwrap_or(scene.run.duration_s)
    }

    /// The runs of every cell. Ticks for each of them; all cells are checked before the first.
    fn followed(&self, cells: &Cells, pool: &Pool, task: &Task) -> Result<Table, NoThresholds> {
        let within = self.within(cells.scene());
        let fault = |scene: &Scene, mechanism: &Arc<Mechanism>| {
            let prepared = prepared(scene, 0, within);
            match Model::build(&prepared, Arc::clone(mechanism)) {
                Ok(model) => Some(vec![escape_fault(&model, &prepared)?]),
                Err(faults) => Some(faults),
            }
        };
        cells.check(pool, task, fault)?;
        let model = |scene: &Scene, built: Built, run: u64| {
            let prepared = prepared(scene, run, within);
            built.ok().and_then(|mechanism| Model::build(&prepared, mechanism).ok())
        };
        let wait = |scene: &Scene, built: Built, run: u64| {
            let model = model(scene, built, run);
            let waited = model.map(|model| waited(&model, self.until, task.cancel)).transpose()?;
            (task.tick)();
            Ok(waited)
        };
        let kramers = |scene: &Scene, built: Built, run: u64| {
            Ok(model(scene, built, run).map(|model| match self.until {
                Until::Well => kramers_rate(&model),
                Until::Crossing => Err(NoKramers::Until),
            }))
        };
        let runs = self.runs as usize;
        let waited = cells.map(runs, pool, task, wait)?;
        let rates = cells.map(1, pool, task, kramers)?;
        let of_cell = |cell: &[Option<Waited>]| cell.iter().copied().collect::<Option<Vec<Waited>>>();
        let found: Vec<Escapes> =
            waited.chunks(runs).map(of_cell).zip(rates).map(|(waited, rate)| waited.zip(rate)).collect();
        Ok(cells.table().with_columns(&self.columns(), &found))
    }

    /// What is written of a cell.
    fn columns(&self) -> Columns<'_> {
        vec![
            column(
                "runs",
                "runs; empty where the flexures have no solution, as all columns",
                |cell: &Escapes| cell.as_ref().map(|_| self.runs),
            ),
            column("escaped", "runs that escaped", |cell: &Escapes| count(cell, |one| one.waiting.happened)),
            column(
                "ended_early",
                "runs that ended before their time without an escape: they left the table of the force, or \
                 used up a budget. They count as observed up to there, which is right only if they would \
                 have escaped as often as the others",
                |cell: &Escapes| count(cell, |one| one.ended_early),
            ),
            column(
                "observed_s",
                "time observed in all runs in s, up to the escape of those that escaped",
                observed,
            ),
            column(
                "escape_rate_per_s",
                "`escaped` over `observed_s`: the estimate of largest likelihood for exponential waiting \
                 times",
                |cell: &Escapes| rate(cell, |rate| rate.value),
            ),
            column("escape_rate_low_per_s", "", |cell: &Escapes| rate(cell, |rate| rate.low)),
            column(
                "escape_rate_high_per_s",
                "its 95 % interval: the 0.025 quantile of chi-squared with 2 r degrees of freedom and the \
                 0.975 quantile with 2 r + 2, over twice the time, where r escaped (Garwood 1936; Epstein \
                 and Sobel 1953; Cox 1953). Without an escape it begins at 0",
                |cell: &Escapes| rate(cell, |rate| rate.high),
            ),
            column(
                "mean_first_passage_s",
                "mean time to the escape, the inverse of the rate; empty without an escape",
                |cell: &Escapes| mean(cell, |rate| rate.value),
            ),
            column("mean_first_passage_low_s", "", |cell: &Escapes| mean(cell, |rate| rate.high)),
            column(
                "mean_first_passage_high_s",
                "its interval; the upper end is empty without an escape",
                |cell: &Escapes| mean(cell, |rate| rate.low),
            ),
            column(
                "median_first_passage_s",
                "time after which half have escaped, by Kaplan and Meier (1958), whatever the distribution; \
                 empty where fewer have. Of exponential times it is 0.69 times the mean",
                |cell: &Escapes| {
                    median(&cell.as_ref()?.0.iter().map(|one| one.waiting).collect::<Vec<Waiting>>())
                },
            ),
            column(
                "kramers_rate_per_s",
                "Kramers' rate for white noise; empty where it does not hold",
                |cell: &Escapes| cell.as_ref()?.1.ok(),
            ),
            column(
                "kramers_fails",
                "the condition that fails there: `until` (`until` is `crossing`), `damping` (not linear, \
                 none, or a circuit), `barrier` (not one barrier with a well behind it), `noise` (not one \
                 noise alone), `height` (below 3 kT), `kink`, `ends` (of stops or a table), `band`, \
                 `lines` (too few), `rate` (too small for a number)",
                |cell: &Escapes| cell.as_ref().and_then(|cell| cell.1.err()).map_or("", NoKramers::name),
            ),
        ]
    }
}

/// The number of runs of a cell that are such.
fn count(cell: &Escapes, is: fn(&Waited) -> bool) -> Option<u64> {
    Some(cell.as_ref()?.0.iter().filter(|one| is(one)).count() as u64)
}

/// The time in s observed in all runs of a cell.
fn observed(cell: &Escapes) -> Option<f64> {
    Some(cell.as_ref()?.0.iter().map(|one| one.waiting.time).sum())
}

fn rate(cell: &Escapes, of: fn(&Rate) -> f64) -> Option<f64> {
    let observed = observed(cell).filter(|time| *time > 0.0)?;
    Some(of(&Rate::of(count(cell, |one| one.waiting.happened)?, observed)))
}

/// The mean waiting time is the inverse of the rate, without an end where that is 0.
fn mean(cell: &Escapes, of: fn(&Rate) -> f64) -> Option<f64> {
    rate(cell, of).filter(|rate| *rate > 0.0).map(|rate| 1.0 / rate)
}

/// How many runs escaped, how many ended early, and why Kramers' rate does not hold.
fn described(table: &Table) -> String {
    let total = |name: &str| match table.column(name).map(|column| &column.values) {
        Some(Values::Counts(counts)) => counts.iter().flatten().sum::<u64>(),
        _ => 0,
    };
    let (runs, escaped, early) = (total("runs"), total("escaped"), total("ended_early"));
    let mut text = format!("{escaped} of {runs} run{} escaped", if runs == 1 { "" } else { "s" });
    if early > 0 {
        text += &format!(
            "; {early} ended before their time without an escape (they left the table of the force, or \
             used up a budget), so that the rate counts their time up to there"
        );
    }
    let fails = table.words("kramers_fails").iter().copied().filter(|word| !word.is_empty());
    let fails: Vec<&str> = fails.collect::<BTreeSet<&str>>().into_iter().collect();
    if !fails.is_empty() {
        let fails = fails.join(", ");
        text += &format!("; Kramers' rate does not hold: {fails} (see kramers_fails in docs/output.md)");
    }
    text
}

/// Checks a number of runs and their time in s.
pub(crate) fn check_runs(runs: u64, within: f64, grid: &Grid) -> Result<(), Error> {
    if !RUNS.contains(&runs) {
        return Err(Error::argument("runs", runs, format!("give 1 to {} runs", RUNS.end())));
    }
    let cells = grid.cells();
    let all = runs * cells;
    if all > MAX_RUNS {
        let problem =
            format!("makes {all} runs in {cells} cells; at most {MAX_RUNS} are possible: take fewer");
        return Err(Error::argument("runs", runs, problem));
    }
    let durations = field_info("run.duration_s").map(|field| field.range);
    if let Some(range) = durations.filter(|range| !range.contains(within)) {
        return Err(Error::number("within", within, format!("give a time in s, {range}")));
    }
    Ok(())
}

/// The scene of run number `run`, which ends at the time `within` in s.
pub(crate) fn prepared(scene: &Scene, run: u64, within: f64) -> Scene {
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
pub(crate) fn escape_fault(model: &Model, scene: &Scene) -> Option<Fault> {
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
pub(crate) fn waited(model: &Model, until: Until, cancel: &AtomicBool) -> Result<Waited, Cancelled> {
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
