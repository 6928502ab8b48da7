//! View of the basins of attraction: the plane of starts, coloured by the attractor of each start.

use eframe::egui::{self, Align2, Ui, UiBuilder, vec2};

use crate::app::session::explore::Level;
use crate::app::session::measured::sentence;
use crate::app::ui::widgets::tell;
use crate::app::words::numbers::{three, with_minus};
use crate::output::{Cell, Chart, Layer, Marks, Panel, PlotAxis, Role};

use super::hand::axes_input;
use super::labels::{plated, pointer_rests};
use super::pane::{Pane, kept_pane_ui};
use super::phase::starts;
use super::stops::stops_ui;
use super::view::Axis;
use super::{View, ViewContext, empty_ui};

pub fn basins_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    // as in the phase portrait, the stops bound the axis
    let reach = context.memory.reach(context.session, Some(Axis::Reach));
    let shared = std::mem::replace(&mut context.span, reach);
    plane_ui(ui, context);
    context.span = shared;
}

fn plane_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, style) = (ui.max_rect(), context.style);
    let speed = context.memory.ranges.follow(context.session).speed();
    let span = context.span;
    // a zoomed range is computed anew with the same number of starts
    let (low, high) = context.memory.axes.ends(Axis::Up(View::Basins), (-speed, speed));
    context.session.want_basins((span.low, span.high), (low, high));
    let basins = &context.session.explore.basins;
    let (parts, current) = basins.parts();
    let level = parts.last().cloned();
    let is_whole = basins.is_whole() && current;
    // the newest part of an answer may be as many as the last one of the answer before
    let key = (basins.question().cloned(), current, parts.len(), [span.low, span.high, low, high]);
    let mut child = ui.new_child(UiBuilder::new().max_rect(area));
    if !current {
        child.set_opacity(0.4);
    }
    let pane = kept_pane_ui(&mut child, &style, area, (key, style), || {
        let (chart, per_speed) = match &level {
            Some(Ok(level)) => (level.chart.clone(), level.per_speed),
            _ => (Chart::default(), 1e3),
        };
        shown(chart, (span.low * 1e3, span.high * 1e3), (low * per_speed, high * per_speed))
    });
    tell(&pane.response, egui::Role::Canvas, "basins of attraction");
    let Some(frame) = pane.frame(0) else { return };
    axes_input(ui, context.memory, View::Basins, &pane.response, (area, frame));
    match &level {
        Some(Ok(_)) => {}
        Some(Err(problem)) => empty_ui(ui, &style, frame, &sentence(problem)),
        None => empty_ui(ui, &style, frame, "The basins are being computed, first a coarse picture."),
    }
    stops_ui(ui, context, frame, (frame.top(), frame.bottom()), (0.0, false));
    if let Some(Ok(level)) = &level {
        // over the stops, at which a mass may rest
        let states = level.chart.panels().flat_map(|panel| &panel.layers);
        let states: Vec<Layer> = states.filter(|layer| is_state(layer)).cloned().collect();
        pane.draw(&ui.painter().with_clip_rect(frame), &style, 0, &states);
        starts(&ui.painter().with_clip_rect(frame), context, &pane, level.per_speed);
        pointer_ui(ui, context, &pane, level, is_whole);
    }
}

/// Whether it has the states of an attractor.
fn is_state(layer: &Layer) -> bool {
    matches!(layer.marks, Marks::Points(_))
}

/// The picture over these ends of its axes, without the stops, which the view draws to be dragged, and
/// without the states of the attractors.
fn shown(mut chart: Chart, across: (f64, f64), up: (f64, f64)) -> Chart {
    if chart.first_panel().is_none() {
        let axis = |words: &str| PlotAxis::between(0.0, 1.0, words);
        let panel = Panel::new(axis("displacement at the start (mm)"), axis("velocity at the start (mm/s)"));
        chart = Chart::stack(vec![panel], "", interwell_studies::study::Table::new());
    }
    if let Some(panel) = chart.first_panel() {
        panel.layers.retain(|layer| layer.role != Role::Stop && !is_state(layer));
        (panel.x, panel.y) = (panel.x.zoomed(across), panel.y.zoomed(up));
    }
    chart
}

/// Describes the start under the pointer in the lower corner; a click begins the scene there.
fn pointer_ui(ui: &Ui, context: &mut ViewContext<'_>, pane: &Pane, level: &Level, is_whole: bool) {
    let (Some(frame), Some((x_mm, speed))) = (pane.frame(0), pane.pointed()) else { return };
    let (x, v) = (x_mm / 1e3, speed / level.per_speed);
    if !(x >= level.room.0 && x <= level.room.1) {
        return; // nothing begins beyond the stops
    }
    let words = || {
        let cells = pane.chart.panels().next()?.cells()?;
        let cell = cells.at(cells.across.cell(x_mm)?, cells.up.cell(speed)?);
        let Cell::Value(place) = cell else { return None };
        level.answer.words().into_iter().nth(place as usize)
    };
    let target = words().map_or("to no known attractor".to_owned(), |words| format!("to {words}"));
    let coarse = if is_whole { "" } else { " (coarse)" };
    let text = with_minus(&format!("{} mm, {} mm/s: {target}{coarse}", three(x_mm), three(v * 1e3)));
    let at = (frame.right_bottom() - vec2(6.0, 4.0), Align2::RIGHT_BOTTOM);
    plated(ui.painter(), &context.style, at, &text, (context.style.small(), context.style.ink()));
    if pane.response.clicked() {
        context.session.start_at(x, v);
    }
    if pointer_rests(ui) {
        pane.response.clone().on_hover_text_at_pointer("Click: the scene begins here.");
    }
}
