//! View of the basins of attraction: the plane of starts, coloured by the attractor of each start.

use eframe::egui::{self, CursorIcon, Ui, UiBuilder};

use crate::app::session::explore::Level;
use crate::app::session::measured::sentence;
use crate::app::ui::widgets::tell;
use crate::app::words::numbers::three;
use crate::output::{Layer, Marks, Panel, PlotAxis, Role, Shade, Shades};
use interwell_studies::study::Edges;

use super::labels::pointer_rests;
use super::layer::by_kind;
use super::phase::starts;
use super::plot::{Plotted, kept, plot_ui};
use super::stops::{add_walls, stops_ui};
use super::{View, ViewContext, empty_ui};

pub fn basins_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, style) = (ui.max_rect(), context.style);
    // as in the phase portrait, the stops bound the axis
    let span = context.memory.reach(context.session);
    let speed = 1e3 * context.memory.ranges.follow(context.session).speed();
    let automatic = [(span.low * 1e3, span.high * 1e3), (-speed, speed)];
    // a zoomed range is computed anew with the same number of starts
    let [across, up] =
        context.memory.ends(View::Basins, automatic).map(|(low, high)| (low / 1e3, high / 1e3));
    context.session.want_basins(across, up);
    let basins = &context.session.explore.basins;
    let (parts, current) = basins.parts();
    let level = parts.last().cloned();
    let is_whole = basins.is_whole() && current;
    // the newest part of an answer may be as many as the last one of the answer before
    let key = (basins.question().cloned(), current, parts.len());
    let known = level.as_ref().and_then(|level| level.as_ref().ok());
    let mut panel = kept(ui, key, || shown(known));
    [(panel.x.low, panel.x.high), (panel.y.low, panel.y.high)] = automatic;
    let mut child = ui.new_child(UiBuilder::new().max_rect(area));
    if !current {
        child.set_opacity(0.4);
    }
    add_walls(&mut panel, context.session);
    let plotted = plot_ui(&mut child, context.memory, View::Basins, &style, area, &panel);
    tell(&plotted.response, egui::Role::Canvas, "basins of attraction");
    let frame = plotted.frame();
    match &level {
        Some(Ok(_)) => {}
        Some(Err(problem)) => empty_ui(ui, &style, frame, &sentence(problem)),
        None => {
            let so_far = basins.running_for().map(|time| format!(" {} s so far.", time.as_secs()));
            if so_far.is_some() {
                ui.ctx().request_repaint_after_secs(1.0);
            }
            let text = "The basins are being computed, first a coarse picture.";
            empty_ui(ui, &style, frame, &format!("{text}{}", so_far.unwrap_or_default()));
        }
    }
    let shared = std::mem::replace(&mut context.span, plotted.span());
    stops_ui(ui, context, frame, (frame.top(), frame.bottom()), (0.0, false));
    context.span = shared;
    let Some(level) = known else { return };
    // over the stops, at which a mass may rest
    let states = panel.layers.iter().filter(|layer| matches!(layer.marks, Marks::Points(_)));
    states.for_each(|layer| plotted.draw(ui, &style, &panel, layer));
    starts(&ui.painter().with_clip_rect(frame), context, |at| Some(plotted.place(at)), 1e3);
    pointer_ui(ui, context, &plotted, level, is_whole);
}

/// The picture in mm and mm/s without the stops, which the view draws to be dragged, and with a layer for
/// each attractor, which the legend hides.
fn shown(level: Option<&Level>) -> Panel {
    let axis = |words: &str| PlotAxis::between(0.0, 1.0, words);
    let mut panel = Panel::new(axis("displacement at the start (mm)"), axis("velocity at the start (mm/s)"));
    let Some(level) = level else { return panel };
    let per_unit = 1e3 / level.per_speed;
    for layer in level.chart.panels().flat_map(|panel| &panel.layers) {
        match &layer.marks {
            Marks::Cells(cells) => {
                let up: Vec<f64> = cells.up.values.iter().map(|v| v * per_unit).collect();
                let cells = Shades { up: Edges::new(&up), ..cells.clone() };
                panel.layers.extend(by_kind(Layer { marks: Marks::Cells(cells), ..layer.clone() }));
            }
            Marks::Points(states) => {
                panel.draw(
                    layer.role,
                    Marks::Points(states.iter().map(|(x, v)| (*x, v * per_unit)).collect()),
                );
            }
            _ if layer.role != Role::Stop => panel.layers.push(layer.clone()),
            _ => {}
        }
    }
    panel
}

/// Describes the start under the pointer; a click begins the scene there.
fn pointer_ui(ui: &Ui, context: &mut ViewContext<'_>, plotted: &Plotted, level: &Level, is_whole: bool) {
    // nothing begins beyond the stops
    let is_start = |(x_mm, _): &(f64, f64)| (level.room.0..=level.room.1).contains(&(x_mm / 1e3));
    if let Some((x_mm, v)) = plotted.clicked.filter(is_start) {
        context.session.start_at(x_mm / 1e3, v / 1e3);
    }
    let Some((x_mm, v)) = plotted.pointed().filter(is_start) else { return };
    let words = || {
        let cells = level.chart.panels().next()?.cells()?;
        let cell = cells.at(cells.across.cell(x_mm)?, cells.up.cell(v / 1e3 * level.per_speed)?);
        let Shade::Value(place) = cell else { return None };
        // after the attractors come those of starts that are not sure
        let (place, count) = (place as usize, level.answer.attractors.len());
        let words = level.answer.words().into_iter().nth(place % count.max(1))?;
        Some(if place < count { words } else { format!("{words}, not sure") })
    };
    let target = words().map_or("to no known attractor".to_owned(), |words| format!("to {words}"));
    let coarse = if is_whole { "" } else { " (coarse)" };
    plotted.write(ui, &context.style, &format!("{} mm, {} mm/s: {target}{coarse}", three(x_mm), three(v)));
    let response = plotted.response.clone().on_hover_cursor(CursorIcon::PointingHand);
    if pointer_rests(ui) {
        response.on_hover_text_at_pointer("Click: the scene begins here.");
    }
}
