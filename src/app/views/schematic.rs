//! Drawing of a mechanism without flexures: a spring, or a mass alone.

use eframe::egui::{Pos2, Shape, Stroke, pos2};

use crate::app::words::numbers::three;
use crate::mechanics::Mechanism;
use crate::output::depends_on_place;

use super::beside::{Attachments, coil};
use super::flexures::{CLAMP, DrawingArea, Sketch};
use super::{Span, ViewContext};

/// Number of half turns of the spring.
const COILS: usize = 12;
/// Half the width of the spring in points.
const COIL: f32 = 9.0;

/// Share of the spring that each of its straight ends takes.
const END: f32 = 0.15;

/// Drawing of a force that does not come from flexures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Schematic {
    /// A spring, for a force that depends on the displacement.
    Spring,
    /// The mass alone, for a constant force.
    Mass { pulled: bool },
}

impl Schematic {
    /// A spring if the force depends on the displacement, springs and magnets not counted.
    pub fn of(mechanism: &Mechanism, span: Span) -> Self {
        match depends_on_place(mechanism, (span.low, span.high)) {
            true => Self::Spring,
            false => Self::Mass { pulled: other_force(mechanism) != 0.0 },
        }
    }

    /// Caption of the drawing; `beside` if springs or magnets are drawn as such.
    fn words(self, mechanism: &Mechanism, beside: bool) -> String {
        let force = other_force(mechanism);
        match self {
            Self::Spring if beside => "the other force as a spring, not to scale".to_owned(),
            Self::Spring => "a spring of this force, not to scale".to_owned(),
            Self::Mass { pulled: false } if beside => "not to scale".to_owned(),
            Self::Mass { pulled: false } => "a free mass".to_owned(),
            Self::Mass { pulled: true } => {
                let direction = if force > 0.0 { "left" } else { "right" };
                format!("a steady force of {} N to the {direction}", three(force.abs()))
            }
        }
    }
}

/// The force of a mechanism without its springs and magnets at x = 0.
fn other_force(mechanism: &Mechanism) -> f64 {
    let force = |part: &Mechanism| {
        let (low, high) = part.curve.domain();
        part.curve.force(0.0_f64.clamp(low, high))
    };
    mechanism.parts_or_self().iter().filter(|part| part.element.is_none()).map(force).sum()
}

impl Sketch {
    /// Draws the rail and, for a spring, the spring from above to the mass, whose middle is `mass`. Returns
    /// the caption.
    pub fn schematic(&mut self, context: &ViewContext<'_>, mass: Pos2, beside: &Attachments) -> String {
        let (rect, DrawingArea { top, bottom, half }) = (self.rect, self.area);
        let mechanism = context.drawn.model(context.session).mechanism();
        let kind = Schematic::of(mechanism, context.span);
        let rail = mass.y + half.y + 3.0;
        self.painter.hline(rect.x_range().shrink(6.0), rail, Stroke::new(2.0, self.style.faint()));
        self.taken.lines.push(vec![pos2(rect.left(), rail), pos2(rect.right(), rail)]);
        if beside.stands_below() {
            self.clamp(bottom..=bottom + CLAMP, false);
        }
        if kind == Schematic::Spring {
            self.clamp(top - CLAMP..=top, true);
            let barrier = mechanism.landscape.barrier;
            let foot = context.span.screen_from_world(barrier.map_or(0.0, |barrier| barrier.x), rect);
            let coil = coil((pos2(foot, top), pos2(mass.x, mass.y - half.y)), COILS, COIL, END);
            self.painter.add(Shape::line(coil.clone(), self.style.flexure_stroke()));
            self.taken.lines.push(coil);
        }
        kind.words(mechanism, beside.is_drawn())
    }
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
