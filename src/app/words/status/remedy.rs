//! Sentences about what it would take to cross, and how much amplitude there is to spare.

use crate::dynamics::{Regime, STANDARD_GRAVITY, Summary};
use crate::scene::{Scene, Stops};
use interwell_studies::study::{Found, Thresholds};

use super::super::capital;
use super::super::numbers::{exact, grams, grams_apart, grams_beside, grams_up};

/// Amplitude in g of a drive that is harmonic.
pub(super) fn amplitude(scene: &Scene) -> Option<f64> {
    Some(scene.harmonic()?.amplitude_g().abs())
}

/// 1 g in the unit of the amplitude of a scene's drive, and the name of that unit.
fn unit(scene: &Scene) -> (f64, &'static str) {
    let drive = scene.harmonic();
    drive.map_or((1.0, "g"), |drive| (drive.amplitude_of(STANDARD_GRAVITY), drive.unit()))
}

/// An amplitude in g, written by `form` in the unit of the drive's field, with that unit.
pub fn in_unit(scene: &Scene, form: fn(f64) -> String, g: f64) -> String {
    let (per_g, unit) = unit(scene);
    format!("{} {unit}", form(g * per_g))
}

/// Gaps that end below this multiple of the least amplitude that crosses are not mentioned.
const NARROW: f64 = 1.03;

/// The clause that says how far gaps reach above the least amplitude that crosses; empty without gaps.
fn gaps(scene: &Scene, found: &Thresholds, from: f64) -> String {
    match found.crossing.without_gap {
        Some(g) if g > NARROW * from => format!(", with gaps up to {}", in_unit(scene, grams, g)),
        None => ", with gaps above it".to_owned(),
        Some(_) => String::new(),
    }
}

/// The word before a threshold near which a motion may be a transient.
fn about(found: &Found) -> &'static str {
    if found.undecided { "about " } else { "" }
}

/// A threshold as every view writes it, in the unit of the drive's field, and that unit.
pub fn threshold(scene: &Scene, found: &Found) -> Option<(String, &'static str)> {
    let (per_g, unit) = unit(scene);
    Some((format!("{}{}", about(found), least(scene, found.value? * per_g)), unit))
}

/// A threshold in the unit of the drive's field, with digits that tell it from the amplitude of the scene.
fn least(scene: &Scene, value: f64) -> String {
    scene.harmonic().map_or_else(|| grams_up(value), |drive| grams_beside(value, drive.amplitude().abs()))
}

/// A distance in g from a threshold, with its unit: two significant digits, but no decimals that an uncertain
/// threshold lacks.
fn apart(scene: &Scene, found: &Found, g: f64) -> String {
    let (per_g, unit) = unit(scene);
    let decimals = |text: &str| text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let fine = grams_apart(g * per_g);
    let known = threshold(scene, found).map_or(0, |(least, _)| decimals(&least));
    let rounded = format!("{:.known$}", g * per_g);
    let is_zero = rounded.chars().all(|c| "0.".contains(c));
    let is_enough = !found.undecided || decimals(&fine) <= known || is_zero;
    format!("{} {unit}", if is_enough { fine } else { rounded })
}

/// The present amplitude and motion compared with the thresholds, which are from rest at this frequency.
pub(super) fn remedy(scene: &Scene, summary: &Summary, found: &Thresholds) -> String {
    let Some(g) = amplitude(scene) else { return String::new() };
    if summary.regime == Regime::OneWell {
        return String::new();
    }
    let crosses = summary.crossings > 0;
    let Some(from) = found.crossing.value else {
        let limit = in_unit(scene, grams, found.searched_to);
        let never = if found.crossing.undecided { "was seen to cross" } else { "crosses" };
        return if crosses { String::new() } else { format!("From rest no shaking up to {limit} {never}.") };
    };
    let about = about(&found.crossing);
    let Some((least, unit)) = threshold(scene, &found.crossing) else { return String::new() };
    let (least, gaps) = (format!("{least} {unit}"), gaps(scene, found, from));
    let apart = |g: f64| apart(scene, &found.crossing, g);
    let text = match (crosses, g >= from) {
        (true, true) => format!("{about}{} to spare: crosses from {least}{gaps}.", apart(g - from)),
        (true, false) => format!("From rest it takes {least} to cross{gaps}."),
        (false, true) => format!("From rest it crosses from {least}{gaps}."),
        (false, false) => match found.frees_at.filter(|frees| *frees > g) {
            Some(g) => format!("Frees at {}, crosses from {least}{gaps}.", in_unit(scene, grams_up, g)),
            None => {
                // said once of both numbers
                let least = least.strip_prefix(about).unwrap_or(&least);
                format!("{about}{} short of crossing at {least}{gaps}.", apart(from - g))
            }
        },
    };
    capital(&text)
}

/// What it would take to cross in every period: more shaking, or stops with the travel limit `stops_mm`.
pub fn ways(scene: &Scene, settled: &Summary, thresholds: &Thresholds, stops_mm: Option<f64>) -> String {
    let Some(g) = amplitude(scene) else { return String::new() };
    let stops = stops_mm.map(|limit| format!("with stops at ±{} mm", exact(limit, 1)));
    match settled.regime {
        Regime::OneWell => "There is no barrier, so nothing to cross.".to_owned(),
        Regime::Interwell | Regime::Crossing => {
            "It crosses already, again and again in the same way.".to_owned()
        }
        Regime::Irregular => match stops.filter(|_| scene.stops == Stops::None) {
            Some(stops) => format!("Crosses in the same way every time {stops}."),
            None => "It crosses already, if not regularly.".to_owned(),
        },
        Regime::Rest | Regime::Intrawell => {
            let more = thresholds.crossing.value.filter(|from| *from > g);
            let about = about(&thresholds.crossing);
            let more = more.map(|from| {
                let apart = apart(scene, &thresholds.crossing, from - g);
                format!("with {about}{apart} more")
            });
            let make = if thresholds.crossing.undecided { "were seen to make" } else { "make" };
            match (more, stops) {
                (Some(more), Some(stops)) => format!("Crosses {more}, or {stops}."),
                (Some(more), None) => format!("Crosses {more}; no stops alone would do it."),
                (None, Some(stops)) => format!("Crosses {stops}."),
                (None, None) => format!(
                    "From rest neither shaking up to {} nor any stops {make} it cross.",
                    in_unit(scene, grams, thresholds.searched_to)
                ),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::dynamics::{Model, Request};
    use crate::mechanics::Mechanism;
    use crate::scene::{Document, Excitation};

    #[test]
    fn undecided_thresholds_are_marked() {
        let Document { scene, files, .. } = Document::load("first-look").unwrap();
        let mechanism = Arc::new(Mechanism::build(&scene.mechanism, &files).unwrap());
        let settled = Model::build(&scene, mechanism).unwrap().run(&Request::default()).summary;
        assert_eq!((settled.regime, settled.crossings), (Regime::Intrawell, 0));
        let said = |value: Option<f64>, undecided: bool| {
            let crossing = Found { value, undecided, without_gap: value, ..Found::default() };
            let found = Thresholds { frees_at: None, crossing, searched_to: 30.0 };
            [remedy(&scene, &settled, &found), ways(&scene, &settled, &found, None)]
        };
        // 15.2 g of mass, pushed with as much as the base would
        let mut pushed = scene.clone();
        pushed.excitation = Excitation::Force {
            amplitude_n: 0.9 * 9.80665 * 0.0152,
            frequency_rad_per_s: 6.0 * std::f64::consts::PI,
            phase_deg: 0.0,
        };
        let crossing = Found { value: Some(1.2), ..Found::default() };
        let found = Thresholds { frees_at: None, crossing, searched_to: 30.0 };
        let (short, more) = (remedy(&pushed, &settled, &found), ways(&pushed, &settled, &found, None));
        assert_eq!(short, "0.045 N short of crossing at 0.179 N, with gaps above it.");
        assert_eq!(more, "Crosses with 0.045 N more; no stops alone would do it.");
        // as many digits as tell it from 0.9 g
        assert_eq!(said(Some(0.902), false)[0], "0.0020 g short of crossing at 0.902 g.");
        assert_eq!(said(Some(0.9004), false)[0], "0.00040 g short of crossing at 0.9004 g.");
        let short = "0.30 g short of crossing at 1.20 g.";
        let more = "Crosses with 0.30 g more; no stops alone would do it.";
        assert_eq!(said(Some(1.2), false), [short, more]);
        let short = "About 0.30 g short of crossing at 1.20 g.";
        let more = "Crosses with about 0.30 g more; no stops alone would do it.";
        assert_eq!(said(Some(1.2), true), [short, more]);
        assert_eq!(said(Some(0.941), true)[0], "About 0.041 g short of crossing at 0.941 g.");
        assert_eq!(said(Some(1.0), true)[0], "About 0.10 g short of crossing at 1.00 g.");
        let nothing = "From rest no shaking up to 30.0 g crosses.";
        let neither = "From rest neither shaking up to 30.0 g nor any stops make it cross.";
        assert_eq!(said(None, false), [nothing, neither]);
        let nothing = "From rest no shaking up to 30.0 g was seen to cross.";
        let neither = "From rest neither shaking up to 30.0 g nor any stops were seen to make it cross.";
        assert_eq!(said(None, true), [nothing, neither]);
    }
}
