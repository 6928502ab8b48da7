//! Measured records: channels with quantity and SI unit, read from CSV.
//!
//! A column is chosen by its name, or by the unit that its name ends with. What cannot be meant is refused
//! with its line, column and value.

use std::path::Path;

use super::clip::clip;
use super::columns::{ColumnsError, Separators, Sheet};
use super::files::{ReadError, read_text};
use super::unit::{Quantity, Unit};

/// The most rows of a measured record, and the most bytes.
pub const MOST_MEASURED: usize = 10_000_000;
/// See [`MOST_MEASURED`].
pub const LARGEST_MEASURED: usize = 1 << 30;

/// A column that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Ask {
    /// What it may be measured of: where no name is given, the first of them that a column's unit tells.
    pub quantities: Vec<Quantity>,
    /// Its name; left out, the column whose unit is one of such a quantity.
    pub column: Option<String>,
    /// Its unit; left out, the one that its name ends with.
    pub unit: Option<String>,
    /// What gives the name and what gives the unit, for messages; empty where the header alone does.
    pub options: (&'static str, &'static str),
}

/// Values of one column.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// What was measured.
    pub quantity: Quantity,
    /// The column's name.
    pub column: String,
    /// The values in SI; all finite.
    pub values: Vec<f64>,
}

/// Channels of one length, in the order in which they were asked for; a channel of times increases.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured<const N: usize> {
    /// The channels.
    pub channels: [Channel; N],
    /// Whether the numbers have a decimal comma.
    pub decimal_commas: bool,
}

/// What is wrong with a measured record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeasuredError {
    /// The file is not there, or no text.
    #[error("{0}")]
    Unreadable(String),
    /// The columns cannot be read.
    #[error(transparent)]
    Columns(#[from] ColumnsError),
    /// No column has a unit of what is needed.
    #[error(
        "line {line}: no column of {name} ({name} in {units}, as in `{example}`); the header has: {found}. \
         {remedy}. The header is the first line that does not begin with #: put that before what stands \
         above it",
        name = .quantity.name(),
        units = .quantity.units()
    )]
    NoColumn {
        /// Line of the header.
        line: usize,
        /// What is needed.
        quantity: Quantity,
        /// Such a name.
        example: String,
        /// The names that the header has.
        found: String,
        /// What to do, a sentence.
        remedy: String,
    },
    /// Several columns have such a unit.
    #[error("line {line}: {found} are all columns of {quantity}: {remedy}")]
    SeveralColumns {
        /// Line of the header.
        line: usize,
        /// What is needed.
        quantity: &'static str,
        /// The names of the columns.
        found: String,
        /// What to do, a clause.
        remedy: String,
    },
    /// The unit of a column is not known.
    #[error("{option}: `{unit}` is no unit of {quantity}; known are {units}")]
    UnknownUnit {
        /// What gives it.
        option: &'static str,
        /// As it was given.
        unit: String,
        /// What is needed.
        quantity: String,
        /// The units that are known.
        units: String,
    },
    /// A column whose name has no unit.
    #[error("column {column}: its name ends with no unit of {quantity}; give it by {option} ({units})")]
    UnitNeeded {
        /// Its name.
        column: String,
        /// What is needed.
        quantity: String,
        /// What gives the unit.
        option: &'static str,
        /// The units that are known.
        units: String,
    },
    /// Fewer rows than a record needs.
    #[error("has {0} rows of numbers; a record needs at least 2")]
    TooFew(usize),
    /// A time that is not after the one before it.
    #[error(
        "line {line}: {column} = {time} does not come after {before}; times must increase from row to row \
         (sort the rows; of several with one time keep one)"
    )]
    NotAfter {
        /// Line of the later row.
        line: usize,
        /// Its column.
        column: String,
        /// The time as written.
        time: f64,
        /// The time before it.
        before: f64,
    },
}

/// Reads the record in the file at `path`.
pub fn read_measured<const N: usize>(path: &Path, asks: &[Ask; N]) -> Result<Measured<N>, MeasuredError> {
    Measured::parse(&text_of(path)?, asks)
}

fn text_of(path: &Path) -> Result<String, MeasuredError> {
    read_text(path, LARGEST_MEASURED).map_err(|error| {
        MeasuredError::Unreadable(match error {
            ReadError::Missing => {
                "is not there (no such file); give the path of a CSV with a header".to_owned()
            }
            ReadError::Unusable(problem) => problem,
        })
    })
}

/// The text of a record whose header is read, so that its columns can be chosen.
#[derive(Debug)]
pub struct MeasuredText {
    text: String,
    /// The names of its columns.
    pub names: Vec<String>,
}

/// A column by its place, and its unit where that is known.
pub type ChosenColumn = (usize, Option<Unit>);

impl MeasuredText {
    /// Reads the file at `path`.
    pub fn read(path: &Path) -> Result<Self, MeasuredError> {
        let text = text_of(path)?;
        let names = Sheet::open(&text, "t_s,x_m", Separators::Any, MOST_MEASURED)?.names;
        Ok(Self { text, names })
    }

    /// The columns that are meant, as far as the units at the ends of their names tell: force over position,
    /// or else displacement, velocity or acceleration over time. What no unit tells is the first column
    /// across, and the first other one for the values.
    pub fn guess(&self) -> [ChosenColumn; 2] {
        let of = |quantity: Quantity| {
            let unit = |name: &String| Unit::of_name(name).filter(|unit| unit.quantity == quantity);
            self.names.iter().enumerate().find_map(|(at, name)| Some((at, Some(unit(name)?))))
        };
        let position = of(Quantity::Displacement);
        if let (Some(position), Some(force)) = (position, of(Quantity::Force)) {
            return [position, force];
        }
        let across = of(Quantity::Time).unwrap_or((0, None));
        let values = position.or_else(|| of(Quantity::Velocity)).or_else(|| of(Quantity::Acceleration));
        let other = usize::from(across.0 == 0 && self.names.len() > 1);
        [across, values.unwrap_or((other, None))]
    }

    /// The values of two columns, each with its unit; messages say where a column or a unit is given.
    pub fn channels(&self, chosen: [(usize, Unit); 2]) -> Result<Measured<2>, MeasuredError> {
        let sheet = Sheet::open(&self.text, "t_s,x_m", Separators::Any, MOST_MEASURED)?;
        Measured::of(&sheet, chosen)
    }
}

impl<const N: usize> Measured<N> {
    /// Reads a record: CSV with a header, values separated by commas, or by semicolons or tabulators with
    /// decimal points or decimal commas.
    pub fn parse(text: &str, asks: &[Ask; N]) -> Result<Self, MeasuredError> {
        let wanted: Vec<String> = asks.iter().map(Ask::wanted).collect();
        let sheet = Sheet::open(text, &wanted.join(","), Separators::Any, MOST_MEASURED)?;
        let mut chosen = Vec::with_capacity(N);
        for ask in asks {
            chosen.push(ask.choose(&sheet)?);
        }
        Self::of(&sheet, std::array::from_fn(|k| chosen[k]))
    }

    /// The columns that stand there, in these units.
    fn of(sheet: &Sheet, chosen: [(usize, Unit); N]) -> Result<Self, MeasuredError> {
        let columns = sheet.numbers(chosen.map(|own| own.0))?;
        if columns.rows.len() < 2 {
            return Err(MeasuredError::TooFew(columns.rows.len()));
        }
        for (k, (at, unit)) in chosen.iter().enumerate().filter(|own| own.1.1.quantity == Quantity::Time) {
            let turn = columns.rows.windows(2).position(|pair| unit.si(pair[1][k]) <= unit.si(pair[0][k]));
            if let Some(row) = turn {
                return Err(MeasuredError::NotAfter {
                    line: columns.lines[row + 1],
                    column: clip(&sheet.names[*at]),
                    time: columns.rows[row + 1][k],
                    before: columns.rows[row][k],
                });
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

impl Ask {
    /// A name of such a column, for messages.
    fn wanted(&self) -> String {
        self.column.clone().unwrap_or_else(|| {
            let name = match self.quantities[0] {
                Quantity::Time => "t",
                Quantity::Displacement => "x",
                Quantity::Velocity => "v",
                Quantity::Acceleration => "accel",
                Quantity::Force => "force",
            };
            format!("{name}{}", self.quantities[0].ending())
        })
    }

    fn quantity_names(&self) -> String {
        self.quantities.iter().map(|own| own.name()).collect::<Vec<_>>().join(" or ")
    }

    fn known_units(&self) -> String {
        self.quantities.iter().map(|own| own.units()).collect::<Vec<_>>().join(", ")
    }

    /// The column's place and its unit.
    fn choose(&self, sheet: &Sheet) -> Result<(usize, Unit), MeasuredError> {
        let of_word = |word: &str| {
            let found = self.quantities.iter().find_map(|own| Unit::of_word(word, *own));
            found.ok_or_else(|| MeasuredError::UnknownUnit {
                option: self.options.1,
                unit: clip(word),
                quantity: self.quantity_names(),
                units: self.known_units(),
            })
        };
        let given = self.unit.as_deref().map(of_word).transpose()?;
        if let Some(name) = &self.column {
            let at = sheet.column(name)?;
            let own = Unit::of_name(name).filter(|unit| self.quantities.contains(&unit.quantity));
            let unit = given.or(own).ok_or_else(|| MeasuredError::UnitNeeded {
                column: clip(name),
                quantity: self.quantity_names(),
                option: self.options.1,
                units: self.known_units(),
            })?;
            return Ok((at, unit));
        }
        for quantity in &self.quantities {
            let of = |(at, name): (usize, &String)| {
                let unit = Unit::of_name(name).filter(|unit| unit.quantity == *quantity)?;
                Some((at, unit))
            };
            let found: Vec<(usize, Unit)> = sheet.names.iter().enumerate().filter_map(of).collect();
            match found[..] {
                [] => {}
                [(at, unit)] => return Ok((at, given.unwrap_or(unit))),
                _ => {
                    let names: Vec<&str> = found.iter().map(|(at, _)| sheet.names[*at].as_str()).collect();
                    return Err(MeasuredError::SeveralColumns {
                        line: sheet.line(0),
                        quantity: quantity.name(),
                        found: clip(&names.join(", ")),
                        remedy: match self.options.0 {
                            "" => "leave the unit to one of them".to_owned(),
                            option => format!("name one by {option}"),
                        },
                    });
                }
            }
        }
        Err(MeasuredError::NoColumn {
            line: sheet.line(0),
            quantity: self.quantities[0],
            example: self.wanted(),
            found: clip(&sheet.names.join(", ")),
            remedy: match self.options {
                ("", _) => "Put the unit at the end of the column's name".to_owned(),
                (option, unit) => format!("Name the column by {option} and its unit by {unit}"),
            },
        })
    }
}
