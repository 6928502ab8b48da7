//! The one line of the first minute: what to try, until it has been done or dismissed.

use eframe::egui::{RichText, Ui};

use crate::dynamics::EventKind;

use super::session::Session;
use super::style::strong_family;

/// Whether the line is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hint {
    open: bool,
}

impl Hint {
    /// Where a scene begins in a well, with something to cross and stops to switch on.
    pub fn for_scene(session: &Session) -> Self {
        let scene = session.scene();
        let offered = scene.app.as_ref().is_some_and(|app| app.stops_when_on.is_some());
        let barrier = session.model().mechanism.landscape.barrier.is_some();
        Self { open: offered && barrier && session.amplitude_g().is_some() }
    }

    /// Whether it is to be shown; once the mass has crossed it is not any more.
    pub fn is_shown(&mut self, session: &Session) -> bool {
        let crossed = |kind| kind == EventKind::Crossing;
        // crossings are rare and recent: a look at the last events is enough
        let done = session.player.watch().events().iter().rev().take(50).any(|event| crossed(event.kind));
        self.open &= !done;
        self.open
    }

    /// Draws it.
    pub fn ui(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let font = eframe::egui::FontId::new(super::style::BODY, strong_family());
            ui.label(RichText::new("Make it cross to the other side.").font(font));
            ui.label("Two things help: shake harder, or put stops near the middle.");
            if ui.small_button("Dismiss").clicked() {
                self.open = false;
            }
        });
    }
}
