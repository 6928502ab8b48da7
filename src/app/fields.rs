//! The numbers of a scene as the window shows them: what each is called, how far its slider goes, what may be typed.

use crate::dynamics::STANDARD_GRAVITY;
use crate::numeric::{self, round};
use crate::scene::{FieldPath, Mechanism, Scene, Stops};

use super::session::Session;

/// What sets how far a slider goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scale {
    /// Nothing of the scene.
    Fixed,
    /// The value that the scene was opened with.
    Value,
    /// The acceleration that the mechanism itself gives the mass.
    Push,
    /// The rate at which the mass swings by itself.
    Rate,
    /// The distance of the wells; without one that of the stops.
    Travel,
    /// The length of the shorter flexure; beyond a quarter of it the stable branch may end.
    Preload,
}

/// A number of a scene and its control.
#[derive(Debug)]
pub struct FieldInfo {
    /// Dotted path in the scene; a part of a sum has its index left out.
    pub path: &'static str,
    /// What its control is called.
    pub name: &'static str,
    /// Its unit; none for a ratio.
    pub unit: &'static str,
    /// Smallest and largest value and step of the slider, for a scene of the prototype's size.
    slider: (f64, f64, f64),
    scale: Scale,
    /// Smallest and largest value that may be typed.
    pub typed: (f64, f64),
    /// What happens if it is increased.
    pub hover: &'static str,
}

/// The range of a slider and the step of the arrow keys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// The left end.
    pub low: f64,
    /// The right end.
    pub high: f64,
    /// The step of the arrow keys.
    pub step: f64,
}

const fn field(
    path: &'static str,
    name: &'static str,
    unit: &'static str,
    (slider, scale): ((f64, f64, f64), Scale),
    typed: (f64, f64),
    hover: &'static str,
) -> FieldInfo {
    FieldInfo { path, name, unit, slider, scale, typed, hover }
}

const G: (f64, f64) = (-1e4, 1e4);
const HZ: (f64, f64) = (1e-2, 1e5);
const BAND: (f64, f64) = (0.0, 1e5);
const LENGTH: (f64, f64) = (1e-3, 1e4);
const LIMIT: (f64, f64) = (1e-3, 1e6);
const SHARE: (f64, f64) = (0.0, 1.0);
const SECONDS: (f64, f64) = (0.01, 1e6);
const PUSH: ((f64, f64, f64), Scale) = ((0.0, 2.0, 0.01), Scale::Push);
const RATE: ((f64, f64, f64), Scale) = ((0.5, 20.0, 0.1), Scale::Rate);
const STOP: ((f64, f64, f64), Scale) = ((0.1, 8.0, 0.05), Scale::Travel);
const UNIT: ((f64, f64, f64), Scale) = ((0.0, 1.0, 0.01), Scale::Fixed);
const LONG: ((f64, f64, f64), Scale) = ((10.0, 60.0, 0.1), Scale::Value);
const WIDE: ((f64, f64, f64), Scale) = ((1.0, 60.0, 0.1), Scale::Value);
const RAMP: ((f64, f64, f64), Scale) = ((1.0, 600.0, 1.0), Scale::Value);

const LIMIT_HOVER: &str = "Increase: the stops move outward. Inside the wells the mass then rests lower on the hill: it takes more shaking to free \
     it and travels further once it crosses.";
const REBOUND_HOVER: &str =
    "Increase: a rebound keeps more of the speed, so that the mass chatters for longer before it rests.";
const SHAKING_HOVER: &str =
    "Increase: the base pushes the mass harder. Beyond some amplitude it crosses to the other well.";
const FASTER_HOVER: &str = "Increase: the pushes follow each other faster and last less long.";

/// All of them, in the order of a scene.
#[rustfmt::skip]
pub static FIELDS: &[FieldInfo] = &[
    field("mass_g", "mass", "g", ((1.0, 50.0, 0.1), Scale::Value), (1e-6, 1e9),
        "Increase: a heavier mass is pushed harder by the same shaking and swings more slowly."),
    field("mechanism.preload_mm", "preload", "mm", ((0.0, 5.0, 0.05), Scale::Preload), (0.0, 1e4),
        "Increase: the flexures are pushed together further. The wells move apart and get deeper, so that it takes more \
         shaking to cross; at 0 there is one well."),
    field("mechanism.thickness_mm", "thickness", "mm", ((0.02, 0.5, 0.005), Scale::Value), LENGTH,
        "Increase: forces grow with the third power of it, and the wells stay where they are."),
    field("mechanism.parallel.length_mm", "parallel flexures, length", "mm", LONG, LENGTH,
        "Increase: the parallel flexures give way more easily: the barrier grows, the wells move apart."),
    field("mechanism.parallel.width_mm", "parallel flexures, width", "mm", WIDE, LENGTH,
        "Increase: the parallel flexures are stiffer, which works against the two wells."),
    field("mechanism.buckling.length_mm", "buckling flexure, length", "mm", LONG, LENGTH,
        "Increase: the buckling flexure bulges more easily and pushes less: the barrier gets lower."),
    field("mechanism.buckling.width_mm", "buckling flexure, width", "mm", WIDE, LENGTH,
        "Increase: the buckling flexure pushes harder: the barrier grows."),
    field("damping.xi", "damping ratio", "", ((0.0, 0.2, 0.001), Scale::Value), (0.0, 100.0),
        "Increase: the motion dies away faster."),
    field("damping.c_n_s_per_m", "damping", "N s/m", ((0.0, 0.2, 0.001), Scale::Value), (0.0, 1e6),
        "Increase: the motion dies away faster."),
    field("stops.travel_limit_mm", "at ±", "mm", STOP, LIMIT, LIMIT_HOVER),
    field("stops.restitution", "restitution", "", UNIT, SHARE, REBOUND_HOVER),
    field("stops.left_mm", "left", "mm", STOP, LIMIT, LIMIT_HOVER),
    field("stops.right_mm", "right", "mm", STOP, LIMIT, LIMIT_HOVER),
    field("stops.restitution_left", "left restitution", "", UNIT, SHARE, REBOUND_HOVER),
    field("stops.restitution_right", "right restitution", "", UNIT, SHARE, REBOUND_HOVER),
    field("excitation.accel_g", "acceleration", "g", ((-2.0, 2.0, 0.01), Scale::Push), G,
        "Increase: the tray is tipped further to the left."),
    field("excitation.frequency_hz", "frequency", "Hz", RATE, HZ, FASTER_HOVER),
    field("excitation.amplitude_g", "amplitude", "g", PUSH, G, SHAKING_HOVER),
    field("excitation.phase_deg", "phase", "°", ((-180.0, 180.0, 15.0), Scale::Fixed), (-1e4, 1e4),
        "Increase: the shaking begins later in its cycle."),
    field("excitation.from_g", "from", "g", ((0.0, 3.0, 0.01), Scale::Push), G,
        "Increase: the ramp begins with harder shaking."),
    field("excitation.to_g", "to", "g", ((0.0, 3.0, 0.01), Scale::Push), G,
        "Increase: the ramp ends with harder shaking."),
    field("excitation.over_s", "over", "s", RAMP, SECONDS, "Increase: the shaking changes more slowly."),
    field("excitation.from_hz", "from", "Hz", ((0.0, 30.0, 0.1), Scale::Rate), BAND,
        "Increase: the sweep begins at a higher frequency."),
    field("excitation.to_hz", "to", "Hz", ((0.0, 30.0, 0.1), Scale::Rate), BAND,
        "Increase: the sweep ends at a higher frequency."),
    field("excitation.rms_g", "RMS", "g", ((0.0, 1.0, 0.01), Scale::Push), (0.0, 1e4), SHAKING_HOVER),
    field("excitation.low_hz", "lowest", "Hz", ((0.0, 50.0, 0.1), Scale::Rate), BAND,
        "Increase: the slow part of the shaking goes."),
    field("excitation.high_hz", "highest", "Hz", ((0.1, 50.0, 0.1), Scale::Rate), HZ,
        "Increase: faster shaking comes in."),
    field("run.duration_s", "run length", "s", ((1.0, 120.0, 1.0), Scale::Value), SECONDS,
        "Increase: what is said of the motion rests on more periods. The second half of the run counts, or what comes after \
         the settling time of the scene."),
];

/// Fields that have no slider: what they are called.
const OTHERS: [(&str, &str, &str); 13] = [
    ("mechanism.young_gpa", "Young's modulus", "GPa"),
    ("mechanism.linear_n_per_m", "linear stiffness", "N/m"),
    ("mechanism.cubic_n_per_m3", "cubic stiffness", "N/m³"),
    ("mechanism.equilibrium_mm", "wells at ±", "mm"),
    ("mechanism.barrier_mj", "barrier", "mJ"),
    ("mechanism.path", "table of the force", ""),
    ("excitation.seed", "seed", ""),
    ("excitation.lines", "lines of the noise", ""),
    ("excitation.path", "record", ""),
    ("start.x_mm", "start, displacement", "mm"),
    ("start.v_m_per_s", "start, velocity", "m/s"),
    ("run.settle_s", "settling time", "s"),
    ("run.tolerance", "tolerance", ""),
];

/// The control of a field; none where it has none.
pub fn info(path: &str) -> Option<&'static FieldInfo> {
    let plain = without_index(path);
    FIELDS.iter().find(|own| own.path == plain)
}

/// A path without the indices of parts of a sum.
fn without_index(path: &str) -> String {
    path.split('.').filter(|part| part.parse::<usize>().is_err()).collect::<Vec<_>>().join(".")
}

/// What a field is called on the screen, and its unit.
pub fn name_and_unit(path: &str) -> (String, &'static str) {
    let plain = without_index(path);
    let known = info(path).map(|own| (own.name, own.unit));
    let other = || OTHERS.iter().find(|own| own.0 == plain).map(|own| (own.1, own.2));
    let Some((name, unit)) = known.or_else(other) else { return (path.to_owned(), "") };
    let name = if plain == "stops.travel_limit_mm" { "stops at ±" } else { name };
    let part = path.split('.').find_map(|part| part.parse::<usize>().ok());
    (part.map_or_else(|| name.to_owned(), |index| format!("{name} of part {}", index + 1)), unit)
}

/// A sentence about a scene, in which each field is called what it is called on the screen.
pub fn in_words(text: &str, scene: &Scene) -> String {
    let mut paths = crate::scene::all_fields(scene);
    // the longer ones first: one may be the beginning of another
    paths.sort_by_key(|path| std::cmp::Reverse(path.len()));
    let mut text = text.to_owned();
    for path in paths.iter().filter(|path| path.contains('.') || *path == "mass_g") {
        if text.contains(path.as_str()) {
            text = text.replace(path.as_str(), &name_and_unit(path).0);
        }
    }
    text
}

impl FieldInfo {
    /// How far the slider goes in a scene: as in the prototype's, where that suits its scales, else by its own.
    pub fn reach(&self, session: &Session) -> Reach {
        let (low, high, step) = self.slider;
        let saved = FieldPath::new(self.path).get(session.editor.saved());
        let scales = &session.model().scales;
        // of the prototype these are 2 g and 20 Hz
        let own = match self.scale {
            Scale::Fixed => None,
            Scale::Value => saved.map(|value| 2.5 * value.abs()),
            Scale::Push => Some(0.15 * high * scales.length / scales.time.powi(2) / STANDARD_GRAVITY),
            Scale::Rate => Some(0.065 * high / (std::f64::consts::TAU * scales.time)),
            Scale::Travel => return travel(session),
            Scale::Preload => return preload(session).unwrap_or(Reach { low, high, step }),
        };
        let fits = saved.is_none_or(|value| (low..=high).contains(&value))
            && match self.scale {
                Scale::Push | Scale::Rate => own.is_none_or(|own| (0.25..=4.0).contains(&(own / high))),
                Scale::Value => saved.is_none_or(|value| value == 0.0 || value.abs() > high / 200.0),
                _ => true,
            };
        let Some(own) = own.filter(|own| !fits && *own > 0.0 && own.is_finite()) else {
            return Reach { low, high, step };
        };
        let high_own = round_up(own.max(1.25 * saved.map_or(0.0, f64::abs)));
        let low_own = if low < 0.0 { -high_own } else { low / high * high_own };
        let step = below(high_own / 200.0);
        Reach { low: (low_own / step).round() * step, high: high_own, step }
    }
}

/// The slider of a stop: from near the middle to beyond the well.
fn travel(session: &Session) -> Reach {
    let (saved, limits) = (session.editor.saved(), [session.remembered_stops(), session.scene().stops]);
    let well = session.model().mechanism.landscape.right_stable().map(|well| well.x.abs() * 1e3);
    let furthest = |stops: &Stops| stops.limits_mm().into_iter().flatten().reduce(f64::max);
    let stops = || furthest(&saved.stops).or_else(|| limits.iter().find_map(furthest));
    let size = well.filter(|mm| *mm > 0.0).or_else(stops).unwrap_or(10.0);
    let step = below(size / 130.0);
    Reach { low: 2.0 * step, high: (0.6 * size / step).round() * 2.0 * step, step }
}

/// The preload that the slider reaches, as a share of the shorter flexure.
const MOST_PRELOAD: f64 = 0.2;

fn preload(session: &Session) -> Option<Reach> {
    let Mechanism::Flexures { parallel, buckling, .. } = &session.scene().mechanism else { return None };
    let most = MOST_PRELOAD * parallel.length_mm.min(buckling.length_mm);
    let step = below(most / 80.0);
    Some(Reach { low: 0.0, high: (most / step).round() * step, step })
}

/// Stops that suit a scene that does not say which: where the prototype has them, in parts of the well's distance.
pub fn suiting_limit(well_mm: Option<f64>) -> f64 {
    match well_mm.filter(|mm| *mm > 0.0 && mm.is_finite()) {
        Some(mm) => format!("{:.1e}", 0.215 * mm).parse().unwrap_or(mm),
        None => 1.5,
    }
}

/// The least number of one or two digits that is not below `value`.
pub fn round_up(value: f64) -> f64 {
    let digits = [1.0, 1.2, 1.5, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    round::round_up(value, &digits)
}

/// 1, 2 or 5 times a power of ten, not above `value`.
pub fn below(value: f64) -> f64 {
    round::round_down(value, &round::ONE_TWO_FIVE)
}

/// The number of six digits: what products of round numbers are meant to be.
pub fn decimal(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

/// Decimals that tell multiples of a step apart.
pub fn decimals(step: f64) -> usize {
    let text = format!("{}", decimal(step));
    text.split_once('.').map_or(0, |(_, after)| after.len()).min(12)
}

/// The most significant digits that a field shows while nobody types in it.
const DIGITS: usize = 7;

/// A number as a field shows it: at least so many decimals, and all digits that it has up to seven.
pub fn shown(value: f64, least: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
    exact(rounded, least)
}

/// The same with every digit that the number has.
pub fn exact(value: f64, least: usize) -> String {
    if value != 0.0 && !(1e-6..1e9).contains(&value.abs()) {
        return format!("{value:e}");
    }
    let text = format!("{}", value + 0.0);
    let own = text.split_once('.').map_or(0, |(_, after)| after.len());
    if own >= least { text } else { format!("{:.least$}", value + 0.0) }
}

/// A number with at least three significant digits, and no more decimals than these take.
pub fn three(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return format!("{}", value + 0.0);
    }
    format!("{value:.0$}", numeric::decimals(size, 3))
}

/// Decimals with which numbers up to `most` have three significant digits.
pub fn decimals_for(most: f64) -> usize {
    if most > 0.0 && most.is_finite() { numeric::decimals(most, 3) } else { 2 }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::app::document::Editor;

    fn session(preset: &str) -> Session {
        Session::new(Editor::open(preset).unwrap(), Arc::new(|| ())).unwrap()
    }

    #[test]
    fn every_field_has_a_name_of_its_own() {
        for preset in crate::scene::PRESETS {
            let scene = crate::scene::Document::load(preset.name).unwrap().scene;
            for path in crate::scene::numeric_fields(&scene) {
                let own = name_and_unit(&path).0;
                let seldom = [
                    "poisson",
                    "initial_bow",
                    "yield",
                    "coefficients",
                    "app.",
                    "count",
                    "stops.",
                    "tolerance",
                ];
                assert!(
                    own != path || seldom.iter().any(|part| path.contains(part)),
                    "{}: {path}",
                    preset.name
                );
            }
        }
        assert_eq!(name_and_unit("excitation.1.amplitude_g"), ("amplitude of part 2".to_owned(), "g"));
        let scene = crate::scene::Document::load("random-shaking").unwrap().scene;
        let text = "excitation.high_hz = 1: must be above excitation.low_hz = 2";
        assert_eq!(in_words(text, &scene), "highest = 1: must be above lowest = 2");
    }

    #[test]
    fn sliders_follow_the_scales_of_the_scene() {
        let reach = |preset: &str, path: &str| info(path).unwrap().reach(&session(preset));
        assert_eq!(reach("first-look", "excitation.amplitude_g"), Reach { low: 0.0, high: 2.0, step: 0.01 });
        assert_eq!(reach("paper", "stops.travel_limit_mm"), Reach { low: 0.1, high: 8.6, step: 0.05 });
        assert_eq!(reach("first-look", "excitation.frequency_hz"), Reach { low: 0.5, high: 20.0, step: 0.1 });
        assert_eq!(reach("duffing", "excitation.amplitude_g"), Reach { low: 0.0, high: 0.07, step: 2e-4 });
        assert_eq!(reach("duffing", "stops.travel_limit_mm"), Reach { low: 10.0, high: 1200.0, step: 5.0 });
        assert_eq!(reach("duffing", "mass_g").high, 3000.0);
        assert_eq!(reach("duffing", "run.duration_s").high, 4000.0);
        // on its slider every number is at a place that a hand can reach
        for preset in crate::scene::PRESETS {
            let session = session(preset.name);
            for field in FIELDS {
                let (own, value) = (field.reach(&session), FieldPath::new(field.path).get(session.scene()));
                assert!(own.low < own.high && own.step > 0.0, "{}: {own:?}", field.path);
                let Some(value) = value else { continue };
                assert!(
                    value <= 1.3 * own.high && (value == 0.0 || value.abs() > own.high / 250.0),
                    "{} {}: {value} {own:?}",
                    preset.name,
                    field.path
                );
            }
        }
    }

    #[test]
    fn numbers_have_the_digits_that_they_have() {
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
        assert_eq!([0.0384, 1.25, 1000.0].map(three), ["0.0384", "1.25", "1000"]);
        assert_eq!(
            (suiting_limit(Some(6.9)), suiting_limit(Some(1000.0)), suiting_limit(None)),
            (1.5, 220.0, 1.5)
        );
    }
}
