//! View of the map: every combination of two fields, each run from rest.

mod pointer;
mod scale;
mod surface;
mod tools;
mod trail;

use std::sync::Arc;

use eframe::egui::{self, Painter, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::session::best::LIMIT;
use crate::app::session::map::{Map, part, short};
use crate::app::ui::style::Style;
use crate::app::ui::widgets::tell;
use crate::app::words::columns::said;
use crate::app::words::kind::Kind;
use crate::app::words::numbers::three;
use crate::app::words::status::{speed, threshold};
use crate::dynamics::Summary;
use crate::output::{Marks, Panel, RMS, View as MapShape, suited_unit, words_of};
use crate::scene::{Stops, SweepAxis};
use interwell_studies::study::{Read, SummaryField, label_and_unit};

use super::labels::haloed;
use super::layer::by_kind;
use super::plot::{Part, Plotted, UPRIGHT, kept, part_ui, width};
use super::view::{Axis, View};
use super::zoom::Ends;
use super::{ViewContext, too_small_ui};

/// Least width and height in points of a map, and of one with cuts beside it.
const LEAST: egui::Vec2 = vec2(140.0, 110.0);
const ROOM_FOR_CUTS: egui::Vec2 = vec2(440.0, 170.0);

/// The panels of the map and of its cuts.
const MAP: usize = 0;
const ACROSS: usize = 1;
const UPWARD: usize = 2;
const NAMES: [&str; 3] = ["map", "cut across", "cut upward"];

/// The share of the view that a cut has.
const CUT: f32 = 0.33;
/// Width in points of the scale of colours.
const BAR: f32 = 14.0;

/// Half the diagonal in points of the mark of the best stops.
const BEST: f32 = 7.0;
/// Half the length in points of the arrow to a scene beyond the map.
const ARROW: f32 = 7.0;

/// The values of a scene on both axes of a map; `None` for a field that it lacks.
type Place = [Option<f64>; 2];

pub fn map_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let whole = enlarge(ui, context);
    if context.session.want_map(ui.input(|input| input.time)) {
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(100));
    }
    tools::tools_ui(ui, context);
    if let Some(problem) = &context.session.map.problem {
        ui.label(format!("  No map: {}", problem.lines().next().unwrap_or_default()));
    }
    let has_words = words_of(context.session.map.quantity().name).is_some();
    let is_surface = context.memory.map_look.surface && !has_words;
    if context.memory.map_look.surface && has_words {
        ui.label("  Words have no height: they are seen from above.");
    }
    let area = ui.available_rect_before_wrap();
    let Some(((_, is_current), whole)) = context.session.map.shown().zip(whole) else { return };
    if area.width() < LEAST.x || area.height() < LEAST.y {
        return too_small_ui(ui, &context.style, area);
    }
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(area));
    if !is_current {
        child.set_opacity(0.4);
    }
    match is_surface {
        true => surface::surface_ui(&mut child, context, area),
        false => flat_ui(&mut child, context, area, whole),
    }
}

/// The ends of both axes of the whole map, after the part that was chosen by hand, once no hand moves it, has
/// become a map of its own.
fn enlarge(ui: &Ui, context: &mut ViewContext<'_>) -> Option<[Ends; 2]> {
    let whole = context.session.map_whole()?;
    let memory = &mut *context.memory;
    let before = memory.map_axes.replace(whole.clone());
    if before.is_some_and(|before| before != whole) {
        memory.free_axes(View::Map);
    }
    let ends = whole.each_ref().map(|axis| {
        let steps = ((axis.to - axis.from) / axis.step + 1e-9).floor();
        (axis.from - 0.5 * axis.step, axis.from + (steps + 0.5) * axis.step)
    });
    let shown = memory.ends(View::Map, ends);
    let moves = |input: &egui::InputState| {
        input.pointer.any_down() || input.smooth_scroll_delta() != egui::Vec2::ZERO
    };
    if memory.chosen_axes(View::Map) == [None; 2] {
        context.session.map.enlarged = None;
    } else if !ui.input(moves) {
        let parts = [0, 1].map(|i| part(&whole[i], shown[i].0, shown[i].1));
        let is_new = |parts: &[SweepAxis; 2]| context.session.map.enlarged.as_ref() != Some(parts);
        if is_new(&parts) && context.session.map_problem(&parts).is_none() {
            context.session.map.enlarged = Some(parts);
        }
    }
    Some(ends)
}

/// The panels of the map: itself, its cuts, and the scale of its colours.
struct Panels {
    panels: Vec<Panel>,
    scale: Option<Panel>,
}

impl Panels {
    fn new(map: &Map, quantity: &SummaryField, shape: &MapShape) -> Self {
        let chart = map.chart(quantity, shape).unwrap_or_default();
        let mut panels: Vec<Panel> = chart.panels().cloned().collect();
        let mut scale = None;
        for panel in &mut panels {
            if let (Some(axis), Some(cells)) = (panel.bar.take(), panel.cells()) {
                scale = Some(scale::scale_of(&axis, &cells.colours));
            }
            let layers = std::mem::take(&mut panel.layers);
            panel.layers = layers.into_iter().flat_map(by_kind).collect();
        }
        Self { panels, scale }
    }
}

/// The map from above, with cuts through the cell of the scene beside it.
fn flat_ui(ui: &mut Ui, context: &mut ViewContext<'_>, area: Rect, whole: [Ends; 2]) {
    let (style, look) = (context.style, context.memory.map_look);
    let trail = if look.trail { context.session.map.trail_places() } else { Vec::new() };
    let Some((map, is_current)) = context.session.map.shown() else { return };
    let quantity = context.session.map.quantity();
    let (place, scene) = (map.place(context.session.scene()), map.nearest_cell(context.session.scene()));
    let has_cuts = look.cuts && area.width() > ROOM_FOR_CUTS.x && area.height() > ROOM_FOR_CUTS.y;
    let shape = MapShape::Cuts(if has_cuts { map.cuts(context.session.scene()) } else { Vec::new() });
    let key = (context.session.map.version, quantity.name, shape.clone());
    let drawn = kept(ui, key, || Arc::new(Panels::new(map, quantity, &shape)));
    // the scale is beside the map, and the cuts are below and to the right of both
    let mut rects = vec![area];
    if has_cuts {
        let (x, y) = (area.right() - CUT * area.width(), area.bottom() - CUT * area.height());
        rects = vec![
            Rect::from_min_max(area.min, pos2(x, y)),
            Rect::from_min_max(pos2(area.left(), y), pos2(x, area.bottom())),
            Rect::from_min_max(pos2(x, area.top()), pos2(area.right(), y)),
        ];
    }
    if drawn.scale.is_some() {
        rects.iter_mut().take(2).for_each(|rect| rect.max.x -= 2.0 * BAR + UPRIGHT);
    }
    let (across, up) = (Some(Axis::Across(View::Map)), Some(Axis::Up(View::Map)));
    let axes = [[across, up], [across, None], [None, up]];
    let mut plots: Vec<Plotted> = Vec::new();
    for (i, panel) in drawn.panels.iter().enumerate() {
        let name = if i == MAP { "" } else { NAMES[i] };
        let part = Part { view: View::Map, name, axes: axes[i] };
        let ends = [[Some(whole[0]), Some(whole[1])], [Some(whole[0]), None], [None, Some(whole[1])]];
        let plotted = part_ui(ui, context.memory, part, &style, rects[i], (panel, ends[i]));
        let named = ui.interact(plotted.frame(), ui.scope_id().with(NAMES[i]), Sense::hover());
        tell(&named, egui::Role::Image, NAMES[i]);
        if i != MAP && width(ui, &style, &panel.heading) < plotted.frame().width() {
            plotted.write(ui, &style, &panel.heading);
        }
        plots.push(plotted);
    }
    let Some(plotted) = plots.first() else { return };
    let frame = plotted.frame();
    if let Some(scale) = &drawn.scale {
        let left = frame.right() + BAR;
        scale::scale_ui(ui, &style, frame.with_min_x(left).with_max_x(left + BAR), scale);
    }
    let painter = ui.painter().with_clip_rect(frame);
    trail::draw(&painter, plotted, &style, &trail);
    best_stops(&painter, plotted, &style, map, place, context.session.best.limit_mm());
    cut_marks(ui, &plots, &drawn.panels, &style, scene);
    let at = marker(&painter, plotted, &style, place);
    let cell_at = |i: usize, (x, y): (f64, f64)| {
        let (column, row) = (map.edges[0].cell(x), map.edges[1].cell(y));
        match i {
            ACROSS => Some((column?, scene.1)),
            UPWARD => Some((scene.0, row?)),
            _ => column.zip(row),
        }
    };
    let chosen = plots.iter().enumerate().find_map(|(i, plot)| cell_at(i, plot.clicked?));
    let pointed = plots.iter().enumerate().find_map(|(i, plot)| cell_at(i, plot.pointed()?));
    match pointed.filter(|_| !plots.iter().any(|plot| plot.response.dragged())) {
        Some(cell) => {
            point_out(&painter, plotted, &style, map, cell);
            plotted.write(ui, &style, &reading(map, quantity, cell));
        }
        None if !is_current => plotted.write(ui, &style, "of the scene before"),
        None if place.contains(&None) || !is_inside(map, place) => {
            plotted.write(ui, &style, &place_in_words(context, place, quantity));
        }
        None => {}
    }
    let cell_under = |at| cell_at(MAP, plotted.values(at));
    let moved = pointer::cross_hair_ui(ui, &style, (at, scene), frame, map.size(), &cell_under);
    pointer::perform(context, chosen, moved);
}

/// Rings the cell of the scene in each cut.
fn cut_marks(ui: &Ui, plots: &[Plotted], panels: &[Panel], style: &Style, scene: (usize, usize)) {
    let Some(cells) = panels.first().and_then(Panel::cells) else { return };
    let (x, y) = (cells.across.values[scene.0], cells.up.values[scene.1]);
    for (i, (plot, panel)) in plots.iter().zip(panels).enumerate().skip(ACROSS) {
        let points = panel.layers.iter().find_map(|layer| match &layer.marks {
            Marks::Regimes(points, _) => Some(points),
            _ => None,
        });
        let is_scene = |point: &(f64, f64)| if i == ACROSS { point.0 == x } else { point.1 == y };
        let Some(at) = points.and_then(|points| points.iter().map(|point| point.0).find(is_scene)) else {
            continue;
        };
        let painter = ui.painter().with_clip_rect(plot.frame());
        for stroke in style.marker_strokes() {
            painter.circle_stroke(plot.place(at), 7.0, stroke);
        }
    }
}

/// Draws a diamond where the scene would stand with its best stops, at `limit` in mm, if the map has an axis
/// of the travel limit that reaches so far.
fn best_stops(
    painter: &Painter,
    plotted: &Plotted,
    style: &Style,
    map: &Map,
    place: Place,
    limit: Option<f64>,
) {
    let axis = map.question.axes.iter().position(|axis| axis.field == LIMIT);
    let (Some(axis), Some(limit)) = (axis, limit) else { return };
    let Some(other) = place[1 - axis] else { return };
    let at = plotted.place(if axis == 0 { (limit, other) } else { (other, limit) });
    if !plotted.frame().contains(at) {
        return;
    }
    let corners = [vec2(0.0, -BEST), vec2(BEST, 0.0), vec2(0.0, BEST), vec2(-BEST, 0.0)];
    for stroke in style.marker_strokes() {
        painter.add(Shape::closed_line(corners.map(|corner| at + corner).to_vec(), stroke));
    }
    let words = (at + vec2(0.0, -BEST - 3.0), egui::Align2::CENTER_BOTTOM);
    haloed(painter, style, words, "best stops", (style.small(), style.ink()));
}

/// Marks a cell by its outline.
fn point_out(painter: &Painter, plotted: &Plotted, style: &Style, map: &Map, (column, row): (usize, usize)) {
    let (x, y) = (&map.edges[0].edges, &map.edges[1].edges);
    let corners = [(x[column], y[row]), (x[column + 1], y[row + 1])].map(|corner| plotted.place(corner));
    let cell = Rect::from_two_pos(corners[0], corners[1]);
    painter.rect_stroke(cell, 0.0, style.cell_stroke(), egui::StrokeKind::Outside);
}

/// Whether a scene lies within the map.
fn is_inside(map: &Map, place: Place) -> bool {
    place.iter().zip(&map.edges).all(|(value, edges)| value.is_some_and(|value| edges.cell(value).is_some()))
}

/// The value of a column as text: `fastest impact 12.3 mm/s`.
fn value_text(quantity: &SummaryField, summary: &Summary) -> Option<String> {
    if let Some(word) = quantity.word(summary) {
        return Some(said(quantity.name, word));
    }
    let value = quantity.number(summary)?;
    if matches!(quantity.read, Read::Count(_)) {
        return Some(format!("{} {value:.0}", quantity.label));
    }
    let (factor, unit) = suited_unit(label_and_unit(quantity.name).1, std::iter::once(value));
    Some(format!("{} {} {unit}", quantity.label, three(value * factor)).trim_end().to_owned())
}

/// A cell in one line: its place, the motion and its value.
fn reading(map: &Map, quantity: &SummaryField, (column, row): (usize, usize)) -> String {
    let values = [map.edges[0].values[column], map.edges[1].values[row]];
    let names = map.grid().columns().iter().zip(values);
    let place = names.map(|(name, value)| format!("{} {}", short(value), label_and_unit(name).1));
    let place = place.map(|place| place.trim_end().to_owned()).collect::<Vec<String>>().join(", ");
    let Some((cell, has_run)) = map.cell(column, row) else { return format!("{place}: not run yet") };
    let mut words = Vec::new();
    if !has_run {
        words.push("not run yet, its neighbour".to_owned());
    }
    if !cell.is_done() {
        words.push(format!("ended early, {}", cell.outcome().replace('_', " ")));
    }
    words.extend(cell.settled().map(|settled| Kind::from(settled.regime).name().to_owned()));
    let value = cell.summary().and_then(|summary| value_text(quantity, summary));
    words.extend(value.filter(|_| quantity.name != "regime"));
    if cell.settled().is_some_and(|settled| settled.is_transient()) {
        words.push("not settled in this time".to_owned());
    }
    format!("{place}: {}", words.join("; "))
}

/// Where a scene beyond the map stands. A scene without stops has its value of the quantity and its threshold
/// beside it: the edge of the map is that of stops far out.
fn place_in_words(context: &ViewContext<'_>, place: Place, quantity: &SummaryField) -> String {
    let card = context.session.now_card();
    if card.scene.stops != Stops::None || !place.contains(&None) {
        return "now: further out".to_owned();
    }
    let crossing = card.thresholds.and_then(|found| threshold(&card.scene, &found.crossing));
    let crossing = crossing.map(|(amplitude, unit)| format!("; it crosses from {amplitude} {unit}"));
    let value = card.settled.as_ref().and_then(|settled| match settled.rms_velocity {
        Some(rms) if quantity.name == RMS => Some(format!("RMS velocity {} mm/s", speed(rms))),
        _ => value_text(quantity, settled),
    });
    let value = value.map(|value| format!(", {value}"));
    format!("now: no stops{}{}", value.unwrap_or_default(), crossing.unwrap_or_default())
}

/// Marks the scene by a ring, or by an arrow across the edge that it lies beyond. Returns the place.
fn marker(painter: &Painter, plotted: &Plotted, style: &Style, place: Place) -> egui::Pos2 {
    let frame = plotted.frame();
    let known = plotted.place((place[0].unwrap_or(0.0), place[1].unwrap_or(0.0)));
    // no stops count as stops far out
    let beyond = frame.right_top() + vec2(1.0, -1.0);
    let wanted = pos2(
        if place[0].is_some() { known.x } else { beyond.x },
        if place[1].is_some() { known.y } else { beyond.y },
    );
    let at = frame.clamp(wanted);
    if frame.contains(wanted) {
        for stroke in style.marker_strokes() {
            painter.circle_stroke(at, 8.0, stroke);
            for direction in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
                painter.line_segment([at + direction * 5.0, at + direction * 13.0], stroke);
            }
        }
        return at;
    }
    let sign = |by: f32| if by == 0.0 { 0.0 } else { by.signum() };
    let direction = vec2(sign(wanted.x - at.x), sign(wanted.y - at.y)).normalized();
    let (tip, back, side) = (at + direction * ARROW, at - direction * ARROW, direction.rot90() * ARROW);
    let ([halo, line], points) = (style.marker_strokes(), vec![tip, back + side, back - side]);
    let painter = painter.with_clip_rect(frame.expand(ARROW + 2.0));
    painter.add(Shape::convex_polygon(points, line.color, Stroke::new(1.5, halo.color)));
    at
}
