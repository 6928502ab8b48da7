//! Transducers, and their fields.

use serde::{Deserialize, Serialize};

/// What turns motion into electrical power, and the load that takes it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Transducer {
    /// None.
    #[default]
    None,
    /// A magnet that moves in a coil: (coil + load) i = k v, force -k i on the mass.
    Electromagnetic {
        /// Coupling k in V s/m, which is N/A, -1e30 to 1e30.
        coupling_v_s_per_m: f64,
        /// Resistance of the coil in ohm, 0 to 1e30.
        coil_ohm: f64,
        /// Resistance of the load in ohm, 0 to inf; 0 is a short circuit, inf an open one.
        load_ohm: f64,
    },
}
