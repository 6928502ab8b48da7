//! Valid ranges of the numbers in a scene, with a remedy for each.
//!
//! There is one row per field. The field's documentation repeats the range; a test compares them.

use std::fmt;

/// Largest number of coefficients of a `Polynomial`, the limit of the force curve.
pub const MAX_COEFFICIENTS: usize = 16;

/// Smallest and largest tolerance of a run.
pub const TOLERANCES: (f64, f64) = (1e-14, 1e-3);

/// A closed range; NaN is never inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub low: f64,
    pub high: f64,
    /// Only whole numbers are valid.
    pub whole: bool,
}

impl Range {
    pub(super) fn contains(&self, value: f64) -> bool {
        self.low <= value && value <= self.high && (!self.whole || value.fract() == 0.0)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.whole {
            write!(f, "whole, {} to {}", self.low, self.high)
        } else {
            write!(f, "{} to {}", number_text(self.low), number_text(self.high))
        }
    }
}

/// A number in plain digits if they are few, otherwise with an exponent. It parses back to the same double.
pub(crate) fn number_text(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() || (1e-4..1e6).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// Specification of a numeric field.
#[derive(Debug)]
pub(super) struct Spec {
    /// Last part of its path; for a list the name of the list.
    pub name: &'static str,
    pub range: Range,
    /// Advice for a value outside the range, as a clause.
    pub remedy: &'static str,
}

const fn spec(name: &'static str, low: f64, high: f64, remedy: &'static str) -> Spec {
    Spec { name, range: Range { low, high, whole: false }, remedy }
}

const fn whole(spec: Spec) -> Spec {
    Spec { range: Range { whole: true, ..spec.range }, ..spec }
}

const LENGTH: (f64, f64) = (1e-15, 1e15);
const MODULUS: (f64, f64) = (1e-60, 1e60);
const COEFFICIENT: (f64, f64) = (-1e200, 1e200);
const ACCELERATION: (f64, f64) = (-1e30, 1e30);

macro_rules! specs {
    ($($constant:ident = $($kind:ident)? $name:literal, $low:expr, $high:expr, $remedy:literal;)*) => {
        $(pub(super) static $constant: Spec = specs!(@ $($kind)? spec($name, $low, $high, $remedy));)*
        /// All rows, for the test that compares them with the documentation.
        #[cfg(test)]
        pub(super) static ALL: &[&Spec] = &[$(&$constant),*];
    };
    (@ $spec:expr) => { $spec };
    (@ whole $spec:expr) => { whole($spec) };
}

specs! {
    MASS = "mass_g", 1e-15, 1e15, "give the proof mass in grams, such as 15.2";
    PRELOAD = "preload_mm", 0.0, LENGTH.1, "give the shortening of the flexures in mm, such as 2.7; 0 makes \
                                            one well";
    THICKNESS = "thickness_mm", LENGTH.0, LENGTH.1, "give the thickness of the flexures in mm, such as 0.1";
    YOUNG = "young_gpa", MODULUS.0, MODULUS.1, "give Young's modulus in GPa, such as 190 for spring steel";
    COUNT = whole "count", 1.0, 64.0, "give the number of flexures side by side";
    FLEXURE_LENGTH = "length_mm", LENGTH.0, LENGTH.1, "give the length of each flexure in mm, such as 26";
    WIDTH = "width_mm", LENGTH.0, LENGTH.1, "give the width of each flexure in mm, such as 20";
    POISSON = "poisson", 0.0, 0.49, "metals have some 0.3";
    BOW = "initial_bow_mm", 0.0, LENGTH.1, "give the bow in mm, such as 0.05; 0 is a straight flexure";
    YIELD = "yield_gpa", MODULUS.0, MODULUS.1, "give the bending stress that is allowed in GPa, such as 2";
    LINEAR = "linear_n_per_m", COEFFICIENT.0, COEFFICIENT.1, "give a finite stiffness in N/m; negative makes \
        two wells";
    CUBIC = "cubic_n_per_m3", COEFFICIENT.0, COEFFICIENT.1, "give a finite stiffness in N/m^3; positive \
        makes two wells";
    EQUILIBRIUM = "equilibrium_mm", LENGTH.0, LENGTH.1, "give the distance of the wells from the middle in \
        mm, such as 7";
    BARRIER = "barrier_mj", 1e-60, 1e60, "give the height of the barrier in mJ, such as 0.5";
    COEFFICIENTS = "coefficients_si", COEFFICIENT.0, COEFFICIENT.1, "give finite coefficients in N/m^i; \
        zeros are fine";
    TABLE_TOLERANCE = "tolerance", 1e-10, 1e-1, "1e-4 of the force maximum suits measured data";
    STIFFNESS = "n_per_m", COEFFICIENT.0, COEFFICIENT.1, "give a finite stiffness in N/m, such as 30";
    STRENGTH = "strength_n_mm4", -1e60, 1e60, "give the strength in N mm^4, such as 2000; below 0 the \
        magnets repel, 0 is no magnet";
    GAP = "gap_mm", LENGTH.0, LENGTH.1, "give the distance of the magnets where they face each other in mm, \
        such as 5";
    XI = "xi", 0.0, 1e6, "give a ratio, such as 0.023 for 2.3 %; `None` or 0 is no damping";
    C = "c_n_s_per_m", 0.0, 1e30, "give a damping coefficient in N s/m; `None` or 0 is no damping";
    TRAVEL_LIMIT = "travel_limit_mm", LENGTH.0, LENGTH.1,
        "stops need room between them: give their distance from x = 0 in mm, or `stops: None` for none";
    RESTITUTION = "restitution", 0.0, 1.0, "0 keeps no speed at an impact, 1 keeps all of it";
    LEFT = "left_mm", LENGTH.0, LENGTH.1,
        "give the distance of the left stop from x = 0 as a positive number in mm, or leave it out for an \
         open side";
    RIGHT = "right_mm", LENGTH.0, LENGTH.1,
        "give the distance of the right stop from x = 0 as a positive number in mm, or leave it out for an \
         open side";
    RESTITUTION_LEFT = "restitution_left", 0.0, 1.0, "0 keeps no speed at an impact, 1 keeps all of it";
    RESTITUTION_RIGHT = "restitution_right", 0.0, 1.0, "0 keeps no speed at an impact, 1 keeps all of it";
    CONTACT_STIFFNESS = "stiffness_n_per_m1_5", MODULUS.0, MODULUS.1,
        "give the stiffness of the contact in N/m^1.5, such as 3.7e9, or leave it out and give radius_mm and \
         young_gpa";
    LOSS = "loss_s_per_m", 0.0, 1e30, "give the loss of the contact in s/m, such as 10.4; 0 is an elastic \
                                       contact; check says which gives a restitution";
    RADIUS = "radius_mm", LENGTH.0, LENGTH.1, "give the radius of the crossed cylinders in mm, such as 5";
    CONTACT_YOUNG = "young_gpa", MODULUS.0, MODULUS.1, "give Young's modulus in GPa, such as 69 for \
        aluminium";
    CONTACT_YIELD = "yield_gpa", MODULUS.0, MODULUS.1, "give the yield strength in GPa, such as 0.276";
    COUPLING_V = "coupling_v_s_per_m", -1e30, 1e30,
        "give the coupling in V s/m (the same number in N/A), such as 5";
    COIL = "coil_ohm", 0.0, 1e30, "give the resistance of the coil in ohm, such as 40";
    LOAD_OHM = "load_ohm", 0.0, f64::INFINITY,
        "give the resistance of the load in ohm; 0 is a short circuit, inf an open one";
    INDUCTANCE = "inductance_mh", 0.0, 1e30, "give the inductance of the coil in mH; 0 makes it a damping";
    COUPLING_N = "coupling_n_per_v", -1e30, 1e30,
        "give the coupling in N/V (the same number in A s/m), such as 1e-3";
    CAPACITANCE = "capacitance_nf", 1e-30, 1e30, "give the capacitance in nF, such as 40";
    LOAD_KOHM = "load_kohm", 0.0, f64::INFINITY,
        "give the resistance of the load in kohm; 0 is a short circuit, inf an open one";
    ACCEL = "accel_g", ACCELERATION.0, ACCELERATION.1, "give an acceleration in g, of either sign";
    FREQUENCY = "frequency_hz", 1e-15, 1e15,
        "give a frequency in Hz, such as 3; use `Constant` for a steady acceleration";
    AMPLITUDE = "amplitude_g", ACCELERATION.0, ACCELERATION.1, "give an amplitude in g, of either sign or 0";
    PHASE = "phase_deg", -1e15, 1e15, "give a phase in degrees";
    FROM_G = "from_g", ACCELERATION.0, ACCELERATION.1, "give an amplitude in g, of either sign or 0";
    TO_G = "to_g", ACCELERATION.0, ACCELERATION.1, "give an amplitude in g, of either sign or 0";
    OVER = "over_s", 1e-15, 1e15, "give the length of the ramp in s; use `Sine` for an amplitude that stays";
    FROM_HZ = "from_hz", 0.0, 1e15, "give the frequency at the beginning in Hz, such as 1";
    TO_HZ = "to_hz", 0.0, 1e15, "give the frequency at the end in Hz, such as 10";
    RMS = "rms_g", 0.0, ACCELERATION.1, "give a root mean square in g, such as 0.5";
    LOW_HZ = "low_hz", 0.0, 1e15, "give the lower end of the band in Hz, such as 1";
    HIGH_HZ = "high_hz", 1e-15, 1e15, "give the upper end of the band in Hz, such as 10";
    SEED = whole "seed", 0.0, 9_007_199_254_740_992.0, "give a whole number; another one gives another noise \
        of the same kind";
    LINES = whole "lines", 1.0, 4096.0, "256 sines look like noise for some minutes";
    X = "x_mm", -1e15, 1e15, "give a displacement in mm";
    V = "v_m_per_s", -1e30, 1e30, "give a velocity in m/s";
    ELECTRICAL = "electrical", -1e30, 1e30,
        "give the current of a coil in A, the voltage of a piezoelectric layer in V";
    DURATION = "duration_s", 1e-15, 1e9, "give how long to run in s, such as 10";
    SETTLE = "settle_s", 0.0, 1e9, "give when the settled window begins in s, or leave it out for half the \
                                    duration";
    TOLERANCE = "tolerance", TOLERANCES.0, TOLERANCES.1, "1e-9 suits most runs and 1e-6 most maps";
    FROM = "from", COEFFICIENT.0, COEFFICIENT.1, "give the first value of the axis";
    TO = "to", COEFFICIENT.0, COEFFICIENT.1, "give the last value of the axis";
    STEP = "step", 1e-200, 1e200, "an axis goes upwards in steps above 0";
    VALUES = "values", COEFFICIENT.0, f64::INFINITY, "give the values of the axis, in the field's unit";
    SPEED = "speed", 1e-15, 1000.0, "1 is real time, 0.1 a tenth of it";
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every numeric field carries, in its documentation, a range that is checked for a field of that name.
    #[test]
    fn documented_ranges_are_the_checked_ones() {
        let source = concat!(include_str!("data.rs"), include_str!("mechanism.rs"), include_str!("stops.rs"));
        let source = format!("{source}{}", include_str!("transducer.rs"));
        let mut doc = String::new();
        let mut seen = Vec::new();
        for line in source.lines().map(str::trim) {
            if let Some(text) = line.strip_prefix("///") {
                doc.push_str(text);
                continue;
            }
            if line.starts_with("#[") {
                continue;
            }
            let numeric = [": f64,", ": u64,", ": Option<f64>,", ": Vec<f64>,", "Ratio(f64),"];
            if numeric.iter().any(|ending| line.ends_with(ending)) {
                let name = line.trim_start_matches("pub ").split(':').next().unwrap_or_default();
                let name = if name == "Ratio(f64)," { "xi" } else { name };
                let known: Vec<_> = ALL.iter().filter(|spec| spec.name == name).collect();
                let stated = known.iter().find(|spec| doc.contains(&spec.range.to_string()));
                let stated = stated.unwrap_or_else(|| panic!("{name}: `{doc}` states none of {known:?}"));
                seen.push((name.to_owned(), stated.range.to_string()));
            }
            doc.clear();
        }
        for spec in ALL {
            let row = (spec.name.to_owned(), spec.range.to_string());
            assert!(seen.contains(&row), "no field documents {row:?}");
        }
    }

    #[test]
    fn ends_are_inside_and_nan_is_not() {
        for spec in ALL {
            let Range { low, high, .. } = spec.range;
            assert!(spec.range.contains(low) && spec.range.contains(high));
            // nothing lies beyond an infinite end
            let above = [f64::INFINITY, high.next_up()].into_iter().filter(|above| *above > high);
            for outside in [f64::NAN, f64::NEG_INFINITY, low.next_down()].into_iter().chain(above) {
                assert!(!spec.range.contains(outside), "{} takes {outside}", spec.name);
            }
        }
    }
}
