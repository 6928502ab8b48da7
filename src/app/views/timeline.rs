//! The stretch of time and the vertical ranges that the wheel chooses for the traces.

use eframe::egui::{self, Ui};
use egui_plot::PlotTransform;

use super::ViewContext;
use super::trace::TraceQuantity;

/// How much longer or shorter than its own a stretch of time may be chosen.
const LONGEST: f64 = 10.0;
const SHORTEST: f64 = 1e-3;

/// The wheel chooses the stretch of time, for all traces; a double click leaves it to the scene.
pub(super) fn zoom(ui: &Ui, response: &egui::Response, context: &mut ViewContext<'_>, own: f64) {
    let window = &mut context.memory.timeline.window;
    if response.double_clicked() {
        (context.memory.timeline.window, context.memory.timeline.vertical) = (None, [None; 4]);
        return;
    }
    if !response.hovered() || ui.input(|input| input.modifiers.shift) {
        return;
    }
    let by = ui.input(|input| {
        (-f64::from(input.smooth_scroll_delta().y) / 200.0).exp() / f64::from(input.zoom_delta())
    });
    if by != 1.0 && by.is_finite() && by > 0.0 {
        *window = Some((window.unwrap_or(own) * by).clamp(SHORTEST * own, LONGEST * own));
    }
}

/// The wheel over the numbers of the vertical axis, or with Shift anywhere, chooses the part of it that is
/// shown, about the pointer; a double click leaves it to the scene.
pub(super) fn zoom_up(
    ui: &Ui,
    transform: &PlotTransform,
    area: egui::Rect,
    context: &mut ViewContext<'_>,
    (quantity, ends): (TraceQuantity, (f64, f64)),
) {
    let Some(at) = ui.input(|input| input.pointer.hover_pos()).filter(|at| area.contains(*at)) else {
        return;
    };
    let over_axis = at.x < transform.frame().left();
    if !ui.rect_contains_pointer(area) || !(over_axis || ui.input(|input| input.modifiers.shift)) {
        return;
    }
    // with Shift a wheel goes sideways
    let turned = ui.input(|input| input.smooth_scroll_delta().x + input.smooth_scroll_delta().y);
    let by = (-f64::from(turned) / 200.0).exp();
    if by == 1.0 || !by.is_finite() {
        return;
    }
    let own = &mut context.memory.timeline.vertical[quantity as usize];
    let (low, high) = own.unwrap_or(ends);
    let y = transform.value_from_position(at).y.clamp(low, high);
    let least = SHORTEST * (ends.1 - ends.0);
    let by = by.max(least / (high - low));
    let new = (y - (y - low) * by, y + (high - y) * by);
    // all that there is, is as good as nothing chosen
    *own = (new.1 - new.0 < ends.1 - ends.0).then_some(new);
}
