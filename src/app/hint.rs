//! The line of the first minute: what to try next, until it has been done or dismissed.

use eframe::egui::{RichText, Ui};

use crate::dynamics::EventKind;
use crate::scene::Stops;

use super::session::Session;
use super::style::strong_family;

/// How far in mm the stops are moved before the trade-off counts as tried.
const TRIED_MM: f64 = 0.3;

/// What is to be tried.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    /// Make it cross.
    Cross,
    /// It has crossed by shaking: now with stops.
    Compare,
    /// It crosses between stops, which stood at so many mm: now move them.
    Move { from_mm: f64 },
    /// Nothing any more.
    Done,
}

/// Whether the line is there, and what it says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hint {
    stage: Stage,
    /// The shaking in g that the scene was opened with.
    opened_g: f64,
}

impl Hint {
    /// Where a scene begins in a well, with something to cross and stops to switch on.
    pub fn for_scene(session: &Session) -> Self {
        let offered = session.scene().app.as_ref().is_some_and(|app| app.stops_when_on.is_some());
        let barrier = session.model().mechanism.landscape.barrier.is_some();
        match session.amplitude_g().filter(|_| offered && barrier) {
            Some(opened_g) => Self { stage: Stage::Cross, opened_g },
            None => Self { stage: Stage::Done, opened_g: 0.0 },
        }
    }

    /// Whether it is to be shown; goes on to the next stage once one is done.
    pub fn is_shown(&mut self, session: &Session) -> bool {
        if self.stage == Stage::Done {
            return false;
        }
        // crossings are rare and recent: a look at the last events is enough
        let crossed = session.player.watch().events().iter().rev().take(50).any(|event| {
            event.kind == EventKind::Crossing && event.t >= session.changed_at() && session.changed_at() > 0.0
        });
        let limit_mm = match session.scene().stops {
            Stops::Rigid { travel_limit_mm, .. } | Stops::Hertz { travel_limit_mm, .. } => {
                Some(travel_limit_mm)
            }
            _ => None,
        };
        self.stage = match (self.stage, limit_mm) {
            (Stage::Cross | Stage::Compare, Some(from_mm)) if crossed => Stage::Move { from_mm },
            (Stage::Cross, None) if crossed => Stage::Compare,
            (Stage::Move { from_mm }, Some(mm))
                if (mm - from_mm).abs() >= TRIED_MM && !session.editor.in_gesture() =>
            {
                Stage::Done
            }
            (stage, _) => stage,
        };
        self.stage != Stage::Done
    }

    /// What it says: what there is, and what to try.
    pub fn text(&self) -> (&'static str, String) {
        match self.stage {
            Stage::Cross => (
                "Make it cross to the other side.",
                "Two things help: shake harder, or put stops near the middle.".to_owned(),
            ),
            Stage::Compare => (
                "It crosses.",
                format!(
                    "Now go back to {:.1} g and switch the stops on: what is gained, what does it cost?",
                    self.opened_g
                ),
            ),
            Stage::Move { .. } => (
                "It crosses between stops.",
                "Compare before and now. Then move the stops outward: how far does that help?".to_owned(),
            ),
            Stage::Done => ("", String::new()),
        }
    }

    /// Draws it.
    pub fn ui(&mut self, ui: &mut Ui) {
        let (first, then) = self.text();
        ui.horizontal(|ui| {
            let font = eframe::egui::FontId::new(super::style::BODY, strong_family());
            ui.label(RichText::new(first).font(font));
            ui.label(then);
            if ui.small_button("Dismiss").clicked() {
                self.stage = Stage::Done;
            }
        });
    }
}
