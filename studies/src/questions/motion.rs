//! What several questions ask about one scene.

use crate::scene::{Axis, Document, Transducer};

/// Whether the transducer has an electrical state, in the scene or in a cell over `axes`.
pub fn may_have_circuit(document: &Document, axes: &[Axis]) -> bool {
    let swept = |name: &str| axes.iter().any(|axis| axis.field == format!("transducer.{name}"));
    let cells_may_have = match document.scene.transducer {
        Transducer::None => false,
        Transducer::Electromagnetic { inductance_mh, .. } => {
            swept("inductance_mh") || inductance_mh > 0.0 && swept("load_ohm")
        }
        Transducer::Piezoelectric { .. } => swept("load_kohm"),
    };
    cells_may_have || document.scene.transducer.has_state()
}
