//! View of the map: every combination of two fields, each run from rest.

mod coordinates;
mod picture;
mod pointer;
mod quantity;
mod tools;

use eframe::egui::{self, Align2, Color32, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::session::map::{Map, name_and_unit, short};
use crate::app::ui::style::Style;
use crate::app::words::kind::Kind;
use crate::app::words::status::speed;
use crate::dynamics::{Regime, Summary};
use crate::output::{PlotAxis, sweep_about};

use super::{ViewContext, too_small_ui};

use coordinates::Coordinates;
use picture::{Picture, bar, lines};
use quantity::ColourScale;
pub use quantity::MapQuantity;

/// Draws it.
pub fn map_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let style = context.style;
    ui.painter().rect_filled(ui.max_rect(), 0.0, style.ground());
    let time = ui.input(|input| input.time);
    if context.session.want_map(time) {
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(100));
    }
    tools::tools_ui(ui, context);
    if let Some(problem) = context.session.map.problem() {
        ui.label(format!("  No map: {}", problem.lines().next().unwrap_or_default()));
    }
    let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    let Some((map, current)) = context.session.map.shown() else { return };
    if area.width() < 140.0 || area.height() < 110.0 {
        return too_small_ui(ui, &style, area);
    }
    let quantity = context.memory.map_quantity;
    let scale = ColourScale::of(quantity, map);
    let id = ui.scope_id().with("picture");
    let old = ui.data(|data| data.get_temp::<Option<Picture>>(id)).flatten();
    let key = (context.session.map.version(), quantity, style, current);
    let picture = Picture::of(ui, old, map, &scale, key);
    let painter = ui.painter().with_clip_rect(area);
    let about = sweep_about(map.grid(), &map.question.scene, &[], None);
    let legend = tools::legend(&painter, area, &picture, map, &style, &about);
    let frame = Coordinates::new(area.with_min_y(legend), map, scale.bar.is_some());
    let spoken = ui.interact(frame.rect, ui.scope_id().with("cells"), Sense::hover());
    spoken.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "map"));
    picture.draw(&painter, &frame, &style);
    lines(&painter, &frame, map, &style);
    frame.axes(&painter, &style);
    bar(&painter, &frame, &scale, &style);
    if !current {
        painter.rect_filled(frame.rect, 0.0, style.veil());
        let words =
            if context.session.map.problem().is_some() { "not of this scene" } else { "of the scene before" };
        let at = frame.rect.center_top() + vec2(0.0, 8.0);
        painter.text(at, Align2::CENTER_TOP, words, style.body(), style.ink());
    }
    let place = context.session.place_on_map(&map.question);
    let at = marker(&painter, &frame, &style, place);
    let hovered = response.hover_pos().and_then(|at| cell_at(&frame, map, at));
    if let Some((column, row)) = hovered.filter(|_| !response.dragged()) {
        painter.add(outline(&frame, map, column, row, &style));
        let text = reading(map, column, row);
        let over = response.clone().on_hover_cursor(egui::CursorIcon::PointingHand);
        over.on_hover_text_at_pointer(text);
    }
    let hand = (&mut context.memory.map_pointer, context.session.map.is_enlarged());
    let wanted = pointer::action_ui(ui, (&response, &frame), map, hand, (&style, at));
    ui.data_mut(|data| data.insert_temp(id, Some(picture)));
    pointer::perform(context, wanted);
}

/// The cell at a place on the screen.
fn cell_at(frame: &Coordinates, map: &Map, at: Pos2) -> Option<(usize, usize)> {
    let (x, y) = frame.world_from_screen(at);
    map.edges[0].cell(x).zip(map.edges[1].cell(y))
}

/// The edge of a cell.
fn outline(frame: &Coordinates, map: &Map, column: usize, row: usize, style: &Style) -> Shape {
    let (x, y) = (&map.edges[0].edges, &map.edges[1].edges);
    let corners =
        [(x[column], y[row]), (x[column + 1], y[row + 1])].map(|corner| frame.screen_from_world(corner));
    let rect = Rect::from_two_pos(corners[0], corners[1]);
    Shape::rect_stroke(rect, 0.0, style.cell_stroke(), egui::StrokeKind::Outside)
}

/// What a cell says.
fn reading(map: &Map, column: usize, row: usize) -> String {
    let names = map.grid().columns();
    let place = [map.edges[0].values[column], map.edges[1].values[row]];
    let mut lines: Vec<String> = names.iter().zip(place).map(|(name, value)| named(name, value)).collect();
    match map.cell(column, row) {
        None => lines.push("not run yet".to_owned()),
        Some((cell, own)) => {
            if !own {
                lines.push("not run yet; its neighbour:".to_owned());
            }
            if !cell.is_done() {
                lines.push(format!("the run ended early: {}", cell.outcome().replace('_', " ")));
            }
            if let Some(settled) = cell.settled() {
                lines.push(Kind::from(settled.regime).name().to_owned());
            }
            let moves = |summary: &&Summary| summary.regime != Regime::Rest;
            if let Some(settled) = cell.settled().filter(moves) {
                let rms = settled.rms_velocity.map_or("-".to_owned(), speed);
                lines.push(format!("RMS velocity {rms} mm/s"));
                if let Some(reach) = settled.max_abs_x {
                    lines.push(format!("reach {:.2} mm", reach * 1e3));
                }
                lines.push(format!(
                    "{} impacts, {} crossings in {} s",
                    settled.impacts,
                    settled.crossings,
                    map.window_s()
                ));
                if let Some(period) = settled.period {
                    let plural = if period == 1 { "" } else { "s" };
                    lines.push(format!("repeats after {period} forcing period{plural}"));
                }
                if settled.settled == Some(false) {
                    lines.push("not settled in this time".to_owned());
                }
            }
            lines.push("click: take the scene there; drag: enlarge".to_owned());
        }
    }
    lines.join("\n")
}

/// `travel limit 1.5 mm` of a column's name and 1.5.
fn named(column: &str, value: f64) -> String {
    let number = short(value);
    match name_and_unit(column) {
        (name, Some(unit)) => format!("{name} {number} {unit}"),
        (name, None) => format!("{name} {number}"),
    }
}

/// Where the scene is: a ring, or an arrow at the edge that it lies beyond. The place of either.
fn marker(painter: &egui::Painter, frame: &Coordinates, style: &Style, place: [Option<f64>; 2]) -> Pos2 {
    // without a stop the mass goes as far as it would with one far out
    let (x, y) = (place[0].unwrap_or(f64::INFINITY), place[1].unwrap_or(f64::INFINITY));
    let inside = |axis: &PlotAxis, value: f64| (axis.low..=axis.high).contains(&value);
    let at =
        frame.screen_from_world((x.clamp(frame.x.low, frame.x.high), y.clamp(frame.y.low, frame.y.high)));
    if inside(&frame.x, x) && inside(&frame.y, y) {
        for stroke in style.marker_strokes() {
            painter.circle_stroke(at, 8.0, stroke);
            for way in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
                painter.line_segment([at + way * 5.0, at + way * 13.0], stroke);
            }
        }
        return at;
    }
    let way = vec2(
        if inside(&frame.x, x) { 0.0 } else { (x - frame.x.low).signum() as f32 },
        if inside(&frame.y, y) { 0.0 } else { -(y - frame.y.low).signum() as f32 },
    )
    .normalized();
    let (tip, back, side) = (at - way * 2.0, at - way * 16.0, way.rot90() * 8.0);
    let ([halo, line], points) = (style.marker_strokes(), vec![tip, back + side, back - side]);
    painter.add(Shape::convex_polygon(points, line.color, Stroke::new(1.5, halo.color)));
    let words = if place[0].is_none() { "no stops" } else { "now: further out" };
    let galley = painter.layout_no_wrap(words.to_owned(), style.body(), Color32::PLACEHOLDER);
    let room = frame.rect.shrink(4.0);
    let size = galley.size();
    let wanted = back - way * (10.0 + 0.5 * size.x) - 0.5 * size;
    let corner = pos2(
        wanted.x.clamp(room.left(), (room.right() - size.x).max(room.left())),
        wanted.y.clamp(room.top(), (room.bottom() - size.y).max(room.top())),
    );
    painter.rect_filled(Rect::from_min_size(corner, size).expand(3.0), 3.0, style.ground());
    painter.galley_with_override_text_color(corner, galley, style.ink());
    at
}
