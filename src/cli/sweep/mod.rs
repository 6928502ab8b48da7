//! `sweep`: a grid of runs, one row for each cell, with progress on standard error.

mod dry_run;
mod prepared;
mod rows;

use clap::Args;
use interwell::output::{Figure, Made, Overlay, SweepPicture, header, manifest, rows, sweep_figure};
use interwell::scene::Document;
use interwell::study::{SweepOptions, Table, Tally};
use serde_json::Value;

use super::failure::Failure;
use super::grid_job::GridJob;
use super::options::{ChartOptions, Common};
use super::outputs::{Output, Outputs};
use super::picture::{Picture, caption};
use super::say;
use super::support::{file_name, inputs, manifest_path, pool};
use prepared::Prepared;
use rows::{Compared, RowFile, Rows};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// Sweep a field; replaces the scene's own sweep (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// Columns after those of the swept fields: names of the summary, or all [default: rms_velocity_m_per_s,
    /// regime, crossings, impacts, max_abs_x_m, period, outcome]
    #[arg(long, value_name = "A,B,..|all", allow_hyphen_values = true, value_delimiter = ',')]
    pub columns: Vec<String>,

    /// Let each run go on, window after window, until its motion repeats, or up to this time in s. Needs a
    /// drive that repeats
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    /// Walk the last --over field in its order (up), backwards (down) or both ways: each cell begins in the
    /// state of the one before, only the first at the scene's start. Needs a drive that repeats
    #[arg(long, value_name = "up|down|both", value_parser = ["up", "down", "both"])]
    pub carry: Option<String>,

    /// With --plot: the column that is shown, any one of --columns all
    #[arg(long, value_name = "COLUMN", requires = "plot", default_value = "rms_velocity_m_per_s")]
    pub quantity: String,

    /// With --plot, over two fields: a surface whose height is the quantity
    #[arg(long, requires = "plot", conflicts_with = "cut")]
    pub surface: bool,

    /// With --plot, over two fields: beside the map the quantity along a line through it, at this value of a
    /// field (repeatable, at most twice)
    #[arg(long, value_name = "FIELD=VALUE", allow_hyphen_values = true, requires = "plot")]
    pub cut: Vec<String>,

    /// Go on with the rows that an earlier process left in FILE.part, where there are some
    #[arg(long)]
    pub resume: bool,

    /// Begin anew, whatever an earlier process left; with --resume: keep its rows before a damaged one
    #[arg(long)]
    pub force: bool,

    /// Compute the I-th of N parts alone; auto or auto/N within an array job of Slurm or HyperQueue. {shard}
    /// in --out becomes I-of-N. `merge` puts the parts together
    #[arg(long, value_name = "I/N|auto", allow_hyphen_values = true, conflicts_with = "plot")]
    pub shard: Option<String>,

    /// Say how many cells there are, about how long they take and what memory, and which commands run them
    #[arg(long, conflicts_with_all = ["resume", "force"])]
    pub dry_run: bool,

    /// With a manifest as SCENE: run it again, write nothing, and compare its rows byte for byte
    #[arg(long, conflicts_with_all = ["out", "plot", "shard", "dry_run", "resume", "force"])]
    pub check: bool,

    /// End with exit status 1 where a cell ended early
    #[arg(long)]
    pub strict: bool,

    #[command(flatten)]
    pub chart: ChartOptions,
}

/// Runs the grid and writes one row for each cell.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let prepared = Prepared::new(options, common)?;
    let pool = pool(common)?;
    if options.dry_run {
        return dry_run::print(&prepared, &pool);
    }
    let Prepared { document, out, sweep, slice, picture, .. } = &prepared;
    let manifest_out = manifest_path(out).filter(|_| !options.check);
    let in_blocks = manifest_out.is_some();
    let outputs = Outputs::new(&inputs(&options.scene, document))
        .with(Output::DATA, Some(&**out).filter(|_| !options.check))?;
    let mut job = GridJob::open(document, common, outputs, out, *picture, manifest_out, pool)?;
    let plan = prepared.plan();
    let opened = prepared.open_rows(&mut job.outputs, in_blocks, &plan)?;
    let Some((mut rows_out, mut all)) = opened else { return prepared.has_all_rows(common.quiet) };
    let from = all.cells;
    if let (Rows::Blocks(blocks), Some(_), 1..) = (&rows_out, picture, from) {
        job.shown = blocks.table(&sweep.empty_table())?;
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
        if !common.quiet {
            say(&format!("{}: all {} rows are the same", prepared.data.display(), all.cells));
        }
    }
    let figure = |rows: &Table, picture: &Picture| prepared.figure(rows, picture);
    let wall_s = job.finish(figure, |origin| {
        let sha256 = rows_out.close()?;
        let made = Made { plan: &plan, shard: slice.shard(), sha256: &sha256 };
        Ok(manifest("sweep", document, sweep.grid(), &all, Some(made), origin, &file_name(out)))
    })?;
    // The rows get their name last: until then --resume can continue them.
    rows_out.finish()?;
    report(common.quiet, document, &tally, slice.rows() - from, wall_s);
    let early = all.ended_early + all.not_converged;
    if options.strict && early > 0 {
        let cells = format!("{early} of {} cells did not come to their end", all.cells);
        return Err(Failure::Failed(anyhow::anyhow!("{}: {cells} (see the column outcome)", document.name)));
    }
    Ok(())
}

impl Prepared<'_> {
    /// Opens the rows, `in_blocks` if they go to a regular file. Returns the tally of those that an earlier
    /// process left; `None` if there are all of them.
    fn open_rows(
        &self,
        outputs: &mut Outputs,
        in_blocks: bool,
        plan: &Value,
    ) -> Result<Option<(Rows, Tally)>, Failure> {
        let header = header(&self.sweep.empty_table().only(&self.columns));
        if self.options.check {
            let mut file = Compared::new(&self.data)?;
            file.put(&header)?;
            return Ok(Some((Rows::Compared(file), Tally::default())));
        }
        if !in_blocks {
            outputs.write(Output::DATA, &header)?;
            return Ok(Some((Rows::Stream, Tally::default())));
        }
        outputs.leave(Output::DATA);
        let file = RowFile { sweep: self, plan, header: &header };
        Ok(file.open()?.map(|(blocks, tally)| (Rows::Blocks(blocks), tally)))
    }

    /// Says that nothing is left to do; an error if a picture was requested.
    fn has_all_rows(&self, quiet: bool) -> Result<(), Failure> {
        let (out, rows) = (self.out.display(), self.slice.rows());
        if self.picture.is_some() {
            return Err(Failure::argument(format!(
                "--resume: {out} has all its rows already: leave --resume out to compute them for a picture"
            )));
        }
        if !quiet {
            say(&format!("{out} has all {rows} rows already"));
        }
        Ok(())
    }

    fn figure(&self, rows: &Table, picture: &Picture) -> Result<Figure, Failure> {
        let (grid, scene) = (self.sweep.grid(), &self.document.scene);
        let &SweepOptions { until_settled, carry, .. } = self.sweep.options();
        // The overlay holds for runs from rest only.
        let overlay = match carry {
            Some(_) => Overlay::default(),
            None => Overlay::of(scene, self.mechanism.as_deref(), grid, rows),
        };
        let (quantity, view, ranges) = (&*self.options.quantity, self.view.clone(), picture.ranges);
        let shown = SweepPicture { rows, grid, scene, until_settled, quantity, overlay, view, ranges };
        Ok(sweep_figure(&shown, &caption(&self.document), &picture.theme)?)
    }
}

/// Prints a summary of the `rows` that were computed now.
fn report(quiet: bool, document: &Document, tally: &Tally, rows: u64, wall_s: f64) {
    // With fewer cells the reader of a pipe has gone, which is not worth a message.
    if quiet || tally.cells != rows {
        return;
    }
    let cells = if tally.cells == 1 { "1 cell".to_owned() } else { format!("{} cells", tally.cells) };
    let early = match (tally.ended_early, tally.not_converged) {
        (0, 0) => String::new(),
        (n, 0) => format!(", {n} ended early (see the column outcome)"),
        (0, n) => format!(", {n} without a solution of the flexures (see the column outcome)"),
        (n, m) => {
            format!(", {n} ended early and {m} without a solution of the flexures (see the column outcome)")
        }
    };
    say(&format!("{cells} in {wall_s:.2} s{early}"));
    if tally.yielding > 0 {
        say(&format!(
            "warning: {}: in {} of them the contact with a stop yields, which the model does not follow",
            document.name, tally.yielding
        ));
    }
}
