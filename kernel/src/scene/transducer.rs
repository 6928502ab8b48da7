//! Transducers and their fields.

use serde::{Deserialize, Serialize};

/// Converter of motion into electrical power, with its load.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Transducer {
    /// No transducer.
    #[default]
    None,
    /// A magnet that moves in a coil: L i' + (coil + load) i = k v, force -k i on the mass.
    Electromagnetic {
        /// Coupling k in V s/m, which is N/A, -1e30 to 1e30.
        coupling_v_s_per_m: f64,
        /// Resistance of the coil in ohm, 0 to 1e30.
        coil_ohm: f64,
        /// Resistance of the load in ohm, 0 to inf; 0 is a short circuit, inf an open one.
        load_ohm: f64,
        /// Inductance L of the coil in mH, 0 to 1e30; 0 makes the transducer a damper.
        #[serde(default)]
        inductance_mh: f64,
    },
    /// A strained piezoelectric layer: C u' + u/load = k v, force -k u on the mass.
    Piezoelectric {
        /// Coupling k in N/V, which is A s/m, -1e30 to 1e30.
        coupling_n_per_v: f64,
        /// Capacitance C in nF, 1e-30 to 1e30.
        capacitance_nf: f64,
        /// Resistance of the load in kohm, 0 to inf; 0 is a short circuit, inf an open one.
        load_kohm: f64,
    },
}

impl Transducer {
    /// Whether it takes energy from the motion.
    pub fn dissipates(&self) -> bool {
        match *self {
            Self::None => false,
            Self::Electromagnetic { coupling_v_s_per_m, coil_ohm, load_ohm, .. } => {
                coupling_v_s_per_m != 0.0 && coil_ohm + load_ohm > 0.0 && load_ohm < f64::INFINITY
            }
            Self::Piezoelectric { coupling_n_per_v, load_kohm, .. } => {
                coupling_n_per_v != 0.0 && load_kohm > 0.0 && load_kohm < f64::INFINITY
            }
        }
    }

    /// Whether a current or a voltage is a state variable of the motion, because it is not 0 and does not
    /// follow from the velocity.
    pub fn has_state(&self) -> bool {
        match *self {
            Self::None => false,
            Self::Electromagnetic { load_ohm, inductance_mh, .. } => {
                inductance_mh > 0.0 && load_ohm < f64::INFINITY
            }
            Self::Piezoelectric { load_kohm, .. } => load_kohm > 0.0,
        }
    }
}
