//! Column of a sweep that a picture shows, in units that suit it.

use super::axis::PlotAxis;
use super::style::{self, Ink, Theme};
use crate::study::{Grid, RMS_VELOCITY, SummaryField, Table, Values, label_and_unit};

/// The column that is shown where none is named.
pub const RMS: &str = RMS_VELOCITY.name;

/// The words that the column called `name` can have, in the order of their colours; `None` for numbers.
pub fn words_of(name: &str) -> Option<&'static [&'static str]> {
    let words: &[&str] = match name {
        "regime" => &["rest", "intrawell", "irregular", "interwell"],
        "outcome" => &[
            "done",
            "inaccurate",
            "left_table",
            "impact_budget",
            "step_budget",
            "not_finite",
            "cancelled",
            "not_converged",
        ],
        _ => SummaryField::find(name)?.words,
    };
    Some(words).filter(|words| !words.is_empty())
}

/// A column to show.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Quantity {
    /// Its values, a row each; NaN where there is none.
    pub values: Vec<f64>,
    /// What stands at its axis.
    pub label: String,
    /// The unit at the end of the label; empty where it has none.
    pub unit: String,
    /// The words that the values are places of, where it has words.
    pub words: Option<&'static [&'static str]>,
    /// Whether these are the regimes.
    regimes: bool,
    /// Whether it is the velocity, which is 0 at rest.
    pub velocity: bool,
}

/// The columns of `table` that can be shown, which are those of the summary and of thresholds, not the swept
/// fields.
pub fn quantities<'a>(table: &'a Table, grid: &'a Grid) -> impl Iterator<Item = &'a str> {
    let shown = |name: &str, values: &Values| {
        !matches!(values, Values::Words(_) | Values::Names(_)) || words_of(name).is_some()
    };
    let columns = table.columns().iter().filter(move |column| shown(&column.name, &column.values));
    columns
        .map(|column| column.name.as_str())
        .filter(|name| !grid.columns().iter().any(|field| field == name))
}

impl Quantity {
    /// The column called `name` of `rows`; no values where there is none.
    pub fn of(rows: &Table, name: &str) -> Self {
        let column = rows.column(name);
        let values: Vec<f64> = match column.map(|column| &column.values) {
            Some(Values::Numbers(values)) => values.clone(),
            Some(Values::Counts(values)) => values.iter().map(|n| n.map_or(f64::NAN, |n| n as f64)).collect(),
            Some(Values::Names(_)) => Vec::new(),
            Some(Values::Words(words)) => {
                let known = words_of(name).unwrap_or_default();
                let place = |word: &&str| known.iter().position(|entry| entry == word);
                words.iter().map(|word| place(word).map_or(f64::NAN, |place| place as f64)).collect()
            }
            None => Vec::new(),
        };
        let greatest = values.iter().filter(|v| v.is_finite()).fold(0.0_f64, |a, b| a.max(b.abs()));
        let (words, unit) =
            column.map_or_else(|| (name.to_owned(), ""), |column| label_and_unit(&column.name));
        let words = match name {
            RMS => "RMS velocity",
            "max_abs_x_m" => "largest |x|",
            _ => words.as_str(),
        };
        // Small lengths and speeds are short numbers in thousandths.
        let (scale, unit) = match unit {
            "m" | "m/s" if greatest < 2.0 => (1e3, format!("m{unit}")),
            _ => (1.0, unit.to_owned()),
        };
        let label = if unit.is_empty() { words.to_owned() } else { format!("{words}, {unit}") };
        let values = values.into_iter().map(|value| value * scale).collect();
        Self { values, label, unit, words: words_of(name), regimes: name == "regime", velocity: name == RMS }
    }

    /// The colour of a value that is the place of a word.
    pub fn ink(&self, value: f64, theme: &Theme) -> Ink {
        let all: &[Ink] = if self.regimes { &theme.regimes } else { &style::KINDS };
        all[value as usize % all.len()]
    }

    /// Its axis: from 0, or from below where there are negative values, with `margin` of the range as room;
    /// the words where it has those.
    pub fn axis(&self, margin: f64, count: usize) -> PlotAxis {
        if let Some(words) = self.words {
            let ticks = words.iter().enumerate().map(|(i, name)| (i as f64, (*name).to_owned())).collect();
            return PlotAxis { low: -0.5, high: words.len() as f64 - 0.5, ticks, label: self.label.clone() };
        }
        PlotAxis::around(self.values.iter().copied().chain([0.0]), margin, count, &self.label)
    }
}
