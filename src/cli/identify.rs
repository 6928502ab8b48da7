//! `identify`: damping, restitution or force curve from a measured record.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use clap::Args;
use interwell::output::{Caption, identified, identified_chart};
use interwell::scene::{Channel, ColumnRequest, Measured, Quantity, Timing, read_measured};
use interwell::study::{
    FORCE_POINTS, Identified, Identity, Unidentified, damping, force, restitution, restitution_of_times,
};

use super::measured::{ColumnOptions, PositionOptions, columns_read};
use super::support::Watch;
use super::{ChartOptions, Common, Failure, Output, Outputs, Picture, refuse};

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

struct Identification<'a> {
    options: &'a Arguments,
    common: &'a Common,
    file: &'a Path,
    of: &'a str,
}

/// Reads the record, identifies the quantity, and writes rows and summary.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let (Some(file), Some(of)) = (options.file.as_deref(), options.of.as_deref()) else {
        refuse!(
            "identify needs a record and what to identify: identify FILE --of damping, restitution or force"
        );
    };
    fits(options, of)?;
    let watch = Watch::start();
    let picture = Picture::of_chart(&options.chart, "--plot-x", common)?;
    let mut outputs = Outputs::new(&[file.to_path_buf()])
        .with(Output::DATA, Some(common.out()))?
        .with(Output::SUMMARY, options.summary.as_deref())?
        .with_picture(picture)?;
    let identification = Identification { options, common, file, of };
    let Answer { timing, found, across, values } = identification.answer()?;
    let found = found.map_err(|problem| identification.about(problem))?;
    outputs.table(Output::DATA, &found.rows)?;
    outputs.write(Output::SUMMARY, identified(of, &found, timing.as_ref(), &watch.origin(1)))?;
    if let Some(picture) = picture {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let caption = Caption::of_record(&name, of, env!("CARGO_PKG_VERSION"));
        let record = (&across[..], &values.values[..]);
        let chart = identified_chart(of, &found, record, values.quantity, picture.ranges);
        picture.write(&mut outputs, &chart, &caption)?;
    }
    outputs.finish()?;
    let sampling = timing.iter().map(Timing::describe);
    let lines = sampling.chain(found.summary.iter().map(Identity::describe)).chain(found.remarks);
    lines.for_each(|line| common.say(&format!("{}: {line}", file.display())));
    Ok(())
}

/// Refuses options that do not belong to what is identified.
fn fits(options: &Arguments, of: &str) -> Result<(), Failure> {
    for (option, given, only) in [
        ("--impact-times", options.impact_times, "restitution"),
        ("--base", options.base.is_some(), "restitution"),
        ("--base-unit", options.base_unit.is_some(), "restitution"),
        ("--left-mm", options.left_mm.is_some(), "restitution"),
        ("--right-mm", options.right_mm.is_some(), "restitution"),
        ("--points", options.points.is_some(), "force"),
        ("--position", options.positions.position.is_some(), "force"),
        ("--position-unit", options.positions.position_unit.is_some(), "force"),
    ] {
        if given && of != only {
            refuse!("{option} belongs to --of {only}, not to --of {of}");
        }
    }
    for (option, given) in [("--from", options.from.is_some()), ("--to", options.to.is_some())] {
        if given && of == "force" {
            refuse!("{option} cuts a record over time; --of force has none");
        }
    }
    if let (Some(from), Some(to)) = (options.from, options.to)
        && !(from < to)
    {
        refuse!("--from {from} --to {to}: give a time before and one after");
    }
    of_record(options)
}

/// Refuses impossible positions of stops, and options that do not go with impact times.
fn of_record(options: &Arguments) -> Result<(), Failure> {
    for (option, place) in [("--left-mm", options.left_mm), ("--right-mm", options.right_mm)] {
        if let Some(place) = place.filter(|place| !place.is_finite()) {
            refuse!("{option} {place}: give the place of the stop in mm");
        }
    }
    if let (Some(left), Some(right)) = (options.left_mm, options.right_mm)
        && !(left < right)
    {
        let message = "the left stop is the one at the lesser displacement; exchange them";
        refuse!("--left-mm {left} --right-mm {right}: {message}");
    }
    if options.base.is_none() && options.base_unit.is_some() {
        refuse!("--base-unit is the unit of a column: name the column by --base");
    }
    for (option, given) in [
        ("--base", options.base.is_some()),
        ("--left-mm", options.left_mm.is_some()),
        ("--right-mm", options.right_mm.is_some()),
    ] {
        if options.impact_times && given {
            let message = "a record of impact times has no displacement; leave one of them out";
            refuse!("{option} with --impact-times: {message}");
        }
    }
    Ok(())
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

impl Identification<'_> {
    fn answer(&self) -> Result<Answer, Failure> {
        let options = self.options;
        let (times, of_values) = (options.columns.times(), |asked: &[_]| options.columns.values(asked));
        if self.of == "force" {
            let asks = [options.positions.positions(), of_values(&[Quantity::Force])];
            let [x, values] = self.read(&asks)?.channels;
            let points = options.points.map_or(FORCE_POINTS, |points| points as usize);
            let found = force(&x.values, &values.values, points);
            return Ok(Answer { timing: None, found, across: x.values, values });
        }
        if self.of == "damping" {
            let any = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration];
            let [times, values] = self.cut(self.read(&[times, of_values(&any)])?)?.channels;
            let found = damping(&times.values, &values);
            return Ok(Answer {
                timing: Some(Timing::of(&times.values)),
                found,
                across: times.values,
                values,
            });
        }
        if options.impact_times {
            let [times] = self.cut(self.read(&[times])?)?.channels;
            let found = restitution_of_times(&times.values);
            let values = Channel { quantity: Quantity::Displacement, values: Vec::new(), ..times };
            return Ok(Answer { timing: None, found, across: Vec::new(), values });
        }
        let values = of_values(&[Quantity::Displacement]);
        let ([times, values], base) = if options.base.is_some() {
            let names = ["--base", "--base-unit"];
            let base = ColumnRequest::by_options(
                &[Quantity::Acceleration],
                &options.base,
                &options.base_unit,
                names,
            );
            let [times, values, base] = self.cut(self.read(&[times, values, base])?)?.channels;
            ([times, values], Some(base.values))
        } else {
            (self.cut(self.read(&[times, values])?)?.channels, None)
        };
        let places = [options.left_mm, options.right_mm].map(|place| place.map(|mm| mm * 1e-3));
        let found = restitution(&times.values, &values.values, base.as_deref(), places);
        Ok(Answer { timing: Some(Timing::of(&times.values)), found, across: times.values, values })
    }

    fn read<const N: usize>(&self, asks: &[ColumnRequest; N]) -> Result<Measured<N>, Failure> {
        let record = read_measured(self.file, asks).map_err(|problem| self.about(problem))?;
        self.common.say(&format!("{}: {}", self.file.display(), columns_read(&record)));
        Ok(record)
    }

    /// Keeps only the rows from `--from` to `--to`; the first channel is the time.
    fn cut<const N: usize>(&self, mut record: Measured<N>) -> Result<Measured<N>, Failure> {
        let times = &record.channels[0].values;
        let from = times.partition_point(|t| *t < self.options.from.unwrap_or(f64::NEG_INFINITY));
        let to = times.partition_point(|t| *t <= self.options.to.unwrap_or(f64::INFINITY));
        if to < from + 2 {
            let (first, last) = (times[0], times[times.len() - 1]);
            return Err(self.about(format!(
                "less than 2 samples from --from to --to; the record goes from {first} to {last} s"
            )));
        }
        for channel in &mut record.channels {
            channel.values = channel.values[from..to].to_vec();
        }
        Ok(record)
    }

    fn about(&self, problem: impl Display) -> Failure {
        Failure::argument(format!("{}: {problem}", self.file.display()))
    }
}
