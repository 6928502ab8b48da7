//! `accuracy`: speed against error, and the hard cases.

use std::io::IsTerminal;

use std::path::Path;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use interwell::output::{accuracy_chart, aligned};
use interwell::study::Task;
use interwell::study::accuracy::{PROBLEMS, Report, Selection, Stopped, accuracy, description, names};

use super::failure::Failure;
use super::options::{Common, PlotOptions};
use super::outputs::{Output, Outputs, write_alone};
use super::picture::Picture;
use super::support::Watch;
use super::{interrupt, say, scene_accuracy};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file or built-in scene whose run is looked at; without one the program's own problems and cases
    #[arg(value_name = "SCENE", conflicts_with_all = ["case", "list", "picture"])]
    pub scene: Option<String>,

    /// With a scene: run it in fixed steps too, each in s or as a fraction such as 1/60; a step that ends
    /// beyond a stop is put onto it, and the mass bounces there
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
}

/// Runs the selected problems and cases and shows the results. Returns an error, after all is written, if a
/// case falls short.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    if let Some(scene) = &options.scene {
        return scene_accuracy::run(scene, options, common);
    }
    if let Some(option) = common.given(&["set", "tolerance"]) {
        return Err(Failure::argument(format!(
            "--{option} needs a SCENE, such as interwell --headless accuracy paper --{option} .."
        )));
    }
    let picture = Picture::new(&options.plot, common)?;
    let selection = if options.case.is_empty() { Selection::all() } else { Selection::of(&options.case)? };
    if options.list {
        return write_alone(Output::DATA, Path::new("-"), &list(&options.case));
    }
    if picture.is_some() && !selection.has_problems() {
        let names: Vec<&str> = PROBLEMS.iter().map(|problem| problem.name).collect();
        return Err(Failure::argument(format!(
            "--plot shows speed against error, and --case leaves none: add --case {}, or leave --plot out",
            names.join(" or ")
        )));
    }
    let mut outputs = Outputs::new(&[]).with(Output::DATA, common.out.as_deref())?.with_picture(picture)?;

    let bar = bar(selection.parts(), common.quiet);
    let task = Task { tick: &|| bar.inc(1), cancel: interrupt::listen() };
    let watch = Watch::start();
    let result = accuracy(&selection, &task);
    bar.finish_and_clear();
    let report = result.map_err(|stopped| match stopped {
        Stopped::Cancelled => Failure::interrupted(),
        Stopped::Scene(_) => Failure::Failed(stopped.into()),
    })?;
    if interrupt::came() {
        return Err(Failure::interrupted());
    }
    if outputs.has(Output::DATA) {
        outputs.table(Output::DATA, &report.table())?;
    }
    if let Some(picture) = picture {
        let (chart, caption) = accuracy_chart(&report.work_table(), env!("CARGO_PKG_VERSION"));
        picture.write(&mut outputs, &chart, &caption)?;
    }
    let to_stdout = outputs.is_stdout(Output::DATA);
    outputs.finish()?;
    show(&shown(&report), to_stdout, common.quiet)?;
    if !common.quiet {
        say(&format!("{:.1} s", watch.wall_s()));
    }
    verdict(&report)
}

/// Writes a text to standard output, or to standard error if standard output has the data.
pub(super) fn show(text: &str, data_on_stdout: bool, quiet: bool) -> Result<(), Failure> {
    if !data_on_stdout {
        write_alone(Output::DATA, Path::new("-"), text)?;
    } else if !quiet {
        say(text.trim_end());
    }
    Ok(())
}

/// Formats the tables of a report as text.
fn shown(report: &Report) -> String {
    let mut parts = Vec::new();
    if !report.points.is_empty() {
        parts.push(aligned(&report.cost_table()));
    }
    if !report.cases.is_empty() {
        parts.push(aligned(&report.case_table()));
    }
    parts.join("\n")
}

/// Returns an error that names the checks that fall short.
fn verdict(report: &Report) -> Result<(), Failure> {
    let short = report.shortfalls();
    let named: Vec<String> =
        short.iter().map(|(case, variant, quantity)| format!("{case} ({variant}): {quantity}")).collect();
    match named.len() {
        0 => Ok(()),
        1 => Err(Failure::Failed(anyhow::anyhow!("a hard case falls short: {}", named[0]))),
        n => Err(Failure::Failed(anyhow::anyhow!(
            "{n} of the hard cases' checks fall short: {}",
            named.join("; ")
        ))),
    }
}

/// Describes the selected problems and cases, or all of them, one paragraph each.
fn list(wanted: &[String]) -> String {
    let is_shown = |name: &&str| wanted.is_empty() || wanted.iter().any(|chosen| chosen == name);
    names().filter(is_shown).map(description).collect()
}

/// A progress bar, hidden unless standard error is a terminal.
fn bar(parts: u64, quiet: bool) -> ProgressBar {
    if quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} parts  {eta} left");
    ProgressBar::new(parts).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use interwell::study::accuracy::{Check, Variant};

    #[test]
    fn a_case_that_falls_short_is_a_failure_that_names_it() {
        let variant = |holds| Variant {
            name: "1e-12 m before",
            steps: 2,
            evaluations: 2,
            cpu_s: 0.0,
            checks: vec![("one impact", Check::Fact(holds))],
        };
        let report = |holds: &[bool]| Report {
            points: Vec::new(),
            cases: vec![("grazing", holds.iter().copied().map(variant).collect())],
        };
        assert!(verdict(&report(&[true, true])).is_ok());
        let failure = verdict(&report(&[true, false])).unwrap_err();
        assert!(matches!(failure, Failure::Failed(_)));
        assert_eq!(failure.to_string(), "a hard case falls short: grazing (1e-12 m before): one impact");
        let failure = verdict(&report(&[false, false])).unwrap_err();
        assert!(failure.to_string().starts_with("2 of the hard cases' checks fall short: "), "{failure}");
    }
}
