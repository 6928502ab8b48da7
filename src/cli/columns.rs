//! Options that choose the columns of a measured record.

use clap::Args;
use interwell::scene::{Ask, Quantity};

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

    /// Column of the values [default: the one whose name ends with such a unit, as x_mm, a_g, force_n]
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

impl PositionOptions {
    /// The request to the record for the positions.
    pub fn positions(&self) -> Ask {
        let names = ["--position", "--position-unit"];
        Ask::by_options(&[Quantity::Displacement], &self.position, &self.position_unit, names)
    }
}

impl ColumnOptions {
    /// The request to the record for the times.
    pub fn times(&self) -> Ask {
        Ask::by_options(&[Quantity::Time], &self.time, &self.time_unit, ["--time", "--time-unit"])
    }

    /// The request to the record for values of the first of these quantities that it has.
    pub fn values(&self, quantities: &[Quantity]) -> Ask {
        Ask::by_options(quantities, &self.column, &self.unit, ["--column", "--unit"])
    }
}
