//! The views: what of a motion is seen, each in a file of its own.
//!
//! A new view is an entry of [`View`], a file with a function `..._ui(ui, &mut ViewContext)`, and a place in
//! [`layouts`](super::layouts). Views share the x axis of [`Span`], so that mechanism and well stand above each other, and
//! keep what they must remember between frames in [`Memory`].

mod before_now;
mod chart;
pub mod energy;
mod flexures;
mod force;
mod map;
mod mechanism;
mod phase;
mod ranges;
mod span;
mod stops;
mod trace;
mod well;

use eframe::egui::Ui;

use crate::mechanics::flexure::State;

use super::session::Session;
use super::style::Style;

pub use map::Quantity as MapQuantity;
pub use span::Span;
pub use trace::{Quantity, Timeline};

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
    /// The force of the mechanism over displacement.
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
}

impl View {
    /// All of them, in the order of the menu.
    pub const ALL: [Self; 11] = [
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
    ];

    /// Whether the displacement runs along it.
    pub fn is_along_x(self) -> bool {
        matches!(self, Self::Mechanism | Self::Well | Self::PhasePortrait | Self::ForceCurve)
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
        }
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
    /// Results are covered: predict first.
    pub covered: bool,
    /// One view fills the window, and shares its axes with none.
    pub filled: bool,
}

/// What views keep between frames.
#[derive(Debug, Clone, Default)]
pub struct Memory {
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
    /// What the map shows.
    pub map_quantity: MapQuantity,
}

/// Draws one view. Whether it changed something.
pub fn view_ui(ui: &mut Ui, view: View, context: &mut ViewContext<'_>) -> bool {
    if ui.rect_contains_pointer(ui.max_rect()) {
        context.memory.hovered = Some(view);
    }
    match view {
        View::Mechanism => mechanism::mechanism_ui(ui, context),
        View::Well => well::well_ui(ui, context),
        View::Displacement => trace::trace_ui(ui, Quantity::Displacement, context),
        View::BeforeNow => before_now::before_now_ui(ui, context),
        View::PhasePortrait => phase::phase_ui(ui, context),
        View::ForceCurve => force::force_ui(ui, context),
        View::Energy => energy::energy_ui(ui, context),
        View::Velocity => trace::trace_ui(ui, Quantity::Velocity, context),
        View::BaseAcceleration => trace::trace_ui(ui, Quantity::BaseAcceleration, context),
        View::Power => trace::trace_ui(ui, Quantity::Power, context),
        View::Map => map::map_ui(ui, context),
    }
}
