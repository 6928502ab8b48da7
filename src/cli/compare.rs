//! `compare`: scenes side by side under one sine, one row for each scene.

use clap::Args;
use interwell::dynamics::Regime;
use interwell::numeric::short;
use interwell::output::{compared_name, comparison_chart, comparison_title};
use interwell::questions::{Compare, Rated, Simulation};
use interwell::scene::{Document, RunSettings, Stops, Transducer};

use super::support::{self, change, inputs, load_simulation, settle_limit, simulation};
use super::{Common, Failure, Output, Outputs, Picture, PlotOptions, ask, caption, interrupt};

const EXAMPLES: &str = "\
Examples:
  interwell --headless compare paper balanced magnet
  interwell --headless compare paper balanced magnet paper-unconstrained --set excitation.amplitude_g=0.8
  interwell --headless compare paper my.ron --environment first-look
  interwell --headless compare paper balanced magnet paper-unconstrained --plot alternatives.pdf \\
      --plot-width-mm 170 --no-title";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene files or built-in scenes; --set changes each of them
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scenes: Vec<String>,

    /// The scene whose excitation, a sine or cosine, and run all of them have [default: the first]
    #[arg(long, value_name = "SCENE")]
    pub environment: Option<String>,

    /// Follow each run, window after window, until its motion repeats, or up to this time in s: longer is
    /// surer where the motion is irregular [default: 1000 forcing periods after the run]
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    #[command(flatten)]
    pub plot: PlotOptions,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::new(&options.plot, common)?;
    let environment = options.environment.as_deref();
    let environment = environment.map(|spec| load_simulation(spec, common)).transpose()?;
    let (mut all, mut read) = (Vec::new(), Vec::new());
    for (name, spec, document) in named(&options.scenes, common)? {
        read.extend(inputs(spec, &document));
        all.push((name, simulation(&document, common)?));
    }
    // without an argument there is the default one
    let (name, first) = all[0].clone();
    let until_settled = settle_limit(options.until_settled.as_deref())?;
    let question = Compare { with: all[1..].to_vec(), name, environment, until_settled };
    let scenes = question.scenes(&first, &interrupt::progress())?;
    if let [(only, _)] = &all[..] {
        common.say(&format!("{only}: the only scene; name others to set beside it"));
    }
    let environment = question.environment.as_ref().unwrap_or(&first).document();
    let replaced = all.iter().filter_map(|(name, scene)| Some((name.clone(), replaced(scene, environment)?)));
    grouped(replaced).iter().for_each(|(names, how)| common.say(&format!("{names}: {how}")));
    let mut outputs = Outputs::new(&read).with_rows(Some(common.out()))?.with_picture(picture)?;
    let found = ask("parts", common, |progress| question.run(&first, progress))?;
    let table = found.table();
    outputs.table(Output::DATA, &table)?;
    let remarks = scenes.iter().enumerate().flat_map(|(row, (name, scene))| {
        let empty = table.columns().iter().filter(|column| column.values.is_missing(row));
        let empty = empty.map(|column| column.name.as_str());
        let remarks = remarks(scene, &found.rated[row], found.amplitude_g, empty);
        remarks.into_iter().map(|words| (name.clone(), words))
    });
    grouped(remarks).iter().for_each(|(names, words)| common.say(&format!("{names}: {words}")));
    if let Some(picture) = picture {
        let mut caption = caption(environment);
        caption.title = comparison_title(&found);
        picture.write(&mut outputs, &comparison_chart(&found.rated, found.frequency_hz), &caption)?;
    }
    let documents = scenes.into_iter().map(|(name, scene)| (name, scene.document().clone()));
    let documents: Vec<(String, Document)> = documents.collect();
    let first = documents.first().map(|(_, document)| document);
    outputs.manifest(first, common.jobs(), |manifest| Ok(manifest.of_scenes(&documents)))?;
    outputs.finish()
}

/// Which of excitation and run of a scene those of the environment replace.
fn replaced(simulation: &Simulation, environment: &Document) -> Option<String> {
    let (scene, lent) = (simulation.scene(), &environment.scene);
    let how = match (scene.excitation != lent.excitation, window(&scene.run) != window(&lent.run)) {
        (true, true) => "under the excitation and with the run of",
        (true, false) => "under the excitation of",
        (false, true) => "with the run of",
        (false, false) => return None,
    };
    Some(format!("{how} {}", environment.name))
}

/// The scenes of the arguments, each with its name in the table and its argument. The manifest of a
/// comparison stands for all scenes of that comparison.
fn named<'a>(specs: &'a [String], common: &Common) -> Result<Vec<(String, &'a str, Document)>, Failure> {
    let mut all = Vec::new();
    for spec in specs {
        let mut document = support::read(spec, common)?;
        let compared = std::mem::take(&mut document.compared);
        if compared.is_empty() {
            all.push((compared_name(spec, &document), &**spec, document));
        }
        for (name, mut document) in compared {
            change(&mut document, common)?;
            all.push((compared_name(&name, &document), &**spec, document));
        }
    }
    Ok(all)
}

/// Duration of a run, beginning of its settled window, and tolerance.
fn window(run: &RunSettings) -> [f64; 3] {
    [run.duration_s, run.settle_s.unwrap_or(0.5 * run.duration_s), run.tolerance]
}

/// Each distinct remark after the names of all to which it applies.
fn grouped(remarks: impl IntoIterator<Item = (String, String)>) -> Vec<(String, String)> {
    let mut groups: Vec<(String, String)> = Vec::new();
    for (name, words) in remarks {
        match groups.iter_mut().find(|group| group.1 == words) {
            Some((names, _)) => *names += &format!(", {name}"),
            None => groups.push((name, words)),
        }
    }
    groups
}

/// Explains the empty and infinite cells of a row, an early end, rest, and an undecided threshold.
fn remarks<'a>(
    simulation: &Simulation,
    rated: &Rated,
    amplitude_g: f64,
    empty: impl Iterator<Item = &'a str>,
) -> Vec<String> {
    let (summary, given) = (&rated.summary, short(amplitude_g));
    let mut all = Vec::new();
    if let Some(at) = summary.outcome.ended_at() {
        let (at, outcome) = (short(at), summary.outcome.name());
        all.push(format!(
            "its run ended early at {at} s ({outcome}): nothing is known of its settled motion"
        ));
    } else if summary.regime == Regime::Rest {
        all.push(format!("{given} g does not move it"));
    }
    if let Some(crossing) = rated.crossing.filter(|crossing| crossing.undecided) {
        let low = crossing.low.map_or_else(String::new, |low| format!(" above {} g", short(low)));
        let high = crossing.high.map_or_else(String::new, |high| format!(" below {} g", short(high)));
        all.push(format!(
            "its threshold is undecided: of some amplitudes{low}{high} it is not known whether they cross: \
             the motion does not repeat in the time for which it is followed, the run ended early, or there \
             is no valid scene"
        ));
    }
    if let Some((_, size)) = rated.sensitivity.as_ref().filter(|(change, _)| change.is_infinite()) {
        all.push(format!("with {size} changed by 1 % nothing is left to cross, or nothing crosses"));
    }
    let empty = empty.map(|column| (column.to_owned(), why_empty(column, simulation, rated, &given)));
    all.extend(grouped(empty).iter().map(|(names, why)| format!("no {names}: {why}")));
    all
}

fn why_empty(column: &str, simulation: &Simulation, rated: &Rated, given: &str) -> String {
    let (summary, crossing) = (&rated.summary, rated.crossing_g());
    let transducer = simulation.scene().transducer != Transducer::None;
    match column {
        "release_g" => "it rests on no stop",
        "mean_load_power_w" if !transducer => "it has no transducer",
        "impact_speed_max_m_per_s" if simulation.scene().stops == Stops::None => "it has no stops",
        "impact_speed_max_m_per_s" if summary.outcome.ended_at().is_none() => "it strikes no stop",
        "rms_velocity_m_per_s" | "mean_load_power_w" | "max_abs_x_m" | "impact_speed_max_m_per_s" => {
            "its run ended early"
        }
        _ if simulation.mechanism().landscape.barrier.is_none() => {
            "no barrier between two wells, so nothing to cross"
        }
        _ if rated.crossing.is_none() => "no barrier stands between its stops, so nothing to cross",
        "crosses_from_hz" | "crosses_to_hz" => {
            return format!("no frequency that was tried makes its settled motion cross at {given} g");
        }
        _ if crossing.is_none() => "no amplitude that was tried makes its settled motion cross",
        "crossing_low_g" => "no smaller amplitude that was tried is known not to cross",
        "crossing_high_g" => "no amplitude that was tried is known to cross for good",
        _ => "its mechanism has no length, thickness or gap to change",
    }
    .to_owned()
}
