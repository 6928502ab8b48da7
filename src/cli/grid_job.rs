//! Run of a study over a grid by a command: its progress, its rows and its picture.

use interwell::output::{Provenance, header, rows};
use interwell::scene::Document;
use interwell::study::{GridStudy, Question, Shard, Slice, SweepEnd, Table, Tally, Task};
use interwell::system::threads::Pool;

use super::failure::Failure;
use super::interrupt;
use super::outputs::{Output, Outputs};
use super::picture::Picture;
use super::progress::Progress;
use super::support::{Watch, located};

/// A study of a grid that runs, with the outputs of its command open.
pub struct GridJob<'a> {
    pub outputs: Outputs,
    document: &'a Document,
    pool: Pool,
    watch: Watch,
    progress: Progress,
    picture: Option<Picture<'a>>,
    /// The rows so far, if they are drawn.
    pub shown: Table,
}

impl<'a> GridJob<'a> {
    /// Begins the job of a study over a document.
    pub fn new(
        document: &'a Document,
        outputs: Outputs,
        pool: Pool,
        progress: Progress,
        picture: Option<Picture<'a>>,
    ) -> Self {
        Self { outputs, document, pool, watch: Watch::start(), progress, picture, shown: Table::new() }
    }

    /// Checks the cells of a slice from its row `from` on; an error names the first wrong one.
    pub fn validate<Q: Question>(
        &self,
        study: &GridStudy<Q>,
        slice: &Slice,
        from: u64,
    ) -> Result<(), Failure> {
        let task = Task { tick: &|| (), cancel: interrupt::listen() };
        study.validate_rows(slice, from, &self.pool, &task).map_err(|cell| located(self.document, cell))
    }

    /// Runs the rows of a slice from `from` on and hands them to `write`, which answers whether more are
    /// wanted. A picture needs all of them, even if the reader of a pipe has gone.
    pub fn run<Q: Question>(
        &mut self,
        study: &GridStudy<Q>,
        slice: &Slice,
        from: u64,
        mut write: impl FnMut(&mut Outputs, &Table, &Tally) -> Result<bool, Failure>,
    ) -> Result<Tally, SweepEnd<Failure>> {
        let Self { outputs, pool, progress, picture, shown, .. } = self;
        let task = Task { tick: &|| progress.inc(1), cancel: interrupt::listen() };
        let result = study.run_rows(slice, from, pool, &task, |table, tally| {
            if picture.is_some() {
                shown.append(table);
            }
            Ok(write(outputs, table, tally)? || picture.is_some())
        });
        self.progress.finish_and_clear();
        result
    }

    /// Runs all rows and writes these of their columns to `--out` as they are computed. Returns the tally,
    /// and the number of rows.
    pub fn stream<Q: Question>(
        &mut self,
        study: &GridStudy<Q>,
        columns: &[String],
    ) -> Result<(Tally, usize), Failure> {
        self.outputs.write(Output::DATA, &header(&study.empty_table().only(columns)))?;
        let mut count = 0;
        let tally = self.run(study, &study.slice(Shard::WHOLE), 0, |outputs, table, _| {
            count += table.rows();
            outputs.stream(Output::DATA, &rows(&table.only(columns), 0..usize::MAX))
        })?;
        Ok((tally, count))
    }

    /// The picture to draw, and the rows that it shows.
    pub fn drawn(&mut self) -> Option<(Picture<'a>, Table)> {
        self.picture.map(|picture| (picture, std::mem::take(&mut self.shown)))
    }

    /// Version, arguments and times of this call of the program.
    pub fn origin(&self) -> Provenance {
        self.watch.origin(self.pool.count())
    }

    /// Gives the outputs their names. Returns the wall-clock time since the beginning in s.
    pub fn finish(self) -> Result<f64, Failure> {
        self.outputs.finish()?;
        Ok(self.watch.wall_s())
    }
}
