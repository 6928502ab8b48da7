//! The line of the first minute: what to try next, and at its end what it showed and why.

use eframe::egui::{RichText, Ui};

use crate::dynamics::EventKind;
use crate::scene::Stops;

use super::session::Session;
use super::status::grams;
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
    /// It has crossed between stops at the shaking of the start, with the stops at so many mm: now move them.
    Move { from_mm: f64 },
    /// The stops have been moved: what there was to see.
    Answer,
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
        let barrier = session.model().mechanism().landscape.barrier.is_some();
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
        // Crossings are rare and recent: a look at the last events is enough. One by hand does not count.
        let since = session.changed_at();
        let crossed = since > 0.0
            && !session.is_by_hand()
            && session
                .player
                .watch()
                .events()
                .iter()
                .rev()
                .take(50)
                .any(|event| event.kind == EventKind::Crossing && event.t >= since);
        let limit_mm = limit_mm(session);
        let as_opened = self.is_as_opened(session);
        self.stage = match (self.stage, limit_mm) {
            (Stage::Cross | Stage::Compare, Some(from_mm)) if crossed && as_opened => Stage::Move { from_mm },
            (Stage::Cross, _) if crossed => Stage::Compare,
            (Stage::Move { .. }, None) => Stage::Compare,
            (Stage::Move { from_mm }, Some(mm))
                if (mm - from_mm).abs() >= TRIED_MM && !session.editor.in_gesture() =>
            {
                Stage::Answer
            }
            (stage, _) => stage,
        };
        self.stage != Stage::Done
    }

    /// Whether the shaking is no stronger than at the start.
    fn is_as_opened(&self, session: &Session) -> bool {
        session.amplitude_g().is_some_and(|g| g.abs() <= self.opened_g.abs() * (1.0 + 1e-9))
    }

    /// Whether it takes two lines.
    pub fn is_long(&self) -> bool {
        self.stage == Stage::Answer
    }

    /// What it says: what there is, and what to try.
    pub fn text(&self, session: &Session) -> (&'static str, String) {
        let opened = grams(self.opened_g);
        match (self.stage, limit_mm(session).is_some(), self.is_as_opened(session)) {
            (Stage::Cross, ..) => (
                "Make it cross to the other side.",
                "Two things help: shake harder, or put stops near the middle.".to_owned(),
            ),
            (Stage::Compare, false, false) => (
                "Harder shaking made it cross.",
                format!("Now go back to {opened} g and switch the stops on: what is gained, what does it cost?"),
            ),
            (Stage::Compare, false, true) => (
                "Now with stops.",
                "Switch them on at this shaking: does it cross, and what does it cost?".to_owned(),
            ),
            (Stage::Compare, true, false) => (
                "Now with less shaking.",
                format!("Go back to {opened} g and leave the stops on: does it still cross?"),
            ),
            (Stage::Compare, true, true) => (
                "Now move the stops.",
                "Where must they stand so that it crosses at this shaking?".to_owned(),
            ),
            (Stage::Move { .. }, ..) => (
                "Between these stops it crossed, without more shaking.",
                "Compare before and now. Then move the stops outward: how far does that help?".to_owned(),
            ),
            (Stage::Answer, ..) => (
                "What stops do, and why:",
                "a stop near the middle holds the mass high on the barrier, so that a weaker push carries it over; but \
                 the mass travels less. Further out the mechanism presses the mass harder against the stop, and the same \
                 push no longer frees it or carries it over."
                    .to_owned(),
            ),
            (Stage::Done, ..) => ("", String::new()),
        }
    }

    /// Draws it.
    pub fn ui(&mut self, ui: &mut Ui, session: &Session) {
        let (first, then) = self.text(session);
        ui.horizontal_wrapped(|ui| {
            let font = eframe::egui::FontId::new(super::style::BODY, strong_family());
            ui.label(RichText::new(first).font(font));
            ui.label(then);
            if ui.small_button("Dismiss").clicked() {
                self.stage = Stage::Done;
            }
        });
    }
}

/// The travel limit of stops alike on both sides.
fn limit_mm(session: &Session) -> Option<f64> {
    match session.scene().stops {
        Stops::Rigid { travel_limit_mm, .. } | Stops::Hertz { travel_limit_mm, .. } => Some(travel_limit_mm),
        _ => None,
    }
}
