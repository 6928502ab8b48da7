//! Strip of the open lesson: its step, what is asked, options, the state of a task, and the way on.

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{
    self, Align, Button, Color32, FontId, Id, Label, Layout, Popup, Pos2, RichText, Sense, SetOpenCommand,
    Stroke, TextEdit, Ui, UiBuilder, vec2,
};

use crate::app::session::Session;
use crate::app::session::lesson::{OpenLesson, Outcome, TaskState};
use crate::app::ui::style::{BODY, Style, strong_family};
use crate::app::words::announce::spoken_ui;
use crate::app::words::lesson::{expected, judged_by, not_yet, numbered, pieces, plain};
use crate::app::words::meanings::{meaning, terms};
use crate::scene::lesson::Step;

/// Text sizes in points: where there is room, and where there is little.
const LARGE: f32 = 16.0;

/// Room in points for the steps and the ways back and on, and height of these, with the way to
/// another lesson in the last step; size of the dot of a step, and their distance.
const WAYS: f32 = 158.0;
const WAY: f32 = 24.0;
const LAST_WAYS: f32 = 190.0;
const DOT: f32 = 4.5;
const APART: f32 = 15.0;

/// Most characters and width in points of the word that a student gives as a reason.
const MOST_LETTERS: usize = 60;
const REASON: f32 = 150.0;

/// Most width in points of what a word means.
const MEANING: f32 = 320.0;

/// The most options that stand side by side.
const SIDE_BY_SIDE: usize = 3;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LessonAct {
    Choose(usize),
    Back,
    Next,
    Hint,
    NextLesson(&'static str),
}

/// The letter of an option.
pub fn letter(option: usize) -> char {
    ('A'..='Z').nth(option).unwrap_or('?')
}

/// Draws it; what was asked for.
pub fn lesson_ui(
    ui: &mut Ui,
    lesson: &mut OpenLesson,
    session: &Session,
    style: &Style,
    compact: bool,
) -> Option<LessonAct> {
    let size = if compact { BODY } else { LARGE };
    let mut asked = None;
    ui.spacing_mut().item_spacing.y = 4.0;
    let text = spoken(lesson, session);
    spoken_ui(ui, Id::unique(("step of a lesson", lesson.number(), &text)), &text);
    ui.horizontal_top(|ui| {
        let ways = if lesson.is_last() { LAST_WAYS } else { WAYS };
        let width = (ui.available_width() - ways - 16.0).max(120.0);
        ui.allocate_ui_with_layout(vec2(width, 0.0), Layout::top_down(Align::Min), |ui| {
            ui.set_width(width);
            let step = lesson.step();
            text_ui(ui, style, heading(step), step.text(), size);
            asked = below_ui(ui, lesson, session, style, size);
        });
        ui.allocate_ui_with_layout(vec2(ways, 0.0), Layout::top_down(Align::Max), |ui| {
            dots_ui(ui, lesson, style);
            asked = asked.or(ways_ui(ui, lesson, ways));
        });
    });
    if lesson.is_covering() {
        asked = asked.or(options_ui(ui, lesson, size));
    }
    asked
}

/// What stands before the text of a step.
fn heading(step: &Step) -> &'static str {
    match step {
        Step::Say(_) => "",
        Step::Predict { .. } => "Predict: ",
        Step::Do { .. } => "Your task: ",
        Step::Explain(_) => "Why: ",
    }
}

/// What a screen reader says of the step, and once more of what became of it.
fn spoken(lesson: &OpenLesson, session: &Session) -> String {
    let (number, of) = (lesson.number() + 1, lesson.lesson().steps.len());
    let step = lesson.step();
    if matches!(step, Step::Predict { .. }) && !lesson.is_covering() {
        return verdict(lesson);
    }
    if matches!(step, Step::Do { .. }) && lesson.task(session) == TaskState::Met {
        return format!("Step {number} of {of}. Done.");
    }
    let options = lesson.options().iter().enumerate();
    let options: String = options.map(|(i, own)| format!(" {}: {}.", letter(i), own.text)).collect();
    let hint = lesson.hint().map_or_else(String::new, |hint| format!(" Hint: {}", plain(hint)));
    format!("Step {number} of {of}. {}{}{options}{hint}", heading(step), plain(step.text()))
}

/// What was expected, and what came of it.
fn verdict(lesson: &OpenLesson) -> String {
    let outcome = match lesson.outcome() {
        Outcome::Holds(option) => Some(lesson.options()[option].text.as_str()),
        Outcome::Unknown => lesson.answer().outcome.as_deref(),
        Outcome::Unclear => return "Not exactly one of the options holds: see for yourself.".to_owned(),
        Outcome::Unjudged(why) => return format!("It cannot be judged: {why}"),
    };
    expected(lesson.answer().choice.as_deref(), outcome)
}

/// A text with bold words; a word of the glossary has a line below it and says what it means.
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
        let byte = whole.char_indices().nth(letter).map_or(whole.len(), |own| own.0);
        let word = terms(&whole).into_iter().find(|own| own.0.contains(&byte)).map(|own| own.1)?;
        Some(format!("{word}: {}", meaning(word).unwrap_or_default()))
    };
    // a click shows it at once and leaves it there
    let clicked = response.interact_pointer_pos().filter(|_| response.clicked()).map(word_at);
    if let Some(Some(text)) = &clicked {
        ui.data_mut(|data| data.insert_temp(response.id, text.clone()));
    }
    let open = clicked.map(|word| SetOpenCommand::Bool(word.is_some()));
    let popup = Popup::from_response(&response).open_memory(open).at_pointer_fixed();
    popup.show(|ui| {
        ui.set_max_width(MEANING);
        ui.label(ui.data(|data| data.get_temp::<String>(response.id)).unwrap_or_default())
    });
    if let Some(text) = response.hover_pos().and_then(word_at) {
        response.on_hover_text_at_pointer(text);
    }
}

/// Below the text: what became of a prediction, or how far a task is.
fn below_ui(
    ui: &mut Ui,
    lesson: &mut OpenLesson,
    session: &Session,
    style: &Style,
    size: f32,
) -> Option<LessonAct> {
    let mut asked = None;
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
                        asked = Some(LessonAct::Hint);
                    }
                }
            });
            // where there is room, its place is kept free: nothing moves when it comes by itself
            let kept = lesson.offered_hint().filter(|_| size > BODY);
            if let Some(hint) = lesson.hint().or(kept) {
                let shown = UiBuilder::new();
                let shown = if lesson.hint().is_some() { shown } else { shown.invisible() };
                ui.scope_builder(shown, |ui| text_ui(ui, style, "Hint: ", hint, size));
            }
        }
    }
    asked
}

/// The reason of a student, in a word of their own.
fn reason_ui(ui: &mut Ui, lesson: &mut OpenLesson, style: &Style, size: f32) {
    let text = "Why, in one word?";
    let galley = ui.painter().layout_no_wrap(text.to_owned(), FontId::proportional(size), style.faint());
    // the field stands beside its name
    if galley.size().x + REASON + 3.0 * ui.spacing().item_spacing.x > ui.available_size_before_wrap().x {
        ui.end_row();
    }
    let name = ui.label(RichText::new(text).size(size).color(style.faint()));
    let word = lesson.why_mut();
    let field = TextEdit::singleline(word).desired_width(REASON).char_limit(MOST_LETTERS);
    ui.add(field.hint_text("if you like")).labelled_by(name.id);
}

/// The steps as dots: those that are behind filled, the present one larger with a ring.
fn dots_ui(ui: &mut Ui, lesson: &OpenLesson, style: &Style) {
    let count = lesson.lesson().steps.len();
    let apart = APART.min((WAYS - 2.0 * DOT) / count as f32);
    let (rect, response) = ui.allocate_exact_size(vec2(apart * count as f32, 18.0), Sense::hover());
    let name = format!("step {} of {count}", lesson.number() + 1);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, name.as_str()));
    for number in 0..count {
        let at = egui::pos2(rect.left() + (number as f32 + 0.5) * apart, rect.center().y);
        let is_behind = number < lesson.number() || number == lesson.number() && lesson.may_go_on();
        let fill = if is_behind && lesson.is_settled(number) { style.ink() } else { Color32::TRANSPARENT };
        ui.painter().circle(at, DOT.min(0.4 * apart), fill, Stroke::new(1.2, style.ink()));
        if number == lesson.number() {
            let ring = Stroke::new(2.0, style.base());
            ui.painter().circle_stroke(at, (DOT + 2.5).min(0.5 * apart), ring);
        }
    }
    response.on_hover_text(name);
}

fn ways_ui(ui: &mut Ui, lesson: &OpenLesson, width: f32) -> Option<LessonAct> {
    let mut asked = None;
    ui.allocate_ui_with_layout(vec2(width, WAY), Layout::right_to_left(Align::Center), |ui| {
        let following = lesson.following().filter(|_| lesson.is_last() && lesson.may_go_on());
        if let Some(name) = following
            && ui.button(numbered(name)).on_hover_text("The lesson that comes after this one").clicked()
        {
            asked = Some(LessonAct::NextLesson(name));
        }
        let name = if lesson.is_last() { "Finish" } else { "Next" };
        let open = match lesson.step() {
            Step::Predict { .. } => "First choose what you expect. A lecturer goes on with PageDown.",
            _ => "First the task. A lecturer goes on with PageDown.",
        };
        let next = ui.add_enabled(lesson.may_go_on(), Button::new(name)).on_disabled_hover_text(open);
        if next.on_hover_text("The next step (PageDown)").clicked() {
            asked = Some(LessonAct::Next);
        }
        let back = ui.add_enabled(lesson.number() > 0, Button::new("Back"));
        if back.on_hover_text("The step before (PageUp)").clicked() {
            asked = Some(LessonAct::Back);
        }
    });
    asked
}

/// The options, side by side and equally high.
fn options_ui(ui: &mut Ui, lesson: &OpenLesson, size: f32) -> Option<LessonAct> {
    let mut asked = None;
    let options = lesson.options();
    let rows = options.len().div_ceil(SIDE_BY_SIDE).max(1);
    let beside = options.len().div_ceil(rows);
    let (space, padding) = (ui.spacing().item_spacing.x, ui.spacing().button_padding);
    let width = (ui.available_width() - space * (beside as f32 - 1.0)) / beside as f32;
    let texts: Vec<String> =
        options.iter().enumerate().map(|(i, own)| format!("{}   {}", letter(i), plain(&own.text))).collect();
    let font = FontId::proportional(size);
    let height = |text: &String| {
        let room = width - 2.0 * padding.x;
        ui.painter().layout(text.clone(), font.clone(), Color32::PLACEHOLDER, room).size().y
    };
    let high = texts.iter().map(height).fold(0.0, f32::max) + 2.0 * padding.y + 4.0;
    for (row, texts) in texts.chunks(beside.max(1)).enumerate() {
        ui.horizontal(|ui| {
            for (i, text) in texts.iter().enumerate() {
                let option = row * beside + i;
                let text = RichText::new(text).font(font.clone());
                let button = ui.add_sized([width, high], Button::new(text).wrap());
                let hover = format!("Choose this: nothing is scored (key {})", letter(option));
                if button.on_hover_text(hover).clicked() {
                    asked = Some(LessonAct::Choose(option));
                }
            }
        });
    }
    asked
}
