//! Controls of the flexures: preload, thickness, lengths, widths.

use eframe::egui::Ui;

use crate::app::session::Session;
use crate::scene::Mechanism;

use super::fields::{absent_ui, field_ui, fields_ui};

/// The slider of the preload; for a mechanism without one greyed, with the reason.
pub fn preload_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    match session.scene().mechanism {
        Mechanism::Flexures { .. } => field_ui(ui, session, "mechanism.preload_mm", width),
        Mechanism::Table { .. } => {
            absent_ui(ui, "preload", "The force comes from a table, which was made at one preload.")
        }
        _ => absent_ui(ui, "preload", "The force is given by a formula without a preload."),
    }
}

/// The sliders of the other sizes.
pub fn sizes_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    if !matches!(session.scene().mechanism, Mechanism::Flexures { .. }) {
        let why = "The mechanism of this scene is a force without flexures behind it.";
        return absent_ui(ui, "sizes of flexures", why);
    }
    let sizes = [
        "mechanism.thickness_mm",
        "mechanism.parallel.length_mm",
        "mechanism.parallel.width_mm",
        "mechanism.buckling.length_mm",
        "mechanism.buckling.width_mm",
    ];
    fields_ui(ui, session, &sizes, width)
}
