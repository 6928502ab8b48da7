//! Formats of numbers in fields, on axes and in sentences, and round numbers for ranges and steps.

use crate::numeric::{self, Ending, elementary, round};

use crate::output::suited_unit;

pub use crate::numeric::rounded;

/// The least round number, of one or two significant digits, that is not below `value`.
pub fn round_up(value: f64) -> f64 {
    let digits = [1.0, 1.2, 1.5, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    round::round_up(value, &digits)
}

/// The greatest 1, 2 or 5 times a power of ten that is not above `value`.
pub fn below(value: f64) -> f64 {
    round::round_down(value, &round::ONE_TWO_FIVE)
}

/// The value rounded to seven significant digits, which removes the rounding errors of products.
pub fn decimal(value: f64) -> f64 {
    rounded(value, 7)
}

/// Number of decimals that distinguishes multiples of a step.
pub fn decimals(step: f64) -> usize {
    decimals_in(&decimal(step).to_string()).min(12)
}

fn decimals_in(number: &str) -> usize {
    number.split_once('.').map_or(0, |(_, after)| after.len())
}

/// A number as a field shows it while it is not edited: with at least `least` decimals, and up to seven
/// significant digits.
pub fn shown(value: f64, least: usize) -> String {
    exact(decimal(value), least)
}

/// Like [`shown`], with all digits of the number.
pub fn exact(value: f64, least: usize) -> String {
    if value.is_infinite() {
        return if value > 0.0 { "\u{221e}" } else { "\u{2212}\u{221e}" }.to_owned();
    }
    if value != 0.0 && !(1e-6..1e9).contains(&value.abs()) {
        return format!("{value:e}");
    }
    let text = format!("{}", value + 0.0);
    if decimals_in(&text) >= least { text } else { format!("{:.least$}", value + 0.0) }
}

/// Units that follow a number after a space.
const UNITS: [&str; 30] = [
    "g", "grams", "m/s²", "µJ", "µW", "mm", "m", "um", "mm/s", "um/s", "m/s", "s", "ms", "Hz", "N", "mN",
    "N/m", "J", "mJ", "uJ", "W", "mW", "uW", "V", "ohm", "kohm", "%", "min", "points", "N s/m",
];

/// A text for the screen: its lines are not broken between a number and its unit, nor before three dots.
pub fn unbroken(text: &str) -> String {
    let mut whole = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(' ') {
        let after = &rest[at + 1..];
        let word = after.split(|c: char| c.is_whitespace() || ".,;:?!)".contains(c)).next().unwrap_or("");
        let is_unit = rest[..at].ends_with(|c: char| c.is_ascii_digit()) && UNITS.contains(&word);
        whole += &rest[..at];
        whole.push(if is_unit || after.starts_with("...") { '\u{a0}' } else { ' ' });
        rest = after;
    }
    whole + rest
}

/// A text of numbers with minus signs in place of hyphens.
pub fn with_minus(text: &str) -> String {
    text.replace('-', "\u{2212}")
}

/// The sign in place of an unknown number.
pub const UNKNOWN: &str = "\u{2013}";

/// A number with at least three significant digits, and no more decimals than these take.
pub fn three(value: f64) -> String {
    numeric::significant(value, 3, Ending::Whole, 0.0..f64::INFINITY)
}

/// The same, with an exponent below this size.
pub fn three_from(value: f64, least: f64) -> String {
    numeric::significant(value, 3, Ending::Whole, least..f64::INFINITY)
}

/// A power in W as text with a unit.
pub fn power(watt: f64) -> String {
    let (factor, unit) = suited_unit("W", std::iter::once(watt.abs()));
    format!("{} {unit}", three(watt * factor))
}

/// Number of decimals with which numbers up to `largest` have three significant digits.
pub fn decimals_for(largest: f64) -> usize {
    if largest > 0.0 && largest.is_finite() { numeric::decimals(largest, 3) } else { 2 }
}

/// A number with `digits` significant digits, without an exponent unless it is very small or large.
fn significant(value: f64, digits: usize) -> String {
    numeric::significant(value, digits, Ending::Padded, 1e-6..1e7)
}

/// An amplitude as its slider shows it.
pub fn as_set(amplitude: f64) -> String {
    shown(amplitude, 2)
}

/// A threshold: three significant digits.
pub fn grams(g: f64) -> String {
    significant(g, 3)
}

/// A threshold beside the present amplitude, rounded up: three significant digits, or as many more as tell
/// the two apart.
pub fn grams_beside(g: f64, present: f64) -> String {
    let differs = |digits: &usize| g == present || significant(g, *digits) != significant(present, *digits);
    up(g, (3..7).find(differs).unwrap_or(3))
}

/// A threshold, rounded up to three significant digits.
pub fn grams_up(g: f64) -> String {
    up(g, 3)
}

/// A threshold, rounded up to so many significant digits, so that the amplitude in the text is enough.
fn up(g: f64, digits: usize) -> String {
    let unit = elementary::powf(10.0, elementary::log10(g).floor() - (digits as f64 - 1.0));
    significant(((g / unit - 1e-6).ceil() * unit).max(g), digits)
}

/// A difference of two thresholds: two significant digits.
pub fn grams_apart(g: f64) -> String {
    significant(g, 2)
}

/// A force in N: two significant digits.
pub fn newtons(n: f64) -> String {
    format!("{} N", significant(n, 2))
}

/// Speed in mm/s: whole, below 10 with one decimal.
pub fn speed(m_per_s: f64) -> String {
    let mm = m_per_s * 1e3;
    if mm > 0.0 && mm < 0.05 {
        return "below 0.1".to_owned();
    }
    if mm < 9.95 { format!("{mm:.1}") } else { format!("{mm:.0}") }
}

/// Length in mm: one decimal, two below 1 mm, none from 100 mm on.
pub fn mm(m: f64) -> String {
    if m.abs() >= 0.09995 {
        return format!("{:.0}", m * 1e3);
    }
    // the sum with 0.0 turns -0.0 into 0.0
    let tenths = (m * 1e4).round() / 10.0 + 0.0;
    if tenths == 0.0 || m.abs() >= 0.95e-3 { format!("{tenths:.1}") } else { format!("{:.2}", m * 1e3) }
}

/// A travel limit in mm: two decimals, as on a slider, or one if the second is 0.
pub fn limit_mm(mm: f64) -> String {
    let text = format!("{mm:.2}");
    text.strip_suffix('0').unwrap_or(&text).to_owned()
}

/// Energy in mJ with two decimals, fewer where three digits stand before them, and below 0.1 mJ with two
/// significant digits; with three from 1 J on in J, and below 1 µJ in a unit that suits it.
pub fn energy(j: f64) -> String {
    let mj = j.max(0.0) * 1e3;
    if mj >= 999.5 {
        return format!("{} J", three(j));
    }
    if mj == 0.0 || mj >= 0.1 {
        return format!("{mj:.0$} mJ", decimals_for(mj).min(2));
    }
    if mj >= 1e-3 {
        return format!("{} mJ", significant(mj, 2));
    }
    let (factor, unit) = suited_unit("J", std::iter::once(j));
    format!("{} {unit}", significant(j * factor, 3))
}

/// A displacement in m near the left and right stops in m, as text in mm: as `mm` formats it, or with more
/// decimals if rounding would move it to the other side of a stop.
pub fn mm_beside(m: f64, stops: (Option<f64>, Option<f64>)) -> String {
    let (left, right) = stops;
    let limits = [left.map(f64::abs), right.map(f64::abs)];
    let is_beyond = |m: f64, stop: &f64| m.abs() > stop * (1.0 + 1e-6);
    let keeps_side = |text: &str| {
        let written = text.parse::<f64>().unwrap_or(m * 1e3) * 1e-3;
        limits.iter().flatten().all(|stop| is_beyond(written, stop) == is_beyond(m, stop))
    };
    let longer = (2..=6).map(|decimals| format!("{:.decimals$}", m * 1e3 + 0.0));
    std::iter::once(mm(m)).chain(longer).find(|text| keeps_side(text)).unwrap_or_else(|| mm(m))
}

/// Length in m from which on lengths are given in m.
const METRE: f64 = 0.9995;

/// A displacement in m near stops in m, with its unit: as `mm_beside` has it, or in m.
pub fn length_beside(m: f64, stops: (Option<f64>, Option<f64>)) -> String {
    if m.abs() >= METRE { format!("{} m", three(m)) } else { format!("{} mm", mm_beside(m, stops)) }
}

/// The factor from m to the unit in which a row of lengths up to `largest` in m is given, and that unit.
pub fn length_unit(largest: f64) -> (f64, &'static str) {
    if largest >= METRE { (1.0, "m") } else { (1e3, "mm") }
}

/// A range in m near stops in m as text, `between 5.6 and 7.3 mm`; its decimals distinguish the ends.
pub fn between(low: f64, high: f64, stops: (Option<f64>, Option<f64>)) -> String {
    let (factor, unit) = length_unit(low.abs().max(high.abs()));
    let text = |m: f64, decimals: usize| with_minus(&format!("{:.decimals$}", m * factor + 0.0));
    let apart = |decimals: &usize| text(low, *decimals) != text(high, *decimals);
    if unit == "m" {
        let decimals = (2..=6).find(apart).unwrap_or(2);
        return format!("between {} and {} m", text(low, decimals), text(high, decimals));
    }
    match (1..=6).find(apart) {
        Some(1) => {
            with_minus(&format!("between {} and {} mm", mm_beside(low, stops), mm_beside(high, stops)))
        }
        Some(decimals) => format!("between {} and {} mm", text(low, decimals), text(high, decimals)),
        None => with_minus(&format!("at {} mm", mm_beside(high, stops))),
    }
}

/// A time in s: one decimal, or none from ten on.
pub fn seconds(s: f64) -> String {
    if s >= 9.95 || s == 0.0 { format!("{s:.0} s") } else { format!("{s:.1} s") }
}

/// A number of events per forcing period in words.
pub fn times(count: f64) -> String {
    if count < 0.1 {
        return "less than once in ten periods".to_owned();
    }
    let rare = (1.0 / count).round();
    match count {
        c if rare > 1.0 && (1.0 / c - rare).abs() < 0.05 * rare => format!("once in {rare:.0} periods"),
        c if (c - 1.0).abs() < 0.05 => "once a period".to_owned(),
        c if (c - 2.0).abs() < 0.05 => "twice a period".to_owned(),
        c if (c - c.round()).abs() < 0.05 => format!("{c:.0} times a period"),
        c => format!("{c:.1} times a period"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_digits() {
        let all = [
            (0.9, 2),
            (1.137, 2),
            (0.037_729_499_880_183_35, 2),
            (1_047.197_551, 0),
            (15.0, 1),
            (-0.0, 2),
            (1e-9, 2),
        ];
        let texts = all.map(|(value, least)| shown(value, least));
        assert_eq!(texts, ["0.90", "1.137", "0.0377295", "1047.198", "15.0", "0.00", "1e-9"]);
        assert_eq!(exact(0.037_729_499_880_183_35, 2), "0.03772949988018335");
        assert_eq!([0.05, 0.01, 15.0, 2e-4].map(decimals), [2, 2, 0, 4]);
        let powers = [0.0, 1.234, 0.012_34, 3.26e-4, 5e-6, -2e-9].map(power);
        assert_eq!(powers, ["0 mW", "1.23 W", "12.3 mW", "0.326 mW", "5.00 µW", "-2.00 nW"]);
        assert_eq!([0.0384, 1.25, 1000.0].map(three), ["0.0384", "1.25", "1000"]);
    }

    #[test]
    fn digits_are_significant() {
        for (value, text) in [
            (0.71885, "0.719"),
            (0.0377, "0.0377"),
            (1.16, "1.16"),
            (0.9996, "1.00"),
            (123.4, "123"),
            (2.5e-9, "2.5e-9"),
            (0.0, "0"),
            (-0.5, "-0.500"),
        ] {
            assert_eq!(grams(value), text);
        }
        assert_eq!([0.6881, 1.15, 0.9991].map(grams_up), ["0.689", "1.15", "1.00"]);
        assert_eq!((grams_apart(0.2604), newtons(0.196_8)), ("0.26".into(), "0.20 N".into()));
    }

    #[test]
    fn an_energy_has_the_unit_that_suits_it() {
        let texts = [9.2e-4, 1.2, 0.25, 7.87e-5, 5.12e-12, 4.56e-8, 0.0, -1.0].map(energy);
        assert_eq!(
            texts,
            ["0.92 mJ", "1.20 J", "250 mJ", "0.079 mJ", "5.12 pJ", "45.6 nJ", "0.00 mJ", "0.00 mJ"]
        );
    }

    #[test]
    fn the_ends_of_a_range_differ() {
        let open = (None, None);
        assert_eq!(between(5.61e-3, 7.29e-3, open), "between 5.6 and 7.3 mm");
        assert_eq!(between(6.0012e-3, 6.0037e-3, open), "between 6.001 and 6.004 mm");
        assert_eq!(between(-1.0001, -1.0, open), "between \u{2212}1.0001 and \u{2212}1.0000 m");
        assert_eq!(between(-1.5363, 1.5, open), "between \u{2212}1.54 and 1.50 m");
        assert_eq!(between(2e-3, 2e-3, open), "at 2.0 mm");
    }

    #[test]
    fn a_length_stays_on_its_side_of_a_stop() {
        let stops = |mm: f64| (Some(-mm * 1e-3), Some(mm * 1e-3));
        let at = [(2.25e-3, 2.25), (6.875e-3, 6.875), (-2.25e-3, 2.25), (1.5e-3, 1.5)];
        let texts = at.map(|(m, limit)| mm_beside(m, stops(limit)));
        assert_eq!(texts, ["2.25", "6.875", "-2.25", "1.5"]);
        // beyond a compliant stop
        assert_eq!(mm_beside(1.52e-3, stops(1.5)), "1.52");
        assert_eq!(mm_beside(7.9e-3, (None, None)), "7.9");
        let lengths = [1.4435, 1.5363, 0.2345, 0.0999, 7.9e-3].map(|m| length_beside(m, (None, None)));
        assert_eq!(lengths, ["1.44 m", "1.54 m", "234 mm", "99.9 mm", "7.9 mm"]);
        assert_eq!(between(-2.25e-3, 1.11e-3, stops(2.25)), "between \u{2212}2.25 and 1.1 mm");
    }
}
