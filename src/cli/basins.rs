//! `basins`: the attractor that each start goes to, one row for each start.

use std::convert::Infallible;
use std::path::PathBuf;

use clap::Args;
use interwell::numeric::short;
use interwell::output::{basins_chart, can_show_starts, rows};
use interwell::study::{Answer, Basins, EvenRange, NoBasins, Starts, StartsError};
use interwell::system::threads::Pool;

use super::progress::duration;
use super::support::{Watch, counted, load_with_mechanism, numbers, outputs, pool};
use super::{Common, Failure, Output, Outputs, Picture, PlotOptions, interrupt, refuse, say, with_bar};

const EXAMPLES: &str = "\
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
    let starts = starts(options)?;
    if picture.is_some() {
        can_show_starts(&starts)?;
    }
    let (document, mechanism) = load_with_mechanism(&options.scene, common)?;
    let count = starts.count() as u64;
    let basins = Basins::new(&document.scene, mechanism, starts);
    let mut basins = basins.map_err(|problem| match problem {
        NoBasins::Faults(faults) => document.error_from(faults).into(),
        NoBasins::Beyond { .. } => {
            Failure::argument(format!("--x-mm {}: {problem}", options.x_mm.as_deref().unwrap_or("")))
        }
        _ => Failure::argument(format!("{}: {problem}", document.name)),
    })?;
    let pool = pool(common)?;
    let mut outputs = outputs(&options.scene, &document, common)?
        .with_picture(picture)?
        .with(Output::ATTRACTORS, options.attractors.as_deref())?;
    outputs.watch = Watch::start();
    if !common.quiet {
        forecast(&basins).iter().for_each(|line| say(line));
    }
    let answer = answer(&mut basins, &pool, common).ok_or_else(Failure::interrupted)?;
    write_rows(&mut outputs, &basins, &answer, &pool)?;
    outputs.table(Output::ATTRACTORS, &answer.attractors_table())?;
    outputs.draw(picture, &document, |_| Ok(basins_chart(&basins, &answer)))?;
    outputs.manifest(Some(&document), pool.count(), |manifest| Ok(manifest.of_basins(&basins, &answer)))?;
    let watch = outputs.watch;
    outputs.finish()?;
    common.say(&outcome(&answer, count, watch.wall_s()));
    Ok(())
}

/// Follows the starts, then repeats those whose answer may be uncertain. Returns `None` if cancelled.
fn answer(basins: &mut Basins, pool: &Pool, common: &Common) -> Option<Answer> {
    let mut answer = with_bar(basins.starts().count() as u64, "starts", common, |task| {
        while !basins.is_whole() && basins.run_level(pool, task) {}
        basins.answer(task).filter(|_| basins.is_whole())
    })?;
    let uncertain = basins.rows_to_check(&answer).len() as u64;
    let whole = with_bar(uncertain, "starts once more", common, |task| basins.check(&mut answer, pool, task));
    whole.then_some(answer)
}

/// A forecast is printed if one start may take more steps than this, about half a second of a core.
const MANY_STEPS: f64 = 1e6;

/// The possible cost of a start in words, or `None` if it is small.
fn forecast(basins: &Basins) -> Option<String> {
    let (steps, seconds) = basins.cost_of_a_period();
    let periods = Basins::PATIENCE as f64;
    (steps * periods > MANY_STEPS).then(|| {
        format!(
            "a forcing period takes some {} steps: a start is followed for at most {periods} of them, \
             which takes some {} of a core; a start that takes far more than the others ends early",
            short(steps),
            duration(seconds * periods)
        )
    })
}

/// Rows that a thread formats at a time.
const ROWS: usize = 1 << 14;

fn write_rows(outputs: &mut Outputs, basins: &Basins, answer: &Answer, pool: &Pool) -> Result<(), Failure> {
    outputs.table(Output::DATA, &answer.table(basins, 0, 0))?;
    let begins: Vec<usize> = (0..answer.rows.len()).step_by(ROWS).collect();
    for begins in begins.chunks(pool.count()) {
        interrupt::check()?;
        let text = |(): &mut (), part: usize| -> Result<String, Infallible> {
            Ok(rows(&answer.table(basins, begins[part], begins[part] + ROWS), 0..ROWS))
        };
        let Ok(texts) = pool.map(begins.len(), || (), text);
        for text in texts {
            outputs.write(Output::DATA, &text)?;
        }
    }
    Ok(())
}

fn outcome(answer: &Answer, count: u64, seconds: f64) -> String {
    let attractors = counted(answer.attractors.len() as u64, "attractor");
    let mut text = format!("{} in {seconds:.2} s, {attractors}", counted(count, "start"));
    let undecided = format!("not settled after {} periods", Basins::PATIENCE);
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

fn starts(options: &Arguments) -> Result<Starts, Failure> {
    let given = |option: &'static str, text: &Option<String>| {
        let missing = || Failure::argument(format!("{option} is missing: {AS_EVEN}"));
        text.clone().map(|text| (option, text)).ok_or_else(missing)
    };
    let texts = [given("--x-mm", &options.x_mm)?, given("--v", &options.v)?];
    let Some(text) = &options.random else {
        let [x_mm, v] = texts.map(|(option, text)| even(option, &text));
        let (x_mm, v) = (x_mm?, v?);
        return Starts::grid(&x_mm, &v).map_err(|problem| wrong("--x-mm and --v", "", &problem));
    };
    let whole = |option: &str, text: &str| {
        let wrong = |_| Failure::argument(format!("{option} {text}: give a whole number, such as 1000"));
        text.trim().parse::<u64>().map_err(wrong)
    };
    let count = whole("--random", text)?;
    let seed = options.seed.as_deref().map_or(Ok(0), |text| whole("--seed", text))?;
    let [x_mm, v] = texts.map(|(option, text)| {
        let [from, to] = numbers(option, &text, ':')?[..] else {
            let message = "with --random write A:B; --random says how many";
            refuse!("{option} {text}: {message}");
        };
        Starts::random((from, to), (0.0, 0.0), 1, 0).map_err(|problem| wrong(option, &text, &problem))?;
        Ok((from, to))
    });
    Starts::random(x_mm?, v?, count, seed).map_err(|problem| wrong("--random", text, &problem))
}

fn wrong(option: &str, text: &str, problem: &StartsError) -> Failure {
    Failure::argument(format!("{}: {problem}", format!("{option} {text}").trim_end()))
}

/// The values `A:B:N` as given to `option`.
fn even(option: &str, text: &str) -> Result<EvenRange, Failure> {
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let [_, _, count] = parts[..] else { refuse!("{option} {text}: {AS_EVEN}") };
    let Ok(count) = count.parse::<u64>() else {
        refuse!("{option} {text}: N is not a whole number; {AS_EVEN}")
    };
    let ends = numbers(option, text, ':')?;
    let range = EvenRange { from: ends[0], to: ends[1], count };
    range.check().map_err(|problem| wrong(option, text, &problem))?;
    Ok(range)
}
