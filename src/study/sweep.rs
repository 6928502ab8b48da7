//! What does the mass do in every cell of a grid? One row a cell, in order, made in parallel.
//!
//! Rows leave in chunks as soon as a chunk is whole, so memory does not grow with the cells already
//! written, and what a cell gives depends on its own scene alone, so the bytes are the same for any
//! number of threads.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use rayon::ThreadPool;
use rayon::prelude::*;

use super::Task;
use super::grid::Grid;
use super::table::{Table, Values};
use crate::dynamics::{Model, Outcome, Request, Summary};
use crate::mechanics::Mechanism;
use crate::scene::{Fault, Files, Scene};

/// A scene, the grid over it, and the mechanisms that its cells share.
#[derive(Debug)]
pub struct Sweep {
    base: Scene,
    files: Files,
    grid: Grid,
    mechanisms: Vec<OnceLock<Result<Arc<Mechanism>, Fault>>>,
}

/// What is wrong with one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct CellFaults {
    /// The cell in words.
    pub cell: String,
    /// Its faults.
    pub faults: Vec<Fault>,
}

/// How a sweep ended short of its last cell; `E` is the writer's error.
#[derive(Debug)]
pub enum SweepEnd<E> {
    /// It was told to stop.
    Cancelled,
    /// The rows could not be written.
    Write(E),
}

/// What a sweep came to.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Tally {
    /// Cells run.
    pub cells: u64,
    /// Cells whose run ended early, as their outcome says.
    pub ended_early: u64,
    /// Cells by outcome.
    pub outcomes: BTreeMap<&'static str, u64>,
    /// Cells by regime; those that ended before their settled window, and those of one well, have none.
    pub regimes: BTreeMap<&'static str, u64>,
}

impl Tally {
    fn count(&mut self, row: &Summary) {
        self.ended_early += u64::from(row.outcome != Outcome::Done);
        *self.outcomes.entry(row.outcome.name()).or_default() += 1;
        if row.rms_velocity.is_some() && !row.regime.name().is_empty() {
            *self.regimes.entry(row.regime.name()).or_default() += 1;
        }
    }
}

/// Cells a thread gets per chunk: a chunk waits for its last cell, so this keeps that wait to some
/// per cent of the chunk even where one cell takes several times the others.
const CELLS_PER_THREAD: u64 = 256;

/// Mechanisms kept for the whole sweep, about 1 kB each; beyond that each cell builds its own.
const KEPT_MECHANISMS: u64 = 65_536;

impl Sweep {
    /// A sweep of `grid` over `base`, which has passed its check, as have the grid's corners.
    pub fn new(base: &Scene, files: &Files, grid: Grid) -> Self {
        // What no cell needs is not copied for each.
        let base = Scene { notes: String::new(), sweep: Vec::new(), app: None, ..base.clone() };
        let kept = Some(grid.mechanisms()).filter(|n| *n <= KEPT_MECHANISMS).unwrap_or(0);
        let mechanisms = (0..kept).map(|_| OnceLock::new()).collect();
        Self { base, files: files.clone(), grid, mechanisms }
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The table without rows.
    pub fn empty_table(&self) -> Table {
        self.table(0, &[])
    }

    /// Builds every cell without running it; the first one that is wrong, with all its
    /// faults. A cancelled check finds nothing.
    pub fn validate(&self, pool: &ThreadPool, task: &Task) -> Result<(), CellFaults> {
        let faults = |scene: &mut Scene, index: u64| {
            if task.is_cancelled() {
                return None;
            }
            let faults = self.model(index, scene).err()?;
            Some(CellFaults { cell: self.grid.describe(index), faults })
        };
        let cells = (0..self.grid.cells()).into_par_iter();
        let first = pool
            .install(|| cells.map_init(|| self.base.clone(), faults).find_first(Option::is_some).flatten());
        first.map_or(Ok(()), Err)
    }

    /// Runs every cell on `pool` and hands the rows to `write`, chunk by chunk in order. `write`
    /// answers whether more rows are wanted. Precondition: [`validate`](Self::validate) found nothing.
    pub fn run<E>(
        &self,
        pool: &ThreadPool,
        task: &Task,
        mut write: impl FnMut(&Table) -> Result<bool, E>,
    ) -> Result<Tally, SweepEnd<E>> {
        let chunk = CELLS_PER_THREAD * pool.current_num_threads() as u64;
        let mut tally = Tally::default();
        while tally.cells < self.grid.cells() {
            let begin = tally.cells;
            let end = (begin + chunk).min(self.grid.cells());
            let run = |scene: &mut Scene, offset: usize| {
                let summary = self.run_cell(begin + offset as u64, scene, task);
                (task.tick)();
                summary
            };
            let cells = (0..(end - begin) as usize).into_par_iter().with_max_len(1);
            let rows: Vec<Option<Summary>> =
                pool.install(|| cells.map_init(|| self.base.clone(), run).collect());
            if task.is_cancelled() {
                return Err(SweepEnd::Cancelled);
            }
            tally.cells = end;
            rows.iter().flatten().for_each(|row| tally.count(row));
            if !write(&self.table(begin, &rows)).map_err(SweepEnd::Write)? {
                break;
            }
        }
        Ok(tally)
    }

    fn run_cell(&self, index: u64, scene: &mut Scene, task: &Task) -> Option<Summary> {
        if task.is_cancelled() {
            return None;
        }
        let model = self.model(index, scene).ok()?;
        let request = Request { cancel: Some(task.cancel), ..Request::default() };
        Some(model.run(&request).summary)
    }

    fn model(&self, index: u64, scene: &mut Scene) -> Result<Model, Vec<Fault>> {
        self.grid.apply(index, scene);
        Model::build(scene, self.mechanism(index, scene)?)
    }

    fn mechanism(&self, index: u64, scene: &Scene) -> Result<Arc<Mechanism>, Vec<Fault>> {
        let build = || Mechanism::build(&scene.mechanism, &self.files).map(Arc::new);
        let built = match self.mechanisms.get(self.grid.mechanism(index) as usize) {
            Some(place) => place.get_or_init(build).clone(),
            None => build(),
        };
        built.map_err(|fault| vec![fault])
    }

    /// The rows of the cells from `begin` on.
    fn table(&self, begin: u64, rows: &[Option<Summary>]) -> Table {
        let mut table = Table::new();
        for (i, column) in self.grid.columns().iter().enumerate() {
            let value = |row: usize| self.grid.values(begin + row as u64).nth(i).unwrap_or(f64::NAN);
            table = table.with(column, Values::Numbers((0..rows.len()).map(value).collect()));
        }
        // A run that ended before its settled window has no numbers there, and counts of 0 would lie.
        let settled = |row: &Option<Summary>| row.filter(|summary| summary.rms_velocity.is_some());
        let numbers = |of: fn(&Summary) -> Option<f64>| {
            Values::Numbers(rows.iter().map(|r| r.as_ref().and_then(of).unwrap_or(f64::NAN)).collect())
        };
        let counts = |of: fn(&Summary) -> Option<u64>| {
            Values::Counts(rows.iter().map(|row| settled(row).as_ref().and_then(of)).collect())
        };
        let words = |of: &dyn Fn(&Option<Summary>) -> Option<&'static str>| {
            Values::Words(rows.iter().map(|row| of(row).unwrap_or("")).collect())
        };
        table
            .with("rms_velocity_m_per_s", numbers(|s| s.rms_velocity))
            .with("regime", words(&|row| settled(row).map(|s| s.regime.name())))
            .with("crossings", counts(|s| Some(s.crossings)))
            .with("impacts", counts(|s| Some(s.impacts)))
            .with("max_abs_x_m", numbers(|s| s.max_abs_x))
            .with("period", counts(|s| s.period.map(u64::from)))
            .with("outcome", words(&|row| row.map(|s| s.outcome.name())))
    }
}
