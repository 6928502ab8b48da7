//! View of the present motion and a pinned one side by side, in step with the drive.

use eframe::egui::{self, Rect, RichText, Ui, UiBuilder, vec2};

use crate::app::session::pins::PinKind;
use crate::scene::{Scene, Stops};

use super::context::Drawn;
use super::mechanism::mechanism_ui;
use super::table::{shaking, stops};
use super::well::well_ui;
use super::{ViewContext, too_small_ui};

/// Height in points of the heading of a column.
const HEADING: f32 = 26.0;
/// Share of the remaining height for the mechanism.
const MECHANISM: f32 = 0.42;

/// Gap in points between the columns.
const GAP: f32 = 6.0;

pub fn side_by_side_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, style) = (ui.max_rect(), context.style);
    if area.width() < 240.0 || area.height() < 180.0 {
        return too_small_ui(ui, &style, area);
    }
    ui.painter().rect_filled(area, 0.0, style.ground());
    let count = context.session.pins.all().len();
    if count == 0 {
        return nothing_ui(ui, context, area);
    }
    let place = context.memory.beside_place.min(count - 1);
    let width = 0.5 * (area.width() - GAP);
    let (before, filled) = (context.drawn, context.filled);
    // both drawings use the axis that they share
    context.filled = false;
    for (i, drawn) in [Drawn::Alone, Drawn::Pinned(place)].into_iter().enumerate() {
        let corner = area.min + vec2(i as f32 * (width + GAP), 0.0);
        let column = Rect::from_min_size(corner, vec2(width, area.height()));
        context.drawn = drawn;
        let is_pin = drawn != Drawn::Alone;
        if is_pin {
            std::mem::swap(&mut context.memory.drawing, &mut context.memory.beside);
        }
        column_ui(ui, context, column, i);
        if is_pin {
            std::mem::swap(&mut context.memory.drawing, &mut context.memory.beside);
        }
    }
    (context.drawn, context.filled) = (before, filled);
    let x = area.center().x;
    ui.painter().vline(x, area.y_range(), style.ghost_stroke());
}

/// Column of a motion: heading, mechanism, well.
fn column_ui(ui: &mut Ui, context: &mut ViewContext<'_>, column: Rect, number: usize) {
    let heading = Rect::from_min_size(column.min, vec2(column.width(), HEADING));
    ui.scope_builder(UiBuilder::new().max_rect(heading.shrink2(vec2(8.0, 2.0))), |ui| {
        ui.horizontal_centered(|ui| heading_ui(ui, context));
    });
    let below = column.with_min_y(heading.bottom());
    let edge = below.top() + MECHANISM * below.height();
    for (part, rect) in [("mechanism", below.with_max_y(edge - 2.0)), ("well", below.with_min_y(edge + 2.0))]
    {
        let mut child = ui.new_child(UiBuilder::new().max_rect(rect).id_salt((part, number)));
        child.set_clip_rect(rect.intersect(ui.clip_rect()));
        match part {
            "mechanism" => mechanism_ui(&mut child, context),
            _ => well_ui(&mut child, context),
        }
    }
}

/// Name of a motion and its scene in words; for a pin, also the choice of the pin that is shown.
fn heading_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let description = |scene: &Scene| {
        let stops = if scene.stops == Stops::None { "no stops".to_owned() } else { stops(scene) };
        format!("{}, {stops}", shaking(scene))
    };
    let (scene, shown) = match context.drawn.pin(context.session) {
        None => {
            ui.label(RichText::new("now").heading());
            (context.session.scene(), None)
        }
        Some(pin) => (pin.scene(), Some(pin.letter())),
    };
    if let Some(shown) = shown {
        for (place, pin) in context.session.pins.all().iter().enumerate() {
            let button = ui.selectable_label(pin.letter() == shown, pin.letter().to_string());
            if button.on_hover_text("The pinned motion that is shown here.").clicked() {
                context.memory.beside_place = place;
            }
        }
    }
    let text = RichText::new(description(scene)).font(context.style.small()).color(context.style.faint());
    ui.add(egui::Label::new(text).truncate());
}

/// Placeholder while nothing is pinned.
fn nothing_ui(ui: &mut Ui, context: &mut ViewContext<'_>, area: Rect) {
    let text =
        "Nothing is pinned. A pinned motion goes on here beside the present one, with the drive in step.";
    let name = match context.session.scene().stops {
        Stops::None => "Beside it with stops",
        _ => "Beside it without stops",
    };
    ui.scope_builder(UiBuilder::new().max_rect(area.shrink(10.0)), |ui| {
        ui.add(egui::Label::new(RichText::new(text).color(context.style.faint())).wrap());
        if ui.button(name).clicked() {
            context.memory.pin = Some(PinKind::OtherStops);
        }
    });
}
