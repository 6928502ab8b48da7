//! Drawing of a mechanism without flexures: a spring, or a mass alone.

use eframe::egui::{self, Pos2, Rect, Shape, Stroke, pos2};

use crate::app::words::numbers::three;
use crate::mechanics::ForceCurve;

use super::flexures::{CLAMP, clamp};
use super::{Span, ViewContext};

/// Half turns of a drawn spring, and half its width in points.
const COILS: usize = 12;
const COIL: f32 = 9.0;

/// What is drawn of a force without flexures behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Schematic {
    /// A spring that pushes the mass away from the middle and draws it back from far out, or the like.
    Spring,
    /// Nothing: the force is the same everywhere.
    Mass { pulled: bool },
}

impl Schematic {
    /// Where the force does not depend on the place there is no spring.
    pub fn of(curve: &ForceCurve, span: Span) -> Self {
        let domain = curve.domain();
        let place = |share: f64| (span.low + share * (span.high - span.low)).clamp(domain.0, domain.1);
        let forces = [0.0, 0.21, 0.5, 0.83, 1.0].map(|share| curve.force(place(share)));
        let same = forces.iter().all(|force| (force - forces[0]).abs() <= 1e-9 * forces[0].abs());
        if same { Self::Mass { pulled: forces[0] != 0.0 } } else { Self::Spring }
    }

    fn words(self, force: f64) -> String {
        match self {
            Self::Spring => "a spring of this force, not to scale".to_owned(),
            Self::Mass { pulled: false } => "a free mass".to_owned(),
            Self::Mass { pulled: true } => {
                let way = if force > 0.0 { "left" } else { "right" };
                format!("a steady force of {} N to the {way}", three(force.abs()))
            }
        }
    }
}

/// The mass on its rail, with a spring from above where there is one.
pub(super) fn schematic(
    painter: &egui::Painter,
    context: &ViewContext<'_>,
    rect: Rect,
    (x, middle, half): (f32, f32, egui::Vec2),
    top: f32,
) -> String {
    let style = context.style;
    let curve = &context.drawn.model(context.session).mechanism().curve;
    let own = Schematic::of(curve, context.span);
    painter.hline(rect.x_range().shrink(6.0), middle + half.y + 3.0, Stroke::new(2.0, style.faint()));
    if own == Schematic::Spring {
        let clamp_at = Rect::from_x_y_ranges(rect.x_range().shrink(6.0), top - CLAMP..=top);
        clamp(painter, &style, clamp_at, true);
        let barrier = context.drawn.model(context.session).mechanism().landscape.barrier;
        let foot = context.span.screen_from_world(barrier.map_or(0.0, |barrier| barrier.x), rect);
        let (from, to) = (pos2(foot, top), pos2(x, middle - half.y));
        painter.add(Shape::line(coil(from, to), style.flexure_stroke()));
    }
    own.words(curve.force(0.0_f64.clamp(curve.domain().0, curve.domain().1)))
}

/// A coil spring from one place to another: straight ends, and turns between that a stretch pulls apart.
fn coil(from: Pos2, to: Pos2) -> Vec<Pos2> {
    let along = to - from;
    let across = along.normalized().rot90() * COIL;
    let turn = |i: usize| {
        let share = 0.15 + 0.7 * (i as f32 + 0.5) / COILS as f32;
        from + along * share + if i.is_multiple_of(2) { across } else { -across }
    };
    let turns = (0..COILS).map(turn);
    [from, from + along * 0.15].into_iter().chain(turns).chain([from + along * 0.85, to]).collect()
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
            let curve = &session.model().mechanism().curve;
            Schematic::of(curve, Span::of(&session, (0.0, 0.0))).words(curve.force(0.0))
        };
        assert_eq!(words("bouncing-ball"), "a steady force of 9.81 N to the left");
        assert_eq!(words("elastic-box"), "a free mass");
        for preset in ["duffing", "monostable", "nominal-cubic", "paper-table"] {
            assert!(words(preset).starts_with("a spring"), "{preset}");
        }
    }
}
