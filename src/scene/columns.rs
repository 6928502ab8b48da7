//! Which numbers stand in two named columns of a CSV text?
//!
//! Comma separated, a header row with the wanted columns in any order among others, lines that begin with
//! `#` are comments. Nothing is repaired silently: what cannot be meant is refused with its line and value.

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
    #[error("has more than {0} rows; thin it out")]
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
    for (i, line) in text.lines().enumerate() {
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
    let unreadable = |e: csv::Error| ColumnsError::Unreadable(e.to_string());
    let mut reader =
        csv::ReaderBuilder::new().trim(csv::Trim::All).flexible(true).from_reader(body.as_bytes());
    let header = reader.headers().map_err(unreadable)?.clone();
    if numbers.is_empty() || header.is_empty() {
        return Err(ColumnsError::Empty { wanted: wanted() });
    }
    let column = |name: &'static str| {
        let mut at = header.iter().enumerate().filter(|(_, h)| *h == name).map(|(i, _)| i);
        let first = at.next().ok_or_else(|| ColumnsError::MissingColumn {
            line: line_of(0),
            missing: name,
            found: shortened(&header.iter().collect::<Vec<_>>().join(", ")),
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
        let number = |i: usize| {
            let value = record.get(at[i]).unwrap_or("");
            value.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| ColumnsError::NoNumber {
                line,
                column: names[i],
                value: shortened(value),
            })
        };
        columns.rows.push([number(0)?, number(1)?]);
        columns.lines.push(line);
    }
    Ok(columns)
}

/// A text for a message, not more than a line.
fn shortened(text: &str) -> String {
    const MOST: usize = 80;
    if text.chars().count() <= MOST {
        text.to_owned()
    } else {
        text.chars().take(MOST).chain("...".chars()).collect()
    }
}
