//! Strip of the open lesson: its step, the options of a prediction, the state of a task, navigation.

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{
    self, Align, Button, Color32, FontId, Id, Label, Layout, Popup, Pos2, RichText, Sense, SetOpenCommand,
    Stroke, TextEdit, Ui, UiBuilder, vec2,
};

use crate::app::session::Session;
use crate::app::session::lesson::{OpenLesson, Outcome, TaskState};
use crate::app::ui::style::{BODY, Style, strong_family};
use crate::app::words::lesson::{expected, judged_by, not_yet, numbered, pieces, plain};
use crate::app::words::meanings::{meaning, terms};
use crate::scene::lesson::Step;

use super::status_line::spoken_ui;

/// Text size in points, unless the window is compact.
const LARGE: f32 = 16.0;
/// Width in points of the column with the dots of the steps and the navigation buttons.
const NAVIGATION: f32 = 158.0;
/// Width in points of that column in the last step, where it also leads to the next lesson.
const LAST_NAVIGATION: f32 = 190.0;
const BUTTON_HEIGHT: f32 = 24.0;
const DOT: f32 = 4.5;
const DOT_SPACING: f32 = 15.0;
/// Greatest number of characters of the reason that a student gives.
const MAX_REASON: usize = 60;
const REASON: f32 = 150.0;
const MEANING: f32 = 320.0;
/// Greatest number of options side by side.
const SIDE_BY_SIDE: usize = 3;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LessonAction {
    Choose(usize),
    Back,
    Next,
    Hint,
    NextLesson(&'static str),
}

pub fn letter(option: usize) -> char {
    ('A'..='Z').nth(option).unwrap_or('?')
}

/// Draws the strip. Returns the action that was chosen.
pub fn lesson_ui(
    ui: &mut Ui,
    lesson: &mut OpenLesson,
    session: &Session,
    style: &Style,
    compact: bool,
) -> Option<LessonAction> {
    let size = if compact { BODY } else { LARGE };
    let mut action = None;
    ui.spacing_mut().item_spacing.y = 4.0;
    let text = spoken(lesson, session);
    spoken_ui(ui, Id::unique(("step of a lesson", lesson.number(), &text)), &text);
    ui.horizontal_top(|ui| {
        let navigation = if lesson.is_last() { LAST_NAVIGATION } else { NAVIGATION };
        let width = (ui.available_width() - navigation - 16.0).max(120.0);
        ui.allocate_ui_with_layout(vec2(width, 0.0), Layout::top_down(Align::Min), |ui| {
            ui.set_width(width);
            let step = lesson.step();
            text_ui(ui, style, heading(step), step.text(), size);
            action = below_ui(ui, lesson, session, style, size);
        });
        ui.allocate_ui_with_layout(vec2(navigation, 0.0), Layout::top_down(Align::Max), |ui| {
            dots_ui(ui, lesson, style);
            action = action.or(navigation_ui(ui, lesson, navigation));
        });
    });
    if lesson.is_covering() {
        action = action.or(options_ui(ui, lesson, size));
    }
    action
}

fn heading(step: &Step) -> &'static str {
    match step {
        Step::Say(_) => "",
        Step::Predict { .. } => "Predict: ",
        Step::Do { .. } => "Your task: ",
        Step::Explain(_) => "Why: ",
    }
}

/// The text for a screen reader: the step, or its result once it has been answered or done.
fn spoken(lesson: &OpenLesson, session: &Session) -> String {
    let (number, count) = (lesson.number() + 1, lesson.lesson().steps.len());
    let step = lesson.step();
    if matches!(step, Step::Predict { .. }) && !lesson.is_covering() {
        return verdict(lesson);
    }
    if matches!(step, Step::Do { .. }) && lesson.task(session) == TaskState::Met {
        return format!("Step {number} of {count}. Done.");
    }
    let options = lesson.options().iter().enumerate();
    let options: String = options.map(|(i, option)| format!(" {}: {}.", letter(i), option.text)).collect();
    let hint = lesson.hint().map_or_else(String::new, |hint| format!(" Hint: {}", plain(hint)));
    format!("Step {number} of {count}. {}{}{options}{hint}", heading(step), plain(step.text()))
}

fn verdict(lesson: &OpenLesson) -> String {
    let outcome = match lesson.outcome() {
        Outcome::Holds(option) => Some(lesson.options()[option].text.as_str()),
        Outcome::Unknown => lesson.answer().outcome.as_deref(),
        Outcome::Unclear => return "Not exactly one of the options holds: see for yourself.".to_owned(),
        Outcome::Unjudged(why) => return format!("It cannot be judged: {why}"),
    };
    expected(lesson.answer().choice.as_deref(), outcome)
}

/// A text with bold words. Terms of the glossary are underlined; hovering or a click shows their meaning.
fn text_ui(ui: &mut Ui, style: &Style, heading: &str, text: &str, size: f32) {
    let mut job = LayoutJob::default();
    let strong = FontId::new(size, strong_family());
    let format = |font: &FontId, color: Color32, underline: Stroke| TextFormat {
        font_id: font.clone(),
        color,
        underline,
        ..TextFormat::default()
    };
    job.append(heading, 0.0, format(&strong, style.base(), Stroke::NONE));
    let (regular, line) = (FontId::proportional(size), Stroke::new(1.0, style.faint()));
    for piece in pieces(text) {
        let font = if piece.bold { &strong } else { &regular };
        let mut from = 0;
        for (range, _) in terms(piece.text) {
            job.append(&piece.text[from..range.start], 0.0, format(font, style.ink(), Stroke::NONE));
            job.append(&piece.text[range.clone()], 0.0, format(font, style.ink(), line));
            from = range.end;
        }
        job.append(&piece.text[from..], 0.0, format(font, style.ink(), Stroke::NONE));
    }
    let whole = job.text.clone();
    let (at, galley, response) =
        Label::new(job).wrap().selectable(false).sense(Sense::CLICK).layout_in_ui(ui);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, whole.as_str()));
    ui.painter().galley(at, galley.clone(), style.ink());
    let word_at = |pointer: Pos2| {
        let letter = galley.cursor_from_pos(pointer - at).index.0;
        let byte = whole.char_indices().nth(letter).map_or(whole.len(), |indexed| indexed.0);
        let word = terms(&whole).into_iter().find(|term| term.0.contains(&byte)).map(|term| term.1)?;
        Some(format!("{word}: {}", meaning(word).unwrap_or_default()))
    };
    // a click shows the meaning at once and keeps it open
    let clicked = response.interact_pointer_pos().filter(|_| response.clicked());
    let word = clicked.and_then(word_at);
    let open = clicked.map(|_| SetOpenCommand::Bool(word.is_some()));
    if let Some(text) = word {
        ui.data_mut(|data| data.insert_temp(response.id, text));
    }
    let popup = Popup::from_response(&response).open_memory(open).at_pointer_fixed();
    popup.show(|ui| {
        ui.set_max_width(MEANING);
        ui.label(ui.data(|data| data.get_temp::<String>(response.id)).unwrap_or_default())
    });
    if let Some(text) = response.hover_pos().and_then(word_at) {
        response.on_hover_text_at_pointer(text);
    }
}

/// Below the text: the outcome of a prediction, or the state of a task.
fn below_ui(
    ui: &mut Ui,
    lesson: &mut OpenLesson,
    session: &Session,
    style: &Style,
    size: f32,
) -> Option<LessonAction> {
    let mut action = None;
    match lesson.step() {
        Step::Say(_) | Step::Explain(_) => {}
        Step::Predict { .. } if lesson.is_covering() => {}
        Step::Predict { .. } => {
            ui.horizontal_wrapped(|ui| {
                ui.label(RichText::new(verdict(lesson)).size(size).font(FontId::new(size, strong_family())));
                if lesson.answer().choice.is_some() {
                    reason_ui(ui, lesson, style, size);
                }
            });
        }
        Step::Do { .. } => {
            let (state, color) = match lesson.task(session) {
                TaskState::Met => ("Done.".to_owned(), style.base()),
                TaskState::Unjudged(why) => (format!("It cannot be judged: {why}"), style.ink()),
                state => {
                    let word = match state {
                        TaskState::Moving => "Will be judged once you let go.".to_owned(),
                        TaskState::NotYet(lack) => not_yet(&lack),
                        _ => "Being judged ...".to_owned(),
                    };
                    let how = judged_by(lesson.lesson(), session.scene().start);
                    (format!("{word} {how}"), style.faint())
                }
            };
            ui.horizontal_wrapped(|ui| {
                ui.label(RichText::new(state).size(size).color(color));
                if lesson.offered_hint().is_some() && lesson.hint().is_none() {
                    let hover = "It comes by itself after 45 s (H)";
                    if ui.small_button("Hint (H)").on_hover_text(hover).clicked() {
                        action = Some(LessonAction::Hint);
                    }
                }
            });
            // space is reserved for the hint if there is room: nothing moves when it appears by itself
            let reserved = lesson.offered_hint().filter(|_| size > BODY);
            if let Some(hint) = lesson.hint().or(reserved) {
                let builder = UiBuilder::new();
                let builder = if lesson.hint().is_some() { builder } else { builder.invisible() };
                ui.scope_builder(builder, |ui| text_ui(ui, style, "Hint: ", hint, size));
            }
        }
    }
    action
}

fn reason_ui(ui: &mut Ui, lesson: &mut OpenLesson, style: &Style, size: f32) {
    let text = "Why, in one word?";
    let galley = ui.painter().layout_no_wrap(text.to_owned(), FontId::proportional(size), style.faint());
    // the field stays in one row with its label
    if galley.size().x + REASON + 3.0 * ui.spacing().item_spacing.x > ui.available_size_before_wrap().x {
        ui.end_row();
    }
    let name = ui.label(RichText::new(text).size(size).color(style.faint()));
    let word = lesson.why_mut();
    let field = TextEdit::singleline(word).desired_width(REASON).char_limit(MAX_REASON);
    ui.add(field.hint_text("if you like")).labelled_by(name.id);
}

/// The steps as dots: filled once they are settled and behind, with a ring around the present one.
fn dots_ui(ui: &mut Ui, lesson: &OpenLesson, style: &Style) {
    let count = lesson.lesson().steps.len();
    let spacing = DOT_SPACING.min((NAVIGATION - 2.0 * DOT) / count as f32);
    let (rect, response) = ui.allocate_exact_size(vec2(spacing * count as f32, 18.0), Sense::hover());
    let name = format!("step {} of {count}", lesson.number() + 1);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, name.as_str()));
    for number in 0..count {
        let at = egui::pos2(rect.left() + (number as f32 + 0.5) * spacing, rect.center().y);
        let is_behind = number < lesson.number() || number == lesson.number() && lesson.may_go_on();
        let fill = if is_behind && lesson.is_settled(number) { style.ink() } else { Color32::TRANSPARENT };
        ui.painter().circle(at, DOT.min(0.4 * spacing), fill, Stroke::new(1.2, style.ink()));
        if number == lesson.number() {
            let ring = Stroke::new(2.0, style.base());
            ui.painter().circle_stroke(at, (DOT + 2.5).min(0.5 * spacing), ring);
        }
    }
    response.on_hover_text(name);
}

fn navigation_ui(ui: &mut Ui, lesson: &OpenLesson, width: f32) -> Option<LessonAction> {
    let mut action = None;
    ui.allocate_ui_with_layout(vec2(width, BUTTON_HEIGHT), Layout::right_to_left(Align::Center), |ui| {
        let next_lesson = lesson.following().filter(|_| lesson.is_last() && lesson.may_go_on());
        if let Some(name) = next_lesson
            && ui.button(numbered(name)).on_hover_text("The lesson that comes after this one").clicked()
        {
            action = Some(LessonAction::NextLesson(name));
        }
        let name = if lesson.is_last() { "Finish" } else { "Next" };
        let condition = match lesson.step() {
            Step::Predict { .. } => "First choose what you expect. A lecturer goes on with PageDown.",
            _ => "First the task. A lecturer goes on with PageDown.",
        };
        let next = ui.add_enabled(lesson.may_go_on(), Button::new(name)).on_disabled_hover_text(condition);
        if next.on_hover_text("The next step (PageDown)").clicked() {
            action = Some(LessonAction::Next);
        }
        let back = ui.add_enabled(lesson.number() > 0, Button::new("Back"));
        if back.on_hover_text("The step before (PageUp)").clicked() {
            action = Some(LessonAction::Back);
        }
    });
    action
}

/// The options side by side, all of one height.
fn options_ui(ui: &mut Ui, lesson: &OpenLesson, size: f32) -> Option<LessonAction> {
    let mut action = None;
    let options = lesson.options();
    let rows = options.len().div_ceil(SIDE_BY_SIDE).max(1);
    let columns = options.len().div_ceil(rows);
    let (space, padding) = (ui.spacing().item_spacing.x, ui.spacing().button_padding);
    let width = (ui.available_width() - space * (columns as f32 - 1.0)) / columns as f32;
    let texts: Vec<String> = options
        .iter()
        .enumerate()
        .map(|(i, option)| format!("{}   {}", letter(i), plain(&option.text)))
        .collect();
    let font = FontId::proportional(size);
    let height = |text: &String| {
        let room = width - 2.0 * padding.x;
        ui.painter().layout(text.clone(), font.clone(), Color32::PLACEHOLDER, room).size().y
    };
    let tallest = texts.iter().map(height).fold(0.0, f32::max) + 2.0 * padding.y + 4.0;
    for (row, texts) in texts.chunks(columns.max(1)).enumerate() {
        ui.horizontal(|ui| {
            for (i, text) in texts.iter().enumerate() {
                let option = row * columns + i;
                let text = RichText::new(text).font(font.clone());
                let button = ui.add_sized([width, tallest], Button::new(text).wrap());
                let hover = format!("Choose this: nothing is scored (key {})", letter(option));
                if button.on_hover_text(hover).clicked() {
                    action = Some(LessonAction::Choose(option));
                }
            }
        });
    }
    action
}
