//! Cells of a map, as far as they are known, and the lines drawn over them.

use std::sync::Arc;
use std::time::Duration;

use crate::app::words::fields::in_words;
use crate::mechanics::Mechanism;
use crate::output::{Chart, Cut, NoPicture, Overlay, SweepPicture, View, csv, shown_columns, sweep_chart};
use crate::questions::{Grid, SweepCells, Table};
use crate::scene::{FieldPath, Scene};
use interwell_studies::study::{Cell, Edges, Levels, STRIDES, SummaryField};

use super::MapQuestion;

const MAX_CELLS: u64 = 200_000;

/// Why a map of this number of cells is refused; `None` if it is not.
pub(super) fn too_many(cells: u64) -> Option<String> {
    let refusal = || format!("the window computes at most {MAX_CELLS} cells, not {cells}: take longer steps");
    (cells > MAX_CELLS).then(refusal)
}

/// A map as far as it is known.
pub struct Map {
    pub question: MapQuestion,
    /// The edges of the cells across and up.
    pub edges: [Edges; 2],
    /// The release in closed form, and the first crossing cells as far as they are known.
    pub overlay: Overlay,
    pub(in crate::app::session) sweep: Arc<SweepCells>,
    levels: Levels,
    cells: Vec<Option<Cell>>,
    /// Number of cells that are known.
    pub known: usize,
    /// Computing time after which it was last drawn.
    drawn_after: Option<Duration>,
    /// Computing time so far.
    pub took: Duration,
    /// Computing time after which every cell of its coarsest level was known.
    pub coarse_after: Option<Duration>,
}

impl Map {
    /// The map of a question before its first cell, or why there is none. `mechanism` is that of the session.
    pub(super) fn new(question: &MapQuestion, mechanism: &Mechanism) -> Result<Self, String> {
        let sweep = question.sweep().map_err(|error| in_words(&error.message(), &question.scene))?;
        let grid = sweep.sweep.grid();
        if let Some(problem) = too_many(grid.cells()) {
            return Err(problem);
        }
        let [across, up] = grid.axes() else { return Err("a map has two axes".to_owned()) };
        let edges = [across, up].map(|axis| Edges::new(&axis.values));
        let mechanism = (!grid.changes_mechanism()).then_some(mechanism);
        Ok(Self {
            question: question.clone(),
            edges,
            overlay: Overlay::of(&question.scene, mechanism, grid, &Table::new()),
            levels: Levels::of(grid),
            cells: vec![None; grid.cells() as usize],
            sweep: Arc::new(sweep),
            known: 0,
            drawn_after: None,
            took: Duration::ZERO,
            coarse_after: None,
        })
    }

    pub fn count(&self) -> usize {
        self.cells.len()
    }

    pub fn is_whole(&self) -> bool {
        self.known == self.cells.len()
    }

    /// Whether every part of the map shows a result, at least that of a coarse cell.
    pub fn is_covered(&self) -> bool {
        self.levels.whole(self.known).is_some()
    }

    pub fn grid(&self) -> &Grid {
        self.sweep.sweep.grid()
    }

    /// Number of columns and of rows.
    pub fn size(&self) -> [usize; 2] {
        [self.edges[0].values.len(), self.edges[1].values.len()]
    }

    /// The cell in a column and row, or its stand-in until it is known, and whether it is the cell itself.
    pub fn cell(&self, column: usize, row: usize) -> Option<(&Cell, bool)> {
        let index = column * self.size()[1] + row;
        if let Some(cell) = self.cells.get(index)? {
            return Some((cell, true));
        }
        let stand_in = |level| self.cells[self.levels.stand_in(index as u64, level) as usize].as_ref();
        let levels = (0..STRIDES.len() - 1).rev();
        levels.filter_map(stand_in).next().map(|cell| (cell, false))
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

    /// Adds cells that have been computed. Returns whether its picture is to be drawn again; that of a large
    /// map is not drawn for every part.
    pub(super) fn add(&mut self, cells: Vec<(u64, Cell)>) -> bool {
        for (index, cell) in cells {
            self.known += usize::from(self.cells[index as usize].replace(cell).is_none());
        }
        let is_new = self.is_covered() && self.coarse_after.is_none();
        if is_new {
            self.coarse_after = Some(self.took);
        }
        let every = Duration::from_micros(10 * self.count() as u64);
        let is_recent = self.drawn_after.is_some_and(|last| self.took < last + every);
        if is_recent && !is_new && !self.is_whole() {
            return false;
        }
        self.drawn_after = Some(self.took);
        if self.is_covered() {
            let rows = self.table(true, &[]);
            self.overlay.first_crossing =
                Overlay::of(&self.question.scene, None, self.grid(), &rows).first_crossing;
        }
        true
    }

    /// Whether it may be shown until the other map is covered: it has the fields and columns of that map.
    pub(super) fn stands_in_for(&self, other: &Self) -> bool {
        let fields = |map: &Self| map.question.axes.clone().map(|axis| axis.field);
        let has_columns = self.question.ledger.is_some() || other.question.ledger.is_none();
        fields(self) == fields(other) && has_columns
    }

    /// Whether it is of the scene of a question over the same fields.
    pub(super) fn is_of_scene(&self, question: &MapQuestion) -> bool {
        let mut scene = Scene::clone(&self.question.scene.scene);
        for axis in &question.axes {
            let path = FieldPath::new(&axis.field);
            let is_set = path.get(&question.scene.scene).is_none_or(|value| path.set(&mut scene, value));
            debug_assert!(is_set, "both maps have the fields of the axes");
        }
        scene == *question.scene.scene
    }

    /// The rows of the sweep with these columns beside the standard ones, with stand-ins for the cells that
    /// are not known yet or without them.
    fn table(&self, stands_in: bool, more: &[&str]) -> Table {
        let [columns, rows] = self.size();
        let cell = |i: usize| {
            let found = self.cell(i / rows, i % rows).filter(|found| found.1 || stands_in);
            found.map_or(Cell::NotRun, |found| *found.0)
        };
        let cells: Vec<Cell> = (0..columns * rows).map(cell).collect();
        let mut table = self.sweep.sweep.table(0, cells.iter().copied());
        for field in more.iter().filter_map(|name| SummaryField::find(name)) {
            if table.column(field.name).is_none() {
                table = table.with(field.name, field.column(cells.iter().map(Cell::summary)));
            }
        }
        table
    }

    /// The cuts along the row and the column of a scene's cell, or of the nearest one.
    pub fn cuts(&self, scene: &Scene) -> Vec<Cut> {
        let (column, row) = self.nearest_cell(scene);
        let names = self.grid().columns();
        let cut =
            |i: usize, place: usize| Cut { column: names[i].clone(), value: self.edges[i].values[place] };
        vec![cut(1, row), cut(0, column)]
    }

    /// The position of a scene on both axes; `None` on an axis whose field it lacks, such as the travel limit
    /// without stops.
    pub fn place(&self, scene: &Scene) -> [Option<f64>; 2] {
        self.question.axes.each_ref().map(|axis| FieldPath::new(&axis.field).get(scene))
    }

    /// The cell of a scene, or the nearest one at the edge. No stops count as stops far out.
    pub fn nearest_cell(&self, scene: &Scene) -> (usize, usize) {
        let place = self.place(scene);
        let near = |i: usize| {
            let (edges, value) = (&self.edges[i], place[i].unwrap_or(f64::INFINITY));
            let outside = if value < edges.ends().0 { 0 } else { edges.values.len() - 1 };
            edges.cell(value).unwrap_or(outside)
        };
        (near(0), near(1))
    }

    /// The picture of the known cells, as `sweep --plot` draws it. The map also shows known cells in place of
    /// unknown ones, the cuts do not.
    pub fn chart(&self, quantity: &SummaryField, view: &View) -> Result<Chart, NoPicture> {
        let more = shown_columns(quantity.name, view, self.grid());
        let drawn = |rows: &Table, view: View| {
            let picture = SweepPicture::of_rows(rows, self.grid(), &self.question.scene, quantity.name);
            sweep_chart(&SweepPicture { overlay: self.overlay.clone(), view, ..picture })
        };
        let mut chart = drawn(&self.table(true, &more), view.clone())?;
        if matches!(view, View::Cuts(_)) && !self.is_whole() {
            let mut known = drawn(&self.table(false, &more), view.clone())?;
            if let (Some(map), Some(panel)) = (chart.first_panel(), known.first_panel()) {
                std::mem::swap(map, panel);
            }
            return Ok(known);
        }
        Ok(chart)
    }

    /// The map as the command line writes it, with these columns after those of its axes.
    pub(super) fn csv(&self, columns: &[&str]) -> String {
        let table = self.table(true, columns);
        let axes = self.grid().columns().iter().cloned();
        let names: Vec<String> = axes.chain(columns.iter().map(|name| (*name).to_owned())).collect();
        csv(&table.only(&names))
    }
}
