//! View of the map: every combination of two fields, each run from rest.

mod best;
mod coordinates;
mod cuts;
mod picture;
mod pointer;
mod quantity;
mod surface;
mod tools;
mod trail;

use std::sync::Arc;

use eframe::egui::{self, Align2, Color32, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::session::map::{Map, short};
use crate::app::ui::style::Style;
use crate::app::words::kind::Kind;
use crate::app::words::status::speed;
use crate::dynamics::{Regime, Summary};
use crate::output::{PlotAxis, RMS, sweep_about};
use crate::study::label_and_unit;

use super::{ViewContext, too_small_ui};

use coordinates::Coordinates;
use picture::{Picture, bar};
use pointer::Targets;
use quantity::ColourScale;
use surface::Surface;

/// Width and height in points above which there is room for cuts.
const ROOM_FOR_CUTS: (f32, f32) = (440.0, 170.0);

/// The drawings of a map: seen from above, and as a surface.
#[derive(Clone)]
struct Drawings {
    picture: Picture,
    surface: Option<Arc<Surface>>,
}

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
    let look = context.memory.map_look;
    let trail = if look.trail { context.session.map.trail_places() } else { Vec::new() };
    let Some((map, current)) = context.session.map.shown() else { return };
    if area.width() < 140.0 || area.height() < 110.0 {
        return too_small_ui(ui, &style, area);
    }
    let quantity = context.session.map.quantity();
    let id = ui.scope_id().with("picture");
    let old = ui.data(|data| data.get_temp::<Option<Drawings>>(id)).flatten();
    let key = (context.session.map.version(), quantity.name, style, current);
    let (old, mut surface) = old.map_or((None, None), |old| (Some(old.picture), old.surface));
    let mut picture = Picture::of(ui, old, map, quantity, key);
    surface = surface.filter(|_| !picture.is_new());
    let scale = Arc::clone(&picture.scale);
    let painter = ui.painter().with_clip_rect(area);
    let about = sweep_about(map.grid(), &map.question.scene, &[], None);
    let is_surface = look.surface && scale.bar.is_some();
    let legend = tools::legend(&painter, area, &picture, map, &style, &about, look);
    let area = area.with_min_y(legend);
    let place = context.session.place_on_map(&map.question);
    let scene = nearest_cell(map, place);
    let spoken = |name: &str, rect: Rect| {
        let spoken = ui.interact(rect, ui.scope_id().with(("cells", name)), Sense::hover());
        spoken.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, name));
    };
    let pointer_state = &mut context.memory.map_pointer;
    let is_enlarged = context.session.map.is_enlarged();
    let wanted = if is_surface {
        let at = (area, painter.pixels_per_point());
        surface = surface.filter(|surface| surface.is_at(at));
        let drawn = surface.or_else(|| Surface::new(at, map, &scale, &style).map(Arc::new));
        surface = drawn.clone();
        let Some(drawn) = drawn else { return };
        spoken("map as a surface", drawn.rect());
        drawn.draw(&painter, &style);
        if look.cuts {
            drawn.cuts(&painter, map, &scale, scene);
        }
        veil(&painter, drawn.rect(), &style, current, context.session.map.problem().is_some());
        let ball = drawn.place_of(map, &scale, scene);
        if let Some(ball) = ball.filter(|_| is_inside(map, place)) {
            drawn.ball(&painter, &style, ball);
        }
        let cell_at = |at: Pos2| drawn.cell_at(at);
        let outline = |(column, row)| {
            let at = drawn.place_of(map, &scale, (column, row)).map_or(Pos2::ZERO, |ends| ends[0]);
            Shape::circle_stroke(at, 5.0, style.cell_stroke())
        };
        hover(&response, &painter, map, &scale, &cell_at, &outline);
        let at = ball.map_or(drawn.rect().left_top(), |ends| ends[0]);
        let places = Targets { cell_at: &cell_at, frame: None, rect: area, scene: (at, scene) };
        pointer::action_ui(ui, &response, map, pointer_state, is_enlarged, &style, &places)
    } else {
        let room = area.width() > ROOM_FOR_CUTS.0 && area.height() > ROOM_FOR_CUTS.1;
        let frame = Coordinates::new(area, map, scale.bar.is_some(), look.cuts && room);
        spoken("map", frame.rect);
        for (rect, name) in frame.strips.iter().flatten().zip(["cut across", "cut upward"]) {
            spoken(name, *rect);
        }
        picture.draw(&painter, &frame, map, &style);
        cuts::draw(&painter, &frame, map, &scale, scene, &style);
        trail::draw(&painter, &frame, &style, &trail);
        best::draw(&painter, &frame, map, place, context.session.best.limit_mm(), &style);
        frame.axes(&painter, &style, scale.bar.as_ref().map(|bar| bar.label.as_str()));
        if let Some(rect) = frame.bar {
            bar(&painter, rect, &scale, &style);
        }
        veil(&painter, frame.rect, &style, current, context.session.map.problem().is_some());
        let at = marker(&painter, &frame, &style, place);
        let cell_at = |at: Pos2| cell_at(&frame, map, scene, at);
        let outline = |(column, row)| outline(&frame, map, column, row, &style);
        hover(&response, &painter, map, &scale, &cell_at, &outline);
        let places = Targets { cell_at: &cell_at, frame: Some(&frame), rect: frame.rect, scene: (at, scene) };
        pointer::action_ui(ui, &response, map, pointer_state, is_enlarged, &style, &places)
    };
    ui.data_mut(|data| data.insert_temp(id, Some(Drawings { picture, surface })));
    pointer::perform(context, wanted);
}

/// Draws a veil over a map that is not that of the scene.
fn veil(painter: &egui::Painter, rect: Rect, style: &Style, current: bool, has_problem: bool) {
    if current {
        return;
    }
    painter.rect_filled(rect, 0.0, style.veil());
    let words = if has_problem { "not of this scene" } else { "of the scene before" };
    let at = rect.center_top() + vec2(0.0, 8.0);
    painter.text(at, Align2::CENTER_TOP, words, style.body(), style.ink());
}

/// Outlines the cell under the pointer and describes it.
fn hover(
    response: &Response,
    painter: &egui::Painter,
    map: &Map,
    scale: &ColourScale,
    cell_at: &dyn Fn(Pos2) -> Option<(usize, usize)>,
    outline: &dyn Fn((usize, usize)) -> Shape,
) {
    let cell = response.hover_pos().filter(|_| !response.dragged()).and_then(cell_at);
    let Some((column, row)) = cell else { return };
    painter.add(outline((column, row)));
    let over = response.clone().on_hover_cursor(egui::CursorIcon::PointingHand);
    over.on_hover_text_at_pointer(reading(map, scale, column, row));
}

/// Whether a scene lies within the map.
fn is_inside(map: &Map, place: [Option<f64>; 2]) -> bool {
    place.iter().zip(&map.edges).all(|(value, edges)| value.is_some_and(|value| edges.cell(value).is_some()))
}

/// The cell of a scene, or the nearest one at the edge. No stops count as stops far out.
fn nearest_cell(map: &Map, place: [Option<f64>; 2]) -> (usize, usize) {
    let near = |i: usize| {
        let (edges, value) = (&map.edges[i], place[i].unwrap_or(f64::INFINITY));
        let outside = if value < edges.ends().0 { 0 } else { edges.values.len() - 1 };
        edges.cell(value).unwrap_or(outside)
    };
    (near(0), near(1))
}

/// The cell at a screen position: of the map, or of the cuts through the cell of the `scene`.
fn cell_at(frame: &Coordinates, map: &Map, scene: (usize, usize), at: Pos2) -> Option<(usize, usize)> {
    let (x, y) = frame.world_from_screen(at);
    let (column, row) = (map.edges[0].cell(x), map.edges[1].cell(y));
    match frame.strips {
        Some([across, _]) if across.contains(at) => {
            let share = f64::from((at.x - across.left()) / across.width());
            let x = frame.x.low + share * (frame.x.high - frame.x.low);
            map.edges[0].cell(x).map(|column| (column, scene.1))
        }
        Some([_, beside]) if beside.contains(at) => row.map(|row| (scene.0, row)),
        _ => column.zip(row),
    }
}

fn outline(frame: &Coordinates, map: &Map, column: usize, row: usize, style: &Style) -> Shape {
    let (x, y) = (&map.edges[0].edges, &map.edges[1].edges);
    let corners =
        [(x[column], y[row]), (x[column + 1], y[row + 1])].map(|corner| frame.screen_from_world(corner));
    let rect = Rect::from_two_pos(corners[0], corners[1]);
    Shape::rect_stroke(rect, 0.0, style.cell_stroke(), egui::StrokeKind::Outside)
}

/// The columns that every reading contains.
const IN_EVERY_READING: [&str; 6] = [RMS, "regime", "max_abs_x_m", "impacts", "crossings", "period"];

/// Text on a cell.
fn reading(map: &Map, scale: &ColourScale, column: usize, row: usize) -> String {
    let names = map.grid().columns();
    let place = [map.edges[0].values[column], map.edges[1].values[row]];
    let mut lines: Vec<String> = names.iter().zip(place).map(|(name, value)| named(name, value)).collect();
    match map.cell(column, row) {
        None => lines.push("not run yet".to_owned()),
        Some((cell, has_run)) => {
            if !has_run {
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
                match settled.settled {
                    Some(false) if settled.is_transient() => {
                        lines.push("not settled in this time".to_owned())
                    }
                    Some(false) => lines.push("averages steady".to_owned()),
                    _ => {}
                }
            }
            lines.extend(scale.reading(cell).filter(|_| !IN_EVERY_READING.contains(&scale.column())));
            lines.push("click: take the scene there; drag: enlarge".to_owned());
        }
    }
    lines.join("\n")
}

/// Name, value and unit of a column: `travel limit 1.5 mm`.
fn named(column: &str, value: f64) -> String {
    let (name, unit) = label_and_unit(column);
    format!("{name} {} {unit}", short(value)).trim_end().to_owned()
}

/// Marks the scene by a ring, or by an arrow at the edge that it lies beyond. Returns the place.
fn marker(painter: &egui::Painter, frame: &Coordinates, style: &Style, place: [Option<f64>; 2]) -> Pos2 {
    // no stops count as stops far out
    let (x, y) = (place[0].unwrap_or(f64::INFINITY), place[1].unwrap_or(f64::INFINITY));
    let inside = |axis: &PlotAxis, value: f64| (axis.low..=axis.high).contains(&value);
    let at =
        frame.screen_from_world((x.clamp(frame.x.low, frame.x.high), y.clamp(frame.y.low, frame.y.high)));
    if inside(&frame.x, x) && inside(&frame.y, y) {
        for stroke in style.marker_strokes() {
            painter.circle_stroke(at, 8.0, stroke);
            for direction in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
                painter.line_segment([at + direction * 5.0, at + direction * 13.0], stroke);
            }
        }
        return at;
    }
    let direction = vec2(
        if inside(&frame.x, x) { 0.0 } else { (x - frame.x.low).signum() as f32 },
        if inside(&frame.y, y) { 0.0 } else { -(y - frame.y.low).signum() as f32 },
    )
    .normalized();
    let (tip, back, side) = (at - direction * 2.0, at - direction * 16.0, direction.rot90() * 8.0);
    let ([halo, line], points) = (style.marker_strokes(), vec![tip, back + side, back - side]);
    painter.add(Shape::convex_polygon(points, line.color, Stroke::new(1.5, halo.color)));
    let words = if place[0].is_none() { "no stops" } else { "now: further out" };
    let galley = painter.layout_no_wrap(words.to_owned(), style.body(), Color32::PLACEHOLDER);
    let room = frame.rect.shrink(4.0);
    let size = galley.size();
    let wanted = back - direction * (10.0 + 0.5 * size.x) - 0.5 * size;
    let corner = pos2(
        wanted.x.clamp(room.left(), (room.right() - size.x).max(room.left())),
        wanted.y.clamp(room.top(), (room.bottom() - size.y).max(room.top())),
    );
    painter.rect_filled(Rect::from_min_size(corner, size).expand(3.0), 3.0, style.ground());
    painter.galley_with_override_text_color(corner, galley, style.ink());
    at
}
