//! Measured records: channels with quantity and SI unit, read from CSV.
//!
//! A column is chosen by its name, or by the unit that its name ends with. An invalid value is rejected with
//! its line and column.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::columns::{ColumnsError, Separators, Sheet};
use super::error::clip;
use super::files::{ReadError, read_text};
use super::unit::{Quantity, Unit};

/// Largest number of rows of a measured record.
pub const MAX_MEASURED_ROWS: usize = 10_000_000;
/// Largest size of a measured record in bytes.
pub const MAX_MEASURED_BYTES: usize = 1 << 30;

/// Request for a column.
///
/// It is what [`read_measured`] takes, one for each column.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnRequest {
    /// Accepted quantities. Without a column name, the first quantity of which a column has a unit is chosen.
    pub quantities: Vec<Quantity>,
    /// The column and unit given by options; without them, the header alone decides.
    pub options: Option<ColumnOptions>,
}

/// Options that may name a column and its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnOptions {
    /// Name of the column; if `None`, the column is chosen by its unit.
    pub column: Option<String>,
    /// Unit of the column; if `None`, the unit at the end of its name.
    pub unit: Option<String>,
    /// The options that give name and unit, for messages.
    pub names: [&'static str; 2],
}

/// Values of one column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Channel {
    /// The measured quantity.
    pub quantity: Quantity,
    /// The column's name.
    pub column: String,
    /// The values in SI; all finite.
    pub values: Vec<f64>,
}

/// Channels of equal length, in the order of the requests; a channel of times is increasing.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured<const N: usize> {
    /// The channels.
    pub channels: [Channel; N],
    /// Whether the numbers have a decimal comma.
    pub decimal_commas: bool,
}

/// Reason why a measured record cannot be read, as a clause.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeasuredError {
    /// The text is not a table of numbers.
    #[error(transparent)]
    Columns(#[from] ColumnsError),
    /// No column has a unit of the quantity.
    #[error("{problem}")]
    NoColumn {
        /// Requested quantity.
        quantity: Quantity,
        /// The columns of the header, and the remedy.
        problem: String,
    },
    /// Anything else: the file, the choice of a column, or the values in it.
    #[error("{0}")]
    Unusable(String),
}

/// Reads columns of a measured record, the CSV file at `path` with a header, and converts them to SI. A
/// column is chosen by its name, or by the unit at its end, such as `x_mm`.
///
/// ```
/// # use interwell_kernel as interwell;
/// use interwell::scene::{ColumnRequest, Measured, Quantity};
///
/// let request = |quantity| ColumnRequest { quantities: vec![quantity], options: None };
/// let requests = [request(Quantity::Time), request(Quantity::Displacement)];
/// let record = Measured::parse("t_ms,x_mm\n0,1.5\n10,1.25\n", &requests)?; // or read_measured of a file
/// assert_eq!(record.channels[0].values, [0.0, 0.01]);
/// assert_eq!(record.channels[1].values, [1.5e-3, 1.25e-3]);
/// # Ok::<(), interwell::scene::MeasuredError>(())
/// ```
///
/// # Errors
///
/// For a file that is missing, larger than [`MAX_MEASURED_BYTES`] or no CSV, a column that is not found, a
/// value that is no finite number, fewer than two rows, and times that do not increase.
pub fn read_measured<const N: usize>(
    path: &Path,
    requests: &[ColumnRequest; N],
) -> Result<Measured<N>, MeasuredError> {
    Measured::parse(&text_of(path)?, requests)
}

fn text_of(path: &Path) -> Result<String, MeasuredError> {
    read_text(path, MAX_MEASURED_BYTES).map_err(|error| {
        MeasuredError::Unusable(match error {
            ReadError::Missing => {
                "is not there (no such file); give the path of a CSV with a header".to_owned()
            }
            ReadError::Unusable(problem) => problem,
        })
    })
}

/// The text of a record with its header parsed, so that columns can be chosen.
#[doc(hidden)]
#[derive(Debug)]
pub struct MeasuredText {
    text: String,
    /// The names of its columns.
    pub names: Vec<String>,
}

/// Index of a column, and its unit if known.
#[doc(hidden)]
pub type ChosenColumn = (usize, Option<Unit>);

impl MeasuredText {
    /// Reads the file at `path`.
    pub fn read(path: &Path) -> Result<Self, MeasuredError> {
        let text = text_of(path)?;
        let names = Sheet::open(&text, "t_s,x_m", Separators::Any, MAX_MEASURED_ROWS)?.names;
        Ok(Self { text, names })
    }

    /// Guesses the abscissa and the values from the units of the columns: force over position, or else
    /// displacement, velocity or acceleration over time. Without such units it takes the first column as the
    /// abscissa and the first other column for the values.
    pub fn guess(&self) -> [ChosenColumn; 2] {
        let column_of = |quantity: Quantity| {
            let unit = |name: &String| Unit::of_name(name).filter(|unit| unit.quantity == quantity);
            self.names.iter().enumerate().find_map(|(at, name)| Some((at, Some(unit(name)?))))
        };
        let position = column_of(Quantity::Displacement);
        if let (Some(position), Some(force)) = (position, column_of(Quantity::Force)) {
            return [position, force];
        }
        let abscissa = column_of(Quantity::Time).unwrap_or((0, None));
        let values =
            position.or_else(|| column_of(Quantity::Velocity)).or_else(|| column_of(Quantity::Acceleration));
        let other = usize::from(abscissa.0 == 0 && self.names.len() > 1);
        [abscissa, values.unwrap_or((other, None))]
    }

    /// The values of two columns with the given units.
    pub fn channels(&self, chosen: [(usize, Unit); 2]) -> Result<Measured<2>, MeasuredError> {
        let sheet = Sheet::open(&self.text, "t_s,x_m", Separators::Any, MAX_MEASURED_ROWS)?;
        Measured::of(&sheet, chosen)
    }
}

impl<const N: usize> Measured<N> {
    /// Parses a record: CSV with a header and values separated by commas, or by semicolons or tabs with
    /// decimal points or decimal commas.
    ///
    /// # Errors
    ///
    /// Those of [`read_measured`].
    pub fn parse(text: &str, requests: &[ColumnRequest; N]) -> Result<Self, MeasuredError> {
        let wanted: Vec<String> = requests.iter().map(ColumnRequest::wanted).collect();
        let sheet = Sheet::open(text, &wanted.join(","), Separators::Any, MAX_MEASURED_ROWS)?;
        let mut chosen = Vec::with_capacity(N);
        for request in requests {
            chosen.push(request.choose(&sheet)?);
        }
        Self::of(&sheet, std::array::from_fn(|k| chosen[k]))
    }

    /// The columns with these indices and units.
    fn of(sheet: &Sheet, chosen: [(usize, Unit); N]) -> Result<Self, MeasuredError> {
        let columns = sheet.numbers(chosen.map(|(at, _)| at))?;
        if columns.rows.len() < 2 {
            return Err(MeasuredError::Unusable(too_few(columns.rows.len())));
        }
        let times = chosen.iter().enumerate().filter(|(_, (_, unit))| unit.quantity == Quantity::Time);
        for (k, (at, unit)) in times {
            let turn = columns.rows.windows(2).position(|pair| unit.si(pair[1][k]) <= unit.si(pair[0][k]));
            if let Some(row) = turn {
                let (before, time) = (columns.rows[row][k], columns.rows[row + 1][k]);
                let (line, column) = (columns.lines[row + 1], clip(&sheet.names[*at]));
                return Err(MeasuredError::Unusable(format!(
                    "line {line}: {column} = {time} does not come after {before}; times must increase from \
                     row to row (sort the rows; of several with one time keep one)"
                )));
            }
        }
        let channels = std::array::from_fn(|k| Channel {
            quantity: chosen[k].1.quantity,
            column: sheet.names[chosen[k].0].clone(),
            values: columns.rows.iter().map(|row| chosen[k].1.si(row[k])).collect(),
        });
        Ok(Self { channels, decimal_commas: columns.decimal_commas })
    }
}

impl ColumnRequest {
    /// A request by the options `names` for column and unit.
    pub fn by_options(
        quantities: &[Quantity],
        column: &Option<String>,
        unit: &Option<String>,
        names: [&'static str; 2],
    ) -> Self {
        let options = ColumnOptions { column: column.clone(), unit: unit.clone(), names };
        Self { quantities: quantities.to_vec(), options: Some(options) }
    }

    /// The requested name, or an example of one, for messages.
    fn wanted(&self) -> String {
        let column = self.options.as_ref().and_then(|options| options.column.clone());
        column.unwrap_or_else(|| self.quantities[0].example())
    }

    /// The column's index and unit.
    fn choose(&self, sheet: &Sheet) -> Result<(usize, Unit), MeasuredError> {
        let Some(ColumnOptions { column, unit, names: [_, unit_option] }) = &self.options else {
            return self.choose_by_unit(sheet, None);
        };
        let quantity =
            self.quantities.iter().map(|quantity| quantity.name()).collect::<Vec<_>>().join(" or ");
        let units = self.quantities.iter().map(|quantity| quantity.units()).collect::<Vec<_>>().join(", ");
        let of_word = |word: &str| {
            let found = self.quantities.iter().find_map(|quantity| Unit::of_word(word, *quantity));
            let unit = clip(word);
            found.ok_or_else(|| {
                let problem = format!("{unit_option}: `{unit}` is no unit of {quantity}; known are {units}");
                MeasuredError::Unusable(problem)
            })
        };
        let given = unit.as_deref().map(of_word).transpose()?;
        let Some(name) = column else { return self.choose_by_unit(sheet, given) };
        let at = sheet.named_column(name)?;
        let in_name = Unit::of_name(&sheet.names[at]).filter(|unit| self.quantities.contains(&unit.quantity));
        let unit = given.or(in_name).ok_or_else(|| {
            MeasuredError::Unusable(format!(
                "column {}: its name ends with no unit of {quantity}; give it by {unit_option} ({units})",
                clip(name)
            ))
        })?;
        Ok((at, unit))
    }

    /// The only column with a unit of the first quantity that has one; `given` replaces that unit.
    fn choose_by_unit(&self, sheet: &Sheet, given: Option<Unit>) -> Result<(usize, Unit), MeasuredError> {
        let (line, names) = (sheet.line(0), self.options.as_ref().map(|options| options.names));
        for quantity in &self.quantities {
            let with_unit = |(at, name): (usize, &String)| {
                let unit = Unit::of_name(name).filter(|unit| unit.quantity == *quantity)?;
                Some((at, unit))
            };
            let found: Vec<(usize, Unit)> = sheet.names.iter().enumerate().filter_map(with_unit).collect();
            match found[..] {
                [] => {}
                [(at, unit)] => return Ok((at, given.unwrap_or(unit))),
                _ => {
                    let found: Vec<&str> = found.iter().map(|(at, _)| sheet.names[*at].as_str()).collect();
                    let (found, name) = (clip(&found.join(", ")), quantity.name());
                    let remedy = match names {
                        None => "leave the unit to one of them".to_owned(),
                        Some([option, _]) => format!("name one by {option}"),
                    };
                    let problem = format!("line {line}: {found} are all columns of {name}: {remedy}");
                    return Err(MeasuredError::Unusable(problem));
                }
            }
        }
        let quantity = self.quantities[0];
        let remedy = match names {
            None => "Put the unit at the end of the column's name".to_owned(),
            Some([option, unit]) => format!("Name the column by {option} and its unit by {unit}"),
        };
        let problem = format!(
            "line {line}: no column of {name} ({name} in {units}, as in `{example}`); {found}. \
             {remedy}. The header is the first line that does not begin with #: put that before \
             what stands above it",
            name = quantity.name(),
            units = quantity.units(),
            example = self.wanted(),
            found = sheet.header()
        );
        Err(MeasuredError::NoColumn { quantity, problem })
    }
}

/// The clause for a record with this many rows, fewer than 2.
pub(super) fn too_few(rows: usize) -> String {
    let count = if rows == 0 { "no row" } else { "one row" };
    format!("has {count} of numbers; a record needs at least 2")
}
