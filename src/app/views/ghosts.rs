//! Ghosts of the pinned motions: dashed, with the letter of the pin.

use std::sync::Arc;

use eframe::egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

use crate::app::session::Session;
use crate::app::session::pins::Pin;
use crate::app::ui::style::Style;
use crate::dynamics::{Model, Sample};

use super::ViewContext;
use super::labels::haloed;

/// Lengths in points of a dash and of the gap after it, of each pin.
const DASHES: [(f32, f32); 3] = [(7.0, 4.0), (3.0, 3.0), (11.0, 3.0)];

/// What the lines of the pins are called.
pub(super) const PINNED: [&str; 3] = ["A", "B", "C"];

/// Pieces of a dashed circle.
const ROUND: usize = 32;

/// A pinned motion at the time that is shown.
pub(super) struct Ghost {
    /// Which of the pins it is.
    pub place: usize,
    /// What it is called.
    pub letter: char,
    /// Its state.
    pub state: Sample,
    /// The model by which it moves.
    pub model: Arc<Model>,
}

/// The pinned motions at the time that is shown.
pub(super) fn ghosts(session: &Session) -> Vec<Ghost> {
    let t = session.player.time();
    let ghost = |pin: &Pin| Ghost {
        place: pin.place(),
        letter: pin.letter(),
        state: pin.state_at(t),
        model: Arc::clone(pin.watch().model_at(t)),
    };
    session.pins.all().iter().map(ghost).collect()
}

/// A path with the dashes of a pin.
pub(super) fn dashed(path: &[Pos2], place: usize, stroke: Stroke) -> Vec<Shape> {
    let (dash, gap) = DASHES[place % DASHES.len()];
    Shape::dashed_line(path, stroke, dash, gap)
}

/// The length in points of a dash of a pin.
pub(super) fn dash(place: usize) -> f32 {
    DASHES[place % DASHES.len()].0
}

impl Ghost {
    /// The mass as a dashed ring with its letter.
    pub fn ball(&self, painter: &Painter, style: &Style, at: Pos2, radius: f32) {
        let turn = std::f32::consts::TAU / ROUND as f32;
        let point = |i: usize| at + radius * Vec2::angled(i as f32 * turn);
        let ring: Vec<Pos2> = (0..=ROUND).map(point).collect();
        self.outline(painter, style, &ring, at - vec2(0.0, radius));
    }

    /// The mass as a dashed box with its letter.
    pub fn body(&self, painter: &Painter, style: &Style, body: Rect) {
        let corners = [body.left_top(), body.right_top(), body.right_bottom(), body.left_bottom()];
        let outline: Vec<Pos2> = corners.into_iter().chain([body.left_top()]).collect();
        self.outline(painter, style, &outline, body.center_top());
    }

    fn outline(&self, painter: &Painter, style: &Style, path: &[Pos2], top: Pos2) {
        painter.add(Shape::line(path.to_vec(), Stroke::new(4.0, style.ground().gamma_multiply(0.7))));
        painter.extend(dashed(path, self.place, style.ghost_mass_stroke()));
        let at = (top - vec2(0.0, 2.0), Align2::CENTER_BOTTOM);
        haloed(painter, style, at, &self.letter.to_string(), (style.small(), style.mass_ink()));
    }

    /// Its stops where they are not those of the present motion, as dashed lines over the height of `rect`.
    pub fn stops(&self, painter: &Painter, context: &ViewContext<'_>, rect: Rect, aside: f32) {
        let (own, present) = (self.model.stop_positions(), context.session.shown().stop_positions());
        for (stop, present, way) in [(own.0, present.0, -aside), (own.1, present.1, aside)] {
            let Some(x) = stop.filter(|_| stop != present) else { continue };
            let x = context.span.screen_from_world(x, rect) + way;
            let ends = [pos2(x, rect.top()), pos2(x, rect.bottom())];
            painter.extend(dashed(&ends, self.place, context.style.stop_stroke()));
        }
    }
}
