//! View of the basins of attraction: the plane of starts, coloured by the attractor of each start.

use eframe::egui::{
    self, Align2, Color32, Mesh, Painter, RichText, Sense, Shape, Stroke, Ui, UiBuilder, vec2,
};

use crate::app::session::explore::Level;
use crate::app::ui::style::Style;
use crate::app::words::numbers::three;
use crate::numeric::short;
use crate::study::{Attractor, Edges};

use super::chart::Chart;
use super::hand::axes_input;
use super::labels::{plated, pointer_rests};
use super::legend::Symbol;
use super::stops::stops_ui;
use super::view::Axis;
use super::{View, ViewContext, too_small_ui};

/// Radius in points of the mark of an attractor.
const MARK: f32 = 5.0;

/// Number of attractors that the legend names, those with the most starts.
const MAX_NAMED: usize = 6;

pub fn basins_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::click() | Sense::DRAG);
    if area.width() < 100.0 || area.height() < 100.0 {
        return too_small_ui(ui, &context.style, area);
    }
    let style = context.style;
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "basins of attraction"));
    let speed = context.memory.ranges.follow(context.session).speed();
    let span = context.span;
    // a zoomed range is computed anew with the same number of starts
    let (low, high) = context.memory.axes.ends(Axis::Up(View::Basins), (-speed, speed));
    context.session.want_basins((span.low, span.high), (low, high));
    let chart = Chart::new(area, span, low, high);
    axes_input(ui, context.memory, View::Basins, &response, (area, chart.rect));
    chart.axes(ui, context, 1e-3);
    let (parts, current) = context.session.explore.basins.parts();
    let level = parts.last().cloned();
    let whole = context.session.explore.basins.is_whole() && current;
    let mut legend: Vec<(Symbol, String)> = Vec::new();
    match &level {
        Some(Ok(level)) => {
            let painter = ui.painter().with_clip_rect(chart.rect);
            cells(&painter, &style, &chart, level, current);
            attractors(&painter, &style, &chart, level);
            legend = entries(&style, &level.answer.attractors);
        }
        Some(Err(problem)) => {
            ui.scope_builder(UiBuilder::new().max_rect(chart.rect.shrink(12.0)), |ui| {
                ui.label(RichText::new(problem).color(style.faint()));
            });
        }
        None => {}
    }
    let edges = (chart.rect.top(), chart.rect.bottom());
    stops_ui(ui, context, chart.rect, edges, 0.0);
    chart.numbers(ui, &style, "velocity at the start (mm/s)", 1e-3);
    if let Some(Ok(level)) = &level {
        pointer_ui(ui, &response, context, &chart, level, whole);
    }
    let entries: Vec<(Symbol, &str)> = legend.iter().map(|(sign, words)| (*sign, words.as_str())).collect();
    chart.legend(ui, &style, area.right(), &entries);
}

/// Draws each start in the colour of its attractor; starts without a known attractor keep the background.
fn cells(painter: &Painter, style: &Style, chart: &Chart, level: &Level, current: bool) {
    let (across, up) = (Edges::new(&level.axes.0), Edges::new(&level.axes.1));
    let rows = level.axes.1.len();
    let mut mesh = Mesh::default();
    for column in 0..level.axes.0.len() {
        let attractor = |row: usize| level.answer.rows[level.shown[column * rows + row]].map(|end| end.0);
        let all: Vec<Option<u32>> = (0..rows).map(attractor).collect();
        let mut row = 0;
        for run in all.chunk_by(|a, b| a == b) {
            let (from, to) = (row, row + run.len());
            row = to;
            let Some(place) = run[0].map(|number| number as usize - 1) else { continue };
            let colour = style.attractor(place);
            let colour = if current { colour } else { colour.gamma_multiply(0.4) };
            let corners = [
                chart.screen_from_world(across.edges[column] / 1e3, up.edges[from]),
                chart.screen_from_world(across.edges[column + 1] / 1e3, up.edges[to]),
            ];
            let first = mesh.vertices.len() as u32;
            for corner in [
                corners[0],
                egui::pos2(corners[1].x, corners[0].y),
                corners[1],
                egui::pos2(corners[0].x, corners[1].y),
            ] {
                mesh.colored_vertex(corner, colour);
            }
            mesh.add_triangle(first, first + 1, first + 2);
            mesh.add_triangle(first, first + 2, first + 3);
        }
    }
    painter.add(Shape::mesh(mesh));
}

/// Draws the states of the attractors at time 0 of the drive, in their colours.
fn attractors(painter: &Painter, style: &Style, chart: &Chart, level: &Level) {
    for (place, attractor) in level.answer.attractors.iter().enumerate() {
        for (x, v) in &attractor.states {
            let at = chart.screen_from_world(*x, *v);
            painter.circle_filled(at, MARK + 2.0, Color32::BLACK);
            painter.circle(at, MARK, style.attractor(place), Stroke::new(1.5, Color32::WHITE));
        }
    }
}

/// Legend entries of the attractors with the most starts, in falling order.
fn entries(style: &Style, attractors: &[Attractor]) -> Vec<(Symbol, String)> {
    let mut named: Vec<usize> = (0..attractors.len()).collect();
    named.sort_by_key(|place| std::cmp::Reverse(attractors[*place].starts));
    named.truncate(MAX_NAMED);
    named.into_iter().map(|i| (Symbol::Shade(style.attractor(i)), entry(&attractors[i]))).collect()
}

/// The kind of an attractor and the share of the starts that go to it.
fn entry(attractor: &Attractor) -> String {
    format!("{}: {} %", attractor.words(), short((1e2 * attractor.share.share).round()))
}

/// Describes the start under the pointer in the lower corner; a click begins the scene there.
fn pointer_ui(
    ui: &Ui,
    response: &egui::Response,
    context: &mut ViewContext<'_>,
    chart: &Chart,
    level: &Level,
    whole: bool,
) {
    let Some(pointer) = response.hover_pos().filter(|at| chart.rect.contains(*at)) else { return };
    let (x, v) = chart.world_from_screen(pointer);
    if !(x >= level.room.0 && x <= level.room.1) {
        return; // nothing begins beyond the stops
    }
    let (across, up) = (Edges::new(&level.axes.0), Edges::new(&level.axes.1));
    let cell = across.cell(x * 1e3).zip(up.cell(v));
    let place = cell.and_then(|(column, row)| {
        let row = level.shown[column * level.axes.1.len() + row];
        level.answer.rows[row].map(|end| end.0 as usize - 1)
    });
    let target = place.map_or("to none that is known".to_owned(), |place| {
        format!("to {}", level.answer.attractors[place].words())
    });
    let coarse = if whole { "" } else { " (coarse)" };
    let text = format!("{} mm, {} mm/s: {target}{coarse}", three(x * 1e3), three(v * 1e3));
    let at = (chart.rect.right_bottom() - vec2(6.0, 4.0), Align2::RIGHT_BOTTOM);
    plated(ui.painter(), &context.style, at, &text, (context.style.small(), context.style.ink()));
    if response.clicked() {
        context.session.start_at(x, v);
    }
    if pointer_rests(ui) {
        response.clone().on_hover_text_at_pointer("Click: the scene begins here.");
    }
}
