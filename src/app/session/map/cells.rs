//! Cells of a map, as far as they are known, and its lines.

use std::sync::Arc;
use std::time::Duration;

use crate::app::session::editor::Editor;
use crate::app::task::Answer;
use crate::app::words::fields::in_words;
use crate::mechanics::Mechanism;
use crate::numeric::short;
use crate::output::{header, rows};
use crate::scene::{Scene, SceneError};
use crate::study::{
    Cell, Edges, Grid, Levels, STRIDES, SummaryField, Sweep, SweepOptions, Table, first_crossing,
    first_crossing_edge, release_line,
};

use super::{Question, over};

/// Largest number of cells of a map in the window.
const MAX_CELLS: u64 = 200_000;

/// Why a map of this many cells is not made; none where it is.
pub(super) fn too_many(cells: u64) -> Option<String> {
    let words = || format!("{cells} cells are more than the window makes ({MAX_CELLS}): take longer steps");
    (cells > MAX_CELLS).then(words)
}

/// A cell on a line through a map.
pub struct CutCell<'a> {
    /// Its place along the line.
    pub place: usize,
    /// What it came to.
    pub cell: &'a Cell,
    /// Whether it lies on the line; if not it is the nearest one that is known so far.
    pub on_line: bool,
}

/// A map as far as it is known.
pub struct Map {
    pub question: Question,
    /// The cells across and up.
    pub edges: [Edges; 2],
    /// The least amplitude that frees the mass, in closed form, where that makes sense: `x` and `y` of its
    /// points.
    pub release: Vec<(f64, f64)>,
    /// Where the first crossing cells begin, as far as is known.
    pub crossing: Vec<Vec<(f64, f64)>>,
    pub(super) sweep: Arc<Sweep>,
    levels: Levels,
    cells: Vec<Option<Cell>>,
    /// Number of cells that are known.
    known: usize,
    /// The work after which its lines were last drawn.
    lines_after: Option<Duration>,
    /// The work after which it had every cell of its coarsest level.
    pub coarse_after: Option<Duration>,
}

impl Map {
    /// The map of a question before its first cell, or why there is none. `mechanism` is that of the open
    /// scene.
    pub(super) fn new(question: &Question, editor: &Editor, mechanism: &Mechanism) -> Result<Self, String> {
        let mut document = editor.document().clone();
        document.scene = question.scene.clone();
        let words = |error: SceneError| in_words(&error.to_string(), &question.scene);
        document.check().map_err(words)?;
        let arguments = question.axes.each_ref().map(over);
        let axes = document.axes(&arguments).map_err(words)?;
        let grid = Grid::new(axes).map_err(|error| error.to_string())?;
        if let Some(problem) = too_many(grid.cells()) {
            return Err(problem);
        }
        let [across, up] = grid.axes() else { return Err("a map has two axes".to_owned()) };
        let edges = [across, up].map(|axis| Edges::new(&axis.values));
        let cells = vec![None; grid.cells() as usize];
        let (levels, release) = (Levels::of(&grid), release(&question.scene, mechanism, &grid));
        let columns = question.ledger.and_then(SummaryField::find).into_iter().collect();
        let options = SweepOptions { columns, ..SweepOptions::default() };
        let sweep = Arc::new(Sweep::new(&document.scene, &document.files, grid).with(options));
        Ok(Self {
            question: question.clone(),
            edges,
            release,
            crossing: Vec::new(),
            sweep,
            levels,
            cells,
            known: 0,
            lines_after: None,
            coarse_after: None,
        })
    }

    /// How many cells there are.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there are none, which does not happen.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    pub fn known(&self) -> usize {
        self.known
    }

    /// Whether every cell is known.
    pub fn is_whole(&self) -> bool {
        self.known == self.cells.len()
    }

    /// Whether every cell of its coarsest level is known.
    pub fn is_covered(&self) -> bool {
        self.levels.whole(self.known).is_some()
    }

    pub fn grid(&self) -> &Grid {
        self.sweep.grid()
    }

    /// Number of columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.edges[0].values.len(), self.edges[1].values.len()]
    }

    /// The cell in a column and row, or the one that stands for it meanwhile, and whether it is the cell
    /// itself.
    pub fn cell(&self, column: usize, row: usize) -> Option<(&Cell, bool)> {
        let index = (column * self.size()[1] + row) as u64;
        if let Some(cell) = self.cells.get(index as usize)? {
            return Some((cell, true));
        }
        let levels = (0..STRIDES.len() - 1).rev();
        let stand_in = |level| self.cells[self.levels.stand_in(index, level) as usize].as_ref();
        levels.filter_map(stand_in).next().map(|cell| (cell, false))
    }

    pub fn known_cells(&self) -> impl Iterator<Item = &Cell> {
        self.cells.iter().flatten()
    }

    /// The cells that are still to be run, level by level.
    pub(super) fn missing(&self) -> Vec<Vec<u64>> {
        let mut begin = 0;
        let level = |end: usize| {
            let cells = &self.levels.order[begin..end];
            begin = end;
            cells.iter().copied().filter(|index| self.cells[*index as usize].is_none()).collect()
        };
        self.levels.ends.into_iter().map(level).collect()
    }

    /// Length of the settled window in s.
    pub fn window_s(&self) -> String {
        let run = self.question.scene.run;
        short(run.duration_s - run.settle_s.unwrap_or(0.5 * run.duration_s))
    }

    /// The rows of the sweep, with stand-ins where they are still to come.
    fn table(&self) -> Table {
        let [columns, rows] = self.size();
        let cell = |i: usize| self.cell(i / rows, i % rows).map_or(Cell::NotRun, |found| *found.0);
        let cells: Vec<Cell> = (0..columns * rows).map(cell).collect();
        self.sweep.table(0, &cells)
    }

    /// The cells along a line through the map: up in a column (`upright`), or across in a row. A cell that is
    /// not known is replaced by the nearest one of the coarse levels, and left out where there is none.
    pub fn cut(&self, upright: bool, at: usize) -> Vec<CutCell<'_>> {
        let [columns, rows] = self.size();
        let index = |place: usize| if upright { at * rows + place } else { place * rows + at };
        let along = |index: u64| if upright { index as usize % rows } else { index as usize / rows };
        let cell = |place: usize| {
            let index = index(place) as u64;
            if let Some(cell) = self.cells[index as usize].as_ref() {
                return Some(CutCell { place, cell, on_line: true });
            }
            let stand_ins = (0..STRIDES.len() - 1).rev().map(|level| self.levels.stand_in(index, level));
            let beside = |other: &u64| along(*other) == place;
            let cell = stand_ins.filter(beside).find_map(|other| self.cells[other as usize].as_ref())?;
            Some(CutCell { place, cell, on_line: false })
        };
        (0..if upright { rows } else { columns }).filter_map(cell).collect()
    }

    /// The map as the command line writes it with these columns after those of its axes.
    pub(super) fn csv(&self, columns: &[&str]) -> String {
        let mut table = self.table();
        for field in columns.iter().filter_map(|name| SummaryField::find(name)) {
            if table.column(field.name).is_none() {
                let summaries = self.cells.iter().map(|cell| cell.as_ref().and_then(Cell::summary));
                table = table.with(field.name, field.column(summaries));
            }
        }
        let axes = self.grid().columns().iter().cloned();
        let names: Vec<String> = axes.chain(columns.iter().map(|name| (*name).to_owned())).collect();
        let table = table.only(&names);
        header(&table) + &rows(&table, 0..usize::MAX)
    }

    /// Draws the line of first crossings again after `worked` of work; in a large map not for every part.
    fn draw_lines(&mut self, worked: Duration) {
        let every = Duration::from_micros(10 * self.len() as u64);
        if !self.is_whole() && self.lines_after.is_some_and(|last| worked < last + every) {
            return;
        }
        self.lines_after = Some(worked);
        let table = self.table();
        let columns = self.grid().columns();
        let names = (columns[0].as_str(), columns[1].as_str());
        self.crossing = first_crossing(self.grid(), &table)
            .map(|line| first_crossing_edge(&line, names, &self.edges[0], &self.edges[1]))
            .unwrap_or_default();
    }
}

impl Answer<(u64, Cell)> for Map {
    fn add(&mut self, cells: Vec<(u64, Cell)>, worked: Duration) {
        for (index, cell) in cells {
            self.known += usize::from(self.cells[index as usize].replace(cell).is_none());
        }
        if self.is_covered() {
            self.coarse_after.get_or_insert(worked);
            self.draw_lines(worked);
        }
    }

    /// Meanwhile a map is shown that is covered, over the same fields, and has the column of this one.
    fn replaces(&self, before: &Self) -> bool {
        let fields = |map: &Self| map.question.axes.clone().map(|axis| axis.field);
        let has_column = before.question.ledger.is_some() || self.question.ledger.is_none();
        self.is_covered() || !before.is_covered() || fields(before) != fields(self) || !has_column
    }
}

/// The points of the line of least amplitudes that free the mass; none where the mechanism changes over the
/// map.
fn release(scene: &Scene, mechanism: &Mechanism, grid: &Grid) -> Vec<(f64, f64)> {
    let line = || release_line(scene, mechanism, grid);
    let Some(line) = (!grid.changes_mechanism()).then(line).flatten() else { return Vec::new() };
    let columns = grid.columns();
    let (x, y) = (line.numbers(&columns[0]), line.numbers(&columns[1]));
    x.into_iter().flatten().copied().zip(y.into_iter().flatten().copied()).collect()
}
