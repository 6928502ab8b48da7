//! Stops as walls that can be dragged, in every view with the shared x axis.

use eframe::egui::{self, Align2, CursorIcon, Painter, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::session::Session;
use crate::app::session::sliders::reach;
use crate::app::ui::style::GRAB;
use crate::app::ui::widgets::arrows;
use crate::app::words::fields::info;
use crate::app::words::numbers::{decimal, decimals, shown, with_minus};
use crate::dynamics::Model;
use crate::output::{Marks, Panel, Role, Side};
use crate::scene::Stops;

use super::ViewContext;
use super::labels::plated;

/// Resolution of a drag, in steps of the slider of a stop.
const FINE: f64 = 0.2;

/// The step in mm of the slider of a stop, which the arrow keys take as well.
pub(super) fn key_step(session: &Session) -> f64 {
    info("stops.travel_limit_mm").map_or(0.05, |field| reach(field, session).step)
}

/// What the best stops are called in a legend.
pub(super) const BEST_STOPS: &str = "best stops";

/// Thickness of a wall in points.
pub(super) const WALL: f32 = 10.0;

/// The stops of a model in m, each with the direction from the middle to it.
pub(super) fn sides(model: &Model) -> impl Iterator<Item = (f64, f32)> {
    let (left, right) = model.stop_positions();
    [(left, -1.0), (right, 1.0)].into_iter().filter_map(|(x, side)| Some((x?, side)))
}

/// Displacements in mm of the stops of the motion shown, and whether they can be moved: not those of the past
/// if they differed then.
fn shown_stops(session: &Session) -> ([Option<f64>; 2], bool) {
    let then = <[_; 2]>::from(session.shown().stop_positions()).map(|stop| stop.map(|x| x * 1e3));
    let present = session.scene().stops.positions_mm();
    if !session.player.is_past() {
        return (present, true);
    }
    let are_equal = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-9 * a.abs().max(b.abs()),
        _ => a == b,
    };
    (then, are_equal(then[0], present[0]) && are_equal(then[1], present[1]))
}

/// The displacement of a stop in mm, with the decimals of its field.
fn limit_number(session: &Session, mm: f64) -> String {
    with_minus(&shown(mm, decimals(key_step(session))))
}

/// Height in points of a row of travel limits.
const LIMIT_ROW: f32 = 18.0;

/// Writes the travel limits outside of the stops, and of those that a question asks about, in `rect`.
pub(super) fn travel_limits(painter: &Painter, context: &ViewContext<'_>, rect: Rect) {
    let style = context.style;
    // those that a question asks about stand above those that are there
    for (row, stops) in [shown_stops(context.session).0, context.memory.asked_stops].into_iter().enumerate() {
        for (mm, side) in stops.into_iter().zip([-1.0, 1.0]) {
            let Some(mm) = mm else { continue };
            let x = context.span.screen_from_world(mm / 1e3, rect) + side * (WALL + 4.0);
            let align = if side > 0.0 { Align2::LEFT_BOTTOM } else { Align2::RIGHT_BOTTOM };
            let at = (pos2(x, rect.bottom() - 4.0 - LIMIT_ROW * row as f32), align);
            let number = limit_number(context.session, mm);
            let number = painter.layout_no_wrap(number, style.small(), style.ink());
            if rect.x_range().contains(x + side * number.size().x) {
                plated(painter, &style, at, number);
            }
        }
    }
}

/// Adds the stops of the motion shown to a picture over displacements in mm.
pub(super) fn add_walls(panel: &mut Panel, session: &Session) {
    for (mm, side) in shown_stops(session).0.into_iter().zip([Side::Left, Side::Right]) {
        if let Some(mm) = mm {
            panel.layer(Role::Stop, "", Marks::Wall(mm, side));
        }
    }
}

/// The best travel limit in mm while it is shown, unless the stops of the motion drawn are there already.
pub fn best_stops(context: &ViewContext<'_>) -> Option<f64> {
    let session = &context.session;
    session.best.limit_mm().filter(|_| !session.is_at_best_stops())
}

/// The stops that are outlined: their displacements in mm, their sides, and the lines. A question asks about
/// some, and the best stops are shown while their card is open.
pub(super) fn outlined(context: &ViewContext<'_>) -> impl Iterator<Item = (f64, f32, Stroke)> {
    let asked = context.memory.asked_stops.map(|mm| (mm, context.style.stop_stroke()));
    let best = best_stops(context);
    let best = [best.map(|mm| -mm), best].map(|mm| (mm, context.style.stroke(Role::BestStop)));
    let all = asked.into_iter().chain(best).zip([-1.0, 1.0, -1.0, 1.0]);
    all.filter_map(|((mm, stroke), side)| Some((mm?, side, stroke)))
}

/// Where stops that a question asks about would set a mass at `x`, in m; `None` if it stands between them.
pub(super) fn asked_place(context: &ViewContext<'_>, x: f64) -> Option<f64> {
    let [left, right] = context.memory.asked_stops.map(|stop| stop.map(|mm| mm / 1e3));
    let place = left.map_or(x, |left| x.max(left));
    let place = right.map_or(place, |right| place.min(right));
    (place != x).then_some(place)
}

/// Lets the stops over `rect` between the heights `top` and `bottom` be dragged. In a drawing the face of a
/// stop is drawn `radius` points, the half width of the mass, outside its travel limit. A stop that is
/// dragged has its number, unless the view writes travel limits itself.
pub fn stops_ui(
    ui: &mut Ui,
    context: &mut ViewContext<'_>,
    rect: Rect,
    (top, bottom): (f32, f32),
    (radius, has_limits): (f32, bool),
) {
    walls_ui(ui, context, rect, (top, bottom), (radius, has_limits));
    // over the walls, so that an edge behind a wall is seen
    for (mm, side, stroke) in outlined(context) {
        let x = context.span.screen_from_world(mm / 1e3, rect) + side * radius;
        let ends = [pos2(x, top), pos2(x + side * WALL, top), pos2(x + side * WALL, bottom), pos2(x, bottom)];
        let outline = Shape::dashed_line(&[&ends[..], &ends[..1]].concat(), stroke, 5.0, 4.0);
        ui.painter().with_clip_rect(rect).extend(outline);
    }
}

fn walls_ui(
    ui: &mut Ui,
    context: &mut ViewContext<'_>,
    rect: Rect,
    (top, bottom): (f32, f32),
    (radius, has_limits): (f32, bool),
) {
    let (stops, movable) = shown_stops(context.session);
    let step = key_step(context.session);
    let fine = FINE * step;
    // the nearest to x = 0 that a stop may come; unequal ones may pass it up to the other stop
    let beyond = |other: Option<f64>| other.map_or(f64::NEG_INFINITY, |other| decimal(other + step));
    let nearest = match context.session.scene().stops {
        Stops::Uneven { .. } => [beyond(stops[1].map(|mm| -mm)), beyond(stops[0])],
        _ => [step; 2],
    };
    for ((mm, side), nearest) in stops.into_iter().zip([-1.0_f32, 1.0]).zip(nearest) {
        let Some(mm) = mm else { continue };
        let x = context.span.screen_from_world(mm / 1e3, rect) + side * radius;
        let wall = Rect::from_two_pos(pos2(x, top), pos2(x + side * WALL, bottom));
        if x < rect.left() - WALL || x > rect.right() + WALL {
            continue;
        }
        let grab = wall.expand2(vec2((GRAB - WALL).max(0.0) * 0.5 + 3.0, 0.0));
        let name = if side < 0.0 { "left stop" } else { "right stop" };
        let id = ui.scope_id().with(name);
        let style = context.style;
        let painter = ui.painter().with_clip_rect(rect);
        // in a chart it is a layer
        if radius > 0.0 {
            painter.rect_filled(wall, 0.0, style.stop());
            painter.extend(hatching(wall, side, Stroke::new(1.0, style.ground())));
        }
        if !movable {
            let at = limit_number(context.session, mm);
            let then = format!("At that time the stop was at {at} mm. The controls change the present stop.");
            ui.interact(grab, id, Sense::hover()).on_hover_text(then);
            continue;
        }
        let response =
            ui.interact(grab, id, Sense::drag()).on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
        response.widget_info(|| egui::WidgetInfo::slider(true, mm, name));
        if response.hovered() || response.dragged() {
            let edge = Stroke::new(2.0, style.ink());
            painter.rect_stroke(wall.expand(1.0), 1.0, edge, egui::StrokeKind::Outside);
        }
        if response.drag_started() {
            context.session.end_presses();
            ui.data_mut(|data| data.insert_temp(id, mm));
        }
        if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            let begin = ui.input(|input| input.pointer.press_origin()).unwrap_or(pointer);
            let [from, to] = [begin, pointer].map(|at| context.span.world_from_screen(at.x, rect) * 1e3);
            let place = ui.data(|data| data.get_temp(id)).unwrap_or(mm) + to - from;
            // 0.01 mm for the prototype, which is finer than a hand
            let distance = decimal((f64::from(side) * place / fine).round() * fine).max(nearest) + 0.0;
            context.session.edit(|scene| scene.stops.set_limit(side > 0.0, distance));
            if !has_limits {
                let text = format!("{} mm", limit_number(context.session, distance));
                let align = if side > 0.0 { Align2::LEFT_TOP } else { Align2::RIGHT_TOP };
                let at = pos2(x + side * (WALL + 5.0), top);
                painter.text(at, align, text, style.body(), style.ink());
            }
        }
        if response.has_focus() && !response.dragged() {
            let stroke = context.style.focus_stroke();
            ui.painter().rect_stroke(wall.expand(3.0), 2.0, stroke, egui::StrokeKind::Outside);
            let moved = arrows(ui, response.id) * f64::from(side);
            if moved != 0.0 {
                let from = (f64::from(side) * mm / step).round();
                let distance = decimal((from + moved) * step).max(nearest) + 0.0;
                context.session.press(name, ui.input(|input| input.time));
                context.session.edit(|scene| scene.stops.set_limit(side > 0.0, distance));
            }
        }
        if response.drag_stopped() {
            context.session.end_gesture();
        }
    }
}

/// Hatching that distinguishes a wall from a bar.
fn hatching(wall: Rect, side: f32, stroke: Stroke) -> Vec<Shape> {
    let count = (wall.height() / 8.0).floor().max(0.0) as usize;
    let line = |i: usize| {
        let y = wall.top() + 8.0 * (i as f32 + 0.2);
        let (inner, outer) =
            if side > 0.0 { (wall.left(), wall.right()) } else { (wall.right(), wall.left()) };
        Shape::line_segment([pos2(inner + side * 3.0, y), pos2(outer, (y + 6.0).min(wall.bottom()))], stroke)
    };
    (0..count.min(400)).map(line).collect()
}
