//! Thresholds: least values of a field from which on a motion from rest is released, crosses or is interwell.
//!
//! These values form no interval: without stops, and near a resonance, they come in windows. So every step of
//! a scan from below is run first; then the first step that changes the answer is bisected, and the changes
//! above it are counted. Each run is followed until its motion repeats, so that a crossing on the way to a
//! motion that does not cross is no answer. If it does not repeat in time, the bisection uses what it does at
//! the end of that time, and `low` and `high` are the nearest values whose answers are known.

use std::sync::{Arc, Mutex, PoisonError};

use super::amplitudes::{AMPLITUDE, frees_at};
use super::bisection::{Trial, between, next_between};
use super::grid_study::Cells;
use super::settled::{followed, runs_from};
use super::walk::excitation_fault;
use super::{Cancelled, CellFaults, Family, Grid, NoModel, Table, Task};
use crate::dynamics::{Outcome, Regime, Run, Summary};
use crate::mechanics::{BuildError, Mechanism};
use crate::scene::{Fault, Files, Scene, Start};
use crate::system::threads::{Pool, Queue, UnderWay};

/// Scan for a threshold: the values of a field, ascending, and the resolution of the threshold.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// Dotted path of the field.
    pub field: String,
    /// Its values, ascending.
    pub values: Vec<f64>,
    /// The threshold is located among the multiples of this, in the field's unit.
    pub resolution: f64,
    /// Time in s up to which runs go on until they repeat; by default 1000 forcing periods beyond the run.
    pub until_settled: Option<f64>,
}

/// A threshold.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Found {
    /// The least value; `None` if no value of the scan does it.
    pub value: Option<f64>,
    /// The last value below it, of those tried, that is known not to do it.
    pub low: Option<f64>,
    /// The first value from it on, of those tried, that is known to do it.
    pub high: Option<f64>,
    /// Whether the answer just below the value, or at it, is unknown; without a value, at the scan's end.
    pub undecided: bool,
    /// How often the answer changes above it, within the scan.
    pub windows: u64,
    /// The value from which on the answer stays yes; `None` if the scan ends with no.
    pub without_gap: Option<f64>,
}

/// Runs the scan of `scene` with its `mechanism` from `files`, each run from rest. `None` if cancelled.
///
/// A value that makes no valid model does not do it. A release under one sine, over the amplitude, is known
/// in closed form: exactly there the mass is not released yet, so that value is also the last one below.
pub fn threshold(
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    files: &Files,
    scan: &Scan,
    onset: Onset,
    task: &Task,
) -> Option<Found> {
    let trial = from_rest(scene);
    let family = Family::new(&trial, files, mechanism, &scan.field);
    let search = Search { family, onset, until_settled: scan.until_settled, task, pool: None, ahead: 1 };
    search.found(scene, mechanism, scan).ok()
}

/// Why there is no table of thresholds.
#[derive(Debug, Clone, PartialEq)]
pub enum NoThresholds {
    /// It was told to stop.
    Cancelled,
    /// In these cells no value makes a valid model, for interwell motion one with a drive that repeats.
    Wrong(Vec<CellFaults>),
}

/// The thresholds of every cell of `grid`: the swept fields, then `of,value,low,high,undecided,windows`. A
/// value is missing if it is not found or the mechanism is not solved. Ticks for each value of the scan in
/// each cell. If cells are wrong, nothing has been run.
pub fn threshold_table(
    scene: &Scene,
    files: &Files,
    grid: &Grid,
    scan: &Scan,
    onset: Onset,
    pool: &Pool,
    task: &Task,
) -> Result<Table, NoThresholds> {
    let cells = Cells::new(scene, files, grid.clone());
    let count = grid.cells() as usize;
    let begin = || cells.base.clone();
    let check = |scene: &mut Scene, index: usize| {
        task.go_on()?;
        let built = cells.mechanism(index as u64, scene, task.cancel).ok_or(Cancelled)?;
        let faults = match built {
            Ok(mechanism) => faults(&from_rest(scene), &mechanism, files, scan, onset),
            Err(BuildError::Unsolved(_)) => None,
            Err(BuildError::Wrong(fault)) => Some(vec![fault]),
        };
        Ok(faults.map(|faults| CellFaults { cell: grid.describe(index as u64), faults }))
    };
    let cancelled = |Cancelled| NoThresholds::Cancelled;
    let wrong: Vec<CellFaults> =
        pool.map(count, begin, check).map_err(cancelled)?.into_iter().flatten().collect();
    if !wrong.is_empty() {
        return Err(NoThresholds::Wrong(wrong));
    }
    // several cells have a thread each
    let ahead = if count == 1 { pool.count() } else { 1 };
    let cell = |scene: &mut Scene, index: usize| {
        let built = cells.mechanism(index as u64, scene, task.cancel).ok_or(Cancelled)?;
        let Ok(mechanism) = built else {
            scan.values.iter().for_each(|_| (task.tick)());
            return Ok(Found { undecided: true, ..Found::default() });
        };
        let trial = from_rest(scene);
        let family = Family::new(&trial, files, &mechanism, &scan.field);
        let until_settled = scan.until_settled;
        let search = Search { family, onset, until_settled, task, pool: Some(pool), ahead };
        search.found(scene, &mechanism, scan)
    };
    let found = pool.map(count, begin, cell).map_err(cancelled)?;
    Ok(grid
        .table(|| 0..grid.cells())
        .each("of", &found, |_| onset.name())
        .each("value", &found, |found| found.value)
        .each("low", &found, |found| found.low)
        .each("high", &found, |found| found.high)
        .each("undecided", &found, |found| Some(found.undecided))
        .each("windows", &found, |found| found.value.map(|_| found.windows)))
}

fn from_rest(scene: &Scene) -> Scene {
    Scene { start: Start::Rest, ..scene.clone() }
}

/// The faults at the first value of the scan, if no value makes a model that can do it.
fn faults(
    trial: &Scene,
    mechanism: &Arc<Mechanism>,
    files: &Files,
    scan: &Scan,
    onset: Onset,
) -> Option<Vec<Fault>> {
    let family = Family::new(trial, files, mechanism, &scan.field);
    let mut first = None;
    for value in &scan.values {
        let faults = match family.model(*value) {
            Ok(model) if onset != Onset::Interwell || model.repeats() => return None,
            Ok(_) => vec![excitation_fault(trial, NO_PERIOD.to_owned())],
            Err(NoModel::NoField | NoModel::Unsolved) => return None,
            Err(NoModel::Faults(faults)) => faults,
        };
        first = first.or(Some(faults));
    }
    first
}

const NO_PERIOD: &str = "does not repeat, so no motion can be said to repeat with it (interwell): ask for \
                         crossing, or take a Sine, or a Sum of sines whose frequencies have a common period";

/// A value of the field and the verdict of its run; `None` while it is not known.
type Answer = (f64, Option<Verdict>);

/// What is known of a scan and of the bisection at its first change.
#[derive(Default)]
pub(super) struct Answers {
    /// The values of the scan, ascending.
    pub scan: Vec<Answer>,
    /// Those of the bisection, in the order in which they were begun.
    between: Vec<Answer>,
    /// How many values of the scan, from the first on, are known not to do it.
    below: usize,
}

impl Answers {
    /// Of a scan that begins with a value that does it.
    pub fn begun_with(value: f64) -> Self {
        let verdict = Verdict { does: true, known: false };
        Self { scan: vec![(value, Some(verdict))], ..Self::default() }
    }

    /// A value by its number: those of the scan first, then those of the bisection.
    fn number(&mut self, number: usize) -> &mut Answer {
        match number.checked_sub(self.scan.len()) {
            Some(place) => &mut self.between[place],
            None => &mut self.scan[number],
        }
    }

    /// The place in the scan of the first value that does it.
    pub fn first_that_does(&self) -> Option<usize> {
        self.scan.iter().position(|(_, verdict)| verdict.is_some_and(|verdict| verdict.does))
    }

    /// The values of the scan between which the answer changes first, once all below are known.
    fn first_change(&mut self) -> Option<(f64, f64)> {
        let does = |answer: &Answer| answer.1.map(|verdict| verdict.does);
        self.below += self.scan[self.below..].iter().take_while(|answer| does(answer) == Some(false)).count();
        let (below, above) = (self.scan.get(self.below.checked_sub(1)?)?, self.scan.get(self.below)?);
        does(above)?.then_some((below.0, above.0))
    }

    /// The next value that is to be asked of the bisection at the first change.
    fn next_between(&mut self, resolution: f64, ahead: usize) -> Option<f64> {
        let span = self.first_change()?;
        let trial = |value: f64| match self.between.iter().find(|answer| answer.0 == value) {
            None => Trial::NotBegun,
            Some((_, None)) => Trial::UnderWay,
            Some((_, Some(verdict))) => Trial::Known(verdict.does),
        };
        next_between(trial, span, resolution, ahead)
    }

    /// The result of the scan and its bisection, once all is known.
    pub fn found(mut self, resolution: f64) -> Found {
        let mut tried: Vec<(f64, Verdict)> = Vec::with_capacity(self.scan.len());
        tried.extend(self.scan.iter().filter_map(|(value, verdict)| Some((*value, (*verdict)?))));
        let changes = tried.windows(2).skip(self.below).filter(|pair| pair[0].1.does != pair[1].1.does);
        let last_up = changes.clone().next_back().map(|pair| pair[1].0);
        let windows = changes.count() as u64;
        let ends_with_yes = tried.last().is_some_and(|(_, verdict)| verdict.does);
        // values asked ahead are left out, since they depend on the number of threads
        let span = self.first_change();
        let mut place = self.below;
        let (mut low, mut high) = span.unwrap_or_default();
        while span.is_some()
            && let Some(middle) = between(low, high, resolution)
            && let Some((_, Some(verdict))) = self.between.iter().find(|answer| answer.0 == middle)
        {
            tried.insert(place, (middle, *verdict));
            match verdict.does {
                true => high = middle,
                false => (low, place) = (middle, place + 1),
            }
        }
        let (below, above) = tried.split_at(place);
        let known = |does: bool| move |tried: &&(f64, Verdict)| tried.1 == Verdict { does, known: true };
        let value = above.first().map(|(value, _)| *value);
        Found {
            value,
            low: below.iter().rfind(known(false)).map(|(value, _)| *value),
            high: above.iter().find(known(true)).map(|(value, _)| *value),
            undecided: [below.last(), above.first()].into_iter().flatten().any(|(_, verdict)| !verdict.known),
            windows,
            without_gap: last_up.or(value).filter(|_| ends_with_yes),
        }
    }
}

/// Runs under way on a thread from which on a further one shares their lanes.
const SHARING: usize = 5;
/// Values of a bisection that are then asked at a time.
const SHARED_AHEAD: usize = 3;

/// A search over the values of a field.
pub(super) struct Search<'a> {
    pub family: Family<'a>,
    pub onset: Onset,
    /// As in [`Scan`].
    pub until_settled: Option<f64>,
    pub task: &'a Task<'a>,
    pub pool: Option<&'a Pool>,
    /// Values of a bisection that are asked at a time by a thread without other runs.
    pub ahead: usize,
}

impl Search<'_> {
    /// The threshold of `scene` with its `mechanism`, to which the family of models belongs.
    fn found(&self, scene: &Scene, mechanism: &Mechanism, scan: &Scan) -> Result<Found, Cancelled> {
        if self.onset == Onset::Release
            && scan.field == AMPLITUDE
            && let Some(frees) = frees_at(scene, mechanism)
            && let (Some(&first), Some(&last)) = (scan.values.first(), scan.values.last())
            && first > -frees
        {
            scan.values.iter().for_each(|_| (self.task.tick)());
            let value = Some(frees.max(first)).filter(|value| *value <= last);
            let low = (frees >= first).then(|| frees.min(last));
            return Ok(Found { value, low, high: value, without_gap: value, ..Found::default() });
        }
        let mut answers = Answers::default();
        self.scan(&mut answers, &scan.values, scan.resolution)?;
        Ok(answers.found(scan.resolution))
    }

    /// Runs further values of a scan, and beside them values of the bisection at its first change, which take
    /// little more time in the same lanes. Then completes the bisection. Ticks for each value of the scan.
    pub fn scan(&self, answers: &mut Answers, values: &[f64], resolution: f64) -> Result<(), Cancelled> {
        let first = answers.scan.len();
        answers.scan.extend(values.iter().map(|value| (*value, None)));
        let count = answers.scan.len();
        let queue = Queue::new(values.len(), self.pool.map_or(1, Pool::count));
        let shared = Mutex::new(answers);
        let lock = || shared.lock().unwrap_or_else(PoisonError::into_inner);
        let take = |under_way: UnderWay| {
            let ahead = match under_way.runs {
                0 => self.ahead,
                SHARING.. => self.ahead.max(SHARED_AHEAD),
                _ => 1,
            };
            let mut answers = lock();
            let Some(next) = answers.next_between(resolution, ahead) else {
                return queue.take(under_way).map(|number| first + number);
            };
            answers.between.push((next, None));
            Some(count + answers.between.len() - 1)
        };
        let answer = |number: usize, verdict: Verdict| {
            lock().number(number).1 = Some(verdict);
            if number < count {
                (self.task.tick)();
            }
        };
        let model = |number: usize| {
            let value = lock().number(number).0;
            let model = self.family.model(value).map_err(|_| answer(number, Verdict::NO_MODEL))?;
            Ok(followed(model, self.until_settled))
        };
        let ended = |number: usize, run: &Run| answer(number, self.onset.verdict(&run.summary));
        loop {
            runs_from(self.pool, self.task, &take, model, ended).ok_or(Cancelled)?;
            if lock().next_between(resolution, 1).is_none() {
                return Ok(());
            }
        }
    }
}

words! {
    /// What begins at a threshold.
    Onset {
        /// The mass leaves the stop on which it rests.
        Release = "release",
        /// The settled motion crosses the barrier at all.
        Crossing = "crossing",
        /// The settled motion crosses, and its crossings repeat.
        Interwell = "interwell",
    }
}

/// Verdict of a run on an onset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Verdict {
    /// Whether the motion does it in the last window of the run.
    pub does: bool,
    /// Whether it goes on so: the motion repeats or rests. A motion that does not, up to the end of the time
    /// for which it is followed, may be a transient: one that crosses may stay in one well later, and one in
    /// one well may cross later. Under a drive that does not repeat, the verdict is about the run itself.
    pub known: bool,
}

impl Verdict {
    /// Of a value that makes no valid model.
    pub(super) const NO_MODEL: Self = Self { does: false, known: false };
}

impl Onset {
    /// The verdict of the run with this summary.
    pub fn verdict(self, summary: &Summary) -> Verdict {
        let does = match self {
            Self::Release => summary.releases > 0,
            Self::Crossing => summary.crossings > 0 && summary.regime != Regime::OneWell,
            Self::Interwell => summary.regime == Regime::Interwell,
        };
        Verdict { does, known: goes_on_so(summary) }
    }
}

/// Whether what a run did in its last window is what the motion does from then on: it repeats or rests, or
/// the drive has no period and nothing is asked beyond the run.
fn goes_on_so(summary: &Summary) -> bool {
    let within_the_run = summary.settled.is_none() || summary.periods == 0;
    summary.outcome == Outcome::Done && (summary.settled == Some(true) || within_the_run)
}
