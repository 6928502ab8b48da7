//! Thresholds: least values of a field from which on a motion from rest is released, crosses or is interwell.
//!
//! The values that do are no interval: without stops, and near a resonance, they come in windows. So nothing
//! is bisected before every step of a scan from below has been run; then the first step that changes the
//! answer is, and the changes above it are counted. Each run goes on until its motion repeats, so that a
//! crossing on the way to a motion that does not cross is no answer.

use std::sync::Arc;

use super::Task;
use super::grid::Grid;
use super::sweep::CellFaults;
use super::table::{Table, Values};
use crate::dynamics::{Model, Regime, Request, STANDARD_GRAVITY, Summary};
use crate::mechanics::{BuildError, Landscape, Mechanism};
use crate::numeric::round::{ONE_TWO_FIVE, decade, round_down};
use crate::scene::{Excitation, FieldPath, Files, Scene, Start, Stops};
use crate::system::threads::Pool;

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

    fn is_in(self, summary: &Summary) -> bool {
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
fn longest(model: &Model) -> f64 {
    model.duration() + PATIENCE * model.forcing_period().unwrap_or(0.0)
}

/// Runs that are asked for together.
const TOGETHER: usize = 32;

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
    let mut search = Search {
        trial: Scene { start: Start::Rest, ..scene.clone() },
        mechanism,
        files,
        path: FieldPath::new(&scan.field),
        onset,
        task,
    };
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
        return Some(Found { value, windows: 0, without_gap: value });
    }
    let mut found = Found { value: None, windows: 0, without_gap: None };
    let (mut before, mut last) = (None, false);
    for values in scan.values.chunks(TOGETHER) {
        let does = search.ask(values)?;
        for (value, does) in values.iter().zip(does) {
            match (does, found.value) {
                (true, None) => {
                    let located = search.locate(before, *value, scan.resolution)?;
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
    }
    found.without_gap = found.without_gap.filter(|_| last);
    Some(found)
}

/// The thresholds of every cell of `grid` over `scene`, in order: the swept fields, then `of,value,windows`.
/// A value that is not found is missing, as is that of a cell whose mechanism is not solved. None where the
/// search was cancelled.
pub fn threshold_table(
    (scene, files): (&Scene, &Files),
    grid: Option<&Grid>,
    asked: (&Scan, Onset),
    pool: &Pool,
    task: &Task,
) -> Option<Result<Table, CellFaults>> {
    let unsolved = Found { value: None, windows: 0, without_gap: None };
    let cell = |scene: &mut Scene, index: usize| {
        grid.inspect(|grid| grid.apply(index as u64, scene));
        let mechanism = match Mechanism::build(&scene.mechanism, files) {
            Ok(mechanism) => Arc::new(mechanism),
            Err(BuildError::Unsolved(_)) => return Ok(unsolved),
            Err(BuildError::Wrong(fault)) => {
                let cell = grid.map_or_else(String::new, |grid| grid.describe(index as u64));
                return Err(Some(CellFaults { cell, faults: vec![fault] }));
            }
        };
        threshold(scene, &mechanism, files, asked, task).ok_or(None)
    };
    let cells = grid.map_or(1, Grid::cells);
    let found = match pool.map(cells as usize, || scene.clone(), cell) {
        Ok(found) => found,
        Err(ended) => return ended.map(Err),
    };
    let mut table = Table::new();
    for (place, column) in grid.iter().flat_map(|grid| grid.columns()).enumerate() {
        let value = |index: u64| grid.and_then(|grid| grid.values(index).nth(place)).unwrap_or(f64::NAN);
        table = table.with(column, Values::Numbers((0..cells).map(value).collect()));
    }
    let values = found.iter().map(|own| own.value.unwrap_or(f64::NAN)).collect();
    Some(Ok(table
        .with("of", Values::Words(vec![asked.1.name(); found.len()]))
        .with("value", Values::Numbers(values))
        .with("windows", Values::Counts(found.iter().map(|own| own.value.map(|_| own.windows)).collect()))))
}

struct Search<'a> {
    trial: Scene,
    mechanism: &'a Arc<Mechanism>,
    files: &'a Files,
    path: FieldPath,
    onset: Onset,
    task: &'a Task<'a>,
}

impl Search<'_> {
    /// Which of the values do it.
    fn ask(&mut self, values: &[f64]) -> Option<Vec<bool>> {
        let mut does = vec![false; values.len()];
        let (mut models, mut places) = (Vec::new(), Vec::new());
        for (place, value) in values.iter().enumerate() {
            if self.task.is_cancelled() {
                return None;
            }
            if let Some(model) = self.model(*value) {
                models.push(model);
                places.push(place);
            }
        }
        let until = models.iter().map(longest).fold(0.0, f64::max);
        for (place, run) in
            places.into_iter().zip(Model::run_all(&models, Some(until), Some(self.task.cancel)))
        {
            does[place] = self.onset.is_in(&run.summary);
            (self.task.tick)();
        }
        (!self.task.is_cancelled()).then_some(does)
    }

    fn model(&mut self, value: f64) -> Option<Model> {
        let before = self.trial.mechanism.clone();
        if !self.path.set(&mut self.trial, value) {
            return None;
        }
        let mechanism = match self.trial.mechanism == before {
            true => Arc::clone(self.mechanism),
            false => Arc::new(Mechanism::build(&self.trial.mechanism, self.files).ok()?),
        };
        let model = Model::build(&self.trial, mechanism).ok();
        self.trial.mechanism = before;
        model
    }

    /// The least multiple of the resolution, as far as bisection tells, that does it, between a value that
    /// does not and one that does.
    fn locate(&mut self, before: Option<f64>, value: f64, resolution: f64) -> Option<f64> {
        let (Some(mut low), mut high) = (before, value) else { return Some(value) };
        loop {
            let middle = multiple(0.5 * (low + high), resolution);
            let near = [
                middle,
                multiple(middle - resolution, resolution),
                multiple(middle + resolution, resolution),
            ];
            let Some(middle) = near.into_iter().find(|own| *own > low && *own < high) else {
                return Some(high);
            };
            match self.ask(&[middle])?[0] {
                true => high = middle,
                false => low = middle,
            }
        }
    }
}

/// The multiple of `unit` nearest to a value; of a decimal unit the decimal itself.
fn multiple(value: f64, unit: f64) -> f64 {
    let count = (value / unit).round();
    let whole = (1.0 / unit).round();
    if (whole * unit - 1.0).abs() < 1e-9 { count / whole } else { count * unit }
}

/// One in the last of three significant digits of a value.
fn third_digit(value: f64) -> f64 {
    10_f64.powi(decade(value) - 2)
}

/// The field of the amplitude of a sine.
const AMPLITUDE: &str = "excitation.amplitude_g";

/// How much shaking it takes, in g, each from rest at the scene's frequency, whatever the scene's own
/// amplitude is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds {
    /// The least amplitude that frees the mass from the stop it rests on, in closed form.
    pub frees_at: Option<f64>,
    /// The least amplitude whose settled motion crosses; none where none does up to
    /// [`searched_to`](Self::searched_to).
    pub crosses_from: Option<f64>,
    /// From this amplitude on every one that was tried crosses; none where the greatest does not.
    pub without_gap: Option<f64>,
    /// Up to where was searched.
    pub searched_to: f64,
}

/// Steps of the scan up to the push that holds the mass against the mechanism's largest force, as many more
/// of the same length above it, and by how much each further one is longer than the last.
const FINE_STEPS: u32 = 50;
const GROWTH: f64 = 1.02;

/// How many times that push is tried at most before nothing is said to cross.
const MOST_PUSHES: f64 = 30.0;

/// Above the first amplitude that crosses, gaps are looked for in so many steps of this share of it.
const GAP_STEPS: u32 = 50;
const GAP_STEP: f64 = 0.01;

/// Searches the amplitudes of a sine. None where the drive is no sine, nothing is to be crossed, or the
/// search was cancelled.
pub fn thresholds(scene: &Scene, mechanism: &Arc<Mechanism>, task: &Task) -> Option<Thresholds> {
    let Excitation::Sine { .. } = scene.excitation else { return None };
    let push = holding_push(scene, mechanism)?;
    let step = push / f64::from(FINE_STEPS);
    let mut values: Vec<f64> = (1..=2 * FINE_STEPS).map(|i| step * f64::from(i)).collect();
    while let Some(last) = values.last().filter(|last| **last < MOST_PUSHES * push) {
        values.push(last * GROWTH);
    }
    // as they are said: what is said to cross has been run
    values.iter_mut().for_each(|value| *value = multiple(*value, third_digit(*value)));
    values.dedup();
    let searched_to = values.last().copied().unwrap_or(push);
    let files = Files::default(); // an amplitude changes no mechanism
    let scan = |values: Vec<f64>| {
        let resolution = third_digit(values.first().copied().unwrap_or(push));
        let scan = Scan { field: AMPLITUDE.to_owned(), values, resolution };
        threshold(scene, mechanism, &files, (&scan, Onset::Crossing), task)
    };
    let mut found = Thresholds {
        frees_at: frees_at(scene, mechanism),
        crosses_from: None,
        without_gap: None,
        searched_to,
    };
    for part in values.chunks(TOGETHER) {
        // the last value before it, so that the first one that crosses can be located
        let first = values.iter().position(|own| *own == part[0]).unwrap_or(0);
        let Some(value) = scan(values[first.saturating_sub(1)..first + part.len()].to_vec())?.value else {
            continue;
        };
        let above = (0..=GAP_STEPS).map(|i| value * (1.0 + GAP_STEP * f64::from(i)));
        let above = above.map(|own| multiple(own, third_digit(own))).collect();
        found.crosses_from = Some(value);
        found.without_gap = scan(above)?.without_gap;
        break;
    }
    Some(found)
}

/// The amplitude in g whose push equals the largest force against which the mechanism must be moved from
/// where the mass rests to the barrier.
fn holding_push(scene: &Scene, mechanism: &Mechanism) -> Option<f64> {
    let Landscape { barrier, extrema, .. } = &mechanism.landscape;
    let barrier = barrier.as_ref()?;
    let rests = match right_stop(scene) {
        Some(stop) => stop.min(barrier.right_well),
        None => barrier.right_well,
    };
    let between = |x: f64| x >= barrier.x && x <= rests;
    let inside = extrema.iter().filter(|own| between(own.x)).map(|own| own.force.abs());
    let force = inside.fold(mechanism.curve.force(rests).abs(), f64::max);
    Some(force / (scene.mass_g / 1e3) / STANDARD_GRAVITY).filter(|push| *push > 0.0 && push.is_finite())
}

fn right_stop(scene: &Scene) -> Option<f64> {
    scene.stops.limits_mm()[1].map(|mm| mm / 1e3)
}

/// The amplitude in g at which the base's push reaches the force that presses the mass on the stop that it
/// rests on.
fn frees_at(scene: &Scene, mechanism: &Mechanism) -> Option<f64> {
    let Excitation::Sine { .. } = scene.excitation else { return None };
    let right = right_stop(scene)?;
    let well = mechanism.landscape.right_stable()?.x;
    let press = -mechanism.curve.force(right);
    (right < well && press > 0.0).then(|| press / (scene.mass_g / 1e3) / STANDARD_GRAVITY)
}
/// The search for stops makes at least so many steps from the well to the middle, and at most two and a half
/// times as many.
const FEWEST_STOPS: f64 = 50.0;

/// From the wells inward the first travel limit in mm, the same on both sides, whose run from rest is
/// interwell under the scene's own excitation; inner `None` where there is none, outer `None` where the
/// search was cancelled.
///
/// The limits that cross are no interval, so nothing is bisected: every step is run, 1, 2 or 5 of a decimal
/// place, a tenth of a millimetre where the wells are some 7 mm away. `restitution` is that of the stops that
/// are tried.
pub fn stops_that_cross(
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    restitution: f64,
    task: &Task,
) -> Option<Option<f64>> {
    let landscape = &mechanism.landscape;
    let Some(well) = landscape.right_stable().filter(|_| landscape.barrier.is_some()) else {
        return Some(None);
    };
    let well_mm = well.x.abs() * 1e3;
    let step = round_down(well_mm / FEWEST_STOPS, &ONE_TWO_FIVE);
    let mut trial = Scene { start: Start::Rest, ..scene.clone() };
    for i in (1..=(well_mm / step).floor() as u32).rev() {
        let travel_limit_mm = multiple(f64::from(i) * step, step);
        trial.stops = Stops::Rigid { travel_limit_mm, restitution };
        let Ok(model) = Model::build(&trial, Arc::clone(mechanism)) else { continue };
        let until_settled = Some(longest(&model));
        let request = Request { cancel: Some(task.cancel), until_settled, ..Request::default() };
        let run = model.run(&request);
        (task.tick)();
        if task.is_cancelled() {
            return None;
        }
        if run.summary.regime == Regime::Interwell {
            return Some(Some(travel_limit_mm));
        }
    }
    Some(None)
}
