//! Which points does a CSV file of a force curve hold?
//!
//! Comma separated, a header row with the columns `x_m` and `force_n` in any order among others, lines
//! that begin with `#` are comments. Nothing is repaired silently: what cannot be meant is refused with
//! its line and value; a table from right to left is read as the same curve from left to right.

/// The fewest points a table may have: below, a corner and a bend look the same.
pub const FEWEST_POINTS: usize = 4;

/// The most points a table may have; fitting takes some seconds there.
pub const MOST_POINTS: usize = 100_000;

const X: &str = "x_m";
const FORCE: &str = "force_n";

/// The points of a force curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Positions in m, strictly increasing.
    pub x: Vec<f64>,
    /// Forces dV/dx in N, one for each position.
    pub force: Vec<f64>,
}

/// What is wrong with the text of a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableError {
    /// No header row.
    #[error("is empty; it needs a header row with the columns {X},{FORCE} and rows of numbers")]
    Empty,
    /// A needed column is not in the header.
    #[error(
        "line {line}: no column {missing}; the header has: {found} (comma separated, {X} in m and {FORCE} in N)"
    )]
    MissingColumn {
        /// Line of the header.
        line: usize,
        /// Name of the column that is needed.
        missing: &'static str,
        /// The names that the header has.
        found: String,
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
    /// Fewer points than a curve needs.
    #[error("has {0} rows of numbers; a force curve needs at least {FEWEST_POINTS}")]
    TooFew(usize),
    /// More points than are sensible.
    #[error("has more than {MOST_POINTS} rows; thin it out")]
    TooMany,
    /// A position that is there twice.
    #[error("line {line}: {X} = {x:e} is there twice; each position needs one force")]
    Repeated {
        /// Line of the second of the two.
        line: usize,
        /// The position.
        x: f64,
    },
    /// Positions that go up and down.
    #[error(
        "line {line}: {X} = {x:e} turns back after {before:e}; positions must run in one direction (sort the rows; of a hysteresis loop keep one branch)"
    )]
    TurnsBack {
        /// Line of the first row against the direction.
        line: usize,
        /// Its position.
        x: f64,
        /// The position before it.
        before: f64,
    },
}

impl Table {
    /// Reads the text of a CSV table.
    ///
    /// Accepts a byte order mark, line ends of any system, blank lines, blanks around values, further
    /// columns, and rows from right to left (reversed here). Guarantee: at least [`FEWEST_POINTS`] finite
    /// points with strictly increasing `x`.
    pub fn parse(text: &str) -> Result<Self, TableError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        // Comments and blank lines go first, so that row k is known to stand on line `numbers[k]`.
        let mut numbers = Vec::new();
        let mut body = String::with_capacity(text.len());
        for (i, line) in text.lines().enumerate() {
            if !line.starts_with('#') && !line.trim().is_empty() {
                if numbers.len() > MOST_POINTS {
                    return Err(TableError::TooMany);
                }
                numbers.push(i + 1);
                body.push_str(line);
                body.push('\n');
            }
        }
        let line_of = |record: usize| numbers.get(record).copied().unwrap_or(0);
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).flexible(true).from_reader(body.as_bytes());
        let header = reader.headers().map_err(|e| TableError::Unreadable(e.to_string()))?.clone();
        if numbers.is_empty() || header.is_empty() {
            return Err(TableError::Empty);
        }
        let column = |name: &'static str| {
            let mut at = header.iter().enumerate().filter(|(_, h)| *h == name).map(|(i, _)| i);
            let first = at.next().ok_or_else(|| TableError::MissingColumn {
                line: line_of(0),
                missing: name,
                found: listed(&header),
            })?;
            match at.next() {
                None => Ok(first),
                Some(_) => Err(TableError::RepeatedColumn { line: line_of(0), column: name }),
            }
        };
        let (x_at, force_at) = (column(X)?, column(FORCE)?);
        let (mut x, mut force) = (Vec::with_capacity(numbers.len()), Vec::with_capacity(numbers.len()));
        let mut record = csv::StringRecord::new();
        while reader.read_record(&mut record).map_err(|e| TableError::Unreadable(e.to_string()))? {
            let line = line_of(x.len() + 1);
            let number = |at: usize, column: &'static str| {
                let value = record.get(at).unwrap_or("");
                value.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| TableError::NoNumber {
                    line,
                    column,
                    value: shortened(value),
                })
            };
            x.push(number(x_at, X)?);
            force.push(number(force_at, FORCE)?);
        }
        if x.len() < FEWEST_POINTS {
            return Err(TableError::TooFew(x.len()));
        }
        let falling = x[1] < x[0];
        for (i, pair) in x.windows(2).enumerate() {
            let (before, x, line) = (pair[0], pair[1], line_of(i + 2));
            if before == x {
                return Err(TableError::Repeated { line, x });
            }
            if (x < before) != falling {
                return Err(TableError::TurnsBack { line, x, before });
            }
        }
        if falling {
            x.reverse();
            force.reverse();
        }
        Ok(Self { x, force })
    }

    /// Remarks about values that are possible but unlikely, each a sentence.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let (first, last) = (self.x[0], self.x[self.x.len() - 1]);
        if last - first > 1.0 {
            warnings.push(format!(
                "{X} runs from {first} m to {last} m: if these are millimetres, divide the column by 1000"
            ));
        }
        warnings
    }
}

/// The names of a header for a message, not more than a line.
fn listed(header: &csv::StringRecord) -> String {
    shortened(&header.iter().collect::<Vec<_>>().join(", "))
}

fn shortened(text: &str) -> String {
    const MOST: usize = 80;
    if text.chars().count() <= MOST {
        text.to_owned()
    } else {
        text.chars().take(MOST).chain("...".chars()).collect()
    }
}
