//! The map as a surface: the picture of its figure, with the scene as a ball on it.

use eframe::egui::{self, Color32, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui};

use crate::app::ui::style::Style;
use crate::app::ui::widgets::tell;
use crate::output::{Shade, View as MapShape};

use super::super::ViewContext;
use super::super::pane::{Pane, kept_pane_ui};
use super::super::plot::{plated_at, single_click};
use super::{is_inside, reading};

/// The picture of the map in `area`; a click takes the scene to a cell.
pub fn surface_ui(ui: &mut Ui, context: &mut ViewContext<'_>, area: Rect) {
    let (style, look) = (context.style, context.memory.map_look);
    let Some((map, _)) = context.session.map.shown() else { return };
    let quantity = context.session.map.quantity();
    let (place, scene) = (map.place(context.session.scene()), map.nearest_cell(context.session.scene()));
    let key = (context.session.map.version, quantity.name, style);
    let pane = kept_pane_ui(ui, &style, area, key, || {
        let mut chart = map.chart(quantity, &MapShape::Surface).unwrap_or_default();
        chart.subtitle.clear();
        chart
    });
    let Some(rect) = pane.surface() else { return };
    let named = ui.interact(rect, ui.scope_id().with("surface"), Sense::hover());
    tell(&named, egui::Role::Image, "map as a surface");
    let painter = ui.painter().with_clip_rect(area);
    if look.cuts {
        cuts(&painter, &style, &pane, scene);
    }
    // the scene is a ball above its place on the floor
    let ball = [height(&pane, scene).unwrap_or(0.0), 0.0].map(|z| at_height(&pane, scene, z));
    if let ([Some(at), Some(floor)], true) = (ball, is_inside(map, place)) {
        for stroke in style.marker_strokes() {
            painter.line_segment([at, floor], Stroke::new(0.6 * stroke.width, stroke.color));
        }
        painter.circle(at, 6.5, style.mass(), Stroke::new(1.5, Color32::BLACK));
    }
    if let Some(cell) = pane.response.hover_pos().and_then(|at| pane.surface_cell(at)) {
        if let Some(at) = height(&pane, cell).and_then(|z| at_height(&pane, cell, z)) {
            painter.circle_stroke(at, 5.0, style.cell_stroke());
        }
        plated_at(&painter, &style, area, &reading(map, quantity, cell));
    }
    let clicked = single_click(ui, ui.scope_id().with("click"), &pane.response, |at| pane.surface_cell(at));
    if let Some((column, row)) = clicked.flatten() {
        context.session.go_to_cell(column, row);
    }
}

/// The height of the surface at a cell, in the unit of its axis.
fn height(pane: &Pane, (column, row): (usize, usize)) -> Option<f64> {
    let (cells, _) = pane.chart.panels().next()?.surface()?;
    match cells.at(column, row) {
        Shade::Value(value) => Some(value),
        Shade::Rest => Some(0.0),
        Shade::Missing | Shade::Blank => None,
    }
}

/// The place on the screen of a cell of the surface at a height.
fn at_height(pane: &Pane, (column, row): (usize, usize), z: f64) -> Option<Pos2> {
    let (cells, _) = pane.chart.panels().next()?.surface()?;
    pane.place_on_surface((cells.across.values[column], cells.up.values[row], z))
}

/// Draws the lines of the cuts along a column and along a row of the surface.
fn cuts(painter: &Painter, style: &Style, pane: &Pane, (column, row): (usize, usize)) {
    let Some((cells, _)) = pane.chart.panels().next().and_then(|panel| panel.surface()) else { return };
    let upward = (0..cells.up.values.len()).map(|row| (column, row)).collect::<Vec<_>>();
    let across = (0..cells.across.values.len()).map(|column| (column, row)).collect();
    for line in [upward, across] {
        let places: Vec<Option<Pos2>> =
            line.into_iter().map(|cell| at_height(pane, cell, height(pane, cell)?)).collect();
        for part in places.split(Option::is_none) {
            let points: Vec<Pos2> = part.iter().flatten().copied().collect();
            painter.add(Shape::line(points.clone(), Stroke::new(style.width(3.6), Color32::BLACK)));
            painter.add(Shape::line(points, Stroke::new(style.width(1.6), Color32::WHITE)));
        }
    }
}
