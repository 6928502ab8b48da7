//! Measured records: the options that choose their columns, and those of `simulate` and `curve` that compare
//! a record with the computed motion or force.

use std::path::PathBuf;

use clap::Args;
use interwell::mechanics::Mechanism;
use interwell::numeric::short;
use interwell::output::aligned;
use interwell::questions::{Curve, Error, Simulation, columns_read};
use interwell::scene::{ColumnRequest, Document, Measured, Quantity, read_measured};
use interwell_studies::study::{Comparison, ForceComparison, MeasuredMotion, metres};

use super::support::{finite, numbers};
use super::{Common, Failure, interrupt, refuse, say};

/// Columns of time and of what was measured.
#[derive(Debug, Args)]
#[command(next_help_heading = "Columns of the record")]
pub struct ColumnOptions {
    /// Column of the times [default: the one whose name ends with a unit of time, as t_s or `time (ms)`]
    #[arg(long, value_name = "COLUMN")]
    pub time: Option<String>,

    /// Unit of the times: s, ms or us [default: as the column's name ends]
    #[arg(long, value_name = "UNIT")]
    pub time_unit: Option<String>,

    /// Column of the values [default: the one whose name ends with a unit, such as x_mm, a_g, force_n]
    #[arg(long, value_name = "COLUMN")]
    pub column: Option<String>,

    /// Unit of the values, such as mm, m/s, g or N [default: as the column's name ends]
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<String>,
}

/// The column of positions, of a force over them.
#[derive(Debug, Args)]
pub struct PositionOptions {
    /// Of force: column of the positions [default: the one whose name ends with a unit of length]
    #[arg(long, value_name = "COLUMN")]
    pub position: Option<String>,

    /// Of force: unit of the positions: m, cm, mm or um [default: as the column's name ends]
    #[arg(long, value_name = "UNIT")]
    pub position_unit: Option<String>,
}

/// The answer without `--measured`: nothing to compare, an error if a column of the record is `chosen`.
fn no_record<T, const N: usize>(
    options: [&str; N],
    chosen: [&Option<String>; N],
) -> Result<Option<T>, Failure> {
    match options.iter().zip(chosen).find(|(_, column)| column.is_some()) {
        None => Ok(None),
        Some((option, _)) => refuse!("{option} is for a record: name the record by --measured FILE"),
    }
}

/// The offset in m that `--offset-mm` gives.
fn offset(text: Option<&str>) -> Result<f64, Failure> {
    text.map_or(Ok(0.0), |text| finite("--offset-mm", text, "give mm, such as -35.2").map(metres))
}

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
    pub fn read(&self, common: &Common) -> Result<Option<MeasuredRecord>, Failure> {
        let ColumnOptions { time, time_unit, column, unit } = &self.columns;
        let names = ["--time", "--time-unit", "--column", "--unit"];
        let Some(path) = &self.measured else {
            return no_record(names, [time, time_unit, column, unit]);
        };
        let offset = offset(self.offset_mm.as_deref())?;
        let shift = match self.shift_s.as_deref() {
            Some("auto") => None,
            None => Some(0.0),
            Some(text) => Some(finite("--shift-s", text, "give seconds, such as -0.25, or auto")?),
        };
        let above = "give a number above 0, such as 0.001 for times that are milliseconds";
        let time_scale = self.time_scale.as_deref();
        let time_scale = time_scale.map_or(Ok(1.0), |text| finite("--time-scale", text, above))?;
        if !(time_scale > 0.0) {
            refuse!("--time-scale {time_scale}: {above}");
        }
        let inset = |text| match numbers("--inset", text, ':')?[..] {
            [from, to] if 0.0 <= from && from < to && to.is_finite() => Ok((from, to)),
            _ => refuse!("--inset {text}: write A:B with times of the run, A below B, such as 29:31"),
        };
        let inset = self.inset.as_deref().map(inset).transpose()?;
        let name = path.display().to_string();
        let any = [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration];
        let times = ColumnRequest::by_options(&[Quantity::Time], time, time_unit, [names[0], names[1]]);
        let values = ColumnRequest::by_options(&any, column, unit, [names[2], names[3]]);
        let record = read_measured(path, &[times, values])
            .map_err(|problem| Failure::argument(format!("--measured {name}: {problem}")))?;
        let quantity = record.channels[1].quantity;
        if self.offset_mm.is_some() && quantity != Quantity::Displacement {
            refuse!("--offset-mm: {name} has a {}, no displacement", quantity.name());
        }
        common.say(&format!("{name}: {}", columns_read(&record)));
        Ok(Some(MeasuredRecord { record, inset, name, offset, time_scale, shift }))
    }
}

impl MeasuredRecord {
    /// Compares the record with the run of a scene.
    pub fn compare(&self, simulation: &Simulation) -> Result<Comparison, Failure> {
        let [times, channel] = &self.record.channels;
        let Self { offset, time_scale, shift, .. } = *self;
        let motion = MeasuredMotion { times: &times.values, channel, offset, time_scale, shift };
        simulation.compared(&motion, &interrupt::progress()).map_err(|error| match error {
            Error::Unfit { .. } => Failure::argument(format!("{}: {}", self.name, error.problem())),
            error => error.into(),
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

#[derive(Debug, Args)]
#[command(next_help_heading = "Comparison with a measured force")]
pub struct MeasuredForceOptions {
    /// Compare with this record, CSV with a header: force over position of a slow pull. With --plot both are
    /// drawn over each other, and below them the difference
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    pub measured: Option<PathBuf>,

    /// With --measured: write the numbers in which the two differ as CSV [default: on standard error]
    #[arg(long, value_name = "FILE", allow_hyphen_values = true, requires = "measured")]
    pub comparison: Option<PathBuf>,

    /// With --measured: mm added to the positions, where the sensor has another zero [default: 0]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, requires = "measured")]
    pub offset_mm: Option<String>,

    #[command(flatten)]
    pub positions: PositionOptions,

    /// Column of the force [default: the one whose name ends with a unit of force, as force_n or `F [mN]`]
    #[arg(long, value_name = "COLUMN", requires = "measured")]
    pub column: Option<String>,

    /// Unit of the force: N, mN, uN or kN [default: as the column's name ends]
    #[arg(long, value_name = "UNIT", requires = "measured")]
    pub unit: Option<String>,
}

impl MeasuredForceOptions {
    /// Compares the record, if one is given, with the curve of a mechanism.
    pub fn compare(
        &self,
        document: &Document,
        mechanism: &Mechanism,
        common: &Common,
    ) -> Result<Option<ForceComparison>, Failure> {
        let PositionOptions { position, position_unit } = &self.positions;
        let names = ["--position", "--position-unit"];
        let Some(path) = &self.measured else {
            return no_record(names, [position, position_unit]);
        };
        let offset = offset(self.offset_mm.as_deref())?;
        let name = path.display();
        let position = ColumnRequest::by_options(&[Quantity::Displacement], position, position_unit, names);
        let force =
            ColumnRequest::by_options(&[Quantity::Force], &self.column, &self.unit, ["--column", "--unit"]);
        let about = |problem: String| Failure::argument(format!("--measured {name}: {problem}"));
        let record = read_measured(path, &[position, force]).map_err(|problem| about(problem.to_string()))?;
        let commas = if record.decimal_commas { ", with decimal commas" } else { "" };
        let [x, force] = &record.channels;
        let positions: Vec<f64> = x.values.iter().map(|x| x + offset).collect();
        let found = Curve::compared(document, mechanism, &positions, &force.values)
            .map_err(|error| about(error.problem()))?;
        common.say(&format!("{name}: position from `{}`, force from `{}`{commas}", x.column, force.column));
        found.remarks.iter().for_each(|remark| common.say(&format!("{name}: {remark}")));
        common.say(aligned(&found.table).trim_end());
        Ok(Some(found))
    }
}
