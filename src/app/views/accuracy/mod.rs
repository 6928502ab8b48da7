//! View of the accuracy: cost of each digit, and the same run in fixed steps.
//!
//! Nothing is computed while the view is closed. One part can be chosen where both do not fit.

mod digits;
mod steps;
mod waiting;

use eframe::egui::{Rect, RichText, Ui, UiBuilder, pos2, vec2};

use super::memory::Page;
use super::{ViewContext, too_small_ui};

/// Width and height in points from which on both parts are shown.
const BOTH: (f32, f32) = (760.0, 250.0);

/// Share of the width for the part on digits, if both are shown.
const DIGITS: f32 = 0.42;

pub fn accuracy_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    ui.painter().rect_filled(ui.max_rect(), 0.0, context.style.ground());
    let area = ui.available_rect_before_wrap().shrink2(vec2(10.0, 6.0));
    if area.width() < 160.0 || area.height() < 100.0 {
        return too_small_ui(ui, &context.style, ui.max_rect());
    }
    context.session.want_accuracy();
    let part = |ui: &mut Ui, rect: Rect, page: Page, context: &mut ViewContext<'_>| {
        ui.scope_builder(UiBuilder::new().max_rect(rect).id_salt(page.name()), |ui| match page {
            Page::Digits => digits::digits_ui(ui, context),
            Page::Steps => steps::steps_ui(ui, context),
        });
    };
    if area.width() >= BOTH.0 && area.height() >= BOTH.1 {
        let middle = area.left() + DIGITS * area.width();
        let [left, right] = [
            Rect::from_min_max(area.min, pos2(middle - 10.0, area.bottom())),
            Rect::from_min_max(pos2(middle + 10.0, area.top()), area.max),
        ];
        for (rect, page) in [(left, Page::Digits), (right, Page::Steps)] {
            ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
                ui.label(RichText::new(page.name()).heading());
            });
            part(ui, rect.with_min_y(rect.top() + 26.0), page, context);
        }
        return;
    }
    ui.scope_builder(UiBuilder::new().max_rect(area), |ui| {
        ui.horizontal(|ui| {
            for page in [Page::Steps, Page::Digits] {
                ui.selectable_value(&mut context.memory.accuracy_page, page, page.name());
            }
        });
    });
    part(ui, area.with_min_y(area.top() + 30.0), context.memory.accuracy_page, context);
}
