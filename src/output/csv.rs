//! CSV: a header row, then a line for each row of a table, comma separated, `\n` ended.
//!
//! Words come from fixed lists and field paths, and names are given without them: nothing holds a comma or a
//! quote, so nothing is ever quoted.

use std::fmt::Write;
use std::ops::Range;

use super::number::push_number;
use crate::study::{Table, Values};

/// The header row of `table`.
pub fn header(table: &Table) -> String {
    let names: Vec<&str> = table.columns().iter().map(|column| column.name.as_str()).collect();
    names.join(",") + "\n"
}

/// The rows of `table` in `range`, which is cut to those there are; missing values are empty cells.
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
                Values::Names(values) => text.push_str(&values[row]),
            }
        }
        text.push('\n');
    }
    text
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
    }
}
