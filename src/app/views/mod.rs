//! The views: what of a motion is seen, each in a file of its own.
//!
//! A new view is an entry of [`View`], a file with a function `..._ui(ui, &mut ViewContext)`, and a place in
//! [`layouts`](super::layouts). Views share the x axis of [`Span`], so that mechanism and well stand above each other, and
//! keep what they must remember between frames in [`Memory`].

mod before_now;
mod displacement;
mod map;
mod mechanism;
mod span;
mod stops;
mod well;

use eframe::egui::Ui;

use super::session::Session;
use super::style::Style;

pub use map::Quantity;
pub use span::Span;

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
    /// What every combination of two fields comes to.
    Map,
}

impl View {
    /// All of them, in the order of the menu.
    pub const ALL: [Self; 5] = [Self::Mechanism, Self::Well, Self::Displacement, Self::BeforeNow, Self::Map];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mechanism => "Mechanism",
            Self::Well => "Well",
            Self::Displacement => "Displacement",
            Self::BeforeNow => "Before / now",
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
}

/// What views keep between frames.
#[derive(Debug, Clone, Default)]
pub struct Memory {
    /// The last impact on the left and the right that is drawn as a ring.
    rings: [Option<mechanism::Ring>; 2],
    /// The time up to which impacts have been looked at.
    seen_to: f64,
    /// The view under the pointer.
    pub hovered: Option<View>,
    /// Time span of the displacement in s, where a person has chosen one.
    pub time_window: Option<f64>,
    /// What the map shows.
    pub map_quantity: Quantity,
}

/// Draws one view. Whether it changed something.
pub fn view_ui(ui: &mut Ui, view: View, context: &mut ViewContext<'_>) -> bool {
    if ui.rect_contains_pointer(ui.max_rect()) {
        context.memory.hovered = Some(view);
    }
    match view {
        View::Mechanism => mechanism::mechanism_ui(ui, context),
        View::Well => well::well_ui(ui, context),
        View::Displacement => displacement::displacement_ui(ui, context),
        View::BeforeNow => before_now::before_now_ui(ui, context),
        View::Map => map::map_ui(ui, context),
    }
}
