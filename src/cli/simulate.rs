//! `simulate`: one run of a scene.

use std::path::PathBuf;

use clap::Args;
use interwell::dynamics::{Model, Outcome};
use interwell::numeric::{extent, short};
use interwell::output::{RunPanel, distance_chart, measured_chart, push_number, run_chart, summary};
use interwell::questions::{Distance, Sampling, Simulation};
use interwell_studies::study::{Keep, ended_remedy, yield_warning};

use super::measured::MeasuredOptions;
use super::picture::range_option;
use super::support::{beside, inputs, load_simulation, number, numbers, settle_limit};
use super::{ChartOptions, Common, Failure, Output, Outputs, Picture, caption, interrupt, refuse, say};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// Time between samples in s [default: a 60th of the forcing period, else a thousandth of the duration]
    #[arg(long, value_name = "S", allow_hyphen_values = true, conflicts_with = "at")]
    pub dt: Option<String>,

    /// Sample at these times in s, in this order
    #[arg(long, value_name = "T1,T2,..", allow_hyphen_values = true)]
    pub at: Option<String>,

    /// Follow the motion, window after window, until it repeats, or up to this time in s. Samples and
    /// averages are then those of the longer run, whose settled window is its last. Needs a drive that
    /// repeats
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true, conflicts_with = "measured")]
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

    /// With --plot: these panels alone, in this order one under the other: displacement, velocity,
    /// acceleration (of the base), power (into the load, or of the base), energy (potential and kinetic),
    /// ledger (work, losses and what is stored over the times shown), portrait (velocity over displacement)
    /// [default: displacement, velocity, acceleration and portrait, with numbers beside them]
    #[arg(long, value_name = "A,B,..", requires = "plot", conflicts_with = "measured", value_delimiter = ',',
          value_parser = RunPanel::ALL.map(RunPanel::name))]
    pub panels: Vec<String>,

    /// With --plot: draw how far the motion of this scene is from that of SCENE over time, each from its
    /// start, in place of the panels; up to three times. --set and --tolerance change the first scene alone
    #[arg(long, value_name = "SCENE", requires = "plot",
          conflicts_with_all = ["measured", "panels", "plot_y"])]
    pub beside: Vec<String>,

    #[command(flatten)]
    pub measured: MeasuredOptions,

    #[command(flatten)]
    pub chart: ChartOptions,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, common)?;
    let sampling = match (&options.at, &options.dt) {
        (Some(text), _) => Sampling::At(numbers("--at", text, ',')?),
        (None, Some(text)) => {
            let remedy = "give a time in s above 0, such as 0.01";
            Sampling::Every(number("--dt", text, |dt| *dt > 0.0 && dt.is_finite(), remedy)?)
        }
        (None, None) => Sampling::Default,
    };
    let panels: Vec<_> = options.panels.iter().filter_map(|name| RunPanel::named(name)).collect();
    if let Some(twice) = (1..panels.len()).find(|place| panels[..*place].contains(&panels[*place])) {
        refuse!("--panels: {} is named twice; a picture shows each panel once", panels[twice].name());
    }
    let panels = if panels.is_empty() { RunPanel::USUAL.to_vec() } else { panels };
    let simulation = load_simulation(&options.scene, common)?;
    let (document, model) = (simulation.document(), simulation.model());
    let until_settled = settle_limit(options.until_settled.as_deref())?;
    let keep = simulation.to_keep(&sampling, until_settled)?;
    let keep = Keep { events: options.events.is_some(), ..keep };
    let window = picture.and_then(|picture| picture.ranges.x).or_else(|| span(&sampling));
    let longest = until_settled.unwrap_or(model.duration());
    if let Some((from, to)) = window.filter(|(from, to)| *from < 0.0 || *to > longest) {
        refuse!("{} {from}:{to}: the run lasts from 0 to {longest} s", range_option());
    }
    let record = options.measured.read(common)?;
    let inset = record.as_ref().and_then(|measured| measured.inset);
    if let Some((from, to)) = inset.filter(|(_, to)| *to > longest) {
        refuse!("--inset {from}:{to}: the run lasts from 0 to {longest} s");
    }
    let mut read = inputs(&options.scene, document);
    read.extend(options.measured.measured.clone());
    if options.beside.len() > 3 {
        refuse!("--beside {}: it can be given three times", options.beside[3]);
    }
    let others = options.beside.iter().map(|spec| beside(spec)).collect::<Result<Vec<_>, _>>()?;
    read.extend(options.beside.iter().zip(&others).flat_map(|(spec, other)| inputs(spec, other.document())));
    let mut outputs = Outputs::new(&read)
        .with_rows(Some(common.out()))?
        .with(Output::EVENTS, options.events.as_deref())?
        .with(Output::SUMMARY, options.summary.as_deref())?
        .with_picture(picture)?
        .with(Output::COMPARISON, options.measured.comparison.as_deref())?;
    let progress = interrupt::progress();
    let (run, trace) = match picture.filter(|_| others.is_empty()) {
        None => (simulation.kept(&keep, &progress)?, None),
        Some(_) => {
            let (run, trace) = simulation.traced(&keep, inset.or(window), &progress)?;
            (run, Some(RunPanel::complete(&panels, trace, simulation.model(), progress.stop())))
        }
    };
    let compared = record.as_ref().map(|measured| measured.compare(&simulation)).transpose()?;
    outputs.table(Output::DATA, &run.samples)?;
    outputs.table(Output::EVENTS, &run.events)?;
    outputs.write(Output::SUMMARY, summary(&run.summary, &document.scene, &outputs.watch.origin(1)))?;
    let compared = record.as_ref().zip(compared.as_ref());
    if let Some(trace) = trace {
        outputs.draw(picture, document, |ranges| match compared {
            Some((_, found)) => Ok(measured_chart(&trace, found, inset, ranges)),
            None => Ok(run_chart(&trace, &run.summary, model, &panels, ranges)),
        })?;
    }
    if let Some(picture) = picture.filter(|_| !others.is_empty()) {
        let caption = caption(document).with_others(others.iter().map(Simulation::document));
        let found = Distance { of: others, times: window }.run(&simulation, &progress)?;
        picture.write(&mut outputs, &distance_chart(&found), &caption)?;
    }
    if let Some((_, found)) = compared {
        outputs.table(Output::COMPARISON, &found.table)?;
    }
    outputs.finish_rows(document, 1)?;
    if let Some((measured, found)) = compared.filter(|_| !common.quiet) {
        measured.report(found);
    }
    let warning = yield_warning(model, &run.summary);
    if let Some(words) = warning {
        common.say(&format!("warning: {}: {words}", document.name));
    }
    if let Some(reason) = remark(model, run.summary.outcome) {
        let reason = format!("{}: {reason}", document.name);
        if options.strict {
            return Err(Failure::failed(reason));
        }
        say(&reason);
    }
    Ok(())
}

/// The first and the last of the listed times. Returns `None` unless there are two different ones.
fn span(sampling: &Sampling) -> Option<(f64, f64)> {
    let Sampling::At(times) = sampling else { return None };
    let (first, last) = extent(times.iter().copied());
    (first < last).then_some((first, last))
}

/// The reason why a run ended before its duration or is inaccurate. Returns `None` if it is done.
fn remark(model: &Model, outcome: Outcome) -> Option<String> {
    let remedy = ended_remedy(model, outcome).unwrap_or_default();
    let reason = match outcome {
        Outcome::Done => return None,
        Outcome::LeftTable { .. } => "the mass left the range of the force curve".to_owned(),
        Outcome::ImpactBudget { count, .. } => format!("it reached {count} impacts, the limit of one run"),
        Outcome::StepBudget { count, .. } => {
            format!("its {count} steps reached the limit of work of one run; {remedy}")
        }
        Outcome::NotFinite { .. } => format!("a number was no longer finite; {remedy}"),
        Outcome::Inaccurate { residual } => {
            return Some(format!(
                "the energy does not balance ({}): the residual is {} times the energy that was moved; \
                 {remedy}",
                outcome.name(),
                short(residual)
            ));
        }
        Outcome::Cancelled { .. } => "it was cancelled".to_owned(),
    };
    let mut at = String::new();
    push_number(&mut at, outcome.ended_at()?);
    Some(format!("the run ended early at t = {at} s ({}): {reason}", outcome.name()))
}
