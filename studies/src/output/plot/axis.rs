//! Axes with their ticks and labels.

use serde::{Deserialize, Serialize};

use super::font;
use super::style::TICK;
use crate::numeric::round::{ONE_TWO_FIVE, decade, round_up};
use crate::numeric::{elementary, extent};

/// A range of values with its ticks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlotAxis {
    /// Value at the left or lower end.
    pub low: f64,
    /// Value at the right or upper end, above `low`.
    pub high: f64,
    /// Values with ticks, and the text at each.
    pub ticks: Vec<(f64, String)>,
    /// Label with unit and power of ten.
    pub label: String,
    /// Label without a power of ten.
    name: String,
    scale: Scale,
}

/// How ticks are placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Scale {
    /// At steps of 1, 2 or 5 times a power of ten.
    Linear,
    /// At powers of ten; the ends are logarithms.
    Decades,
    /// At 1 and 3 times powers of ten on a logarithmic scale of the value plus 1, which has room for 0 and
    /// for thousands.
    Counts,
    /// At given values.
    Given,
}

/// The requested ranges of the horizontal and the (first) vertical axis of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ranges {
    /// Range of the horizontal axis.
    pub x: Option<(f64, f64)>,
    /// Range of the vertical axis.
    pub y: Option<(f64, f64)>,
}

/// Number of ticks of an axis before the layout.
const USUAL: usize = 6;

/// Magnitude to which values are limited, so that no difference of two values overflows.
const LARGEST: f64 = 1e300;

impl PlotAxis {
    /// An axis from the smallest to the largest of `values`, extended by the share `margin` of that range at
    /// both ends. Values that are not finite are ignored; a range of length 0 is widened.
    pub fn around(values: impl IntoIterator<Item = f64>, margin: f64, label: &str) -> Self {
        let (low, high) = extent(values.into_iter().filter(|value| value.is_finite()));
        if low > high {
            return Self::between(0.0, 1.0, label);
        }
        let more = margin * (high - low);
        Self::between(low - more, high + more, label)
    }

    /// Like [`around`](Self::around), with 0 among the values; without any value it has no numbers.
    pub fn from_zero(values: impl IntoIterator<Item = f64>, margin: f64, label: &str) -> Self {
        let known: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        if known.is_empty() {
            return Self::given(0.0, 1.0, Vec::new(), label);
        }
        Self::around(known.into_iter().chain([0.0]), margin, label)
    }

    /// An axis from `low` to `high` with ticks at steps of 1, 2 or 5 times a power of ten.
    pub fn between(low: f64, high: f64, label: &str) -> Self {
        Self::linear(low, high, USUAL, label)
    }

    fn linear(low: f64, high: f64, count: usize, label: &str) -> Self {
        let (low, high) = finite_range(low, high);
        let ticks = |step: f64| (high / step + 1e-9).floor() - (low / step - 1e-9).ceil() + 1.0;
        let usual = round_up((high - low) / count.max(1) as f64, &ONE_TWO_FIVE);
        // a smaller step where the usual one has hardly a tick, or where its ticks are no more than those of
        // a range that begins and ends with one
        let finer = round_up(0.39 * usual, &ONE_TWO_FIVE);
        let step = if ticks(usual) < 3.0 || ticks(finer) <= count as f64 + 1.0 { finer } else { usual };
        // if plain numbers would be long, the label has a common power of ten
        let largest = low.abs().max(high.abs());
        let power = decade(largest);
        let power = if (-3..5).contains(&power) { 0 } else { power };
        let scale = elementary::powi(10.0, power);
        let decimals = (power - (elementary::log10(step) + 1e-9).floor() as i32).clamp(0, 12) as usize;
        // if the step is lost in the rounding of large numbers, only the ends have ticks
        let ticks = if step > 8.0 * f64::EPSILON * largest {
            let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
            let number = |k: i64| {
                let value = (first + k as f64) * step;
                let text = format!("{:.decimals$}", value / scale);
                // zero has no sign, and negative numbers have a minus sign instead of a hyphen
                let zero = text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.'));
                let text = if zero { text.replace('-', "") } else { text.replace('-', "\u{2212}") };
                (value.clamp(low, high), text)
            };
            (0..=(last - first).clamp(0.0, 40.0) as i64).map(number).collect()
        } else {
            [low, high].map(|value| (value, format!("{:.12}", value / scale))).into()
        };
        let name = label.to_owned();
        let label = match (power, label.rsplit_once(" (")) {
            (0, _) => label.to_owned(),
            (_, Some((words, unit))) => format!("{words} (10{} {unit}", superscript(power)),
            (_, None) => format!("{label} (\u{d7}10{})", superscript(power)),
        };
        Self { low, high, ticks, label, name, scale: Scale::Linear }
    }

    /// An axis with these ticks.
    pub fn given(low: f64, high: f64, ticks: Vec<(f64, String)>, label: &str) -> Self {
        Self { low, high, ticks, label: label.to_owned(), name: label.to_owned(), scale: Scale::Given }
    }

    /// A nearly logarithmic axis of whole numbers from 0 to `high`.
    pub fn counts(high: f64, label: &str) -> Self {
        let high = high.max(1.0);
        let powers = (0..9).flat_map(|power| [1, 3].map(|digit| digit * 10_u64.pow(power)));
        let ticks = std::iter::once(0).chain(powers).map(|n| (n as f64, n.to_string()));
        let ticks = ticks.filter(|tick| tick.0 <= high).collect();
        Self { scale: Scale::Counts, ..Self::given(0.0, high, ticks, label) }
    }

    /// The axis with about `count` ticks.
    #[must_use]
    pub fn with_ticks(&self, count: usize) -> Self {
        match self.scale {
            Scale::Linear => Self::linear(self.low, self.high, count, &self.name),
            Scale::Decades => Self::logarithmic(self.low, self.high, count, &self.name),
            Scale::Counts => {
                let whole = Self::counts(self.high, &self.name);
                let every = whole.ticks.len().div_ceil(count + 1).max(1);
                Self { ticks: whole.ticks.into_iter().step_by(every).collect(), ..self.clone() }
            }
            Scale::Given => self.clone(),
        }
    }

    /// The axis with other ends, which are logarithms on a logarithmic axis.
    #[must_use]
    pub fn zoomed(&self, (low, high): (f64, f64)) -> Self {
        Self { low, high, ..self.clone() }.with_ticks(USUAL)
    }

    /// The axis with other ends, and without ticks.
    #[doc(hidden)]
    pub fn bare(&self, (low, high): (f64, f64)) -> Self {
        let (label, name) = (String::new(), self.name.clone());
        Self { low, high, ticks: Vec::new(), label, name, scale: self.scale }
    }

    /// The unit of its values, if it has one.
    pub fn unit(&self) -> Option<&str> {
        Some(self.name.rsplit_once(" (")?.1.trim_end_matches(')'))
    }

    /// Whether its ends are logarithms to base 10.
    pub fn is_logarithmic(&self) -> bool {
        self.scale == Scale::Decades
    }

    /// Whether its ticks are numbers of a scale, so that some may be left out.
    pub(super) fn is_scale(&self) -> bool {
        self.scale != Scale::Given
    }

    /// Whether a value lies between its ends.
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// The axis over the given range of values, which are not logarithms, or `self` if there is none.
    #[must_use]
    pub fn or_given(self, range: Option<(f64, f64)>) -> Self {
        match (range, self.scale) {
            (None, _) => self,
            (Some((low, high)), Scale::Decades) => {
                Self::powers(elementary::log10(low), elementary::log10(high), &self.name)
            }
            (Some((low, high)), _) => Self::linear(low, high, USUAL, &self.name),
        }
    }

    /// A logarithmic axis in whole decades that covers `values`, which are not logarithms and above 0, with
    /// ticks at powers of ten.
    pub fn decades(values: impl IntoIterator<Item = f64>, label: &str) -> Self {
        let positive = values.into_iter().filter(|value| value.is_finite() && *value > 0.0);
        let (low, high) = extent(positive.map(elementary::log10));
        if low > high {
            return Self::powers(0.0, 1.0, label);
        }
        Self::powers(low.floor(), high.ceil().max(low.floor() + 1.0), label)
    }

    /// A logarithmic axis between these logarithms, with ticks at powers of ten.
    pub fn powers(low: f64, high: f64, label: &str) -> Self {
        Self::logarithmic(low, high, USUAL, label)
    }

    fn logarithmic(low: f64, high: f64, count: usize, label: &str) -> Self {
        let every = (((high - low) / count.max(1) as f64).ceil() as i32).max(1);
        let powers = low.ceil() as i32..=high.floor() as i32;
        let powers = powers.filter(|power| power.rem_euclid(every) == 0);
        let ticks = powers.map(|power| (f64::from(power), format!("10{}", superscript(power)))).collect();
        Self { scale: Scale::Decades, ..Self::given(low, high, ticks, label) }
    }

    /// Width of the widest of its numbers on the canvas.
    pub(super) fn widest_number(&self) -> f64 {
        self.ticks.iter().map(|tick| font::width(&tick.1, TICK, false)).fold(0.0, f64::max)
    }

    /// Position of `value` between the ends: 0 at the lower, 1 at the upper end.
    pub fn share(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Counts => elementary::ln(1.0 + value.max(0.0)) / elementary::ln(1.0 + self.high),
            Scale::Linear | Scale::Decades | Scale::Given => {
                (value.clamp(-LARGEST, LARGEST) - self.low) / (self.high - self.low)
            }
        }
    }
}

/// The ends of a range, made finite and distinct.
fn finite_range(low: f64, high: f64) -> (f64, f64) {
    let tame = |value: f64| if value.is_finite() { value.clamp(-LARGEST, LARGEST) } else { 0.0 };
    let (low, high) = (tame(low.min(high)), tame(low.max(high)));
    let least = 1e-9 * low.abs().max(high.abs());
    if high - low > least && high - low > 1e-290 {
        return (low, high);
    }
    let half = if low == 0.0 || low.abs() < 1e-280 { 1.0 } else { 0.1 * low.abs() };
    let middle = 0.5 * low + 0.5 * high;
    (middle - half, middle + half)
}

/// A whole number in superscript digits.
pub(crate) fn superscript(power: i32) -> String {
    let digit = |c: char| match c {
        '-' => '\u{207b}',
        '1' => '\u{b9}',
        '2' => '\u{b2}',
        '3' => '\u{b3}',
        c => char::from_u32(0x2070 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
    };
    power.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(axis: &PlotAxis) -> String {
        axis.ticks.iter().map(|tick| tick.1.as_str()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn decades_cover_what_they_show() {
        let axis = PlotAxis::decades([3e-5, f64::NAN, 0.0, 2.0], "error").with_ticks(3);
        assert_eq!((axis.low, axis.high), (-5.0, 1.0));
        assert_eq!(numbers(&axis), "10\u{207b}\u{2074} 10\u{207b}\u{b2} 10\u{2070}");
        let one = PlotAxis::decades([1e-3], "");
        assert_eq!((one.low, one.high), (-3.0, -2.0));
        let none = PlotAxis::decades([], "");
        assert_eq!((none.low, none.high), (0.0, 1.0));
    }

    #[test]
    fn ticks_are_short_numbers() {
        assert_eq!(numbers(&PlotAxis::between(0.0, 2.0, "").with_ticks(5)), "0.0 0.5 1.0 1.5 2.0");
        assert_eq!(numbers(&PlotAxis::between(-1.7, 1.7, "").with_ticks(4)), "\u{2212}1 0 1");
        assert_eq!(numbers(&PlotAxis::between(0.0, 10.0, "").with_ticks(5)), "0 2 4 6 8 10");
        assert_eq!(numbers(&PlotAxis::between(0.0, 1570.8, "").with_ticks(5)), "0 500 1000 1500");
        let small = PlotAxis::between(0.0, 2e-9, "x (m)").with_ticks(4);
        assert_eq!(
            (numbers(&small), small.label.as_str()),
            ("0.0 0.5 1.0 1.5 2.0".into(), "x (10\u{207b}\u{2079} m)")
        );
    }

    #[test]
    fn degenerate_ranges_become_ranges() {
        let nan = f64::NAN;
        let ends = [0.0, -0.0, 1.0, -3.0, 1e308, -1e308, 5e-324, 1e-300, 1e15, nan, f64::INFINITY];
        for low in ends {
            for high in ends.into_iter().chain([low * (1.0 + 1e-15), low + 1.0]) {
                for count in [0, 1, 5, 12] {
                    let axis = PlotAxis::between(low, high, "x").with_ticks(count);
                    assert!(axis.low < axis.high, "{low} {high}");
                    assert!(!axis.ticks.is_empty() && axis.ticks.len() < 42, "{low} {high}: {axis:?}");
                    let shares = axis.ticks.iter().map(|tick| axis.share(tick.0));
                    assert!(shares.into_iter().all(|s| (-1e-9..=1.0 + 1e-9).contains(&s)), "{axis:?}");
                }
            }
        }
        assert_eq!(PlotAxis::around([nan, nan], 0.1, "").low, 0.0);
        assert_eq!(PlotAxis::around([3.0], 0.1, "").ticks.len(), 7);
    }
}
