//! The views, each in a file of its own.
//!
//! A new view is an entry of [`View`], a file with a function `..._ui(ui, &mut ViewContext)`, and a place in
//! a layout of the window. Views share the x axis of [`Span`], so that mechanism and well stand above each
//! other, and keep what they must remember between frames in [`Memory`].

mod accuracy;
mod before_now;
mod chart;
pub mod energy;
mod flexures;
mod force;
mod labels;
mod legend;
mod map;
mod mass;
mod mechanism;
mod phase;
mod ranges;
mod schematic;
mod span;
mod stops;
mod timeline;
mod trace;
mod well;

use eframe::egui::{Align, Label, Layout, Rect, RichText, Ui, UiBuilder};

use crate::app::session::Session;
use crate::app::ui::style::Style;
use crate::mechanics::flexure::State;

pub use map::MapQuantity;
pub use span::Span;
pub use timeline::Timeline;
pub use trace::TraceQuantity;

/// What can be seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum View {
    /// The mechanism as a drawing.
    Mechanism,
    /// The potential with the mass on it.
    Well,
    /// Displacement over time.
    Displacement,
    /// The state before the last gesture against the present one.
    BeforeNow,
    /// Velocity over displacement.
    PhasePortrait,
    /// The force that holds the mass against the mechanism, over displacement.
    ForceCurve,
    /// Where the energy went.
    Energy,
    /// Velocity over time.
    Velocity,
    /// Acceleration of the base over time.
    BaseAcceleration,
    /// Work of the base in a second, over time.
    Power,
    /// What every combination of two fields comes to.
    Map,
    /// What digits cost, and what a fixed step makes of the scene.
    Accuracy,
}

impl View {
    /// All of them, in the order of the menu.
    pub const ALL: [Self; 12] = [
        Self::Mechanism,
        Self::Well,
        Self::Displacement,
        Self::BeforeNow,
        Self::PhasePortrait,
        Self::ForceCurve,
        Self::Energy,
        Self::Velocity,
        Self::BaseAcceleration,
        Self::Power,
        Self::Map,
        Self::Accuracy,
    ];

    /// Whether the displacement runs along it.
    pub fn is_along_x(self) -> bool {
        matches!(self, Self::Mechanism | Self::Well | Self::PhasePortrait | Self::ForceCurve)
    }

    /// What it shows and what a hand can do in it.
    pub fn about(self) -> &'static str {
        match self {
            Self::Mechanism => {
                "The mass between its stops, seen from the base that shakes, with its flexures or a spring \
                 in their place. The arrow is the push that the mass feels. Drag the mass or a stop."
            }
            Self::Well => {
                "The mass rides on the potential like a ball on a tray that the push tips. Drag the ball or \
                 a stop."
            }
            Self::Displacement => {
                "Where the mass is, seen from the base, over time. The wheel zooms in time; with Shift, or \
                 over the numbers of the axis, in displacement. A double click is back."
            }
            Self::BeforeNow => "What your last change did: the state before it, and the one after it.",
            Self::PhasePortrait => {
                "Velocity over displacement: a moving mass runs clockwise. An impact is a jump of the \
                 velocity. The separatrix needs just the energy to stand on the barrier. Click to let the \
                 motion go on from a state."
            }
            Self::ForceCurve => {
                "The force that would hold the mass at a place, positive to the right; the mechanism pulls \
                 with as much the other way. Where the push is above the curve it drives the mass to the \
                 right, below it to the left; a mass on a stop is freed when the push passes the mark there. \
                 Filled: stable. Hollow: unstable. Diamond: a kink, where the stiffness jumps."
            }
            Self::Energy => {
                "Where the energy came from, where it went, and what is there against the barrier."
            }
            Self::Velocity => {
                "Velocity of the mass, seen from the base, over time. An impact turns it round and leaves a \
                 part of it. The wheel zooms in time, a double click is back."
            }
            Self::BaseAcceleration => {
                "Acceleration of the base over time. The mass feels the opposite of it, as one does in a bus \
                 that brakes. The wheel zooms in time, a double click is back."
            }
            Self::Power => {
                "Work of the base on the mass in a second. Below zero the mass gives energy back to the \
                 base. The wheel zooms in time, a double click is back."
            }
            Self::Map => {
                "What every combination of two settings comes to, each in a run of its own. Click to take \
                 the scene there."
            }
            Self::Accuracy => {
                "How far the computed motion is from the true one: what each digit costs, and what becomes \
                 of the scene in fixed steps, as a game or a small applet takes them. From the scene's start."
            }
        }
    }

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mechanism => "Mechanism",
            Self::Well => "Well",
            Self::Displacement => "Displacement",
            Self::BeforeNow => "Before / now",
            Self::PhasePortrait => "Phase portrait",
            Self::ForceCurve => "Force curve",
            Self::Energy => "Energy",
            Self::Velocity => "Velocity",
            Self::BaseAcceleration => "Base acceleration",
            Self::Power => "Power",
            Self::Map => "Map",
            Self::Accuracy => "Accuracy",
        }
    }
}

impl Memory {
    /// The x axis that views share, with room for what has been seen.
    pub fn span(&mut self, session: &Session) -> Span {
        let seen = self.ranges.follow(session).reach(session);
        let own = Span::of(session, seen);
        let x = session.player.state().x;
        let is_seen = self.held.span.0.is_none_or(|(low, high)| low < x && x < high);
        let held = session.editor.in_gesture() && is_seen;
        let (low, high) = self.held.span.keep((own.low, own.high), held);
        Span { low, high }
    }
}

/// What a view looks at and acts on.
pub struct ViewContext<'a> {
    /// The open scene: document, model, motion, results.
    pub session: &'a mut Session,
    /// Colours and widths.
    pub style: Style,
    /// The x axis that views share.
    pub span: Span,
    /// What views keep between frames.
    pub memory: &'a mut Memory,
    /// No rings at impacts.
    pub reduce_motion: bool,
    /// The motion and all results are covered: predict first.
    pub covered: bool,
    /// One view fills the window, and shares its axes with none.
    pub filled: bool,
}

/// An axis that stands still while a hand changes the scene, so that what the hand does to it is seen.
#[derive(Debug, Clone, Copy, Default)]
struct Held(Option<(f64, f64)>);

/// The room in an axis, as a share of it, that may be used up before an axis that is held gives way.
const SPARE: f64 = 0.08;

impl Held {
    /// The ends of the axis: those that it should have, or in the midst of a gesture those that it had, as
    /// long as what it has to show is inside.
    fn keep(&mut self, own: (f64, f64), in_gesture: bool) -> (f64, f64) {
        let spare = SPARE * (own.1 - own.0);
        let holds = |had: &(f64, f64)| had.0 <= own.0 + spare && had.1 >= own.1 - spare;
        let ends = self.0.filter(|had| in_gesture && holds(had)).unwrap_or(own);
        self.0 = Some(ends);
        ends
    }
}

/// The axes that stand still during a gesture.
#[derive(Debug, Clone, Copy, Default)]
struct HeldAxes {
    /// Displacement.
    span: Held,
    /// Potential energy.
    heights: Held,
    /// Force.
    force: Held,
}

/// What views keep between frames.
#[derive(Debug, Clone, Default)]
pub struct Memory {
    /// Axes that stand still during a gesture.
    held: HeldAxes,
    /// The last impact on the left and the right that is drawn as a ring.
    rings: [Option<mechanism::Ring>; 2],
    /// The flexures as they were drawn last.
    bent: Option<State>,
    /// The time up to which impacts have been looked at.
    seen_to: f64,
    /// The mass is to be taken hold of by the first view that has it.
    pub grab: bool,
    /// The view under the pointer.
    pub hovered: Option<View>,
    /// What the traces share.
    pub timeline: Timeline,
    /// How far axes of velocity and power reach.
    ranges: ranges::Ranges,
    /// The phase portrait shows a point a period and no path.
    pub points_only: bool,
    /// What the map shows.
    pub map_quantity: MapQuantity,
    /// State of the pointer on the map.
    map_pointer: map::PointerState,
    /// What the view Accuracy shows where there is no room for all of it.
    accuracy_page: accuracy::Page,
}

/// Draws one view. Whether it changed something.
pub fn view_ui(ui: &mut Ui, view: View, context: &mut ViewContext<'_>) -> bool {
    // what is left of the panel: over a filled window stand a title and a button
    let rect = ui.available_rect_before_wrap();
    if ui.rect_contains_pointer(rect) {
        context.memory.hovered = Some(view);
    }
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| drawn_ui(ui, view, context)).inner
}

/// What stands in the place of a view while the motion and all results are covered.
fn covered_ui(ui: &mut Ui, style: &Style) {
    let rect = ui.max_rect();
    ui.painter().rect_filled(rect, 0.0, style.ground());
    ui.scope_builder(UiBuilder::new().max_rect(rect.shrink(12.0)), |ui| {
        ui.label("Covered");
    });
}

/// In place of a view that has no room: a word, where there is room for one.
fn too_small_ui(ui: &mut Ui, style: &Style, area: Rect) {
    ui.painter().rect_filled(area, 0.0, style.ground());
    let text = RichText::new("Too small to show: drag an edge of it, or press Z over it.")
        .small()
        .color(style.faint());
    let middle = UiBuilder::new().max_rect(area.shrink(4.0)).layout(Layout::top_down(Align::Center));
    ui.scope_builder(middle, |ui| {
        ui.set_clip_rect(area.intersect(ui.clip_rect()));
        ui.add(Label::new(text).wrap())
    });
}

fn drawn_ui(ui: &mut Ui, view: View, context: &mut ViewContext<'_>) -> bool {
    if context.covered {
        covered_ui(ui, &context.style);
        return false;
    }
    match view {
        View::Mechanism => mechanism::mechanism_ui(ui, context),
        View::Well => well::well_ui(ui, context),
        View::Displacement => trace::trace_ui(ui, TraceQuantity::Displacement, context),
        View::BeforeNow => before_now::before_now_ui(ui, context),
        View::PhasePortrait => phase::phase_ui(ui, context),
        View::ForceCurve => force::force_ui(ui, context),
        View::Energy => energy::energy_ui(ui, context),
        View::Velocity => trace::trace_ui(ui, TraceQuantity::Velocity, context),
        View::BaseAcceleration => trace::trace_ui(ui, TraceQuantity::BaseAcceleration, context),
        View::Power => trace::trace_ui(ui, TraceQuantity::Power, context),
        View::Map => map::map_ui(ui, context),
        View::Accuracy => accuracy::accuracy_ui(ui, context),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_stands_still_while_a_hand_moves_what_it_shows() {
        let mut held = Held::default();
        assert_eq!(held.keep((-8.0, 8.0), false), (-8.0, 8.0));
        // smaller or a little larger it stays, and what leaves it takes it along
        assert_eq!(held.keep((-4.0, 4.0), true), (-8.0, 8.0));
        assert_eq!(held.keep((-9.0, 9.0), true), (-8.0, 8.0));
        assert_eq!(held.keep((-12.0, 12.0), true), (-12.0, 12.0));
        assert_eq!(held.keep((-9.0, 9.0), true), (-12.0, 12.0));
        assert_eq!(held.keep((-9.0, 9.0), false), (-9.0, 9.0));
    }
}
