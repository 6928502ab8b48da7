//! What a study declares, once for the library, the command line, Python and the documents.

use std::convert::Infallible;
use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::{
    Cancelled, CellFaults, Cells, Grid, GridStudy, IMPACTS, NoThresholds, Question, Said, Table, Tally, Task,
    Values,
};
use crate::dynamics::Model;
use crate::mechanics::Mechanism;
use crate::output::{Chart, Manifest, NoPicture, Ranges};
use crate::questions::{Error, Progress, Simulation};
use crate::scene::{Document, Scene, read_number};
use crate::system::threads::Pool;

/// Fields by dotted path, each with its values.
pub type Over = Vec<(String, Vec<f64>)>;

/// A study of one scene or of the cells of a grid over it, whose answer is a table.
///
/// Its fields are the arguments of its command and of its method in Python; their documentation is the help
/// of both.
pub trait Study: clap::Args + serde::de::DeserializeOwned + Clone + Default + Send + Sync + 'static {
    /// The name of its command and of its method in Python.
    const NAME: &'static str;
    /// What scenes it takes, as the help says it.
    const SCENE: &'static str = "Scene file or built-in scene";
    /// What is counted while it is computed, such as `runs`.
    const PARTS: &'static str;
    /// Whether it can be asked for every cell of a grid.
    const GRID: bool = true;
    /// Whether a row stands for a cell.
    const ROW_A_CELL: bool = true;
    /// An example in Python, with its answers; empty for a study whose method is written by hand.
    const PYTHON: &'static str;

    /// The fields of the grid.
    fn over(&self) -> &Over {
        const { &Vec::new() }
    }

    /// What is counted while it is computed.
    fn parts(&self, _scenes: &Scenes) -> &'static str {
        Self::PARTS
    }

    /// Gives the fields of the scene that it covers their first values, before the scene is checked.
    fn prepare(&self, _document: &mut Document) -> Result<(), Error> {
        Ok(())
    }

    /// Checks the arguments, before anything is run.
    fn check(&self, scenes: &Scenes) -> Result<(), Error>;

    /// What to know before a long computation; asked where somebody waits for it.
    fn forecast(&self, _scenes: &Scenes) -> Result<Option<String>, Error> {
        Ok(None)
    }

    /// Answers the study.
    ///
    /// Precondition: [`check`](Self::check) found no fault.
    fn answer(&self, scenes: &Scenes, progress: &Progress) -> Result<Answered, Error>;

    /// The rows of a grid that are written as they come, in place of an [`answer`](Self::answer).
    fn streamed(&self, _scenes: &Scenes, _progress: &Progress) -> Result<Option<Streamed>, Error> {
        Ok(None)
    }

    /// The files that the further tables of an answer go to, in their order, each with its option.
    fn files(&self) -> Vec<(&'static str, &Path)> {
        Vec::new()
    }

    /// Checks whether an answer over this grid can be drawn.
    fn can_draw(&self, grid: &Grid) -> Result<(), NoPicture>;

    /// Checks the ranges that are given for the axes of a picture.
    fn check_ranges(&self, _ranges: &Ranges) -> Result<(), Error> {
        Ok(())
    }

    /// The columns of each of its tables from left to right, after those of the fields.
    fn columns() -> Vec<Vec<Heading>>;
}

/// The scenes that a study is about: one, or the cells of a grid over it.
#[derive(Debug, Clone, Copy)]
pub struct Scenes<'a> {
    /// The scene, whose values of the grid's fields are never run.
    pub document: &'a Document,
    /// The grid; of the scene alone without fields.
    pub grid: &'a Grid,
    /// The mechanism, if it is that of all cells.
    pub mechanism: Option<&'a Arc<Mechanism>>,
}

impl<'a> Scenes<'a> {
    /// The cells of `grid` over a simulation.
    pub fn of(simulation: &'a Simulation, grid: &'a Grid) -> Self {
        let mechanism = (!grid.changes_mechanism()).then(|| simulation.mechanism());
        Self { document: simulation.document(), grid, mechanism }
    }

    /// The fields of the scene.
    pub fn scene(&self) -> &'a Scene {
        &self.document.scene
    }

    /// The mechanism of the scene itself.
    pub(crate) fn mechanism(&self) -> Result<Arc<Mechanism>, Error> {
        if let Some(mechanism) = self.mechanism {
            return Ok(Arc::clone(mechanism));
        }
        let built = Mechanism::build(&self.scene().mechanism, &self.document.files);
        built.map(Arc::new).map_err(|error| Error::unbuilt(self.document, error))
    }

    /// The model of the scene itself.
    pub(crate) fn model(&self) -> Result<Model, Error> {
        let model = Model::build(self.scene(), self.mechanism()?);
        model.map_err(|faults| Error::faults_of(self.document, faults))
    }

    /// The cells, before any mechanism is built.
    pub(crate) fn cells(&self) -> Cells {
        Cells::new(&self.document.scene, &self.document.files, self.grid.clone())
    }

    /// The error of a table that was not computed.
    pub(crate) fn no_table(&self, end: NoThresholds) -> Error {
        match end {
            NoThresholds::Cancelled => Error::Cancelled,
            NoThresholds::Wrong(cells) => Error::cells_of(self.document, cells),
        }
    }
}

/// An answer: its table, what that does not say, and how it is drawn.
pub struct Answered {
    /// The table, without rows if they are made in [`parts`](Self::parts).
    pub table: Table,
    /// The rows where there are very many.
    pub parts: Option<Parts>,
    /// Further tables.
    pub beside: Vec<Table>,
    /// What the table does not say.
    pub remarks: Vec<Remark>,
    /// Draws the table, where it can be drawn.
    pub chart: Option<Draw>,
    /// Makes the manifest of the rows, where it has more than that of any table.
    pub manifest: Option<Documented>,
}

/// Rows that are made where they are needed: their number, and those from one to before another.
pub type Parts = (usize, Box<dyn Fn(usize, usize) -> Table + Send + Sync>);

/// Makes a manifest.
pub type Documented = Box<dyn Fn(&Manifest) -> String + Send + Sync>;

/// Makes the chart of a table.
pub type Draw = Box<dyn Fn(&Table, &Framing) -> Result<Chart, Error> + Send + Sync>;

impl Answered {
    /// An answer of one table.
    pub fn new(table: Table) -> Self {
        Self { table, parts: None, beside: Vec::new(), remarks: Vec::new(), chart: None, manifest: None }
    }

    /// An answer of this number of rows, which `part` makes.
    pub(crate) fn in_parts(
        rows: usize,
        part: impl Fn(usize, usize) -> Table + Send + Sync + 'static,
    ) -> Self {
        Self { parts: Some((rows, Box::new(part))), ..Self::new(Table::new()) }
    }

    /// The whole table.
    pub fn into_table(self) -> Table {
        self.parts.map_or(self.table, |(rows, part)| part(0, rows))
    }

    /// The same with a further table.
    pub(crate) fn beside(mut self, table: Table) -> Self {
        self.beside.push(table);
        self
    }

    /// The same with a manifest of its own.
    pub(crate) fn documented(self, manifest: impl Fn(&Manifest) -> String + Send + Sync + 'static) -> Self {
        Self { manifest: Some(Box::new(manifest)), ..self }
    }

    /// The same with remarks.
    pub fn told<R: Into<Remark>>(self, remarks: impl IntoIterator<Item = R>) -> Self {
        Self { remarks: remarks.into_iter().map(Into::into).collect(), ..self }
    }

    /// The same without a column that its picture alone needs.
    fn hiding(mut self, name: &'static str) -> Self {
        let Some(hidden) = self.table.column(name).cloned() else { return self };
        self.table = self.table.without(name);
        let Some(chart) = self.chart.take() else { return self };
        self.drawn(move |table, framing| chart(&table.clone().with(name, hidden.values.clone()), framing))
    }

    /// The same with a picture.
    pub fn drawn(
        self,
        chart: impl Fn(&Table, &Framing) -> Result<Chart, Error> + Send + Sync + 'static,
    ) -> Self {
        Self { chart: Some(Box::new(chart)), ..self }
    }
}

/// The rows of a grid as they come.
pub struct Streamed {
    /// The rows.
    pub rows: Box<dyn Rows>,
    /// What all rows, of this number, do not say, from the counts of their cells and the time in s.
    pub remark: fn(&Tally, usize, f64) -> String,
    /// The counts in their manifest.
    pub manifest: fn(&Manifest, &Grid, &Tally) -> String,
    /// Draws them.
    pub chart: Draw,
}

/// Rows of the cells of a grid, not yet computed.
pub trait Rows {
    /// The table without rows.
    fn header(&self) -> Table;

    /// Number of cells, in each direction of a walk.
    fn count(&self) -> u64;

    /// The mechanism of the first cell.
    fn first_mechanism(&self) -> Option<Arc<Mechanism>>;

    /// Checks all cells.
    fn validate(&self, pool: &Pool, task: &Task) -> Result<(), CellFaults>;

    /// Computes the rows and hands them over in order, until no more are wanted; the error is that of the
    /// cancelled task.
    fn run(
        &self,
        pool: &Pool,
        task: &Task,
        write: &mut dyn FnMut(&Table) -> bool,
    ) -> Result<Tally, Cancelled>;
}

impl<Q: Question> Rows for GridStudy<Q> {
    fn header(&self) -> Table {
        self.empty_table()
    }

    fn count(&self) -> u64 {
        self.rows()
    }

    fn first_mechanism(&self) -> Option<Arc<Mechanism>> {
        self.first_mechanism().ok()
    }

    fn validate(&self, pool: &Pool, task: &Task) -> Result<(), CellFaults> {
        self.validate(pool, task)
    }

    fn run(
        &self,
        pool: &Pool,
        task: &Task,
        write: &mut dyn FnMut(&Table) -> bool,
    ) -> Result<Tally, Cancelled> {
        self.run::<Infallible>(pool, task, |table| Ok(write(table))).map_err(|_| Cancelled)
    }
}

/// A sentence about an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// The sentence.
    pub text: Said,
    /// Whether it is said even where only errors are wanted.
    pub is_warning: bool,
}

impl Remark {
    /// A sentence on what went wrong.
    pub fn warning(text: String) -> Self {
        Self { is_warning: true, ..text.into() }
    }
}

impl From<String> for Remark {
    fn from(text: String) -> Self {
        Self { text: Said::new(text), is_warning: false }
    }
}

/// How an answer is drawn.
#[derive(Debug, Clone, Copy)]
pub struct Framing<'a> {
    /// A column, or the panels of a run.
    pub quantity: Option<&'a str>,
    /// Ranges of the axes.
    pub ranges: Ranges,
    /// Ends a run that is made for the picture.
    pub cancel: &'a AtomicBool,
}

/// The grid over these fields, or that of the scene alone.
pub(crate) fn grid_or_one(over: &Over, simulation: &Simulation) -> Result<Grid, Error> {
    if over.is_empty() { Ok(Grid::of_one()) } else { simulation.grid(over) }
}

/// Answers a study about a simulation.
pub fn answer<S: Study>(
    study: &S,
    simulation: &Simulation,
    progress: &Progress,
) -> Result<(Grid, Answered), Error> {
    let grid = grid_or_one(study.over(), simulation)?;
    let answer = answer_in(study, &Scenes::of(simulation, &grid), progress)?;
    Ok((grid, answer))
}

/// Answers a study about these scenes, whatever fields it names; all rows of a grid are in memory.
pub fn answer_in<S: Study>(study: &S, scenes: &Scenes, progress: &Progress) -> Result<Answered, Error> {
    study.check(scenes)?;
    let Some(Streamed { rows, chart, .. }) = study.streamed(scenes, progress)? else {
        return Ok(study.answer(scenes, progress)?.hiding(IMPACTS));
    };
    let mut all = rows.header();
    progress.pool(|pool| {
        let wrong = |cell| Error::cells_of(scenes.document, vec![cell]);
        rows.validate(pool, &progress.silent()).map_err(wrong)?;
        let mut append = |table: &Table| {
            all.append(table);
            true
        };
        let end = progress.task(Some(rows.count()), |task| rows.run(pool, task, &mut append));
        end.map_err(|Cancelled| Error::Cancelled)
    })??;
    Ok(Answered { chart: Some(chart), ..Answered::new(all) }.hiding(IMPACTS))
}

/// The heading of arguments that say how an answer is drawn; a program gives them with its picture.
pub const PICTURE: &str = "Picture";

/// The name of a column and what it means; without words it shares those of the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Heading {
    /// Its name, with the unit at its end.
    pub name: &'static str,
    /// What it means, as the documents say it.
    pub words: &'static str,
}

/// The headings of columns.
pub(crate) fn headings<R>(columns: Vec<ColumnOf<R>>) -> Vec<Heading> {
    columns.into_iter().map(|column| column.heading).collect()
}

/// The values of a column from what its rows are made of.
type Collected<'a, R> = Box<dyn Fn(&[R]) -> Values + 'a>;

/// A column of a table whose rows are made from `R`.
pub(crate) struct ColumnOf<'a, R> {
    pub heading: Heading,
    values: Collected<'a, R>,
}

/// A column with the value of `of` in each row.
pub(crate) fn column<'a, R, V>(
    name: &'static str,
    words: &'static str,
    of: impl Fn(&R) -> V + 'a,
) -> ColumnOf<'a, R>
where
    Values: FromIterator<V>,
{
    let values = Box::new(move |rows: &[R]| rows.iter().map(&of).collect());
    ColumnOf { heading: Heading { name, words }, values }
}

impl Table {
    /// The table with these columns on its right, a row for each of `rows`.
    #[must_use]
    pub(crate) fn with_columns<R>(self, columns: &[ColumnOf<R>], rows: &[R]) -> Self {
        columns.iter().fold(self, |table, column| table.with(column.heading.name, (column.values)(rows)))
    }
}

/// A number of things, such as `1 cell` or `2 cells`.
pub fn counted(count: u64, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}

/// Reads a whole number in a range; the error names the range.
pub fn whole<T: TryFrom<u64>>(
    range: RangeInclusive<u64>,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.trim().parse().ok().filter(|number| range.contains(number));
        let wrong = || format!("give a whole number from {} to {}", range.start(), range.end());
        number.and_then(|number| T::try_from(number).ok()).ok_or_else(wrong)
    }
}

/// Reads a finite number, plain or as arithmetic; the error says what to give.
pub fn number(remedy: &'static str) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = read_number(text).ok().filter(|number| number.is_finite());
        number.ok_or_else(|| remedy.to_owned())
    }
}

/// `count` evenly spaced values over a range, each rounded to 15 significant digits, so that 0.58 is 0.58 and
/// not 0.5800000000000001.
pub(crate) fn even(range: RangeInclusive<f64>, count: usize) -> Vec<f64> {
    let (from, to) = (*range.start(), *range.end());
    let last = count.saturating_sub(1).max(1) as f64;
    let value = |i: usize| {
        let plain = from + (to - from) * (i as f64 / last);
        format!("{plain:.14e}").parse().unwrap_or(plain)
    };
    (0..count).map(value).collect()
}

/// Methods that set the fields of a grid.
macro_rules! over_fields {
    ($($study:ident)*) => {$(
        impl $study {
            /// A grid over a field, with `count` even values including both ends of the range.
            pub fn over(
                field: impl Into<String>,
                range: std::ops::RangeInclusive<f64>,
                count: usize,
            ) -> Self {
                Self::default().and(field, range, count)
            }

            /// A grid over these values of a field.
            pub fn over_values(field: impl Into<String>, values: impl Into<Vec<f64>>) -> Self {
                Self::default().and_values(field, values)
            }

            /// Adds a field to the grid, whose values change faster than those of the fields before it.
            #[must_use]
            pub fn and(
                self,
                field: impl Into<String>,
                range: std::ops::RangeInclusive<f64>,
                count: usize,
            ) -> Self {
                self.and_values(field, $crate::study::even(range, count))
            }

            /// Adds a field with these values to the grid, which change faster than those of the fields
            /// before it.
            #[must_use]
            pub fn and_values(mut self, field: impl Into<String>, values: impl Into<Vec<f64>>) -> Self {
                self.over.push((field.into(), values.into()));
                self
            }
        }
    )*};
}
pub(crate) use over_fields;

/// The methods of a study: those of its grid, and `run`.
macro_rules! study_methods {
    ($($study:ident)*) => {$(
        $crate::study::over_fields!($study);

        impl $study {
            /// Computes the table.
            pub fn run(
                &self,
                simulation: &$crate::questions::Simulation,
                progress: &$crate::questions::Progress,
            ) -> Result<$crate::study::Table, $crate::questions::Error> {
                Ok($crate::study::answer(self, simulation, progress)?.1.table)
            }
        }
    )*};
}
pub(crate) use study_methods;
