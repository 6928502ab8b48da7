//! View of the map: every combination of two fields, each run from rest.

mod pointer;
mod tools;
mod trail;

use eframe::egui::{self, Align2, Color32, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, vec2};

use crate::app::session::best::LIMIT;
use crate::app::session::map::{Map, short};
use crate::app::ui::style::Style;
use crate::app::ui::widgets::tell;
use crate::app::words::columns::said;
use crate::app::words::kind::Kind;
use crate::app::words::numbers::{UNKNOWN, three};
use crate::app::words::status::{speed, threshold};
use crate::dynamics::{Regime, Summary};
use crate::output::{Cell as DrawnCell, Marks, PlotAxis, RMS, View as MapShape, suited_unit, words_of};
use crate::scene::Stops;
use interwell_studies::study::{Read, SummaryField, label_and_unit};

use super::labels::{Taken, haloed};
use super::pane::{Pane, kept_pane_ui};
use super::{LegendRow, ViewContext, too_small_ui};

use pointer::Targets;

/// Width and height in points above which there is room for cuts.
const ROOM_FOR_CUTS: (f32, f32) = (440.0, 170.0);

/// The panels of the map and of its cuts.
const MAP: usize = 0;
const ACROSS: usize = 1;
const UPWARD: usize = 2;

/// Half the diagonal in points of the mark of the best stops.
const BEST: f32 = 7.0;

/// Number of places along a side of the map at which the words of that arrow may stand, less one.
const PLACES: usize = 12;

/// Half the length in points of the arrow to a scene beyond the map.
const ARROW: f32 = 7.0;

/// The values of a scene on both axes of a map; `None` for a field that it lacks.
type Place = [Option<f64>; 2];

pub fn map_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let style = context.style;
    if context.session.want_map(ui.input(|input| input.time)) {
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(100));
    }
    tools::tools_ui(ui, context);
    if let Some(problem) = &context.session.map.problem {
        ui.label(format!("  No map: {}", problem.lines().next().unwrap_or_default()));
    }
    let area = ui.available_rect_before_wrap();
    let look = context.memory.map_look;
    let trail = if look.trail { context.session.map.trail_places() } else { Vec::new() };
    let Some((map, current)) = context.session.map.shown() else { return };
    if area.width() < 140.0 || area.height() < 110.0 {
        return too_small_ui(ui, &style, area);
    }
    let quantity = context.session.map.quantity();
    let (place, scene) = (map.place(context.session.scene()), map.nearest_cell(context.session.scene()));
    let has_room = area.width() > ROOM_FOR_CUTS.0 && area.height() > ROOM_FOR_CUTS.1;
    let is_surface = look.surface && words_of(quantity.name).is_none();
    let shape = match (is_surface, look.cuts && has_room) {
        (true, _) => MapShape::Surface,
        (false, true) => MapShape::Cuts(map.cuts(context.session.scene())),
        (false, false) => MapShape::Cuts(Vec::new()),
    };
    // in a low view only the legend is above the map
    let is_short = LegendRow::given(ui).is_some();
    let key = (context.session.map.version, quantity.name, look, style, shape.clone(), is_short);
    let pane = kept_pane_ui(ui, &style, area, key, || {
        // a quantity that cannot be a surface is seen from above
        let above = || map.chart(quantity, &MapShape::Cuts(Vec::new()));
        let mut chart = map.chart(quantity, &shape).or_else(|_| above()).unwrap_or_default();
        if look.surface && words_of(quantity.name).is_some() {
            let rest = if is_short { String::new() } else { format!("; {}", chart.subtitle) };
            chart.subtitle = format!("words have no height: seen from above{rest}");
        } else if is_short {
            chart.subtitle.clear();
        }
        chart
    });
    let painter = ui.painter().with_clip_rect(area);
    let rect = pane.surface().or(pane.frame(MAP)).unwrap_or(area);
    let names = match pane.surface() {
        Some(_) => vec![(rect, "map as a surface")],
        None => [(MAP, "map"), (ACROSS, "cut across"), (UPWARD, "cut upward")]
            .into_iter()
            .filter_map(|(panel, name)| Some((pane.frame(panel)?, name)))
            .collect(),
    };
    for (rect, name) in names {
        let response = ui.interact(rect, ui.scope_id().with(("cells", name)), Sense::hover());
        tell(&response, egui::Role::Image, name);
    }
    let at = match pane.surface() {
        Some(_) => {
            if look.cuts {
                surface_cuts(&painter, &style, &pane, scene);
            }
            let ball = [height(&pane, scene).unwrap_or(0.0), 0.0].map(|z| surface_place(&pane, scene, z));
            // the scene is a ball above its place on the floor
            if let ([Some(at), Some(floor)], true) = (ball, is_inside(map, place)) {
                for stroke in style.marker_strokes() {
                    painter.line_segment([at, floor], Stroke::new(0.6 * stroke.width, stroke.color));
                }
                painter.circle(at, 6.5, style.mass(), Stroke::new(1.5, Color32::BLACK));
            }
            ball[0].unwrap_or(rect.left_top())
        }
        None => {
            trail::draw(&painter, &pane, &style, &trail);
            best_stops(&painter, &style, &pane, map, place, context.session.best.limit_mm());
            cut_marks(&painter, &style, &pane, scene);
            marker(&painter, &pane, &style, (place, &place_in_words(context, place, quantity)))
        }
    };
    if !current {
        // a veil over a map that is not that of the scene
        painter.rect_filled(rect, 0.0, style.veil());
        let has_problem = context.session.map.problem.is_some();
        let words = if has_problem { "not of this scene" } else { "of the scene before" };
        let at = rect.center_top() + vec2(0.0, 8.0);
        painter.text(at, Align2::CENTER_TOP, words, style.body(), style.ink());
    }
    let cell_at = |at: Pos2| cell_at(&pane, map, scene, at);
    let pointed = pane.hovered().filter(|_| !pane.response.dragged()).and_then(cell_at);
    if let Some(cell) = pointed.filter(|_| !context.memory.hushed) {
        point_out(&painter, &style, &pane, map, cell);
        let over = pane.response.clone().on_hover_cursor(egui::CursorIcon::PointingHand);
        over.on_hover_text_at_pointer(reading(map, quantity, cell, style.projector));
    }
    let is_enlarged = !context.session.map.enlarged.is_empty();
    let targets =
        Targets { map, is_enlarged, style, cell_at: &cell_at, pane: &pane, rect, scene: (at, scene) };
    let wanted = pointer::action_ui(ui, &mut context.memory.map_pointer, &targets);
    pointer::perform(context, wanted);
}

/// The height of the surface at a cell, in the unit of its axis.
fn height(pane: &Pane, (column, row): (usize, usize)) -> Option<f64> {
    let (cells, _) = pane.chart.panels().next()?.surface()?;
    match cells.at(column, row) {
        DrawnCell::Value(value) => Some(value),
        DrawnCell::Rest => Some(0.0),
        DrawnCell::Missing | DrawnCell::Blank => None,
    }
}

/// The place on the screen of a cell of the surface at a height.
fn surface_place(pane: &Pane, (column, row): (usize, usize), z: f64) -> Option<Pos2> {
    let (cells, _) = pane.chart.panels().next()?.surface()?;
    pane.place_on_surface((cells.across.values[column], cells.up.values[row], z))
}

/// Draws the lines of the cuts along a column and along a row of the surface.
fn surface_cuts(painter: &Painter, style: &Style, pane: &Pane, (column, row): (usize, usize)) {
    let Some((cells, _)) = pane.chart.panels().next().and_then(|panel| panel.surface()) else { return };
    let upward = (0..cells.up.values.len()).map(|row| (column, row)).collect::<Vec<_>>();
    let across = (0..cells.across.values.len()).map(|column| (column, row)).collect();
    for line in [upward, across] {
        let places: Vec<Option<Pos2>> =
            line.into_iter().map(|cell| surface_place(pane, cell, height(pane, cell)?)).collect();
        for part in places.split(Option::is_none) {
            let points: Vec<Pos2> = part.iter().flatten().copied().collect();
            painter.add(Shape::line(points.clone(), Stroke::new(style.width(3.6), Color32::BLACK)));
            painter.add(Shape::line(points, Stroke::new(style.width(1.6), Color32::WHITE)));
        }
    }
}

/// Rings the cell of the scene in each cut.
fn cut_marks(painter: &Painter, style: &Style, pane: &Pane, scene: (usize, usize)) {
    let panels: Vec<_> = pane.chart.panels().collect();
    for panel in [ACROSS, UPWARD] {
        let Some((cells, cut)) = panels[MAP].cells().zip(panels.get(panel)) else { continue };
        let (x, y) = (cells.across.values[scene.0], cells.up.values[scene.1]);
        let is_scene = |point: &&((f64, f64), &str)| match panel {
            ACROSS => point.0.0 == x,
            _ => point.0.1 == y,
        };
        let points = cut.layers.iter().find_map(|layer| match &layer.marks {
            Marks::Regimes(points, _) => points.iter().find(is_scene),
            _ => None,
        });
        if let Some(at) = points.and_then(|point| pane.place(panel, point.0)) {
            for stroke in style.marker_strokes() {
                painter.circle_stroke(at, 7.0, stroke);
            }
        }
    }
}

/// Draws a diamond where the scene would stand with its best stops, at `limit` in mm, if the map has an axis
/// of the travel limit that reaches so far.
fn best_stops(painter: &Painter, style: &Style, pane: &Pane, map: &Map, place: Place, limit: Option<f64>) {
    let axis = map.question.axes.iter().position(|axis| axis.field == LIMIT);
    let (Some(axis), Some(limit)) = (axis, limit) else { return };
    let Some(other) = place[1 - axis] else { return };
    let (x, y) = if axis == 0 { (limit, other) } else { (other, limit) };
    let inside = pane.axes(MAP).is_some_and(|[across, up]| across.contains(x) && up.contains(y));
    let Some(at) = pane.place(MAP, (x, y)).filter(|_| inside) else { return };
    let corners = [vec2(0.0, -BEST), vec2(BEST, 0.0), vec2(0.0, BEST), vec2(-BEST, 0.0)];
    for stroke in style.marker_strokes() {
        painter.add(Shape::closed_line(corners.map(|corner| at + corner).to_vec(), stroke));
    }
    let words = (at + vec2(0.0, -BEST - 3.0), Align2::CENTER_BOTTOM);
    haloed(painter, style, words, "best stops", (style.small(), style.ink()));
}

/// Marks a cell: its place on the surface, or its outline on the map.
fn point_out(painter: &Painter, style: &Style, pane: &Pane, map: &Map, (column, row): (usize, usize)) {
    let (x, y) = (&map.edges[0].edges, &map.edges[1].edges);
    let corners = [(x[column], y[row]), (x[column + 1], y[row + 1])].map(|corner| pane.place(MAP, corner));
    if let Some(at) = height(pane, (column, row)).and_then(|z| surface_place(pane, (column, row), z)) {
        painter.circle_stroke(at, 5.0, style.cell_stroke());
    } else if let [Some(a), Some(b)] = corners {
        let cell = Rect::from_two_pos(a, b);
        painter.rect_stroke(cell, 0.0, style.cell_stroke(), egui::StrokeKind::Outside);
    }
}

/// Whether a scene lies within the map.
fn is_inside(map: &Map, place: Place) -> bool {
    place.iter().zip(&map.edges).all(|(value, edges)| value.is_some_and(|value| edges.cell(value).is_some()))
}

/// The cell at a screen position: of the surface, of the map, or of the cuts through the cell of the `scene`.
fn cell_at(pane: &Pane, map: &Map, scene: (usize, usize), at: Pos2) -> Option<(usize, usize)> {
    if pane.surface().is_some() {
        return pane.surface_cell(at);
    }
    let panel = [MAP, ACROSS, UPWARD]
        .into_iter()
        .find(|panel| pane.frame(*panel).is_some_and(|frame| frame.contains(at)))?;
    let (x, y) = pane.values_at(panel, at)?;
    let (column, row) = (map.edges[0].cell(x), map.edges[1].cell(y));
    match panel {
        ACROSS => Some((column?, scene.1)),
        UPWARD => Some((scene.0, row?)),
        _ => column.zip(row),
    }
}

/// The columns that every reading contains.
const IN_EVERY_READING: [&str; 6] = [RMS, "regime", "max_abs_x_m", "impacts", "crossings", "period"];

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

/// Text on a cell. If it `is_brief`, only its place, the motion and the quantity of the map, for a projector,
/// by which a long text would hide the axes.
fn reading(map: &Map, quantity: &SummaryField, (column, row): (usize, usize), is_brief: bool) -> String {
    let names = map.grid().columns();
    let place = [map.edges[0].values[column], map.edges[1].values[row]];
    // such as `travel limit 1.5 mm`
    let named = |(column, value): (&String, f64)| {
        let (name, unit) = label_and_unit(column);
        format!("{name} {} {unit}", short(value)).trim_end().to_owned()
    };
    let mut lines: Vec<String> = names.iter().zip(place).map(named).collect();
    let Some((cell, has_run)) = map.cell(column, row) else {
        lines.push("not run yet".to_owned());
        return lines.join("\n");
    };
    if !has_run {
        lines.push("not run yet; its neighbour:".to_owned());
    }
    if !cell.is_done() {
        lines.push(format!("the run ended early: {}", cell.outcome().replace('_', " ")));
    }
    lines.extend(cell.settled().map(|settled| Kind::from(settled.regime).name().to_owned()));
    let value = cell.summary().and_then(|summary| value_text(quantity, summary));
    let is_said_below = !is_brief && IN_EVERY_READING.contains(&quantity.name);
    lines.extend(value.filter(|_| !is_said_below && quantity.name != "regime"));
    if is_brief {
        return lines.join("\n");
    }
    if let Some(settled) = cell.settled().filter(|settled| settled.regime != Regime::Rest) {
        let rms = settled.rms_velocity.map_or(UNKNOWN.to_owned(), speed);
        lines.push(format!("RMS velocity {rms} mm/s"));
        lines.extend(settled.max_abs_x.map(|reach| format!("reach {} mm", three(reach * 1e3))));
        let (impacts, crossings) = (settled.impacts, settled.crossings);
        lines.push(format!("{impacts} impacts, {crossings} crossings in {} s", map.window_s()));
        if let Some(period) = settled.period {
            let plural = if period == 1 { "" } else { "s" };
            lines.push(format!("repeats after {period} forcing period{plural}"));
        }
        if settled.settled == Some(false) {
            let is_steady = !settled.is_transient();
            lines.push(if is_steady { "averages steady" } else { "not settled in this time" }.to_owned());
        }
    }
    lines.push("click: take the scene there; drag: enlarge".to_owned());
    lines.join("\n")
}

/// Where a scene beyond the map stands. A scene without stops has its value of the quantity and its threshold
/// beside it: the edge of the map is that of stops far out.
fn place_in_words(context: &ViewContext<'_>, place: Place, quantity: &SummaryField) -> String {
    let card = context.session.now_card();
    if card.scene.stops != Stops::None || !place.contains(&None) {
        return "now: further out".to_owned();
    }
    let crossing = card.thresholds.and_then(|found| threshold(&card.scene, &found.crossing));
    let crossing = crossing.map(|(amplitude, unit)| format!("\nit crosses from {amplitude} {unit}"));
    let value = card.settled.as_ref().and_then(|settled| match settled.rms_velocity {
        Some(rms) if quantity.name == RMS => Some(format!("RMS velocity {} mm/s", speed(rms))),
        _ => value_text(quantity, settled),
    });
    let value = value.map(|value| format!(", {value}"));
    format!("now: no stops{}{}", value.unwrap_or_default(), crossing.unwrap_or_default())
}

/// Marks the scene by a ring, or by an arrow across the edge that it lies beyond, with these words where they
/// hide no line. Returns the place.
fn marker(painter: &Painter, pane: &Pane, style: &Style, (place, words): (Place, &str)) -> Pos2 {
    let Some(([across, up], frame)) = pane.axes(MAP).zip(pane.frame(MAP)) else { return Pos2::ZERO };
    // no stops count as stops far out
    let (x, y) = (place[0].unwrap_or(f64::INFINITY), place[1].unwrap_or(f64::INFINITY));
    let nearest = |axis: &PlotAxis, value: f64| value.clamp(axis.low, axis.high);
    let at = pane.place(MAP, (nearest(across, x), nearest(up, y))).unwrap_or(frame.center());
    if across.contains(x) && up.contains(y) {
        for stroke in style.marker_strokes() {
            painter.circle_stroke(at, 8.0, stroke);
            for direction in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
                painter.line_segment([at + direction * 5.0, at + direction * 13.0], stroke);
            }
        }
        return at;
    }
    let beyond = |axis: &PlotAxis, value: f64| match axis.contains(value) {
        true => 0.0,
        false => (value - axis.low).signum() as f32,
    };
    let direction = vec2(beyond(across, x), -beyond(up, y)).normalized();
    let (tip, back, side) = (at + direction * ARROW, at - direction * ARROW, direction.rot90() * ARROW);
    let ([halo, line], points) = (style.marker_strokes(), vec![tip, back + side, back - side]);
    painter.add(Shape::convex_polygon(points, line.color, Stroke::new(1.5, halo.color)));
    let lines = pane.chart.panels().next().into_iter().flat_map(|panel| &panel.layers);
    let lines = lines.filter_map(|layer| match &layer.marks {
        Marks::Path(points) => Some(points.iter().filter_map(|point| pane.place(MAP, *point)).collect()),
        _ => None,
    });
    let mut taken = Taken { lines: lines.collect(), places: Vec::new(), plate: Some(style.ground()) };
    let (room, look) = (frame.shrink(4.0), (style.body(), style.ink()));
    let size = painter.layout_no_wrap(words.to_owned(), look.0.clone(), look.1).size();
    let cells = pane.chart.panels().next().and_then(|panel| panel.cells());
    let is_at_rest = |at: Pos2| {
        let cell = pane
            .values_at(MAP, at)
            .zip(cells)
            .and_then(|((x, y), cells)| Some(cells.at(cells.across.cell(x)?, cells.up.cell(y)?)));
        cell.is_some_and(|cell| matches!(cell, DrawnCell::Rest))
    };
    let steps = || (0..=PLACES).map(|step| step as f32 / PLACES as f32);
    let mut places: Vec<Rect> = steps()
        .flat_map(|across| steps().map(move |up| vec2(across, up)))
        .map(|share| Rect::from_min_size(room.min + share * (room.size() - size), size))
        .collect();
    // near the arrow, and best where the cells say no more than that the mass rests
    let hides = |place: &Rect| {
        let points = steps().map(|share| place.lerp_inside(vec2(share, 0.0)));
        let points = points.chain(steps().map(|share| place.lerp_inside(vec2(share, 1.0))));
        points.into_iter().any(|at| !is_at_rest(at))
    };
    places.sort_by_cached_key(|place| (hides(place), place.distance_to_pos(at) as u32));
    let places: Vec<_> = places.iter().map(|place| (words, place.min, Align2::LEFT_TOP)).collect();
    if taken.write(painter, room, look.clone(), places.iter().copied()).is_none() {
        taken.lines.clear();
        taken.write(painter, room, look, places);
    }
    at
}
