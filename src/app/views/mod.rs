//! The views of the window.
//!
//! Each view is a row of the table of [`View`] and a function `..._ui(ui, &mut ViewContext)` in its own file
//! or folder. Views share the x axis of [`Span`], so that the mechanism lines up with the well below it, and
//! keep their state between frames in [`Memory`].

mod accuracy;
mod axes;
mod basins;
mod before_now;
mod beside;
mod chart;
mod compare;
mod context;
mod cursor_times;
mod cursors;
mod distance;
pub mod energy;
mod events;
mod flexures;
mod force;
mod ghosts;
mod hand;
mod labels;
mod legend;
mod map;
mod mass;
mod measured;
mod mechanism;
mod memory;
mod overlay;
mod pane;
mod phase;
mod plot;
mod power;
mod ranges;
mod schematic;
mod side_by_side;
mod span;
mod spectrum;
mod stops;
mod table;
mod trace;
mod up_and_down;
mod view;
mod well;
mod zoom;

use eframe::egui::{Ui, UiBuilder};

use crate::app::ui::style::Style;

pub(super) use context::too_small_ui;
pub use context::{Cover, Drawn, ViewContext};
pub use cursor_times::Cursors;
pub use memory::{MapLook, Memory, Timeline};
pub use span::Span;
pub use trace::TraceQuantity;
pub(super) use trace::stretch;
pub use view::View;

pub fn view_ui(ui: &mut Ui, view: View, context: &mut ViewContext<'_>) {
    // the rest of the panel: a view that fills the window has a title and a button above it
    let rect = ui.available_rect_before_wrap();
    if ui.rect_contains_pointer(rect) {
        context.memory.hovered = Some(view);
    }
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| drawn_ui(ui, view, context));
}

/// Draws the placeholder of a view whose content is covered.
fn covered_ui(ui: &mut Ui, style: &Style) {
    let rect = ui.max_rect();
    ui.painter().rect_filled(rect, 0.0, style.ground());
    ui.scope_builder(UiBuilder::new().max_rect(rect.shrink(12.0)), |ui| {
        ui.label("Covered");
    });
}

fn drawn_ui(ui: &mut Ui, view: View, context: &mut ViewContext<'_>) {
    if context.memory.covered == Some(view) {
        return covered_ui(ui, &context.style);
    }
    match context.cover {
        Cover::None => {}
        Cover::Surveys if !view.is_survey() => {}
        Cover::Future if view.is_static() => {
            ui.disable();
            ui.set_opacity(1.0);
        }
        Cover::Surveys | Cover::Future | Cover::All => return covered_ui(ui, &context.style),
    }
    match view {
        View::Mechanism => mechanism::mechanism_ui(ui, context),
        View::Well => well::well_ui(ui, context),
        View::Displacement => trace::trace_ui(ui, TraceQuantity::Displacement, context),
        View::BeforeNow => before_now::before_now_ui(ui, context),
        View::Compare => compare::compare_ui(ui, context),
        View::Measured => measured::measured_ui(ui, context),
        View::SideBySide => side_by_side::side_by_side_ui(ui, context),
        View::Distance => distance::distance_ui(ui, context),
        View::PhasePortrait => phase::phase_ui(ui, context),
        View::Section => phase::section_ui(ui, context),
        View::ForceCurve => force::force_ui(ui, context),
        View::Energy => energy::energy_ui(ui, context),
        View::Velocity => trace::trace_ui(ui, TraceQuantity::Velocity, context),
        View::BaseAcceleration => trace::trace_ui(ui, TraceQuantity::BaseAcceleration, context),
        View::Power => power::power_ui(ui, context),
        View::Events => events::events_ui(ui, context),
        View::Map => map::map_ui(ui, context),
        View::UpAndDown => up_and_down::up_and_down_ui(ui, context),
        View::Basins => basins::basins_ui(ui, context),
        View::Spectrum => spectrum::spectrum_ui(ui, context),
        View::Accuracy => accuracy::accuracy_ui(ui, context),
    }
}
