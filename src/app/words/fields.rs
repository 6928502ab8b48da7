//! Table of the numeric fields of a scene: name on the screen, unit, limits, range of the slider.

use crate::scene::{Mechanism, Scene};

/// What the range of a slider depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Nothing: every scene has the range of the table.
    Fixed,
    /// The value that the scene was opened with.
    Value,
    /// The acceleration that the mechanism itself gives the mass.
    Push,
    /// The frequency at which the mass swings without a drive.
    Rate,
    /// The distance of the wells, or of the stops if there is none.
    Travel,
    /// The length of the shorter flexure; beyond a quarter of it the stable branch may end.
    Preload,
    /// Powers of ten around the value that the scene was opened with, on a logarithmic slider.
    Ratio,
}

/// A numeric field of a scene and its control.
#[derive(Debug)]
pub struct FieldInfo {
    /// Dotted path in the scene, without the indices of parts of a sum.
    pub path: &'static str,
    /// Name of its control.
    pub name: &'static str,
    /// Its unit; empty for a ratio.
    pub unit: &'static str,
    /// Smallest and largest value and step of the slider, for a scene of the prototype's size.
    pub slider: (f64, f64, f64),
    /// What that range depends on in another scene.
    pub scale: Scale,
    /// Smallest and largest value that may be typed.
    pub typed: (f64, f64),
    /// What happens if it is increased.
    pub hover: &'static str,
}

/// The range of a slider and the step of the arrow keys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    pub low: f64,
    pub high: f64,
    /// The step of the arrow keys; on a logarithmic slider only of the number beside it.
    pub step: f64,
    /// Whether the slider is logarithmic; then `low` is above 0.
    pub ratios: bool,
}

impl Reach {
    /// The range of a linear slider.
    pub const fn even(low: f64, high: f64, step: f64) -> Self {
        Self { low, high, step, ratios: false }
    }
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
const SIZE: (f64, f64) = (0.0, 1e4);
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
const LOAD: ((f64, f64, f64), Scale) = ((1.0, 1e4, 0.1), Scale::Ratio);
const COUPLING: (f64, f64) = (-1e6, 1e6);
const ANY_LOAD: (f64, f64) = (0.0, f64::INFINITY);
const RAMP: ((f64, f64, f64), Scale) = ((1.0, 600.0, 1.0), Scale::Value);

const LIMIT_HOVER: &str = "Increase: the stops move outward. Inside the wells the mass then rests lower on \
                           the hill: it takes more shaking to free it and travels further once it crosses.";
const REBOUND_HOVER: &str =
    "Increase: a rebound keeps more of the speed, so that the mass chatters for longer before it rests.";
const SHAKING_HOVER: &str =
    "Increase: the base pushes the mass harder. Beyond some amplitude it crosses to the other well.";
const LOAD_HOVER: &str = "Increase: the same motion gives more voltage over the load and less current \
                          through it. The power is largest somewhere between a short circuit (0) and an \
                          open one (inf), which take none. Both may be typed.";
const COUPLING_HOVER: &str = "Increase: the same speed gives more voltage, and the load brakes the mass \
                              harder. That is more power at first, and less once the mass crosses no longer.";
const FASTER_HOVER: &str = "Increase: the pushes follow each other faster and last less long.";

/// All fields that have a control, in the order of a scene.
#[rustfmt::skip]
pub static FIELDS: &[FieldInfo] = &[
    field("mass_g", "mass", "g", ((1.0, 50.0, 0.1), Scale::Value), (1e-6, 1e9),
        "Increase: a heavier mass is pushed harder by the same shaking and swings more slowly."),
    field("mechanism.preload_mm", "preload", "mm", ((0.0, 5.0, 0.05), Scale::Preload), (0.0, 1e4),
        "Increase: the flexures are pushed together further. The wells move apart and get deeper, so that it \
         takes more shaking to cross; at 0 there is one well."),
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
    field("mechanism.n_per_m", "spring", "N/m", ((-100.0, 100.0, 1.0), Scale::Value), (-1e6, 1e6),
        "Increase: a stiffer spring draws the mass to the middle: the barrier is lower, the wells move in."),
    field("mechanism.strength_n_mm4", "strength of the magnets", "N mm⁴",
        ((-2e3, 2e3, 1.0), Scale::Value), (-1e9, 1e9),
        "Increase: the magnets attract each other more where they face each other: the barrier gets lower. \
         Below 0 they repel each other, and it gets higher."),
    field("mechanism.gap_mm", "gap of the magnets", "mm", ((0.5, 20.0, 0.1), Scale::Value), LENGTH,
        "Increase: the magnets are further apart. Their force falls with the fourth power of it and reaches \
         further to both sides."),
    field("damping.xi", "damping ratio", "", ((0.0, 0.2, 0.001), Scale::Value), (0.0, 100.0),
        "Increase: the motion dies away faster."),
    field("damping.c_n_s_per_m", "damping", "N s/m", ((0.0, 0.2, 0.001), Scale::Value), (0.0, 1e6),
        "Increase: the motion dies away faster."),
    field("transducer.load_ohm", "load", "ohm", LOAD, ANY_LOAD, LOAD_HOVER),
    field("transducer.load_kohm", "load", "kohm", LOAD, ANY_LOAD, LOAD_HOVER),
    field("transducer.coupling_v_s_per_m", "coupling", "V s/m", ((0.0, 10.0, 0.05), Scale::Value), COUPLING,
        COUPLING_HOVER),
    field("transducer.coupling_n_per_v", "coupling", "N/V", ((0.0, 5e-3, 1e-5), Scale::Value), COUPLING,
        COUPLING_HOVER),
    field("transducer.coil_ohm", "coil", "ohm", ((0.0, 200.0, 1.0), Scale::Value), SIZE,
        "Increase: more of the electrical power becomes heat in the coil, which brakes the mass less."),
    field("transducer.inductance_mh", "inductance", "mH", ((0.0, 200.0, 1.0), Scale::Value), (0.0, 1e9),
        "Increase: the current follows the velocity more slowly, and fast motion gives less of it."),
    field("transducer.capacitance_nf", "capacitance", "nF", ((1.0, 200.0, 1.0), Scale::Value), (1e-6, 1e9),
        "Increase: the same motion charges the layer to a lower voltage, and slow motion loses less of it \
         through the load."),
    field("stops.travel_limit_mm", "travel limit ±", "mm", STOP, LIMIT, LIMIT_HOVER),
    field("stops.restitution", "restitution", "", UNIT, SHARE, REBOUND_HOVER),
    field("stops.left_mm", "left", "mm", STOP, LIMIT, LIMIT_HOVER),
    field("stops.right_mm", "right", "mm", STOP, LIMIT, LIMIT_HOVER),
    field("stops.restitution_left", "left restitution", "", UNIT, SHARE, REBOUND_HOVER),
    field("stops.restitution_right", "right restitution", "", UNIT, SHARE, REBOUND_HOVER),
    field("excitation.accel_g", "acceleration", "g", ((-2.0, 2.0, 0.01), Scale::Push), G,
        "Increase: the tray is tipped further to the left."),
    field("excitation.frequency_hz", "frequency", "Hz", RATE, HZ, FASTER_HOVER),
    field("excitation.amplitude_g", "amplitude", "g", PUSH, SIZE, SHAKING_HOVER),
    field("excitation.phase_deg", "phase", "°", ((-180.0, 180.0, 15.0), Scale::Fixed), (-1e4, 1e4),
        "Increase: the shaking begins later in its cycle."),
    field("excitation.from_g", "from", "g", ((0.0, 3.0, 0.01), Scale::Push), SIZE,
        "Increase: the ramp begins with harder shaking."),
    field("excitation.to_g", "to", "g", ((0.0, 3.0, 0.01), Scale::Push), SIZE,
        "Increase: the ramp ends with harder shaking."),
    field("excitation.over_s", "over", "s", RAMP, SECONDS, "Increase: the shaking changes more slowly."),
    field("excitation.from_hz", "from", "Hz", ((0.0, 30.0, 0.1), Scale::Rate), BAND,
        "Increase: the sweep begins at a higher frequency."),
    field("excitation.to_hz", "to", "Hz", ((0.0, 30.0, 0.1), Scale::Rate), BAND,
        "Increase: the sweep ends at a higher frequency."),
    field("excitation.rms_g", "RMS", "g", ((0.0, 1.0, 0.01), Scale::Push), SIZE, SHAKING_HOVER),
    field("excitation.low_hz", "lowest", "Hz", ((0.0, 50.0, 0.1), Scale::Rate), BAND,
        "Increase: the slow part of the shaking goes."),
    field("excitation.high_hz", "highest", "Hz", ((0.1, 50.0, 0.1), Scale::Rate), HZ,
        "Increase: faster shaking comes in."),
    field("start.x_mm", "start, displacement", "mm", ((-8.0, 8.0, 0.05), Scale::Value), (-1e6, 1e6),
        "Increase: the mass begins further to the right. The motion begins again."),
    field("start.v_m_per_s", "start, velocity", "m/s", ((-1.0, 1.0, 0.005), Scale::Value), (-1e4, 1e4),
        "Increase: the mass begins faster to the right; below 0, to the left. The motion begins again."),
    field("run.duration_s", "run length", "s", ((1.0, 120.0, 1.0), Scale::Value), SECONDS,
        "Increase: what is said of the motion rests on more periods. The second half of the run counts, or \
         what comes after the settling time of the scene."),
];

/// Path, name and unit of fields that have no control.
const WITHOUT_CONTROL: &[(&str, &str, &str)] = &[
    ("mechanism.young_gpa", "Young's modulus", "GPa"),
    ("mechanism.linear_n_per_m", "linear stiffness", "N/m"),
    ("mechanism.cubic_n_per_m3", "cubic stiffness", "N/m³"),
    ("mechanism.equilibrium_mm", "wells at ±", "mm"),
    ("mechanism.barrier_mj", "barrier", "mJ"),
    ("mechanism.path", "table of the force", ""),
    ("excitation.seed", "seed", ""),
    ("excitation.lines", "lines of the noise", ""),
    ("excitation.path", "record", ""),
    ("start.electrical", "start, current or voltage", ""),
    ("run.settle_s", "settling time", "s"),
    ("run.tolerance", "tolerance", ""),
];

pub fn mechanism_name(mechanism: &Mechanism) -> String {
    match mechanism {
        Mechanism::Flexures { .. } => "flexures".to_owned(),
        Mechanism::Cubic { .. } => "cubic".to_owned(),
        Mechanism::DoubleWell { .. } => "double well".to_owned(),
        Mechanism::Polynomial { coefficients_si } => format!("polynomial of {}", coefficients_si.len()),
        Mechanism::Table { path, .. } => path.clone(),
        Mechanism::Linear { .. } => "spring".to_owned(),
        Mechanism::Magnet { .. } => "magnet".to_owned(),
        Mechanism::Sum(parts) => parts.iter().map(mechanism_name).collect::<Vec<_>>().join(" + "),
    }
}

/// The control of a field; `None` if it has none.
pub fn info(path: &str) -> Option<&'static FieldInfo> {
    let plain = without_index(path);
    FIELDS.iter().find(|field| field.path == plain)
}

/// A path without the indices of parts of a sum.
fn without_index(path: &str) -> String {
    path.split('.').filter(|part| part.parse::<usize>().is_err()).collect::<Vec<_>>().join(".")
}

/// Name of a field on the screen, and its unit.
pub fn name_and_unit(path: &str) -> (String, &'static str) {
    let plain = without_index(path);
    let known = info(path).map(|field| (field.name, field.unit));
    let other = || WITHOUT_CONTROL.iter().find(|row| row.0 == plain).map(|row| (row.1, row.2));
    let Some((name, unit)) = known.or_else(other) else { return (path.to_owned(), "") };
    let part = path.split('.').find_map(|part| part.parse::<usize>().ok());
    (part.map_or_else(|| name.to_owned(), |index| format!("{name} of part {}", index + 1)), unit)
}

/// A sentence about a scene, with the paths of fields replaced by their names on the screen.
pub fn in_words(text: &str, scene: &Scene) -> String {
    let mut paths = crate::scene::all_fields(scene);
    // longer paths first: one path may be the beginning of another
    paths.sort_by_key(|path| std::cmp::Reverse(path.len()));
    let mut text = text.to_owned();
    for path in paths.iter().filter(|path| path.contains('.') || *path == "mass_g") {
        if text.contains(path.as_str()) {
            text = text.replace(path.as_str(), &name_and_unit(path).0);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_a_name_of_its_own() {
        for preset in crate::scene::PRESETS {
            let scene = crate::scene::Document::load(preset.name).unwrap().scene;
            for path in crate::scene::numeric_fields(&scene) {
                let name = name_and_unit(&path).0;
                let unnamed = [
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
                    name != path || unnamed.iter().any(|part| path.contains(part)),
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
}
