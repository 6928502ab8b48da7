//! Sweeps: a run for each cell of a grid, with bands where inputs are uncertain.

use super::grid::{all_rows, settles};
use super::{Error, Progress, Simulation};
use crate::numeric::number_text;
use crate::scene::{
    Axis, Document, FieldPath, SceneError, Uncertain, field_info, find_name, is_whole, read_number,
};
use crate::study::{
    self, Carry, Cell, DIRECTION, Draws, Grid, MAX_CELLS, MAX_DRAWS, Over, STANDARD_COLUMNS, SUMMARY_FIELDS,
    SummaryField, SweepOptions, Table, Variation, share_in_range,
};

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

    /// The cells of a grid, not yet run; see [`Section::cells`](super::Section::cells). The document has the
    /// [values](Self::nominal) of the uncertain inputs, and `shown` are columns that a picture needs.
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
        let sweep = study::Sweep::new(&document.scene, &document.files, grid).with(options);
        Ok(SweepCells { sweep: settles(sweep, until_settled, document, progress)?, chosen, written })
    }
}

/// A sweep whose arguments are checked.
#[doc(hidden)]
#[derive(Debug)]
pub struct SweepCells {
    /// The sweep.
    pub sweep: study::Sweep,
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

const FORM: &str = "write FIELD=VALUE+-SIGMA, FIELD=+-SIGMA or FIELD=+-5%, such as damping.xi=0.023+-0.002";

/// The least share of a normal distribution that must lie in the range of its field: a half, as at an end of
/// the range, up to rounding.
const LEAST_SHARE: f64 = 0.5 - 1e-9;

/// The field of an uncertain input, its value, which may be empty, and its standard deviation.
fn parts(input: &str) -> Result<[&str; 3], Error> {
    let parts = input.split_once('=').and_then(|(field, law)| {
        let (value, sigma) = law.split_once("+-").or_else(|| law.split_once('\u{b1}'))?;
        Some([field, value, sigma].map(str::trim))
    });
    parts.ok_or_else(|| Error::argument("uncertain", input, FORM))
}

/// Gives the fields of a document the values of the uncertain inputs, and says whether there are any. The
/// document is to be checked afterwards.
#[doc(hidden)]
pub fn assign(uncertain: &Uncertain, document: &mut Document) -> Result<bool, Error> {
    let mut assigned = false;
    for input in &uncertain.fields {
        let [field, value, _] = parts(input)?;
        if !value.is_empty() {
            let done = document.assign(field, value, &format!("--uncertain {input}"));
            done.map_err(|error| Error::Scene(SceneError::Argument(error)))?;
            assigned = true;
        }
    }
    Ok(assigned)
}

/// The draws of the uncertain inputs of a sweep of `grid` over a document, whose fields have been
/// [assigned](assign).
pub fn draws(
    uncertain: &Uncertain,
    document: &Document,
    grid: &Grid,
    carry: Option<Carry>,
) -> Result<Draws, Error> {
    let Uncertain { fields, draws, seed } = uncertain;
    if fields.is_empty() {
        let given = draws.map(|draws| ("draws", draws)).or(seed.map(|seed| ("seed", seed)));
        let problem = "nothing is uncertain; name a field with --uncertain, such as damping.xi=+-0.002";
        return given
            .map_or(Ok(Draws::default()), |(name, value)| Err(Error::argument(name, value, problem)));
    }
    let mut laws: Vec<Variation> = Vec::new();
    for input in fields {
        let wrong = |problem: String| Error::argument("uncertain", input, problem);
        let [field, value, sigma] = parts(input)?;
        let law = variation(field, sigma, FORM, document).map_err(wrong)?;
        let axis = grid.axes().iter().find(|axis| axis.field == field);
        if axis.is_some() && !value.is_empty() {
            let problem = "the field is swept: leave VALUE out, and SIGMA is that of each value of the sweep";
            return Err(wrong(problem.to_owned()));
        }
        if laws.iter().any(|known| known.field == field) {
            return Err(wrong("the field is given twice; give it once".to_owned()));
        }
        let of_scene = FieldPath::new(field).get(&document.scene).unwrap_or(f64::NAN);
        let values = axis.map_or_else(|| vec![of_scene], |axis| axis.values.clone());
        if axis.is_none() && law.relative && values[0] == 0.0 {
            let problem = "a percentage of 0 is nothing; give SIGMA in the unit of the field";
            return Err(wrong(problem.to_owned()));
        }
        values.iter().try_for_each(|value| check_share(&law, *value).map_err(wrong))?;
        laws.push(law);
    }
    if carry.is_some() {
        let problem = "a walk with --carry has no bands; leave one of the two out";
        return Err(Error::argument("uncertain", &fields[0], problem));
    }
    if let Some(draws) = draws.filter(|draws| !(1..=MAX_DRAWS).contains(draws)) {
        let problem = format!("give a whole number from 1 to {MAX_DRAWS}");
        return Err(Error::argument("draws", draws, problem));
    }
    let made = Draws::new(laws, uncertain, &document.scene, grid);
    match grid.cells().checked_mul(made.runs()) {
        Some(runs) if runs <= MAX_CELLS => Ok(made),
        _ => {
            let (cells, runs) = (grid.cells(), made.runs());
            let problem = format!(
                "{cells} cells of {runs} runs are more than the {MAX_CELLS} runs of one sweep; take longer \
                 steps or fewer draws"
            );
            Err(Error::argument("draws", runs - 1, problem))
        }
    }
}

/// Checks that a normal distribution about a value lies mostly in the range of its field.
fn check_share(law: &Variation, value: f64) -> Result<(), String> {
    if !value.is_finite() {
        return Err(format!(
            "nothing lies about {}; give the field a finite value or leave it out",
            number_text(value)
        ));
    }
    let share = share_in_range(law, value);
    if share >= LEAST_SHARE {
        return Ok(());
    }
    let range = field_info(&law.field).map_or_else(String::new, |field| field.range.to_string());
    Err(format!(
        "about {} only {:.1} % of the distribution lie in {range}, where the field is valid; give a smaller \
         SIGMA",
        number_text(value),
        100.0 * share
    ))
}

/// The variation of `field` by `by`, a number in its unit or a percentage of its value; `form` is how both
/// are written. The error is a clause.
pub(crate) fn variation(field: &str, by: &str, form: &str, document: &Document) -> Result<Variation, String> {
    can_vary(field, document)?;
    let (by, relative) = deviation(by, form)?;
    if by < 0.0 {
        let given = if relative { 100.0 * by } else { by };
        return Err(format!("{} is negative; give 0 or more", number_text(given)));
    }
    Ok(Variation { field: field.to_owned(), by, relative })
}

/// Whether a field can have values a little beside its own; the error is a clause.
pub(crate) fn can_vary(field: &str, document: &Document) -> Result<(), String> {
    if FieldPath::new(field).get(&document.scene).is_none() {
        // the error of `parse` lists the fields
        Axis::parse(&format!("{field}=1"), &document.scene)?;
        return Err("the scene leaves this field out; give it a value with --set".to_owned());
    }
    if is_whole(&document.scene, field) {
        let problem = "holds whole numbers, which do not come out a little otherwise; vary another field";
        return Err(problem.to_owned());
    }
    Ok(())
}

/// A number in the unit of a field, or the share of its value that a percentage is, and whether it is one.
pub(crate) fn deviation(text: &str, form: &str) -> Result<(f64, bool), String> {
    let text = text.trim();
    let (number, relative) = text.strip_suffix('%').map_or((text, false), |share| (share, true));
    let number = read_number(number).map_err(|_| form)?;
    if !number.is_finite() {
        return Err(format!("{} is not finite; give a finite number", number_text(number)));
    }
    Ok((if relative { number / 100.0 } else { number }, relative))
}
