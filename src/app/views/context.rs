//! What every view is given, and what stands in the place of one that has no room.

use eframe::egui::{Align, Label, Layout, Rect, RichText, Ui, UiBuilder};

use crate::app::session::Session;
use crate::app::ui::style::Style;

use super::memory::Memory;
use super::span::Span;

/// What is covered, so that one predicts first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cover {
    /// Nothing.
    None,
    /// What other settings or starts than the present ones would come to.
    Surveys,
    /// All that is not there to be seen before the motion begins; the motion stands at its start, and nothing
    /// can be moved.
    Future,
    /// The motion and all results.
    All,
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
    /// What is covered.
    pub cover: Cover,
    /// One view fills the window, and shares its axes with none.
    pub filled: bool,
}

/// In place of a view that has no room: a word, where there is room for one.
pub fn too_small_ui(ui: &mut Ui, style: &Style, area: Rect) {
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
