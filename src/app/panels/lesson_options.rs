//! The options of a prediction, with the votes for them.

use eframe::egui::{self, Button, Color32, FontId, Sense, Stroke, Ui, Vec2, vec2};

use crate::app::session::lesson::{MOST_VOTES, OpenLesson, Outcome};
use crate::app::ui::style::{BODY, Style};
use crate::app::ui::widgets::{primary, tell};
use crate::app::words::lesson::{letter, plain};
use crate::scene::lesson::Choice;

use super::lesson::LessonAction;

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

/// An option with its letter.
fn option_text(option: usize, choice: &Choice) -> String {
    format!("{}   {}", letter(option), plain(&choice.text))
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

/// The votes for an option, if there are any.
fn votes_text(votes: u32) -> String {
    match votes {
        0 => String::new(),
        1 => "1\u{a0}vote".to_owned(),
        votes => format!("{votes}\u{a0}votes"),
    }
}

/// Width and height in points of each of these options with as many votes, `columns` of them side by side.
fn size_of(ui: &Ui, options: &[(usize, &Choice)], columns: usize, votes: u32) -> Vec2 {
    let columns = columns as f32;
    let (space, padding) = (ui.spacing().item_spacing.x, ui.spacing().button_padding);
    let width = (ui.available_width() - space * (columns - 1.0)) / columns;
    let font = || FontId::proportional(BODY);
    let votes = ui.painter().layout_no_wrap(votes_text(votes), font(), Color32::PLACEHOLDER).size().x;
    let beside = if votes > 0.0 { votes + 2.0 * space } else { 0.0 };
    let room = width - 2.0 * padding.x - beside;
    let height = |(option, choice): &(usize, &Choice)| {
        let text = option_text(*option, choice);
        ui.painter().layout(text, font(), Color32::PLACEHOLDER, room).size().y
    };
    let tallest = options.iter().map(height).fold(0.0, f32::max);
    vec2(width, tallest + 2.0 * padding.y + 4.0)
}

/// Width and height in points of each option, with at most `most` side by side and any number of votes.
pub(super) fn option_size(ui: &Ui, options: &[Choice], most: usize) -> Vec2 {
    let all: Vec<_> = options.iter().enumerate().collect();
    size_of(ui, &all, columns_of(options.len(), most), MOST_VOTES)
}

/// Number of options side by side of `count`, at most `most`, in rows that are equally full.
fn columns_of(count: usize, most: usize) -> usize {
    count.div_ceil(count.div_ceil(most).max(1)).max(1)
}

/// The options of a prediction, at most `most` side by side, all of one height, or in a column each as high as
/// its text. Once the answer is shown, the one that holds is filled, and a ring marks another one that was
/// chosen.
pub(super) fn options_ui(
    ui: &mut Ui,
    lesson: &OpenLesson,
    style: &Style,
    most: usize,
) -> Option<LessonAction> {
    let options = lesson.options();
    if options.is_empty() {
        return None;
    }
    let mut action = None;
    let columns = columns_of(options.len(), most);
    for (row, choices) in options.chunks(columns).enumerate() {
        let votes = |option: usize| *lesson.answer().votes.get(option).unwrap_or(&0);
        let each = match choices {
            [choice] if columns == 1 => size_of(ui, &[(row, choice)], 1, votes(row)),
            _ => option_size(ui, options, most),
        };
        ui.horizontal(|ui| {
            for (i, choice) in choices.iter().enumerate() {
                let option = row * columns + i;
                let (text, votes) = (option_text(option, choice), votes_text(votes(option)));
                let spoken = if votes.is_empty() { text.clone() } else { format!("{text}, {votes}") };
                if !lesson.is_covering() {
                    let button = match lesson.outcome() == Outcome::Holds(option) {
                        true => primary(ui, &text),
                        false if lesson.answer().choice.as_ref() == Some(&choice.text) => {
                            Button::new(text).stroke(Stroke::new(2.0, style.accent()))
                        }
                        false => Button::new(text),
                    };
                    let shown = ui.add_sized(each, button.right_text(votes).wrap().sense(Sense::hover()));
                    tell(&shown, egui::Role::Label, &spoken);
                    continue;
                }
                let button = ui.add_sized(each, Button::new(text).right_text(votes).wrap());
                let letter = letter(option);
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
        });
    }
    action
}
