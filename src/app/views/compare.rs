//! Table of the present motion beside the reference.

use eframe::egui::{self, Button, RichText, Ui};

use crate::app::ui::widgets::tell;

use super::table::table_ui;
use super::{ViewContext, page_ui};

pub fn compare_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (style, reference) = (context.style, &context.session.reference);
    let cards: Vec<_> =
        context.session.reference_card().into_iter().chain([context.session.now_card()]).collect();
    let now = cards.len() - 1;
    let (name, about) = match reference.is_pinned {
        true => ("pinned", "The scene and the motion as they were when they were pinned."),
        false => ("start", "The scene and the motion as they were opened."),
    };
    let is_other = *reference.scene != *context.session.scene();
    let (mut pins, mut goes_back) = (false, false);
    page_ui(ui, |ui| {
        table_ui(ui, context, &cards, &mut |ui, column| match column {
            None => {
                let hover = "The present scene and motion become what later changes are compared with (K).";
                pins = ui.add(Button::new("Pin").small()).on_hover_text(hover).clicked();
            }
            Some(column) if column == now => {
                let hover = "In brackets: by how much it differs.";
                ui.label(RichText::new("now").heading()).on_hover_text(hover);
            }
            Some(_) => {
                _ = ui.horizontal_wrapped(|ui| {
                    ui.label(RichText::new(name).heading().color(style.compared())).on_hover_text(about);
                    let back = ui.add_enabled(is_other, Button::new(RichText::new("Back").small()).small());
                    tell(&back, egui::Role::Button, "Back");
                    let hover = "Takes this scene back: one step that can be undone. The motion goes on from \
                             where it is.";
                    let back = back.on_hover_text(hover).on_disabled_hover_text("It is the present scene.");
                    goes_back = back.clicked();
                })
            }
        });
        if now == 0 && ui.available_height() > 23.0 {
            ui.add_space(6.0);
            let text = "Change something: what was before stays here to compare.";
            ui.label(RichText::new(text).color(style.faint()));
        }
    });
    context.memory.pin |= pins;
    if goes_back {
        context.session.take_back();
    }
}
