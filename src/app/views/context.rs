//! Context passed to every view, and the placeholder of a view that is too small.

use std::sync::Arc;

use eframe::egui::{Align, Label, Layout, Rect, RichText, Ui, UiBuilder};

use crate::app::session::Session;
use crate::app::session::pins::Pin;
use crate::app::ui::style::Style;
use crate::dynamics::{Model, Sample};
use crate::study::Watch;

use super::memory::Memory;
use super::span::Span;

/// What a lesson covers until the learner has made a prediction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cover {
    None,
    /// Results of other settings or starts than the present ones.
    Surveys,
    /// Everything that follows from the motion, which stands at its start; nothing can be moved.
    Future,
    /// The motion and all results.
    All,
}

/// Which motion a drawing shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drawn {
    /// The present motion, with the pinned ones as ghosts.
    WithGhosts,
    /// The present motion alone.
    Alone,
    /// The pinned motion at this index, which cannot be moved by hand.
    Pinned(usize),
}

impl Drawn {
    /// The pinned motion that is drawn, if any.
    pub(super) fn pin(self, session: &Session) -> Option<&Pin> {
        match self {
            Self::Pinned(place) => session.pins.all().get(place),
            Self::WithGhosts | Self::Alone => None,
        }
    }

    /// The recorded motion that is drawn.
    pub(super) fn watch(self, session: &Session) -> &Watch {
        self.pin(session).map_or(session.player.watch(), Pin::watch)
    }

    /// Its state at the time that is shown.
    pub(super) fn state(self, session: &Session) -> Sample {
        self.pin(session).map_or_else(|| session.player.state(), |pin| pin.state_at(session.player.time()))
    }

    /// Its model at that time.
    pub(super) fn model(self, session: &Session) -> &Arc<Model> {
        let of_pin = |pin| Pin::watch(pin).model_at(session.player.time());
        self.pin(session).map_or(session.shown(), |pin| of_pin(pin))
    }
}

/// What a view shows and acts on.
pub struct ViewContext<'a> {
    /// The open scene: document, model, motion, results.
    pub session: &'a mut Session,
    /// Colours and line widths.
    pub style: Style,
    /// The x axis that views share.
    pub span: Span,
    /// State that views keep between frames.
    pub memory: &'a mut Memory,
    /// Whether rings at impacts are left out.
    pub reduce_motion: bool,
    pub cover: Cover,
    /// Whether the view fills the window, so that it shares its axes with no other.
    pub filled: bool,
    pub drawn: Drawn,
}

/// Shows a hint in place of a view that is too small.
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
