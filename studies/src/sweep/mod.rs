//! Sweeps: a run for each cell of a grid, with bands where inputs are uncertain.

pub(crate) mod cells;
mod chart;
mod lines;
mod map;
mod picture;
mod uncertain;
mod walked;

use crate::questions::{Error, Progress, Simulation, all_rows, settles};
use crate::scene::{Document, Uncertain, find_name};
use crate::study::{Carry, Cell, DIRECTION, Grid, Over, SUMMARY_FIELDS, SummaryField, Table};
pub use cells::{STANDARD_COLUMNS, SweepOptions};
pub use chart::{MAX_PICTURE_CELLS, NoPicture, can_show, sweep_chart};
pub(crate) use chart::{can_show_over_field, distinct, each_line, few_lines};
pub use lines::{Edges, first_crossing, release_line};
use lines::{first_crossing_edge, line_meets};
pub(crate) use map::map;
pub use map::shown_columns;
pub use picture::{Cut, NOT_SETTLED, Overlay, SweepPicture, View};
pub(crate) use picture::{ascending, label, spans, swept_axis};
use uncertain::draws;
pub(crate) use uncertain::{Draws, can_vary, deviation};
pub use uncertain::{MAX_DRAWS, assign};
pub use walked::{Walk, WalkedRun};

/// What the settled motion does in each cell of a grid over fields: one run and one row per cell.
///
/// # Columns
///
/// The swept fields in their own units, named by the shortest unique end of their path
/// (`travel_limit_mm`); with `carry` the `direction`; then `rms_velocity_m_per_s`, `regime`, `crossings`,
/// `impacts`, `max_abs_x_m`, `period`, `outcome`, or the chosen `columns`.
///
/// With `uncertain` inputs each cell is also run for draws of them from normal distributions. Column `X` of
/// numbers is then followed by `X_low` and `X_high`, between which 95 % of the draws lie, and one of words by
/// `X_share`, the share of the draws with the same word; the last column, `draws`, counts the draws that came
/// to their end. A distribution is truncated to the range of its field. The k-th draw is at the same
/// probabilities in every cell, those of ChaCha8 with the seed, so that bands are smooth along the axes. The
/// ends of a band are quantiles with straight lines between the draws (Hyndman and Fan 1996, definition 6).
///
/// With `carry` a run begins in the state of the run before at its last whole forcing period, so that walks
/// up and down show hysteresis (Duffing 1918; for the double well Holmes 1979). The cells of a walk are run
/// one after another, other cells in batches: 41 by 101 cells of `nominal-cubic` take 0.1 s of CPU time.
/// Energies, `mean_x_m` and `impact_share` are slower, since they need the energy ledger.
///
/// # Errors
///
/// [`Error::Argument`] for wrong fields, `columns` or `until_settled`, for uncertain inputs that the scene
/// does not have or that lie mostly out of their range, and for them with `carry`; [`Error::Cells`] for the
/// first cell that is not a valid scene or, with `carry`, whose drive does not repeat. A run that ends early
/// is no error: its `outcome` says why.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Progress, Simulation, Sweep};
///
/// let simulation = Simulation::preset("nominal-cubic")?;
/// let sweep = Sweep::over("stops.travel_limit_mm", 2.0..=6.0, 3);
/// let sweep = sweep.and("excitation.amplitude_g", 0.5..=1.5, 3);
/// let table = sweep.run(&simulation, &Progress::none())?;
/// assert_eq!(table.rows(), 9);
/// assert!(table.words("outcome").iter().all(|outcome| *outcome == "done"));
///
/// // Friction known to a tenth: the band of the speed, and how many draws have the regime of the cell.
/// let sweep = Sweep::over("excitation.amplitude_g", 0.2..=0.4, 3).uncertain("damping.xi=+-10%");
/// let table = sweep.run(&simulation.with("stops", "None")?, &Progress::none())?;
/// let [low, speed, high] = ["_low", "", "_high"]
///     .map(|end| table.numbers(&format!("rms_velocity_m_per_s{end}")).unwrap());
/// assert!((0..3).all(|row| low[row] < speed[row] && speed[row] < high[row]));
/// assert_eq!(table.numbers("regime_share"), Some(&[1.0; 3][..]));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sweep {
    /// The fields, the slowest first; if there are none, those of the scene's `sweep`.
    pub over: Over,
    /// Columns after those of the fields: names of summary fields, or `all`; empty for the standard ones.
    pub columns: Vec<String>,
    /// Each run continues until its motion repeats, at most up to this time in s.
    pub until_settled: Option<f64>,
    /// Directions in which the last field is walked: each run from the end of the one before.
    pub carry: Option<Carry>,
    /// Uncertain inputs, and their draws.
    pub uncertain: Uncertain,
}

impl Sweep {
    /// Adds an uncertain input, `FIELD=VALUE+-SIGMA`: a field with its value and its standard deviation, in
    /// the unit of the field or as a percentage of the value (`5%`). Without VALUE it is that of the scene,
    /// of a swept field that of each cell.
    #[must_use]
    pub fn uncertain(mut self, input: impl Into<String>) -> Self {
        self.uncertain.fields.push(input.into());
        self
    }

    /// The simulation with the nominal values of the uncertain inputs, whose runs are the rows of the cells.
    /// Its mechanism is not solved again where it is given to [`run`](Self::run).
    pub fn nominal(&self, simulation: &Simulation, progress: &Progress) -> Result<Simulation, Error> {
        let mut document = simulation.document().clone();
        match assign(&self.uncertain, &mut document)? {
            true => simulation.with_document(document, progress),
            false => Ok(simulation.clone()),
        }
    }

    /// Runs the cells.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<Table, Error> {
        let simulation = self.nominal(simulation, progress)?;
        let document = simulation.document();
        let cells = self.cells(document, simulation.grid(&self.over)?, &[], progress)?;
        Ok(cells.rows(document, progress)?.only(&cells.written))
    }

    /// The cells of a grid, not yet run; see [`Section::cells`](crate::questions::Section::cells). The
    /// document has the [values](Self::nominal) of the uncertain inputs, and `shown` are columns that a
    /// picture needs.
    #[doc(hidden)]
    pub fn cells(
        &self,
        document: &Document,
        grid: Grid,
        shown: &[&str],
        progress: &Progress,
    ) -> Result<SweepCells, Error> {
        let columns = column_names(&self.columns, &grid, self.carry)?;
        let draws = draws(&self.uncertain, document, &grid, self.carry)?;
        let (written, until_settled) = (draws.columns(&columns), self.until_settled);
        let chosen = columns[grid.columns().len() + usize::from(self.carry.is_some())..].to_vec();
        let shown = shown.iter().copied().filter(|name| !columns.iter().any(|column| column == name));
        let fields = columns.iter().map(String::as_str).chain(shown).filter_map(SummaryField::find).collect();
        let options = SweepOptions { columns: fields, until_settled, carry: self.carry, draws };
        let sweep = cells::Sweep::new(&document.scene, &document.files, grid).with(options);
        Ok(SweepCells { sweep: settles(sweep, until_settled, document, progress)?, chosen, written })
    }
}

/// A sweep whose arguments are checked.
#[doc(hidden)]
#[derive(Debug)]
pub struct SweepCells {
    /// The sweep.
    pub sweep: cells::Sweep,
    /// The columns after those of the fields and of the direction, without bands.
    pub chosen: Vec<String>,
    /// The columns that are written.
    pub written: Vec<String>,
}

impl SweepCells {
    /// Runs the cells with these indices, in any order, and hands over each as soon as it is known.
    pub fn run(
        &self,
        cells: &[u64],
        progress: &Progress,
        each: &(dyn Fn(u64, Cell) + Sync),
    ) -> Result<(), Error> {
        let whole = progress.pool(|pool| self.sweep.run_cells(pool, &progress.silent(), cells, each))?;
        if whole { Ok(()) } else { Err(Error::Cancelled) }
    }

    /// All rows, with all columns that were computed.
    pub fn rows(&self, document: &Document, progress: &Progress) -> Result<Table, Error> {
        all_rows(&self.sweep, document, progress)
    }
}

/// The names of the columns of a sweep: the swept fields, the direction of a walk, and the chosen columns,
/// without those of bands.
fn column_names(chosen: &[String], grid: &Grid, carry: Option<Carry>) -> Result<Vec<String>, Error> {
    let mut names = grid.columns().to_vec();
    names.extend(carry.map(|_| DIRECTION.to_owned()));
    match chosen {
        [] => names.extend(STANDARD_COLUMNS.map(str::to_owned)),
        [all] if all == "all" => {
            let more = SUMMARY_FIELDS.iter().map(|field| field.name);
            let more = more.filter(|name| !STANDARD_COLUMNS.contains(name));
            names.extend(STANDARD_COLUMNS.into_iter().chain(more).map(str::to_owned));
        }
        list => {
            let fields = SUMMARY_FIELDS.iter().map(|field| field.name);
            let known: Vec<&str> = ["all"].into_iter().chain(fields).collect();
            for name in list.iter().map(|name| name.trim()) {
                let wrong = |problem: &str| Error::argument("columns", name, problem);
                let column = find_name("column", name, &known).map_err(|problem| wrong(&problem))?;
                if column == "all" {
                    return Err(wrong("stands alone: it has every column"));
                }
                if names.iter().any(|known| known == column) {
                    return Err(wrong("named twice; name it once"));
                }
                names.push(column.to_owned());
            }
        }
    }
    Ok(names)
}
