//! What every view is given, and what stands in the place of one that has no room.

use eframe::egui::{Align, Label, Layout, Rect, RichText, Ui, UiBuilder};

use crate::app::session::Session;
use crate::app::session::pins::Pin;
use crate::app::ui::style::Style;
use crate::dynamics::{Model, Sample};
use crate::study::Watch;

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

/// Which motion a drawing shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drawn {
    /// The present one, and the pinned ones as ghosts.
    WithGhosts,
    /// The present one.
    Alone,
    /// The pinned one at this place; no hand moves it.
    Pinned(usize),
}

impl Drawn {
    /// The pinned motion that is drawn.
    pub(super) fn pin(self, session: &Session) -> Option<&Pin> {
        match self {
            Self::Pinned(place) => session.pins.all().get(place),
            Self::WithGhosts | Self::Alone => None,
        }
    }

    /// Its past.
    pub(super) fn watch(self, session: &Session) -> &Watch {
        self.pin(session).map_or(session.player.watch(), Pin::watch)
    }

    /// Its state at the time that is shown.
    pub(super) fn state(self, session: &Session) -> Sample {
        self.pin(session).map_or_else(|| session.player.state(), |pin| pin.state_at(session.player.time()))
    }

    /// The model by which it moves then.
    pub(super) fn model(self, session: &Session) -> &Model {
        let of_pin = |pin| Pin::watch(pin).model_at(session.player.time());
        self.pin(session).map_or(session.shown(), |pin| of_pin(pin))
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
    pub cover: Cover,
    /// One view fills the window, and shares its axes with none.
    pub filled: bool,
    pub drawn: Drawn,
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
