//! The arguments of the command line, and the text of `--help`.

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args, Parser, Subcommand};

const USAGE: &str = "interwell [SCENE]
       interwell --headless COMMAND [SCENE] [OPTIONS]";

const EXAMPLES: &str = "\
Examples:
  interwell --headless presets
  interwell --headless check my-scene.ron
  interwell --headless simulate --set stops.travel_limit_mm=2 --out run.csv --summary run.json
  interwell --headless simulate elastic-box --at 0,0.5,1 --events - --out /dev/null
  interwell --headless sweep --out map.csv --plot map.png
  interwell --headless sweep paper --over stops.travel_limit_mm=1:4:0.5 --over excitation.amplitude_g=0.5,1
  interwell --headless accuracy --plot accuracy.png
  interwell --headless accuracy nominal-cubic --method rk4 --step-s 1/60,1/600

A scene is a .ron file or the name of a built-in one; `presets --write DIR` copies those out.
A scene is also the manifest that `sweep --out map.csv` writes beside its rows (map.csv.json), or - for standard input.
Exit status: 0 done; 1 the run or the writing failed, a case of `accuracy` falls short, or a run of `simulate --strict`
ended early; 2 the arguments or the scene are wrong.";

/// Bistable mechanisms with hard travel limits: see and compute how stops start interwell motion.
#[derive(Debug, Parser)]
#[command(name = "interwell", version, override_usage = USAGE, after_help = EXAMPLES, disable_help_subcommand = true)]
pub struct Options {
    /// Work without a window; every command needs it, before or after its name
    #[arg(long, global = true)]
    pub headless: bool,

    /// Scene to open in the window
    #[arg(value_name = "SCENE")]
    pub scene: Option<String>,

    /// What to compute
    #[command(subcommand)]
    pub command: Option<Command>,

    /// Common options before the command.
    #[command(flatten)]
    pub common: Common,
}

/// A command of `--headless`.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// List the built-in scenes, or copy them out
    #[command(override_usage = "interwell --headless presets [OPTIONS]")]
    Presets(PresetsOptions),
    /// Validate scenes; print what each models, and how accurate its force curve is
    #[command(override_usage = "interwell --headless check [SCENE]... [OPTIONS]")]
    Check(CheckOptions),
    /// Force, potential and stiffness of the mechanism as CSV
    #[command(override_usage = "interwell --headless curve [SCENE] [OPTIONS]")]
    Curve(CurveOptions),
    /// Run a scene once: samples as CSV
    #[command(override_usage = "interwell --headless simulate [SCENE] [OPTIONS]")]
    Simulate(SimulateOptions),
    /// Run a grid of scenes: CSV with a row for each cell
    #[command(override_usage = "interwell --headless sweep [SCENE] [OPTIONS]")]
    Sweep(SweepOptions),
    /// The least value of a field from which on a motion from rest is released, crosses or is interwell
    #[command(override_usage = "interwell --headless threshold [SCENE] [OPTIONS]")]
    Threshold(ThresholdOptions),
    /// Of a scene: the error of its run, what digits cost, what a fixed step makes of it. Without one: speed against error
    /// beside other methods, and the hard cases with the digits that they allow and reach
    #[command(override_usage = "interwell --headless accuracy [SCENE] [OPTIONS]")]
    Accuracy(AccuracyOptions),
}

impl Command {
    /// The word that selects it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Presets(_) => "presets",
            Self::Check(_) => "check",
            Self::Curve(_) => "curve",
            Self::Simulate(_) => "simulate",
            Self::Sweep(_) => "sweep",
            Self::Threshold(_) => "threshold",
            Self::Accuracy(_) => "accuracy",
        }
    }

    /// Its common options.
    pub fn common(&mut self) -> &mut Common {
        match self {
            Self::Presets(PresetsOptions { common, .. })
            | Self::Check(CheckOptions { common, .. })
            | Self::Curve(CurveOptions { common, .. })
            | Self::Simulate(SimulateOptions { common, .. })
            | Self::Sweep(SweepOptions { common, .. })
            | Self::Threshold(ThresholdOptions { common, .. })
            | Self::Accuracy(AccuracyOptions { common, .. }) => common,
        }
    }
}

/// What every command takes, before its name or after it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Common options")]
pub struct Common {
    /// Where the data goes [default: -, standard output]
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub out: Option<PathBuf>,

    /// Change a field of the scene, such as stops.travel_limit_mm=2 or stops=None (repeatable)
    #[arg(long, value_name = "FIELD=VALUE", allow_hyphen_values = true)]
    pub set: Vec<String>,

    /// Local error allowed, 1e-14 to 1e-3; replaces the scene's run.tolerance
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub tolerance: Option<String>,

    /// Threads to use [default: one per core]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,

    /// Say nothing on standard error but errors
    #[arg(long)]
    pub quiet: bool,
}

impl Common {
    /// Where the data goes.
    pub fn out(&self) -> &Path {
        self.out.as_deref().unwrap_or(Path::new("-"))
    }

    /// Puts what stood before the command in front of what stands after it; an error names an option that may be given
    /// once and was given in both places.
    ///
    /// clap's own global arguments would forget a `--set` before the command where another one follows it.
    pub fn put_before(&mut self, before: Self) -> Result<(), &'static str> {
        fn one<T>(own: &mut Option<T>, before: Option<T>, name: &'static str) -> Result<(), &'static str> {
            match (own.is_some(), before) {
                (_, None) => Ok(()),
                (true, Some(_)) => Err(name),
                (false, before) => {
                    *own = before;
                    Ok(())
                }
            }
        }
        self.set.splice(0..0, before.set);
        self.quiet |= before.quiet;
        one(&mut self.out, before.out, "--out")?;
        one(&mut self.tolerance, before.tolerance, "--tolerance")?;
        one(&mut self.jobs, before.jobs, "--jobs")
    }

    /// The first of these that was given, for where it has no meaning: all of them, or those alone that change a scene or
    /// how it is run.
    pub fn given(&self, of_a_scene: bool) -> Option<&'static str> {
        let given = [
            (!self.set.is_empty(), "--set"),
            (self.tolerance.is_some(), "--tolerance"),
            (self.jobs.is_some(), "--jobs"),
            (!of_a_scene && self.out.is_some(), "--out"),
            (!of_a_scene && self.quiet, "--quiet"),
        ];
        given.into_iter().find(|own| own.0).map(|own| own.1)
    }
}

/// What the commands take that can draw.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("picture").multiple(true))]
pub struct PlotOptions {
    /// Draw a picture; the name ends in .png or .svg. A run is drawn from samples of its own, over the times that --at spans
    #[arg(long, value_name = "FILE", allow_hyphen_values = true, group = "picture")]
    pub plot: Option<PathBuf>,

    /// With a picture: light on dark
    #[arg(long, requires = "picture")]
    pub dark: bool,

    /// With a picture: its size in pixels, 200 to 4000 each way, such as 2400x1500; it keeps its proportions of 8 to 5 (an
    /// 85 mm column at 300 dpi is 1004 pixels wide) [default: 1600x1000]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, requires = "picture")]
    pub plot_size: Option<String>,

    /// With a picture: without title, subtitle and footer, for a page that has a caption
    #[arg(long, requires = "picture")]
    pub no_title: bool,
}

/// What the commands take whose pictures have axes with ranges.
#[derive(Debug, Args)]
pub struct RangeOptions {
    /// With --plot: range of the axis to the right in its unit; of a run the times in s
    #[arg(
        long,
        value_name = "A:B",
        visible_alias = "plot-time",
        allow_hyphen_values = true,
        requires = "plot"
    )]
    pub plot_x: Option<String>,

    /// With --plot: range of the first axis upward in its unit, such as -2:2 for the displacement of a run in mm
    #[arg(long, value_name = "A:B", allow_hyphen_values = true, requires = "plot")]
    pub plot_y: Option<String>,
}

/// `presets`.
#[derive(Debug, Args)]
pub struct PresetsOptions {
    /// Copy the scenes and their tables into this folder
    #[arg(long, value_name = "DIR")]
    pub write: Option<PathBuf>,

    /// With --write: replace files that are there and differ
    #[arg(long, requires = "write")]
    pub force: bool,

    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// `check`.
#[derive(Debug, Args)]
pub struct CheckOptions {
    /// Scene files or built-in scenes [default: paper]
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<String>,

    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// `curve`.
#[derive(Debug, Args)]
pub struct CurveOptions {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// From A to B in mm [default: a little beyond equilibria and stops, where the curve reaches as far]
    #[arg(long, value_name = "A:B", allow_hyphen_values = true, conflicts_with = "at_mm")]
    pub range_mm: Option<String>,

    /// Number of positions over the range [default: 401, for --shapes 21]
    #[arg(long, value_name = "N", allow_hyphen_values = true, conflicts_with = "at_mm",
          value_parser = clap::value_parser!(u32).range(2..=10_000_000))]
    pub points: Option<u32>,

    /// At these positions in mm, in this order
    #[arg(long, value_name = "X1,X2,..", allow_hyphen_values = true)]
    pub at_mm: Option<String>,

    /// Of flexures: more columns, axial_n (compression of the buckling flexures together), bump_m (height of their
    /// bump) and max_stress_pa (largest bending stress), each row solved afresh; warns where the stress exceeds
    /// mechanism.yield_gpa
    #[arg(long)]
    pub full: bool,

    /// Of flexures: write centre lines as CSV x_m,flexure,s_m,px_m,py_m. In the frame, with a shuttle of no width:
    /// a parallel flexure is clamped at (0, 0) and ends at (its length less the shortening, x); a buckling one is
    /// clamped at (both lengths less the preload, 0) and ends at the same place
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub shapes: Option<PathBuf>,

    /// Of a compliant stop: write what one impact on it does over the impact speed as CSV, speed_m_per_s, restitution,
    /// rigid_restitution, contact_time_s, depth_m, peak_force_n, peak_pressure_pa, in closed form
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub contact: Option<PathBuf>,

    /// Draw restitution over impact speed, beside a rigid stop's constant; the name ends in .png or .svg
    #[arg(long, value_name = "FILE", allow_hyphen_values = true, group = "picture")]
    pub contact_plot: Option<PathBuf>,

    /// With --contact and --contact-plot: the restitution of the rigid stop, 0 to 1
    #[arg(long, value_name = "E", allow_hyphen_values = true, default_value = "0.36")]
    pub rigid: String,

    /// Write equilibria, barrier, force extrema and kinks as JSON
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub landscape: Option<PathBuf>,

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

/// `simulate`.
#[derive(Debug, Args)]
pub struct SimulateOptions {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// Time between samples in s [default: a 60th of the forcing period, else a thousandth of the duration]
    #[arg(long, value_name = "S", allow_hyphen_values = true, conflicts_with = "at")]
    pub dt: Option<String>,

    /// Sample at these times in s, in this order
    #[arg(long, value_name = "T1,T2,..", allow_hyphen_values = true)]
    pub at: Option<String>,

    /// Go on, window after window, until the motion repeats, or up to this time in s. Samples and averages are then of the
    /// longer run; its window is the last one. Needs a drive that repeats
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    /// Write impacts, rests, releases and crossings as CSV
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub events: Option<PathBuf>,

    /// Fail with exit status 1 where the run ends before its duration; its files are written all the same
    #[arg(long)]
    pub strict: bool,

    /// Write statistics, outcome and energy ledger as JSON
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub summary: Option<PathBuf>,

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

/// `sweep`.
#[derive(Debug, Args)]
pub struct SweepOptions {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// Sweep a field; replaces the scene's own sweep (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// Columns after those of the swept fields: names of the summary, or all [default: rms_velocity_m_per_s, regime,
    /// crossings, impacts, max_abs_x_m, period, outcome]
    #[arg(long, value_name = "A,B,..|all", allow_hyphen_values = true, value_delimiter = ',')]
    pub columns: Vec<String>,

    /// Let each run go on, window after window, until its motion repeats, or up to this time in s. Needs a drive that
    /// repeats
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    /// With --plot: the column that is shown, any one with numbers, or regime
    #[arg(long, value_name = "COLUMN", requires = "plot", default_value = "rms_velocity_m_per_s")]
    pub quantity: String,

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

/// `threshold`.
#[derive(Debug, Args)]
pub struct ThresholdOptions {
    /// Scene file or built-in scene; each run begins at rest
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// The field and its range [default of the step: a 200th of the range]
    #[arg(
        long,
        value_name = "FIELD=FROM:TO[:STEP]",
        default_value = "excitation.amplitude_g=0:2",
        allow_hyphen_values = true
    )]
    pub field: String,

    /// What begins there: release (the mass leaves the stop it rests on), crossing (the settled motion crosses at all) or
    /// interwell (its crossings repeat)
    #[arg(long, value_name = "ONSET", default_value = "crossing", value_parser = ["release", "crossing", "interwell"])]
    pub of: String,

    /// How closely the threshold is located, in the field's unit [default: a 1000th of the step]
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub resolution: Option<String>,

    /// One row for each value of another field (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// `accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyOptions {
    /// Scene file or built-in scene whose run is looked at; without one the program's own problems and cases
    #[arg(value_name = "SCENE", conflicts_with_all = ["case", "list", "picture"])]
    pub scene: Option<String>,

    /// With a scene: what fixed steps make of it, each in s or as a fraction such as 1/60; stops clamp and bounce
    #[arg(long, value_name = "S1,S2,..", allow_hyphen_values = true, requires = "scene")]
    pub step_s: Option<String>,

    /// With --step-s: the method, euler (semi-implicit), verlet or rk4 (repeatable) [default: all]
    #[arg(long, value_name = "NAME", requires = "step_s",
          value_parser = ["euler", "verlet", "rk4"])]
    pub method: Vec<String>,

    /// Run this case alone (repeatable): p1, p2 or flexures for speed against error, or a hard case
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    pub case: Vec<String>,

    /// List the cases: what each runs, how its answer is known, why so many digits are allowed
    #[arg(long)]
    pub list: bool,

    /// The picture: error over time, of the problems p1, p2 and flexures.
    #[command(flatten)]
    pub plot: PlotOptions,

    /// What every command takes; --out has everything as CSV, and where that is `-` the table goes to standard error.
    #[command(flatten)]
    pub common: Common,
}
