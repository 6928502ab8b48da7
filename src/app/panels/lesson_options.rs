//! The options of a prediction, with the votes for them.

use std::sync::Arc;

use eframe::egui::{self, Align2, Button, Color32, FontId, Galley, Sense, Stroke, Ui, Vec2, pos2, vec2};

use crate::app::session::lesson::{MOST_VOTES, OpenLesson, Outcome};
use crate::app::ui::style::{BODY, CONTROL, Style, strong_family};
use crate::app::ui::widgets::{primary, tell};
use crate::app::words::lesson::{letter, plain};
use crate::app::words::numbers::unbroken;
use crate::scene::lesson::Choice;

use super::lesson::LessonAction;

/// Distance in points between the letter of an option and its text, from left to left.
const INDENT: f32 = 22.0;

/// Height in points of a bar of votes.
const BAR: f32 = 3.0;

/// A button for each option of a prediction, with the votes for it.
pub fn votes_ui(ui: &mut Ui, lesson: &OpenLesson) -> Option<LessonAction> {
    let mut action = None;
    for option in 0..lesson.options().len() {
        let (letter, votes) = (letter(option), lesson.answer().votes.get(option).unwrap_or(&0));
        let hover = format!("One more vote for {letter} (Shift+{letter}). Right button: one less.");
        let button = ui.button(format!("{letter} {votes}")).on_hover_text(hover);
        let more = i32::from(button.clicked()) - i32::from(button.secondary_clicked());
        action = action.or((more != 0).then_some(LessonAction::Vote(option, more)));
    }
    action
}

/// All options in one text, with their votes.
pub(super) fn options_text(options: &[Choice], votes: &[u32]) -> String {
    let each = options.iter().enumerate().map(|(option, choice)| {
        let votes = votes_text(*votes.get(option).unwrap_or(&0));
        let votes = if votes.is_empty() { votes } else { format!(" ({votes})") };
        // each in one line
        format!("**{}** {}{votes}", letter(option), choice.text).replace(' ', "\u{a0}")
    });
    each.collect::<Vec<_>>().join("     ")
}

/// The votes for an option in words, if there are any.
fn votes_text(votes: u32) -> String {
    match votes {
        0 => String::new(),
        1 => "1\u{a0}vote".to_owned(),
        votes => format!("{votes}\u{a0}votes"),
    }
}

/// The letter and the text of an option, with room for its votes in a button as wide as this.
fn parts_of(ui: &Ui, (option, choice): (usize, &Choice), width: f32, ink: Color32) -> [Arc<Galley>; 2] {
    let font = || FontId::proportional(BODY);
    let votes = ui.painter().layout_no_wrap(MOST_VOTES.to_string(), font(), ink).size().x;
    let room = width - 2.0 * ui.spacing().button_padding.x - INDENT - votes - ui.spacing().item_spacing.x;
    let letter = ui.painter().layout_no_wrap(letter(option).to_string(), font(), ink);
    [letter, ui.painter().layout(unbroken(&plain(&choice.text)), font(), ink, room)]
}

/// Width and height in points of an option.
fn size_of(ui: &Ui, option: (usize, &Choice)) -> Vec2 {
    let width = ui.available_width();
    let height = parts_of(ui, option, width, Color32::PLACEHOLDER)[1].size().y;
    vec2(width, (height + 2.0 * ui.spacing().button_padding.y + 4.0).max(CONTROL))
}

/// The options of a prediction, one below another. Once the answer is shown, the one that holds is filled,
/// and a ring marks another one that was chosen.
pub(super) fn options_ui(ui: &mut Ui, lesson: &OpenLesson, style: &Style) -> Option<LessonAction> {
    let mut action = None;
    for (option, choice) in lesson.options().iter().enumerate() {
        let each = size_of(ui, (option, choice));
        let count = *lesson.answer().votes.get(option).unwrap_or(&0);
        let votes = votes_text(count);
        let letter = letter(option);
        let text = format!("{letter}   {}", plain(&choice.text));
        let spoken = if votes.is_empty() { text } else { format!("{text}, {votes}") };
        let holds = !lesson.is_covering() && lesson.outcome() == Outcome::Holds(option);
        let is_chosen = lesson.answer().choice.as_ref() == Some(&choice.text);
        let mut button = if holds { primary(ui, "") } else { Button::new("") };
        if !lesson.is_covering() {
            button = button.sense(Sense::hover());
            if is_chosen && !holds {
                button = button.stroke(Stroke::new(2.0, style.accent()));
            }
        }
        let button = ui.add_sized(each, button);
        let ink = if holds { style.on_action() } else { style.ink() };
        let [left, right] = parts_of(ui, (option, choice), each.x, ink);
        let inside = button.rect.shrink2(ui.spacing().button_padding);
        let top = inside.center().y - 0.5 * right.size().y;
        ui.painter().galley(pos2(inside.left(), top), left, ink);
        ui.painter().galley(pos2(inside.left() + INDENT, top), right, ink);
        // counted in secret, so that no vote follows the others
        if count > 0 && !lesson.is_covering() {
            let font = FontId::new(BODY, strong_family());
            ui.painter().text(inside.right_center(), Align2::RIGHT_CENTER, count, font, ink);
            let share = count as f32 / lesson.votes() as f32;
            let bottom = button.rect.bottom() - 2.0;
            let bar = inside.with_min_y(bottom - BAR).with_max_y(bottom);
            let bar = bar.with_max_x(bar.left() + share * bar.width());
            ui.painter().rect_filled(bar, 0.5 * BAR, if holds { ink } else { style.accent() });
        }
        if !lesson.is_covering() {
            tell(&button, egui::Role::Label, &spoken);
            continue;
        }
        let hover = format!(
            "Choose this: nothing is scored (key {letter}). Right button or Shift+{letter}: count a \
             vote."
        );
        let button = button.on_hover_text(hover);
        tell(&button, egui::Role::Button, &spoken);
        if button.clicked() {
            action = Some(LessonAction::Choose(option));
        } else if button.secondary_clicked() {
            action = Some(LessonAction::Vote(option, 1));
        }
    }
    action
}
