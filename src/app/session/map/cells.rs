//! Cells of a map, as far as they are known, and the lines drawn over them.

use std::sync::Arc;
use std::time::Duration;

use crate::app::session::editor::Editor;
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

const MAX_CELLS: u64 = 200_000;

/// Why a map of so many cells is not made; `None` if it is.
pub(super) fn too_many(cells: u64) -> Option<String> {
    let problem = || format!("{cells} cells are more than the window makes ({MAX_CELLS}): take longer steps");
    (cells > MAX_CELLS).then(problem)
}

/// A cell on a line through a map.
pub struct CutCell<'a> {
    /// Its index along the line.
    pub place: usize,
    pub cell: &'a Cell,
    /// Whether the result is of this cell; if not, it is of the nearest cell that is known so far.
    pub is_known: bool,
}

pub struct Map {
    pub question: Question,
    /// The edges of the cells across and up.
    pub edges: [Edges; 2],
    /// Least amplitude that releases the mass from a stop, in closed form where it exists: its points.
    pub release: Vec<(f64, f64)>,
    /// The edge of the first crossing cells, as far as they are known.
    pub crossing: Vec<Vec<(f64, f64)>>,
    pub(super) sweep: Arc<Sweep>,
    levels: Levels,
    cells: Vec<Option<Cell>>,
    known: usize,
    /// Computing time after which its lines were last drawn.
    lines_after: Option<Duration>,
    pub took: Duration,
    /// Computing time after which every cell of its coarsest level was known.
    pub coarse_after: Option<Duration>,
}

impl Map {
    /// The map of a question before its first cell, or why there is none. `mechanism` is that of the session.
    pub(super) fn new(question: &Question, editor: &Editor, mechanism: &Mechanism) -> Result<Self, String> {
        let mut document = editor.document().clone();
        document.scene = question.scene.clone();
        let message = |error: SceneError| in_words(&error.to_string(), &question.scene);
        document.check().map_err(message)?;
        let arguments = question.axes.each_ref().map(over);
        let axes = document.axes(&arguments).map_err(message)?;
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
            took: Duration::ZERO,
            coarse_after: None,
        })
    }

    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there are no cells, which does not occur.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    pub fn known(&self) -> usize {
        self.known
    }

    pub fn is_whole(&self) -> bool {
        self.known == self.cells.len()
    }

    /// Whether every part of the map shows a result, at least that of a coarse cell.
    pub fn is_covered(&self) -> bool {
        self.levels.whole(self.known).is_some()
    }

    pub fn grid(&self) -> &Grid {
        self.sweep.grid()
    }

    /// Number of columns and of rows.
    pub fn size(&self) -> [usize; 2] {
        [self.edges[0].values.len(), self.edges[1].values.len()]
    }

    /// The cell in a column and row, or its stand-in until it is known, and whether it is the cell itself.
    pub fn cell(&self, column: usize, row: usize) -> Option<(&Cell, bool)> {
        self.cell_or_stand_in(column * self.size()[1] + row, |_| true)
    }

    /// The cell of an index or, until it is known, its stand-in on the finest level where that is known and
    /// its index `fits`; and whether it is the cell itself.
    fn cell_or_stand_in(&self, index: usize, fits: impl Fn(usize) -> bool) -> Option<(&Cell, bool)> {
        if let Some(cell) = self.cells.get(index)? {
            return Some((cell, true));
        }
        let stand_in = |level| self.levels.stand_in(index as u64, level) as usize;
        let mut stand_ins = (0..STRIDES.len() - 1).rev().map(stand_in).filter(|other| fits(*other));
        stand_ins.find_map(|other| self.cells[other].as_ref()).map(|cell| (cell, false))
    }

    pub fn known_cells(&self) -> impl Iterator<Item = &Cell> {
        self.cells.iter().flatten()
    }

    /// The indices of the cells that are not known, level by level.
    pub(super) fn missing(&self) -> Vec<Vec<u64>> {
        let mut begin = 0;
        let level = |end: usize| {
            let cells = &self.levels.order[begin..end];
            begin = end;
            cells.iter().copied().filter(|index| self.cells[*index as usize].is_none()).collect()
        };
        self.levels.ends.into_iter().map(level).collect()
    }

    pub(super) fn add(&mut self, cells: Vec<(u64, Cell)>) {
        for (index, cell) in cells {
            self.known += usize::from(self.cells[index as usize].replace(cell).is_none());
        }
        if self.is_covered() {
            self.coarse_after.get_or_insert(self.took);
            self.draw_lines();
        }
    }

    /// Whether it may be shown until the other map is covered: it has the fields and columns of that map.
    pub(super) fn stands_in_for(&self, other: &Self) -> bool {
        let fields = |map: &Self| map.question.axes.clone().map(|axis| axis.field);
        let has_columns = self.question.ledger.is_some() || other.question.ledger.is_none();
        fields(self) == fields(other) && has_columns
    }

    /// Length of the settled window in s.
    pub fn window_s(&self) -> String {
        let run = self.question.scene.run;
        short(run.duration_s - run.settle_s.unwrap_or(0.5 * run.duration_s))
    }

    /// The rows of the sweep, with stand-ins for the cells that are not known yet.
    fn table(&self) -> Table {
        let [columns, rows] = self.size();
        let cell = |i: usize| self.cell(i / rows, i % rows).map_or(Cell::NotRun, |found| *found.0);
        self.sweep.table(0, (0..columns * rows).map(cell))
    }

    /// The cells along a line through the map: up a column (`upright`), or across a row. A cell that is not
    /// known yet has a stand-in from a coarser level, or is left out.
    pub fn cut(&self, upright: bool, at: usize) -> Vec<CutCell<'_>> {
        let [columns, rows] = self.size();
        let index = |place: usize| if upright { at * rows + place } else { place * rows + at };
        let along = |index: usize| if upright { index % rows } else { index / rows };
        let cell = |place: usize| {
            let (cell, is_known) = self.cell_or_stand_in(index(place), |other| along(other) == place)?;
            Some(CutCell { place, cell, is_known })
        };
        (0..if upright { rows } else { columns }).filter_map(cell).collect()
    }

    /// The map as the command line writes it, with these columns after those of its axes.
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

    /// Updates the line of first crossings, on a large map not for every part.
    fn draw_lines(&mut self) {
        let every = Duration::from_micros(10 * self.len() as u64);
        if !self.is_whole() && self.lines_after.is_some_and(|last| self.took < last + every) {
            return;
        }
        self.lines_after = Some(self.took);
        let table = self.table();
        let columns = self.grid().columns();
        let names = (columns[0].as_str(), columns[1].as_str());
        self.crossing = first_crossing(self.grid(), &table)
            .map(|line| first_crossing_edge(&line, names, &self.edges[0], &self.edges[1]))
            .unwrap_or_default();
    }
}

/// Points of the least amplitude that releases the mass; none if the mechanism changes over the map.
fn release(scene: &Scene, mechanism: &Mechanism, grid: &Grid) -> Vec<(f64, f64)> {
    let line = || release_line(scene, mechanism, grid);
    let Some(line) = (!grid.changes_mechanism()).then(line).flatten() else { return Vec::new() };
    let columns = grid.columns();
    let (x, y) = (line.numbers(&columns[0]), line.numbers(&columns[1]));
    x.into_iter().flatten().copied().zip(y.into_iter().flatten().copied()).collect()
}
