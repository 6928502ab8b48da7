//! Fields of a scene file, with their units.
//!
//! Every field has its unit in its name; the units are practical ones (mm, g, Hz, degrees). This module
//! checks nothing: [`check`](super::check()) does, and `dynamics::Model` converts to SI once.
//!
//! Both ends of the ranges stated below are valid; a test compares their text with the checked range. The
//! ends are wide on purpose: a scene stays valid if its masses, lengths and times are scaled by anything from
//! 1e-9 to 1e9 (a duration by 1e8), yet no product of them overflows.

use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize};

use super::mechanism::Mechanism;
use super::record::Record;
use super::stops::Stops;
use super::transducer::Transducer;

/// A scene: one mechanism, how it is shaken and stopped, and how long it runs.
///
/// Fields have the unit in their names and the ranges of `docs/scene.md`. A scene that is read from a file or
/// a text is checked as a whole, with all faults at once, when a `Document` or a simulation of it is made;
/// one that a program fills in is checked when its model is built.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// One line that names the scene; the default is the file's name without its extension.
    #[serde(default)]
    pub title: String,
    /// What to look for; free text. In a file, a line break with its indentation is a space and an empty line
    /// begins a paragraph.
    #[serde(default, skip_serializing_if = "String::is_empty", deserialize_with = "paragraphs")]
    pub notes: String,
    /// Proof mass in grams, 1e-15 to 1e15.
    pub mass_g: f64,
    /// Source of the restoring force.
    pub mechanism: Mechanism,
    /// Viscous damping.
    #[serde(default, skip_serializing_if = "is_default")]
    pub damping: Damping,
    /// Travel limits.
    #[serde(default, skip_serializing_if = "is_default")]
    pub stops: Stops,
    /// Transducer that converts motion into electrical power.
    #[serde(default, skip_serializing_if = "is_default")]
    pub transducer: Transducer,
    /// Acceleration of the base.
    #[serde(default, skip_serializing_if = "is_default")]
    pub excitation: Excitation,
    /// State at time 0.
    #[serde(default)]
    pub start: Start,
    /// Duration, settled window and tolerance.
    pub run: RunSettings,
    /// The grid of the command `sweep`, slowest field first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sweep: Vec<SweepAxis>,
    /// Hints for the window; the command line ignores them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub app: Option<AppHints>,
}

/// Viscous damping.
///
/// The force on the mass is -c v, with the velocity v relative to the base. A transducer without a state of
/// its own adds to c.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Damping {
    /// No damping.
    #[default]
    None,
    /// Damping ratio xi of the right-hand stable equilibrium, 0 to 1e6: c = 2 xi sqrt(k m), where k is
    /// [`Landscape::damping_stiffness`](crate::mechanics::Landscape::damping_stiffness). Its path is
    /// `damping.xi`.
    Ratio(f64),
    /// Damping coefficient.
    Coefficient {
        /// c in N s/m, 0 to 1e30.
        c_n_s_per_m: f64,
    },
}

/// Acceleration of the base, positive to the right, or a force on the mass.
///
/// Amplitudes are in g (9.80665 m/s^2) but for those of `Cosine`, `Force` and of series, which name their
/// unit. A drive of a program's own is made by [`from_fn`](Self::from_fn) or
/// [`from_samples`](Self::from_samples).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Excitation {
    /// The base stands still.
    #[default]
    None,
    /// Constant acceleration, as on a tilted base.
    Constant {
        /// Acceleration in g, -1e30 to 1e30.
        accel_g: f64,
    },
    /// amplitude sin(2 pi f t + phase).
    Sine {
        /// Frequency in Hz, 1e-15 to 1e15.
        frequency_hz: f64,
        /// Amplitude in g, -1e30 to 1e30; 0 and negative are valid.
        amplitude_g: f64,
        /// Phase in degrees, -1e15 to 1e15, reduced exactly at multiples of 90.
        #[serde(default)]
        phase_deg: f64,
    },
    /// amplitude cos(w t + phase), in SI.
    Cosine {
        /// Amplitude of the base acceleration in m/s^2, -1e30 to 1e30; 0 and negative are valid.
        amplitude_m_per_s2: f64,
        /// Angular frequency w in rad/s, 1e-15 to 1e15.
        frequency_rad_per_s: f64,
        /// Phase in degrees, -1e15 to 1e15, reduced exactly at multiples of 90.
        #[serde(default)]
        phase_deg: f64,
    },
    /// A force on the mass in place of an acceleration of the base: amplitude cos(w t + phase), whatever the
    /// mass. The motion is that of the base acceleration -force/mass.
    Force {
        /// Amplitude in N, -1e30 to 1e30; 0 and negative are valid.
        amplitude_n: f64,
        /// Angular frequency w in rad/s, 1e-15 to 1e15.
        frequency_rad_per_s: f64,
        /// Phase in degrees, -1e15 to 1e15, reduced exactly at multiples of 90.
        #[serde(default)]
        phase_deg: f64,
    },
    /// (from + (to - from) t/over) sin(2 pi f t), then `to`.
    AmplitudeRamp {
        /// Frequency in Hz, 1e-15 to 1e15.
        frequency_hz: f64,
        /// Amplitude at time 0 in g, -1e30 to 1e30.
        from_g: f64,
        /// Amplitude from the end of the ramp on, in g, -1e30 to 1e30.
        to_g: f64,
        /// Length of the ramp in s, 1e-15 to 1e15.
        over_s: f64,
    },
    /// amplitude sin(2 pi (from t + (to - from) t^2/(2 over))), from `over` on at the frequency `to` without
    /// a jump of phase.
    Chirp {
        /// Frequency at time 0 in Hz, 0 to 1e15.
        from_hz: f64,
        /// Frequency from the end of the chirp on, in Hz, 0 to 1e15.
        to_hz: f64,
        /// Length of the chirp in s, 1e-15 to 1e15.
        over_s: f64,
        /// Amplitude in g, any sign: -1e30 to 1e30.
        amplitude_g: f64,
    },
    /// Band-limited noise: a sum of sines at random frequencies, one in each of `lines` equal parts of the
    /// band, with random phases.
    Noise {
        /// Root mean square in g, 0 to 1e30.
        rms_g: f64,
        /// Lower end of the band in Hz, 0 to 1e15.
        low_hz: f64,
        /// Upper end of the band in Hz, 1e-15 to 1e15, above the lower.
        high_hz: f64,
        /// Seed of the random numbers; whole, 0 to 9007199254740992.
        seed: u64,
        /// Number of sines; whole, 1 to 4096.
        #[serde(default = "default_lines")]
        lines: u64,
    },
    /// A recorded acceleration: CSV with columns `t_s,accel_m_per_s2`, or others whose names end with a unit
    /// of time and one of acceleration; linear between samples, zero before the first and after the last; at
    /// most a million rows and 64 MB.
    Recorded {
        /// Path relative to the scene file, or the name of an embedded record.
        path: String,
        /// Contents of the file, once a document has read it; not a part of the text.
        #[serde(skip)]
        record: Option<Arc<Record>>,
    },
    /// The sum of several excitations.
    Sum(Vec<Excitation>),
}

/// State at time 0.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Start {
    /// At the right-hand stable equilibrium, or on the stop if the equilibrium lies beyond it.
    #[default]
    Rest,
    /// A given state.
    At {
        /// Displacement in mm, -1e15 to 1e15, between the stops or on one.
        x_mm: f64,
        /// Velocity in m/s, -1e30 to 1e30.
        v_m_per_s: f64,
        /// Current in A of a coil with inductance, or voltage in V of a piezoelectric transducer, -1e30 to
        /// 1e30; 0 for every other scene.
        #[serde(default, skip_serializing_if = "is_default")]
        electrical: f64,
    },
}

/// Duration, settled window and tolerance.
///
/// Regime, period and averages of a run are those of the settled window, which is cut to whole forcing
/// periods. The tolerance is relative to [`Scales`](crate::dynamics::Scales).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Run", deny_unknown_fields)]
pub struct RunSettings {
    /// Duration in s, 1e-15 to 1e9.
    pub duration_s: f64,
    /// Beginning of the settled window in s, 0 to 1e9 and at most the duration; by default half of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settle_s: Option<f64>,
    /// Allowed local error, relative to the scene's scales, 1e-14 to 0.001.
    #[serde(default = "default_tolerance")]
    pub tolerance: f64,
    /// Whether a run that repeats exactly may be completed from its first cycle.
    #[serde(default = "default_true")]
    pub recurrence: bool,
}

/// One axis of a sweep: even steps (`from`, `to`, `step`), or `values` in their place.
///
/// It is what a scene file says; [`Axis`](super::Axis) has all values.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "WrittenAxis", into = "WrittenAxis")]
pub struct SweepAxis {
    /// Dotted path of a numeric field, such as `stops.travel_limit_mm`.
    pub field: String,
    /// First value, in the field's unit, -1e200 to 1e200.
    pub from: f64,
    /// Last value, -1e200 to 1e200, included if a step reaches it; not below the first.
    pub to: f64,
    /// Step, 1e-200 to 1e200.
    pub step: f64,
    /// The values one by one, each -1e200 to inf; if there are any, the three numbers above are ignored.
    pub values: Vec<f64>,
}

/// A [`SweepAxis`] in the form of a file.
#[derive(Serialize, Deserialize)]
#[serde(rename = "SweepAxis", deny_unknown_fields)]
struct WrittenAxis {
    field: String,
    /// As in the axis, -1e200 to 1e200.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    from: Option<f64>,
    /// As in the axis, -1e200 to 1e200.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    to: Option<f64>,
    /// As in the axis, 1e-200 to 1e200.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    step: Option<f64>,
    /// As in the axis, each -1e200 to inf.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    values: Vec<f64>,
}

impl From<SweepAxis> for WrittenAxis {
    fn from(SweepAxis { field, from, to, step, values }: SweepAxis) -> Self {
        let even = |number: f64| values.is_empty().then_some(number);
        Self { field, from: even(from), to: even(to), step: even(step), values }
    }
}

impl TryFrom<WrittenAxis> for SweepAxis {
    type Error = &'static str;

    fn try_from(WrittenAxis { field, from, to, step, values }: WrittenAxis) -> Result<Self, Self::Error> {
        match (from, to, step) {
            (Some(from), Some(to), Some(step)) if values.is_empty() => {
                Ok(Self { field, from, to, step, values })
            }
            (None, None, None) if !values.is_empty() => Ok(Self { field, values, ..Self::default() }),
            _ => Err(
                "an axis of a sweep has `from`, `to` and `step`, or `values` with at least one number in \
                 their place",
            ),
        }
    }
}

/// Hints for the window.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AppHints {
    /// The layout to open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<Layout>,
    /// Playing speed relative to real time, 1e-15 to 1000.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// The stops that appear when they are switched on.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "some_stops")]
    pub stops_when_on: Option<Stops>,
}

/// A layout of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Layout {
    /// Mechanism, well, displacement, before and now.
    Look,
    /// Adds phase portrait, force curve and energy.
    Study,
    /// The map of RMS velocity.
    Map,
    /// One field walked up and down, with the motion.
    Explore,
}

/// Whether a field is left out when written: RON would write the choice `None` as `r#None`, to distinguish it
/// from an absent option.
pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Joins the lines of a manually wrapped text; paragraphs stay separated by one empty line.
fn paragraphs<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    String::deserialize(from).map(|text| joined(&text))
}

/// The text with the lines of each paragraph joined.
pub(super) fn joined(text: &str) -> String {
    let mut joined = String::with_capacity(text.len());
    for line in text.lines().map(str::trim) {
        if line.is_empty() {
            if !joined.is_empty() && !joined.ends_with('\n') {
                joined.push_str("\n\n");
            }
        } else {
            if !joined.is_empty() && !joined.ends_with('\n') {
                joined.push(' ');
            }
            joined.push_str(line);
        }
    }
    joined.truncate(joined.trim_end().len());
    joined
}

/// Reads `Some(Stops::None)` as `None`: it has the same meaning as an absent field and would
/// be written alike.
fn some_stops<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Stops>, D::Error> {
    Ok(Option::<Stops>::deserialize(from)?.filter(|stops| *stops != Stops::None))
}

fn default_lines() -> u64 {
    256
}

fn default_tolerance() -> f64 {
    1e-9
}

fn default_true() -> bool {
    true
}
