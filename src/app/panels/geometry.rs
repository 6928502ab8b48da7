//! Controls of the mechanism: preload, sizes of flexures, springs and magnets beside them.

use eframe::egui::Ui;

use crate::app::session::Session;
use crate::app::words::fields::info;
use crate::scene::{Mechanism, numeric_fields};

use super::fields::{absent_ui, field_ui};

/// Paths of the mechanism's fields that have a slider, including those of the parts of a sum.
fn sliders(session: &Session) -> Vec<String> {
    let has_slider = |path: &String| path.starts_with("mechanism.") && info(path).is_some();
    numeric_fields(session.scene()).into_iter().filter(has_slider).collect()
}

fn is_preload(path: &str) -> bool {
    path.ends_with(".preload_mm")
}

/// The slider of the preload; for a mechanism without one, its name greyed out with the reason.
pub fn preload_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    match sliders(session).into_iter().find(|path| is_preload(path)) {
        Some(path) => field_ui(ui, session, &path, width),
        None if matches!(session.scene().mechanism, Mechanism::Table { .. }) => {
            absent_ui(ui, "preload", "The force comes from a table, which was made at one preload.")
        }
        None => absent_ui(ui, "preload", "The force is given by a formula without a preload."),
    }
}

/// Whether a field belongs to springs or magnets, which lower the barrier as stops do.
fn is_balancing(path: &str) -> bool {
    [".n_per_m", ".strength_n_mm4", ".gap_mm"].iter().any(|end| path.ends_with(end))
}

pub fn balancing_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    let balancing = sliders(session).into_iter().filter(|path| is_balancing(path));
    balancing.for_each(|path| field_ui(ui, session, &path, width));
}

/// The sliders of the mechanism's other fields, the sizes of its flexures.
pub fn sizes_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    let mut sizes = sliders(session);
    sizes.retain(|path| !is_preload(path) && !is_balancing(path));
    if sizes.is_empty() {
        let why = "The mechanism of this scene is a force without flexures behind it.";
        absent_ui(ui, "sizes of flexures", why);
    }
    sizes.iter().for_each(|path| field_ui(ui, session, path, width));
}
