//! `identify`: damping, restitution or force curve from a measured record.

use std::path::PathBuf;

use clap::Args;
use interwell::output::{Caption, identified, identified_chart};
use interwell::questions::{Identify, IdentifyAnswer, WhatToIdentify};
use interwell::scene::Timing;
use interwell_studies::study::Identity;

use super::measured::{ColumnOptions, PositionOptions};
use super::{ChartOptions, Common, Failure, Output, Outputs, Picture, interrupt, refuse};

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

    /// Leave out samples before this time in s
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    pub from: Option<f64>,

    /// Leave out samples after this time in s
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    pub to: Option<f64>,

    /// Of restitution: each row is an impact of which only the time is known
    #[arg(long)]
    pub impact_times: bool,

    /// Of restitution: column of the base's acceleration, which makes the flights smoother
    #[arg(long, value_name = "COLUMN")]
    pub base: Option<String>,

    /// Of restitution: unit of the base's acceleration: m/s^2 or g [default: as the column's name ends]
    #[arg(long, value_name = "UNIT")]
    pub base_unit: Option<String>,

    /// Of force: points of the curve, 4 to 100000 [default: 101, or as many as the samples allow]
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

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let (Some(file), Some(of)) = (options.file.as_deref(), options.of.as_deref()) else {
        refuse!(
            "identify needs a record and what to identify: identify FILE --of damping, restitution or force"
        );
    };
    let question = question(options, WhatToIdentify::named(of).unwrap_or(WhatToIdentify::Damping));
    question.check()?;
    let picture = Picture::of_chart(&options.chart, common)?;
    let record = [file.to_path_buf()];
    let mut outputs = Outputs::new(&record)
        .with_rows(Some(common.out()))?
        .reading(&record)?
        .with(Output::SUMMARY, options.summary.as_deref())?
        .with_picture(picture)?;
    let IdentifyAnswer { timing, found, across, values, columns } =
        question.run(file, &interrupt::progress())?;
    common.say(&format!("{}: {columns}", file.display()));
    outputs.table(Output::DATA, &found.rows)?;
    outputs.write(Output::SUMMARY, identified(of, &found, timing.as_ref(), &outputs.watch.origin(1)))?;
    if let Some(picture) = picture {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let caption = Caption::of_record(&name, of, env!("CARGO_PKG_VERSION"));
        let record = (&across[..], &values.values[..]);
        let chart = identified_chart(of, &found, record, values.quantity, picture.ranges);
        picture.write(&mut outputs, &chart, &caption)?;
    }
    outputs.finish_rows(None, 1)?;
    let sampling = timing.iter().map(Timing::describe);
    let lines = sampling.chain(found.summary.iter().map(Identity::describe)).chain(found.remarks);
    lines.for_each(|line| common.say(&format!("{}: {line}", file.display())));
    Ok(())
}

fn question(options: &Arguments, of: WhatToIdentify) -> Identify {
    let (ColumnOptions { time, time_unit, column, unit }, positions) = (&options.columns, &options.positions);
    let both = |name: &Option<String>, unit: &Option<String>| [name.clone(), unit.clone()];
    Identify {
        of,
        time: both(time, time_unit),
        column: both(column, unit),
        position: both(&positions.position, &positions.position_unit),
        base: both(&options.base, &options.base_unit),
        between: [options.from, options.to],
        impact_times: options.impact_times,
        points: options.points,
    }
}
