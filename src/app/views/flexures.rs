//! Drawing of the bent flexures, from the solved shape at the displacement of the mass.
//!
//! The solver runs once per frame (less than a tenth of a millisecond), so that no shape is interpolated and
//! the bulge vanishes where it should. The scale along the flexures differs from that of the x axis; the
//! ratio of the two is written. The mass is a body between the two groups, not to scale.

use std::ops::RangeInclusive;

use eframe::egui::{Align2, Painter, Pos2, Rect, Stroke, Vec2, pos2, vec2};

use crate::app::ui::style::Style;
use crate::mechanics::flexure::{Geometry, State};

use super::labels::Taken;
use super::{Span, ViewContext};

/// Smallest travel in points that is drawn at true scale.
const MIN_TRAVEL: f64 = 60.0;

/// Largest number of flexures drawn for a group.
const MAX_LINES: usize = 4;

/// Thickness of the clamps in points.
pub(super) const CLAMP: f32 = 8.0;

/// Area of the drawing: between two clamps, with the body of the mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DrawingArea {
    /// Inner edge of the upper clamp.
    pub top: f32,
    /// Inner edge of the lower clamp.
    pub bottom: f32,
    /// Half the size of the body.
    pub half: Vec2,
}

/// A drawing of the mechanism in `rect`, and its lines and rectangles of which labels keep clear.
pub(super) struct Sketch {
    pub painter: Painter,
    pub rect: Rect,
    pub style: Style,
    pub area: DrawingArea,
    pub taken: Taken,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DrawingScale {
    place: DrawingArea,
    /// Points per m along the flexures.
    pub along: f64,
    /// Distance between the clamps in m, for a body of zero size.
    clamps: f64,
}

impl DrawingScale {
    pub fn of(geometry: &Geometry, place: DrawingArea) -> Self {
        let clamps = geometry.parallel.length + geometry.buckling.length - geometry.preload;
        let room = f64::from((place.bottom - place.top - 2.0 * place.half.y).max(1.0));
        Self { place, along: room / clamps, clamps }
    }

    /// The x axis over `rect` at true scale. `None` if the travel would be too small or does not fit.
    pub fn true_span(&self, reach: f64, rect: Rect) -> Option<Span> {
        let half = 0.5 * f64::from(rect.width()) / self.along;
        (reach * self.along >= MIN_TRAVEL && half > 1.1 * reach).then_some(Span { low: -half, high: half })
    }

    /// The ratio of the scales across and along the flexures, as text.
    pub fn words(&self, span: Span, rect: Rect) -> String {
        let stretch = span.scale(rect) / self.along;
        match stretch {
            s if (s - 1.0).abs() < 0.02 => "true scale".to_owned(),
            s if s < 9.95 => format!("drawn {s:.1}× wider"),
            s => format!("drawn {s:.0}× wider"),
        }
    }

    pub fn middle(&self, state: &State) -> f32 {
        let end = |line: usize| state.lines.get(line).and_then(|line| line.points.last());
        let along = end(0).map_or(0.5 * self.clamps, |point| point[1]);
        self.place.bottom - (along * self.along) as f32 - self.place.half.y
    }

    /// The lines of the flexures below the body and of those above it, each from its clamp.
    pub fn lines(&self, geometry: &Geometry, state: &State, span: Span, rect: Rect) -> [Vec<Vec<Pos2>>; 2] {
        let mut lines = [Vec::new(), Vec::new()];
        let groups = [(&geometry.parallel, false), (&geometry.buckling, true)];
        for (line, (group, above)) in state.lines.iter().zip(groups) {
            let place = |[_, along, across]: &[f64; 3]| {
                let y = match above {
                    true => self.place.top + ((self.clamps - along) * self.along) as f32,
                    false => self.place.bottom - (along * self.along) as f32,
                };
                pos2(span.screen_from_world(*across, rect), y)
            };
            let points: Vec<Pos2> = line.points.iter().map(place).collect();
            let count = group.count.clamp(1, MAX_LINES);
            for i in 0..count {
                let share = if count == 1 { 0.0 } else { 2.0 * i as f32 / (count - 1) as f32 - 1.0 };
                let aside = vec2(0.9 * share * self.place.half.x, 0.0);
                lines[usize::from(above)].push(points.iter().map(|point| *point + aside).collect());
            }
        }
        lines
    }

    /// Draws a bar of 10 mm along the flexures. Returns its rectangle.
    pub fn bar(&self, painter: &Painter, style: &Style, at: Pos2) -> Option<Rect> {
        let length = (0.01 * self.along) as f32;
        if !(6.0..400.0).contains(&length) {
            return None;
        }
        let (stroke, foot) = (style.ghost_stroke(), at - vec2(0.0, length));
        painter.line_segment([at, foot], stroke);
        for end in [at, foot] {
            painter.line_segment([end - vec2(4.0, 0.0), end + vec2(4.0, 0.0)], stroke);
        }
        let middle = at - vec2(8.0, 0.5 * length);
        let name = painter.text(middle, Align2::RIGHT_CENTER, "10\u{a0}mm", style.small(), style.faint());
        Some(name.union(Rect::from_two_pos(at, foot)))
    }
}

/// Shape of the flexures with the mass at `x` in m, or the last known shape if the solver fails.
pub(super) fn state_at(context: &mut ViewContext<'_>, x: f64) -> Option<State> {
    let mechanism = &context.drawn.model(context.session).mechanism();
    let flexures = mechanism.flexures.as_ref()?;
    let (low, high) = mechanism.curve.domain();
    if let Ok(state) = flexures.state(x.clamp(low, high)) {
        context.memory.drawing.bent = Some(state);
    }
    context.memory.drawing.bent.clone()
}

/// Bulge of the buckling flexures, as text.
pub(super) fn bulge_words(state: &State) -> String {
    let bulge = state.bump.abs() * 1e3;
    if bulge < 0.005 { "taut: no bulge left".to_owned() } else { format!("bulge {bulge:.1} mm") }
}

impl Sketch {
    /// Draws a clamp at these heights: a bar of the frame, hatched on the side away from the flexures.
    pub fn clamp(&self, heights: RangeInclusive<f32>, above: bool) {
        let (painter, bar) = (&self.painter, Rect::from_x_y_ranges(self.rect.x_range().shrink(6.0), heights));
        painter.rect_filled(bar, 0.0, self.style.frame_colour());
        let stroke = Stroke::new(1.0, self.style.ground());
        let count = (bar.width() / 8.0).floor().clamp(0.0, 1000.0) as usize;
        for i in 0..count {
            let x = bar.left() + 8.0 * (i as f32 + 0.5);
            painter.line_segment([pos2(x, bar.bottom()), pos2(x + 5.0, bar.top())], stroke);
        }
        let edge = if above { bar.bottom() } else { bar.top() };
        painter.hline(bar.x_range(), edge, Stroke::new(1.5, self.style.faint()));
    }
}
