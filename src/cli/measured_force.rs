//! Options of `curve` that lay a measured force over the computed one.

use std::path::PathBuf;

use clap::Args;
use interwell::mechanics::Mechanism;
use interwell::output::aligned;
use interwell::scene::{Ask, Quantity, read_measured};
use interwell::study::{ForceComparison, compare_force};

use super::columns::PositionOptions;
use super::failure::Failure;
use super::measured::offset;
use super::say;

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
    pub fn compare(&self, mechanism: &Mechanism, quiet: bool) -> Result<Option<ForceComparison>, Failure> {
        let PositionOptions { position, position_unit } = &self.positions;
        let Some(path) = &self.measured else {
            let chosen = [("--position", position), ("--position-unit", position_unit)];
            return match chosen.into_iter().find(|option| option.1.is_some()) {
                None => Ok(None),
                Some((option, _)) => {
                    Err(Failure::argument(format!("{option} is of a record: name that by --measured FILE")))
                }
            };
        };
        let offset = offset(self.offset_mm.as_deref())?;
        let name = path.display();
        let names = ["--column", "--unit"];
        let force = Ask::by_options(&[Quantity::Force], &self.column, &self.unit, names);
        let about =
            |problem: &dyn std::fmt::Display| Failure::argument(format!("--measured {name}: {problem}"));
        let record =
            read_measured(path, &[self.positions.positions(), force]).map_err(|problem| about(&problem))?;
        let commas = if record.decimal_commas { ", with decimal commas" } else { "" };
        let [x, force] = &record.channels;
        let positions: Vec<f64> = x.values.iter().map(|x| x + offset).collect();
        let found = compare_force(mechanism, &positions, &force.values).map_err(|problem| about(&problem))?;
        if !quiet {
            say(&format!("{name}: position from `{}`, force from `{}`{commas}", x.column, force.column));
            found.remarks.iter().for_each(|remark| say(&format!("{name}: {remark}")));
            say(aligned(&found.table).trim_end());
        }
        Ok(Some(found))
    }
}
