//! Tables as CSV: a header line, then one line for each row, separated by commas and ended by `\n`.
//!
//! Words come from fixed lists and field paths, and names contain no comma or quote, so cells are never
//! quoted.

use std::fmt::Write;
use std::ops::Range;
use std::str::FromStr;

use crate::numeric::{one_line, push_number};
use crate::study::{Cell, Direction, SUMMARY_FIELDS, Table, Values};

/// The header row of `table`.
pub fn header(table: &Table) -> String {
    let names: Vec<&str> = table.columns().iter().map(|column| column.name.as_str()).collect();
    names.join(",") + "\n"
}

/// The header and all rows of `table`.
pub fn csv(table: &Table) -> String {
    header(table) + &rows(table, 0..table.rows())
}

/// The rows of `table` in `range`, which may go beyond the last row. Missing values are empty cells.
pub fn rows(table: &Table, range: Range<usize>) -> String {
    let mut text = String::with_capacity(range.len().min(table.rows()) * 16 * table.columns().len());
    for row in range.start..range.end.min(table.rows()) {
        for (i, column) in table.columns().iter().enumerate() {
            if i > 0 {
                text.push(',');
            }
            match &column.values {
                Values::Numbers(values) => push_number(&mut text, values[row]),
                Values::Counts(values) => {
                    if let Some(count) = values[row] {
                        let _ = write!(text, "{count}");
                    }
                }
                Values::Words(values) => text.push_str(values[row]),
                Values::Names(values) => text.push_str(&one_line(&values[row])),
            }
        }
        text.push('\n');
    }
    text
}

/// Reads the output of [`header`] and [`rows`] into a table with the columns of `empty`; the columns of the
/// text may be in any order. The error is a clause of a sentence.
pub fn csv_table(text: &str, empty: &Table) -> Result<Table, String> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let names = reader.headers().map_err(|error| error.to_string())?.clone();
    let rows: Vec<csv::StringRecord> =
        reader.records().collect::<Result<_, _>>().map_err(|error| error.to_string())?;
    let mut table = Table::new();
    for column in empty.columns() {
        let name = &column.name;
        let missing = || format!("there is no column {name}");
        let place = names.iter().position(|header| header == name).ok_or_else(missing)?;
        let cells = rows.iter().map(|row| row.get(place).unwrap_or_default());
        let wrong = |cell: &str, what| format!("`{cell}` in the column {name} is no {what}");
        let values: Result<Values, String> = match &column.values {
            Values::Numbers(_) => {
                cells.map(|cell| parsed::<f64>(cell).ok_or_else(|| wrong(cell, "number"))).collect()
            }
            Values::Counts(_) => {
                cells.map(|cell| parsed::<u64>(cell).ok_or_else(|| wrong(cell, "number"))).collect()
            }
            Values::Names(_) => Ok(cells.map(str::to_owned).collect()),
            Values::Words(_) => {
                cells.map(|cell| known_word(cell).ok_or_else(|| wrong(cell, "word of a sweep"))).collect()
            }
        };
        table = table.with(name, values?);
    }
    Ok(table)
}

/// The number in a cell, `Some(None)` if it is empty; `None` if there is another text.
fn parsed<T: FromStr>(cell: &str) -> Option<Option<T>> {
    if cell.is_empty() { Some(None) } else { cell.parse().ok().map(Some) }
}

/// The word of a sweep that is equal to `word`; an empty one is a missing value.
fn known_word(word: &str) -> Option<&'static str> {
    let of_runs = SUMMARY_FIELDS.iter().flat_map(|field| field.words).copied();
    let others = [Direction::Up.name(), Direction::Down.name(), Cell::Unsolved.outcome(), ""];
    of_runs.chain(others).find(|known| *known == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_values_are_empty_cells() {
        let table = Table::new()
            .with("x_m", Values::Numbers(vec![0.5, f64::NAN]))
            .with("period", Values::Counts(vec![None, Some(3)]))
            .with("regime", Values::Words(vec!["rest", ""]));
        assert_eq!(header(&table), "x_m,period,regime\n");
        assert_eq!(rows(&table, 0..usize::MAX), "0.5,,rest\n,3,\n");
        assert_eq!(rows(&table, 1..2), ",3,\n");
        assert_eq!(rows(&table, 5..9), "");
        let text = header(&table) + &rows(&table, 0..2);
        let read = csv_table(&text, &table).unwrap();
        assert_eq!(header(&read) + &rows(&read, 0..2), text);
        assert!(csv_table("x_m,period,regime\na,1,rest\n", &table).unwrap_err().contains("`a`"));
        assert!(csv_table("x_m,regime\n1,rest\n", &table).unwrap_err().contains("period"));
    }
}
