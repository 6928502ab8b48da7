//! Thresholds: least values of a field from which on a motion from rest is released, crosses or is interwell.
//!
//! The values that do are no interval: without stops, and near a resonance, they come in windows. So nothing
//! is bisected before every step of a scan from below has been run; then the first step that changes the
//! answer is, and the changes above it are counted. Each run goes on until its motion repeats, so that a
//! crossing on the way to a motion that does not cross is no answer.

use std::sync::{Arc, Mutex, PoisonError};

use super::Task;
use super::bisection::{between, next_between};
use super::cell::CellFaults;
use super::family::Family;
use super::grid::Grid;
use super::push::{AMPLITUDE, frees_at};
use super::shared_runs::{runs_from, shared_runs};
use super::table::Table;
use crate::dynamics::{Model, Regime, Request, Run, Summary};
use crate::mechanics::{BuildError, Mechanism};
use crate::scene::{Fault, Files, Scene, Start};
use crate::system::threads::{Pool, Queue, UnderWay};

/// What begins at a threshold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Onset {
    /// The mass leaves the stop on which it rests.
    Release,
    /// The settled motion crosses the barrier at all.
    Crossing,
    /// The settled motion crosses, and its crossings repeat.
    Interwell,
}

impl Onset {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Release, Self::Crossing, Self::Interwell];

    /// The word on the command line and in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Release => "release",
            Self::Crossing => "crossing",
            Self::Interwell => "interwell",
        }
    }

    pub(super) fn is_in(self, summary: &Summary) -> bool {
        match self {
            Self::Release => summary.releases > 0,
            Self::Crossing => summary.crossings > 0 && summary.regime != Regime::OneWell,
            Self::Interwell => summary.regime == Regime::Interwell,
        }
    }
}

/// What a threshold is searched for over: the values of a scan, ascending, and how closely the first one is
/// located.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// Dotted path of the field.
    pub field: String,
    /// Its values, ascending.
    pub values: Vec<f64>,
    /// The threshold is located among the multiples of this, in the field's unit.
    pub resolution: f64,
}

/// A threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// The least value; none where no value of the scan does it.
    pub value: Option<f64>,
    /// How often the answer changes above it, within the scan.
    pub windows: u64,
    /// From this value of the scan on nothing changes any more: that of the last change upward; none where
    /// the scan ends with the answer no.
    pub without_gap: Option<f64>,
}

/// Forcing periods for which a run of a scan is followed until its motion repeats: some more than after which
/// irregular motion is called settled.
const PATIENCE: f64 = 250.0;

/// The time in s up to which a run is followed until its motion repeats.
pub(super) fn longest(model: &Model) -> f64 {
    model.duration() + PATIENCE * model.forcing_period().unwrap_or(0.0)
}

/// Runs the scan of `scene`, each run from rest. `mechanism` is the scene's own, built from `files`. None
/// where the search was cancelled.
///
/// A value that makes no valid model does not do it. A release under one sine that moves a mass from the stop
/// it is pressed on, over the amplitude, is known in closed form.
pub fn threshold(
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    files: &Files,
    (scan, onset): (&Scan, Onset),
    task: &Task,
) -> Option<Found> {
    threshold_on((None, 1), scene, mechanism, files, (scan, onset), task)
}

/// The same, by the threads of a pool; so many values of a bisection are asked at a time.
pub(super) fn threshold_on(
    (pool, ahead): (Option<&Pool>, usize),
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    files: &Files,
    (scan, onset): (&Scan, Onset),
    task: &Task,
) -> Option<Found> {
    let trial = from_rest(scene);
    let search = Search { pool, ahead, ..Search::new(&trial, mechanism, files, (scan, onset), task) };
    if onset == Onset::Release
        && scan.field == AMPLITUDE
        && let Some(value) = frees_at(scene, mechanism)
    {
        let inside = scan
            .values
            .first()
            .zip(scan.values.last())
            .filter(|(low, high)| value >= **low && value <= **high);
        let value = inside.map(|_| value);
        scan.values.iter().for_each(|_| (task.tick)());
        return Some(Found { value, windows: 0, without_gap: value });
    }
    let mut found = Found { value: None, windows: 0, without_gap: None };
    let (mut before, mut last) = (None, false);
    let mut asked = search.scan(scan)?;
    for (value, does) in scan.values.iter().zip(asked.of_scan.iter().map(|own| *own == Some(true))) {
        match (does, found.value) {
            (true, None) => {
                let located = match before {
                    Some(before) => search.locate(&mut asked.between, (before, *value), scan.resolution)?,
                    None => *value,
                };
                (found.value, found.without_gap) = (Some(located), Some(located));
            }
            (true, Some(_)) if !last => {
                found.windows += 1;
                found.without_gap = Some(*value);
            }
            (false, Some(_)) if last => found.windows += 1,
            _ => {}
        }
        (before, last) = (Some(*value), does);
    }
    found.without_gap = found.without_gap.filter(|_| last);
    Some(found)
}

/// The thresholds of every cell of `grid` over `scene`, in order: the swept fields, then `of,value,windows`.
/// A value that is not found is missing, as is that of a cell whose mechanism is not solved. Ticks as often
/// as there are cells and values of the scan. An error has every cell in which no value makes a valid model,
/// or for interwell motion none under a drive that repeats, and then nothing has been run. None where the
/// search was cancelled.
pub fn threshold_table(
    (scene, files): (&Scene, &Files),
    grid: Option<&Grid>,
    asked: (&Scan, Onset),
    pool: &Pool,
    task: &Task,
) -> Option<Result<Table, Vec<CellFaults>>> {
    let cells = grid.map_or(1, Grid::cells) as usize;
    let one = grid.is_none_or(|grid| !grid.changes_mechanism()).then(|| build(scene, files));
    let prepared = |scene: &mut Scene, index: usize| {
        grid.inspect(|grid| grid.apply(index as u64, scene));
        one.clone().unwrap_or_else(|| build(scene, files))
    };
    let check = |scene: &mut Scene, index: usize| {
        if task.is_cancelled() {
            return Err(());
        }
        let faults = match prepared(scene, index) {
            Ok(mechanism) => {
                let trial = from_rest(scene);
                Search::new(&trial, &mechanism, files, asked, task).faults(&asked.0.values)
            }
            Err(BuildError::Unsolved(_)) => return Ok(None),
            Err(BuildError::Wrong(fault)) => Some(vec![fault]),
        };
        let cell = || grid.map_or_else(String::new, |grid| grid.describe(index as u64));
        Ok(faults.map(|faults| CellFaults { cell: cell(), faults }))
    };
    let wrong: Vec<CellFaults> =
        pool.map(cells, || scene.clone(), check).ok()?.into_iter().flatten().collect();
    if !wrong.is_empty() {
        return Some(Err(wrong));
    }
    // of several cells each has a thread of its own
    let ahead = if cells == 1 { pool.count() } else { 1 };
    let cell = |scene: &mut Scene, index: usize| match prepared(scene, index) {
        Ok(mechanism) => threshold_on((Some(pool), ahead), scene, &mechanism, files, asked, task).ok_or(()),
        Err(_) => {
            asked.0.values.iter().for_each(|_| (task.tick)());
            Ok(Found { value: None, windows: 0, without_gap: None })
        }
    };
    let found = pool.map(cells, || scene.clone(), cell).ok()?;
    let mut table = Table::new();
    for (place, column) in grid.iter().flat_map(|grid| grid.columns()).enumerate() {
        let value = |index: u64| grid.and_then(|grid| grid.values(index).nth(place)).unwrap_or(f64::NAN);
        table = table.with(column, (0..cells as u64).map(value).collect());
    }
    Some(Ok(table
        .each("of", &found, |_| asked.1.name())
        .each("value", &found, |own| own.value.unwrap_or(f64::NAN))
        .each("windows", &found, |own| own.value.map(|_| own.windows))))
}

fn build(scene: &Scene, files: &Files) -> Result<Arc<Mechanism>, BuildError> {
    Mechanism::build(&scene.mechanism, files).map(Arc::new)
}

fn from_rest(scene: &Scene) -> Scene {
    Scene { start: Start::Rest, ..scene.clone() }
}

/// Runs that a thread has under way from which on a further one shares their lanes, and values of a bisection
/// that are then asked at a time.
const COMPANY: usize = 5;
const IN_COMPANY: usize = 3;

/// What is known of the values of a scan and of those of the bisection at its first change, which come in the
/// order in which they were asked: no answer where a run is under way.
struct Asked {
    of_scan: Vec<Option<bool>>,
    between: Vec<(f64, Option<bool>)>,
}

impl Asked {
    /// The values of the scan between which the answer changes first, once nothing below is open.
    fn first_change(&self, values: &[f64]) -> Option<(f64, f64)> {
        let first = self.of_scan.iter().position(|own| *own != Some(false)).filter(|first| *first > 0)?;
        (self.of_scan[first] == Some(true)).then(|| (values[first - 1], values[first]))
    }
}

struct Search<'a> {
    trial: &'a Scene,
    family: Family<'a>,
    onset: Onset,
    task: &'a Task<'a>,
    pool: Option<&'a Pool>,
    /// Values of a bisection that are asked at a time, by themselves.
    ahead: usize,
}

impl<'a> Search<'a> {
    fn new(
        trial: &'a Scene,
        mechanism: &'a Arc<Mechanism>,
        files: &'a Files,
        (scan, onset): (&Scan, Onset),
        task: &'a Task<'a>,
    ) -> Self {
        let family = Family::new(trial, files, mechanism, &scan.field);
        Self { trial, family, onset, task, pool: None, ahead: 1 }
    }

    /// Runs the scan, and what can be asked meanwhile of the bisection that follows it: in the lanes it takes
    /// little more time.
    fn scan(&self, scan: &Scan) -> Option<Asked> {
        let Scan { values, resolution, .. } = scan;
        let queue = Queue::new(values.len(), self.pool.map_or(1, Pool::count));
        let asked = Mutex::new(Asked { of_scan: vec![None; values.len()], between: Vec::new() });
        let lock = || asked.lock().unwrap_or_else(PoisonError::into_inner);
        let take = |held: UnderWay| {
            let ahead = match held.runs {
                0 => self.ahead,
                COMPANY.. => self.ahead.max(IN_COMPANY),
                _ => 1,
            };
            let mut own = lock();
            let span = own.first_change(values);
            let Some(next) = span.and_then(|span| next_between(&own.between, span, *resolution, ahead))
            else {
                return queue.take(held);
            };
            own.between.push((next, None));
            Some(values.len() + own.between.len() - 1)
        };
        let told = |number: usize, does: bool| match number.checked_sub(values.len()) {
            Some(place) => lock().between[place].1 = Some(does),
            None => {
                lock().of_scan[number] = Some(does);
                (self.task.tick)();
            }
        };
        let model = |number: usize| {
            let value = values.get(number).copied();
            let value = value.unwrap_or_else(|| lock().between[number - values.len()].0);
            self.model(value).ok_or_else(|| told(number, false))
        };
        let does = |number: usize, run: &Run| told(number, self.onset.is_in(&run.summary));
        runs_from(self.pool, self.task, &take, model, does)?;
        Some(asked.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// Which of the values do it.
    fn ask(&self, values: &[f64]) -> Option<Vec<bool>> {
        let model = |number: usize| self.model(values[number]).ok_or(false);
        let does = |run: &Run| self.onset.is_in(&run.summary);
        shared_runs(self.pool, self.task, values.len(), model, does)
    }

    /// The model of a value, where there is one, and what is asked of it.
    fn model(&self, value: f64) -> Option<(Model, Request<'a>)> {
        let model = self.family.model(value).ok()?;
        let until_settled = Some(longest(&model));
        Some((model, Request { until_settled, ..Request::default() }))
    }

    /// The faults of the model at the first of the values, where none of them makes one that can do it.
    fn faults(&self, values: &[f64]) -> Option<Vec<Fault>> {
        let mut first = None;
        for value in values {
            let faults = match self.family.model(*value) {
                Ok(model) if self.onset != Onset::Interwell || model.repeats() => return None,
                Ok(_) => vec![self.no_period()],
                Err(faults) if faults.is_empty() => return None,
                Err(faults) => faults,
            };
            first = first.or(Some(faults));
        }
        first
    }

    fn no_period(&self) -> Fault {
        let kind = format!("{:?}", self.trial.excitation);
        let kind = kind.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default().to_owned();
        let problem = "does not repeat, so no motion can be said to repeat with it (interwell): ask for \
                       crossing, or take a Sine, or a Sum of sines whose frequencies have a common period";
        Fault { field: "excitation".into(), value: kind, problem: problem.into() }
    }

    /// The least multiple of the resolution, as far as bisection tells, that does it, between a value that
    /// does not and one that does; of some it may be known.
    fn locate(&self, asked: &mut Vec<(f64, Option<bool>)>, span: (f64, f64), resolution: f64) -> Option<f64> {
        loop {
            let known = asked.len();
            while let Some(next) = next_between(asked, span, resolution, self.ahead) {
                asked.push((next, None));
            }
            let next: Vec<f64> = asked[known..].iter().map(|own| own.0).collect();
            if next.is_empty() {
                break;
            }
            let does = self.ask(&next)?;
            asked[known..].iter_mut().zip(does).for_each(|(own, does)| own.1 = Some(does));
        }
        let (mut low, mut high) = span;
        while let Some(middle) = between(low, high, resolution) {
            match asked.contains(&(middle, Some(true))) {
                true => high = middle,
                false => low = middle,
            }
        }
        Some(high)
    }
}
