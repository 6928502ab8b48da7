//! Status line under the menu: what the mass does, with its accuracy beside it; its announcements.

use eframe::egui::{self, FontId, Id, RichText, Role, Sense, Ui, Vec2, accesskit::Live, vec2};

use crate::app::session::{OFFER_TO_STOP, Session};
use crate::app::ui::style::{BODY, COMPACT_BELOW, SMALL, STATUS, Style, strong_family};
use crate::app::ui::widgets::{fitting, kind_shapes, parts_ui, tell};
use crate::app::words::kind::Kind;
use crate::app::words::meanings::meaning;
use crate::app::words::status::Sentence;

const SPARE: &str =
    "\n\nTo spare: how much weaker the shaking may become before, from rest, it no longer crosses.";

/// Width in points of the column beside the sentence.
const BESIDE: f32 = 208.0;
/// Height in points of a line in that column.
const LINE: f32 = 17.0;
/// Width in points of a window below which hover text replaces that column.
const NARROW: f32 = 640.0;
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
    let beside = if has_column(ui) { BESIDE + 76.0 } else { 60.0 };
    let rows = (LONG / (ui.available_width() - beside).max(1.0)).ceil().clamp(2.0, MAX_ROWS);
    rows * ROW + MARGIN
}

/// Whether the window is wide enough for a column beside the sentence.
pub fn has_column(ui: &Ui) -> bool {
    ui.ctx().content_rect().width() >= NARROW
}

/// What stands beside the sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beside {
    /// A column with the accuracy, where there is room for it.
    Accuracy,
    /// The buttons of a lesson.
    Buttons,
    /// Nothing, and below it the guide line: it has one row, without what it would take to cross.
    Guide,
}

/// Draws the line; without a column beside the sentence, the hover text has the accuracy.
pub fn status_ui(
    ui: &mut Ui,
    session: &mut Session,
    announcer: &mut Announcer,
    style: &Style,
    beside: Beside,
) {
    let has_column = beside == Beside::Accuracy && has_column(ui);
    let sentence = session.sentence();
    announcer.say(ui, &sentence);
    ui.horizontal_centered(|ui| {
        let height = ui.available_height().min(STATUS + 6.0);
        let (rect, _) = ui.allocate_exact_size(Vec2::new(STATUS + 6.0, height), Sense::hover());
        let (kind, color) = (sentence.kind, style.kind(sentence.kind));
        ui.painter().extend(kind_shapes(kind, rect.center(), height.min(STATUS) * 0.42, color));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if has_column {
                beside_ui(ui, session, style);
            } else if beside == Beside::Accuracy {
                stop_ui(ui, session);
            }
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let all = [(&*sentence.whole(), egui::FontFamily::Proportional)];
                let has_room = fitting(ui, &all, ui.available_size(), BODY).0 == BODY;
                let is_whole = beside != Beside::Guide && has_room;
                let text = if is_whole { sentence.whole() } else { sentence.text.clone() };
                // the name of the motion is read first, in larger letters where there is room
                let (name, rest) = text.split_at(text.find(':').map_or(0, |at| at + 1));
                let is_compact = ui.ctx().content_rect().width() < COMPACT_BELOW;
                let (large, name, rest) = if is_compact { ("", name, rest) } else { (name, "", rest.trim()) };
                if !large.is_empty() {
                    let font = FontId::new(STATUS, strong_family());
                    let galley = ui.painter().layout_no_wrap(large.to_owned(), font, style.ink());
                    let (place, _) = ui.allocate_exact_size(galley.size(), Sense::hover());
                    ui.painter().galley(place.min, galley, style.ink());
                }
                // what it does in a row, and below it what is known besides, where both fit
                let rows = rest.replacen(". ", ".\n", 1);
                let parts_of = |rest| [(name, strong_family()), (rest, egui::FontFamily::Proportional)];
                let room = ui.available_size();
                let in_rows = fitting(ui, &parts_of(&rows), vec2(room.x, f32::INFINITY), BODY);
                let is_in_rows = in_rows.0 == BODY && in_rows.1 <= room.y;
                let parts = parts_of(if is_in_rows { &rows } else { rest });
                let (size, _) = fitting(ui, &parts, room, BODY);
                let label = parts_ui(ui, &parts, size);
                tell(&label, Role::Label, &text);
                if label.hovered() {
                    let kind = meaning(&sentence.text).map_or_else(String::new, |text| format!("{text}\n\n"));
                    let trust = session.trust().filter(|_| !has_column);
                    let trust = trust.map_or_else(String::new, |(short, _)| format!("\n\n{short}"));
                    let spare = if sentence.remedy.contains("to spare") { SPARE } else { "" };
                    label.on_hover_text(format!("{kind}{}{spare}{trust}", session.ways()));
                }
            });
        });
    });
}

/// Offers to cancel background work that has taken long, in a link.
fn stop_ui(ui: &mut Ui, session: &mut Session) {
    let Some(worked) = session.working() else { return };
    if worked < OFFER_TO_STOP {
        ui.ctx().request_repaint_after(OFFER_TO_STOP - worked);
        return;
    }
    let hover = "Time spent in the background on the settled motion, on what it would take to cross and on \
                 the accuracy. The motion continues without these results; the next change starts anew.";
    let text = RichText::new(format!("Stop computing ({} s)", worked.as_secs())).size(SMALL);
    ui.ctx().request_repaint_after_secs(1.0);
    if ui.link(text).on_hover_text(hover).clicked() {
        session.stop_working();
    }
}

/// The column beside the sentence, which is as wide whatever it says: how accurate the motion is, whether the
/// mass was moved, and the offer to stop computing.
fn beside_ui(ui: &mut Ui, session: &mut Session, style: &Style) {
    let trust = session.trust();
    let moved = session.was_set_on_stop().then_some("The mass was set on the stop");
    let offers_stop = session.working().is_some_and(|worked| worked >= OFFER_TO_STOP);
    let count = u8::from(trust.is_some()) + u8::from(moved.is_some()) + u8::from(offers_stop);
    let size = Vec2::new(BESIDE, LINE * f32::from(count.clamp(1, 2)));
    ui.allocate_ui_with_layout(size, egui::Layout::top_down(egui::Align::Max), |ui| {
        ui.set_min_width(BESIDE);
        (ui.spacing_mut().item_spacing.y, ui.spacing_mut().interact_size.y) = (0.0, LINE);
        let line = |ui: &mut Ui, text: &str| {
            ui.add(egui::Label::new(RichText::new(text).size(SMALL).color(style.faint())).extend())
        };
        stop_ui(ui, session);
        if let Some((short, long)) = trust {
            let meaning = meaning(&short).map_or_else(String::new, |meaning| format!("{meaning}\n\n"));
            line(ui, &short).on_hover_text(format!("{meaning}{long}"));
        }
        if let Some(moved) = moved.filter(|_| count < 3) {
            let hover = "A stop that was moved or switched on would have gone through it.";
            line(ui, moved).on_hover_text(hover);
        }
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
