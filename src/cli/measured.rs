//! Options of `simulate` that lay a measured motion over the computed one.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use clap::Args;
use interwell::dynamics::Model;
use interwell::numeric::short;
use interwell::output::aligned;
use interwell::scene::{Measured, Quantity, Scene, read_measured};
use interwell::study::{Comparison, MeasuredMotion, NoComparison, compare, metres};

use super::columns::ColumnOptions;
use super::failure::Failure;
use super::say;
use super::support::{number, numbers};

#[derive(Debug, Args)]
#[command(next_help_heading = "Comparison with a measured motion")]
pub struct MeasuredOptions {
    /// Compare with this record, CSV with a header: displacement, velocity or acceleration of the base over
    /// time. With --plot both are drawn over each other
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub measured: Option<PathBuf>,

    /// With --measured: write the numbers in which the two differ as CSV [default: on standard error]
    #[arg(long, value_name = "FILE", allow_hyphen_values = true, requires = "measured")]
    pub comparison: Option<PathBuf>,

    /// With --measured: seconds added to the times of the record, or auto, which finds the shift of the least
    /// mean square difference [default: 0]
    #[arg(long, value_name = "S|auto", allow_hyphen_values = true, requires = "measured")]
    pub shift_s: Option<String>,

    /// With --measured: mm added to a displacement, where the sensor has another zero [default: 0]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, requires = "measured")]
    pub offset_mm: Option<String>,

    /// With --measured: what the times of the record are multiplied by, before they are shifted [default: 1]
    #[arg(long, value_name = "K", allow_hyphen_values = true, requires = "measured")]
    pub time_scale: Option<String>,

    /// With --measured and --plot: times in s that a second panel shows closer
    #[arg(long, value_name = "A:B", allow_hyphen_values = true, requires_all = ["measured", "plot"])]
    pub inset: Option<String>,

    #[command(flatten)]
    pub columns: ColumnOptions,
}

/// The offset in m that `--offset-mm` gives.
pub fn offset(text: Option<&str>) -> Result<f64, Failure> {
    let Some(text) = text else { return Ok(0.0) };
    finite("--offset-mm", text, "give mm, such as -35.2").map(metres)
}

fn finite(option: &str, text: &str, right: &str) -> Result<f64, Failure> {
    number(option, text, |value: &f64| value.is_finite(), right)
}

/// A measured record, and how its times and values are shifted and scaled for the comparison with a run.
pub struct MeasuredRecord {
    /// Times and values.
    pub record: Measured<2>,
    /// Times in s that a second panel shows closer.
    pub inset: Option<(f64, f64)>,
    name: String,
    offset: f64,
    time_scale: f64,
    shift: Option<f64>,
}

impl MeasuredOptions {
    /// Reads the record, if one is given.
    pub fn read(&self, quiet: bool) -> Result<Option<MeasuredRecord>, Failure> {
        let ColumnOptions { time, time_unit, column, unit } = &self.columns;
        let chosen = [("--time", time), ("--time-unit", time_unit), ("--column", column), ("--unit", unit)];
        let Some(path) = &self.measured else {
            return match chosen.into_iter().find(|option| option.1.is_some()) {
                None => Ok(None),
                Some((option, _)) => {
                    Err(Failure::argument(format!("{option} is of a record: name that by --measured FILE")))
                }
            };
        };
        let offset = offset(self.offset_mm.as_deref())?;
        let shift = match self.shift_s.as_deref() {
            Some("auto") => None,
            None => Some(0.0),
            Some(text) => Some(finite("--shift-s", text, "give seconds, such as -0.25, or auto")?),
        };
        let above = "give a number above 0, such as 0.001 for times that are milliseconds";
        let time_scale = match self.time_scale.as_deref() {
            None => 1.0,
            Some(text) => finite("--time-scale", text, above)?,
        };
        if !(time_scale > 0.0) {
            return Err(Failure::argument(format!("--time-scale {time_scale}: {above}")));
        }
        let inset = match self.inset.as_deref() {
            None => None,
            Some(text) => match numbers("--inset", text, ':')?[..] {
                [from, to] if 0.0 <= from && from < to && to.is_finite() => Some((from, to)),
                _ => {
                    let message =
                        format!("--inset {text}: write A:B with times of the run, A below B, such as 29:31");
                    return Err(Failure::argument(message));
                }
            },
        };
        let name = path.display().to_string();
        let any = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration];
        let record = read_measured(path, &[self.columns.times(), self.columns.values(&any)])
            .map_err(|problem| Failure::argument(format!("--measured {name}: {problem}")))?;
        if self.offset_mm.is_some() && record.channels[1].quantity != Quantity::Displacement {
            let what = record.channels[1].quantity.name();
            return Err(Failure::argument(format!("--offset-mm: {name} has a {what}, no displacement")));
        }
        if !quiet {
            let [times, values] = &record.channels;
            let commas = if record.decimal_commas { ", with decimal commas" } else { "" };
            let what = values.quantity.name();
            say(&format!("{name}: time from `{}`, {what} from `{}`{commas}", times.column, values.column));
        }
        Ok(Some(MeasuredRecord { record, inset, name, offset, time_scale, shift }))
    }
}

impl MeasuredRecord {
    /// Compares the record with the run of a model.
    pub fn compare(&self, scene: &Scene, model: &Model, cancel: &AtomicBool) -> Result<Comparison, Failure> {
        let [times, channel] = &self.record.channels;
        let Self { offset, time_scale, shift, .. } = *self;
        let motion = MeasuredMotion { times: &times.values, channel, offset, time_scale, shift };
        compare(scene, model, &motion, cancel).map_err(|problem| match problem {
            NoComparison::Cancelled => Failure::interrupted(),
            problem => Failure::argument(format!("{}: {problem}", self.name)),
        })
    }

    /// Prints the comparison on standard error.
    pub fn report(&self, found: &Comparison) {
        let name = &self.name;
        found.remarks.iter().for_each(|remark| say(&format!("{name}: {remark}")));
        let how = if self.shift.is_none() { " (found by least squares)" } else { "" };
        say(&format!("{name}: shifted by {} s{how}", short(found.shift)));
        say(aligned(&found.table).trim_end());
    }
}
