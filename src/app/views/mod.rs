//! The views of the window.
//!
//! Each view is a row of the table of [`View`], and a function, which the row names, in a separate file or
//! folder. Views share the x axis of [`Span`], so that the mechanism lines up with the well below it, and
//! keep their state between frames in [`Memory`].

mod accuracy;
mod axes;
mod basins;
mod compare;
mod context;
mod cursors;
pub mod energy;
mod events;
mod force;
mod ghosts;
mod hand;
mod labels;
mod layer;
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
mod row;
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

pub use context::{Cover, ViewContext};
use context::{covered_ui, empty_ui, offer_ui, page_ui, too_small_ui};
pub use cursors::Cursors;
pub use memory::{MapLook, Memory, Timeline};
pub use row::LegendRow;
pub use span::Span;
pub(super) use trace::stretch;
pub use view::View;

/// The text over a view that is covered until the first prediction of a lesson has been shown.
const LATER: &str = "This is shown after the first prediction.";

pub fn view_ui(ui: &mut Ui, view: View, context: &mut ViewContext<'_>) {
    // the rest of the panel: a view that fills the window has a title and a button above it
    let rect = ui.available_rect_before_wrap();
    if ui.rect_contains_pointer(rect) {
        context.memory.hovered = Some(view);
    }
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| drawn_ui(ui, view, context));
}

fn drawn_ui(ui: &mut Ui, view: View, context: &mut ViewContext<'_>) {
    if context.memory.covered == Some(view) {
        return covered_ui(ui, &context.style, LATER);
    }
    match context.cover {
        Cover::None => {}
        Cover::Surveys if !view.is_survey() => {}
        Cover::Future if view.is_static() => {
            ui.disable();
            ui.set_opacity(1.0);
        }
        Cover::Surveys => return covered_ui(ui, &context.style, LATER),
        Cover::Future | Cover::All => {
            let question = context.memory.question.as_deref().unwrap_or("What do you expect?");
            return covered_ui(ui, &context.style, question);
        }
    }
    view.ui(ui, context);
}
