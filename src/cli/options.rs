//! The arguments of the command line, and the text of `--help`.

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args, CommandFactory, Parser, Subcommand};
use interwell::system::threads::{MAX_THREADS, processors};

use super::pages::{Page, VERSION};
use super::{Failure, say, whole};

const USAGE: &str = "interwell [SCENE]
       interwell --headless COMMAND [SCENE] [OPTIONS]";

const EXAMPLES: &str = "\
Examples:
  interwell --headless presets
  interwell --headless check my-scene.ron
  interwell --headless simulate --set stops.travel_limit_mm=2 --out run.csv --summary run.json
  interwell --headless simulate elastic-box --at 0,0.5,1 --events - --out /dev/null
  interwell --headless sweep --out map.csv --plot map.png
  interwell --headless sweep paper --surface --plot map.pdf --plot-width-mm 85 --font-pt 8 --no-title
  interwell --headless sweep paper --cut travel_limit_mm=1.5 --cut amplitude_g=1.2 --plot cuts.pdf
  interwell --headless sweep paper --over stops.travel_limit_mm=1:4:0.5 --over excitation.amplitude_g=0.5,1
  interwell --headless sweep paper --over excitation.amplitude_g=0:2:0.02 --carry both --plot hysteresis.png
  interwell --headless sweep paper --over excitation.amplitude_g=0:2:0.02 --uncertain damping.xi=+-5%
  interwell --headless sweep paper --out map.csv --resume
  interwell --headless sweep paper --shard 2/5 --out 'map-{shard}.csv'
  interwell --headless merge map-*-of-5.csv --out map.csv
  interwell --headless section paper --over excitation.amplitude_g=0.5:1.5:0.005 --plot diagram.png
  interwell --headless basins --x-mm -1.5:1.5:101 --v -0.5:0.5:101 --out basins.csv --plot basins.png
  interwell --headless exponents duffing-chaos --quiet
  interwell --headless escape paper --set 'excitation=Noise(rms_g:0.8,low_hz:0.5,high_hz:20,seed:1)' --runs 50
  interwell --headless orbit impact-oscillator --branch excitation.amplitude_g=0.05:0.06 --plot branch.png
  interwell --headless accuracy --plot accuracy.png
  interwell --headless accuracy nominal-cubic --method rk4 --step-s 1/60,1/600

A scene is a .ron file or the name of a built-in one; `presets --write DIR` copies those out.
A lesson is a .ron file, or the name or number of a built-in one: `interwell 3` opens the third.
A scene is also the manifest that every command writes beside its table (`--out map.csv`: map.csv.json), whose
`repeat` has the arguments that make the table again, or - for standard input.
Exit status: 0 done; 1 the run or the writing failed, a case of `accuracy` falls short, or a run of
`simulate --strict` or `sweep --strict` ended early; 2 the arguments or the scene are wrong.";

/// Bistable mechanisms with hard travel limits: see and compute how stops start interwell motion.
#[derive(Debug, Parser)]
#[command(name = "interwell", version = VERSION.as_str(), override_usage = USAGE, after_help = EXAMPLES)]
#[command(disable_help_subcommand = true)]
pub struct Options {
    /// Work without a window; every command needs it, before or after its name
    #[arg(long, global = true)]
    pub headless: bool,

    /// Scene or lesson to open in the window; a lesson is a file, or the name or number of a built-in one
    #[arg(value_name = "SCENE")]
    pub scene: Option<String>,

    /// What to compute
    #[command(subcommand)]
    pub command: Option<Word>,

    #[command(flatten)]
    pub common: Common,
}

/// A command of `--headless`, or a page for packages.
#[derive(Debug, Subcommand)]
pub enum Word {
    #[command(flatten)]
    Command(Box<Command>),
    #[command(flatten)]
    Page(Page),
}

/// Defines the commands: help or the study that has it, name, variant, positional argument in the usage line,
/// the common options that
/// the command refuses, and those that it accepts but ignores. Its help lists neither.
macro_rules! commands {
    ($($(#[doc = $help:literal])* $word:ident $variant:ident $scene:literal
        $(asks $study:ident)? $(refuses $($refused:literal)+)? $(ignores $($ignored:literal)+)?;)*) => {
        /// A command of `--headless`.
        #[derive(Debug, Subcommand)]
        pub enum Command {
            $(
                $(#[doc = $help])*
                $(#[command(about = super::declared::about::<interwell::questions::$study>())])?
                #[command(override_usage = concat!("interwell \
                    --headless ", stringify!($word), $scene, " \
                    [OPTIONS]"))]
                $variant {
                    #[command(flatten)]
                    arguments: super::$word::Arguments,
                    #[command(flatten)]
                    common: Common,
                },
            )*
        }

        /// Each command with the common options that it refuses, and those that it ignores.
        const COMMANDS: &[(&str, &[&str], &[&str])] =
            &[$((stringify!($word), &[$($($refused),+)?], &[$($($ignored),+)?])),*];

        impl Command {
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => stringify!($word),)*
                }
            }

            /// The common options that it refuses.
            pub fn refused(&self) -> &'static [&'static str] {
                COMMANDS.iter().find(|command| command.0 == self.name()).map_or(&[], |command| command.1)
            }

            pub fn common(&mut self) -> &mut Common {
                match self {
                    $(Self::$variant { common, .. } => common,)*
                }
            }

            pub fn run(&self) -> Result<(), Failure> {
                match self {
                    $(Self::$variant { arguments, common } => super::$word::run(arguments, common),)*
                }
            }
        }
    };
}

commands! {
    /// List the built-in scenes, or copy them out
    presets Presets "" refuses "set" "tolerance" "jobs";
    /// Validate scenes; print what each models, and how accurate its force curve is
    check Check " [SCENE]..." ignores "jobs";
    /// Force, potential and stiffness of the mechanism as CSV
    curve Curve " [SCENE]" ignores "jobs";
    /// Run a scene once: samples as CSV
    simulate Simulate " [SCENE]" ignores "jobs";
    /// Run a grid of scenes: CSV with a row for each cell
    sweep Sweep " [SCENE]";
    /// Join the parts of a sweep that `sweep --shard` computed
    merge Merge " PART..." refuses "set" "tolerance" "jobs";
    section Section " [SCENE]" asks Section;
    threshold Threshold " [SCENE]" asks Threshold;
    /// Scenes side by side under one sine: least amplitudes, speed, reach, band of frequencies, sensitivity
    compare Compare " [SCENE]..";
    /// The values of some fields at which a result is largest, in one environment or several, with margins
    best Best " [SCENE] --over FIELD=A:B";
    spectrum Spectrum " [SCENE]" asks Spectrum ignores "jobs";
    basins Basins " [SCENE] --x-mm A:B:N --v A:B:N" asks Basins;
    orbit Orbit " [SCENE]" asks Orbits ignores "jobs";
    exponents Exponents " [SCENE]" asks Exponents;
    escape Escape " [SCENE]" asks Escape;
    /// Damping ratio, restitution or force curve from a measured record, each number with its interval
    identify Identify " FILE --of damping|restitution|force" refuses "set" "tolerance" ignores "jobs";
    /// List the lessons; print, check or begin one
    lesson Lesson " [LESSON]" refuses "set" "tolerance";
    /// Of a scene: the error of its run, its cost over the tolerance, its error in fixed steps. Without a
    /// scene: speed against error beside other methods, and the hard cases with digits allowed and reached
    accuracy Accuracy " [SCENE]" ignores "jobs";
}

/// The command line for clap; the help of each command hides the options that it does not use, and has of the
/// documentation of its study the first sentence.
pub fn command_line() -> clap::Command {
    COMMANDS.iter().fold(Options::command(), |command, (word, refused, ignored)| {
        let unused = refused.iter().chain(*ignored);
        command.mut_subcommand(word, |sub| {
            unused.fold(sub.long_about(None::<&str>), |sub, name| sub.mut_arg(name, |arg| arg.hide(true)))
        })
    })
}

/// Whether a command takes one thread, whatever `--jobs` says.
pub fn takes_one_thread(name: &str) -> bool {
    COMMANDS.iter().any(|(word, _, ignored)| *word == name && ignored.contains(&"jobs"))
}

/// The names of all commands, as a sentence lists them.
pub fn command_names() -> String {
    let names: Vec<&str> = COMMANDS.iter().map(|command| command.0).collect();
    let (last, others) = names.split_last().unwrap_or((&"", &[]));
    format!("{} or {last}", others.join(", "))
}

/// The options of every command, before its name or after it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Common options")]
pub struct Common {
    /// Where the data goes [default: -, standard output]
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub out: Option<PathBuf>,

    /// Change a field of the scene, such as stops.travel_limit_mm=2, excitation.amplitude_g=0.8/g
    /// (arithmetic) or stops=None (repeatable)
    #[arg(long, value_name = "FIELD=VALUE", allow_hyphen_values = true)]
    pub set: Vec<String>,

    /// Local error allowed, 1e-14 to 1e-3; replaces the scene's run.tolerance
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub tolerance: Option<String>,

    /// Threads to use [default: one per core]
    #[arg(long, value_name = "N", allow_hyphen_values = true,
          value_parser = whole::<u16>(1..=MAX_THREADS.into()))]
    pub jobs: Option<u16>,

    /// Print only errors on standard error
    #[arg(long)]
    pub quiet: bool,
}

impl Common {
    /// The names of all of them.
    pub const ALL: &'static [&'static str] = &["set", "tolerance", "jobs", "out", "quiet"];

    /// The number of threads.
    pub fn jobs(&self) -> usize {
        self.jobs.map_or_else(processors, usize::from)
    }

    pub fn out(&self) -> &Path {
        self.out.as_deref().unwrap_or(Path::new("-"))
    }

    /// Prints a line on standard error, unless `--quiet` is given.
    pub fn say(&self, line: &str) {
        if !self.quiet {
            say(line);
        }
    }

    /// Adds the options given `before` the command to those given after it. The error is the name of an
    /// option that may be given once and was given in both places.
    ///
    /// clap's global arguments would drop a `--set` before the command if another one follows the command.
    pub fn put_before(&mut self, before: Self) -> Result<(), &'static str> {
        let mut once = ["out", "tolerance", "jobs"].into_iter();
        if let Some(twice) =
            once.find(|name| [&*self, &before].iter().all(|one| one.given(&[*name]).is_some()))
        {
            return Err(twice);
        }
        self.out = self.out.take().or(before.out);
        self.tolerance = self.tolerance.take().or(before.tolerance);
        self.jobs = self.jobs.or(before.jobs);
        self.set.splice(0..0, before.set);
        self.quiet |= before.quiet;
        Ok(())
    }

    /// The first of the named options that was given, for commands in which they have no meaning.
    pub fn given(&self, names: &[&'static str]) -> Option<&'static str> {
        let is_given = |name: &&&str| match **name {
            "set" => !self.set.is_empty(),
            "tolerance" => self.tolerance.is_some(),
            "jobs" => self.jobs.is_some(),
            "out" => self.out.is_some(),
            _ => self.quiet,
        };
        names.iter().find(is_given).copied()
    }
}

/// The options of the commands that can draw.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("picture").multiple(true))]
pub struct PlotOptions {
    /// Draw a picture; the name ends in .png, .svg or .pdf. That of `simulate` has samples of its own, over
    /// the times from the first to the last of --at
    #[arg(long, value_name = "FILE", allow_hyphen_values = true, group = "picture")]
    pub plot: Option<PathBuf>,

    /// With a picture: light on dark
    #[arg(long, requires = "picture")]
    pub dark: bool,

    /// With a picture: its size in pixels, 200 to 4000 each way, such as 2400x1500; it keeps its proportions
    /// of 8 to 5 (an 85 mm column at 300 dpi is 1004 pixels wide) [default: 1600x1000]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, requires = "picture")]
    pub plot_size: Option<String>,

    /// With a picture: its width on paper in mm, such as 85 for a column; it is laid out for that width, with
    /// text of --font-pt
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    #[arg(requires = "picture", conflicts_with = "plot_size")]
    pub plot_width_mm: Option<String>,

    /// With --plot-width-mm: its height in mm [default: what its kind needs, about 5/8 of the width]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, requires = "plot_width_mm")]
    pub plot_height_mm: Option<String>,

    /// With --plot-width-mm: the size in points of numbers and legends; labels of axes are a tenth larger
    #[arg(long, value_name = "PT", allow_hyphen_values = true, default_value = "8")]
    #[arg(requires = "plot_width_mm")]
    pub font_pt: String,

    /// With --plot-width-mm and a PNG: pixels an inch [default: 300]
    #[arg(long, value_name = "DPI", allow_hyphen_values = true, requires = "plot_width_mm")]
    pub dpi: Option<String>,

    /// With a picture: write the numbers that are drawn as CSV
    #[arg(long, value_name = "FILE", allow_hyphen_values = true, requires = "picture")]
    pub plot_data: Option<PathBuf>,

    /// With a picture: without title, subtitle and footer, for a page that has a caption
    #[arg(long, requires = "picture")]
    pub no_title: bool,
}

/// The options of the commands whose pictures have axes with ranges.
#[derive(Debug, Args)]
pub struct ChartOptions {
    #[command(flatten)]
    pub plot: PlotOptions,

    /// With --plot: range of the axis to the right in its unit; of a run the times in s
    #[arg(long, value_name = "A:B", visible_alias = "plot-time", allow_hyphen_values = true)]
    #[arg(requires = "plot")]
    pub plot_x: Option<String>,

    /// With --plot: range of the first axis upward in its unit, such as -2:2 for the displacement of a run in
    /// mm
    #[arg(long, value_name = "A:B", allow_hyphen_values = true, requires = "plot")]
    pub plot_y: Option<String>,
}
