//! The command line: reads arguments, runs a study, writes its table. Nothing is computed here.

mod accuracy;
mod best;
mod check;
mod compare;
mod curve;
mod declared;
mod failure;
mod given;
mod grid_job;
mod identify;
mod interrupt;
mod lesson;
mod measured;
mod merge;
mod options;
mod outputs;
mod pages;
mod picture;
mod presets;
mod progress;
mod shard;
mod simulate;
mod support;
mod sweep;

use std::error::Error as _;
use std::io::Write;
use std::process::ExitCode;

use clap::FromArgMatches;
use clap::error::{ContextKind, ErrorKind};
use interwell::numeric::visible;

/// Commands whose studies declare them.
macro_rules! declared {
    ($($command:ident: $study:ident)*) => {$(
        mod $command {
            pub use super::declared::run;
            pub type Arguments = super::declared::Arguments<interwell::questions::$study>;
        }
    )*};
}

declared! {
    basins: Basins
    escape: Escape
    exponents: Exponents
    orbit: Orbits
    section: Section
    spectrum: Spectrum
    threshold: Threshold
}

pub use failure::Failure;
pub use options::{Options, command_names};

use failure::refuse;
use interwell_studies::study::whole;
use options::{ChartOptions, Common, PlotOptions, Word};
use outputs::{Output, Outputs, write_alone};
use picture::{Picture, caption};
use progress::{ask, bar};

/// Reads the arguments; an `Err` is the exit status after help or an error has been printed.
pub fn parse() -> Result<Options, ExitCode> {
    let matches = options::command_line().try_get_matches();
    let read = matches.and_then(|matches| Options::from_arg_matches(&matches));
    read.map_err(|error| match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            let _ = error.print();
            ExitCode::SUCCESS
        }
        ErrorKind::InvalidUtf8 => {
            let wrong = std::env::args_os().find(|text| text.to_str().is_none()).unwrap_or_default();
            let remedy = "rename the file, or go to its folder and name it from there";
            say(&format!("error: `{}` is not valid UTF-8: {remedy}", wrong.to_string_lossy()));
            ExitCode::from(2)
        }
        ErrorKind::ValueValidation if error.source().is_some() => {
            let context = |kind| error.get(kind).map(ToString::to_string).unwrap_or_default();
            let (argument, value) = (context(ContextKind::InvalidArg), context(ContextKind::InvalidValue));
            let option = argument.split(' ').next().unwrap_or_default();
            let problem = error.source().map(ToString::to_string).unwrap_or_default();
            say(&format!("error: {option} {value}: {problem}"));
            ExitCode::from(2)
        }
        _ => {
            // Usage and hints would bury the lines that name argument, value and remedy.
            let text = error.render().to_string();
            let parts = text.split("\n\n").filter(|part| !part.trim_start().starts_with("Usage:"));
            let lines = parts.flat_map(str::lines).map(str::trim);
            let hint = |line: &str| line.starts_with("tip: to pass") || line.starts_with("For more");
            let lines: Vec<&str> = lines.filter(|line| !line.is_empty() && !hint(line)).collect();
            say(&lines.join("\n"));
            ExitCode::from(2)
        }
    })
}

/// Runs the command, or opens the window on a scene by `window`.
pub fn run(
    options: Options,
    window: impl FnOnce(Option<&str>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let Options { headless, common, scene, command } = options;
    let commands = command_names();
    match (command, headless, scene) {
        (Some(_), _, Some(scene)) => refuse!("`{scene}` stands before the command: put the scene after it"),
        (Some(Word::Page(page)), _, None) => {
            if let Some(option) = common.given(Common::ALL) {
                refuse!("--{option} changes nothing in `{}`: leave it out", page.name());
            }
            page.run()
        }
        (Some(Word::Command(command)), false, None) => {
            let name = command.name();
            refuse!("`{name}` works without a window: write interwell --headless {name}")
        }
        (Some(Word::Command(mut command)), true, None) => {
            if let Err(option) = command.common().put_before(common) {
                refuse!("--{option} is given before and after the command: give it once");
            }
            let (name, refused) = (command.name(), command.refused());
            if let Some(option) = command.common().given(refused) {
                refuse!("--{option} changes a scene or its run, and `{name}` takes no scene: leave it out");
            }
            command.run()
        }
        (None, true, None) => refuse!(
            "--headless needs a command: {commands}, such as interwell --headless simulate paper; see \
             interwell --help"
        ),
        (None, true, Some(word)) => {
            refuse!("--headless needs a command before `{word}`: {commands}; see interwell --help")
        }
        (None, false, scene) => match common.given(Common::ALL) {
            Some(option) => refuse!(
                "--{option} belongs to a command: {commands}, such as interwell --headless simulate; the \
                 window takes a scene alone"
            ),
            None => window(scene.as_deref()),
        },
    }
}

/// Prints a line on standard error, without what a terminal would obey; a closed standard error is ignored.
pub fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}", visible(line));
}
