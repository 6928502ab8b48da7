//! The motion of the reference as a ghost: a dashed outline of the mass, and dashed stops.

use std::sync::Arc;

use eframe::egui::{Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2};

use crate::app::ui::style::Style;
use crate::dynamics::{Model, Sample};
use crate::output::{Role, Theme};

use super::ViewContext;
use super::pane::UNIT;

const MAX_DASHES: usize = 300;
/// Distance in points within which points of a path are merged.
const NEAR: f32 = 1.0;

/// The name of the reference in a legend.
pub(super) const REFERENCE: &str = "reference";

const CIRCLE_SEGMENTS: usize = 32;

/// The motion of the reference at the time that is shown.
pub(super) struct Ghost {
    pub state: Sample,
    /// The model by which it moves.
    pub model: Arc<Model>,
}

/// The motion of the reference at the time that is shown, if it is not the present one then.
pub(super) fn ghost(context: &ViewContext<'_>) -> Option<Ghost> {
    let t = context.session.player.time();
    let apart = context.session.reference.apart().filter(|apart| apart.since <= t)?;
    Some(Ghost { state: apart.watch.state_at(t), model: Arc::clone(apart.watch.model_at(t)) })
}

/// A path with the dashes of the reference; points within [`NEAR`] of each other are merged.
pub(super) fn dashed(path: &[Pos2], stroke: Stroke) -> Vec<Shape> {
    let mut kept: Vec<Pos2> = Vec::with_capacity(path.len().min(MAX_DASHES * 8));
    for at in path {
        if kept.last().is_none_or(|last| last.distance_sq(*at) > NEAR * NEAR) {
            kept.push(*at);
        }
    }
    kept.extend(path.last());
    let length: f32 = kept.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let (dash, gap) = Theme::LIGHT.look(Role::Compared).dash.unwrap_or((1.0, 0.0));
    let (dash, gap) = (dash as f32 * UNIT, gap as f32 * UNIT);
    // longer ones on a long path, to limit their number
    let factor = (length / ((dash + gap) * MAX_DASHES as f32)).max(1.0);
    Shape::dashed_line(&kept, stroke, dash * factor, gap * factor)
}

/// A closed path around `at`.
pub(super) fn circle(at: Pos2, radius: f32) -> Vec<Pos2> {
    let turn = std::f32::consts::TAU / CIRCLE_SEGMENTS as f32;
    (0..=CIRCLE_SEGMENTS).map(|i| at + radius * Vec2::angled(i as f32 * turn)).collect()
}

/// A closed path along the edges of a box.
pub(super) fn edges(body: Rect) -> [Pos2; 5] {
    let top_left = body.left_top();
    [top_left, body.right_top(), body.right_bottom(), body.left_bottom(), top_left]
}

impl Ghost {
    /// Draws the mass as a dashed outline along a closed path.
    pub fn outline(&self, painter: &Painter, style: &Style, path: &[Pos2]) {
        painter.add(Shape::line(path.to_vec(), Stroke::new(4.0, style.ground().gamma_multiply(0.7))));
        painter.extend(dashed(path, Stroke::new(style.width(1.8), style.compared())));
    }

    /// Draws its stops as dashed lines over the height of `rect`, where they differ from the present ones.
    pub fn stops(&self, painter: &Painter, context: &ViewContext<'_>, rect: Rect, aside: f32) {
        let (compared, present) = (self.model.stop_positions(), context.session.shown().stop_positions());
        for (stop, present, offset) in [(compared.0, present.0, -aside), (compared.1, present.1, aside)] {
            let Some(x) = stop.filter(|_| stop != present) else { continue };
            let x = context.span.screen_from_world(x, rect) + offset;
            let ends = [pos2(x, rect.top()), pos2(x, rect.bottom())];
            painter.extend(dashed(&ends, context.style.stop_stroke()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_path_has_few_dashes_that_reach_to_its_end() {
        let zigzag: Vec<Pos2> =
            (0..20_000).map(|i| pos2(0.01 * i as f32, if i / 25 % 2 == 0 { 0.0 } else { 300.0 })).collect();
        let shapes = dashed(&zigzag, Stroke::new(1.0, eframe::egui::Color32::RED));
        // a dash around a corner consists of two
        assert!(shapes.len() > MAX_DASHES / 2 && shapes.len() < 5 * MAX_DASHES, "{}", shapes.len());
        let right = shapes.iter().map(|shape| shape.visual_bounding_rect().right()).fold(0.0, f32::max);
        assert!(right > 190.0, "{right}");
    }
}
