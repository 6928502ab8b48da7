//! View of the present motion and a pinned one side by side, in step with the drive.

use eframe::egui::{Label, Rect, RichText, Ui, UiBuilder, vec2};

use crate::app::session::pins::PinKind;
use crate::scene::{Scene, Stops};

use super::context::Drawn;
use super::table::{shaking, stops};
use super::{View, ViewContext, offer_ui};

/// Height in points of the heading of a column.
const HEADING: f32 = 26.0;
/// Share of the remaining height for the mechanism.
const MECHANISM: f32 = 0.42;

/// Gap in points between the columns.
const GAP: f32 = 6.0;

pub fn side_by_side_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let area = ui.max_rect();
    if context.session.pins.all().is_empty() {
        let text = "Nothing is pinned. A pinned motion continues here beside the present one, \
                    in step with the drive.";
        let name = match context.session.scene().stops {
            Stops::None => "Beside it with stops",
            _ => "Beside it without stops",
        };
        if offer_ui(ui, &context.style, area, text, name) {
            context.memory.pin = Some(PinKind::OtherStops);
        }
        return;
    }
    let place = context.memory.beside_place(context.session);
    let width = 0.5 * (area.width() - GAP);
    let (before, filled) = (context.drawn, context.filled);
    // both drawings use the axis that they share
    context.filled = false;
    for (i, drawn) in [Drawn::Alone, Drawn::Pinned(place)].into_iter().enumerate() {
        let corner = area.min + vec2(i as f32 * (width + GAP), 0.0);
        let column = Rect::from_min_size(corner, vec2(width, area.height()));
        context.drawn = drawn;
        // the pinned motion is drawn last, with a separate drawing in the memory
        if drawn != Drawn::Alone {
            std::mem::swap(&mut context.memory.drawing, &mut context.memory.beside);
        }
        column_ui(ui, context, column, i);
    }
    std::mem::swap(&mut context.memory.drawing, &mut context.memory.beside);
    (context.drawn, context.filled) = (before, filled);
    ui.painter().vline(area.center().x, area.y_range(), context.style.ghost_stroke());
}

/// Column of a motion: heading, mechanism, well.
fn column_ui(ui: &mut Ui, context: &mut ViewContext<'_>, column: Rect, number: usize) {
    let heading = Rect::from_min_size(column.min, vec2(column.width(), HEADING));
    ui.scope_builder(UiBuilder::new().max_rect(heading.shrink2(vec2(8.0, 2.0))), |ui| {
        ui.horizontal_centered(|ui| heading_ui(ui, context));
    });
    let below = column.with_min_y(heading.bottom());
    let edge = below.top() + MECHANISM * below.height();
    let (upper, lower) = (below.with_max_y(edge - 2.0), below.with_min_y(edge + 2.0));
    for (view, name, rect) in [(View::Mechanism, "mechanism", upper), (View::Well, "well", lower)] {
        let mut child = ui.new_child(UiBuilder::new().max_rect(rect).id_salt((name, number)));
        child.set_clip_rect(rect.intersect(ui.clip_rect()));
        view.ui(&mut child, context);
    }
}

/// Name of a motion and its scene in words; for a pin, also the choice of the pin that is shown.
fn heading_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let description = |scene: &Scene| {
        let stops = if scene.stops == Stops::None { "no stops".to_owned() } else { stops(scene) };
        format!("{}, {stops}", shaking(scene).0)
    };
    let scene = if let Some(shown) = context.drawn.pin(context.session) {
        for (place, pin) in context.session.pins.all().iter().enumerate() {
            let button = ui.selectable_label(pin.letter == shown.letter, pin.letter.to_string());
            if button.on_hover_text("The pinned motion that is shown here.").clicked() {
                context.memory.beside_place = place;
            }
        }
        &shown.scene
    } else {
        ui.label(RichText::new("now").heading());
        context.session.scene()
    };
    let text = RichText::new(description(scene)).font(context.style.small()).color(context.style.faint());
    ui.add(Label::new(text).truncate());
}
