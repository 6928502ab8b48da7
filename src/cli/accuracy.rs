//! `accuracy`: speed against error, and the hard cases. With a scene the error of its run, its cost over the
//! tolerance, and its error in fixed steps.

use std::path::Path;

use clap::Args;
use interwell::output::{accuracy_chart, aligned, scene_accuracy_chart};
use interwell::questions::{Accuracy, Scheme, check_accuracy};
use interwell::scene::Document;
use interwell_studies::study::accuracy::{PROBLEMS, Report, Selection, description, names};
use interwell_studies::study::stop_positions;

use super::support::{Watch, inputs, load_simulation};
use super::{Common, Failure, Output, Outputs, Picture, PlotOptions, ask, interrupt, refuse, write_alone};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file or built-in scene whose run is examined; without one the built-in problems and cases
    #[arg(value_name = "SCENE", conflicts_with_all = ["case", "list"])]
    pub scene: Option<String>,

    /// With a scene: run it in fixed steps too, each in s or as a fraction such as 1/60; a step that ends
    /// beyond a stop is put onto it, and the mass bounces there
    #[arg(long, value_name = "S1,S2,..", allow_hyphen_values = true, requires = "scene")]
    pub step_s: Option<String>,

    /// With --step-s: the method, euler (semi-implicit), verlet or rk4 (repeatable) [default: all]
    #[arg(long, value_name = "NAME", requires = "step_s",
          value_parser = Scheme::ALL.map(Scheme::word))]
    pub method: Vec<String>,

    /// Run this case alone (repeatable): p1, p2 or flexures for speed against error, or a hard case
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    pub case: Vec<String>,

    /// List the cases: what each runs, how its answer is known, why so many digits are allowed
    #[arg(long)]
    pub list: bool,

    #[command(flatten)]
    pub plot: PlotOptions,
}

/// Runs the selected problems and cases and shows the results. Returns an error, after all is written, if a
/// case falls short.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::new(&options.plot, common)?;
    if let Some(scene) = &options.scene {
        return of_scene(scene, options, picture, common);
    }
    if let Some(option) = common.given(&["set", "tolerance"]) {
        refuse!("--{option} needs a SCENE, such as interwell --headless accuracy paper --{option} ..");
    }
    let selection = Selection::of(&options.case).map_err(Failure::argument)?;
    if options.list {
        return write_alone(Output::DATA, Path::new("-"), &list(&options.case));
    }
    if picture.is_some() && !selection.has_problems() {
        let names: Vec<&str> = PROBLEMS.iter().map(|problem| problem.name).collect();
        refuse!(
            "--plot shows speed against error, and --case leaves none: add --case {}, or leave --plot out",
            names.join(" or ")
        );
    }
    let mut outputs = Outputs::new(&[]).with_rows(common.out.as_deref())?.with_picture(picture)?;

    let watch = Watch::start();
    let report = ask("parts", common, |progress| check_accuracy(&selection, progress))?;
    interrupt::check()?;
    outputs.table(Output::DATA, &report.table())?;
    if let Some(picture) = picture {
        let (chart, caption) = accuracy_chart(&report.work_table(), env!("CARGO_PKG_VERSION"));
        picture.write(&mut outputs, &chart, &caption)?;
    }
    let costs = (!report.points.is_empty()).then(|| aligned(&report.cost_table()));
    let cases = (!report.cases.is_empty()).then(|| aligned(&report.case_table()));
    let tables: Vec<String> = costs.into_iter().chain(cases).collect();
    finish(outputs, None, &tables.join("\n"), common)?;
    common.say(&format!("{:.1} s", watch.wall_s()));
    verdict(&report)
}

/// Finishes the outputs of this scene, if there is one, and writes a text to standard output, or to standard
/// error if standard output has the data.
fn finish(
    mut outputs: Outputs,
    document: Option<&Document>,
    text: &str,
    common: &Common,
) -> Result<(), Failure> {
    let data_on_stdout = outputs.is_stdout(Output::DATA);
    outputs.finish_rows(document, 1)?;
    if !data_on_stdout {
        return write_alone(Output::DATA, Path::new("-"), text);
    }
    common.say(text.trim_end());
    Ok(())
}

/// Returns an error that names the checks that fall short.
fn verdict(report: &Report) -> Result<(), Failure> {
    let short = report.shortfalls();
    let named: Vec<String> =
        short.iter().map(|(case, variant, quantity)| format!("{case} ({variant}): {quantity}")).collect();
    match &named[..] {
        [] => Ok(()),
        [one] => Err(Failure::failed(format!("a hard case falls short: {one}"))),
        all => Err(Failure::failed(format!(
            "{} of the hard cases' checks fall short: {}",
            all.len(),
            all.join("; ")
        ))),
    }
}

/// Describes the selected problems and cases, or all of them, one paragraph each.
fn list(wanted: &[String]) -> String {
    let is_shown = |name: &&str| wanted.is_empty() || wanted.iter().any(|chosen| chosen == name);
    names().filter(is_shown).map(description).collect()
}

fn of_scene(
    spec: &str,
    options: &Arguments,
    picture: Option<Picture>,
    common: &Common,
) -> Result<(), Failure> {
    let step_s = options.step_s.as_deref().map_or_else(|| Ok(Vec::new()), steps)?;
    let is_chosen = |scheme: &Scheme| options.method.iter().any(|name| name == scheme.word());
    let question = Accuracy { step_s, method: Scheme::ALL.into_iter().filter(is_chosen).collect() };
    question.check()?;
    let simulation = load_simulation(spec, common)?;
    let (document, model) = (simulation.document(), simulation.model());
    let outputs = Outputs::new(&inputs(spec, document)).with_rows(common.out.as_deref())?;
    let mut outputs = outputs.with_picture(picture)?;
    let found = question.run(&simulation, &interrupt::progress())?;
    let table = found.table();
    outputs.table(Output::DATA, &table)?;
    outputs.draw(picture, document, |_| {
        let (tolerance, stops) = (model.tolerance(), stop_positions(&document.scene));
        Ok(scene_accuracy_chart(&found.tolerances, tolerance, &found.stepped, stops))
    })?;
    finish(outputs, Some(document), &format!("{}\n\n{}", found.words().join("\n"), aligned(&table)), common)
}

/// Steps in s, each a number or a fraction.
fn steps(text: &str) -> Result<Vec<f64>, Failure> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let step = |part: &str| {
        let value = match part.split_once('/') {
            Some((above, below)) => number(above).zip(number(below)).map(|(above, below)| above / below),
            None => number(part),
        };
        value.filter(|step| step.is_finite()).ok_or_else(|| {
            let remedy = "give seconds, such as 0.001 or 1/60";
            Failure::argument(format!("--step-s {text}: `{part}` is no step; {remedy}"))
        })
    };
    text.split(',').map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use interwell_studies::study::accuracy::{Check, Variant};

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
