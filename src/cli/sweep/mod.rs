//! `sweep`: a grid of runs, one row for each cell, with progress on standard error.

mod dry_run;
mod prepared;
mod rows;

use interwell::output::{Chart, Made, Overlay, Ranges, SweepPicture, header, is_regular, rows, sweep_chart};
use interwell::questions::Table;
use interwell::scene::Document;
use interwell_studies::study::{SweepOptions, Tally};

use super::grid_job::GridJob;
use super::support::{counted, inputs, pool};
use super::{Common, Failure, Output, Outputs, refuse};
pub use prepared::Arguments;
use prepared::Prepared;
use rows::{Compared, Rows};

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let prepared = Prepared::new(options, common)?;
    let pool = pool(common)?;
    if options.dry_run {
        return dry_run::print(&prepared, &pool);
    }
    let Prepared { document, out, sweep, slice, picture, plan, .. } = &prepared;
    let out = Some(&**out).filter(|_| !options.check);
    let outputs = Outputs::new(&inputs(&options.scene, document)).with_rows(out)?;
    let mut job = GridJob::open(document, common, outputs, *picture, pool)?;
    let opened = prepared.open_rows(&mut job.outputs)?;
    let Some((mut rows_out, mut all)) = opened else { return prepared.has_all_rows(common) };
    let from = all.cells;
    if let (Rows::Blocks(blocks), Some(_), 1..) = (&rows_out, picture, from) {
        job.shown = blocks.table(&sweep.empty_table().only(&prepared.columns))?;
        let lacking = prepared.lacking_columns().join(" and ");
        if !lacking.is_empty() {
            let lost = "the picture marks neither transients nor hysteresis";
            common.say(&format!("warning: {lost}: the rows that were there have no {lacking}"));
        }
    }
    let result = job.run(sweep, slice, from, "cells", |outputs, table, tally| {
        rows_out.put(outputs, rows(&table.only(&prepared.columns), 0..usize::MAX), tally)
    });
    let tally = match result {
        Ok(tally) => tally,
        Err(end) => return Err(rows_out.ended(end)),
    };
    all.add(&tally);
    if let Rows::Compared(file) = &mut rows_out {
        file.end()?;
        common.say(&format!("{}: all {} rows are the same", prepared.data().display(), all.cells));
    }
    let chart = |rows: &Table, ranges| prepared.chart(rows, ranges);
    let wall_s = job.finish(chart, |manifest| {
        let sha256 = rows_out.close()?;
        let (shard, mechanisms) = (slice.shard(), sweep.mechanisms());
        let made = Made { plan, shard, sha256: &sha256, mechanisms };
        Ok(manifest.of_rows(sweep.grid(), &all, Some(made)))
    })?;
    // The rows get their name last: until then --resume can continue them.
    rows_out.finish()?;
    // If there are fewer, the reader of a pipe has gone.
    if tally.cells == slice.rows() - from {
        report(common, document, &tally, wall_s);
    }
    let early = all.ended_early + all.not_converged;
    if options.strict && early > 0 {
        let cells = format!("{early} of {} cells did not come to their end", all.cells);
        return Err(Failure::failed(format!("{}: {cells} (see the column outcome)", document.name)));
    }
    Ok(())
}

impl Prepared<'_> {
    /// Opens the rows, in blocks if they go to a regular file. Returns the tally of the rows that an
    /// earlier process left; `None` if no row is missing.
    fn open_rows(&self, outputs: &mut Outputs) -> Result<Option<(Rows, Tally)>, Failure> {
        let header = header(&self.sweep.empty_table().only(&self.columns));
        if self.options.check {
            let mut file = Compared::new(&self.data())?;
            file.put(&header)?;
            return Ok(Some((Rows::Compared(file), Tally::default())));
        }
        let sink = if is_regular(&self.out) { outputs.take(Output::DATA) } else { None };
        let Some(sink) = sink else {
            outputs.write(Output::DATA, &header)?;
            return Ok(Some((Rows::Stream, Tally::default())));
        };
        Ok(self.open_blocks(&header, sink)?.map(|(blocks, tally)| (Rows::Blocks(Box::new(blocks)), tally)))
    }

    /// Says that nothing is left to do; an error if a picture was requested.
    fn has_all_rows(&self, common: &Common) -> Result<(), Failure> {
        let (out, rows) = (self.out.display(), self.slice.rows());
        if self.picture.is_some() {
            refuse!(
                "--resume: {out} has all its rows already: leave --resume out to compute them for a picture"
            );
        }
        common.say(&format!("{out} has all {rows} rows already"));
        Ok(())
    }

    fn chart(&self, rows: &Table, ranges: Ranges) -> Result<Chart, Failure> {
        let (grid, scene) = (self.sweep.grid(), &self.document.scene);
        let &SweepOptions { until_settled, ref draws, .. } = self.sweep.options();
        let overlay = Overlay::of(scene, self.mechanism.as_deref(), grid, rows);
        let (quantity, view, draws) = (self.quantity, self.view.clone(), &*draws.about());
        let shown = SweepPicture { rows, grid, scene, until_settled, quantity, overlay, view, ranges, draws };
        Ok(sweep_chart(&shown)?)
    }
}

fn report(common: &Common, document: &Document, tally: &Tally, wall_s: f64) {
    let cells = counted(tally.cells, "cell");
    let early = match (tally.ended_early, tally.not_converged) {
        (0, 0) => String::new(),
        (n, 0) => format!(", {n} ended early (see the column outcome)"),
        (0, n) => format!(", {n} without a solution of the flexures (see the column outcome)"),
        (n, m) => {
            format!(", {n} ended early and {m} without a solution of the flexures (see the column outcome)")
        }
    };
    common.say(&format!("{cells} in {wall_s:.2} s{early}"));
    if tally.yielding > 0 {
        common.say(&format!(
            "warning: {}: in {} of them the contact with a stop yields, which the model does not follow",
            document.name, tally.yielding
        ));
    }
}
