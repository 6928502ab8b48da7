//! What stands in the place of an answer that is still to come.

use eframe::egui::{RichText, Ui};

use super::super::ViewContext;

/// Said while something is worked out for the first time.
pub fn waiting_ui(ui: &mut Ui, context: &ViewContext<'_>) {
    let text = match context.session.fault() {
        Some(_) => "This scene cannot run.",
        None if context.session.accuracy.is_stopped() => "Stopped: the next change begins it again.",
        None => "Working it out.",
    };
    ui.label(RichText::new(text).color(context.style.faint()));
}
