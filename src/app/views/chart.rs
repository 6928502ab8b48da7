//! A picture over the displacement: where things stand in it, and its axes.
//!
//! The x axis is the one that all views share, over the whole width, so that pictures above each other line up; what
//! belongs to the vertical axis is written into the picture.

use eframe::egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};

use crate::app::style::Style;
use crate::mechanics::Landscape;

use super::ViewContext;
use super::span::{Span, ticks};
use super::well::{LEGEND, x_axis};

/// How far outside the picture in points is far enough.
const FAR: f32 = 4000.0;

/// Points between two points of a curve.
pub const CURVE_STEP: f32 = 2.0;

/// Radius in points of the mark of an equilibrium.
const MARK: f32 = 5.0;

/// Height in points of the name of the x axis.
const NAME: f32 = 16.0;

/// An entry of the legend.
pub enum Sign {
    /// A line.
    Line(Stroke),
    /// A dashed line.
    Dashed(Stroke),
    /// A ring.
    Ring(Stroke),
}

/// Where things stand.
#[derive(Debug, Clone, Copy)]
pub struct Chart {
    /// The whole of it.
    pub area: Rect,
    /// What is drawn on.
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

    /// The place on the screen of a displacement in m and a value of the vertical axis.
    pub fn screen_from_world(&self, x: f64, y: f64) -> Pos2 {
        let share = (y - self.low) / (self.high - self.low);
        let at = self.rect.bottom() - (share * f64::from(self.rect.height())) as f32;
        let across = self.span.screen_from_world(x, self.rect);
        pos2(
            across.clamp(self.rect.left() - FAR, self.rect.right() + FAR),
            at.clamp(self.rect.top() - FAR, self.rect.bottom() + FAR),
        )
    }

    /// The displacement in m and the value of the vertical axis of a place on the screen.
    pub fn world_from_screen(&self, at: Pos2) -> (f64, f64) {
        let share = f64::from((self.rect.bottom() - at.y) / self.rect.height());
        (self.span.world_from_screen(at.x, self.rect), self.low + share * (self.high - self.low))
    }

    /// The places of `y` over the part of the axis from `low` to `high` in m.
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

    /// Ground, grid and ticks; `name` says what the vertical axis is, with the unit of which one is `unit`.
    pub fn axes(&self, ui: &Ui, context: &ViewContext<'_>, name: &str, unit: f64) {
        let (style, rect) = (context.style, self.rect);
        let painter = ui.painter().with_clip_rect(self.area);
        painter.rect_filled(self.area, 0.0, style.ground());
        x_axis(&painter, context, rect);
        let below = pos2(rect.center().x, self.area.bottom() - 3.0);
        painter.text(below, Align2::CENTER_BOTTOM, "displacement (mm)", style.small(), style.faint());
        let rows = f64::from((rect.height() / 40.0).clamp(2.0, 7.0));
        let (values, decimals) = ticks(self.low / unit, self.high / unit, rows);
        for value in values.iter().map(|value| value * 1e3) {
            let at = self.screen_from_world(self.span.low, value * unit).y;
            let stroke = if value == 0.0 { style.ghost_stroke() } else { style.grid_stroke() };
            painter.hline(rect.x_range(), at, stroke);
            if at > rect.top() + 26.0 && at < rect.bottom() - 8.0 {
                let text = format!("{:.decimals$}", value + 0.0);
                self.written(&painter, &style, pos2(rect.left() + 4.0, at), Align2::LEFT_CENTER, &text);
            }
        }
        let corner = rect.left_top() + vec2(4.0, 3.0);
        self.written(&painter, &style, corner, Align2::LEFT_TOP, name);
    }

    /// Small text that hides the grid behind it.
    pub fn written(&self, painter: &Painter, style: &Style, at: Pos2, align: Align2, text: &str) {
        let galley = painter.layout_no_wrap(text.to_owned(), style.small(), style.faint());
        let place = align.anchor_size(at, galley.size());
        painter.rect_filled(place.expand2(vec2(5.0, 0.0)), 2.0, style.ground());
        painter.galley(place.min, galley, style.faint());
    }

    /// What the lines mean, above the picture; what has no room is left out.
    pub fn legend(&self, ui: &Ui, style: &Style, entries: &[(Sign, &str)]) {
        let painter = ui.painter().with_clip_rect(self.area);
        let (mut x, y) = (self.area.left() + 8.0, self.area.top() + 0.5 * LEGEND);
        for (sign, text) in entries {
            let galley = painter.layout_no_wrap((*text).to_owned(), style.small(), style.faint());
            if x + 24.0 + galley.size().x > self.area.right() - 4.0 {
                break;
            }
            let (from, to) = (pos2(x, y), pos2(x + 18.0, y));
            match sign {
                Sign::Line(stroke) => {
                    painter.line_segment([from, to], *stroke);
                }
                Sign::Dashed(stroke) => {
                    painter.extend(Shape::dashed_line(&[from, to], *stroke, 4.0, 3.0));
                }
                Sign::Ring(stroke) => {
                    painter.circle_stroke(from + vec2(9.0, 0.0), 3.0, *stroke);
                }
            }
            let width = galley.size().x;
            painter.galley(pos2(x + 24.0, y - 0.5 * galley.size().y), galley, style.faint());
            x += 24.0 + width + 14.0;
        }
    }

    /// Equilibria where the vertical axis is 0: filled where stable, hollow where not.
    pub fn equilibria(&self, painter: &Painter, style: &Style, landscape: &Landscape) {
        for equilibrium in &landscape.equilibria {
            let at = self.screen_from_world(equilibrium.x, 0.0);
            let fill = if equilibrium.stable { style.ink() } else { style.ground() };
            painter.circle(at, MARK, fill, Stroke::new(1.5, style.ink()));
        }
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
