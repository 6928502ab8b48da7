//! Mark of the best stops on the map.

use eframe::egui::{Align2, Painter, Shape, vec2};

use crate::app::session::best::LIMIT;
use crate::app::session::map::Map;
use crate::app::ui::style::Style;

use super::super::labels::haloed;
use super::super::pane::Pane;
use super::MAP;

/// Half the diagonal of the mark in points.
const SIZE: f32 = 7.0;

/// Draws a diamond where the scene would stand with its best stops, at `limit` in mm. Draws nothing if the
/// map has no axis of the travel limit, or ends before it.
pub fn draw(
    painter: &Painter,
    pane: &Pane,
    map: &Map,
    place: [Option<f64>; 2],
    limit: Option<f64>,
    style: &Style,
) {
    let axis = map.question.axes.iter().position(|axis| axis.field == LIMIT);
    let (Some(axis), Some(limit)) = (axis, limit) else { return };
    let Some(other) = place[1 - axis] else { return };
    let (x, y) = if axis == 0 { (limit, other) } else { (other, limit) };
    let inside = pane.axes(MAP).is_some_and(|[across, up]| across.contains(x) && up.contains(y));
    let Some(at) = pane.place(MAP, (x, y)).filter(|_| inside) else { return };
    let corners = [vec2(0.0, -SIZE), vec2(SIZE, 0.0), vec2(0.0, SIZE), vec2(-SIZE, 0.0)];
    for stroke in style.marker_strokes() {
        painter.add(Shape::closed_line(corners.map(|corner| at + corner).to_vec(), stroke));
    }
    let words = (at + vec2(0.0, -SIZE - 3.0), Align2::CENTER_BOTTOM);
    haloed(painter, style, words, "best stops", (style.small(), style.ink()));
}
