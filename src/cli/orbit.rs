//! `orbit`: the periodic motion near the settled motion of a run, or a branch of them over a field.

use clap::Args;
use interwell::output::branch_chart;
use interwell::questions::{can_have_orbits, no_orbit};
use interwell::scene::{Axis, Document, is_whole};
use interwell::study::{Family, Table, Task, branch, orbit, orbit_table};

use super::progress::bar_on_terminal;
use super::support::{check, finite, mechanism, model, outputs, read, warn};
use super::{ChartOptions, Common, Failure, Output, Picture, caption, interrupt, refuse, whole};

const EXAMPLES: &str = "\
Examples:
  interwell --headless orbit paper
  interwell --headless orbit duffing-chaos --period 1
  interwell --headless orbit paper-unconstrained --set run.duration_s=200 \\
      --branch excitation.amplitude_g=1.3:1.1 --out branch.csv --plot branch.png";

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

    /// Phase of the drive at which states are taken, in degrees
    #[arg(long, value_name = "P", default_value = "0", allow_hyphen_values = true)]
    pub phase_deg: String,

    /// Follow the motion over a field from A, in place of the scene's own value, to B, through folds; a row a
    /// motion
    #[arg(long, value_name = "FIELD=A:B", allow_hyphen_values = true)]
    pub branch: Option<String>,

    /// The picture, of a branch.
    #[command(flatten)]
    pub chart: ChartOptions,
}

/// Finds the motion, or follows its branch, and writes the table.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, "--plot-x", common)?;
    if picture.is_some() && options.branch.is_none() {
        refuse!("--plot shows a branch; add --branch FIELD=A:B, or leave it out");
    }
    let phase_deg = finite("--phase-deg", &options.phase_deg, "give a phase in degrees, such as 90")?;
    let mut document = read(&options.scene, common)?;
    let mut branch_range = None;
    if let Some(text) = &options.branch {
        let (field, from, to) = range(text, &document)?;
        // the branch begins at this value; the value in the scene is never run
        document.assign(&field, &from.to_string(), &format!("--branch {text}"))?;
        branch_range = Some((field, from, to));
    }
    let warnings = check(&mut document, None)?;
    let mechanism = mechanism(&document)?;
    warn(&document, common, &warnings, Some(&mechanism));
    let model = model(&document, &mechanism)?;
    can_have_orbits(&document, &model)?;
    let cancel = interrupt::listen();
    let mut outputs = outputs(&options.scene, &document, common)?.with_picture(picture)?;
    let phase = phase_deg / 360.0;
    let failed = |error, at: &str| no_orbit(&document, error, at);
    let table: Table = match branch_range {
        None => {
            let found = orbit(&model, phase, options.period, cancel);
            orbit_table(&[found.map_err(|error| failed(error, ""))?])
        }
        Some((field, from, to)) => {
            let family = Family::new(&document.scene, &document.files, &mechanism, &field);
            // the number of motions is not known beforehand
            let bar = bar_on_terminal(None, "{human_pos} motions", common.quiet);
            let task = Task { tick: &|| bar.inc(1), cancel };
            let found = branch(&family, &field, (from, to), phase, options.period, &task);
            bar.finish_and_clear();
            let found = found.map_err(|error| failed(error, &format!("at {field} = {from}: ")))?;
            if let Some(picture) = picture {
                let chart = branch_chart(&found, phase_deg, picture.ranges);
                picture.write(&mut outputs, &chart, &caption(&document))?;
            }
            found.remarks((from, to)).iter().for_each(|line| common.say(line));
            found.table()
        }
    };
    outputs.table(Output::DATA, &table)?;
    outputs.finish_rows(&document, 1)
}

/// The field of `--branch FIELD=A:B` and the ends of its range.
fn range(text: &str, document: &Document) -> Result<(String, f64, f64), Failure> {
    let wrong = |problem: String| Failure::argument(format!("--branch {text}: {problem}"));
    let form = || wrong("write FIELD=A:B, such as excitation.amplitude_g=0.5:2".into());
    let (field, values) = text.split_once('=').ok_or_else(form)?;
    let (from, to) = values.split_once(':').filter(|(_, to)| !to.contains(':')).ok_or_else(form)?;
    // both ends are values that the field may have
    let axis = Axis::parse(&format!("{}={},{}", field.trim(), from.trim(), to.trim()), &document.scene);
    let axis = axis.map_err(wrong)?;
    if is_whole(&document.scene, &axis.field) {
        refuse!(
            "--branch {text}: {} holds whole numbers, and a branch takes all values between A and B; follow \
             the motion with `sweep --carry` over it",
            axis.field
        );
    }
    match axis.values[..] {
        [from, to] if from != to => Ok((axis.field, from, to)),
        [from, _] => refuse!("--branch {text}: A and B are both {from}; give a range, such as 0.5:2"),
        _ => Err(form()),
    }
}
