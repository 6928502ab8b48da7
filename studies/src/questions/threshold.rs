//! The question about thresholds.

use std::ops::RangeInclusive;

use super::escape::{grid_or_one, no_table};
use super::grid::{Over, check_until, drive_alone, even, over_fields};
use super::{Error, Progress, Simulation};
use crate::scene::{Amplitude, Axis, Document, Stops, is_whole};
use crate::study::{
    Cells, Grid, Onset, Scan, Searched, Table, suits_melnikov, threshold_table, with_melnikov,
};

over_fields!(Threshold);

/// The smallest value of a field at which the mass is released, or its settled motion crosses or is
/// interwell: for one scene, or in every cell of a grid.
///
/// # Columns
///
/// The fields of the grid, `of`, then `value`, `low`, `high` in the unit of the searched field,
/// `undecided`, `windows`, `step` and `resolution`. `value` is missing if no value that was tried has the
/// motion. `low` and `high` are the nearest values that were tried whose motion is known; `windows` counts
/// the changes above `value`; `step` is the distance of the steps on both sides of it, and `resolution` that
/// of the bisection between them.
///
/// # Method
///
/// The release under one sine has a closed form. Otherwise all steps of the range are run from rest,
/// each until its motion repeats (by default for at most 1000 forcing periods beyond the run of the scene),
/// and the first change is bisected, since the values that cross need not form an interval. A window narrower
/// than a step may be missed; a smaller step costs more runs.
///
/// Without a range the amplitude of the scene's drive is searched upward from 0, as by
/// [`Compare`](super::Compare): at least 100 even steps up to the amplitude whose inertial force equals the
/// largest force of the mechanism between the rest position and the barrier, as many up to twice that, then
/// steps of 1 % to thirty times it. The steps above the first with the motion are run only up to 1.5 times
/// it. Without a barrier the range is 0 to 2 g.
///
/// # Errors
///
/// [`Error::Argument`] for a wrong `field`, `resolution` or `until_settled`, for a release (`of`) without
/// stops, for a grid over the searched field, and for `melnikov` of a field that is not the amplitude of one
/// sine; [`Error::Cells`] for cells in which no value of the range gives a valid scene, or one whose drive
/// repeats, which interwell motion needs.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Onset, Progress, Simulation, Threshold};
///
/// // The mass is released when mass times base acceleration exceeds the force on the stop at 4 mm.
/// let question = Threshold { of: Onset::Release, ..Threshold::default() };
/// let table = question.run(&Simulation::preset("nominal-cubic")?, &Progress::none())?;
/// let force_n = 40.0 * 4e-3 - 816_326.530_612_245 * 4e-3_f64.powi(3);
/// let amplitude_g = force_n / (15.2e-3 * 9.806_65);
/// assert!((table.numbers("value").unwrap()[0] - amplitude_g).abs() < 1e-9);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Threshold {
    /// The fields of the grid, the slowest first; if there are none, the table has one row.
    pub over: Over,
    /// The field that is searched and its range: `FIELD=FROM:TO`, in 200 steps, or `FIELD=FROM:TO:STEP`. An
    /// amplitude of the drive needs no range, and is the field by default where the drive has one alone.
    pub field: Option<String>,
    /// The onset that is searched.
    pub of: Onset,
    /// Resolution of the threshold in the unit of the field; by default a 1000th of the step, or 1 for a
    /// field of whole numbers.
    pub resolution: Option<f64>,
    /// Each run continues until its motion repeats, at most up to this time in s.
    pub until_settled: Option<f64>,
    /// Whether the column `melnikov_g` is added, of a cosine or force in SI `melnikov_m_per_s2` or
    /// `melnikov_n`: Melnikov's threshold, in closed form up to quadrature
    /// (Melnikov 1963; Guckenheimer and Holmes 1983, section 4.5): the first order in damping and drive of
    /// the amplitude above which irregular motions that cross exist. It needs the drive's amplitude as field.
    pub melnikov: bool,
}

impl Default for Threshold {
    fn default() -> Self {
        let (field, of) = (None, Onset::Crossing);
        Self { over: Vec::new(), field, of, resolution: None, until_settled: None, melnikov: false }
    }
}

/// Why there is no Melnikov's threshold of a field.
const NO_MELNIKOV: &str = "Melnikov's threshold is an amplitude of one sine: take a Sine, \
                           Cosine or Force, and search its amplitude, such as excitation.amplitude_g";

/// Number of steps of a range that is given without a step.
const DEFAULT_STEPS: f64 = 200.0;

impl Threshold {
    /// Searches the thresholds.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<Table, Error> {
        self.in_cells(simulation.document(), &grid_or_one(&self.over, simulation)?, progress)
    }

    /// Like [`Escape::in_cells`](super::Escape::in_cells).
    #[doc(hidden)]
    pub fn in_cells(&self, document: &Document, grid: &Grid, progress: &Progress) -> Result<Table, Error> {
        let searched = self.searched(document, grid)?;
        let ticks = grid.cells() * searched.ticks();
        let cells = Cells::new(&document.scene, &document.files, grid.clone());
        let found = progress.shared(ticks, |pool, task| {
            let table = threshold_table(&cells, &searched, self.of, pool, task)?;
            if self.melnikov { with_melnikov(table, &cells, pool, task) } else { Ok(table) }
        })?;
        found.map_err(|end| no_table(document, end))
    }

    /// What is searched in the cells of `grid`.
    #[doc(hidden)]
    pub fn searched(&self, document: &Document, grid: &Grid) -> Result<Searched, Error> {
        if self.of == Onset::Release && document.scene.stops == Stops::None {
            let remedy = "the scene has no stops to release the mass from; give it some, such as \
                          stops=Rigid(travel_limit_mm: 1.5, restitution: 0.36)";
            return Err(Error::argument("of", "release", remedy));
        }
        let given = self.field.as_deref().map(str::trim);
        let amplitudes = document.scene.amplitudes();
        let searched = match given.filter(|text| amplitudes.iter().all(|one| one.path != **text)) {
            None => {
                let field = given.map_or_else(|| only(&amplitudes), |text| Ok(text.to_owned()))?;
                if let Some(resolution) = self.resolution.filter(|value| !is_resolution(*value)) {
                    return Err(wrong_resolution(resolution, "number"));
                }
                let (resolution, until_settled) = (self.resolution, self.until_settled);
                Searched::Upward { field, resolution, until_settled }
            }
            Some(text) => {
                let (resolution, until_settled) = (self.resolution, self.until_settled);
                // a range alone is one of the amplitude
                let of_drive = if text.starts_with('=') { only(&amplitudes)? } else { String::new() };
                Searched::Scan(scan(&(of_drive + text), resolution, until_settled, document)?)
            }
        };
        let field = searched.field();
        if self.melnikov && !suits_melnikov(&document.scene, field) {
            return Err(Error::argument("field", given.unwrap_or(field), NO_MELNIKOV));
        }
        not_swept(grid, field)?;
        if self.until_settled.is_some() {
            let mut first = document.scene.clone();
            grid.apply(0, &mut first);
            check_until(self.until_settled, document, &drive_alone(document, first)?)?;
        }
        Ok(searched)
    }
}

/// The field of the amplitude of a drive that has one alone.
fn only(amplitudes: &[Amplitude]) -> Result<String, Error> {
    let problem = match amplitudes {
        [one] => return Ok(one.path.clone()),
        [] => "the drive of the scene has no amplitude; name a field with its range, such as \
               stops.travel_limit_mm=0.5:3"
            .to_owned(),
        several => {
            let paths: Vec<&str> = several.iter().map(|one| &*one.path).collect();
            format!("the drive of the scene has several amplitudes; name one of {}", paths.join(", "))
        }
    };
    Err(Error::argument("field", "", format!("is missing: {problem}")))
}

/// Refuses a grid over the searched field.
pub(super) fn not_swept(grid: &Grid, field: &str) -> Result<(), Error> {
    if grid.axes().iter().any(|swept| swept.field == field) {
        return Err(Error::argument("over", field, "the threshold is over it; sweep another field"));
    }
    Ok(())
}

fn is_resolution(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

fn wrong_resolution(value: f64, kind: &str) -> Error {
    let problem = format!("give a {kind} above 0, in the unit of the field");
    Error::number("resolution", value, problem)
}

/// The values of a field and range, `FIELD=FROM:TO[:STEP]`, and the resolution of a threshold among them.
pub(super) fn scan(
    argument: &str,
    resolution: Option<f64>,
    until_settled: Option<f64>,
    document: &Document,
) -> Result<Scan, Error> {
    let wrong = |problem: String| Error::argument("field", argument, problem);
    let parsed = |text: &str| -> Result<Axis, Error> {
        let axis = Axis::parse(text, &document.scene).map_err(wrong)?;
        match axis.values.iter().all(|value| value.is_finite()) {
            true => Ok(axis),
            false => Err(wrong("the ends of the range must be finite".into())),
        }
    };
    let (mut full, mut end) = (argument.to_owned(), None);
    if let Some((from, to)) = argument.split_once(':').filter(|(_, to)| !to.contains(':')) {
        // parsed as a list, so that the message names a wrong end
        let ends = parsed(&format!("{from},{to}"))?;
        let [low, high] = ends.values[..] else {
            let problem = "write FIELD=FROM:TO or FIELD=FROM:TO:STEP, such as excitation.amplitude_g=0:2";
            return Err(wrong(problem.into()));
        };
        if low == high {
            return Err(wrong(format!("FROM and TO are both {low}; give a range, such as 0:2")));
        }
        if low > high {
            return Err(wrong(format!("TO must be above FROM; write {high}:{low}")));
        }
        let step = (high - low) / DEFAULT_STEPS;
        let step = if is_whole(&document.scene, &ends.field) { step.ceil() } else { step };
        (full, end) = (format!("{argument}:{step}"), Some(high));
    }
    let axis = parsed(&full)?;
    let mut values = axis.values;
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() < 2 {
        let problem = "it is a single value; give a range of which STEP is a part, such as 0:2:0.1";
        return Err(wrong(problem.into()));
    }
    let step = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
    if let Some(high) = end {
        // rounding may put the last step just below the end of the range
        values.retain(|value| *value < high - 1e-6 * step);
        values.push(high);
    }
    let whole = is_whole(&document.scene, &axis.field);
    let resolution = match resolution {
        None if whole => 1.0,
        None => 1e-3 * step,
        Some(value) if is_resolution(value) && (!whole || value.fract() == 0.0) => value,
        Some(value) => return Err(wrong_resolution(value, if whole { "whole number" } else { "number" })),
    };
    Ok(Scan { field: axis.field, values, resolution, until_settled })
}
