//! Sweep: a run for each cell of a grid, with one row per cell.

use std::sync::atomic::AtomicBool;

use super::Draws;
use crate::dynamics::{Model, Request, Run};
use crate::scene::{Fault, Scene};
use crate::study::grid_study::fields;
use crate::study::walk::without_a_period;
use crate::study::{Carry, Cell, Grid, GridStudy, Question, Row, SummaryField, Table, Tally, Values};

/// The columns that every sweep has after those of its fields.
pub const STANDARD_COLUMNS: [&str; 7] =
    ["rms_velocity_m_per_s", "regime", "crossings", "impacts", "max_abs_x_m", "period", OUTCOME];

pub(super) const OUTCOME: &str = "outcome";

/// Options of a sweep beyond running each cell for its duration.
#[derive(Debug, Clone, Default)]
pub struct SweepOptions {
    /// Columns besides the [standard](STANDARD_COLUMNS) ones; with one of the ledger, cells are run one at a
    /// time.
    pub columns: Vec<&'static SummaryField>,
    /// Each run continues until its motion repeats, at most up to this time in s.
    pub until_settled: Option<f64>,
    /// The last field is walked, as [`Sweep`](crate::questions::Sweep) says; the rows are in its order.
    pub carry: Option<Carry>,
    /// Draws of uncertain fields, which are run in each cell besides the cell itself; without `carry`.
    pub draws: Draws,
}

/// A run for each cell of a grid, with one row per cell.
pub type Sweep = GridStudy<SweepOptions>;

impl Question for SweepOptions {
    type Answer = Cell;

    fn request(&self) -> Option<Request<'_>> {
        let ledger = self.columns.iter().any(|field| field.needs_ledger);
        Some(Request { ledger, until_settled: self.until_settled, ..Request::default() })
    }

    fn fault(&self, model: &Model, scene: &Scene) -> Option<Fault> {
        self.carry.and_then(|_| without_a_period(model, scene, "a walk from cell to cell"))
    }

    fn answer(&self, _: &Model, run: Option<Run>, _: &AtomicBool) -> Cell {
        run.map_or(Cell::NotRun, |run| Cell::Run(run.summary))
    }

    fn without_model(cell: Cell) -> Cell {
        cell
    }

    fn count(tally: &mut Tally, cell: &Cell) {
        tally.count(cell);
    }

    fn table(&self, grid: &Grid, rows: &[Row<Cell>]) -> Table {
        let cells = (!self.draws.is_empty()).then(|| self.draws.cells(rows));
        let table = fields(grid, cells.as_deref().unwrap_or(rows), |_| 1, self.carry.is_some());
        let standard = STANDARD_COLUMNS.into_iter().filter_map(SummaryField::find);
        let more = self.columns.iter().copied().filter(|field| !STANDARD_COLUMNS.contains(&field.name));
        let all = standard.chain(more);
        let Some(cells) = cells else {
            return all.fold(table, |table, field| table.with(field.name, column(field, rows)));
        };
        let table = all.fold(table, |table, field| {
            let table = table.with(field.name, column(field, &cells));
            self.draws.with_band(table, field, rows, |cell| word(field, cell))
        });
        self.draws.with_count(table, rows)
    }

    fn draws(&self) -> Option<&Draws> {
        Some(&self.draws).filter(|draws| !draws.is_empty())
    }

    fn carry(&self) -> Option<Carry> {
        self.carry
    }
}

fn column(field: &SummaryField, rows: &[Row<Cell>]) -> Values {
    match field.name {
        // also for cells without a run
        OUTCOME => Values::Words(rows.iter().map(|row| row.answer.outcome()).collect()),
        _ => field.column(rows.iter().map(|row| row.answer.summary())),
    }
}

/// The word of a cell in a column of words.
fn word(field: &SummaryField, cell: &Cell) -> &'static str {
    match field.name {
        OUTCOME => cell.outcome(),
        _ => cell.summary().and_then(|summary| field.word(summary)).unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::mechanics::FlexureError;
    use crate::scene::Document;
    use crate::study::Task;
    use crate::system::threads::Pool;

    #[test]
    fn a_mechanism_that_was_not_solved_is_an_outcome_of_its_cells() {
        let mut document = Document::load("nominal-cubic").unwrap();
        document.set("run.duration_s=1").unwrap();
        document.set("run.settle_s=0").unwrap();
        let over = ["mechanism.linear_n_per_m=-40,-30", "excitation.amplitude_g=0.5,1,1.5"];
        let grid = Grid::new(document.axes(&over).unwrap()).unwrap();
        let sweep = Sweep::new(&document.scene, &document.files, grid);
        let error = FlexureError::NotConverged { x: 1e-3, residual: 1.0, is_preloaded: true };
        sweep.set_mechanism(1, Err(error.into()));
        let pool = Pool::new(2).unwrap();
        let cancel = AtomicBool::new(false);
        let task = Task { tick: &|| (), cancel: &cancel };
        sweep.validate(&pool, &task).unwrap();
        let mut rows = Table::new();
        let write = |table: &Table| {
            rows.append(table);
            Ok::<_, ()>(true)
        };
        let tally = sweep.run(&pool, &task, write).unwrap();
        assert_eq!((tally.cells, tally.ended_early, tally.not_converged, tally.mechanisms), (6, 0, 3, 1));
        assert_eq!(tally.outcomes, BTreeMap::from([("done".into(), 3), ("not_converged".into(), 3)]));
        let words = |name: &str| rows.column(name).unwrap().values.clone();
        let outcomes = [["done"; 3], ["not_converged"; 3]].concat();
        assert_eq!(words("outcome"), Values::Words(outcomes));
        assert!(rows.numbers("rms_velocity_m_per_s").unwrap()[3..].iter().all(|speed| speed.is_nan()));
        assert!(rows.numbers("max_abs_x_m").unwrap()[3..].iter().all(|x| x.is_nan()));
        for name in ["crossings", "impacts", "period"] {
            assert!(matches!(words(name), Values::Counts(counts) if counts[3..] == [None; 3]), "{name}");
        }
        assert!(matches!(words("regime"), Values::Words(words) if words[3..] == [""; 3]));
    }
}
