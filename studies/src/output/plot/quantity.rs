//! Column of a sweep that a picture shows, in units that suit it.

use super::axis::PlotAxis;
use super::mark::REGIMES;
use super::role::Role;
use super::swept::missing_words;
use crate::study::{Grid, RMS_VELOCITY, SummaryField, Table, Values, label_and_unit};

/// The column that is shown where none is named.
pub const RMS: &str = RMS_VELOCITY.name;

/// The words that the column called `name` can have, in the order of their colours; `None` for numbers.
pub fn words_of(name: &str) -> Option<&'static [&'static str]> {
    let words: &[&str] = match name {
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

/// Counts with more values than this are numbers on a scale.
const MOST_COUNTS: usize = 8;

/// A column to show.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Quantity {
    /// Its values, a row each; NaN where there is none. Of kinds, their places.
    pub values: Vec<f64>,
    /// What stands at its axis.
    pub label: String,
    /// The unit at the end of the label; empty where it has none.
    pub unit: String,
    /// The kinds that the values are places of, with their words, where it has kinds.
    pub kinds: Option<Vec<(Role, String)>>,
    /// Whether a motion at rest is shown as such.
    pub rests: bool,
    /// Whether it is the velocity.
    velocity: bool,
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
        let words = words_of(name);
        let mut values: Vec<f64> = match column.map(|column| &column.values) {
            Some(Values::Numbers(values)) => values.clone(),
            Some(Values::Counts(values)) => values.iter().map(|n| n.map_or(f64::NAN, |n| n as f64)).collect(),
            Some(Values::Words(shown)) => {
                let place = |word: &&str| words.unwrap_or_default().iter().position(|entry| entry == word);
                shown.iter().map(|word| place(word).map_or(f64::NAN, |place| place as f64)).collect()
            }
            Some(Values::Names(_)) | None => Vec::new(),
        };
        let role = |place: usize, word: &str| match REGIMES.iter().position(|regime| regime.0 == word) {
            Some(regime) if name == "regime" => Role::Regime(regime),
            _ => Role::Kind(place),
        };
        let mut kinds: Option<Vec<(Role, String)>> = words.map(|words| {
            words.iter().enumerate().map(|(i, word)| (role(i, word), (*word).to_owned())).collect()
        });
        if name == PERIOD {
            kinds = Some(counted(&mut values));
        }
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
        let label = if unit.is_empty() { words.to_owned() } else { format!("{words} ({unit})") };
        let values = values.into_iter().map(|value| value * scale).collect();
        let velocity = name == RMS;
        Self { values, label, unit, kinds, rests: velocity || name == PERIOD, velocity }
    }

    /// What a legend says of cells without a value.
    pub fn missing(&self, rows: &Table) -> &'static str {
        if self.velocity { missing_words(rows.words("outcome")) } else { "no value" }
    }

    /// Its axis: from 0, or from below where there are negative values, with `margin` of the range as room;
    /// the words where it has those.
    pub fn axis(&self, margin: f64) -> PlotAxis {
        if let Some(kinds) = &self.kinds {
            let ticks = kinds.iter().enumerate().map(|(i, kind)| (i as f64, kind.1.clone())).collect();
            return PlotAxis::given(-0.5, kinds.len() as f64 - 0.5, ticks, &self.label);
        }
        PlotAxis::around(self.values.iter().copied().chain([0.0]), margin, &self.label)
    }
}

/// The period of a motion in forcing periods.
const PERIOD: &str = "period";

/// Whole numbers as kinds: each value becomes its place among them; the greatest ones are one kind.
fn counted(values: &mut [f64]) -> Vec<(Role, String)> {
    let mut all: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    let rest = all.len() > MOST_COUNTS;
    all.truncate(MOST_COUNTS);
    for value in values.iter_mut().filter(|value| value.is_finite()) {
        *value = all.partition_point(|known| known <= value).saturating_sub(1) as f64;
    }
    let name = |(i, value): (usize, &f64)| {
        let least = if rest && i + 1 == MOST_COUNTS { "\u{2265} " } else { "" };
        (Role::Kind(i), format!("period {least}{value}"))
    };
    all.iter().enumerate().map(name).collect()
}
