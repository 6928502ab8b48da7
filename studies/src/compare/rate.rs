//! The numbers of each scene of a comparison, and their table.

use std::sync::Arc;

use crate::dynamics::{Model, Run, Summary};
use crate::mechanics::Mechanism;
use crate::numeric::elementary;
use crate::numeric::round::decade;
use crate::scene::{Excitation, FieldPath, Files, STANDARD_GRAVITY, Scene, numeric_fields};
use crate::study::amplitudes::{crossing, frees_at};
use crate::study::bisection::multiple;
use crate::study::grid::{is_of_mechanism, name_of};
use crate::study::settled::{followed, settled_within, shared_runs};
use crate::study::{Cancelled, Family, Result, SummaryField, Table, Task};
use crate::system::threads::Pool;
use crate::threshold::{Above, Found, Onset, from_rest};

/// A scene of a comparison, with the common excitation.
#[derive(Debug, Clone)]
pub struct Alternative {
    /// Its name.
    pub name: String,
    /// The scene; its excitation is a sine.
    pub scene: Scene,
    /// The files that it names.
    pub files: Files,
    /// Its mechanism.
    pub mechanism: Arc<Mechanism>,
}

const SIZE_CHANGE: f64 = 0.01;

/// Crossings are searched from the frequency of the drive divided by this factor to the frequency times it.
pub const SEARCHED_SPAN: f64 = 10.0;

/// Number of frequencies tried on each side of that of the drive.
const STEPS: i32 = 40;

const BAND_RESOLUTION: f64 = 1e-3;

/// Names of the fields that are sizes: lengths, thicknesses, and the gap between magnets.
const SIZES: [&str; 3] = ["length_mm", "thickness_mm", "gap_mm"];

const FREQUENCY: &str = "excitation.frequency_hz";

/// Results of one scene.
///
/// It is a row of the comparison as numbers: amplitudes in g, frequencies in Hz, the summary in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Rated {
    /// The scene.
    pub name: String,
    /// Smallest amplitude in g that releases the mass from its stop; `None` if it rests on none.
    pub release_g: Option<f64>,
    /// Smallest amplitude in g whose settled motion from rest crosses; `None` if there is no barrier.
    pub crossing: Option<Found>,
    /// The settled motion of the scene itself.
    pub summary: Summary,
    /// Ends of the band of frequencies in Hz, at the scene's amplitude, whose settled motion from rest
    /// crosses: the band that contains the frequency of the drive, otherwise the widest band.
    pub crosses_hz: Option<(f64, f64)>,
    /// The largest relative change of the crossing threshold for a change of one size by 1 % up or down, and
    /// that size. Infinite if the changed scene has no barrier or does not cross.
    pub sensitivity: Option<(f64, String)>,
}

/// A part of the work: rating a scene, or finding its crossing threshold with one size changed.
pub(super) struct Part {
    /// The index of the scene.
    scene: usize,
    /// The field that is changed, and by which share.
    change: Option<(String, f64)>,
}

/// The parts of the work.
pub(super) fn parts(scenes: &[Alternative]) -> Vec<Part> {
    let unchanged = (0..scenes.len()).map(|scene| Part { scene, change: None });
    let changed = scenes.iter().enumerate().flat_map(|(scene, alternative)| {
        let change = |field: &String| [-1.0, 1.0].map(|way| Some((field.clone(), way * SIZE_CHANGE)));
        let changes: Vec<_> = sizes(&alternative.scene).iter().flat_map(change).collect();
        changes.into_iter().map(move |change| Part { scene, change })
    });
    unchanged.chain(changed).collect()
}

/// The fields of sizes of the mechanism that are not 0.
fn sizes(scene: &Scene) -> Vec<String> {
    let is_size = |path: &String| is_of_mechanism(path) && SIZES.contains(&name_of(path));
    numeric_fields(scene).into_iter().filter(is_size).collect()
}

/// Rates the scenes on `pool`; the result is the same for any number of threads. Each run begins at rest and
/// continues until its motion repeats, at most up to `until_settled` in s (by default 1000 forcing periods
/// beyond the run). `None` if cancelled.
pub fn alternatives(
    scenes: &[Alternative],
    until_settled: Option<f64>,
    pool: &Pool,
    task: &Task,
) -> Option<Vec<Rated>> {
    let parts = parts(scenes);
    // progress is counted by parts, not by the searches within them
    let silent = Task { tick: &|| (), cancel: task.cancel };
    let rating = Rating { until_settled, pool, task: &silent };
    let work = |index: usize| {
        let Part { scene, change } = &parts[index];
        let done = match change {
            None => rating.rate(&scenes[*scene]).map(|rated| (Some(Box::new(rated)), None)),
            Some((field, by)) => rating.changed(&scenes[*scene], field, *by).map(|found| (None, found)),
        };
        (task.tick)();
        task.check_cancelled().and(done)
    };
    let done = pool.map(parts.len(), work).ok()?;
    let mut rated: Vec<Rated> = Vec::new();
    for (Part { scene, change }, (unchanged, threshold)) in parts.into_iter().zip(done) {
        rated.extend(unchanged.map(|unchanged| *unchanged));
        let Some((field, _)) = change else { continue };
        let Some(before) = rated[scene].crossing_g() else { continue };
        let change = threshold.map_or(f64::INFINITY, |after| (after - before).abs() / before);
        let sensitivity = &mut rated[scene].sensitivity;
        if sensitivity.as_ref().is_none_or(|(largest, _)| change > *largest) {
            *sensitivity = Some((change, field));
        }
    }
    Some(rated)
}

struct Rating<'a> {
    until_settled: Option<f64>,
    pool: &'a Pool,
    task: &'a Task<'a>,
}

impl Rated {
    /// Smallest amplitude in g whose settled motion crosses, if any does.
    pub fn crossing_g(&self) -> Option<f64> {
        self.crossing?.value
    }
}

impl Rating<'_> {
    fn rate(&self, scene: &Alternative) -> Result<Rated> {
        let trial = from_rest(&scene.scene);
        let crossing = self.crossing(&trial, &scene.mechanism, Above::Searched)?;
        // the scene was checked
        let model = Model::build(&trial, Arc::clone(&scene.mechanism)).map_err(|_| Cancelled)?;
        Ok(Rated {
            name: scene.name.clone(),
            release_g: frees_at(&trial, &scene.mechanism).map(|acceleration| acceleration / STANDARD_GRAVITY),
            crossing,
            summary: settled_within(&model, self.until_settled, self.task.cancel).ok_or(Cancelled)?,
            crosses_hz: self.band(scene, &trial)?,
            sensitivity: None,
        })
    }

    fn crossing(&self, trial: &Scene, mechanism: &Arc<Mechanism>, above: Above) -> Result<Option<Found>> {
        let found = crossing(trial, mechanism, Some(self.pool), self.until_settled, above, self.task)?;
        Ok(found.map(|(found, _)| found))
    }

    /// The crossing threshold with one size changed by the share `by`.
    fn changed(&self, scene: &Alternative, field: &str, by: f64) -> Result<Option<f64>> {
        let mut trial = from_rest(&scene.scene);
        let path = FieldPath::new(field);
        // the scene has the field, which is one of its sizes
        path.get(&trial).filter(|value| path.set(&mut trial, value * (1.0 + by))).ok_or(Cancelled)?;
        let built = Mechanism::build_cancellable(&trial.mechanism, &scene.files, self.task.cancel);
        let Ok(mechanism) = built.ok_or(Cancelled)? else { return Ok(None) };
        let found = self.crossing(&trial, &Arc::new(mechanism), Above::Skipped)?;
        Ok(found.and_then(|found| found.value))
    }

    /// The band of frequencies that cross, by a scan and bisection of its ends; a gap or a band narrower than
    /// a step of the scan may be missed.
    fn band(&self, scene: &Alternative, trial: &Scene) -> Result<Option<(f64, f64)>> {
        let Excitation::Sine { frequency_hz, .. } = trial.excitation else { return Ok(None) };
        let family = Family::new(trial, &scene.files, &scene.mechanism, FREQUENCY);
        let ask = |values: &[f64]| -> Result<Vec<bool>> {
            let model = |number: usize| {
                let model = family.model(values[number]).map_err(|_| false)?;
                Ok(followed(model, self.until_settled))
            };
            let crosses = |run: &Run| Onset::Crossing.verdict(&run.summary).does;
            shared_runs(Some(self.pool), self.task, values.len(), model, crosses).ok_or(Cancelled)
        };
        let values: Vec<f64> = (-STEPS..=STEPS)
            .map(|i| decimal(frequency_hz * elementary::powf(SEARCHED_SPAN, f64::from(i) / f64::from(STEPS))))
            .collect();
        let does = ask(&values)?;
        let mut bands: Vec<(usize, usize)> = Vec::new();
        for i in (0..does.len()).filter(|i| does[*i]) {
            match bands.last_mut() {
                Some((_, last)) if *last + 1 == i => *last = i,
                _ => bands.push((i, i)),
            }
        }
        let middle = STEPS as usize;
        let holds = |band: &&(usize, usize)| (band.0..=band.1).contains(&middle);
        let widest = || bands.iter().rev().max_by_key(|band| band.1 - band.0);
        let Some((first, last)) = bands.iter().find(holds).or_else(widest).copied() else {
            return Ok(None);
        };
        let edge = |inside: usize, outside: Option<usize>| -> Result<f64> {
            let (mut inside, Some(outside)) = (values[inside], outside) else { return Ok(values[inside]) };
            let mut outside = values[outside];
            while (outside / inside - 1.0).abs() > BAND_RESOLUTION {
                let middle = decimal((inside * outside).sqrt());
                if ask(&[middle])?[0] { inside = middle } else { outside = middle }
            }
            Ok(inside)
        };
        let low = edge(first, first.checked_sub(1))?;
        let high = edge(last, Some(last + 1).filter(|i| *i < values.len()))?;
        Ok(Some((low, high)))
    }
}

/// A number to five digits, above 0.
fn decimal(value: f64) -> f64 {
    multiple(value, elementary::powi(10.0, decade(value) - 4))
}

/// A row for each scene: thresholds, numbers of the settled motion, band of frequencies, sensitivity.
pub fn comparison_table(rated: &[Rated]) -> Table {
    let mut table = Table::new()
        .each("scene", rated, |row| row.name.clone())
        .each("release_g", rated, |row| row.release_g)
        .each("crossing_g", rated, Rated::crossing_g)
        .each("crossing_low_g", rated, |row| row.crossing?.low)
        .each("crossing_high_g", rated, |row| row.crossing?.high)
        .each("crossing_undecided", rated, |row| row.crossing.map(|found| found.undecided))
        .each("crossing_step_g", rated, |row| row.crossing?.step)
        .each("crossing_resolution_g", rated, |row| row.crossing?.resolution);
    let summary = ["rms_velocity_m_per_s", "mean_load_power_w", "max_abs_x_m", "impact_speed_max_m_per_s"];
    for field in summary.into_iter().filter_map(SummaryField::find) {
        table = table.with(field.name, field.column(rated.iter().map(|row| Some(&row.summary))));
    }
    table
        .each("crosses_from_hz", rated, |row| row.crosses_hz.map(|band| band.0))
        .each("crosses_to_hz", rated, |row| row.crosses_hz.map(|band| band.1))
        .each("threshold_sensitivity", rated, |row| Some(row.sensitivity.as_ref()?.0))
        .each("most_sensitive_to", rated, |row| row.sensitivity.clone().unwrap_or_default().1)
}
