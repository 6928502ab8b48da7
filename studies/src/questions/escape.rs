//! Questions about rare events under noise: escapes from a well, and thresholds in probability.

use std::ops::RangeInclusive;

use super::grid::{Over, even, over_fields};
use super::threshold::{not_swept, scan};
use super::{Error, Progress, Simulation};
use crate::scene::{Document, field_info};
use crate::study::{
    Cells, Chance, EscapeOptions, Grid, NoThresholds, Scan, Table, Until, escape_table,
    probable_threshold_table,
};

/// How often, and after which time, a motion under noise leaves its well: runs that differ in the seed of the
/// noise, for one scene or in every cell of a grid.
///
/// # Columns
///
/// The fields, `runs`, `escaped`, `ended_early`, `observed_s`, then `escape_rate_per_s`,
/// `mean_first_passage_s` (its inverse), both with `low` and `high` of a 95 % interval,
/// `median_first_passage_s`, `kramers_rate_per_s` and `kramers_fails`. Without an escape, the rate is 0, and
/// the mean time and the upper end of its interval are missing.
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
#[derive(Debug, Clone, PartialEq)]
pub struct Escape {
    /// The fields of the grid, the slowest first; if there are none, the table has one row.
    pub over: Over,
    /// Number of runs in each cell, 1 to 1000000.
    pub runs: u64,
    /// Time in s at which a run ends without an escape; by default the duration of the scene's run.
    pub within: Option<f64>,
    /// What counts as an escape.
    pub until: Until,
}

impl Default for Escape {
    fn default() -> Self {
        Self { over: Vec::new(), runs: Self::RUNS, within: None, until: Until::Well }
    }
}

const RUNS: RangeInclusive<u64> = 1..=1_000_000;

/// Largest number of runs of all cells together.
const MAX_RUNS: u64 = 10_000_000;

impl Escape {
    /// Default number of runs.
    pub const RUNS: u64 = 100;

    /// Runs the cells.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<Table, Error> {
        self.in_cells(simulation.document(), &grid_or_one(&self.over, simulation)?, progress)
    }

    /// Runs the cells of `grid` in place of those of `over`. The scene itself, whose values of the fields are
    /// never run, needs no model.
    #[doc(hidden)]
    pub fn in_cells(&self, document: &Document, grid: &Grid, progress: &Progress) -> Result<Table, Error> {
        let options = self.options(document, grid)?;
        let cells = Cells::new(&document.scene, &document.files, grid.clone());
        let runs = grid.cells() * options.runs;
        let found = progress.shared(runs, |pool, task| escape_table(&cells, &options, pool, task))?;
        found.map_err(|end| no_table(document, end))
    }

    /// The runs of each cell of `grid`; an error if an argument is wrong.
    #[doc(hidden)]
    pub fn options(&self, document: &Document, grid: &Grid) -> Result<EscapeOptions, Error> {
        let within = self.within.unwrap_or(document.scene.run.duration_s);
        check_runs(self.runs, within, grid)?;
        Ok(EscapeOptions { runs: self.runs, within, until: self.until })
    }
}

over_fields!(Escape);

/// The value of a field at which a share of the runs under noise crosses the barrier within a time: for one
/// scene, or in every cell of a grid.
///
/// # Columns
///
/// The fields of the grid, `of`, `probability`, `value` with `low` and `high` of a 95 % interval in
/// the unit of the searched field, `runs`, and `crossed`, the number of runs that cross at the end of the
/// range. A number is missing if too few runs cross there, an end of the interval also if there are too few
/// runs to have one.
///
/// # Method
///
/// All runs begin at rest. Each keeps its random numbers and is bisected between the ends of the
/// range; `value` is the quantile of the values that were found, and its interval lies between two of them,
/// whose ranks are binomial (David and Nagaraja 2003, section 7.1). A run that crosses at a value is taken to
/// cross at higher ones; where it does not, the bisection finds one of the changes of its answer.
///
/// # Errors
///
/// [`Error::Argument`] for a wrong argument; [`Error::Cells`] for cells in which no value of the
/// range gives a valid scene with noise and two wells.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{ProbableThreshold, Progress, Simulation};
///
/// let noise = "Noise(rms_g: 0.3, low_hz: 1, high_hz: 20, seed: 1, lines: 64)";
/// let simulation = Simulation::preset("nominal-cubic")?.with("excitation", noise)?;
/// let field = "excitation.rms_g=0:4".to_owned();
/// let (field, within) = (Some(field), Some(2.0));
/// let question = ProbableThreshold { field, runs: 9, within, ..ProbableThreshold::default() };
/// let table = question.run(&simulation, &Progress::none())?;
/// let number = |name: &str| table.numbers(name).unwrap()[0];
/// assert!(number("low") <= number("value") && number("value") <= number("high"));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ProbableThreshold {
    /// The fields of the grid, the slowest first; if there are none, the table has one row.
    pub over: Over,
    /// The field that is searched and its range: `FIELD=FROM:TO` or `FIELD=FROM:TO:STEP`; by default the root
    /// mean square of the scene's noise, 0 to 2 g.
    pub field: Option<String>,
    /// Share of the runs that cross, above 0 and below 1.
    pub probability: f64,
    /// Number of runs, 1 to 1000000.
    pub runs: u64,
    /// Time in s within which they cross; by default the duration of the scene's run.
    pub within: Option<f64>,
    /// Resolution of the threshold in the unit of the field; by default the step.
    pub resolution: Option<f64>,
}

impl Default for ProbableThreshold {
    fn default() -> Self {
        let (over, field, runs) = (Vec::new(), None, Escape::RUNS);
        Self { over, field, probability: 0.5, runs, within: None, resolution: None }
    }
}

impl ProbableThreshold {
    /// Searches the thresholds.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<Table, Error> {
        self.in_cells(simulation.document(), &grid_or_one(&self.over, simulation)?, progress)
    }

    /// Like [`Escape::in_cells`].
    #[doc(hidden)]
    pub fn in_cells(&self, document: &Document, grid: &Grid, progress: &Progress) -> Result<Table, Error> {
        let (chance, scan) = (self.chance(document, grid)?, self.scan(document, grid)?);
        let cells = Cells::new(&document.scene, &document.files, grid.clone());
        let found = progress.shared(grid.cells() * chance.runs, |pool, task| {
            probable_threshold_table(&cells, &scan, &chance, pool, task)
        })?;
        found.map_err(|end| no_table(document, end))
    }

    /// The range that is searched, and its resolution.
    #[doc(hidden)]
    pub fn scan(&self, document: &Document, grid: &Grid) -> Result<Scan, Error> {
        let field = match &self.field {
            Some(given) => given.trim().to_owned(),
            None => default_field(document)?,
        };
        let scan = scan(&field, self.resolution, None, document)?;
        not_swept(grid, &scan.field)?;
        let step = scan.values.windows(2).map(|pair| pair[1] - pair[0]).next().unwrap_or(scan.resolution);
        Ok(Scan { resolution: self.resolution.unwrap_or(step), ..scan })
    }

    /// Probability, runs and time of each cell of `grid`; an error if one of them is wrong.
    #[doc(hidden)]
    pub fn chance(&self, document: &Document, grid: &Grid) -> Result<Chance, Error> {
        let within = self.within.unwrap_or(document.scene.run.duration_s);
        check_runs(self.runs, within, grid)?;
        if !(self.probability > 0.0 && self.probability < 1.0) {
            let problem = "give a share above 0 and below 1, such as 0.5";
            return Err(Error::number("probability", self.probability, problem));
        }
        Ok(Chance { probability: self.probability, runs: self.runs, within })
    }
}

/// The root mean square of the noise of a scene that has one, 0 to 2 g.
fn default_field(document: &Document) -> Result<String, Error> {
    let mut noises = document.scene.amplitudes();
    noises.retain(|amplitude| amplitude.path.ends_with(".rms_g"));
    match &noises[..] {
        [noise] => Ok(format!("{}=0:2", noise.path)),
        _ => {
            let problem = "is missing, and the scene has no noise, or several: name a field with its range, \
                           such as excitation.rms_g=0:2";
            Err(Error::argument("field", "", problem))
        }
    }
}

/// The grid over these fields, or that of the scene alone.
pub(super) fn grid_or_one(over: &Over, simulation: &Simulation) -> Result<Grid, Error> {
    if over.is_empty() { Ok(Grid::of_one()) } else { simulation.grid(over) }
}

/// Checks a number of runs and their time in s.
fn check_runs(runs: u64, within: f64, grid: &Grid) -> Result<(), Error> {
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

/// The error of a question whose table was not computed.
pub(super) fn no_table(document: &Document, end: NoThresholds) -> Error {
    match end {
        NoThresholds::Cancelled => Error::Cancelled,
        NoThresholds::Wrong(cells) => Error::cells_of(document, cells),
    }
}
