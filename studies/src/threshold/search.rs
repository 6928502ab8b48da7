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

use crate::dynamics::{Model, Outcome, Regime, Run, Summary};
use crate::mechanics::Mechanism;
use crate::numeric::rounded;
use crate::scene::{Fault, Files, Scene, Start};
use crate::study::amplitudes::{Upward, frees_at};
use crate::study::bisection::{Trial, between, multiple, next_between};
use crate::study::settled::{followed, runs_from};
use crate::study::{
    Built, Cancelled, CellFaults, Cells, ColumnOf, Family, Heading, NoModel, Table, Task, column,
    excitation_fault,
};
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
/// it: [`windows`](Self::windows) counts where they end and begin again, within the scan or, of an amplitude
/// that is searched upward, within half the threshold above it.
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
    /// Number of changes of the answer above it.
    pub windows: u64,
    /// The value above which all tried values have the motion; `None` if the last does not have it.
    pub without_gap: Option<f64>,
    /// Distance of the values of the scan on both sides of it: a narrower window below may be missed. `None`
    /// for a closed form, and where the scan has no value on one side.
    pub step: Option<f64>,
    /// Its resolution, where it was bisected.
    pub resolution: Option<f64>,
}

/// What is searched for a threshold.
#[derive(Debug, Clone, PartialEq)]
pub enum Searched {
    /// The values of a scan.
    Scan(Scan),
    /// An amplitude of the drive from 0 upward, in steps that suit each scene.
    Upward {
        /// Dotted path of its field, one of [`Scene::amplitudes`].
        field: String,
        /// As in [`Scan`]; by default a thousandth of the first step.
        resolution: Option<f64>,
        /// As in [`Scan`].
        until_settled: Option<f64>,
    },
}

impl Searched {
    /// Dotted path of the searched field.
    pub fn field(&self) -> &str {
        match self {
            Self::Scan(scan) => &scan.field,
            Self::Upward { field, .. } => field,
        }
    }

    fn until_settled(&self) -> Option<f64> {
        match self {
            Self::Scan(scan) => scan.until_settled,
            Self::Upward { until_settled, .. } => *until_settled,
        }
    }

    /// Number of times that a search of one scene ticks.
    pub fn ticks(&self) -> u64 {
        match self {
            Self::Scan(scan) => scan.values.len() as u64,
            Self::Upward { .. } => 1,
        }
    }

    /// The values that may be tried of a scene first.
    fn values(&self, scene: &Scene, mechanism: &Mechanism) -> Vec<f64> {
        match self {
            Self::Scan(scan) => scan.values.clone(),
            Self::Upward { field, .. } => Upward::of(scene, mechanism, field).values,
        }
    }
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
    search.scanned(scene, mechanism, scan).ok()
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

/// The thresholds of every cell. Ticks [`Searched::ticks`] times for each. All cells are checked before the
/// first run.
pub(super) fn table(
    cells: &Cells,
    searched: &Searched,
    onset: Onset,
    pool: &Pool,
    task: &Task,
) -> Result<Table, NoThresholds> {
    cells.check(pool, task, |scene, mechanism| {
        let (trial, values) = (from_rest(scene), searched.values(scene, mechanism));
        faults(&trial, mechanism, &cells.files, (searched.field(), &values), |model| {
            let suits = onset != Onset::Interwell || model.repeats();
            (!suits).then(|| excitation_fault(&trial, NO_PERIOD.to_owned()))
        })
    })?;
    // with several cells, each runs on one thread
    let ahead = if cells.grid.cells() == 1 { pool.count() } else { 1 };
    let silent = Task { tick: &|| (), cancel: task.cancel };
    let of_cell = |scene: &Scene, built: Built, _: u64| {
        let Ok(mechanism) = built else {
            (0..searched.ticks()).for_each(|_| (task.tick)());
            return Ok(Found { undecided: true, ..Found::default() });
        };
        let trial = from_rest(scene);
        let family = Family::new(&trial, &cells.files, &mechanism, searched.field());
        let until_settled = searched.until_settled();
        let search = Search { family, onset, until_settled, task, pool: Some(pool), ahead };
        match searched {
            Searched::Scan(scan) => search.scanned(scene, &mechanism, scan),
            Searched::Upward { field, resolution, .. } => {
                let mut upward = Upward::of(scene, &mechanism, field);
                upward.resolution = resolution.unwrap_or(upward.resolution);
                let how = (&**field, &upward, Above::Searched);
                let found = Search { task: &silent, ..search }.upward(scene, &mechanism, how)?;
                (task.tick)();
                Ok(found)
            }
        }
    };
    let found = cells.map(1, pool, task, of_cell)?;
    Ok(cells.table().with_columns(&columns(onset), &found))
}

/// The columns and what they mean.
pub(super) fn headings() -> Vec<Heading> {
    columns(Onset::Crossing).into_iter().map(|column| column.heading).collect()
}

fn columns(onset: Onset) -> Vec<ColumnOf<'static, Found>> {
    vec![
        column("of", "`release`, `crossing` or `interwell`", move |_: &Found| onset.name()),
        column(
            "value",
            "the least value that does it, in the field's unit; empty where there is none in the range, and \
             standard error says of how many rows",
            |found: &Found| found.value,
        ),
        column(
            "low",
            "the last value below it, of those tried, that is known not to do it",
            |found: &Found| found.low,
        ),
        column(
            "high",
            "the first value from it on, of those tried, that is known to do it",
            |found: &Found| found.high,
        ),
        column(
            "undecided",
            "`true` where the answer at `value`, or just below it, is not known; where `value` is empty, \
             that at the end of the range. `low` and `high` then lie further apart than the resolution, or \
             one is empty",
            |found: &Found| Some(found.undecided),
        ),
        column(
            "windows",
            "how often the answer changes above `value`: twice for each gap, once more where it ends with no",
            |found: &Found| found.value.map(|_| found.windows),
        ),
        column(
            "step",
            "distance of the steps on both sides of `value`, between which it was bisected: a window below \
             it that is narrower can be missed; empty where the first step does it, or none",
            |found: &Found| found.step,
        ),
        column(
            "resolution",
            "that of the bisection, by default a thousandth of the (first) step; empty where nothing was \
             bisected",
            |found: &Found| found.resolution,
        ),
    ]
}

pub(crate) fn from_rest(scene: &Scene) -> Scene {
    Scene { start: Start::Rest, ..scene.clone() }
}

/// The faults at the first of these values of a field, if none gives a model in which `fault` finds none.
pub(crate) fn faults(
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    files: &Files,
    (field, values): (&str, &[f64]),
    fault: impl Fn(&Model) -> Option<Fault>,
) -> Option<Vec<Fault>> {
    let family = Family::new(scene, files, mechanism, field);
    let mut first = None;
    for value in values {
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
pub(crate) struct Answers {
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
            step: span.map(|(low, high)| rounded(high - low, DIGITS)),
            resolution: span.map(|_| rounded(resolution, DIGITS)),
        }
    }
}

/// Number of values that are run together before it is seen whether one of them has the motion.
const TOGETHER: usize = 32;

/// Number of steps above a threshold in which changes are searched.
const GAP_STEPS: u32 = 50;
/// Length of such a step, as a share of the threshold.
const GAP_STEP: f64 = 0.01;

/// Whether the range above a threshold is searched for windows, gaps and values known to have the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Above {
    Searched,
    Skipped,
}

/// Digits of a step and a resolution, which leave out the rounding of the difference of two values.
const DIGITS: usize = 12;

/// Number of runs under way on a thread from which further runs share their vector lanes.
const SHARING: usize = 5;
/// Number of values of a bisection that are then run at a time.
const SHARED_AHEAD: usize = 3;

pub(crate) struct Search<'a> {
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
    /// The value of `field` that releases the mass, where it has a closed form and that is what is searched.
    fn frees_at(&self, scene: &Scene, mechanism: &Mechanism, field: &str) -> Option<f64> {
        let drive = scene.harmonic().filter(|drive| drive.amplitude_path() == field)?;
        let frees = frees_at(scene, mechanism).filter(|_| self.onset == Onset::Release)?;
        Some(drive.amplitude_of(frees))
    }

    /// The threshold of `scene` with its `mechanism`; the family of models must be theirs.
    fn scanned(&self, scene: &Scene, mechanism: &Mechanism, scan: &Scan) -> Result<Found, Cancelled> {
        if let Some(frees) = self.frees_at(scene, mechanism, &scan.field)
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

    /// The threshold of `scene` with its `mechanism` in `field`, the field of the family of models, searched
    /// upward: the values above the first one with the motion are not tried, but for those within half of it.
    pub fn upward(
        &self,
        scene: &Scene,
        mechanism: &Mechanism,
        (field, upward, above): (&str, &Upward, Above),
    ) -> Result<Found, Cancelled> {
        if let Some(frees) = self.frees_at(scene, mechanism, field) {
            let all = Some(frees);
            return Ok(Found { value: all, low: all, high: all, without_gap: all, ..Found::default() });
        }
        let Upward { values, resolution } = upward;
        let mut answers = Answers::default();
        for part in values.chunks(TOGETHER) {
            self.scan(&mut answers, part, *resolution)?;
            if let Some(first) = answers.first_with_motion() {
                // values beyond the threshold are dropped, since their number depends on where a part ends
                answers.scan.truncate(first + 1);
                break;
            }
        }
        let found = answers.found(*resolution);
        let Some(value) = found.value.filter(|_| above == Above::Searched) else { return Ok(found) };
        let tried = (1..=GAP_STEPS).map(|i| multiple(value * (1.0 + GAP_STEP * f64::from(i)), *resolution));
        let mut tried: Vec<f64> = tried.collect();
        tried.dedup();
        let mut answers = Answers::begun_with(value);
        self.scan(&mut answers, &tried, *resolution)?;
        let Found { high, windows, without_gap, .. } = answers.found(*resolution);
        let high = [found.high, high].into_iter().flatten().reduce(f64::min);
        Ok(Found { high, windows, without_gap, ..found })
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

crate::study::words! {
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
    pub(crate) const NO_MODEL: Self = Self { does: false, known: false };
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
