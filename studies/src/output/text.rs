//! Tables as text for a terminal, with aligned columns and short numbers.

use crate::numeric::one_line;
use crate::study::{Table, Values};

/// A number with about three digits; a missing one is empty.
fn brief(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (0.1..100.0).contains(&size) {
        format!("{value:.1}")
    } else if (100.0..1e6).contains(&size) {
        format!("{value:.0}")
    } else {
        format!("{value:.1e}")
    }
}

/// The table as lines of text: a heading with readable names of the columns, then one line for each row.
/// Words are aligned to the left, numbers to the right; nothing is truncated.
pub fn aligned(table: &Table) -> String {
    let mut lines = vec![String::new(); table.rows() + 1];
    for column in table.columns() {
        let (left, words): (bool, Vec<String>) = match &column.values {
            Values::Numbers(values) => (false, values.iter().map(|value| brief(*value)).collect()),
            Values::Counts(values) => {
                let text = |count: &Option<u64>| count.map_or_else(String::new, |n| n.to_string());
                (false, values.iter().map(text).collect())
            }
            Values::Words(values) => (true, values.iter().map(|word| (*word).to_owned()).collect()),
            Values::Names(values) => (true, values.iter().map(|name| one_line(name)).collect()),
        };
        let cells = [vec![column.label()], words].concat();
        let width = cells.iter().map(|cell| cell.chars().count()).max().unwrap_or(0);
        for (line, cell) in lines.iter_mut().zip(cells) {
            *line += &if left { format!("{cell:<width$}  ") } else { format!("{cell:>width$}  ") };
        }
    }
    lines.iter().map(|line| format!("{}\n", line.trim_end())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stand_in_line() {
        let table = Table::new()
            .with("case", Values::Words(vec!["a", "longer"]))
            .with("cpu_s", Values::Numbers(vec![1.5e-4, f64::NAN]))
            .with("steps", Values::Counts(vec![Some(12), None]));
        assert_eq!(aligned(&table), "case    cpu (s)  steps\na        1.5e-4     12\nlonger\n");
        assert_eq!(
            ["1.0", "16.0", "123", "0"],
            [1.0, 16.0, 123.4, 0.0].map(brief).each_ref().map(String::as_str)
        );
    }
}
