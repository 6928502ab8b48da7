//! Table of the data in a picture, one row per point, cell or mark.

use crate::study::{Column, Table, Values};

/// Rows of several kinds, distinguished by the column `series`.
pub(crate) struct Drawn {
    series: Vec<&'static str>,
    numbers: Vec<(String, Vec<f64>)>,
    words: Vec<(&'static str, Vec<&'static str>)>,
}

impl Drawn {
    /// An empty table with these columns of numbers, followed by columns of words.
    pub fn new<'a>(numbers: impl IntoIterator<Item = &'a str>, words: &[&'static str]) -> Self {
        Self {
            series: Vec::new(),
            numbers: numbers.into_iter().map(|name| (name.to_owned(), Vec::new())).collect(),
            words: words.iter().map(|name| (*name, Vec::new())).collect(),
        }
    }

    /// Adds a row; omitted numbers and words at the end are missing values.
    pub fn put(&mut self, series: &'static str, numbers: &[f64], words: &[&'static str]) {
        self.series.push(series);
        for (i, (_, column)) in self.numbers.iter_mut().enumerate() {
            column.push(numbers.get(i).copied().unwrap_or(f64::NAN));
        }
        for (i, (_, column)) in self.words.iter_mut().enumerate() {
            column.push(words.get(i).copied().unwrap_or(""));
        }
    }

    /// All rows.
    pub fn table(self) -> Table {
        let table = Table::new().with("series", Values::Words(self.series));
        let numbers = self.numbers.into_iter();
        let table = numbers.fold(table, |table, (name, values)| table.with(name, Values::Numbers(values)));
        self.words.into_iter().fold(table, |table, (name, values)| table.with(name, Values::Words(values)))
    }
}

/// One series: these columns of numbers or counts, in the rows that are `shown`.
pub(crate) fn of_rows(
    series: &'static str,
    rows: &Table,
    names: &[&str],
    shown: impl Fn(usize) -> bool,
) -> Table {
    let kept: Vec<usize> = (0..rows.rows()).filter(|row| shown(*row)).collect();
    let table = Table::new().with("series", Values::Words(vec![series; kept.len()]));
    names.iter().fold(table, |table, name| {
        let values = rows.column(name).and_then(as_numbers).unwrap_or_default();
        table.with(*name, kept.iter().map(|row| values[*row]).collect())
    })
}

/// The values of a column of numbers or counts; none of words.
pub(crate) fn as_numbers(column: &Column) -> Option<Vec<f64>> {
    match &column.values {
        Values::Numbers(values) => Some(values.clone()),
        Values::Counts(values) => Some(values.iter().map(|n| n.map_or(f64::NAN, |n| n as f64)).collect()),
        Values::Words(_) | Values::Names(_) => None,
    }
}
