//! Placeholder for a result that is still being computed.

use eframe::egui::Ui;

use super::super::{ViewContext, empty_ui};

/// Shows a message while a result is computed for the first time.
pub fn waiting_ui(ui: &mut Ui, context: &ViewContext<'_>) {
    let text = match context.session.fault() {
        Some(_) => "This scene cannot run.",
        None if context.session.accuracy.is_stopped() => "Stopped: the next change begins it again.",
        None => "Working it out.",
    };
    let room = ui.available_rect_before_wrap();
    empty_ui(ui, &context.style, room, text);
}
