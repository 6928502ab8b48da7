//! Stops as walls that can be dragged, wherever a view has the shared x axis.

use eframe::egui::{self, CursorIcon, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::controls::put_side;
use crate::app::session::stop_distances;
use crate::app::style::{BALL, GRAB};
use crate::scene::Scene;

use super::ViewContext;
use super::well::arrows;

/// Step in mm of a stop that the arrow keys move, as that of its slider.
const KEY_STEP: f64 = 0.05;

/// Thickness of a wall in points.
const WALL: f32 = 10.0;

/// Draws the stops over `rect` between the heights `top` and `bottom`, and lets them be dragged, for a mass that is drawn
/// as a ball. Whether they were.
pub fn stops_ui(ui: &mut Ui, context: &mut ViewContext<'_>, rect: Rect, top: f32, bottom: f32) -> bool {
    stops_beside_ui(ui, context, rect, (top, bottom), BALL)
}

/// The same for a mass that is drawn with another radius: 0 where a wall's face is the place of the stop.
pub fn stops_beside_ui(
    ui: &mut Ui,
    context: &mut ViewContext<'_>,
    rect: Rect,
    (top, bottom): (f32, f32),
    radius: f32,
) -> bool {
    let (left, right) = stop_distances(context.session.scene());
    let mut changed = false;
    for (mm, way) in [(left, -1.0_f32), (right, 1.0)] {
        let Some(mm) = mm else { continue };
        let x = context.span.screen_from_world(mm / 1e3, rect) + way * radius;
        let wall = Rect::from_two_pos(pos2(x, top), pos2(x + way * WALL, bottom));
        if x < rect.left() - WALL || x > rect.right() + WALL {
            continue;
        }
        let grab = wall.expand2(vec2((GRAB - WALL).max(0.0) * 0.5 + 3.0, 0.0));
        let name = if way < 0.0 { "left stop" } else { "right stop" };
        let id = ui.scope_id().with(name);
        let response =
            ui.interact(grab, id, Sense::drag()).on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
        response.widget_info(|| egui::WidgetInfo::slider(true, mm, name));
        let style = context.style;
        let color = if response.hovered() || response.dragged() { style.mass() } else { style.stop() };
        let painter = ui.painter().with_clip_rect(rect);
        painter.rect_filled(wall, 0.0, color);
        painter.extend(hatching(wall, way, Stroke::new(1.0, style.ground())));
        if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            let place = context.span.world_from_screen(pointer.x - way * (radius + 0.5 * WALL), rect) * 1e3;
            // a hundredth of a millimetre is finer than a hand
            let distance = (f64::from(way) * place * 100.0).round() / 100.0;
            changed |=
                context.session.edit(|scene| put_side(&mut scene.stops, way > 0.0, distance.max(0.05)));
            let text = format!("{distance:.2} mm");
            let align = if way > 0.0 { egui::Align2::LEFT_TOP } else { egui::Align2::RIGHT_TOP };
            let at = pos2(x + way * (WALL + 5.0), top);
            painter.text(at, align, text, style.body(), style.ink());
        }
        if response.has_focus() && !response.dragged() {
            let stroke = context.style.focus_stroke();
            ui.painter().rect_stroke(wall.expand(3.0), 2.0, stroke, egui::StrokeKind::Outside);
            let moved = arrows(ui, response.id) * f64::from(way);
            if moved != 0.0 {
                let distance = ((mm.abs() / KEY_STEP).round() + moved) * KEY_STEP;
                let edit = |scene: &mut Scene| put_side(&mut scene.stops, way > 0.0, distance.max(KEY_STEP));
                changed |= context.session.edit_once(edit);
            }
        }
        if response.drag_stopped() {
            context.session.end_gesture();
        }
    }
    changed
}

/// Strokes that tell a wall from a bar.
fn hatching(wall: Rect, way: f32, stroke: Stroke) -> Vec<Shape> {
    let count = (wall.height() / 8.0).floor().max(0.0) as usize;
    let line = |i: usize| {
        let y = wall.top() + 8.0 * (i as f32 + 0.2);
        let (inner, outer) =
            if way > 0.0 { (wall.left(), wall.right()) } else { (wall.right(), wall.left()) };
        Shape::line_segment([pos2(inner + way * 3.0, y), pos2(outer, (y + 6.0).min(wall.bottom()))], stroke)
    };
    (0..count.min(400)).map(line).collect()
}
