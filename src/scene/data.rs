//! What a person writes: the fields of a scene file, with their units.
//!
//! Every field carries its unit in its name and the units are those a person sets on a slider
//! (mm, g, Hz, degrees). Nothing here is checked: [`check`](super::check) does that, and
//! `dynamics::Model` converts to SI once.

use serde::{Deserialize, Serialize};

/// A scene: one mechanism, how it is shaken and stopped, and how long it runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// One line that names the scene.
    pub title: String,
    /// What to look for; free text.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub notes: String,
    /// Proof mass in grams, above 0.
    pub mass_g: f64,
    /// Where the restoring force comes from.
    pub mechanism: Mechanism,
    /// Viscous damping.
    #[serde(default)]
    pub damping: Damping,
    /// Travel limits.
    #[serde(default)]
    pub stops: Stops,
    /// Acceleration of the base.
    #[serde(default)]
    pub excitation: Excitation,
    /// State at time 0.
    #[serde(default)]
    pub start: Start,
    /// Duration, settled window and tolerance.
    pub run: Run,
    /// The grid that `sweep` runs over, slowest field first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sweep: Vec<SweepAxis>,
    /// Electromagnetic transducer.
    #[serde(default, skip_serializing_if = "Transducer::is_none")]
    pub transducer: Transducer,
    /// Hints for the window; the command line ignores them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub app: Option<AppHints>,
}

/// Where the restoring force comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Mechanism {
    /// F = linear x + cubic x^3.
    Cubic {
        /// Linear stiffness in N/m, any sign.
        linear_n_per_m: f64,
        /// Cubic stiffness in N/m^3, any sign.
        cubic_n_per_m3: f64,
    },
    /// The quartic potential with two wells at +-equilibrium, a barrier between them.
    DoubleWell {
        /// Distance of the stable equilibria from the middle in mm, above 0.
        equilibrium_mm: f64,
        /// Height of the barrier in mJ, above 0.
        barrier_mj: f64,
    },
    /// F = sum of coefficients[i] x^i.
    Polynomial {
        /// Coefficients from the constant up, in N/m^i.
        coefficients_si: Vec<f64>,
    },
    /// A measured or computed curve: CSV with columns `x_m,force_n`.
    Table {
        /// Path relative to the scene file, or the name of an embedded table.
        path: String,
        /// Error allowed to the fitted curve, relative to the force maximum between the wells.
        #[serde(default = "default_table_tolerance")]
        tolerance: f64,
    },
}

/// Viscous damping.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Damping {
    /// No damping.
    #[default]
    None,
    /// Damping ratio of the right-hand stable equilibrium: c = 2 xi sqrt(k m).
    Ratio(f64),
    /// Damping coefficient.
    Coefficient {
        /// c in N s/m, 0 or above.
        c_n_s_per_m: f64,
    },
}

/// Travel limits.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Stops {
    /// Nothing in the way.
    #[default]
    None,
    /// Equal rigid stops on both sides.
    Rigid {
        /// Distance of each stop from x = 0 in mm, above 0.
        travel_limit_mm: f64,
        /// Coefficient of restitution, 0 to 1.
        restitution: f64,
    },
    /// Rigid stops that differ; a side left out is open.
    Uneven {
        /// Distance of the left stop from x = 0 in mm, above 0.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        left_mm: Option<f64>,
        /// Distance of the right stop from x = 0 in mm, above 0.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        right_mm: Option<f64>,
        /// Restitution of the left stop, 0 to 1; left out, the right stop's.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        restitution_left: Option<f64>,
        /// Restitution of the right stop, 0 to 1; left out, the left stop's.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        restitution_right: Option<f64>,
    },
}

/// Acceleration of the base, positive to the right.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Excitation {
    /// The base stands still.
    #[default]
    None,
    /// Constant acceleration, as of a tilted base.
    Constant {
        /// Acceleration in g, any sign.
        accel_g: f64,
    },
    /// amplitude sin(2 pi f t + phase).
    Sine {
        /// Frequency in Hz, above 0.
        frequency_hz: f64,
        /// Amplitude in g, any sign.
        amplitude_g: f64,
        /// Phase in degrees, reduced exactly at multiples of 90.
        #[serde(default)]
        phase_deg: f64,
    },
    /// (from + (to - from) t/over) sin(2 pi f t), then `to`.
    AmplitudeRamp {
        /// Frequency in Hz, above 0.
        frequency_hz: f64,
        /// Amplitude at time 0 in g.
        from_g: f64,
        /// Amplitude from the end of the ramp on, in g.
        to_g: f64,
        /// Length of the ramp in s, above 0.
        over_s: f64,
    },
    /// The sum of several excitations.
    Sum(Vec<Excitation>),
}

/// State at time 0.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Start {
    /// At the right-hand stable equilibrium, or on the stop where that lies beyond one.
    #[default]
    Rest,
    /// A given state.
    At {
        /// Displacement in mm, between the stops.
        x_mm: f64,
        /// Velocity in m/s.
        v_m_per_s: f64,
    },
}

/// Duration, settled window and tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Duration in s, above 0, at most 1e9.
    pub duration_s: f64,
    /// Begin of the settled window in s; left out, half the duration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settle_s: Option<f64>,
    /// Local error allowed, relative to the scene's scales: 1e-14 to 1e-3.
    #[serde(default = "default_tolerance")]
    pub tolerance: f64,
    /// Whether a run that repeats exactly may be completed from its first cycle.
    #[serde(default = "default_true")]
    pub recurrence: bool,
}

/// One axis of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepAxis {
    /// Dotted path of a numeric field, such as `stops.travel_limit_mm`.
    pub field: String,
    /// First value, in the field's unit.
    pub from: f64,
    /// Last value, included where the step reaches it.
    pub to: f64,
    /// Step, above 0.
    pub step: f64,
}

/// Electromagnetic transducer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Transducer {
    /// None.
    #[default]
    None,
}

impl Transducer {
    fn is_none(&self) -> bool {
        *self == Self::None
    }
}

/// Hints for the window.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AppHints {
    /// The layout that opens.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<Layout>,
    /// Playing speed relative to real time, above 0, at most 1000.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// The stops that appear when they are switched on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
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
}

fn default_table_tolerance() -> f64 {
    1e-4
}

fn default_tolerance() -> f64 {
    1e-9
}

fn default_true() -> bool {
    true
}
