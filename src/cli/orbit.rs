//! `orbit`: the periodic motion near the settled motion of a run, or a branch of them over a field.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use interwell::dynamics::MapState;
use interwell::output::{branch_chart, loci_chart};
use interwell::questions::{Begin, Branch, BranchEvent, Error, FieldRange, Locus, Orbit};
use interwell::scene::{Axis, Document};
use interwell_studies::study::BranchOptions;

use super::progress::bar_on_terminal;
use super::support::{finite, if_given, outputs, read, simulation};
use super::{ChartOptions, Common, Failure, Output, Picture, interrupt, refuse, whole};

const EXAMPLES: &str = "\
Examples:
  interwell --headless orbit paper
  interwell --headless orbit duffing-chaos --period 1
  interwell --headless orbit impact-oscillator --from impacts=1
  interwell --headless orbit paper-unconstrained --set run.duration_s=200 \\
      --branch excitation.amplitude_g=1.3:1.1 --out branch.csv --plot branch.png
  interwell --headless orbit impact-oscillator --branch excitation.amplitude_g=0.056:0.0545 --switch 3
  interwell --headless orbit impact-oscillator --branch excitation.amplitude_g=0.05:0.07 \\
      --locus grazing --and excitation.frequency_hz=0.1:0.116 --plot grazings.png";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// Forcing periods after which the motion repeats [default: those of the run's settled motion]
    #[arg(long, value_name = "N", allow_hyphen_values = true,
          value_parser = whole::<u32>(1..=1000))]
    pub period: Option<u32>,

    /// The motion to take in place of that of the run: its state at that phase, X_MM,V_M_PER_S (with A or V
    /// of a circuit as a third number), or impacts=N for one with N impacts in the period, stable or not
    #[arg(long, value_name = "STATE", allow_hyphen_values = true)]
    pub from: Option<String>,

    /// Phase of the drive at which states are taken, in degrees
    #[arg(long, value_name = "P", default_value = "0", allow_hyphen_values = true)]
    pub phase_deg: String,

    /// Follow the motion over a field from A, in place of its value in the scene, to B, through folds; a row
    /// a motion
    #[arg(long, value_name = "FIELD=A:B", allow_hyphen_values = true)]
    pub branch: Option<String>,

    /// Longest step of a branch, as a share of the range and of the scales of the state, 0.0001 to 0.05
    /// [default: 0.01]
    #[arg(long, value_name = "S", allow_hyphen_values = true, requires = "branch")]
    pub step: Option<String>,

    /// Largest number of motions of a branch [default: 5000]
    #[arg(long, value_name = "N", allow_hyphen_values = true, requires = "branch",
          value_parser = whole::<usize>(1..=1_000_000))]
    pub count: Option<usize>,

    /// Follow also the branches that begin at flips and breakings of the symmetry, those that begin on them,
    /// and so on to this number of levels [default without a number: 1]
    #[arg(long, value_name = "LEVELS", num_args = 0..=1, default_missing_value = "1",
          requires = "branch", conflicts_with = "locus", value_parser = whole::<u32>(1..=10))]
    pub switch: Option<u32>,

    /// Follow each event of this kind on the branch over a second field too: grazing, fold, flip or symmetry
    /// (where a symmetric motion loses its symmetry)
    #[arg(long, value_name = "EVENT", requires_all = ["branch", "and"], value_parser = events())]
    pub locus: Option<String>,

    /// With --locus: the second field, from C, in place of its value in the scene, to D
    #[arg(long, value_name = "FIELD=C:D", allow_hyphen_values = true, requires = "locus")]
    pub and: Option<String>,

    #[command(flatten)]
    pub chart: ChartOptions,
}

/// The events of `--locus`.
fn events() -> PossibleValuesParser {
    let event = |event: BranchEvent| PossibleValue::new(event.name());
    let symmetry = event(BranchEvent::Symmetry).alias("symmetry-breaking");
    [event(BranchEvent::Grazing), event(BranchEvent::Fold), event(BranchEvent::Flip), symmetry].into()
}

/// Finds the motion, or follows its branch or the loci from it, and writes the table.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, common)?;
    if picture.is_some() && options.branch.is_none() {
        refuse!("--plot shows a branch; add --branch FIELD=A:B, or leave it out");
    }
    let phase_deg = finite("--phase-deg", &options.phase_deg, "give a phase in degrees, such as 90")?;
    let mut document = read(&options.scene, common)?;
    let over = options.branch.as_ref().map(|text| range("--branch", text, &document)).transpose()?;
    let and = options.and.as_ref().map(|text| range("--and", text, &document)).transpose()?;
    // the branch begins at these values; those in the scene are never run
    for (option, range) in [("--branch", &over), ("--and", &and)] {
        if let Some(FieldRange { field, range: (from, _) }) = range {
            document.assign(field, &from.to_string(), &format!("{option} {field}"))?;
        }
    }
    let simulation = simulation(&document, common)?;
    let document = simulation.document();
    let mut outputs = outputs(&options.scene, document, common)?.with_picture(picture)?;
    // the number of motions is not known beforehand
    let bar = bar_on_terminal(None, "{human_pos} motions", common.quiet);
    let count = |done: u64, _: Option<u64>| bar.set_position(done);
    let progress = interrupt::progress().reporting_to(&count);
    let period = options.period;
    let begin = options.from.as_deref().map_or(Ok(Begin::Run), begin)?;
    let Some(FieldRange { field, range }) = over else {
        let found = Orbit { period, phase_deg, begin }.run(&simulation, &progress)?;
        outputs.table(Output::DATA, &found.table())?;
        return outputs.finish_rows(document, 1);
    };
    let step = if_given("--step", options.step.as_deref(), "give a share, such as 0.01")?;
    let step = step.unwrap_or(BranchOptions::STEP);
    let count = options.count.unwrap_or(BranchOptions::COUNT);
    let branch = Branch { field, range, period, phase_deg, begin, step, count };
    let of = options.locus.as_deref().map(|name| name.strip_suffix("-breaking").unwrap_or(name));
    let told = |error: Error| {
        bar.finish_and_clear();
        let Error::Argument { name, problem, .. } = &error else { return Failure::from(error) };
        let option = match &**name {
            "field" | "range" => options.branch.as_ref().map(|text| format!("--branch {text}")),
            "second" | "second_range" => options.and.as_ref().map(|text| format!("--and {text}")),
            _ => None,
        };
        option
            .map_or_else(|| error.clone().into(), |option| Failure::argument(format!("{option}: {problem}")))
    };
    let (table, remarks) = match of.and_then(BranchEvent::named).zip(and) {
        Some((of, second)) => {
            let found = Locus { branch, of, second }.run(&simulation, &progress).map_err(told)?;
            bar.finish_and_clear();
            outputs.draw(picture, document, |ranges| Ok(loci_chart(&found.loci, phase_deg, ranges)))?;
            (found.table(), found.remarks())
        }
        None => {
            let levels = options.switch.unwrap_or(0);
            let found = branch.with_switches(levels, &simulation, &progress).map_err(told)?;
            bar.finish_and_clear();
            outputs.draw(picture, document, |ranges| Ok(branch_chart(&found.branches, phase_deg, ranges)))?;
            let of_one = || found.branches[0].table();
            (if options.switch.is_some() { found.table() } else { of_one() }, found.remarks())
        }
    };
    remarks.iter().for_each(|line| common.say(line));
    outputs.table(Output::DATA, &table)?;
    outputs.finish_rows(document, 1)
}

/// The motion of an option `--from`.
fn begin(text: &str) -> Result<Begin, Failure> {
    let wrong = || {
        let problem = "write X_MM,V_M_PER_S, such as 1.5,0.02, with A or V of a circuit as a third number, \
                       or impacts=N, such as impacts=1";
        Failure::argument(format!("--from {text}: {problem}"))
    };
    if let Some(number) = text.strip_prefix("impacts=") {
        return number.trim().parse().map(Begin::Impacts).map_err(|_| wrong());
    }
    let numbers =
        text.split(',').map(|part| part.trim().parse().ok().filter(|number: &f64| number.is_finite()));
    match numbers.collect::<Option<Vec<f64>>>().as_deref() {
        Some([x, v]) => Ok(Begin::State(MapState { x: x * 1e-3, v: *v, electrical: 0.0 })),
        Some([x, v, electrical]) => {
            Ok(Begin::State(MapState { x: x * 1e-3, v: *v, electrical: *electrical }))
        }
        _ => Err(wrong()),
    }
}

/// The field of an option `FIELD=A:B` and the ends of its range.
fn range(option: &str, text: &str, document: &Document) -> Result<FieldRange, Failure> {
    let wrong = |problem: String| Failure::argument(format!("{option} {text}: {problem}"));
    let form = || wrong("write FIELD=FROM:TO, such as excitation.amplitude_g=0.5:2".into());
    let (field, values) = text.split_once('=').ok_or_else(form)?;
    let (from, to) = values.split_once(':').filter(|(_, to)| !to.contains(':')).ok_or_else(form)?;
    let axis = Axis::parse(&format!("{}={},{}", field.trim(), from.trim(), to.trim()), &document.scene);
    let axis = axis.map_err(wrong)?;
    match axis.values[..] {
        [from, to] => Ok(FieldRange { field: axis.field, range: (from, to) }),
        _ => Err(form()),
    }
}
