//! Arguments of `sweep`, and a sweep whose arguments are checked.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use interwell::mechanics::{BuildError, Mechanism};
use interwell::output::{Cut, View, can_show, plan, shown_columns};
use interwell::questions::{self, Carry, Error, Grid, SweepCells, Uncertain, assign_uncertain};
use interwell::scene::{Document, find_name, is_manifest, read_number};
use interwell_studies::study::{MAX_DRAWS, Shard, Slice, SummaryField, Sweep};
use serde_json::{Value, json};

use super::super::shard::{placed, shard};
use super::super::support::{check, read, settle_limit, warn};
use super::super::{ChartOptions, Common, Failure, Picture, interrupt, whole};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// Sweep a field; replaces the scene's own sweep (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// Columns after those of the swept fields: names of the summary, which may lack their units, or all
    /// [default: rms_velocity_m_per_s, regime, crossings, impacts, max_abs_x_m, period, outcome]
    #[arg(long, value_name = "A,B,..|all", allow_hyphen_values = true, value_delimiter = ',')]
    pub columns: Vec<String>,

    /// Follow each run, window after window, until its motion repeats, or up to this time in s. Needs a
    /// drive that repeats
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    /// Walk the last --over field in its order (up), backwards (down) or both ways: each run from the end of
    /// the one before, only the first from the scene's start. Needs a drive that repeats
    #[arg(long, value_name = "up|down|both", value_parser = ["up", "down", "both"])]
    pub carry: Option<String>,

    /// An input that is known with a standard deviation SIGMA, in the unit of the field or as a percentage of
    /// its value (repeatable): gives each column the band that 95 % of the draws lie in. Without VALUE it is
    /// the scene's or, if the field is swept, the cell's
    #[arg(long, value_name = "FIELD=[VALUE]+-SIGMA[%]", allow_hyphen_values = true)]
    pub uncertain: Vec<String>,

    /// Draws of the --uncertain fields, run for each cell [default: 100]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = whole::<u64>(1..=MAX_DRAWS))]
    pub draws: Option<u64>,

    /// Seed of the draws [default: 1]
    #[arg(long, value_name = "SEED")]
    pub seed: Option<u64>,

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

    /// Continue after the rows that an earlier process left in FILE.part, if there are any
    #[arg(long)]
    pub resume: bool,

    /// Begin anew, whatever an earlier process left; with --resume: keep its rows before a damaged one
    #[arg(long)]
    pub force: bool,

    /// Compute the I-th of N parts alone; auto or auto/N within an array job of Slurm or HyperQueue. {shard}
    /// in --out becomes I-of-N. `merge` joins the parts
    #[arg(long, value_name = "I/N|auto", allow_hyphen_values = true, conflicts_with = "plot")]
    pub shard: Option<String>,

    /// Print the number of cells, estimates of their time and memory, and the commands that run them
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

/// A sweep whose arguments are checked.
pub struct Prepared<'a> {
    pub options: &'a Arguments,
    pub document: Document,
    /// Where the rows go.
    pub out: PathBuf,
    pub sweep: Sweep,
    pub slice: Slice,
    /// The mechanism of the first cell, if it is solved.
    pub mechanism: Option<Arc<Mechanism>>,
    /// The columns that are written.
    pub columns: Vec<String>,
    /// All that decides the bytes of the rows.
    pub plan: Value,
    pub picture: Option<Picture<'a>>,
    /// The full name of the column that it shows.
    pub quantity: &'a str,
    pub view: View,
}

impl<'a> Prepared<'a> {
    /// Loads the scene, checks the arguments and prints the warnings. An argument overrides a manifest that
    /// is given as the scene.
    pub fn new(options: &'a Arguments, common: &Common) -> Result<Self, Failure> {
        let picture = Picture::of_chart(&options.chart, common)?;
        // an unknown name is reported by `can_show`, with the names that exist
        let quantity = SummaryField::named(&options.quantity).map_or(&*options.quantity, |field| field.name);
        if options.check && !is_manifest(options.scene.as_ref()) {
            return Err(no_sweep(options));
        }
        let mut document = read(&options.scene, common)?;
        let swept = document.swept.clone().unwrap_or_default();
        let uncertain = uncertain(options, swept.uncertain);
        assign_uncertain(&uncertain, &mut document)?;
        let warnings = check(&mut document, Some(&options.over))?;
        if options.check && document.swept.is_none() {
            return Err(no_sweep(options));
        }
        // Rows, plan and manifest then refer to the same bytes, even if the files change during the sweep.
        document.cache_files();
        let number = options.shard.as_ref().or(swept.shard.as_ref());
        let variable = |name: &str| std::env::var(name).ok();
        let shard = number.map_or(Ok(Shard::WHOLE), |text| shard(text, variable))?;
        let out = placed(common.out(), options.shard.as_deref(), shard)?;
        let grid = Grid::new(document.axes(&options.over)?)?;
        let until_settled = settle_limit(options.until_settled.as_deref())?.or(swept.until_settled);
        let carry = options.carry.as_ref().or(swept.carry.as_ref()).and_then(|word| Carry::named(word));
        let columns = if options.columns.is_empty() { swept.columns } else { options.columns.clone() };
        let question = questions::Sweep { over: Vec::new(), columns, until_settled, carry, uncertain };
        let view = view(options, &grid)?;
        // the columns of the picture are computed even if they are not written
        let shown = picture.map_or_else(Vec::new, |_| shown_columns(quantity, &view, &grid));
        let cells = question.cells(&document, grid, &shown, &interrupt::progress())?;
        let SweepCells { sweep, chosen, written: columns } = cells;
        let mechanism = first_mechanism(&document, &sweep)?;
        let slice = sweep.slice(shard);
        warn(&document, common, &warnings, mechanism.as_deref());
        if picture.is_some() {
            can_show(sweep.grid(), quantity, &view, &sweep.empty_table())?;
        }
        let mut plan = plan(&document, &sweep, &chosen, env!("CARGO_PKG_VERSION"));
        (plan["rows"], plan["unit"]) = (json!(sweep.rows()), json!(slice.unit()));
        Ok(Self { options, document, out, sweep, slice, mechanism, columns, plan, picture, quantity, view })
    }

    /// The file with the rows of the manifest that is given as the scene: beside it, whatever it names.
    pub fn data(&self) -> PathBuf {
        let name = self.document.swept.as_ref().map_or("", |swept| &swept.data);
        Path::new(&self.options.scene).with_file_name(Path::new(name).file_name().unwrap_or_default())
    }
}

/// The error of `--check` without the manifest of a sweep.
fn no_sweep(options: &Arguments) -> Failure {
    let problem = "give the manifest of a sweep, such as map.csv.json, as the scene";
    Failure::argument(format!("--check {}: {problem}", options.scene))
}

/// The uncertain inputs of the arguments; those of a manifest where they name none.
fn uncertain(options: &Arguments, of_manifest: Uncertain) -> Uncertain {
    let given = !options.uncertain.is_empty();
    Uncertain {
        fields: if given { options.uncertain.clone() } else { of_manifest.fields },
        draws: options.draws.or(of_manifest.draws),
        seed: options.seed.or(of_manifest.seed),
    }
}

const MAX_CUTS: usize = 2;

/// How the picture shows a sweep of this grid.
fn view(options: &Arguments, grid: &Grid) -> Result<View, Failure> {
    if options.surface {
        return Ok(View::Surface);
    }
    let mut cuts: Vec<Cut> = Vec::new();
    for text in &options.cut {
        let wrong = |problem: String| Failure::argument(format!("--cut {text}: {problem}"));
        let columns: Vec<&str> = grid.columns().iter().map(String::as_str).collect();
        let form = || wrong(format!("write FIELD=VALUE with a field of the sweep: {}", columns.join(", ")));
        let (field, value) = text.split_once('=').ok_or_else(form)?;
        let field = field.trim();
        let place = grid.axes().iter().position(|axis| axis.field == field);
        let column =
            place.map_or_else(|| find_name("field of the sweep", field, &columns), |at| Ok(columns[at]));
        let column = column.map_err(wrong)?;
        let value = read_number(value).map_err(|_| form())?;
        let place = columns.iter().position(|name| *name == column).unwrap_or(0);
        let mut near = grid.axes()[place].values.clone();
        if !near.contains(&value) {
            near.sort_by(|a, b| (a - value).abs().total_cmp(&(b - value).abs()));
            let near: Vec<String> = near.iter().take(2).map(f64::to_string).collect();
            let near = near.join(" and ");
            return Err(wrong(format!("the sweep has no such value; the nearest are {near}")));
        }
        if cuts.len() == MAX_CUTS {
            return Err(wrong(format!("at most {MAX_CUTS} cuts stand beside a map")));
        }
        cuts.push(Cut { column: column.to_owned(), value });
    }
    Ok(if cuts.is_empty() { View::Top } else { View::Cuts(cuts) })
}

/// The mechanism of the first cell. Flexures without a solution are an error if all cells have them; if the
/// mechanism is swept, they are an outcome of the cell, and this is `None`.
fn first_mechanism(document: &Document, sweep: &Sweep) -> Result<Option<Arc<Mechanism>>, Failure> {
    match sweep.first_mechanism() {
        Ok(mechanism) => Ok(Some(mechanism)),
        Err(BuildError::Unsolved(_)) if sweep.grid().changes_mechanism() => Ok(None),
        Err(error) => Err(Error::unbuilt(document, error).into()),
    }
}
