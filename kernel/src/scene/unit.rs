//! Units in the names of measured columns, and their conversion to SI.

use serde::{Deserialize, Serialize};

/// Standard gravity in m/s^2.
pub const STANDARD_GRAVITY: f64 = 9.80665;

/// Physical quantity of a measured column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// Time, s.
    Time,
    /// Displacement, or position in a quasi-static test, m.
    Displacement,
    /// Velocity, m/s.
    Velocity,
    /// Acceleration, m/s^2.
    Acceleration,
    /// Force, N.
    Force,
}

impl Quantity {
    /// Its name, the ending of a column's name for its SI unit, and the beginning of one.
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Time => ["time", "_s", "t"],
            Self::Displacement => ["displacement", "_m", "x"],
            Self::Velocity => ["velocity", "_m_per_s", "v"],
            Self::Acceleration => ["acceleration", "_m_per_s2", "accel"],
            Self::Force => ["force", "_n", "force"],
        }
    }

    /// Name of the quantity.
    pub fn name(self) -> &'static str {
        self.words()[0]
    }

    /// The ending of a column's name for its SI unit.
    pub fn ending(self) -> &'static str {
        self.words()[1]
    }

    /// An example of a column's name for the quantity in its SI unit.
    pub(super) fn example(self) -> String {
        self.words()[2].to_owned() + self.ending()
    }

    /// The known units of the quantity, separated by commas.
    pub fn units(self) -> String {
        let known = UNITS.iter().filter(|unit| unit.quantity == self && unit.listed);
        known.map(|unit| unit.word).collect::<Vec<_>>().join(", ")
    }
}

/// A unit of measurement.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Quantity that it measures.
    pub quantity: Quantity,
    word: &'static str,
    /// Numerator of its size in SI, an exact double.
    times: f64,
    /// Denominator of its size in SI, an exact double.
    over: f64,
    /// Whether messages list it; other spellings of the same unit are not listed.
    listed: bool,
}

const fn unit(word: &'static str, quantity: Quantity, times: f64, over: f64) -> Unit {
    Unit { quantity, word, times, over, listed: true }
}

const fn alias(word: &'static str, quantity: Quantity, times: f64, over: f64) -> Unit {
    Unit { quantity, word, times, over, listed: false }
}

/// The known units with all spellings. Upper and lower case are different spellings.
const UNITS: [Unit; 30] = [
    unit("s", Quantity::Time, 1.0, 1.0),
    unit("ms", Quantity::Time, 1.0, 1e3),
    unit("us", Quantity::Time, 1.0, 1e6),
    alias("\u{b5}s", Quantity::Time, 1.0, 1e6),
    unit("m", Quantity::Displacement, 1.0, 1.0),
    unit("cm", Quantity::Displacement, 1.0, 1e2),
    unit("mm", Quantity::Displacement, 1.0, 1e3),
    unit("um", Quantity::Displacement, 1.0, 1e6),
    alias("\u{b5}m", Quantity::Displacement, 1.0, 1e6),
    unit("m/s", Quantity::Velocity, 1.0, 1.0),
    alias("m_per_s", Quantity::Velocity, 1.0, 1.0),
    unit("mm/s", Quantity::Velocity, 1.0, 1e3),
    alias("mm_per_s", Quantity::Velocity, 1.0, 1e3),
    unit("m/s2", Quantity::Acceleration, 1.0, 1.0),
    alias("m/s^2", Quantity::Acceleration, 1.0, 1.0),
    alias("m/s\u{b2}", Quantity::Acceleration, 1.0, 1.0),
    alias("m_per_s2", Quantity::Acceleration, 1.0, 1.0),
    unit("mm/s2", Quantity::Acceleration, 1.0, 1e3),
    alias("mm/s^2", Quantity::Acceleration, 1.0, 1e3),
    alias("mm/s\u{b2}", Quantity::Acceleration, 1.0, 1e3),
    alias("mm_per_s2", Quantity::Acceleration, 1.0, 1e3),
    unit("g", Quantity::Acceleration, STANDARD_GRAVITY, 1.0),
    unit("mg", Quantity::Acceleration, STANDARD_GRAVITY, 1e3),
    unit("N", Quantity::Force, 1.0, 1.0),
    alias("n", Quantity::Force, 1.0, 1.0),
    unit("mN", Quantity::Force, 1.0, 1e3),
    alias("mn", Quantity::Force, 1.0, 1e3),
    alias("\u{3bc}N", Quantity::Force, 1.0, 1e6),
    unit("uN", Quantity::Force, 1.0, 1e6),
    unit("kN", Quantity::Force, 1e3, 1.0),
];

impl Unit {
    /// The units of a quantity, each in one spelling.
    pub fn all(quantity: Quantity) -> impl Iterator<Item = Self> {
        UNITS.into_iter().filter(move |unit| unit.quantity == quantity && unit.listed)
    }

    /// The spelling of the unit.
    pub fn word(self) -> &'static str {
        self.word
    }

    /// The unit of `quantity` with the spelling `word`.
    pub fn of_word(word: &str, quantity: Quantity) -> Option<Self> {
        UNITS.into_iter().find(|unit| unit.word == word && unit.quantity == quantity)
    }

    /// The unit at the end of a column's name, as in `x_mm`, `x [mm]`, `x (mm)` or `x, mm`.
    pub fn of_name(name: &str) -> Option<Self> {
        let ends = |word: &str| {
            let rest = |end: &str, before: &[&str]| {
                let rest = name.strip_suffix(end).and_then(|rest| rest.strip_suffix(word));
                // the m in `stiffness_n_per_m` is only a part of the unit
                let whole = |rest: &&str| !rest.trim_end_matches('_').ends_with("_per");
                rest.filter(whole).is_some_and(|rest| before.iter().any(|mark| rest.ends_with(mark)))
            };
            rest("", &["_", ", "]) || rest("]", &["["]) || rest(")", &["("])
        };
        UNITS.into_iter().filter(|unit| ends(unit.word)).max_by_key(|unit| unit.word.len())
    }

    /// Converts a value in this unit to SI.
    pub fn si(self, value: f64) -> f64 {
        value * self.times / self.over
    }
}

/// Endings of names with their units, the longest first: `_m_per_s2` also ends like a name in seconds.
const ENDINGS: [(&str, &str); 29] = [
    ("_m_per_s2", "m/s\u{b2}"),
    ("_m_per_s", "m/s"),
    ("_n_per_m3", "N/m\u{b3}"),
    ("_n_per_m", "N/m"),
    ("_n_per_m1_5", "N/m^1.5"),
    ("_n_s_per_m", "N s/m"),
    ("_v_s_per_m", "V s/m"),
    ("_s_per_m", "s/m"),
    ("_n_per_v", "N/V"),
    ("_n_mm4", "N mm\u{2074}"),
    ("_rad_per_s", "rad/s"),
    ("_per_s", "1/s"),
    ("_kohm", "kohm"),
    ("_ohm", "ohm"),
    ("_mh", "mH"),
    ("_nf", "nF"),
    ("_gpa", "GPa"),
    ("_pa", "Pa"),
    ("_deg", "\u{b0}"),
    ("_mm", "mm"),
    ("_mj", "mJ"),
    ("_hz", "Hz"),
    ("_g", "g"),
    ("_j", "J"),
    ("_m", "m"),
    ("_n", "N"),
    ("_v", "V"),
    ("_w", "W"),
    ("_s", "s"),
];

/// The ending of the name of a field or column that says its unit, and the unit as a person writes it.
#[doc(hidden)]
pub fn unit_ending(name: &str) -> Option<(&'static str, &'static str)> {
    ENDINGS.into_iter().find(|(ending, _)| name.ends_with(ending))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_of_a_name_gives_its_unit() {
        for (name, quantity, one) in [
            ("t_s", Quantity::Time, 1.0),
            ("Time (ms)", Quantity::Time, 1e-3),
            ("x_m", Quantity::Displacement, 1.0),
            ("laser [mm]", Quantity::Displacement, 1e-3),
            ("displacement, mm", Quantity::Displacement, 1e-3),
            ("v_m_per_s", Quantity::Velocity, 1.0),
            ("base_accel_m_per_s2", Quantity::Acceleration, 1.0),
            ("a_mm_per_s2", Quantity::Acceleration, 1e-3),
            ("a_g", Quantity::Acceleration, 9.80665),
            ("force_n", Quantity::Force, 1.0),
            ("F (mN)", Quantity::Force, 1e-3),
        ] {
            let unit = Unit::of_name(name).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((unit.quantity, unit.si(1.0)), (quantity, one), "{name}");
        }
        for name in ["t", "phase", "Position", "x m", "F_MN", "force_kgf", "stiffness_n_per_m", ""] {
            assert_eq!(Unit::of_name(name), None, "{name}");
        }
        // rounded correctly from the decimal
        assert_eq!(Unit::of_name("x_mm").unwrap().si(0.3), 3e-4);
    }
}
