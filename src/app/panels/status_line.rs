//! Status line under the menu: what the mass does, and its announcements.

use eframe::egui::{self, FontId, Id, RichText, Role, Sense, Ui, Vec2, accesskit::Live, vec2};

use crate::app::session::Session;
use crate::app::ui::style::{BODY, STATUS, Style, strong_family};
use crate::app::ui::widgets::{fitting, kind_shapes, parts_ui, prose, tell};
use crate::app::words::kind::Kind;
use crate::app::words::meanings::meaning;
use crate::app::words::status::Sentence;

const SPARE: &str =
    "\n\nTo spare: how much weaker the shaking may become before, from rest, it no longer crosses.";

/// Height in points of a row of the sentence at the size of body text.
const ROW: f32 = 17.0;
/// Height in points that the status line leaves around its rows.
const MARGIN: f32 = 5.0;
/// Width in points of a long sentence in one row.
const LONG: f32 = 1050.0;
/// Greatest number of rows, in a window that is no wider than a column.
const MAX_ROWS: f32 = 5.0;

/// Height in points of the line, which no sentence changes: two rows, or more where the window is narrow.
pub fn height(ui: &Ui) -> f32 {
    let rows = (LONG / (ui.available_width() - 60.0).max(1.0)).ceil().clamp(2.0, MAX_ROWS);
    rows * ROW + MARGIN
}

/// Draws the line.
pub fn status_ui(ui: &mut Ui, session: &mut Session, announcer: &mut Announcer, style: &Style) {
    let sentence = session.sentence();
    announcer.say(ui, &sentence);
    ui.horizontal_centered(|ui| {
        let height = ui.available_height().min(STATUS + 6.0);
        let (rect, _) = ui.allocate_exact_size(Vec2::new(STATUS + 6.0, height), Sense::hover());
        let (kind, color) = (sentence.kind, style.kind(sentence.kind));
        ui.painter().extend(kind_shapes(kind, rect.center(), height.min(STATUS) * 0.42, color));
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            // the name of the motion is read first, in larger letters
            let name = sentence.text.split_at(sentence.text.find(':').map_or(0, |at| at + 1)).0;
            if !name.is_empty() {
                let font = FontId::new(STATUS, strong_family());
                let galley = ui.painter().layout_no_wrap(name.to_owned(), font, style.ink());
                let (place, _) = ui.allocate_exact_size(galley.size(), Sense::hover());
                ui.painter().galley(place.min, galley, style.ink());
            }
            let room = ui.available_size();
            let whole = sentence.whole();
            let is_whole = fitting(ui, &prose(&whole[name.len()..]), room, BODY).0 == BODY;
            let text = if is_whole { whole } else { sentence.text.clone() };
            let rest = text[name.len()..].trim();
            // what it does in a row, and below it what is known besides, where both fit
            let rows = rest.replacen(". ", ".\n", 1);
            let in_rows = fitting(ui, &prose(&rows), vec2(room.x, f32::INFINITY), BODY);
            let is_in_rows = in_rows.0 == BODY && in_rows.1 <= room.y;
            let parts = prose(if is_in_rows { &rows } else { rest });
            let (size, _) = fitting(ui, &parts, room, BODY);
            let label = parts_ui(ui, &parts, size);
            tell(&label, Role::Label, &text);
            if label.hovered() {
                let kind = meaning(&sentence.text).map_or_else(String::new, |text| format!("{text}\n\n"));
                let spare = if sentence.remedy.contains("to spare") { SPARE } else { "" };
                label.on_hover_text(format!("{kind}{}{spare}", session.ways()));
            }
        });
    });
}

/// The text in place of the sentence while the results are covered: by a prediction, with its number of
/// votes, or by a key.
pub fn covered_ui(ui: &mut Ui, votes: Option<u32>) {
    let text = match votes {
        None => "Covered: what do you expect? C shows it again.",
        Some(0) => "Covered until you choose: what do you expect?",
        Some(1) => "1 vote is counted. Reveal shows what it does.",
        Some(votes) => &format!("{votes} votes are counted. Reveal shows what it does."),
    };
    ui.horizontal_centered(|ui| ui.label(RichText::new(text).heading().size(STATUS)));
}

/// Time in s for which a sentence has to stay unchanged before it is spoken.
const STILL: f64 = 0.5;

/// Announcements of the motion for screen readers.
///
/// The sentence itself can always be read. It is spoken when the kind of motion changes, and otherwise once
/// it has not changed for a while: a slider that moves would make a screen reader speak without end.
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

    /// Speaks the sentence of the frame once it is to be spoken: what was spoken last is in the accessibility
    /// tree.
    pub fn say(&mut self, ui: &mut Ui, sentence: &Sentence) {
        if let Some(seconds) = self.take(sentence, ui.input(|input| input.time)) {
            ui.ctx().request_repaint_after_secs(seconds as f32);
        }
        if let Some((count, text)) = self.spoken() {
            spoken_ui(ui, Id::unique(("announcement", count)), text);
        }
    }

    fn speak(&mut self, kind: Kind, text: String) {
        (self.spoken, self.waiting) = (Some((kind, text)), None);
        self.count += 1;
    }

    /// The sentence that was spoken last, with its sequence number.
    pub fn spoken(&self) -> Option<(u64, &str)> {
        self.spoken.as_ref().map(|(_, text)| (self.count, text.as_str()))
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
