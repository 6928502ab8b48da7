//! Column of a sweep that a picture shows, in suitable units.

use super::axis::PlotAxis;
use super::cells::Shade;
use super::drawn::as_numbers;
use super::mark::{REGIMES, regime_words};
use super::role::Role;
use crate::numeric::extent;
use crate::study::{Grid, RMS_VELOCITY, Read, SummaryField, Table, Values, label_and_unit, with_unit};
use crate::sweep::distinct;

/// The column that is shown by default.
pub const RMS: &str = RMS_VELOCITY.name;

/// The words that the column called `name` can have, in the order of their colours; `None` for numbers.
#[doc(hidden)]
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

/// Number of distinct counts above which they are shown on a scale.
const MAX_COUNTS: usize = 8;

/// A column to show.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Quantity {
    /// Its values, one per row, NaN for missing ones; for kinds, their indices.
    pub values: Vec<f64>,
    pub label: String,
    /// The unit at the end of the label; empty where it has none.
    pub unit: String,
    /// The kinds of which the values are indices, with their words, if it has kinds.
    pub kinds: Option<Vec<(Role, String)>>,
    /// The cell of each row: a value, none, or rest.
    pub cells: Vec<Shade>,
    /// The band about its values, if it has one: least and largest values.
    pub band: Option<[Vec<f64>; 2]>,
    name: String,
}

/// The columns of `table` that can be shown, which are those of the summary and of thresholds, not the swept
/// fields.
pub fn quantities<'a>(table: &'a Table, grid: &'a Grid) -> impl Iterator<Item = &'a str> {
    let shown = |name: &str, values: &Values| {
        !matches!(values, Values::Words(_) | Values::Names(_)) || words_of(name).is_some()
    };
    let columns = table.columns().iter().filter(move |column| shown(&column.name, &column.values));
    let names = columns.map(|column| column.name.as_str());
    names.filter(|name| !grid.columns().iter().any(|field| field == name))
}

impl Quantity {
    /// The column called `name` of `rows`; no values where there is none.
    pub fn of(rows: &Table, name: &str) -> Self {
        let column = rows.column(name);
        let words = words_of(name);
        let mut values: Vec<f64> = match column.map(|column| &column.values) {
            Some(Values::Words(shown)) => {
                let place = |word: &&str| words.unwrap_or_default().iter().position(|entry| entry == word);
                shown.iter().map(|word| place(word).map_or(f64::NAN, |place| place as f64)).collect()
            }
            _ => column.and_then(as_numbers).unwrap_or_default(),
        };
        let role = |place: usize, word: &str| match REGIMES.iter().position(|regime| regime.0 == word) {
            Some(regime) if name == "regime" => Role::Regime(regime),
            _ => Role::Kind(place),
        };
        let shown = |word: &str| match word {
            "true" => name.to_owned(),
            "false" => format!("not {name}"),
            word => regime_words(word).to_owned(),
        };
        let kinds: Option<Vec<(Role, String)>> = match words {
            Some(words) => {
                let there = placed(&mut values, usize::MAX).into_iter().map(|place| place as usize);
                Some(there.map(|i| (role(i, words[i]), shown(words[i]))).collect())
            }
            None => (name == PERIOD).then(|| counted(&mut values)),
        };
        let end_of = |ending: &str, words| Some((SummaryField::find(name.strip_suffix(ending)?)?, words));
        let end = end_of("_low", ", lower end of the band").or(end_of("_high", ", upper end of the band"));
        let (words, unit) = label_and_unit(end.map_or(name, |(field, _)| field.name));
        let (field, end) = end.map_or((SummaryField::find(name), ""), |(field, words)| (Some(field), words));
        let words = field.map_or(words, |field| format!("{}{end}", field.label));
        let (scale, unit) = suited_unit(unit, values.iter().copied());
        let label = with_unit(words, unit);
        let scaled = |values: &[f64]| values.iter().map(|value| value * scale).collect();
        let end = |end: &str| rows.numbers(&format!("{name}{end}")).map(scaled);
        let band = end("_low").zip(end("_high")).map(|(low, high)| [low, high]);
        let band = band.filter(|_| kinds.is_none());
        let values: Vec<f64> = scaled(&values);
        // an outcome describes how the run ended and not its motion
        let rests = |value: f64| match kinds {
            Some(_) => name != "outcome",
            None => name == RMS || value == 0.0,
        };
        let (regimes, outcomes) = (rows.words("regime"), rows.words("outcome"));
        let cell = |(row, value): (usize, &f64)| match (regimes.get(row), outcomes.get(row)) {
            (_, Some(&"")) => Shade::Blank,
            (Some(&"rest"), _) if rests(*value) => Shade::Rest,
            _ if !value.is_finite() => Shade::Missing,
            _ => Shade::Value(*value),
        };
        let cells = values.iter().enumerate().map(cell).collect();
        Self { values, label, unit: unit.to_owned(), kinds, cells, band, name: name.to_owned() }
    }

    /// The legend entry for cells without a value: the reasons that occur.
    pub fn missing(&self, rows: &Table) -> String {
        let mut reasons: Vec<&str> = Vec::new();
        let outcomes = rows.words("outcome").iter().zip(&self.cells);
        for (outcome, _) in outcomes.filter(|row| *row.1 == Shade::Missing) {
            let reason = match *outcome {
                "done" => without_value(&self.name),
                "not_converged" => "flexures not solved",
                _ => "ended early",
            };
            if !reasons.contains(&reason) {
                reasons.push(reason);
            }
        }
        if reasons.is_empty() { "no value".to_owned() } else { reasons.join(", or ") }
    }

    /// The axis of its colours: that of [`axis`](Self::axis), or of counts one with room for small ones.
    pub fn bar(&self) -> PlotAxis {
        let field = SummaryField::find(&self.name).filter(|field| matches!(field.read, Read::Count(_)));
        match field.filter(|_| self.kinds.is_none()) {
            Some(_) => PlotAxis::counts(extent(self.values.iter().copied()).1, &self.label),
            None => self.axis(0.0),
        }
    }

    /// Its axis: from 0, or from below where there are negative values, with `margin` of the range as room;
    /// the words where it has those.
    pub fn axis(&self, margin: f64) -> PlotAxis {
        if let Some(kinds) = self.kinds.as_ref().filter(|kinds| !kinds.is_empty()) {
            let ticks = kinds.iter().enumerate().map(|(i, kind)| (i as f64, kind.1.clone())).collect();
            return PlotAxis::given(-0.5, kinds.len() as f64 - 0.5, ticks, &self.label);
        }
        PlotAxis::from_zero(self.values.iter().copied(), margin, &self.label)
    }

    /// Its axis with room for its band.
    pub fn axis_of_band(&self, margin: f64) -> PlotAxis {
        let Some([low, high]) = &self.band else { return self.axis(margin) };
        let all = self.values.iter().chain(low).chain(high).copied();
        PlotAxis::from_zero(all, margin, &self.label)
    }
}

/// Why a run that lasted to its end has no value in a column.
fn without_value(name: &str) -> &'static str {
    match name {
        PERIOD | "settles_at_s" => "does not repeat",
        "first_release_s" | "first_release_g" => "no release, or the shaking does not change",
        "first_crossing_s" | "first_crossing_g" => "no crossing, or the shaking does not change",
        "impact_speed_max_m_per_s" => "no impact",
        "peak_contact_force_n" | "peak_contact_pressure_pa" => "no compliant stop is touched",
        "ended_at_s" => "lasted to its end",
        _ => "no value",
    }
}

/// Powers in W that are given in mW, wherever they stand.
const MILLIWATTS: std::ops::Range<f64> = 1e-5..1.0;

/// The factor from the SI unit `unit` to a unit in which these values are short numbers, and its name.
/// Lengths and speeds below 2 are shown in thousandths.
#[doc(hidden)]
pub fn suited_unit(unit: &'static str, values: impl Iterator<Item = f64>) -> (f64, &'static str) {
    let finite = values.filter(|value| value.is_finite());
    let greatest = finite.fold(0.0_f64, |greatest, value| greatest.max(value.abs()));
    let prefixed = |units: [(f64, &'static str); 5]| {
        // nothing is shown in thousandths
        let size = if greatest > 0.0 { greatest } else { 1e-3 };
        let fits = units.into_iter().find(|(factor, _)| size * factor >= 1.0);
        fits.unwrap_or(units[4])
    };
    match unit {
        "m" if greatest < 2.0 => (1e3, "mm"),
        "m/s" if greatest < 2.0 => (1e3, "mm/s"),
        "J" => prefixed([(1.0, "J"), (1e3, "mJ"), (1e6, "\u{b5}J"), (1e9, "nJ"), (1e12, "pJ")]),
        "W" if MILLIWATTS.contains(&greatest) => (1e3, "mW"),
        "W" => prefixed([(1.0, "W"), (1e3, "mW"), (1e6, "\u{b5}W"), (1e9, "nW"), (1e12, "pW")]),
        "Pa" if greatest >= 1e6 => (1e-6, "MPa"),
        "Pa" if greatest >= 1e3 => (1e-3, "kPa"),
        unit => (1.0, unit),
    }
}

/// The period of a motion in forcing periods.
const PERIOD: &str = "period";

/// Whole numbers as kinds: each value becomes its place among them; the greatest ones are one kind.
fn counted(values: &mut [f64]) -> Vec<(Role, String)> {
    let greatest = extent(values.iter().copied()).1;
    let all = placed(values, MAX_COUNTS);
    let name = |(i, value): (usize, &f64)| {
        let least = if i + 1 == MAX_COUNTS && *value < greatest { "\u{2265} " } else { "" };
        (Role::Kind(i), format!("period {least}{value}"))
    };
    all.iter().enumerate().map(name).collect()
}

/// Replaces each value by its index among the values that occur, and returns these, at most `count`: the last
/// one stands for all above it.
fn placed(values: &mut [f64], count: usize) -> Vec<f64> {
    let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let mut all = distinct(&finite);
    all.truncate(count);
    for value in values.iter_mut().filter(|value| value.is_finite()) {
        *value = all.partition_point(|known| known <= value).saturating_sub(1) as f64;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_suits_its_values() {
        let of = |unit, value: f64| suited_unit(unit, [value, f64::NAN, -0.5 * value].into_iter());
        assert_eq!([of("m", 0.02), of("m", 3.0), of("m/s", 0.4)], [(1e3, "mm"), (1.0, "m"), (1e3, "mm/s")]);
        assert_eq!([of("J", -2.0), of("J", 0.0), of("W", 3e-7)], [(1.0, "J"), (1e3, "mJ"), (1e9, "nW")]);
        assert_eq!([of("W", 1e-15), of("Pa", 2e8), of("", 7.0)], [(1e12, "pW"), (1e-6, "MPa"), (1.0, "")]);
    }

    #[test]
    fn a_category_shows_rest_whatever_its_word() {
        let rows = [("rest", "left", "true"), ("rest", "right", "false"), ("interwell", "both", "false")];
        let table = Table::new().each("regime", &rows, |row| row.0).each("side", &rows, |row| row.1);
        let table = table.each("settled", &rows, |row| row.2).each("outcome", &rows, |_| "done");
        let table = table.each("period", &rows, |row| if row.0 == "rest" { f64::NAN } else { 1.0 });
        let table = table.each("impacts", &rows, |row| if row.1 == "right" { 1.0 } else { 0.0 });
        let cells = |name: &str| Quantity::of(&table, name).cells;
        for name in ["regime", "side", "settled", "period"] {
            assert!(matches!(cells(name)[..], [Shade::Rest, Shade::Rest, Shade::Value(_)]), "{name}");
        }
        assert_eq!(cells("outcome"), [Shade::Value(0.0); 3]);
        assert_eq!(cells("impacts"), [Shade::Rest, Shade::Value(1.0), Shade::Value(0.0)]);
        let words: Vec<String> =
            Quantity::of(&table, "settled").kinds.unwrap().into_iter().map(|kind| kind.1).collect();
        assert_eq!(words, ["settled", "not settled"]);
    }

    #[test]
    fn a_legend_says_why_a_cell_has_no_value() {
        let missing = |name: &str, rows: &[(f64, &'static str)]| {
            let table = Table::new().each(name, rows, |row| row.0).each("outcome", rows, |row| row.1);
            Quantity::of(&table, name).missing(&table)
        };
        let nan = f64::NAN;
        assert_eq!(missing(RMS, &[(1.0, "done"), (nan, "left_table")]), "ended early");
        assert_eq!(missing(RMS, &[(nan, "not_converged"), (1.0, "step_budget")]), "flexures not solved");
        let both = [(nan, "not_converged"), (nan, "step_budget"), (nan, ""), (nan, "not_finite")];
        assert_eq!(missing(RMS, &both), "flexures not solved, or ended early");
        assert_eq!(missing("impact_speed_max_m_per_s", &[(nan, "done")]), "no impact");
    }
}
