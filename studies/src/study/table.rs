//! Table: named columns of one length, each with a unit and one type of value.
//!
//! Every study returns this type, and every writer and plot reads it.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Deserializer, Serialize};

use crate::scene::unit_ending;

/// Values of one column, all of one type.
///
/// The type of a column is the same in every table of a question, whatever its values are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Values {
    /// Real numbers. NaN is a missing value. Infinity is one, such as the load of an open circuit; minus
    /// infinity is an exponent where nothing is left of a perturbation.
    Numbers(Vec<f64>),
    /// Whole numbers; `None` is a missing value.
    Counts(Vec<Option<u64>>),
    /// Words from a fixed list; an empty one is a missing value.
    #[serde(deserialize_with = "words")]
    Words(Vec<&'static str>),
    /// Names given by a user, without commas, quotes or line breaks; an empty one is a missing value.
    Names(Vec<String>),
}

/// Words that another run of the program has written. Each is kept for the rest of this run, once.
fn words<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<&'static str>, D::Error> {
    static KNOWN: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let mut word = |text: String| match known.get(text.as_str()) {
        Some(word) => *word,
        None => {
            let word: &'static str = text.leak();
            known.insert(word);
            word
        }
    };
    Ok(Vec::<String>::deserialize(from)?.into_iter().map(&mut word).collect())
}

impl Values {
    /// Number of rows.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Counts(values) => values.len(),
            Self::Words(values) => values.len(),
            Self::Names(values) => values.len(),
        }
    }

    /// Whether the value of a row is missing; true beyond the last row.
    pub fn is_missing(&self, row: usize) -> bool {
        match self {
            Self::Numbers(values) => values.get(row).is_none_or(|value| value.is_nan()),
            Self::Counts(values) => values.get(row).is_none_or(Option::is_none),
            Self::Words(values) => values.get(row).is_none_or(|word| word.is_empty()),
            Self::Names(values) => values.get(row).is_none_or(String::is_empty),
        }
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Types of values from which a column can be collected; `None` is a missing value.
macro_rules! collected {
    ($($value:ty: $variant:ident, $row:pat => $cell:expr;)*) => {$(
        impl FromIterator<$value> for Values {
            fn from_iter<I: IntoIterator<Item = $value>>(values: I) -> Self {
                Self::$variant(values.into_iter().map(|$row| $cell).collect())
            }
        }
    )*};
}

collected! {
    f64: Numbers, number => number;
    Option<f64>: Numbers, number => number.unwrap_or(f64::NAN);
    Option<u64>: Counts, count => count;
    &'static str: Words, word => word;
    Option<bool>: Words, flag => flag.map_or("", |flag| if flag { "true" } else { "false" });
    String: Names, name => name;
}

/// One column: its name and its values.
///
/// [`unit`](Self::unit) and [`label`](Self::label) take the name apart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Name with the unit in it, as in the header of a CSV file: `rms_velocity_m_per_s`.
    pub name: String,
    /// Its values.
    pub values: Values,
}

/// The name of a column or field as plain text, and its unit: `travel limit` and `mm`. The unit is taken from
/// the end of the name; it is empty for a pure number, a count or a word.
pub fn label_and_unit(name: &str) -> (String, &'static str) {
    let (ending, unit) = unit_ending(name).unwrap_or_default();
    let words = name.strip_suffix(ending).unwrap_or(name).replace(['_', '.'], " ");
    // the only name that is a single letter
    let words = if words == "xi" { "damping ratio".to_owned() } else { words };
    (words, unit)
}

impl Column {
    /// The unit as plain text, from the end of the name, such as `mm`; empty where there is none.
    pub fn unit(&self) -> &'static str {
        label_and_unit(&self.name).1
    }

    /// The name as plain text with the unit: `travel limit (mm)`.
    pub fn label(&self) -> String {
        let (words, unit) = label_and_unit(&self.name);
        with_unit(words, unit)
    }
}

/// The words of a label with their unit, if there is one.
pub fn with_unit(words: String, unit: &str) -> String {
    if unit.is_empty() { words } else { format!("{words} ({unit})") }
}

/// Columns of one length: the answer of every study.
///
/// A column is found by its name, which ends with its unit: [`numbers`](Self::numbers) and
/// [`words`](Self::words) give the values of these types, [`column`](Self::column) those of any type. Missing
/// values are described at [`Values`].
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Table, Values};
///
/// let positions = Values::Numbers(vec![0.5e-3, 1.0e-3]);
/// let table = Table::new().with("x_m", positions);
/// assert_eq!(table.rows(), 2);
/// assert_eq!(table.numbers("x_m"), Some(&[0.5e-3, 1.0e-3][..]));
/// assert_eq!(table.column("x_m").unwrap().unit(), "m");
/// assert!(table.words("x_m").is_empty());
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Table {
    columns: Vec<Column>,
}

impl Table {
    /// A table without columns.
    pub fn new() -> Self {
        Self::default()
    }

    /// The table with one more column on its right.
    ///
    /// Precondition: as many values as the present columns have.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, values: Values) -> Self {
        debug_assert!(self.columns.is_empty() || self.rows() == values.len());
        self.columns.push(Column { name: name.into(), values });
        self
    }

    /// The table with one more column on its right: the value of `of` for each row.
    #[must_use]
    pub fn each<R, V>(self, name: &str, rows: &[R], of: impl Fn(&R) -> V) -> Self
    where
        Values: FromIterator<V>,
    {
        self.each_by(name, rows, &of)
    }

    /// The same, compiled once for each type of values, not for each column.
    fn each_by<R, V>(self, name: &str, rows: &[R], of: &dyn Fn(&R) -> V) -> Self
    where
        Values: FromIterator<V>,
    {
        self.with(name, rows.iter().map(of).collect())
    }

    /// The columns from left to right.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The columns from left to right, by value.
    pub fn into_columns(self) -> Vec<Column> {
        self.columns
    }

    /// The column called `name`.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The values of the column of real numbers called `name`.
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        if let Values::Numbers(values) = &self.column(name)?.values { Some(values) } else { None }
    }

    /// The words of the column called `name`; empty if it has other values or is not there.
    pub fn words(&self, name: &str) -> &[&'static str] {
        match self.column(name).map(|column| &column.values) {
            Some(Values::Words(words)) => words,
            _ => &[],
        }
    }

    /// The table with only these of its columns, in this order.
    #[must_use]
    pub fn only(&self, names: &[String]) -> Self {
        Self { columns: names.iter().filter_map(|name| self.column(name)).cloned().collect() }
    }

    /// The table without the column called `name`.
    #[must_use]
    pub fn without(&self, name: &str) -> Self {
        Self { columns: self.columns.iter().filter(|column| column.name != name).cloned().collect() }
    }

    /// Adds the rows of `more`, which has all columns and may have others, below.
    pub fn append(&mut self, more: &Self) {
        if self.columns.is_empty() {
            self.columns.clone_from(&more.columns);
            return;
        }
        for column in &mut self.columns {
            match (&mut column.values, more.column(&column.name).map(|more| &more.values)) {
                (Values::Numbers(values), Some(Values::Numbers(more))) => values.extend_from_slice(more),
                (Values::Counts(values), Some(Values::Counts(more))) => values.extend_from_slice(more),
                (Values::Words(values), Some(Values::Words(more))) => values.extend_from_slice(more),
                (Values::Names(values), Some(Values::Names(more))) => values.extend_from_slice(more),
                _ => debug_assert!(false, "tables of one study have the same columns"),
            }
        }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }
}
