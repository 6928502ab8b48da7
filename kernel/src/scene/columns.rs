//! Numbers in named columns of a CSV text.
//!
//! The text is comma separated (optionally also by semicolons or tabs) and has a header row with the needed
//! columns in any order, possibly among others. Lines that begin with `#` are comments. Nothing is repaired
//! silently: an invalid value is rejected with its line. A scene from elsewhere may name any file, so no
//! message quotes one that does not look like a table.

use super::error::clip;
use super::names::find_name;

/// Largest number of rows that are read.
pub const MAX_ROWS: usize = 1_000_000;

/// Error in a CSV text.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ColumnsError {
    /// No header row.
    #[error("is empty; it needs a header row with the columns {wanted} and rows of numbers")]
    Empty {
        /// The columns that are needed.
        wanted: String,
    },
    /// A needed column is not in the header.
    #[error("{0}")]
    MissingColumn(String),
    /// A needed column occurs twice.
    #[error("line {line}: column {column} is there more than once")]
    RepeatedColumn {
        /// Line of the header.
        line: usize,
        /// Its name.
        column: String,
    },
    /// A text in quotation marks that extends beyond its line, so that it would include further rows.
    #[error(
        "line {line}: a quotation mark opens a text that does not end on this line; close it or leave it out"
    )]
    OpenQuote {
        /// Line of the row.
        line: usize,
    },
    /// A value that is not a finite number.
    #[error(
        "line {line}: {column} is `{value}`; it must be a finite number with a decimal point (a row without \
         a value is to be left out)"
    )]
    NoNumber {
        /// Line of the row.
        line: usize,
        /// Name of the column.
        column: String,
        /// The value as written, empty if the row is too short.
        value: String,
    },
    /// More rows than are read.
    #[error("has more than {0} rows, the most that are read: thin it out, or cut it to what the run needs")]
    TooMany(usize),
    /// The text is not CSV, its first row is not a header, or a row has more values than the header has
    /// names.
    #[error("{0}")]
    Unusable(String),
}

/// Columns of a table with the line numbers of their rows.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq)]
pub struct Columns<const N: usize> {
    /// The numbers of each row in the order of the requested names; all finite.
    pub rows: Vec<[f64; N]>,
    /// The line of each row in the text, from 1.
    pub lines: Vec<usize>,
    /// Whether numbers had a decimal comma.
    pub decimal_commas: bool,
}

/// Reads the columns `names` of a CSV text with at most `max_rows` rows.
///
/// Accepts a byte order mark, line ends of any system, blank lines, blanks around values and further columns;
/// if `ragged`, also rows with more values than the header has names.
#[doc(hidden)]
pub fn read_columns<const N: usize>(
    text: &str,
    names: [&str; N],
    max_rows: usize,
    ragged: bool,
) -> Result<Columns<N>, ColumnsError> {
    let wanted = names.join(",");
    let sheet = Sheet { ragged, ..Sheet::open(text, &wanted, Separators::Comma, max_rows)? };
    let mut at = [0; N];
    for (at, name) in at.iter_mut().zip(names) {
        *at = sheet.column(name)?;
    }
    sheet.numbers(at)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separators {
    Comma,
    /// A semicolon or a tab if the header has one, with decimal points or commas in the numbers; otherwise a
    /// comma. A header of numbers is rejected, as is a row with more values than the header has names.
    Any,
}

pub(super) struct Sheet {
    /// The text without comments and blank lines.
    body: String,
    /// The line of each row of the body, from 1, beginning with the header.
    lines: Vec<usize>,
    separator: u8,
    /// Whether a row may have more values than the header has names.
    ragged: bool,
    /// The names of the columns.
    pub names: Vec<String>,
    wanted: String,
}

impl Sheet {
    /// Parses the header; `wanted` are the needed columns for messages.
    pub fn open(
        text: &str,
        wanted: &str,
        allowed: Separators,
        max_rows: usize,
    ) -> Result<Self, ColumnsError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        // Comments and blank lines are removed first, so that row k is on line `lines[k]`.
        let mut numbers = Vec::new();
        let mut body = String::with_capacity(text.len());
        for (i, line) in lines(text).enumerate() {
            if !line.starts_with('#') && !line.trim().is_empty() {
                if numbers.len() > max_rows {
                    return Err(ColumnsError::TooMany(max_rows));
                }
                numbers.push(i + 1);
                body.push_str(line);
                body.push('\n');
            }
        }
        let header = body.split('\n').next().unwrap_or_default();
        let separator = match allowed {
            Separators::Any if header.contains(';') => b';',
            Separators::Any if header.contains('\t') => b'\t',
            _ => b',',
        };
        let ragged = allowed == Separators::Comma;
        let mut sheet =
            Self { body, lines: numbers, separator, ragged, names: Vec::new(), wanted: wanted.to_owned() };
        let header = sheet.reader().headers().map_err(unreadable)?.clone();
        if sheet.lines.is_empty() || header.is_empty() {
            return Err(ColumnsError::Empty { wanted: wanted.to_owned() });
        }
        sheet.check_quotes(&header, 0)?;
        sheet.names = header.iter().map(|name| name.trim().to_owned()).collect();
        let numeric = |name: &String| name.replace(',', ".").parse::<f64>().is_ok();
        if allowed == Separators::Any && sheet.names.iter().all(numeric) {
            return Err(ColumnsError::Unusable(format!(
                "line {}: a row of numbers; put a row with the columns' names above it, such as {wanted}",
                sheet.lines[0]
            )));
        }
        Ok(sheet)
    }

    // Blanks are trimmed later: the CSV reader would trim the line's end with them.
    fn reader(&self) -> csv::Reader<&[u8]> {
        let mut builder = csv::ReaderBuilder::new();
        builder.flexible(true).delimiter(self.separator).from_reader(self.body.as_bytes())
    }

    /// The line of a row, the header being row 0.
    pub fn line(&self, row: usize) -> usize {
        self.lines.get(row).copied().unwrap_or(0)
    }

    /// Fails if a text in quotation marks contains a line end, so that the row is longer than its line.
    fn check_quotes(&self, record: &csv::StringRecord, row: usize) -> Result<(), ColumnsError> {
        match record.iter().any(|value| value.contains('\n')) {
            false => Ok(()),
            true => Err(ColumnsError::OpenQuote { line: self.line(row) }),
        }
    }

    /// Whether the row below the header has as many values as the header has names, at least two of them
    /// numbers, or one of the first rows has numbers alone.
    fn is_table(&self) -> bool {
        const ROWS: usize = 20;
        let lines: Vec<&str> = self.body.split('\n').take(ROWS).collect();
        let [header, rows @ ..] = &lines[..] else { return false };
        let is_number = |value: &&str| value.trim().replace(',', ".").parse::<f64>().is_ok();
        [',', ';', '\t'].into_iter().any(|separator| {
            let counts = |row: &&str| {
                let values = || row.split(separator);
                (values().count(), values().filter(is_number).count())
            };
            let names = header.split(separator).count();
            let has_names =
                rows.first().map(counts).is_some_and(|(all, numbers)| all == names && numbers >= 2);
            has_names || rows.iter().map(counts).any(|(all, numbers)| all == numbers && numbers >= 2)
        })
    }

    /// What the header has, in words; its names only if this is a table.
    pub fn header(&self) -> String {
        match self.is_table() {
            true => format!("the header has: {}", clip(&self.names.join(", "))),
            false => "the file is no table of numbers below a header".to_owned(),
        }
    }

    /// Index of the column that a person calls `name`, in full or without its unit.
    pub fn named_column(&self, name: &str) -> Result<usize, ColumnsError> {
        let known: Vec<&str> = self.names.iter().map(String::as_str).collect();
        match find_name("column", name, &known) {
            Ok(full) => self.column(full),
            Err(problem) => {
                let known = clip(problem.trim_start_matches("no such column"));
                let known = if self.is_table() { known } else { format!("; {}", self.header()) };
                let (line, name) = (self.line(0), clip(name));
                Err(ColumnsError::MissingColumn(format!("line {line}: no column {name}{known}")))
            }
        }
    }

    /// Index of the column called `name`.
    pub fn column(&self, name: &str) -> Result<usize, ColumnsError> {
        let mut at = self.names.iter().enumerate().filter(|(_, other)| *other == name).map(|(i, _)| i);
        let first = at.next().ok_or_else(|| {
            ColumnsError::MissingColumn(format!(
                "line {}: no column {}; {} (comma separated; needed: {})",
                self.line(0),
                clip(name),
                self.header(),
                self.wanted
            ))
        })?;
        match at.next() {
            None => Ok(first),
            Some(_) => Err(ColumnsError::RepeatedColumn { line: self.line(0), column: clip(name) }),
        }
    }

    /// The numbers in the columns with these indices.
    pub fn numbers<const N: usize>(&self, at: [usize; N]) -> Result<Columns<N>, ColumnsError> {
        let mut rows = Vec::with_capacity(self.lines.len());
        let (mut points, mut commas) = (false, false);
        let mut reader = self.reader();
        let mut record = csv::StringRecord::new();
        while reader.read_record(&mut record).map_err(unreadable)? {
            let place = rows.len() + 1;
            self.check_quotes(&record, place)?;
            // empty values at the end of a row are ignored
            let names = self.names.len();
            let beyond = record.iter().skip(names).any(|value| !value.trim().is_empty());
            if !self.ragged && beyond {
                let (line, found) = (self.line(place), record.len());
                return Err(ColumnsError::Unusable(format!(
                    "line {line}: has {found} values where the header has {names} names; if commas are meant \
                     as decimal points, separate the values by semicolons"
                )));
            }
            let mut row = [0.0; N];
            for (cell, at) in row.iter_mut().zip(at) {
                let value = record.get(at).unwrap_or("").trim();
                let comma = self.separator != b',' && value.contains(',');
                (points, commas) = (points || value.contains('.'), commas || comma);
                let number = match comma {
                    false => value.parse::<f64>().ok(),
                    // with both in one file, one could be a thousands separator
                    true if points => None,
                    true => value.replacen(',', ".", 1).parse().ok(),
                };
                let mixed = commas && points;
                *cell = number.filter(|v| v.is_finite() && !mixed).ok_or_else(|| ColumnsError::NoNumber {
                    line: self.line(place),
                    column: clip(&self.names[at]),
                    value: clip(value),
                })?;
            }
            rows.push(row);
        }
        Ok(Columns { rows, lines: self.lines.get(1..).unwrap_or_default().to_vec(), decimal_commas: commas })
    }
}

fn unreadable(error: csv::Error) -> ColumnsError {
    ColumnsError::Unusable(format!("is not a CSV table: {error}"))
}

/// The lines of a text with line ends of any system: a line feed, a carriage return or both.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}
