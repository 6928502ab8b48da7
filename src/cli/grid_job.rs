//! Run of a study over a grid by a command: its outputs, progress, rows, picture and manifest.

use interwell::output::{Chart, Manifest, Ranges};
use interwell::questions::Error;
use interwell::questions::Table;
use interwell::scene::Document;
use interwell::system::threads::Pool;
use interwell_studies::study::{GridStudy, Question, Slice, SweepEnd, Tally, Task};

use super::support::Watch;
use super::{Common, Failure, Output, Outputs, Picture, bar, interrupt};

/// A study of a grid whose outputs are open.
pub struct GridJob<'a> {
    pub outputs: Outputs,
    /// The rows so far, if they are drawn.
    pub shown: Table,
    document: &'a Document,
    common: &'a Common,
    picture: Option<Picture<'a>>,
    pool: Pool,
}

impl<'a> GridJob<'a> {
    /// Opens the picture beside `outputs`.
    pub fn open(
        document: &'a Document,
        common: &'a Common,
        outputs: Outputs,
        picture: Option<Picture<'a>>,
        pool: Pool,
    ) -> Result<Self, Failure> {
        let mut outputs = outputs.with_picture(picture)?;
        // The manifest is opened only when it is written, since a killed process would leave it unfinished.
        outputs.leave(Output::MANIFEST);
        Ok(Self { outputs, shown: Table::new(), document, common, picture, pool })
    }

    /// Checks and runs the rows of a slice from `from` on, each called `unit`, and hands them to `write`,
    /// which returns whether more rows are needed. With a picture all rows are run, even after the reader of
    /// a pipe has gone.
    pub fn run<Q: Question>(
        &mut self,
        study: &GridStudy<Q>,
        slice: &Slice,
        from: u64,
        unit: &str,
        mut write: impl FnMut(&mut Outputs, &Table, &Tally) -> Result<bool, Failure>,
    ) -> Result<Tally, SweepEnd<Failure>> {
        self.outputs.watch = Watch::start();
        let runs = study.runs_per_row();
        let unit = if runs > 1 { "runs" } else { unit };
        let progress = bar(runs * slice.rows(), runs * from, unit, self.common);
        let task = Task { tick: &|| progress.inc(1), cancel: interrupt::listen() };
        let valid = study.validate_rows(slice, from, &self.pool, &task);
        valid.map_err(|cell| SweepEnd::Write(Error::cells_of(self.document, vec![cell]).into()))?;
        study.run_rows(slice, from, &self.pool, &task, |table, tally| {
            if self.picture.is_some() {
                self.shown.append(table);
            }
            Ok(write(&mut self.outputs, table, tally)? || self.picture.is_some())
        })
    }

    /// Draws the rows, writes the manifest and gives the outputs their names. Returns the wall-clock time
    /// since the rows began in s.
    pub fn finish(
        mut self,
        chart: impl FnOnce(&Table, Ranges) -> Result<Chart, Failure>,
        manifest: impl FnOnce(&Manifest) -> Result<String, Failure>,
    ) -> Result<f64, Failure> {
        self.outputs.draw(self.picture, self.document, |ranges| chart(&self.shown, ranges))?;
        self.outputs.manifest(Some(self.document), self.pool.count(), manifest)?;
        let watch = self.outputs.watch;
        self.outputs.finish()?;
        Ok(watch.wall_s())
    }
}
