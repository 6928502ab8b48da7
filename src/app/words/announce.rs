//! Announcements of the motion for screen readers.
//!
//! The sentence itself can always be read. It is spoken when the kind of motion changes, and otherwise once
//! it has stood still for a while: a slider under way would make it talk without end.

use eframe::egui::{self, Id, Role, Ui, accesskit::Live};

use super::kind::Kind;
use super::status::Sentence;

/// Seconds for which a sentence stands still before it is spoken.
const STILL: f64 = 0.5;

/// What was said, and what waits to be.
#[derive(Debug, Default)]
pub struct Announcer {
    said: Option<(Kind, String)>,
    /// The newest sentence and since when it stands.
    waiting: Option<(String, f64)>,
    count: u64,
}

impl Announcer {
    /// Takes in the sentence of this frame at `now` in s. Seconds until it will be spoken, where it waits.
    pub fn take(&mut self, sentence: &Sentence, now: f64) -> Option<f64> {
        let text = sentence.whole();
        let Some((kind, said)) = &self.said else {
            self.say(sentence.kind, text);
            return None;
        };
        if *said == text {
            self.waiting = None;
            return None;
        }
        let since = match &self.waiting {
            Some((waiting, since)) if *waiting == text => *since,
            _ => now,
        };
        if *kind != sentence.kind || now - since >= STILL {
            self.say(sentence.kind, text);
            return None;
        }
        self.waiting = Some((text, since));
        Some(since + STILL - now)
    }

    fn say(&mut self, kind: Kind, text: String) {
        (self.said, self.waiting) = (Some((kind, text)), None);
        self.count += 1;
    }

    /// What was spoken last, with its sequence number.
    pub fn said(&self) -> Option<(u64, &str)> {
        self.said.as_ref().map(|(_, text)| (self.count, text.as_str()))
    }

    /// Puts what was spoken last into the tree that screen readers read.
    pub fn ui(&self, ui: &mut Ui) {
        let Some((count, text)) = self.said() else { return };
        spoken_ui(ui, Id::unique(("announcement", count)), text);
    }
}

/// Puts a text into the tree that screen readers read: as a new node for each, since readers on Linux speak
/// when a live node enters the tree and not when its text changes.
pub fn spoken_ui(ui: &mut Ui, id: Id, text: &str) {
    let nowhere = egui::Rect::from_min_size(ui.min_rect().left_top(), egui::Vec2::ZERO);
    ui.interact(nowhere, id, egui::Sense::hover());
    ui.ctx().accesskit_node_builder(id, |node| {
        node.set_role(Role::Status);
        node.set_live(Live::Polite);
        node.set_label(text);
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sentence(kind: Kind, text: &str) -> Sentence {
        Sentence { kind, text: text.to_owned(), remedy: String::new() }
    }

    #[test]
    fn another_motion_is_spoken_at_once_and_another_number_when_it_stands() {
        let mut announcer = Announcer::default();
        assert_eq!(announcer.take(&sentence(Kind::Intrawell, "17"), 0.0), None);
        assert_eq!(announcer.said(), Some((1, "17")));
        // a slider under way
        for i in 0..100 {
            let wait = announcer.take(&sentence(Kind::Intrawell, &i.to_string()), 1.0 + 0.1 * f64::from(i));
            assert_eq!(wait.map(|wait| (wait - STILL).abs() < 1e-9), (i != 17).then_some(true));
        }
        assert_eq!(announcer.said(), Some((1, "17")));
        assert!(announcer.take(&sentence(Kind::Intrawell, "99"), 11.2).is_some());
        assert_eq!(announcer.take(&sentence(Kind::Intrawell, "99"), 11.5), None);
        assert_eq!(announcer.said(), Some((2, "99")));
        assert_eq!(announcer.take(&sentence(Kind::Interwell, "crosses"), 11.6), None);
        assert_eq!(announcer.said(), Some((3, "crosses")));
    }
}
