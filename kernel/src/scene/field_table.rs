//! Table of the numeric fields of a scene: the range of each with the remedy for a value outside it, its name
//! on the screen, its control in the window, and its place among the axes of a map.
//!
//! Checks, `--set`, `--over`, the window and the tests of the documentation all read this table.

use std::fmt;

use super::unit::unit_ending;
use crate::numeric::number_text;

/// Largest number of coefficients of a `Polynomial`, the limit of the force curve.
pub const MAX_COEFFICIENTS: usize = 16;

/// Smallest and largest tolerance of a run.
pub const TOLERANCES: (f64, f64) = (1e-14, 1e-3);

/// A closed range; NaN is never inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Smallest valid value.
    pub low: f64,
    /// Largest valid value.
    pub high: f64,
    /// Only whole numbers are valid.
    pub whole: bool,
}

impl Range {
    /// Whether a value is valid.
    pub fn contains(&self, value: f64) -> bool {
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

/// The quantity that the range of a slider depends on.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Nothing: every scene has the range of the table.
    Fixed,
    /// The value that the scene was opened with.
    Value,
    /// The acceleration that the mechanism itself gives the mass.
    Push,
    /// The force that the mechanism itself has on the mass.
    Force,
    /// The frequency at which the mass swings without a drive.
    Rate,
    /// The distance of the wells, or of the stops if there is none.
    Travel,
    /// The length of the shorter flexure; beyond a quarter of it the stable branch may end.
    Preload,
    /// Powers of ten around the value that the scene was opened with, on a logarithmic slider.
    Ratio,
}

/// The control of a field in the window.
#[doc(hidden)]
#[derive(Debug)]
pub struct Control {
    /// Path of the field.
    pub path: &'static str,
    /// Smallest and largest value and step of the slider, for a scene of the prototype's size.
    pub slider: (f64, f64, f64),
    /// The quantity that this range depends on in another scene.
    pub scale: Scale,
    /// Smallest and largest value that may be typed.
    pub typed: (f64, f64),
    /// The effect of an increase, shown under the pointer.
    pub hover: &'static str,
}

/// A numeric field of a scene.
///
/// [`FIELDS`] lists them, and [`field_info`] finds that of a path.
#[derive(Debug)]
pub struct FieldInfo {
    /// Dotted path in the scene, without the indices of parts of a sum and of elements of a list.
    pub path: &'static str,
    /// Its valid values.
    pub range: Range,
    /// Advice for a value outside the range, as a clause.
    pub remedy: &'static str,
    /// Its name on the screen; without one the path is shown.
    #[doc(hidden)]
    pub name: Option<&'static str>,
    /// Its control in the window, if it has one.
    #[doc(hidden)]
    pub control: Option<Control>,
    /// Its place among the fields that are offered as axes of a map, if it is offered.
    #[doc(hidden)]
    pub axis: Option<u8>,
}

impl FieldInfo {
    /// Its unit on the screen, by the end of its path; empty for a ratio.
    pub fn unit(&self) -> &'static str {
        unit_ending(&self.path.replace('.', "_")).map_or("", |(_, unit)| unit)
    }

    const fn whole(mut self) -> Self {
        self.range.whole = true;
        self
    }

    const fn named(mut self, name: &'static str) -> Self {
        self.name = Some(name);
        self
    }

    const fn axis(mut self, place: u8) -> Self {
        self.axis = Some(place);
        self
    }

    const fn control(
        mut self,
        name: &'static str,
        (slider, scale): ((f64, f64, f64), Scale),
        typed: (f64, f64),
        hover: &'static str,
    ) -> Self {
        self.control = Some(Control { path: self.path, slider, scale, typed, hover });
        self.named(name)
    }
}

const fn field(path: &'static str, (low, high): (f64, f64), remedy: &'static str) -> FieldInfo {
    let range = Range { low, high, whole: false };
    FieldInfo { path, range, remedy, name: None, control: None, axis: None }
}

/// The row of a path that may have indices.
pub fn field_info(path: &str) -> Option<&'static FieldInfo> {
    let plain = without_indices(path);
    FIELDS.iter().find(|field| field.path == plain)
}

/// A path without the indices of parts of a sum and of elements of a list.
#[doc(hidden)]
pub fn without_indices(path: &str) -> String {
    path.split('.').filter(|part| part.parse::<usize>().is_err()).collect::<Vec<_>>().join(".")
}

/// The row of a path without indices. In a constant, the build fails if there is none.
pub(super) const fn row(path: &str) -> &'static FieldInfo {
    let mut i = 0;
    while i < FIELDS.len() {
        if is_equal(FIELDS[i].path.as_bytes(), path.as_bytes()) {
            return &FIELDS[i];
        }
        i += 1;
    }
    panic!("a number has no row in the table of fields")
}

const fn is_equal(a: &[u8], b: &[u8]) -> bool {
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

const POSITIVE: (f64, f64) = (1e-15, 1e15);
const PLACE: (f64, f64) = (-1e15, 1e15);
const MODULUS: (f64, f64) = (1e-60, 1e60);
const COEFFICIENT: (f64, f64) = (-1e200, 1e200);
const ACCELERATION: (f64, f64) = (-1e30, 1e30);
const BAND: (f64, f64) = (0.0, 1e15);
const LOAD: (f64, f64) = (0.0, f64::INFINITY);
const NOT_NEGATIVE: (f64, f64) = (0.0, 1e30);
const SHARE: (f64, f64) = (0.0, 1.0);

// The values that may be typed.
const TYPED_G: (f64, f64) = (-1e4, 1e4);
const TYPED_SIZE: (f64, f64) = (0.0, 1e4);
const TYPED_HZ: (f64, f64) = (1e-2, 1e5);
const TYPED_BAND: (f64, f64) = (0.0, 1e5);
const TYPED_LENGTH: (f64, f64) = (1e-3, 1e4);
const TYPED_LIMIT: (f64, f64) = (1e-3, 1e6);
const TYPED_PLACE: (f64, f64) = (-1e6, 1e6);
const TYPED_SECONDS: (f64, f64) = (0.01, 1e6);
const TYPED_COUPLING: (f64, f64) = (-1e6, 1e6);

type Slider = ((f64, f64, f64), Scale);

const PUSH: Slider = ((0.0, 2.0, 0.01), Scale::Push);
const RAMP_PUSH: Slider = ((0.0, 3.0, 0.01), Scale::Push);
const RATE: Slider = ((0.5, 20.0, 0.1), Scale::Rate);
const CHIRP_RATE: Slider = ((0.0, 30.0, 0.1), Scale::Rate);
const STOP: Slider = ((0.1, 8.0, 0.05), Scale::Travel);
const ZERO_TO_ONE: Slider = ((0.0, 1.0, 0.01), Scale::Fixed);
const LONG: Slider = ((10.0, 60.0, 0.1), Scale::Value);
const WIDE: Slider = ((1.0, 60.0, 0.1), Scale::Value);
const DAMPING: Slider = ((0.0, 0.2, 0.001), Scale::Value);
const DECADES: Slider = ((1.0, 1e4, 0.1), Scale::Ratio);

const LENGTH_REMEDY: &str = "give the length of each flexure in mm, such as 26";
const WIDTH_REMEDY: &str = "give the width of each flexure in mm, such as 20";
const POISSON_REMEDY: &str = "about 0.3 for metals";
const REBOUND_REMEDY: &str = "0 keeps no speed at an impact, 1 keeps all of it";
const AMPLITUDE_REMEDY: &str = "give an amplitude in g, of either sign or 0";

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
                              harder. That is more power at first, and less once the mass no longer crosses.";
const DAMPING_HOVER: &str = "Increase: the motion dies away faster.";

/// All numeric fields, in the order of a scene.
#[rustfmt::skip]
pub const FIELDS: &[FieldInfo] = &[
    field("mass_g", POSITIVE, "give the proof mass in grams, such as 15.2")
        .control("mass", ((1.0, 50.0, 0.1), Scale::Value), (1e-6, 1e9),
            "Increase: a heavier mass is pushed harder by the same shaking and swings more slowly.")
        .axis(7),
    field("mechanism.preload_mm", (0.0, 1e15),
            "give the shortening of the flexures in mm, such as 2.7; 0 makes one well")
        .control("preload", ((0.0, 5.0, 0.05), Scale::Preload), TYPED_SIZE,
            "Increase: the flexures are pushed together further. The wells move apart and get deeper, so \
             that it takes more shaking to cross; at 0 there is one well.")
        .axis(6),
    field("mechanism.thickness_mm", POSITIVE, "give the thickness of the flexures in mm, such as 0.1")
        .control("thickness", ((0.02, 0.5, 0.005), Scale::Value), TYPED_LENGTH,
            "Increase: forces grow with the third power of it, and the wells stay where they are.")
        .axis(14),
    field("mechanism.young_gpa", MODULUS, "give Young's modulus in GPa, such as 190 for spring steel")
        .named("Young's modulus").axis(23),
    field("mechanism.parallel.count", (1.0, 64.0), "give the number of flexures side by side").whole(),
    field("mechanism.parallel.length_mm", POSITIVE, LENGTH_REMEDY)
        .control("parallel flexures, length", LONG, TYPED_LENGTH,
            "Increase: the parallel flexures give way more easily: the barrier grows, the wells move apart.")
        .axis(19),
    field("mechanism.parallel.width_mm", POSITIVE, WIDTH_REMEDY)
        .control("parallel flexures, width", WIDE, TYPED_LENGTH,
            "Increase: the parallel flexures are stiffer, which works against the two wells.")
        .axis(20),
    field("mechanism.buckling.count", (1.0, 64.0), "give the number of flexures side by side").whole(),
    field("mechanism.buckling.length_mm", POSITIVE, LENGTH_REMEDY)
        .control("buckling flexure, length", LONG, TYPED_LENGTH,
            "Increase: the buckling flexure bulges more easily and pushes less: the barrier gets lower.")
        .axis(21),
    field("mechanism.buckling.width_mm", POSITIVE, WIDTH_REMEDY)
        .control("buckling flexure, width", WIDE, TYPED_LENGTH,
            "Increase: the buckling flexure pushes harder: the barrier grows.")
        .axis(22),
    field("mechanism.poisson", (0.0, 0.49), POISSON_REMEDY),
    field("mechanism.initial_bow_mm", (0.0, 1e15),
            "give the bow in mm, such as 0.05; 0 is a straight flexure"),
    field("mechanism.yield_gpa", MODULUS, "give the bending stress that is allowed in GPa, such as 2"),
    field("mechanism.linear_n_per_m", COEFFICIENT, "give a finite stiffness in N/m; negative makes two wells")
        .named("linear stiffness").axis(17),
    field("mechanism.cubic_n_per_m3", COEFFICIENT,
            "give a finite stiffness in N/m^3; positive makes two wells")
        .named("cubic stiffness").axis(18),
    field("mechanism.equilibrium_mm", POSITIVE,
            "give the distance of the wells from the middle in mm, such as 7")
        .named("wells at ±").axis(15),
    field("mechanism.barrier_mj", (1e-60, 1e60), "give the height of the barrier in mJ, such as 0.5")
        .named("barrier").axis(16),
    field("mechanism.coefficients_si", COEFFICIENT, "give finite coefficients in N/m^i; zeros are fine"),
    field("mechanism.error_n", NOT_NEGATIVE, "give the error of the curve in N; 0 is an exact curve"),
    field("mechanism.tolerance", (1e-10, 1e-1), "1e-4 of the force maximum suits measured data"),
    field("mechanism.n_per_m", COEFFICIENT, "give a finite stiffness in N/m, such as 30")
        .control("spring", ((-100.0, 100.0, 1.0), Scale::Value), (-1e6, 1e6),
            "Increase: a stiffer spring draws the mass to the middle: the barrier is lower, the wells move \
             in.")
        .axis(38),
    field("mechanism.strength_n_mm4", (-1e60, 1e60),
            "give the strength in N mm^4, such as 2000; below 0 for antiparallel moments, 0 is no magnet")
        .control("strength of the magnets", ((-2e3, 2e3, 1.0), Scale::Value), (-1e9, 1e9),
            "Increase: facing magnets attract each other more at x = 0: the barrier gets lower. Below 0 they \
             repel each other, and it gets higher. Transverse ones do the opposite.")
        .axis(39),
    field("mechanism.gap_mm", POSITIVE,
            "give the distance of the magnets at x = 0 in mm, such as 5")
        .control("gap of the magnets", ((0.5, 20.0, 0.1), Scale::Value), TYPED_LENGTH,
            "Increase: the magnets are further apart. Their force falls with the fourth power of it and \
             reaches further to both sides.")
        .axis(40),
    field("damping.xi", (0.0, 1e6), "give a ratio, such as 0.023 for 2.3 %; `None` or 0 is no damping")
        .control("damping ratio", DAMPING, (0.0, 100.0), DAMPING_HOVER).axis(5),
    field("damping.c_n_s_per_m", NOT_NEGATIVE,
            "give a damping coefficient in N s/m; `None` or 0 is no damping")
        .control("damping", DAMPING, (0.0, 1e6), DAMPING_HOVER).axis(12),
    field("stops.travel_limit_mm", POSITIVE,
            "stops need room between them: give their distance from x = 0 in mm, or `stops: None` for none")
        .control("travel limit ±", STOP, TYPED_LIMIT, LIMIT_HOVER).axis(1),
    field("stops.restitution", SHARE, REBOUND_REMEDY)
        .control("restitution", ZERO_TO_ONE, SHARE, REBOUND_HOVER).axis(4),
    field("stops.left_mm", PLACE,
            "give how far left of x = 0 the left stop stands in mm, below 0 for one right of it, or leave \
             it out for an open side")
        .control("left", STOP, TYPED_PLACE, LIMIT_HOVER).axis(8),
    field("stops.right_mm", PLACE,
            "give how far right of x = 0 the right stop stands in mm, below 0 for one left of it, or leave \
             it out for an open side")
        .control("right", STOP, TYPED_PLACE, LIMIT_HOVER).axis(9),
    field("stops.restitution_left", SHARE, REBOUND_REMEDY)
        .control("left restitution", ZERO_TO_ONE, SHARE, REBOUND_HOVER).axis(10),
    field("stops.restitution_right", SHARE, REBOUND_REMEDY)
        .control("right restitution", ZERO_TO_ONE, SHARE, REBOUND_HOVER).axis(11),
    field("stops.stiffness_n_per_m1_5", MODULUS,
            "give the stiffness of the contact in N/m^1.5, such as 3.7e9, or leave it out and give radius_mm \
             and young_gpa")
        .axis(24),
    field("stops.loss_s_per_m", NOT_NEGATIVE,
            "give the loss of the contact in s/m, such as 10.4; 0 is an elastic contact; check says which \
             gives a restitution")
        .axis(25),
    field("stops.radius_mm", POSITIVE, "give the radius of the crossed cylinders in mm, such as 5").axis(26),
    field("stops.young_gpa", MODULUS, "give Young's modulus in GPa, such as 69 for aluminium").axis(23),
    field("stops.poisson", (0.0, 0.49), POISSON_REMEDY),
    field("stops.yield_gpa", MODULUS, "give the yield strength in GPa, such as 0.276"),
    field("transducer.coupling_v_s_per_m", (-1e30, 1e30),
            "give the coupling in V s/m (the same number in N/A), such as 5")
        .control("coupling", ((0.0, 10.0, 0.05), Scale::Value), TYPED_COUPLING, COUPLING_HOVER).axis(33),
    field("transducer.coil_ohm", NOT_NEGATIVE, "give the resistance of the coil in ohm, such as 40")
        .control("coil", ((0.0, 200.0, 1.0), Scale::Value), TYPED_SIZE,
            "Increase: more of the electrical power becomes heat in the coil, which brakes the mass less.")
        .axis(35),
    field("transducer.load_ohm", LOAD,
            "give the resistance of the load in ohm; 0 is a short circuit, inf an open one")
        .control("load", DECADES, LOAD, LOAD_HOVER).axis(31),
    field("transducer.inductance_mh", NOT_NEGATIVE,
            "give the inductance of the coil in mH; 0 makes it a damping")
        .control("inductance", ((0.0, 200.0, 1.0), Scale::Value), (0.0, 1e9),
            "Increase: the current follows the velocity more slowly, and fast motion gives less of it.")
        .axis(36),
    field("transducer.coupling_n_per_v", (-1e30, 1e30),
            "give the coupling in N/V (the same number in A s/m), such as 1e-3")
        .control("coupling", ((0.0, 5e-3, 1e-5), Scale::Value), TYPED_COUPLING, COUPLING_HOVER).axis(34),
    field("transducer.capacitance_nf", (1e-30, 1e30), "give the capacitance in nF, such as 40")
        .control("capacitance", ((1.0, 200.0, 1.0), Scale::Value), (1e-6, 1e9),
            "Increase: the same motion charges the layer to a lower voltage, and slow motion loses less of \
             it through the load.")
        .axis(37),
    field("transducer.load_kohm", LOAD,
            "give the resistance of the load in kohm; 0 is a short circuit, inf an open one")
        .control("load", DECADES, LOAD, LOAD_HOVER).axis(32),
    field("excitation.accel_g", ACCELERATION, "give an acceleration in g, of either sign")
        .control("acceleration", ((-2.0, 2.0, 0.01), Scale::Push), TYPED_G,
            "Increase: the tray is tipped further to the left.")
        .axis(27),
    field("excitation.frequency_hz", POSITIVE,
            "give a frequency in Hz, such as 3; use `Constant` for a steady acceleration")
        .control("frequency", RATE, TYPED_HZ,
            "Increase: the pushes follow each other faster and last less long.")
        .axis(3),
    field("excitation.amplitude_g", ACCELERATION, AMPLITUDE_REMEDY)
        .control("amplitude", PUSH, TYPED_SIZE, SHAKING_HOVER).axis(2),
    field("excitation.amplitude_m_per_s2", ACCELERATION, "give an amplitude in m/s^2, of either sign or 0")
        .control("amplitude", ((0.0, 20.0, 0.1), Scale::Push), (0.0, 1e5), SHAKING_HOVER).axis(42),
    field("excitation.amplitude_n", ACCELERATION, "give the amplitude of the force in N, of either sign or 0")
        .control("force", ((0.0, 0.3, 0.002), Scale::Force), (0.0, 1e9),
            "Increase: the mass is pushed harder. Beyond some amplitude it crosses to the other well.")
        .axis(43),
    field("excitation.frequency_rad_per_s", POSITIVE,
            "give an angular frequency in rad/s: 2 pi times that in Hz")
        .control("frequency", ((3.0, 125.0, 0.5), Scale::Rate), (1e-3, 1e6),
            "Increase: the pushes follow each other faster and last less long.")
        .axis(44),
    field("excitation.phase_deg", (-1e15, 1e15), "give a phase in degrees")
        .control("phase", ((-180.0, 180.0, 15.0), Scale::Fixed), TYPED_G,
            "Increase: the shaking begins later in its cycle."),
    field("excitation.from_g", ACCELERATION, AMPLITUDE_REMEDY)
        .control("from", RAMP_PUSH, TYPED_SIZE, "Increase: the ramp begins with harder shaking."),
    field("excitation.to_g", ACCELERATION, AMPLITUDE_REMEDY)
        .control("to", RAMP_PUSH, TYPED_SIZE, "Increase: the ramp ends with harder shaking.").axis(28),
    field("excitation.over_s", POSITIVE,
            "give the length of the ramp in s; use `Sine` for an amplitude that stays")
        .control("over", ((1.0, 600.0, 1.0), Scale::Value), TYPED_SECONDS,
            "Increase: the shaking changes more slowly.")
        .axis(29),
    field("excitation.from_hz", BAND, "give the frequency at the beginning in Hz, such as 1")
        .control("from", CHIRP_RATE, TYPED_BAND, "Increase: the sweep begins at a higher frequency."),
    field("excitation.to_hz", BAND, "give the frequency at the end in Hz, such as 10")
        .control("to", CHIRP_RATE, TYPED_BAND, "Increase: the sweep ends at a higher frequency.").axis(30),
    field("excitation.rms_g", NOT_NEGATIVE, "give a root mean square in g, such as 0.5")
        .control("RMS", ((0.0, 1.0, 0.01), Scale::Push), TYPED_SIZE, SHAKING_HOVER).axis(13),
    field("excitation.low_hz", BAND, "give the lower end of the band in Hz, such as 1")
        .control("lowest", ((0.0, 50.0, 0.1), Scale::Rate), TYPED_BAND,
            "Increase: the slow part of the shaking goes."),
    field("excitation.high_hz", POSITIVE, "give the upper end of the band in Hz, such as 10")
        .control("highest", ((0.1, 50.0, 0.1), Scale::Rate), TYPED_HZ,
            "Increase: faster shaking comes in."),
    field("excitation.seed", (0.0, 9_007_199_254_740_992.0),
            "give a whole number; another one gives another noise of the same kind")
        .whole().named("seed").axis(41),
    field("excitation.lines", (1.0, 4096.0), "256 sines look like noise for some minutes")
        .whole().named("lines of the noise"),
    field("start.x_mm", PLACE, "give a displacement in mm")
        .control("starting displacement", ((-8.0, 8.0, 0.05), Scale::Value), (-1e6, 1e6),
            "Increase: the mass begins further to the right. The motion begins again."),
    field("start.v_m_per_s", (-1e30, 1e30), "give a velocity in m/s")
        .control("starting velocity", ((-1.0, 1.0, 0.005), Scale::Value), (-1e4, 1e4),
            "Increase: the mass begins faster to the right; below 0, to the left. The motion begins again."),
    field("start.electrical", (-1e30, 1e30),
            "give the current of a coil in A, the voltage of a piezoelectric layer in V")
        .named("start, current or voltage"),
    field("run.duration_s", (1e-15, 1e9), "give how long to run in s, such as 10")
        .control("run length", ((1.0, 120.0, 1.0), Scale::Value), TYPED_SECONDS,
            "Increase: what is said of the motion rests on more periods. The second half of the run counts, \
             or what comes after the settling time of the scene."),
    field("run.settle_s", (0.0, 1e9),
            "give when the settled window begins in s, or leave it out for half the duration")
        .named("settling time"),
    field("run.tolerance", TOLERANCES, "1e-9 suits most runs and 1e-6 most maps").named("tolerance"),
    field("sweep.from", COEFFICIENT, "give the first value of the axis"),
    field("sweep.to", COEFFICIENT, "give the last value of the axis"),
    field("sweep.step", (1e-200, 1e200), "an axis goes upwards in steps above 0"),
    field("sweep.values", (-1e200, f64::INFINITY), "give the values of the axis, in the field's unit"),
    field("app.speed", (1e-15, 1000.0), "1 is real time, 0.1 a tenth of it"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_inside_and_nan_is_not() {
        for field in FIELDS {
            let Range { low, high, .. } = field.range;
            assert!(field.range.contains(low) && field.range.contains(high));
            // nothing lies beyond an infinite end
            let above = [f64::INFINITY, high.next_up()].into_iter().filter(|above| *above > high);
            for outside in [f64::NAN, f64::NEG_INFINITY, low.next_down()].into_iter().chain(above) {
                assert!(!field.range.contains(outside), "{} takes {outside}", field.path);
            }
        }
    }
}
