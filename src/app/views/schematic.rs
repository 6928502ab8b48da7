//! Drawing of a mechanism without flexures: a spring, or a mass alone.

use eframe::egui::{self, Rect, Shape, Stroke, pos2};

use crate::app::words::numbers::three;
use crate::mechanics::Mechanism;

use super::beside::{Beside, coil};
use super::flexures::{CLAMP, clamp};
use super::{Span, ViewContext};

/// Half turns of a drawn spring, and half its width in points.
const COILS: usize = 12;
const COIL: f32 = 9.0;

/// Share of a drawn spring that each of its ends takes.
const END: f32 = 0.15;

/// What is drawn of a force without flexures behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Schematic {
    /// A spring that pushes the mass away from the middle and draws it back from far out, or the like.
    Spring,
    /// Nothing: the force is the same everywhere.
    Mass { pulled: bool },
}

impl Schematic {
    /// Where the force does not depend on the place there is no spring; springs and magnets that are drawn as
    /// such do not count.
    pub fn of(mechanism: &Mechanism, span: Span) -> Self {
        let depends = |part: &Mechanism| {
            let forces = [0.0, 0.21, 0.5, 0.83, 1.0].map(|share| {
                let (low, high) = part.curve.domain();
                part.curve.force((span.low + share * (span.high - span.low)).clamp(low, high))
            });
            forces.iter().any(|force| (force - forces[0]).abs() > 1e-9 * forces[0].abs())
        };
        match others(mechanism).any(depends) {
            true => Self::Spring,
            false => Self::Mass { pulled: steady(mechanism) != 0.0 },
        }
    }

    /// What is said of a mechanism; `beside` what is drawn as such there is something.
    fn words(self, mechanism: &Mechanism, beside: bool) -> String {
        let force = steady(mechanism);
        match self {
            Self::Spring if beside => "the other force as a spring, not to scale".to_owned(),
            Self::Spring => "a spring of this force, not to scale".to_owned(),
            Self::Mass { pulled: false } if beside => "not to scale".to_owned(),
            Self::Mass { pulled: false } => "a free mass".to_owned(),
            Self::Mass { pulled: true } => {
                let way = if force > 0.0 { "left" } else { "right" };
                format!("a steady force of {} N to the {way}", three(force.abs()))
            }
        }
    }
}

/// The parts of a mechanism that are no spring and no magnets.
fn others(mechanism: &Mechanism) -> impl Iterator<Item = &Mechanism> {
    mechanism.side_by_side().iter().filter(|part| part.element.is_none())
}

/// Their force in the middle.
fn steady(mechanism: &Mechanism) -> f64 {
    let force = |part: &Mechanism| {
        let (low, high) = part.curve.domain();
        part.curve.force(0.0_f64.clamp(low, high))
    };
    others(mechanism).map(force).sum()
}

/// The mass on its rail, with a spring from above where there is one; between what is `beside` it.
pub(super) fn schematic(
    painter: &egui::Painter,
    context: &ViewContext<'_>,
    rect: Rect,
    (x, middle, half): (f32, f32, egui::Vec2),
    (top, bottom): (f32, f32),
    beside: &Beside,
) -> String {
    let style = context.style;
    let mechanism = context.drawn.model(context.session).mechanism();
    let own = Schematic::of(mechanism, context.span);
    painter.hline(rect.x_range().shrink(6.0), middle + half.y + 3.0, Stroke::new(2.0, style.faint()));
    let bar = |y: std::ops::RangeInclusive<f32>| Rect::from_x_y_ranges(rect.x_range().shrink(6.0), y);
    if beside.stands_below() {
        clamp(painter, &style, bar(bottom..=bottom + CLAMP), false);
    }
    if own == Schematic::Spring {
        clamp(painter, &style, bar(top - CLAMP..=top), true);
        let barrier = mechanism.landscape.barrier;
        let foot = context.span.screen_from_world(barrier.map_or(0.0, |barrier| barrier.x), rect);
        let (from, to) = (pos2(foot, top), pos2(x, middle - half.y));
        painter.add(Shape::line(coil((from, to), COILS, COIL, END), style.flexure_stroke()));
    }
    own.words(mechanism, beside.is_drawn())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::app::session::Session;
    use crate::app::session::editor::Editor;

    #[test]
    fn only_a_force_that_depends_on_the_place_has_a_spring() {
        let words = |preset: &str| {
            let session = Session::new(Editor::open(preset).unwrap(), Arc::new(|| ())).unwrap();
            let mechanism = session.model().mechanism();
            Schematic::of(mechanism, Span::of(&session, (0.0, 0.0))).words(mechanism, false)
        };
        assert_eq!(words("bouncing-ball"), "a steady force of 9.81 N to the left");
        assert_eq!(words("elastic-box"), "a free mass");
        for preset in ["duffing", "monostable", "nominal-cubic", "paper-table"] {
            assert!(words(preset).starts_with("a spring"), "{preset}");
        }
    }
}
