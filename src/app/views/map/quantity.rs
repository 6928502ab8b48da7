//! Colour scale of a column of the map.

use crate::app::session::map::Map;
use crate::app::words::columns::{ShownColumn, said};
use crate::app::words::kind::Kind;
use crate::app::words::numbers::three;
use crate::dynamics::{Regime, Summary};
use crate::output::PlotAxis;
use crate::study::{Cell, SummaryField};

/// Largest number of forcing periods after which a motion is found to repeat.
const PERIODS: usize = 12;

/// What one cell shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Look {
    /// Not run yet.
    Unknown,
    /// The run ended early, or there was no mechanism.
    Missing,
    /// At rest, which is shown differently from little motion.
    Rest,
    /// The run has no such value: no period of a motion that does not repeat, no release.
    None,
    Kind(Kind),
    /// A word, by its index among those of the column.
    Word(u8),
    /// A share of the scale, 0 to 1.
    Share(f32),
}

/// Spacing of numbers on a scale.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Steps {
    /// Equal differences are equal steps.
    Even,
    /// For counts: equal ratios are nearly equal steps.
    Ratios,
    /// Each whole number has one step.
    Whole,
}

/// The colours of one map of one quantity.
#[derive(Debug, Clone)]
pub struct ColourScale {
    info: &'static SummaryField,
    factor: f64,
    unit: &'static str,
    /// The bar beside the map. `None` for words.
    pub bar: Option<PlotAxis>,
    steps: Steps,
}

/// The number in a summary; of a word, its index.
fn number(info: &SummaryField, summary: &Summary) -> Option<f64> {
    let place = || {
        let word = info.word(summary)?;
        info.shown_words()?.iter().position(|known| *known == word).map(|place| place as f64)
    };
    info.number(summary).or_else(place)
}

impl ColourScale {
    /// A scale from 0, or from the smallest value if it is negative, to the largest value of the map so far.
    pub fn of(info: &'static SummaryField, map: &Map) -> Self {
        let values = || map.known_cells().filter_map(|cell| number(info, cell.summary()?));
        let (factor, unit) = info.unit(values());
        let (low, high) = values().fold((0.0_f64, 0.0_f64), |(low, high), value| {
            (low.min(value * factor), high.max(value * factor))
        });
        let label = match (info.name, unit) {
            ("period", _) => "repeats after forcing periods".to_owned(),
            ("crossings" | "impacts" | "releases", _) => format!("{} in {} s", info.label, map.window_s()),
            (_, "") => info.label.to_owned(),
            _ => format!("{} ({unit})", info.label),
        };
        let (bar, steps) = match info.name {
            _ if info.shown_words().is_some() => (None, Steps::Even),
            "period" => {
                let ticks = (1..=PERIODS).map(|n| (n as f64, n.to_string())).collect();
                let bar = PlotAxis::given(0.5, PERIODS as f64 + 0.5, ticks, &label);
                (Some(bar), Steps::Whole)
            }
            _ if info.is_count() => (Some(counts(high, &label)), Steps::Ratios),
            _ => (Some(PlotAxis::between(low, high, &label)), Steps::Even),
        };
        Self { info, factor, unit, bar, steps }
    }

    /// The number of a cell in the unit of the scale; of a word, its index. `None` if it has none.
    pub fn value(&self, cell: &Cell) -> Option<f64> {
        Some(number(self.info, cell.summary()?)? * self.factor)
    }

    /// What a cell shows, and whether its motion is at rest.
    pub fn look(&self, cell: &Cell) -> (Look, bool) {
        let rests = is_at_rest(cell);
        // the zeros of a mass at rest are shown as rest, not as small values
        let of_motion = |value: f64| value == 0.0 || ["regime", "period"].contains(&self.info.name);
        let look = match (self.value(cell), &self.bar) {
            (None, _) if cell.settled().is_none() => Look::Missing,
            (Some(value), _) if rests && of_motion(value) => Look::Rest,
            (None, _) if rests && ["regime", "period"].contains(&self.info.name) => Look::Rest,
            (Some(value), Some(bar)) => Look::Share(self.share(value, bar) as f32),
            _ if self.info.name == "regime" => {
                cell.settled().map_or(Look::None, |settled| Look::Kind(Kind::from(settled.regime)))
            }
            (Some(place), None) => Look::Word(place as u8),
            (None, _) => Look::None,
        };
        (look, rests)
    }

    /// Position of a value on the bar, 0 to 1.
    pub fn share(&self, value: f64, bar: &PlotAxis) -> f64 {
        match self.steps {
            Steps::Ratios => (1.0 + value).ln() / (1.0 + bar.high).ln(),
            Steps::Even | Steps::Whole => bar.share(value),
        }
    }

    /// Height of a cell on the scale, 0 to 1; words lie in the middle of equal parts.
    pub fn height(&self, cell: &Cell) -> Option<f64> {
        let value = self.value(cell)?;
        match (&self.bar, self.info.shown_words()) {
            (Some(bar), _) => Some(self.share(value, bar)),
            (None, Some(words)) => Some((value + 0.5) / words.len() as f64),
            (None, None) => None,
        }
    }

    /// Number of colour steps of the bar. `None` if it is continuous.
    pub fn steps(&self) -> Option<usize> {
        (self.steps == Steps::Whole).then_some(PERIODS)
    }

    pub fn column(&self) -> &'static str {
        self.info.name
    }

    pub fn is_of_words(&self) -> bool {
        self.info.shown_words().is_some()
    }

    /// Text of the word with an index.
    pub fn word(&self, place: u8) -> String {
        let word = self.info.shown_words().and_then(|words| words.get(usize::from(place)));
        said(self.info.name, word.copied().unwrap_or_default())
    }

    /// Text on the value of a cell: `fastest impact 12.3 mm/s`.
    pub fn reading(&self, cell: &Cell) -> Option<String> {
        let value = self.value(cell)?;
        Some(match self.info.shown_words() {
            Some(_) => self.word(value as u8),
            None if self.info.is_count() => format!("{} {value:.0}", self.info.label),
            None => format!("{} {} {}", self.info.label, three(value), self.unit).trim_end().to_owned(),
        })
    }

    /// Why a cell whose run lasted to its end has no value.
    pub fn without_value(&self) -> &'static str {
        match self.info.name {
            "period" | "settles_at_s" => "does not repeat",
            "first_release_s" | "first_release_g" => "no release, or the shaking does not change",
            "first_crossing_s" | "first_crossing_g" => "no crossing, or the shaking does not change",
            "impact_speed_max_m_per_s" => "no impact",
            "peak_contact_force_n" | "peak_contact_pressure_pa" => "no compliant stop is touched",
            "ended_at_s" => "lasted to its end",
            _ => "has no such value",
        }
    }
}

/// Whether the settled motion of a cell is rest.
pub fn is_at_rest(cell: &Cell) -> bool {
    cell.settled().is_some_and(|settled| settled.regime == Regime::Rest)
}

/// A scale of counts, which range from two to a thousand: ticks at 1 and 3 times powers of ten.
fn counts(largest: f64, label: &str) -> PlotAxis {
    let high = largest.max(1.0);
    let powers = (0..9).flat_map(|power| [1, 3].map(|digit| digit * 10_u64.pow(power)));
    let ticks = std::iter::once(0).chain(powers).map(|n| (n as f64, n.to_string()));
    PlotAxis::given(0.0, high, ticks.filter(|tick| tick.0 <= high).collect(), label)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::time::Duration;

    use super::*;
    use crate::app::session::Session;
    use crate::app::session::editor::Editor;
    use crate::scene::SweepAxis;

    #[test]
    fn nothing_of_a_motion_is_not_rest() {
        let mut session = Session::new(Editor::open("paper").unwrap(), Arc::new(|| ())).unwrap();
        let axis = |field: &str, from, to, step| {
            let field = field.to_owned();
            SweepAxis { field, from, to, step, ..SweepAxis::default() }
        };
        let axes =
            [axis("stops.travel_limit_mm", 1.5, 6.5, 5.0), axis("excitation.amplitude_g", 0.4, 1.0, 0.3)];
        session.map.choose(Some(axes));
        session.want_map(0.0);
        assert!(session.wait_for_map(Duration::from_secs(3600)));
        let map = session.map.map().unwrap();
        let scale = |column: &str| ColourScale::of(SummaryField::find(column).unwrap(), map);
        let look =
            |column: &str, place: (usize, usize)| scale(column).look(map.cell(place.0, place.1).unwrap().0);
        let (rest, moves, crosses) = ((0, 0), (1, 2), (0, 2));
        assert_eq!(look("regime", rest), (Look::Rest, true));
        assert_eq!(look("regime", moves), (Look::Kind(Kind::Intrawell), false));
        assert_eq!(look("regime", crosses), (Look::Kind(Kind::Interwell), false));
        assert_eq!(look("crossings", rest), (Look::Rest, true));
        assert_eq!(look("crossings", moves), (Look::Share(0.0), false));
        assert_eq!(look("crossings", crosses), (Look::Share(1.0), false));
        // a number of a motion at rest is shown, and marked as rest
        let (shown, rests) = look("max_abs_x_m", rest);
        let reach = scale("max_abs_x_m");
        assert!(rests && shown == Look::Share((1.5 / reach.bar.as_ref().unwrap().high) as f32), "{shown:?}");
        assert_eq!(reach.reading(map.cell(0, 0).unwrap().0).unwrap(), "reach 1.50 mm");
        // a value that no run has is not zero
        assert_eq!(look("peak_contact_force_n", crosses), (Look::None, false));
        assert_eq!(look("work_j", crosses), (Look::None, false));
        assert_eq!(look("side", crosses), (Look::Word(2), false));
        assert_eq!(scale("side").word(2), "both sides");
    }
}
