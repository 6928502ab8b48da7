//! View of the last change: the scene and its motion before it and now.

use eframe::egui::{Button, RichText, Ui};

use crate::app::session::pins::{FULL, PinKind};

use super::table::{Column, table_ui};
use super::{ViewContext, page_ui};

pub fn before_now_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    page_ui(ui, |ui| card_ui(ui, context));
}

fn card_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let style = context.style;
    let before = context.session.before_card().cloned();
    let is_first = before.is_none();
    let column = |card| Column { card, ended: None, differs: false };
    let columns = [before, Some(context.session.now_card())].map(column);
    let mut pin = false;
    let is_full = context.session.pins.is_full();
    table_ui(ui, context, (&columns, 1), &mut |ui, column, _| match column {
        None => {
            let hover = "This motion goes on, dashed, beside the one that you change from here on (K).";
            let button = ui.add_enabled(!is_full, Button::new("Pin").small());
            pin = button.on_hover_text(hover).on_disabled_hover_text(FULL).clicked();
        }
        Some(0) => _ = ui.label(RichText::new("before").color(style.faint())),
        Some(_) => _ = ui.label(RichText::new("now").heading()),
    });
    if is_first && ui.available_height() > 28.0 {
        ui.add_space(6.0);
        let text = "Change something: the state before it stays here to compare.";
        ui.label(RichText::new(text).color(style.faint()));
    }
    if pin {
        context.memory.pin = Some(PinKind::Motion);
    }
}
