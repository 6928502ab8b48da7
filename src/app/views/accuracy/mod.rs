//! View of the accuracy: cost of each digit, and the same run in fixed steps.
//!
//! Nothing is computed while the view is closed. One part can be chosen where both do not fit.

mod digits;
mod steps;

use eframe::egui::{Rect, RichText, Ui, UiBuilder, vec2};

use crate::app::ui::widgets::segment_ui;

use super::{ViewContext, empty_ui};

/// Width and height in points from which on both parts are shown.
const BOTH: (f32, f32) = (760.0, 250.0);

/// Share of the width for the part on digits, if both are shown.
const DIGITS: f32 = 0.42;

pub fn accuracy_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let area = ui.available_rect_before_wrap().shrink2(vec2(10.0, 6.0));
    context.session.want_accuracy();
    let part = |ui: &mut Ui, rect: Rect, digits: bool, context: &mut ViewContext<'_>| {
        ui.scope_builder(UiBuilder::new().max_rect(rect).id_salt(name(digits)), |ui| match digits {
            true => digits::digits_ui(ui, context),
            false => steps::steps_ui(ui, context),
        });
    };
    if area.width() >= BOTH.0 && area.height() >= BOTH.1 {
        let middle = area.left() + DIGITS * area.width();
        let (left, right) = (area.with_max_x(middle - 10.0), area.with_min_x(middle + 10.0));
        for (rect, digits) in [(left, true), (right, false)] {
            ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
                ui.label(RichText::new(name(digits)).heading());
            });
            part(ui, rect.with_min_y(rect.top() + 26.0), digits, context);
        }
        return;
    }
    ui.scope_builder(UiBuilder::new().max_rect(area), |ui| {
        ui.horizontal(|ui| {
            for digits in [false, true] {
                segment_ui(ui, &mut context.memory.shows_digits, digits, name(digits));
            }
        });
    });
    part(ui, area.with_min_y(area.top() + 30.0), context.memory.shows_digits, context);
}

/// Heading of the part on the digits, or of that on fixed steps.
fn name(digits: bool) -> &'static str {
    if digits { "What a digit costs" } else { "What the step size does" }
}

/// Shows a message while a result is computed for the first time.
fn waiting_ui(ui: &mut Ui, context: &ViewContext<'_>) {
    let text = match context.session.fault() {
        Some(_) => "This scene cannot run.",
        None if context.session.accuracy.is_stopped => "Stopped: the next change begins it again.",
        None => "Computing.",
    };
    let room = ui.available_rect_before_wrap();
    empty_ui(ui, &context.style, room, text);
}
