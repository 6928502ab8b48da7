//! Numbers of two named columns of a CSV text.
//!
//! Comma separated, a header row with the wanted columns in any order among others, lines that begin with
//! `#` are comments. Nothing is repaired silently: what cannot be meant is refused with its line and value.

use super::clip::clip;

/// The most rows that are read.
pub const MOST_ROWS: usize = 1_000_000;

/// What is wrong with a CSV text.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ColumnsError {
    /// No header row.
    #[error("is empty; it needs a header row with the columns {wanted} and rows of numbers")]
    Empty {
        /// The columns that are needed.
        wanted: String,
    },
    /// A needed column is not in the header.
    #[error("line {line}: no column {missing}; the header has: {found} (comma separated; needed: {wanted})")]
    MissingColumn {
        /// Line of the header.
        line: usize,
        /// Name of the column that is needed.
        missing: &'static str,
        /// The names that the header has.
        found: String,
        /// The columns that are needed.
        wanted: String,
    },
    /// A needed column is there twice.
    #[error("line {line}: column {column} is there more than once")]
    RepeatedColumn {
        /// Line of the header.
        line: usize,
        /// Its name.
        column: &'static str,
    },
    /// A row is not readable as CSV.
    #[error("is not a CSV table: {0}")]
    Unreadable(String),
    /// A text in quotation marks that goes on beyond its line, with all the rows that it would swallow.
    #[error(
        "line {line}: a quotation mark opens a text that does not end on this line; close it or leave it out"
    )]
    OpenQuote {
        /// Line of the row.
        line: usize,
    },
    /// A value that is no finite number.
    #[error("line {line}: {column} is `{value}`; it must be a finite number with a decimal point")]
    NoNumber {
        /// Line of the row.
        line: usize,
        /// Name of the column.
        column: &'static str,
        /// The value as written, empty where the row is too short.
        value: String,
    },
    /// More rows than are sensible.
    #[error("has more than {0} rows, the most that are read: thin it out, or cut it to what the run needs")]
    TooMany(usize),
}

/// Two columns of a table, and where their rows stand.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// The numbers of each row in the order of the names asked for; all finite.
    pub rows: Vec<[f64; 2]>,
    /// The line of each row in the text, from 1.
    pub lines: Vec<usize>,
}

/// Reads the columns `names` of a CSV text with at most `most` rows.
///
/// Accepts a byte order mark, line ends of any system, blank lines, blanks around values and further columns.
pub fn read_columns(text: &str, names: [&'static str; 2], most: usize) -> Result<Columns, ColumnsError> {
    let wanted = || names.join(",");
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    // Comments and blank lines go first, so that row k is known to stand on line `numbers[k]`.
    let mut numbers = Vec::new();
    let mut body = String::with_capacity(text.len());
    for (i, line) in lines(text).enumerate() {
        if !line.starts_with('#') && !line.trim().is_empty() {
            if numbers.len() > most {
                return Err(ColumnsError::TooMany(most));
            }
            numbers.push(i + 1);
            body.push_str(line);
            body.push('\n');
        }
    }
    let line_of = |record: usize| numbers.get(record).copied().unwrap_or(0);
    // One line, one row: as long as no text in quotation marks holds a line's end.
    let closed = |record: &csv::StringRecord, line: usize| match record.iter().any(|v| v.contains('\n')) {
        false => Ok(()),
        true => Err(ColumnsError::OpenQuote { line }),
    };
    let unreadable = |e: csv::Error| ColumnsError::Unreadable(e.to_string());
    // Blanks are taken off below: here they would take the line's end with them.
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(body.as_bytes());
    let header = reader.headers().map_err(unreadable)?.clone();
    if numbers.is_empty() || header.is_empty() {
        return Err(ColumnsError::Empty { wanted: wanted() });
    }
    closed(&header, line_of(0))?;
    let column = |name: &'static str| {
        let mut at = header.iter().enumerate().filter(|(_, h)| h.trim() == name).map(|(i, _)| i);
        let first = at.next().ok_or_else(|| ColumnsError::MissingColumn {
            line: line_of(0),
            missing: name,
            found: clip(&header.iter().map(str::trim).collect::<Vec<_>>().join(", ")),
            wanted: wanted(),
        })?;
        match at.next() {
            None => Ok(first),
            Some(_) => Err(ColumnsError::RepeatedColumn { line: line_of(0), column: name }),
        }
    };
    let at = [column(names[0])?, column(names[1])?];
    let mut columns = Columns { rows: Vec::with_capacity(numbers.len()), lines: Vec::new() };
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(unreadable)? {
        let line = line_of(columns.rows.len() + 1);
        closed(&record, line)?;
        let number = |i: usize| {
            let value = record.get(at[i]).unwrap_or("").trim();
            value.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| ColumnsError::NoNumber {
                line,
                column: names[i],
                value: clip(value),
            })
        };
        columns.rows.push([number(0)?, number(1)?]);
        columns.lines.push(line);
    }
    Ok(columns)
}

/// The lines of a text, whichever system ended them: by a line feed, a carriage return or both.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'))
}
