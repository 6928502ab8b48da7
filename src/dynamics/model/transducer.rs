//! Transducer of a scene in SI: what it does to the motion, and what it gives.
//!
//! Voltage, current and powers follow from one signal. Without an electrical state that is the velocity: a
//! coil without inductance is a damping k^2/(coil + load), exactly.

use crate::numeric::short;
use crate::scene;

/// A transducer as run. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Transducer {
    /// Damping coefficient in N s/m that it adds.
    pub damping: f64,
    /// Voltage over the load per signal.
    voltage: f64,
    /// Current through the transducer per signal.
    current: f64,
    /// Power into the load, and lost in the coil, per squared signal.
    load: f64,
    coil: f64,
}

/// What a transducer gives at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Output {
    /// Voltage over the load in V.
    pub voltage: f64,
    /// Current through the load in A.
    pub current: f64,
    /// Power into the load in W.
    pub power: f64,
}

impl Transducer {
    /// The transducer of a scene; none where it has none.
    pub fn of(transducer: &scene::Transducer) -> Option<Self> {
        match *transducer {
            scene::Transducer::None => None,
            scene::Transducer::Electromagnetic { coupling_v_s_per_m, load_ohm, .. }
                if load_ohm.is_infinite() =>
            {
                let voltage = coupling_v_s_per_m;
                Some(Self { damping: 0.0, voltage, current: 0.0, load: 0.0, coil: 0.0 })
            }
            scene::Transducer::Electromagnetic { coupling_v_s_per_m, coil_ohm, load_ohm } => {
                let current = coupling_v_s_per_m / (coil_ohm + load_ohm);
                Some(Self {
                    damping: coupling_v_s_per_m * current,
                    voltage: load_ohm * current,
                    current,
                    load: load_ohm * current * current,
                    coil: coil_ohm * current * current,
                })
            }
        }
    }

    /// What it gives at a velocity in m/s.
    pub fn output(&self, v: f64) -> Output {
        let signal = v;
        Output {
            voltage: self.voltage * signal,
            current: self.current * signal,
            power: self.load * signal * signal,
        }
    }

    /// Energy into the load and lost in the coil in J, from the integral of the squared signal over time; of
    /// its mean, the mean powers in W.
    pub fn energies(&self, squared: f64) -> (f64, f64) {
        (self.load * squared, self.coil * squared)
    }

    /// Root mean square of the voltage over the load in V, from that of the signal.
    pub fn voltage_rms(&self, signal: f64) -> f64 {
        self.voltage.abs() * signal
    }

    /// It in words, for `check`.
    pub fn describe(&self) -> Vec<String> {
        vec![format!(
            "transducer: a damping of {} N s/m, {} V and {} A over the load at 1 m/s",
            short(self.damping),
            short(self.voltage),
            short(self.current)
        )]
    }
}
