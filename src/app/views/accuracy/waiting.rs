//! Placeholder for a result that is still being computed.

use eframe::egui::{RichText, Ui};

use super::super::ViewContext;

/// Shows a message while a result is computed for the first time.
pub fn waiting_ui(ui: &mut Ui, context: &ViewContext<'_>) {
    let text = match context.session.fault() {
        Some(_) => "This scene cannot run.",
        None if context.session.accuracy.is_stopped() => "Stopped: the next change begins it again.",
        None => "Working it out.",
    };
    ui.label(RichText::new(text).color(context.style.faint()));
}
