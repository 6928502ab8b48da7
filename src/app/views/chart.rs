//! Charts over displacement: coordinates, axes, readout.
//!
//! All views share the x axis over their whole width, so that pictures above each other line up. The labels
//! of the vertical axis are written inside the picture.

use eframe::egui::{Align2, Painter, Pos2, Rect, Stroke, Ui, pos2, vec2};

use crate::app::ui::style::Style;
use crate::mechanics::Landscape;
use crate::output::PlotAxis;

use super::ViewContext;
use super::labels::{haloed, plated};
use super::legend::{LEGEND, Symbol, legend};
use super::span::Span;

/// Distance in points outside the picture at which positions are clamped.
const FAR: f32 = 4000.0;

/// Distance in points between two samples of a curve.
pub const CURVE_STEP: f32 = 2.0;

/// Radius in points of the mark of an equilibrium.
const MARK: f32 = 5.0;

/// Height in points of the label of the x axis.
const NAME: f32 = 16.0;

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
        let rect = Rect::from_min_max(area.min + vec2(0.0, LEGEND), area.max - vec2(0.0, 22.0 + NAME));
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

    /// The vertical axis in multiples of `unit`, with the ticks that it has room for.
    fn axis(&self, name: &str, unit: f64) -> PlotAxis {
        let rows = (self.rect.height() / 40.0).clamp(2.0, 7.0) as usize;
        PlotAxis::between(self.low / unit, self.high / unit, name).with_ticks(rows)
    }

    /// Draws background, grid and x axis; grid lines lie at round multiples of `unit`.
    pub fn axes(&self, ui: &Ui, context: &ViewContext<'_>, unit: f64) {
        let (style, rect) = (context.style, self.rect);
        let painter = ui.painter().with_clip_rect(self.area);
        painter.rect_filled(self.area, 0.0, style.ground());
        x_axis(&painter, context, rect);
        let below = pos2(rect.center().x, self.area.bottom() - 3.0);
        painter.text(below, Align2::CENTER_BOTTOM, "displacement (mm)", style.small(), style.faint());
        for (value, _) in self.axis("", unit).ticks {
            let at = self.screen_from_world(self.span.low, value * unit).y;
            let stroke = if value == 0.0 { style.ghost_stroke() } else { style.grid_stroke() };
            painter.hline(rect.x_range(), at, stroke);
        }
    }

    /// Draws the name of the vertical axis and its numbers, in multiples of `unit`, over the picture.
    pub fn numbers(&self, ui: &Ui, style: &Style, name: &str, unit: f64) {
        let painter = ui.painter().with_clip_rect(self.area);
        let write = |at: Pos2, align: Align2, text: &str| {
            plated(&painter, style, (at, align), text, (style.small(), style.faint()));
        };
        let axis = self.axis(name, unit);
        for (value, text) in axis.ticks {
            let at = self.screen_from_world(self.span.low, value * unit).y;
            if at > self.rect.top() + 26.0 && at < self.rect.bottom() - 8.0 {
                // above its grid line, so that the line does not cross it
                write(pos2(self.rect.left() + 4.0, at - 1.0), Align2::LEFT_BOTTOM, &text);
            }
        }
        write(self.rect.left_top() + vec2(4.0, 3.0), Align2::LEFT_TOP, &axis.label);
    }

    /// Writes `text` below the picture, about the point under the pointer.
    pub fn readout(&self, ui: &Ui, style: &Style, text: &str) {
        let painter = ui.painter().with_clip_rect(self.area);
        let at = (self.area.right_bottom() - vec2(6.0, 3.0), Align2::RIGHT_BOTTOM);
        haloed(&painter, style, at, text, (style.small(), style.ink()));
    }

    /// Draws the legend above the picture; entries that do not fit left of `right` are left out.
    pub fn legend(&self, ui: &Ui, style: &Style, right: f32, entries: &[(Symbol, &str)]) {
        legend(ui, style, self.area, right, entries);
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

/// Draws the ticks of the x axis, in mm, below `rect`.
pub fn x_axis(painter: &Painter, context: &ViewContext<'_>, rect: Rect) {
    let style = context.style;
    let PlotAxis { ticks, label, .. } = context.span.axis().with_ticks((rect.width() / 55.0) as usize);
    let unit = label.rsplit_once(" (").map_or("", |(_, unit)| unit.trim_end_matches(')'));
    let last = ticks.len().saturating_sub(1);
    for (i, (mm, text)) in ticks.into_iter().enumerate() {
        let at = context.span.screen_from_world(mm / 1e3, rect);
        painter.vline(at, rect.y_range(), style.grid_stroke());
        let text = if i == last { format!("{text} {unit}") } else { text };
        let galley = painter.layout_no_wrap(text, style.small(), style.faint());
        let half = 0.5 * galley.size().x + 2.0;
        // moved inwards at the edges, so that the number is not cut off
        let middle = at.clamp(rect.left() + half, (rect.right() - half).max(rect.left() + half));
        painter.galley(pos2(middle - half, rect.bottom() + 4.0), galley, style.faint());
    }
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
