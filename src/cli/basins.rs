//! `basins`: the attractor that each start goes to, one row for each start.

use std::path::PathBuf;

use clap::Args;
use interwell::numeric::short;
use interwell::output::{basins_chart, can_show_starts, rows};
use interwell::questions::{Basins, BasinsAnswer, EvenRange};
use interwell_studies::study;

use super::progress::duration;
use super::support::{counted, load_with_mechanism, numbers, outputs};
use super::{Common, Failure, Output, Outputs, Picture, PlotOptions, ask, interrupt, refuse, say};

const EXAMPLES: &str = "\
A row is `sure` where the error of the integration cannot change its answer: a second run at a thousandth
of the tolerance stays within a tenth of the scene's scales of the first one up to the attractor.

Examples:
  interwell --headless basins paper --x-mm -1.5:1.5:101 --v -0.5:0.5:101 --out basins.csv --plot basins.png
  interwell --headless basins duffing --x-mm -2000:2000:200 --v -2:2:200 --attractors - --out /dev/null
  interwell --headless basins paper-unconstrained --x-mm -8:8 --v -0.5:0.5 --random 1000 --out starts.csv";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene; its start is not used
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// Displacements in mm from which the mass starts: N from A to B, both included; A:B with --random
    #[arg(long, value_name = "A:B:N", allow_hyphen_values = true)]
    pub x_mm: Option<String>,

    /// Velocities in m/s with which it starts, likewise
    #[arg(long, value_name = "A:B:N", allow_hyphen_values = true)]
    pub v: Option<String>,

    /// Number of starts drawn uniformly from the two ranges A:B, in place of a grid; the shares of the
    /// attractors are then their basin stability
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub random: Option<String>,

    /// Seed of --random; whole, 0 or above [default: 0]
    #[arg(long, value_name = "S", allow_hyphen_values = true, requires = "random")]
    pub seed: Option<String>,

    /// Where the attractors go: regime, period, side, RMS velocity, a state, and the share of the starts
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub attractors: Option<PathBuf>,

    #[command(flatten)]
    pub plot: PlotOptions,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::new(&options.plot, common)?;
    let question = question(options)?;
    let starts = question.starts()?;
    if picture.is_some() {
        can_show_starts(&starts)?;
    }
    let (document, mechanism) = load_with_mechanism(&options.scene, common)?;
    let basins = question.begin(starts, &document, &mechanism)?;
    let mut outputs = outputs(&options.scene, &document, common)?
        .with_picture(picture)?
        .with(Output::ATTRACTORS, options.attractors.as_deref())?;
    if !common.quiet {
        forecast(&basins).iter().for_each(|line| say(line));
    }
    let found =
        ask("starts followed", common, |progress| Basins::followed(basins.checked(), progress, None))?;
    write_rows(&mut outputs, &found)?;
    outputs.table(Output::ATTRACTORS, &found.attractors())?;
    let BasinsAnswer { basins, answer } = &found;
    outputs.draw(picture, &document, |_| Ok(basins_chart(basins, answer)))?;
    outputs.manifest(Some(&document), common.jobs(), |manifest| Ok(manifest.of_basins(basins, answer)))?;
    let watch = outputs.watch;
    outputs.finish()?;
    common.say(&outcome(answer, watch.wall_s()));
    Ok(())
}

/// A forecast is printed if one start may take more steps than this, about half a second of a core.
const MANY_STEPS: f64 = 1e6;

/// The possible cost of a start in words, or `None` if it is small.
fn forecast(basins: &study::BasinMap) -> Option<String> {
    let (steps, seconds) = basins.cost_of_a_period();
    let periods = study::BasinMap::PATIENCE as f64;
    (steps * periods > MANY_STEPS).then(|| {
        format!(
            "a forcing period takes some {} steps: a start is followed for at most {periods} of them, \
             which takes some {} of a core; a start that takes far more than the others ends early",
            short(steps),
            duration(seconds * periods)
        )
    })
}

/// Rows that are formatted at a time.
const ROWS: usize = 1 << 14;

fn write_rows(outputs: &mut Outputs, found: &BasinsAnswer) -> Result<(), Failure> {
    let BasinsAnswer { basins, answer } = found;
    outputs.table(Output::DATA, &answer.table(basins, 0, 0))?;
    for begin in (0..answer.rows.len()).step_by(ROWS) {
        interrupt::check()?;
        outputs.write(Output::DATA, rows(&answer.table(basins, begin, begin + ROWS), 0..ROWS))?;
    }
    Ok(())
}

fn outcome(answer: &study::Answer, seconds: f64) -> String {
    let attractors = counted(answer.attractors.len() as u64, "attractor");
    let mut text = format!("{} in {seconds:.2} s, {attractors}", counted(answer.rows.len() as u64, "start"));
    let undecided = format!("not settled after {} periods", study::BasinMap::PATIENCE);
    for (count, what) in [
        (answer.unsure(), "not sure"),
        (answer.outside, "outside the room of the mass"),
        (answer.lost - answer.spent, "ended early"),
        (answer.spent, "out of work: a motion far faster than its drive; raise the frequency or the damping"),
        (answer.undecided, undecided.as_str()),
    ] {
        if count > 0 {
            text += &format!(", {count} {what}");
        }
    }
    text
}

/// The form of a range of values, for error messages.
const AS_EVEN: &str = "write A:B:N, the first value, the last and how many, such as -5:5:101";

fn question(options: &Arguments) -> Result<Basins, Failure> {
    let missing = |option: &str| Failure::argument(format!("{option} is missing: {AS_EVEN}"));
    let x_mm = options.x_mm.as_deref().ok_or_else(|| missing("--x-mm"))?;
    let v = options.v.as_deref().ok_or_else(|| missing("--v"))?;
    let Some(text) = &options.random else {
        return Ok(Basins { x_mm: even("--x-mm", x_mm)?, v: even("--v", v)?, random: None });
    };
    let whole = |option: &str, text: &str| {
        let wrong = |_| Failure::argument(format!("{option} {text}: give a whole number, such as 1000"));
        text.trim().parse::<u64>().map_err(wrong)
    };
    let count = whole("--random", text)?;
    let seed = options.seed.as_deref().map_or(Ok(0), |text| whole("--seed", text))?;
    let between = |option: &str, text: &str| match numbers(option, text, ':')?[..] {
        [from, to] => Ok(EvenRange { from, to, count: 1 }),
        _ => refuse!("{option} {text}: with --random write A:B; --random says how many"),
    };
    let (x_mm, v) = (between("--x-mm", x_mm)?, between("--v", v)?);
    Ok(Basins { x_mm, v, random: Some((count, seed)) })
}

/// The values `A:B:N` as given to `option`.
fn even(option: &str, text: &str) -> Result<EvenRange, Failure> {
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let [_, _, count] = parts[..] else { refuse!("{option} {text}: {AS_EVEN}") };
    let Ok(count) = count.parse::<u64>() else {
        refuse!("{option} {text}: N is not a whole number; {AS_EVEN}")
    };
    let ends = numbers(option, text, ':')?;
    Ok(EvenRange { from: ends[0], to: ends[1], count })
}
