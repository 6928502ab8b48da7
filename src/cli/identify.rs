//! `identify`: damping, restitution or force curve from a measured record.

use std::path::{Path, PathBuf};

use clap::Args;
use interwell::output::{Caption, identified, identified_chart};
use interwell::scene::{Ask, Channel, Measured, Quantity, Timing, read_measured};
use interwell::study::{
    FORCE_POINTS, Identified, Unidentified, damping, force, restitution, restitution_of_times,
};

use super::columns::{ColumnOptions, PositionOptions};
use super::failure::Failure;
use super::options::{ChartOptions, Common};
use super::outputs::{Output, Outputs};
use super::picture::Picture;
use super::say;
use super::support::Watch;

const EXAMPLES: &str = "\
Examples:
  interwell --headless identify decay.csv --of damping --out ratio.csv --summary ratio.json
  interwell --headless identify decay.csv --of damping --out ratio.csv --plot decay.png
  interwell --headless identify laser.csv --of damping --from 2.1 --to 6 --column 'laser (mm)'
  interwell --headless identify bounce.csv --of restitution --time Zeit --time-unit ms --column Weg --unit mm
  interwell --headless identify shaken.csv --of restitution --base base_accel_m_per_s2 --summary e.json
  interwell --headless identify impacts.csv --of restitution --impact-times
  interwell --headless identify pull.csv --of force --points 201 --out force.csv
  interwell --headless curve --set 'mechanism=Table(path: \"/data/force.csv\", tolerance: 1e-3)'";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// The record: CSV with a header
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,

    /// What is identified: damping (of a free decay), restitution (of impacts on stops) or force (over
    /// position, of a slow pull)
    #[arg(long, value_name = "WHAT", value_parser = ["damping", "restitution", "force"])]
    pub of: Option<String>,

    /// Leave out what was recorded before this time in s
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    pub from: Option<f64>,

    /// Leave out what was recorded after this time in s
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    pub to: Option<f64>,

    /// Of restitution: the rows are impacts, and their times are all that is known
    #[arg(long)]
    pub impact_times: bool,

    /// Of restitution: column of the base's acceleration, which makes the flights smoother
    #[arg(long, value_name = "COLUMN")]
    pub base: Option<String>,

    /// Of restitution: unit of the base's acceleration: m/s^2 or g [default: as the column's name ends]
    #[arg(long, value_name = "UNIT")]
    pub base_unit: Option<String>,

    /// Of restitution: about where the left stop is [default: the leftmost impacts]
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub left_mm: Option<f64>,

    /// Of restitution: about where the right stop is [default: the rightmost impacts]
    #[arg(long, value_name = "MM", allow_hyphen_values = true)]
    pub right_mm: Option<f64>,

    /// Of force: points of the curve, 4 to 100000 [default: 101]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(4..=100_000))]
    pub points: Option<u32>,

    #[command(flatten)]
    pub positions: PositionOptions,

    /// Write the numbers that sum the record up, with their intervals, as JSON
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub summary: Option<PathBuf>,

    #[command(flatten)]
    pub columns: ColumnOptions,

    #[command(flatten)]
    pub chart: ChartOptions,
}

impl Arguments {
    fn file(&self) -> &Path {
        self.file.as_deref().unwrap_or(Path::new(""))
    }

    fn of(&self) -> &str {
        self.of.as_deref().unwrap_or_default()
    }

    /// The request to the record for the base's acceleration.
    fn base(&self) -> Ask {
        Ask::by_options(&[Quantity::Acceleration], &self.base, &self.base_unit, ["--base", "--base-unit"])
    }
}

/// Reads the record, identifies the quantity, and writes rows and summary.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    fits(options)?;
    let watch = Watch::start();
    let picture = Picture::of_chart(&options.chart, "--plot-x", common)?;
    let mut outputs = Outputs::new(&[options.file().to_path_buf()])
        .with(Output::DATA, Some(common.out()))?
        .with(Output::SUMMARY, options.summary.as_deref())?
        .with_picture(picture)?;
    let Answer { timing, found, across, values } = answer(options, common.quiet)?;
    let found = found.map_err(|problem| about(options.file(), problem))?;
    outputs.table(Output::DATA, &found.rows)?;
    let summary = identified(options.of(), &found, timing.as_ref(), &watch.origin(1));
    outputs.write(Output::SUMMARY, &summary)?;
    if let Some(picture) = picture {
        let name = options.file().file_name().unwrap_or_default().to_string_lossy();
        let caption = Caption::of_record(&name, options.of(), env!("CARGO_PKG_VERSION"));
        let record = (&across[..], &values.values[..]);
        let chart = identified_chart(options.of(), &found, record, values.quantity, picture.ranges);
        picture.write(&mut outputs, &chart, &caption)?;
    }
    outputs.finish()?;
    if !common.quiet {
        let name = options.file().display();
        if let Some(timing) = timing {
            say(&format!("{name}: {}", timing.describe()));
        }
        found.summary.iter().for_each(|number| say(&format!("{name}: {}", number.describe())));
        found.remarks.iter().for_each(|remark| say(&format!("{name}: {remark}")));
    }
    Ok(())
}

/// Refuses options that do not belong to what is identified.
fn fits(options: &Arguments) -> Result<(), Failure> {
    if options.file.is_none() || options.of.is_none() {
        return Err(Failure::argument(
            "identify needs a record and what to identify: identify FILE --of damping, restitution or force",
        ));
    }
    let of = options.of();
    let given = |option: &'static str, given: bool, only: &'static str| {
        (given && of != only).then_some((option, only))
    };
    let wrong = [
        given("--impact-times", options.impact_times, "restitution"),
        given("--base", options.base.is_some(), "restitution"),
        given("--base-unit", options.base_unit.is_some(), "restitution"),
        given("--left-mm", options.left_mm.is_some(), "restitution"),
        given("--right-mm", options.right_mm.is_some(), "restitution"),
        given("--points", options.points.is_some(), "force"),
        given("--position", options.positions.position.is_some(), "force"),
        given("--position-unit", options.positions.position_unit.is_some(), "force"),
    ];
    if let Some((option, only)) = wrong.into_iter().flatten().next() {
        return Err(Failure::argument(format!("{option} belongs to --of {only}, not to --of {of}")));
    }
    let timed = [("--from", options.from.is_some()), ("--to", options.to.is_some())];
    if let Some((option, _)) = timed.into_iter().find(|option| option.1 && of == "force") {
        return Err(Failure::argument(format!("{option} cuts a record over time; --of force has none")));
    }
    if let (Some(from), Some(to)) = (options.from, options.to)
        && !(from < to)
    {
        return Err(Failure::argument(format!("--from {from} --to {to}: give a time before and one after")));
    }
    of_record(options)
}

/// Refuses impossible positions of stops, and options that do not go with impact times.
fn of_record(options: &Arguments) -> Result<(), Failure> {
    let places = [("--left-mm", options.left_mm), ("--right-mm", options.right_mm)];
    let endless = |(option, place): &(&'static str, Option<f64>)| {
        place.filter(|place| !place.is_finite()).map(|place| (*option, place))
    };
    if let Some((option, place)) = places.iter().find_map(endless) {
        return Err(Failure::argument(format!("{option} {place}: give the place of the stop in mm")));
    }
    if let (Some(left), Some(right)) = (options.left_mm, options.right_mm)
        && !(left < right)
    {
        let message = "the left stop is the one at the lesser displacement; exchange them";
        return Err(Failure::argument(format!("--left-mm {left} --right-mm {right}: {message}")));
    }
    if options.base.is_none() && options.base_unit.is_some() {
        return Err(Failure::argument("--base-unit is the unit of a column: name the column by --base"));
    }
    let given = [places[0].1.map(|_| "--left-mm"), places[1].1.map(|_| "--right-mm")];
    let beside =
        options.base.as_ref().map(|_| "--base").into_iter().chain(given.into_iter().flatten()).next();
    match beside.filter(|_| options.impact_times) {
        Some(option) => {
            let message = "a record of impact times has no displacement; leave one of them out";
            Err(Failure::argument(format!("{option} with --impact-times: {message}")))
        }
        None => Ok(()),
    }
}

/// The identified quantity, and the record that it is identified from.
struct Answer {
    /// The sampling of a record over time.
    timing: Option<Timing>,
    found: Result<Identified, Unidentified>,
    /// Times or positions.
    across: Vec<f64>,
    /// What was measured; empty for impact times.
    values: Channel,
}

/// Reads the record and identifies the quantity.
fn answer(options: &Arguments, quiet: bool) -> Result<Answer, Failure> {
    let times = options.columns.times();
    match options.of() {
        "force" => {
            let asks = [options.positions.positions(), options.columns.values(&[Quantity::Force])];
            let [x, values] = read(options, quiet, &asks)?.channels;
            let points = options.points.map_or(FORCE_POINTS, |points| points as usize);
            let found = force(&x.values, &values.values, points);
            Ok(Answer { timing: None, found, across: x.values, values })
        }
        "restitution" if options.impact_times => {
            let [times] = cut(options, read(options, quiet, &[times])?)?.channels;
            let found = restitution_of_times(&times.values);
            let values = Channel { quantity: Quantity::Displacement, values: Vec::new(), ..times };
            Ok(Answer { timing: None, found, across: Vec::new(), values })
        }
        "restitution" => {
            let asks = [times, options.columns.values(&[Quantity::Displacement])];
            let (channels, base) = match &options.base {
                None => (cut(options, read(options, quiet, &asks)?)?.channels, None),
                Some(_) => {
                    let [times, values] = asks;
                    let record = read(options, quiet, &[times, values, options.base()])?;
                    let [times, values, base] = cut(options, record)?.channels;
                    ([times, values], Some(base.values))
                }
            };
            let [times, values] = channels;
            let (timing, times) = (Some(Timing::of(&times.values)), times.values);
            let given = [options.left_mm, options.right_mm].map(|place| place.map(|mm| mm * 1e-3));
            let found = restitution(&times, &values.values, base.as_deref(), given);
            Ok(Answer { timing, found, across: times, values })
        }
        _ => {
            let any = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration];
            let record = read(options, quiet, &[times, options.columns.values(&any)])?;
            let [times, values] = cut(options, record)?.channels;
            let (timing, times) = (Some(Timing::of(&times.values)), times.values);
            Ok(Answer { timing, found: damping(&times, &values), across: times, values })
        }
    }
}

fn read<const N: usize>(options: &Arguments, quiet: bool, asks: &[Ask; N]) -> Result<Measured<N>, Failure> {
    let record = read_measured(options.file(), asks).map_err(|problem| about(options.file(), problem))?;
    if !quiet {
        let from = |channel: &Channel| format!("{} from `{}`", channel.quantity.name(), channel.column);
        let read = record.channels.iter().map(from);
        let commas = if record.decimal_commas { ", with decimal commas" } else { "" };
        say(&format!("{}: {}{commas}", options.file().display(), read.collect::<Vec<_>>().join(", ")));
    }
    Ok(record)
}

/// Keeps only the rows from `--from` to `--to`; the first channel is the time.
fn cut<const N: usize>(options: &Arguments, mut record: Measured<N>) -> Result<Measured<N>, Failure> {
    let times = &record.channels[0].values;
    let from = times.partition_point(|t| *t < options.from.unwrap_or(f64::NEG_INFINITY));
    let to = times.partition_point(|t| *t <= options.to.unwrap_or(f64::INFINITY));
    if to < from + 2 {
        let (first, last) = (times[0], times[times.len() - 1]);
        let message =
            format!("less than 2 samples from --from to --to; the record goes from {first} to {last} s");
        return Err(about(options.file(), message));
    }
    for channel in &mut record.channels {
        channel.values = channel.values[from..to].to_vec();
    }
    Ok(record)
}

/// An error about the record.
fn about(file: &Path, problem: impl std::fmt::Display) -> Failure {
    Failure::argument(format!("{}: {problem}", file.display()))
}
