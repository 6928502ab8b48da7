//! `sweep`: a grid of runs, a row a cell, with progress on standard error.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use interwell::mechanics::{BuildError, Mechanism};
use interwell::output::{
    Cut, Overlay, SweepPicture, View, can_show, header, is_regular, manifest, rows, sweep_figure,
};
use interwell::scene::Document;
use interwell::study::{
    Carry, DIRECTION, Grid, STANDARD_COLUMNS, SUMMARY_FIELDS, SummaryField, Sweep, SweepEnd, SweepOptions,
    Table, Task,
};

use interwell::system::threads::{Pool, processors};

use super::failure::{Failure, wrong_cell};
use super::options::{Common, PlotOptions, RangeOptions};
use super::picture::{Picture, caption, ranges};
use super::support::{
    MANIFEST, Watch, finish, inputs, load, open, refuse_electrical_state, unbuilt, until_settled, warn,
    write_text,
};
use super::{interrupt, say};

/// What it takes.
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

    /// The picture.
    #[command(flatten)]
    pub plot: PlotOptions,

    /// Its axes.
    #[command(flatten)]
    pub ranges: RangeOptions,

    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// Runs the grid and writes a row a cell.
pub fn run(options: &Arguments) -> Result<(), Failure> {
    let common = &options.common;
    let picture = Picture::asked(&options.plot, &options.common)?;
    let axes = ranges(&options.ranges, "--plot-x")?;
    let (mut document, warnings) = load(&options.scene, common, Some(&options.over))?;
    let beside = manifest_path(common.out());
    if beside.is_some() {
        // The rows and the manifest are of the same bytes, whatever becomes of the files meanwhile.
        document.hold_files();
    }
    let sweep = Sweep::new(&document.scene, &document.files, Grid::new(document.axes(&options.over)?)?);
    let mechanism = first_mechanism(&document, &sweep)?;
    let carry = options.carry.as_deref().and_then(Carry::named);
    if carry.is_some() {
        refuse_electrical_state(&document, sweep.grid().axes(), "--carry")?;
    }
    let columns = columns(&options.columns, sweep.grid(), carry)?;
    let looked_at = Task { tick: &|| (), cancel: interrupt::listen() };
    let until_settled = match &sweep.first_model(&looked_at).and_then(Result::ok) {
        Some(model) => until_settled(options.until_settled.as_deref(), &document, model)?,
        None => None, // said below, cell by cell
    };
    // what is shown need not be written
    let asked = picture.is_some().then_some(&options.quantity);
    let shown = asked.filter(|name| !columns.contains(name));
    let fields = columns.iter().chain(shown).filter_map(|name| SummaryField::find(name)).collect();
    let sweep = sweep.with(SweepOptions { columns: fields, until_settled, carry });
    warn(&document, common, &warnings, mechanism.as_deref());
    let view = view(options, sweep.grid())?;
    if picture.is_some() {
        can_show(sweep.grid(), (&options.quantity, &view), &sweep.empty_table())?;
    }
    let pool = pool(common)?;
    let beside = beside.as_deref().map(|path| (MANIFEST, path));
    let [plot, data] = Picture::outputs(picture);
    let outputs = [Some(("--out", common.out())), plot, data, beside];
    let mut sinks = open(&inputs(&options.scene, &document), outputs)?;
    let mut shown = picture.map(|_| Table::new());

    let bar = bar(sweep.rows(), "cells", common.quiet, common.out());
    let task = Task { tick: &|| bar.inc(1), cancel: interrupt::listen() };
    let watch = Watch::start();
    let result = (|| {
        sweep.validate(&pool, &task).map_err(|cell| located(&document, cell))?;
        write_text(&mut sinks[0], &header(&sweep.empty_table().only(&columns)))?;
        let write = |table: &Table| {
            if let Some(shown) = &mut shown {
                shown.append(table);
            }
            write_text(&mut sinks[0], &rows(&table.only(&columns), 0..usize::MAX))?;
            let Some(sink) = &mut sinks[0] else { return Ok(false) };
            sink.flush().map_err(|error| Failure::writing(sink.name(), error))?;
            // Where the reader of a pipe has gone, a picture may still be wanted.
            Ok(!sink.is_closed() || shown.is_some())
        };
        sweep.run(&pool, &task, write).map_err(|end| match end {
            SweepEnd::Cancelled => Failure::interrupted(),
            SweepEnd::Write(failure) => failure,
        })
    })();
    bar.finish_and_clear();
    let tally = result?;
    if let Some((picture, rows)) = picture.zip(shown) {
        let grid = sweep.grid();
        // They are about runs from rest.
        let overlay = match carry {
            Some(_) => Overlay::default(),
            None => Overlay::of(&document.scene, mechanism.as_deref(), grid, &rows),
        };
        let (rows, scene, quantity) = (&rows, &document.scene, &*options.quantity);
        let shown = SweepPicture { rows, grid, scene, until_settled, quantity, overlay, view, ranges: axes };
        picture.write(&mut sinks[1..3], sweep_figure(&shown, &caption(&document), &picture.theme)?)?;
    }
    if sinks[3].is_some() {
        let data = file_name(common.out());
        let grid = sweep.grid();
        let origin = watch.origin(pool.count());
        let text = manifest(("sweep", &document), grid, &tally, &origin, &data);
        write_text(&mut sinks[3], &text)?;
    }
    finish(sinks)?;
    // Fewer cells than there are: the reader of a pipe has gone, which is no news to anyone.
    if !common.quiet && tally.cells == sweep.rows() {
        let cells = if tally.cells == 1 { "1 cell".to_owned() } else { format!("{} cells", tally.cells) };
        let early = match (tally.ended_early, tally.not_converged) {
            (0, 0) => String::new(),
            (n, 0) => format!(", {n} ended early (see the column outcome)"),
            (0, n) => format!(", {n} without a solution of the flexures (see the column outcome)"),
            (n, m) => format!(
                ", {n} ended early and {m} without a solution of the flexures (see the column outcome)"
            ),
        };
        say(&format!("{cells} in {:.2} s{early}", watch.wall_s()));
        if tally.yielding > 0 {
            say(&format!(
                "warning: {}: in {} of them the contact with a stop yields, which the model does not follow",
                document.name, tally.yielding
            ));
        }
    }
    Ok(())
}

/// The most cuts beside a map.
const MOST_CUTS: usize = 2;

/// How the picture shows a sweep of this grid.
fn view(options: &Arguments, grid: &Grid) -> Result<View, Failure> {
    if options.surface {
        return Ok(View::Surface);
    }
    let mut cuts: Vec<Cut> = Vec::new();
    for text in &options.cut {
        let wrong = |problem: String| Failure::argument(format!("--cut {text}: {problem}"));
        let known = || grid.columns().join(", ");
        let form = || wrong(format!("write FIELD=VALUE with a field of the sweep: {}", known()));
        let (field, value) = text.split_once('=').ok_or_else(form)?;
        let field = field.trim();
        let place = grid
            .axes()
            .iter()
            .zip(grid.columns())
            .position(|(axis, column)| axis.field == field || column == field);
        let place = place.ok_or_else(|| wrong(format!("no field of the sweep; these are: {}", known())))?;
        let value: f64 = value.trim().parse().map_err(|_| form())?;
        let column = grid.columns()[place].clone();
        let values = &grid.axes()[place].values;
        if !values.contains(&value) {
            let mut near: Vec<f64> = values.clone();
            near.sort_by(|a, b| (a - value).abs().total_cmp(&(b - value).abs()));
            near.truncate(2);
            let near: Vec<String> = near.iter().map(f64::to_string).collect();
            return Err(wrong(format!(
                "the sweep has no such value; the nearest are {}",
                near.join(" and ")
            )));
        }
        if cuts.len() == MOST_CUTS {
            return Err(wrong(format!("at most {MOST_CUTS} cuts stand beside a map")));
        }
        cuts.push(Cut { column, value });
    }
    Ok(if cuts.is_empty() { View::Top } else { View::Cuts(cuts) })
}

/// The columns of the rows: those of the swept fields, the direction of a walk, and what was asked for.
fn columns(asked: &[String], grid: &Grid, carry: Option<Carry>) -> Result<Vec<String>, Failure> {
    let mut names = grid.columns().to_vec();
    names.extend(carry.map(|_| DIRECTION.to_owned()));
    match asked {
        [] => names.extend(STANDARD_COLUMNS.map(str::to_owned)),
        [all] if all == "all" => {
            let more = SUMMARY_FIELDS.iter().map(|field| field.name);
            let more = more.filter(|name| !STANDARD_COLUMNS.contains(name));
            names.extend(STANDARD_COLUMNS.into_iter().chain(more).map(str::to_owned));
        }
        list => {
            for name in list.iter().map(|name| name.trim()) {
                let Some(field) = SummaryField::find(name) else {
                    let known: Vec<&str> = SUMMARY_FIELDS.iter().map(|field| field.name).collect();
                    return Err(Failure::argument(format!(
                        "--columns {name}: no such column; there are all, {}",
                        known.join(", ")
                    )));
                };
                if names.iter().any(|known| known == field.name) {
                    return Err(Failure::argument(format!("--columns {name}: named twice; name it once")));
                }
                names.push(field.name.to_owned());
            }
        }
    }
    Ok(names)
}

/// The mechanism of the sweep's first cell. Where it was not solved: none, if the mechanism is swept, since
/// that is an outcome of the cell; an error, if it is that of every cell.
fn first_mechanism(document: &Document, sweep: &Sweep) -> Result<Option<Arc<Mechanism>>, Failure> {
    match sweep.first_mechanism() {
        Ok(mechanism) => Ok(Some(mechanism)),
        Err(BuildError::Unsolved(_)) if sweep.grid().changes_mechanism() => Ok(None),
        Err(error) => Err(unbuilt(document, error)),
    }
}

/// Where the manifest of the rows at `out` goes: beside them, where they are a regular file.
pub fn manifest_path(out: &Path) -> Option<PathBuf> {
    is_regular(out).then(|| {
        let mut name = out.as_os_str().to_owned();
        name.push(".json");
        name.into()
    })
}

/// The name of the file with the rows.
pub fn file_name(out: &Path) -> String {
    out.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// As many threads as were asked for.
pub fn pool(common: &Common) -> Result<Pool, Failure> {
    let count = common.jobs.map_or_else(processors, usize::from);
    Pool::new(count).map_err(|error| Failure::Failed(error.into()))
}

/// The error of a cell that is wrong, with the places of its faults.
pub fn located(document: &Document, cell: interwell::study::CellFaults) -> Failure {
    let error = document.error_from(cell.faults.clone());
    wrong_cell(&cell, error)
}

/// A bar of so many parts, called `unit`, with rate and time left, where standard error is a terminal that
/// the rows do not go to too.
pub fn bar(parts: u64, unit: &str, quiet: bool, out: &Path) -> ProgressBar {
    let rows_on_terminal = out == Path::new("-") && std::io::stdout().is_terminal();
    if quiet || rows_on_terminal || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let template = format!("{{wide_bar}} {{human_pos}}/{{human_len}} {unit}  {{rate}}  {{eta}} left");
    let style = ProgressStyle::with_template(&template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let rate = |state: &ProgressState, text: &mut dyn std::fmt::Write| {
        let _ = write!(text, "{:.0}/s", state.per_sec());
    };
    ProgressBar::new(parts).with_style(style.with_key("rate", rate))
}
