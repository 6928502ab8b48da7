//! Ghosts of the pinned motions: dashed outlines with the letters of the pins.

use std::sync::Arc;

use eframe::egui::{Align2, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

use crate::app::session::pins::Pin;
use crate::app::ui::style::{BODY, Style, strong_family};
use crate::dynamics::{Model, Sample};
use crate::output::{Role, Theme};

use super::ViewContext;
use super::context::Drawn;
use super::labels::haloed;
use super::pane::UNIT;

const MAX_DASHES: usize = 300;
/// Distance in points within which points of a path are merged.
const NEAR: f32 = 1.0;

pub(super) const PINNED: [&str; 3] = ["A", "B", "C"];

/// Width in points reserved for a letter.
const LETTER: f32 = 10.0;

const CIRCLE_SEGMENTS: usize = 32;

/// A pinned motion at the time that is shown.
pub(super) struct Ghost {
    /// Index of its letter.
    pub place: usize,
    pub state: Sample,
    /// The model by which it moves.
    pub model: Arc<Model>,
    /// Horizontal offset in points of its letter, so that letters at one place do not overlap.
    aside: f32,
}

/// The pinned motions at the time that is shown, where they are drawn over the present one.
pub(super) fn ghosts(context: &ViewContext<'_>) -> Vec<Ghost> {
    let session = &context.session;
    if context.drawn != Drawn::WithGhosts {
        return Vec::new();
    }
    let t = session.player.time();
    let ghost = |(pin, aside): (&Pin, f32)| Ghost {
        place: pin.place(),
        state: pin.watch.state_at(t),
        model: Arc::clone(pin.watch.model_at(t)),
        aside,
    };
    let pins = session.pins.all();
    let places: Vec<f64> = pins.iter().map(|pin| pin.watch.state_at(t).x).collect();
    pins.iter().zip(offsets(&places)).map(ghost).collect()
}

/// Offsets of the letters, in the order of their places, so that no two overlap.
fn offsets(places: &[f64]) -> Vec<f32> {
    let middle = 0.5 * (places.len().max(1) - 1) as f32;
    let before = |i: usize| {
        let is_before = |j: &usize| (places[*j], *j) < (places[i], i);
        (0..places.len()).filter(is_before).count() as f32
    };
    (0..places.len()).map(|i| LETTER * (before(i) - middle)).collect()
}

/// A path with the dashes of a pin; points within [`NEAR`] of each other are merged.
pub(super) fn dashed(path: &[Pos2], place: usize, stroke: Stroke) -> Vec<Shape> {
    let mut kept: Vec<Pos2> = Vec::with_capacity(path.len().min(MAX_DASHES * 8));
    for at in path {
        if kept.last().is_none_or(|last| last.distance_sq(*at) > NEAR * NEAR) {
            kept.push(*at);
        }
    }
    kept.extend(path.last());
    let length: f32 = kept.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let (dash, gap) = Theme::LIGHT.look(Role::Pin(place)).dash.unwrap_or((1.0, 0.0));
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
    /// Draws the mass as a dashed ring with its letter.
    pub fn ball(&self, painter: &Painter, style: &Style, at: Pos2, radius: f32) {
        self.outline(painter, style, &circle(at, radius));
        self.letter(painter, style, (at - vec2(0.0, radius + 2.0), Align2::CENTER_BOTTOM));
    }

    /// Draws the mass as a dashed box with its letter.
    pub fn body(&self, painter: &Painter, style: &Style, body: Rect) {
        self.outline(painter, style, &edges(body));
        // clear of the flexures
        self.letter(painter, style, (body.center(), Align2::CENTER_CENTER));
    }

    fn letter(&self, painter: &Painter, style: &Style, (at, align): (Pos2, Align2)) {
        let place = (at + vec2(self.aside, 0.0), align);
        let strong = FontId::new(BODY, strong_family());
        haloed(painter, style, place, PINNED[self.place], (strong, style.pin()));
    }

    fn outline(&self, painter: &Painter, style: &Style, path: &[Pos2]) {
        painter.add(Shape::line(path.to_vec(), Stroke::new(4.0, style.ground().gamma_multiply(0.7))));
        painter.extend(dashed(path, self.place, style.ghost_mass_stroke()));
    }

    /// Draws its stops as dashed lines over the height of `rect`, where they differ from the present ones.
    pub fn stops(&self, painter: &Painter, context: &ViewContext<'_>, rect: Rect, aside: f32) {
        let (pinned, present) = (self.model.stop_positions(), context.session.shown().stop_positions());
        for (stop, present, offset) in [(pinned.0, present.0, -aside), (pinned.1, present.1, aside)] {
            let Some(x) = stop.filter(|_| stop != present) else { continue };
            let x = context.span.screen_from_world(x, rect) + offset;
            let ends = [pos2(x, rect.top()), pos2(x, rect.bottom())];
            painter.extend(dashed(&ends, self.place, context.style.stop_stroke()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_motions_at_one_place_stand_in_a_row() {
        assert_eq!(offsets(&[]), [0.0; 0]);
        assert_eq!(offsets(&[0.3]), [0.0]);
        assert_eq!(offsets(&[0.3, 0.3]), [-5.0, 5.0]);
        assert_eq!(offsets(&[0.3, 0.2, 0.3]), [0.0, -10.0, 10.0]);
        // the offsets bring no two letters closer
        let places = [0.7, -0.1, 0.69];
        let moved: Vec<f64> = places.iter().zip(offsets(&places)).map(|(x, by)| x + f64::from(by)).collect();
        assert!((moved[0] - moved[2]).abs() >= 10.0 && (moved[1] - moved[2]).abs() >= 10.0, "{moved:?}");
    }

    #[test]
    fn a_long_path_has_few_dashes_that_reach_to_its_end() {
        let zigzag: Vec<Pos2> =
            (0..20_000).map(|i| pos2(0.01 * i as f32, if i / 25 % 2 == 0 { 0.0 } else { 300.0 })).collect();
        for place in 0..3 {
            let shapes = dashed(&zigzag, place, Stroke::new(1.0, eframe::egui::Color32::RED));
            // a dash around a corner consists of two
            assert!(shapes.len() > MAX_DASHES / 2 && shapes.len() < 5 * MAX_DASHES, "{}", shapes.len());
            let right = shapes.iter().map(|shape| shape.visual_bounding_rect().right()).fold(0.0, f32::max);
            assert!(right > 190.0, "{right}");
        }
    }
}
