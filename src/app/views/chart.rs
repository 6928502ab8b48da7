//! Charts over displacement: coordinates, axes, readout.
//!
//! All views share the x axis right of a column for the vertical axis, so that pictures above each other line
//! up.

use std::f32::consts::FRAC_PI_2;

use eframe::egui::epaint::TextShape;
use eframe::egui::{Align2, Painter, Pos2, Rect, Stroke, Ui, pos2, vec2};

use crate::app::ui::style::Style;
use crate::mechanics::Landscape;

use super::ViewContext;
use super::labels::haloed;
use super::legend::{LEGEND, Symbol, legend};
use super::plot::named;
use super::span::Span;

/// Distance in points outside the picture at which positions are clamped.
const FAR: f32 = 4000.0;

/// Distance in points between two samples of a curve.
pub const CURVE_STEP: f32 = 2.0;

/// Radius in points of the mark of an equilibrium.
const MARK: f32 = 5.0;

/// Width in points of the name and the numbers of a vertical axis, left of the picture.
pub const GUTTER: f32 = 54.0;

/// Height in points of the numbers of the x axis.
pub const NUMBERS: f32 = 22.0;
/// Height in points of its name.
pub const NAME: f32 = 16.0;

/// Smallest distance in points between the numbers of a vertical axis.
const ROW: f32 = 13.0;

/// Coordinates of a chart.
#[derive(Debug, Clone, Copy)]
pub struct Chart {
    /// The whole chart.
    pub area: Rect,
    /// The plot area.
    pub rect: Rect,
    span: Span,
    /// Ends of the vertical axis.
    low: f64,
    high: f64,
}

impl Chart {
    /// A picture in `area` with a vertical axis from `low` to `high`.
    pub fn new(area: Rect, span: Span, low: f64, high: f64) -> Self {
        let rect = Rect::from_min_max(area.min + vec2(GUTTER, LEGEND), area.max - vec2(0.0, NUMBERS + NAME));
        Self { area, rect, span, low, high }
    }

    /// Screen position of a displacement in m and a value of the vertical axis.
    pub fn screen_from_world(&self, x: f64, y: f64) -> Pos2 {
        let share = (y - self.low) / (self.high - self.low);
        let at = self.rect.bottom() - (share * f64::from(self.rect.height())) as f32;
        let across = self.span.screen_from_world(x, self.rect);
        pos2(
            across.clamp(self.rect.left() - FAR, self.rect.right() + FAR),
            at.clamp(self.rect.top() - FAR, self.rect.bottom() + FAR),
        )
    }

    /// Displacement in m and value of the vertical axis at a screen position.
    pub fn world_from_screen(&self, at: Pos2) -> (f64, f64) {
        let share = f64::from((self.rect.bottom() - at.y) / self.rect.height());
        (self.span.world_from_screen(at.x, self.rect), self.low + share * (self.high - self.low))
    }

    /// Screen positions of the curve `y` for displacements from `low` to `high` in m.
    pub fn curve(&self, low: f64, high: f64, y: impl Fn(f64) -> f64) -> Vec<Pos2> {
        if !(high > low) {
            return Vec::new();
        }
        let width = (high - low) * self.span.scale(self.rect);
        let count = (width / f64::from(CURVE_STEP)).clamp(8.0, 4000.0) as usize;
        let place = |i: usize| low + (high - low) * i as f64 / count as f64;
        let point = |i: usize| {
            let x = place(i).min(high);
            self.screen_from_world(x, y(x))
        };
        (0..=count).map(point).collect()
    }

    /// Draws background, grid and axes; the vertical one has this name and is in multiples of `unit`. Unless
    /// a readout takes its place, the name of the x axis stands below.
    pub fn axes(&self, ui: &Ui, context: &ViewContext<'_>, (name, unit): (&str, f64), is_read: bool) {
        let painter = ui.painter().with_clip_rect(self.area);
        painter.rect_filled(self.area, 0.0, context.style.ground());
        x_axis(&painter, context, self.rect, !is_read);
        y_axis(&painter, &context.style, self.rect, (self.low / unit, self.high / unit), name);
    }

    /// Writes `text` below the picture, about the point under the pointer.
    pub fn readout(&self, ui: &Ui, style: &Style, text: &str) {
        let painter = ui.painter().with_clip_rect(self.area);
        let at = (self.area.right_bottom() - vec2(6.0, 3.0), Align2::RIGHT_BOTTOM);
        haloed(&painter, style, at, text, (style.small(), style.ink()));
    }

    /// Draws the legend above the picture; entries that do not fit left of `right` are left out.
    pub fn legend(&self, ui: &Ui, style: &Style, right: f32, entries: &[(Symbol, &str)]) {
        legend(ui, style, self.area.with_min_x(self.rect.left()), right, entries);
    }

    /// Marks the equilibria at 0 of the vertical axis: filled if stable, hollow if unstable.
    pub fn equilibria(&self, painter: &Painter, style: &Style, landscape: &Landscape) {
        for equilibrium in &landscape.equilibria {
            let at = self.screen_from_world(equilibrium.x, 0.0);
            let fill = if equilibrium.stable { style.ink() } else { style.ground() };
            painter.circle(at, MARK, fill, Stroke::new(1.5, style.ink()));
        }
    }
}

/// Draws the grid and the numbers of the x axis, in mm, and its name below `rect` if it has room.
pub fn x_axis(painter: &Painter, context: &ViewContext<'_>, rect: Rect, is_named: bool) {
    let (style, span) = (context.style, context.span);
    let columns = f64::from(rect.width() / 55.0);
    let axis = named(span.low * 1e3, span.high * 1e3, "displacement (mm)", columns);
    for (mm, text) in axis.ticks {
        let at = span.screen_from_world(mm / 1e3, rect);
        painter.vline(at, rect.y_range(), style.grid_stroke());
        let galley = painter.layout_no_wrap(text, style.small(), style.faint());
        let half = 0.5 * galley.size().x + 2.0;
        // moved inwards at the edges, so that the number is not cut off
        let middle = at.clamp(rect.left() + half, (rect.right() - half).max(rect.left() + half));
        painter.galley(pos2(middle - half, rect.bottom() + 4.0), galley, style.faint());
    }
    if is_named {
        let below = pos2(rect.center().x, rect.bottom() + NUMBERS + NAME - 3.0);
        painter.text(below, Align2::CENTER_BOTTOM, axis.label, style.small(), style.faint());
    }
}

/// Draws the grid of a vertical axis with these ends, and its numbers and name left of `rect`; where the name
/// is longer than the axis, the unit alone.
pub fn y_axis(painter: &Painter, style: &Style, rect: Rect, (low, high): (f64, f64), name: &str) {
    let axis = named(low, high, name, f64::from(rect.height() / 40.0));
    let step = axis.ticks.windows(2).next().map_or(1.0, |pair| pair[1].0 - pair[0].0);
    let rows = f64::from(ROW / rect.height()) * (high - low) / step;
    let every = rows.ceil().clamp(1.0, 100.0) as i64;
    for (value, text) in axis.ticks {
        let y = rect.bottom() - ((value - low) / (high - low)) as f32 * rect.height();
        let stroke = if value == 0.0 { style.ghost_stroke() } else { style.grid_stroke() };
        painter.hline(rect.x_range(), y, stroke);
        if (value / step).round() as i64 % every == 0 {
            let at = pos2(rect.left() - 5.0, y);
            painter.text(at, Align2::RIGHT_CENTER, text, style.small(), style.faint());
        }
    }
    let unit = axis.label.rsplit_once(" (").map_or("", |(_, unit)| unit.trim_end_matches(')')).to_owned();
    let galley = |text: String| painter.layout_no_wrap(text, style.small(), style.faint());
    let whole = galley(axis.label);
    let galley = if whole.size().x > rect.height() { galley(unit) } else { whole };
    let corner = pos2(rect.left() - GUTTER + 2.0, rect.center().y + 0.5 * galley.size().x);
    painter.add(TextShape::new(corner, galley, style.faint()).with_angle(-FRAC_PI_2));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn screen_and_world_are_inverse() {
        let area = Rect::from_min_max(pos2(10.0, 20.0), pos2(410.0, 320.0));
        let chart = Chart::new(area, Span { low: -8e-3, high: 8e-3 }, -0.4, 0.4);
        let (x, v) = chart.world_from_screen(chart.screen_from_world(3e-3, 0.1));
        assert!((x - 3e-3).abs() < 1e-8 && (v - 0.1).abs() < 1e-6);
        assert_eq!(chart.curve(0.0, 0.0, |x| x).len(), 0);
    }
}
