//! `sweep`: a grid of runs, one row for each cell, with progress on standard error.

mod asked;
mod dry_run;
mod rows;

use clap::Args;
use interwell::output::{
    Made, Overlay, Sink, SweepPicture, can_show, csv_table, header, manifest, plan, sweep_figure,
};
use interwell::scene::Document;
use interwell::study::{Grid, SummaryField, Sweep, SweepEnd, SweepOptions, Table, Tally, Task};
use serde_json::json;

use super::failure::Failure;
use super::options::{ChartOptions, Common};
use super::picture::{Picture, caption, ranges};
pub use super::progress::bar;
use super::shard;
use super::support::{
    MANIFEST, Watch, finish, inputs, load, open, refuse_electrical_state, until_settled, warn, write_text,
};
pub use super::support::{file_name, located, manifest_path, pool};
use super::{interrupt, say};
use asked::{Settings, view};
use rows::{Blocks, Compared, RowFile, Rows};

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
    asked::has_manifest(options)?;
    let picture = Picture::new(&options.chart.plot, common)?;
    let axes = ranges(&options.chart, "--plot-x")?;
    let (mut document, warnings) = load(&options.scene, common, Some(&options.over))?;
    // Rows, plan and manifest then refer to the same bytes, even if the files change during the sweep.
    document.hold_files();
    let settings = Settings::new(options, &document)?;
    let out = shard::placed(common.out(), options.shard.as_deref(), settings.shard)?;
    let beside = manifest_path(&out).filter(|_| !options.check);
    let sweep = Sweep::new(&document.scene, &document.files, Grid::new(document.axes(&options.over)?)?);
    let mechanism = asked::first_mechanism(&document, &sweep)?;
    if settings.carry.is_some() {
        refuse_electrical_state(&document, sweep.grid().axes(), "--carry")?;
    }
    let (more, columns) = settings.columns(sweep.grid())?;
    let trial = Task { tick: &|| (), cancel: interrupt::listen() };
    let until_settled = match &sweep.first_model(&trial).and_then(Result::ok) {
        Some(model) => until_settled(settings.until_settled.as_deref(), &document, model)?,
        None => None, // `validate_rows` reports the fault below, with its cell
    };
    // the quantity of the picture is computed even if its column is not written
    let quantity = picture.is_some().then_some(&options.quantity);
    let shown = quantity.filter(|name| !columns.contains(name));
    let fields = columns.iter().chain(shown).filter_map(|name| SummaryField::find(name)).collect();
    let sweep = sweep.with(SweepOptions { columns: fields, until_settled, carry: settings.carry });
    let slice = sweep.slice(settings.shard);
    warn(&document, common, &warnings, mechanism.as_deref());
    let view = view(options, sweep.grid())?;
    if picture.is_some() {
        can_show(sweep.grid(), (&options.quantity, &view), &sweep.empty_table())?;
    }
    let pool = pool(common)?;
    if options.dry_run {
        let parts = (picture.is_some(), options.shard.is_some());
        return dry_run::print((&document, &sweep, &slice), &columns, parts, &pool);
    }
    let manifest_out = beside.as_deref().map(|path| (MANIFEST, path));
    let [plot, data] = Picture::outputs(picture);
    let rows_out = Some(("--out", &*out)).filter(|_| !options.check);
    let mut sinks = open(&inputs(&options.scene, &document), [rows_out, plot, data, manifest_out])?;
    // The manifest is opened again when it is written: a killed process would leave its unfinished file.
    sinks[3] = None;
    let mut shown = picture.map(|_| Table::new());

    let mut plan = plan(&document, &sweep, &more, env!("CARGO_PKG_VERSION"));
    (plan["rows"], plan["unit"]) = (json!(sweep.rows()), json!(slice.unit()));
    let first = header(&sweep.empty_table().only(&columns));
    let mut before = Tally::default();
    let mut rows = match sinks[0].take() {
        None => {
            let mut file = Compared::new(&settings.data)?;
            file.put(&first)?;
            Rows::Compared(file)
        }
        Some(_) if beside.is_some() => {
            let (unit, header) = (slice.unit(), &*first);
            let (shard, rows, plan, out) = (settings.shard, slice.rows(), &plan, &*out);
            let Arguments { resume, force, .. } = *options;
            let table = sweep.empty_table();
            let mut needed =
                Some(&*options.quantity).into_iter().chain(table.columns().iter().map(|c| &*c.name));
            let lacking =
                needed.find(|name| picture.is_some() && !columns.iter().any(|column| column == name));
            let lacking = lacking.map(str::to_owned);
            match (RowFile { out, plan, shard, rows, unit, header, resume, force, lacking }).open()? {
                Some((blocks, tally)) => {
                    before = tally;
                    Rows::Blocks(blocks)
                }
                None if picture.is_none() => {
                    if !common.quiet {
                        say(&format!("{} has all {rows} rows already", out.display()));
                    }
                    return Ok(());
                }
                None => {
                    let out = out.display();
                    let problem = format!("--resume: {out} has all its rows already: leave --resume out");
                    return Err(Failure::argument(format!("{problem} to compute them for a picture")));
                }
            }
        }
        Some(mut sink) => {
            sink.put(&first).map_err(|error| Failure::writing(sink.name(), error))?;
            Rows::Stream(sink)
        }
    };
    let from = before.cells;
    if let (Some(shown), Rows::Blocks(blocks)) = (&mut shown, &rows) {
        *shown = shown_before(blocks, &sweep, from)?;
    }

    let bar = bar(slice.rows(), "cells", common.quiet, &out);
    bar.begin_at(from);
    let task = Task { tick: &|| bar.inc(1), cancel: interrupt::listen() };
    let watch = Watch::start();
    let result = (|| {
        let valid = sweep.validate_rows(&slice, from, &pool, &task);
        valid.map_err(|cell| SweepEnd::Write(located(&document, cell)))?;
        let write = |table: &Table, tally: &Tally| {
            if let Some(shown) = &mut shown {
                shown.append(table);
            }
            let text = interwell::output::rows(&table.only(&columns), 0..usize::MAX);
            // A picture needs all rows, even if the reader of a pipe has gone.
            Ok(rows.put(text, tally)? || shown.is_some())
        };
        sweep.run_rows(&slice, from, &pool, &task, write)
    })();
    bar.finish_and_clear();
    let tally = match (result, rows) {
        (Ok(tally), kept) => {
            rows = kept;
            tally
        }
        (Err(SweepEnd::Cancelled), Rows::Blocks(blocks)) => return Err(blocks.interrupted()),
        (Err(SweepEnd::Cancelled), _) => return Err(Failure::interrupted()),
        (Err(SweepEnd::Write(failure)), rows) => {
            if let Rows::Blocks(blocks) = rows {
                blocks.leave();
            }
            return Err(failure);
        }
    };
    if let Some((picture, rows)) = picture.zip(shown) {
        let grid = sweep.grid();
        // The overlay holds for runs from rest only.
        let overlay = match settings.carry {
            Some(_) => Overlay::default(),
            None => Overlay::of(&document.scene, mechanism.as_deref(), grid, &rows),
        };
        let (rows, scene, quantity) = (&rows, &document.scene, &*options.quantity);
        let shown = SweepPicture { rows, grid, scene, until_settled, quantity, overlay, view, ranges: axes };
        picture.write(&mut sinks[1..3], sweep_figure(&shown, &caption(&document), &picture.theme)?)?;
    }
    before.add(&tally);
    let all = before;
    match rows {
        Rows::Stream(sink) => sinks[0] = Some(sink),
        Rows::Compared(mut file) => {
            file.end()?;
            if !common.quiet {
                say(&format!("{}: all {} rows are the same", settings.data.display(), all.cells));
            }
        }
        Rows::Blocks(mut blocks) => {
            let sha256 = blocks.close()?;
            let made = Made { plan: &plan, shard: settings.shard, sha256: &sha256 };
            let (grid, origin) = (sweep.grid(), watch.origin(pool.count()));
            let text = manifest(("sweep", &document), grid, &all, Some(made), &origin, &file_name(&out));
            sinks[3] = beside.as_deref().map(Sink::open).transpose()?;
            write_text(&mut sinks[3], &text)?;
            // The rows get their name last: until then --resume can continue them.
            finish(sinks)?;
            sinks = [const { None }; 4];
            blocks.finish()?;
        }
    }
    finish(sinks)?;
    report(common.quiet, &document, &tally, (slice.rows(), from), watch.wall_s());
    let early = all.ended_early + all.not_converged;
    if options.strict && early > 0 {
        let cells = format!("{early} of {} cells did not come to their end", all.cells);
        return Err(Failure::Failed(anyhow::anyhow!("{}: {cells} (see the column outcome)", document.name)));
    }
    Ok(())
}

/// Reads the rows of an earlier process for a picture.
fn shown_before(blocks: &Blocks, sweep: &Sweep, from: u64) -> Result<Table, Failure> {
    if from == 0 {
        return Ok(Table::new());
    }
    let read = csv_table(&blocks.text()?, &sweep.empty_table());
    read.map_err(|problem| Failure::Failed(anyhow::anyhow!("the rows that are there: {problem}")))
}

/// Prints a summary of the sweep of `rows` rows, of which `before` were there already.
fn report(quiet: bool, document: &Document, tally: &Tally, (rows, before): (u64, u64), wall_s: f64) {
    // With fewer cells the reader of a pipe has gone, which is not worth a message.
    if quiet || tally.cells != rows - before {
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
