//! Announcements of the motion for screen readers.
//!
//! The sentence itself can always be read. It is spoken when the kind of motion changes, and otherwise once
//! it has not changed for a while: a slider that moves would make a screen reader speak without end.

use eframe::egui::{self, Id, Role, Ui, accesskit::Live};

use super::kind::Kind;
use super::status::Sentence;

/// Time in s for which a sentence has to stay unchanged before it is spoken.
const STILL: f64 = 0.5;

/// The sentence that was spoken last, and the one that waits to be spoken.
#[derive(Debug, Default)]
pub struct Announcer {
    spoken: Option<(Kind, String)>,
    /// The newest sentence, and the time in s since which it has not changed.
    waiting: Option<(String, f64)>,
    count: u64,
}

impl Announcer {
    /// Receives the sentence of the frame at `now` in s. Returns the time in s until it is spoken.
    pub fn take(&mut self, sentence: &Sentence, now: f64) -> Option<f64> {
        let text = sentence.whole();
        let Some((kind, spoken)) = &self.spoken else {
            self.speak(sentence.kind, text);
            return None;
        };
        if *spoken == text {
            self.waiting = None;
            return None;
        }
        let since = match &self.waiting {
            Some((waiting, since)) if *waiting == text => *since,
            _ => now,
        };
        if *kind != sentence.kind || now - since >= STILL {
            self.speak(sentence.kind, text);
            return None;
        }
        self.waiting = Some((text, since));
        Some(since + STILL - now)
    }

    fn speak(&mut self, kind: Kind, text: String) {
        (self.spoken, self.waiting) = (Some((kind, text)), None);
        self.count += 1;
    }

    /// The sentence that was spoken last, with its sequence number.
    pub fn spoken(&self) -> Option<(u64, &str)> {
        self.spoken.as_ref().map(|(_, text)| (self.count, text.as_str()))
    }

    /// Adds the sentence that was spoken last to the accessibility tree.
    pub fn ui(&self, ui: &mut Ui) {
        let Some((count, text)) = self.spoken() else { return };
        spoken_ui(ui, Id::unique(("announcement", count)), text);
    }
}

/// Adds a text to the accessibility tree, as a new node for each text: screen readers on Linux speak when a
/// live node enters the tree, not when its text changes.
pub fn spoken_ui(ui: &mut Ui, id: Id, text: &str) {
    let empty = egui::Rect::from_min_size(ui.min_rect().left_top(), egui::Vec2::ZERO);
    ui.interact(empty, id, egui::Sense::hover());
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
    fn another_motion_is_spoken_at_once_and_another_number_when_it_stays() {
        let mut announcer = Announcer::default();
        assert_eq!(announcer.take(&sentence(Kind::Intrawell, "17"), 0.0), None);
        assert_eq!(announcer.spoken(), Some((1, "17")));
        // while a slider moves
        for i in 0..100 {
            let wait = announcer.take(&sentence(Kind::Intrawell, &i.to_string()), 1.0 + 0.1 * f64::from(i));
            assert_eq!(wait.map(|wait| (wait - STILL).abs() < 1e-9), (i != 17).then_some(true));
        }
        assert_eq!(announcer.spoken(), Some((1, "17")));
        assert!(announcer.take(&sentence(Kind::Intrawell, "99"), 11.2).is_some());
        assert_eq!(announcer.take(&sentence(Kind::Intrawell, "99"), 11.5), None);
        assert_eq!(announcer.spoken(), Some((2, "99")));
        assert_eq!(announcer.take(&sentence(Kind::Interwell, "crosses"), 11.6), None);
        assert_eq!(announcer.spoken(), Some((3, "crosses")));
    }
}
