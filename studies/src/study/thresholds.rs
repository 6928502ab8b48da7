//! Thresholds: the smallest values of a field at which a motion from rest is released, crosses or is
//! interwell.
//!
//! The values with such motions need not form an interval: without stops, and near a resonance, there are
//! windows. So all values of a scan are run first; then the first interval in which the answer changes is
//! bisected, and the changes above it are counted. Each run continues until its motion repeats, so that a
//! crossing during the transient does not count. If the motion does not repeat in time, the bisection uses
//! its last window, and `low` and `high` are the nearest values with a known answer.

use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use super::amplitudes::frees_at;
use super::bisection::{Trial, between, next_between};
use super::grid_study::{Built, Cells};
use super::settled::{followed, runs_from};
use super::walk::excitation_fault;
use super::{Cancelled, CellFaults, Family, NoModel, Table, Task};
use crate::dynamics::{Model, Outcome, Regime, Run, Summary};
use crate::mechanics::Mechanism;
use crate::scene::{Fault, Files, Scene, Start};
use crate::system::threads::{Pool, Queue, UnderWay};

/// The values that are tried for a threshold, and its resolution.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// Dotted path of the field.
    pub field: String,
    /// Its values, ascending.
    pub values: Vec<f64>,
    /// Resolution in the unit of the field: the threshold is a multiple of it.
    pub resolution: f64,
    /// Time in s up to which runs continue until they repeat; by default 1000 forcing periods beyond the run.
    pub until_settled: Option<f64>,
}

/// A threshold.
///
/// Values are in the unit of the searched field. The motions that begin at a threshold need not go on above
/// it: [`windows`](Self::windows) counts where they end and begin again.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Found {
    /// The smallest value with the motion; `None` if no value of the scan has it.
    pub value: Option<f64>,
    /// The largest tried value below it whose motion is known to be different.
    pub low: Option<f64>,
    /// The smallest tried value, from it on, that is known to have the motion.
    pub high: Option<f64>,
    /// Whether the answer at the value or just below it is unknown; without a value, at the end of the scan.
    pub undecided: bool,
    /// Number of changes of the answer above it, within the scan.
    pub windows: u64,
    /// The value above which the whole scan has the motion; `None` if its last value does not have it.
    pub without_gap: Option<f64>,
}

/// The threshold of `scene` with its `mechanism` from `files`; all runs begin at rest. `None` if cancelled.
///
/// A value without a valid model counts as one without the motion. The release under one sine, over its
/// amplitude, has a closed form; exactly at that amplitude the mass is not yet released, so it is also `low`.
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

/// Why there is no table of thresholds or of escapes.
#[derive(Debug, Clone, PartialEq)]
pub enum NoThresholds {
    /// It was cancelled.
    Cancelled,
    /// Cells in which no value gives a valid model, or none that can have the motion: whose drive repeats,
    /// for interwell motion, or is a noise, for an escape.
    Wrong(Vec<CellFaults>),
}

impl From<Cancelled> for NoThresholds {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// The thresholds of every cell, with the columns of [`Threshold`](crate::questions::Threshold).
/// Ticks for each value of the scan in each cell. All cells are checked before the first run.
pub fn threshold_table(
    cells: &Cells,
    scan: &Scan,
    onset: Onset,
    pool: &Pool,
    task: &Task,
) -> Result<Table, NoThresholds> {
    cells.check(pool, task, |scene, mechanism| {
        let trial = from_rest(scene);
        faults(&trial, mechanism, &cells.files, scan, |model| {
            let suits = onset != Onset::Interwell || model.repeats();
            (!suits).then(|| excitation_fault(&trial, NO_PERIOD.to_owned()))
        })
    })?;
    // with several cells, each runs on one thread
    let ahead = if cells.grid.cells() == 1 { pool.count() } else { 1 };
    let of_cell = |scene: &Scene, built: Built, _: u64| {
        let Ok(mechanism) = built else {
            scan.values.iter().for_each(|_| (task.tick)());
            return Ok(Found { undecided: true, ..Found::default() });
        };
        let trial = from_rest(scene);
        let family = Family::new(&trial, &cells.files, &mechanism, &scan.field);
        let until_settled = scan.until_settled;
        let search = Search { family, onset, until_settled, task, pool: Some(pool), ahead };
        search.found(scene, &mechanism, scan)
    };
    let found = cells.map(1, pool, task, of_cell)?;
    Ok(cells
        .table()
        .each("of", &found, |_| onset.name())
        .each("value", &found, |found| found.value)
        .each("low", &found, |found| found.low)
        .each("high", &found, |found| found.high)
        .each("undecided", &found, |found| Some(found.undecided))
        .each("windows", &found, |found| found.value.map(|_| found.windows)))
}

pub(super) fn from_rest(scene: &Scene) -> Scene {
    Scene { start: Start::Rest, ..scene.clone() }
}

/// The faults at the first value of the scan, if no value gives a model in which `fault` finds none.
pub(super) fn faults(
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    files: &Files,
    scan: &Scan,
    fault: impl Fn(&Model) -> Option<Fault>,
) -> Option<Vec<Fault>> {
    let family = Family::new(scene, files, mechanism, &scan.field);
    let mut first = None;
    for value in &scan.values {
        let faults = match family.model(*value) {
            Ok(model) => vec![fault(&model)?],
            Err(NoModel::NoField | NoModel::Unsolved) => return None,
            Err(NoModel::Faults(faults)) => faults,
        };
        first = first.or(Some(faults));
    }
    first
}

const NO_PERIOD: &str = "does not repeat, so no motion can be said to repeat with it (interwell): ask for \
                         crossing, or take a Sine, or a Sum of sines whose frequencies have a common period";

/// A value of the field and the verdict on its run; `None` until the run has ended.
type Answer = (f64, Option<Verdict>);

/// The answers of a scan and of the bisection at its first change.
#[derive(Default)]
pub(super) struct Answers {
    /// The values of the scan, ascending.
    pub scan: Vec<Answer>,
    /// The values of the bisection, in the order in which they were begun.
    between: Vec<Answer>,
    /// Number of values at the beginning of the scan without the motion.
    below: usize,
}

impl Answers {
    /// The answers of a scan whose first value has the motion.
    pub fn begun_with(value: f64) -> Self {
        let verdict = Verdict { does: true, known: false };
        Self { scan: vec![(value, Some(verdict))], ..Self::default() }
    }

    /// The answer with this index: first those of the scan, then those of the bisection.
    fn number(&mut self, number: usize) -> &mut Answer {
        match number.checked_sub(self.scan.len()) {
            Some(place) => &mut self.between[place],
            None => &mut self.scan[number],
        }
    }

    /// Index in the scan of the first value with the motion.
    pub fn first_with_motion(&self) -> Option<usize> {
        self.scan.iter().position(|(_, verdict)| verdict.is_some_and(|verdict| verdict.does))
    }

    /// The two values of the scan between which the answer changes first; `None` until all below are known.
    fn first_change(&mut self) -> Option<(f64, f64)> {
        let does = |answer: &Answer| answer.1.map(|verdict| verdict.does);
        self.below += self.scan[self.below..].iter().take_while(|answer| does(answer) == Some(false)).count();
        let (below, above) = (self.scan.get(self.below.checked_sub(1)?)?, self.scan.get(self.below)?);
        does(above)?.then_some((below.0, above.0))
    }

    /// The next value to run for the bisection at the first change.
    fn next_between(&mut self, resolution: f64, ahead: usize) -> Option<f64> {
        let span = self.first_change()?;
        let trial = |value: f64| match self.between.iter().find(|answer| answer.0 == value) {
            None => Trial::NotBegun,
            Some((_, None)) => Trial::UnderWay,
            Some((_, Some(verdict))) => Trial::Known(verdict.does),
        };
        next_between(trial, span, resolution, ahead)
    }

    /// The threshold, when scan and bisection are complete.
    pub fn found(mut self, resolution: f64) -> Found {
        let mut tried: Vec<(f64, Verdict)> = Vec::with_capacity(self.scan.len());
        tried.extend(self.scan.iter().filter_map(|(value, verdict)| Some((*value, (*verdict)?))));
        let changes = tried.windows(2).skip(self.below).filter(|pair| pair[0].1.does != pair[1].1.does);
        let last_up = changes.clone().next_back().map(|pair| pair[1].0);
        let windows = changes.count() as u64;
        let ends_with_yes = tried.last().is_some_and(|(_, verdict)| verdict.does);
        // values that were run ahead are left out, since they depend on the number of threads
        let span = self.first_change();
        let mut place = self.below;
        let (mut low, mut high) = span.unwrap_or_default();
        while span.is_some()
            && let Some(middle) = between(low, high, resolution)
            && let Some((_, Some(verdict))) = self.between.iter().find(|answer| answer.0 == middle)
        {
            tried.insert(place, (middle, *verdict));
            if verdict.does { high = middle } else { (low, place) = (middle, place + 1) }
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

/// Number of runs under way on a thread from which further runs share their vector lanes.
const SHARING: usize = 5;
/// Number of values of a bisection that are then run at a time.
const SHARED_AHEAD: usize = 3;

pub(super) struct Search<'a> {
    pub family: Family<'a>,
    pub onset: Onset,
    /// As in [`Scan`].
    pub until_settled: Option<f64>,
    pub task: &'a Task<'a>,
    pub pool: Option<&'a Pool>,
    /// Number of values of a bisection that a thread without other runs runs at a time.
    pub ahead: usize,
}

impl Search<'_> {
    /// The threshold of `scene` with its `mechanism`; the family of models must be theirs.
    fn found(&self, scene: &Scene, mechanism: &Mechanism, scan: &Scan) -> Result<Found, Cancelled> {
        if self.onset == Onset::Release
            && let Some(drive) = scene.harmonic().filter(|drive| drive.amplitude_path() == scan.field)
            && let Some(frees) =
                frees_at(scene, mechanism).map(|acceleration| drive.amplitude_of(acceleration))
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

    /// Runs further values of a scan, and in free vector lanes values of the bisection at its first change.
    /// Then completes the bisection. Ticks for each value of the scan.
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
        /// The settled motion crosses the barrier.
        Crossing = "crossing",
        /// The settled motion crosses, and its crossings repeat.
        Interwell = "interwell",
    }
}

/// Whether a run shows an onset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Verdict {
    /// Whether the motion in the last window of the run shows it.
    pub does: bool,
    /// Whether this is known to be permanent: the motion repeats or rests. Otherwise the motion may be a
    /// transient: it may stop crossing later, or begin to cross. Under a drive that does not repeat, the
    /// verdict applies to the run itself.
    pub known: bool,
}

impl Verdict {
    pub(super) const NO_MODEL: Self = Self { does: false, known: false };
}

impl Onset {
    /// The verdict on the run with this summary.
    pub fn verdict(self, summary: &Summary) -> Verdict {
        let does = match self {
            Self::Release => summary.releases > 0,
            Self::Crossing => summary.crossings > 0 && summary.regime != Regime::OneWell,
            Self::Interwell => summary.regime == Regime::Interwell,
        };
        Verdict { does, known: is_permanent(summary) }
    }
}

/// Whether the motion in the last window of a run is permanent: it repeats or rests, or the drive has no
/// period and only the run itself counts.
fn is_permanent(summary: &Summary) -> bool {
    let within_the_run = summary.settled.is_none() || summary.periods == 0;
    summary.outcome == Outcome::Done && (summary.settled == Some(true) || within_the_run)
}
