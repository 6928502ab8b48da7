//! Column of the open lesson: its step, options of a prediction, the state of a task, navigation.

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{
    self, Align, Button, Color32, FontId, Id, Label, Layout, Popup, Pos2, Rect, Response, RichText, Sense,
    SetOpenCommand, Stroke, Ui, vec2,
};

use crate::app::session::Session;
use crate::app::session::lesson::{MOST_VOTES, OpenLesson, Outcome, TaskState};
use crate::app::ui::style::{BODY, CONTROL, Style, strong_family};
use crate::app::ui::widgets::{primary, tell};
use crate::app::words::lesson::{expected, judged_by, letter, not_yet, numbered, pieces, plain};
use crate::app::words::meanings::{meaning, terms};
use crate::app::words::numbers::unbroken;
use crate::scene::lesson::{Choice, Condition, Step};

use super::controls;
use super::lesson_options::{options_text, options_ui};
use super::status_line::spoken_ui;

/// Greatest width in points of the dots of the steps.
const NAVIGATION: f32 = 190.0;
const SPACE: f32 = 4.0;
const HINT: &str = "Hint: ";
/// The longest result of a prediction that is judged, in a column and in a strip.
const LONGEST_RESULT: &str = "Answer: B. You chose C.\n";
const SHORT_RESULT: &str = "Answer: B. ";
const DOT: f32 = 4.5;
const DOT_SPACING: f32 = 15.0;
const LEAST_SPACING: f32 = 9.0;
const MEANING: f32 = 320.0;
/// Space in points between the parts of a column.
const COLUMN_SPACE: f32 = 8.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LessonAction {
    Choose(usize),
    Back,
    Next,
    /// Go on although the task is not done.
    Skip,
    /// Show the answer of a prediction without a choice.
    Reveal,
    Finish,
    Hint,
    /// More or fewer votes for an option.
    Vote(usize, i32),
    NextLesson(&'static str),
}

/// Draws the column: the dots of the steps and the buttons, which stay where they are, and
/// below them the text, the options one below another, the reply to a choice, the controls and the state of a
/// task. If `urged`, the button that continues gets the keyboard focus. Returns the chosen action and the
/// rectangle of each control.
pub fn lesson_column_ui(
    ui: &mut Ui,
    lesson: &mut OpenLesson,
    session: &mut Session,
    style: &Style,
    urged: bool,
) -> (Option<LessonAction>, Vec<(String, Rect)>) {
    speak_ui(ui, lesson, session);
    let row = vec2(ui.available_width(), CONTROL);
    let buttons = ui.allocate_ui_with_layout(row, Layout::right_to_left(Align::Center), |ui| {
        let action = buttons_ui(ui, lesson, urged);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| dots_ui(ui, lesson, style));
        action
    });
    ui.add_space(COLUMN_SPACE);
    let below = egui::ScrollArea::vertical().id_salt(lesson.number()).auto_shrink(false).show(ui, |ui| {
        let usual = ui.spacing().item_spacing.y;
        ui.spacing_mut().item_spacing.y = COLUMN_SPACE;
        let width = ui.available_width();
        ui.scope(|ui| {
            if let Step::Predict { ask, .. } = lesson.step() {
                // the options stay where they are when the result comes
                ui.set_min_height(height_of_text(ui, style, (LONGEST_RESULT, ask), width));
            }
            step_ui(ui, lesson, style, true);
        });
        let mut action = options_ui(ui, lesson, style);
        if lesson.is_covering() {
            action = action.or(reveal_ui(ui, urged));
        }
        if let Some((option, reply)) = lesson.reply() {
            text_ui(ui, style, &format!("{}: ", letter(option)), reply);
        }
        ui.spacing_mut().item_spacing.y = usual;
        ui.add_space(COLUMN_SPACE);
        let enabled = ui.scope(|ui| {
            // the question is about what they change
            if lesson.is_covering() {
                ui.set_invisible();
            }
            controls::named_ui(ui, session, &lesson.lesson().controls)
        });
        ui.add_space(COLUMN_SPACE);
        ui.spacing_mut().item_spacing.y = COLUMN_SPACE;
        (action.or(task_ui(ui, lesson, session, style)), enabled.inner)
    });
    let (action, places) = below.inner;
    (buttons.inner.or(action), places)
}

/// A button that shows the answer of a prediction without a choice.
fn reveal_ui(ui: &mut Ui, urged: bool) -> Option<LessonAction> {
    let reveal = ui.button("Reveal").on_hover_text("Shows what it does, without a choice");
    urge(&reveal, urged);
    reveal.clicked().then_some(LessonAction::Reveal)
}

/// Draws the step in words, as high in every step, above a view that has the whole window: its text, and the
/// options of a prediction with their votes.
pub fn lesson_words_ui(ui: &mut Ui, lesson: &OpenLesson, session: &Session, style: &Style) {
    ui.spacing_mut().item_spacing.y = SPACE;
    speak_ui(ui, lesson, session);
    let width = ui.available_width();
    let height = |step: &Step| {
        let (result, options): (&str, &[Choice]) = match step {
            Step::Predict { options, .. } => (SHORT_RESULT, options),
            step => (heading(step), &[]),
        };
        let text = height_of_text(ui, style, (result, step.text()), width);
        let most = vec![MOST_VOTES; options.len()];
        let below = SPACE + height_of_text(ui, style, ("", &options_text(options, &most)), width);
        if options.is_empty() { text } else { text + below }
    };
    ui.set_min_height(lesson.lesson().steps.iter().map(height).fold(0.0, f32::max));
    step_ui(ui, lesson, style, false);
    if !lesson.options().is_empty() {
        let votes: &[u32] = if lesson.is_covering() { &[] } else { &lesson.answer().votes };
        text_ui(ui, style, "", &options_text(lesson.options(), votes));
    }
}

/// Gives the step to screen readers.
fn speak_ui(ui: &mut Ui, lesson: &OpenLesson, session: &Session) {
    let text = spoken(lesson, session);
    spoken_ui(ui, Id::unique(("step of a lesson", lesson.number(), &text)), &text);
}

/// Draws the text of the step after its heading, which is the result of a prediction once that is shown.
fn step_ui(ui: &mut Ui, lesson: &OpenLesson, style: &Style, is_column: bool) {
    let step = lesson.step();
    let is_shown = matches!(step, Step::Predict { .. }) && !lesson.is_covering();
    let space = if is_column { "\n" } else { " " };
    let result = is_shown.then(|| short_verdict(lesson, is_column) + space);
    text_ui(ui, style, &result.unwrap_or_else(|| heading(step).to_owned()), step.text());
}

/// Height in points of a text after a heading.
fn height_of_text(ui: &Ui, style: &Style, (heading, text): (&str, &str), width: f32) -> f32 {
    let mut job = job(style, heading, text);
    job.wrap.max_width = width;
    ui.painter().layout_job(job).size().y
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

/// The result of a prediction above its options, which stay and have their letters. A ring marks the one
/// that was chosen; words say it too if there `is_room`.
fn short_verdict(lesson: &OpenLesson, is_room: bool) -> String {
    match lesson.outcome() {
        Outcome::Holds(option) if lesson.answer().choice.as_ref() == Some(&lesson.options()[option].text) => {
            "That holds.".to_owned()
        }
        Outcome::Holds(option) if !is_room => format!("Answer: {}.", letter(option)),
        Outcome::Holds(option) => {
            let is_chosen = |choice: &&Choice| lesson.answer().choice.as_ref() == Some(&choice.text);
            let chosen = lesson.options().iter().position(|choice| is_chosen(&choice));
            let chosen = chosen.map_or_else(String::new, |place| format!(" You chose {}.", letter(place)));
            format!("Answer: {}.{chosen}", letter(option))
        }
        Outcome::Unknown => "Watch what it does.".to_owned(),
        Outcome::Unclear | Outcome::Unjudged(_) => verdict(lesson),
    }
}

/// The result of a prediction with the texts of its options.
fn verdict(lesson: &OpenLesson) -> String {
    let outcome = match lesson.outcome() {
        Outcome::Holds(option) if lesson.answer().choice.is_none() => {
            let text = plain(lesson.options()[option].text.trim_end_matches('.'));
            return format!("What holds: {}, “{text}”.", letter(option));
        }
        Outcome::Holds(option) => Some(lesson.options()[option].text.as_str()),
        Outcome::Unknown => lesson.answer().outcome.as_deref(),
        Outcome::Unclear => return "Not exactly one of the options holds: see for yourself.".to_owned(),
        Outcome::Unjudged(why) => return format!("It cannot be judged: {why}"),
    };
    expected(lesson.answer().choice.as_deref(), outcome)
}

/// A text with bold words, and terms of the glossary underlined.
fn job(style: &Style, heading: &str, text: &str) -> LayoutJob {
    let mut job = LayoutJob::default();
    let strong = FontId::new(BODY, strong_family());
    job.append(heading, 0.0, TextFormat::simple(strong.clone(), style.accent()));
    for piece in pieces(text) {
        let font = if piece.bold { strong.clone() } else { style.body() };
        let plain = TextFormat::simple(font, style.ink());
        let underlined = TextFormat { underline: Stroke::new(1.0, style.faint()), ..plain.clone() };
        let mut from = 0;
        for (range, _) in terms(piece.text) {
            job.append(&unbroken(&piece.text[from..range.start]), 0.0, plain.clone());
            job.append(&piece.text[range.clone()], 0.0, underlined.clone());
            from = range.end;
        }
        job.append(&unbroken(&piece.text[from..]), 0.0, plain);
    }
    job
}

/// Draws a text; hovering or a click on a term of the glossary shows its meaning.
fn text_ui(ui: &mut Ui, style: &Style, heading: &str, text: &str) {
    let job = job(style, heading, text);
    let whole = job.text.clone();
    let (at, galley, response) =
        Label::new(job).wrap().selectable(false).sense(Sense::CLICK).layout_in_ui(ui);
    tell(&response, egui::Role::Label, &whole.replace('\u{a0}', " "));
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

/// Draws the state of a task and its hint.
fn task_ui(ui: &mut Ui, lesson: &OpenLesson, session: &Session, style: &Style) -> Option<LessonAction> {
    let Step::Do { .. } = lesson.step() else { return None };
    let mut action = None;
    let starts = lesson.step().conditions().into_iter().flat_map(Condition::all_starts).count();
    let how = judged_by(lesson.lesson(), session.scene().start, starts, session.is_continued);
    let task = lesson.task(session);
    let is_met = matches!(task, TaskState::Met);
    let (state, color) = match task {
        TaskState::Met if lesson.was_changed_since(session) => {
            ("Done, before your last changes.".to_owned(), style.accent())
        }
        TaskState::Met => ("Done.".to_owned(), style.accent()),
        TaskState::Unjudged(why) => (format!("It cannot be judged: {why}"), style.ink()),
        TaskState::Moving => ("Will be judged once you let go.".to_owned(), style.faint()),
        TaskState::NotYet(lack) => (unbroken(&not_yet(&lack, is_on_stops(session))), style.ink()),
        TaskState::Judging => ("Being judged.".to_owned(), style.faint()),
    };
    let state = RichText::new(state).color(color);
    let state = ui.label(if is_met { state.heading() } else { state });
    if is_met {
        ui.label(RichText::new(how).color(style.faint()));
    } else {
        state.on_hover_text(how);
    }
    if lesson.offered_hint().is_some() && lesson.hint().is_none() {
        let (name, hover) = match lesson.offers_hint() {
            true => ("Would a hint help? (H)", "Shows the hint"),
            false => ("Hint (H)", "Shows the hint"),
        };
        let button = ui.add(Button::new(name).selected(lesson.offers_hint()));
        action = button.on_hover_text(hover).clicked().then_some(LessonAction::Hint);
    }
    if let Some(hint) = lesson.hint() {
        text_ui(ui, style, HINT, hint);
    }
    action
}

/// Whether stops hold the mass away from the bottoms of the wells, so that it can hop on one.
fn is_on_stops(session: &Session) -> bool {
    let model = session.model();
    let well = model.mechanism().landscape.right_stable().map(|well| well.x);
    well.zip(model.stop_positions().1).is_some_and(|(well, stop)| stop < well)
}

/// The steps as dots: filled once they are settled and passed, with a ring around the present one. Without
/// room for them, their numbers.
fn dots_ui(ui: &mut Ui, lesson: &OpenLesson, style: &Style) {
    let count = lesson.lesson().steps.len();
    let room = ui.available_width().min(NAVIGATION);
    let spacing = DOT_SPACING.min((room - 2.0 * DOT) / count as f32);
    let name = format!("step {} of {count}", lesson.number() + 1);
    if spacing < LEAST_SPACING {
        let label = ui.label(RichText::new(format!("{} of {count}", lesson.number() + 1)).heading());
        return tell(&label, egui::Role::Label, &name);
    }
    let (rect, response) = ui.allocate_exact_size(vec2(spacing * count as f32, 18.0), Sense::hover());
    tell(&response, egui::Role::Label, &name);
    for number in 0..count {
        let at = egui::pos2(rect.left() + (number as f32 + 0.5) * spacing, rect.center().y);
        let is_behind = number < lesson.number() || number == lesson.number() && lesson.may_go_on();
        let fill = if is_behind && lesson.is_settled(number) { style.ink() } else { Color32::TRANSPARENT };
        ui.painter().circle(at, DOT.min(0.4 * spacing), fill, Stroke::new(1.2, style.ink()));
        if number == lesson.number() {
            let ring = Stroke::new(2.0, style.accent());
            ui.painter().circle_stroke(at, (DOT + 2.5).min(0.5 * spacing), ring);
        }
    }
    response.on_hover_text(name);
}

/// The buttons, the last one first, in a layout from right to left.
fn buttons_ui(ui: &mut Ui, lesson: &OpenLesson, urged: bool) -> Option<LessonAction> {
    let mut action = None;
    let following = lesson.following().filter(|_| lesson.is_last() && lesson.may_go_on());
    if let Some(name) = following {
        let next = ui.add(primary(ui, &numbered(name))).on_hover_text("The lesson that comes after this one");
        urge(&next, urged);
        action = next.clicked().then_some(LessonAction::NextLesson(name));
    }
    let (name, chosen, hover) = match lesson.is_last() {
        true => ("Finish", LessonAction::Finish, "Ends the lesson: your scene comes back as it was"),
        false => ("Next", LessonAction::Next, "The next step (PageDown)"),
    };
    let is_skipped = !lesson.may_go_on() && !lesson.is_covering() && !lesson.is_last();
    let (button, hover) = match following {
        _ if is_skipped => (Button::new("Skip"), "The next step, without the task (PageDown twice)"),
        None => (primary(ui, name), hover),
        Some(_) => (Button::new(name), hover),
    };
    let next = ui.add_enabled(lesson.may_go_on() || is_skipped, button);
    let next = next.on_disabled_hover_text(match lesson.step() {
        Step::Predict { .. } => "First choose what you expect, or Reveal.",
        _ => "First the task.",
    });
    urge(&next, urged && lesson.is_last() && following.is_none());
    if next.on_hover_text(hover).clicked() {
        action = Some(if is_skipped { LessonAction::Skip } else { chosen });
    }
    let back = ui.add_enabled(lesson.number() > 0, Button::new("Back"));
    if back.on_hover_text("The step before (PageUp)").clicked() {
        action = Some(LessonAction::Back);
    }
    action
}

/// Gives a button the keyboard focus if `urged`, so that Enter presses it. A pressed button loses the focus,
/// which the button that takes its place would inherit.
fn urge(button: &Response, urged: bool) {
    if button.clicked() {
        button.surrender_focus();
    } else if urged {
        button.request_focus();
    }
}
