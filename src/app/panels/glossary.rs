//! Glossary of the technical terms in lessons and sentences.

use eframe::egui::{self, Modifiers, RichText, ScrollArea, Ui};

use crate::app::ui::widgets::{close_ui, dialog, dialog_width};
use crate::app::words::meanings::{GLOSSARY, meaning};

/// Shows the glossary. Returns `false` once it is to be closed.
pub fn glossary_ui(ui: &Ui) -> bool {
    let answer = dialog(ui.ctx(), "glossary").show(ui.ctx(), |ui| {
        ui.set_max_width(dialog_width(ui, 640.0));
        ui.heading("Glossary");
        ui.add_space(4.0);
        let room = (ui.ctx().content_rect().height() - 130.0).max(80.0);
        ScrollArea::vertical().max_height(room).show(ui, |ui| {
            for word in GLOSSARY {
                ui.label(RichText::new(word).heading());
                ui.label(meaning(word).unwrap_or_default());
                ui.add_space(4.0);
            }
        });
        ui.add_space(8.0);
        close_ui(ui)
    });
    let toggled = ui.input_mut(|input| input.consume_key(Modifiers::NONE, egui::Key::F2));
    !(answer.inner || answer.should_close() || toggled)
}
