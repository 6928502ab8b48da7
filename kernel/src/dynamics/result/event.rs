//! Samples and events of a run.

use serde::{Deserialize, Serialize};

/// Whether the mass moves freely or is on a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Between the stops, or touching one for an instant.
    Free,
    /// At rest on the left stop, or in contact with it where it is compliant.
    LeftStop,
    /// At rest on the right stop, or in contact with it where it is compliant.
    RightStop,
}

impl Phase {
    /// The word in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::LeftStop => "left_stop",
            Self::RightStop => "right_stop",
        }
    }
}

/// The state at a requested time; at the instant of an event, the state after the event.
///
/// The values are those of the polynomial of the integrator's step at that time, and not interpolated between
/// steps. The force on the mass and the potential follow from `x` by
/// [`ForceCurve`](crate::mechanics::ForceCurve).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time in s, as requested.
    pub t: f64,
    /// Displacement in m.
    pub x: f64,
    /// Velocity in m/s.
    pub v: f64,
    /// Acceleration of the base in m/s^2.
    pub base_accel: f64,
    /// Free or resting.
    pub phase: Phase,
    /// Electrical state of a transducer that has one, current in A or voltage in V; otherwise 0.
    pub electrical: f64,
}

impl Sample {
    /// Power of the base on the mass, -m a_b v, in W; `mass` in kg. Its integral is the ledger's work.
    pub fn work_rate(&self, mass: f64) -> f64 {
        -mass * self.base_accel * self.v
    }
}

/// Left or right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Negative x.
    Left,
    /// Positive x.
    Right,
}

impl Side {
    /// The opposite side.
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// The word in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// A rebound from a stop.
    Impact,
    /// The mass came to rest on a stop.
    Rest,
    /// The mass left a stop on which it rested.
    Release,
    /// A crossing of the barrier.
    Crossing,
    /// The mass touched a compliant stop.
    Contact,
    /// The mass separated from a compliant stop.
    Separate,
}

impl EventKind {
    /// The word in the CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Impact => "impact",
            Self::Rest => "rest",
            Self::Release => "release",
            Self::Crossing => "crossing",
            Self::Contact => "contact",
            Self::Separate => "separate",
        }
    }
}

/// One event of a run.
///
/// Its velocities are those just before and just after it, which are equal where nothing strikes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Time in s.
    pub t: f64,
    /// What happened.
    pub kind: EventKind,
    /// The stop, or the well entered.
    pub side: Side,
    /// Velocity before it in m/s, signed.
    pub v_in: f64,
    /// Velocity after it in m/s, signed.
    pub v_out: f64,
}

/// A state of a motion at a phase of the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SectionPoint {
    /// Time in s.
    pub t: f64,
    /// Displacement in m.
    pub x: f64,
    /// Velocity in m/s; right after an event at this instant.
    pub v: f64,
}

/// A state from which a motion can continue.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MapState {
    /// Displacement in m.
    pub x: f64,
    /// Velocity in m/s.
    pub v: f64,
    /// State of the circuit, a current in A or a voltage in V; 0 without one.
    pub electrical: f64,
}

impl From<(f64, f64)> for MapState {
    /// Displacement and velocity, with the circuit at rest.
    fn from((x, v): (f64, f64)) -> Self {
        Self { x, v, electrical: 0.0 }
    }
}
