//! Texts to read: notes of the scene below the controls, the glossary, the lecturer's notes of a lesson.

use eframe::egui::{
    self, Align, CentralPanel, Color32, Frame, Key, Label, Layout, Modifiers, Rect, RichText, ScrollArea, Ui,
    ViewportBuilder, ViewportClass, ViewportId, vec2,
};

use crate::app::session::lesson::{OpenLesson, Outcome};
use crate::app::ui::widgets::{close_ui, dialog_ui, prose_height, prose_ui};
use crate::app::words::lesson::{letter, plain, script};
use crate::app::words::meanings::{GLOSSARY, meaning};
use crate::scene::Scene;
use crate::scene::lesson::Step;

use super::lesson::LessonAction;
use super::lesson_options::votes_ui;

/// Height in points of the heading.
const HEADING: f32 = 42.0;
/// Height in points of the button that shows the rest.
const MORE: f32 = 30.0;
/// Width in points of the column of times.
const TIME: f32 = 40.0;
/// Least height in points in which notes are shown.
const LEAST: f32 = 120.0;

/// Draws the beginning of the notes, above `bottom`: two sentences at most. If the scene was changed, they
/// describe it before the changes. Returns whether the user asks for all of the notes.
pub fn notes_ui(ui: &mut Ui, scene: &Scene, is_changed: bool, bottom: f32) -> bool {
    let notes = scene.notes.trim();
    let room = bottom - ui.cursor().top();
    if notes.is_empty() {
        return false;
    }
    let hover = "All that the scene says about itself";
    let heading = if is_changed { "The scene before changes" } else { "About this scene" };
    ui.add_space(14.0);
    if room < LEAST {
        return ui.link(heading).on_hover_text(hover).clicked();
    }
    ui.label(RichText::new(heading).heading());
    let width = ui.available_width();
    let fits = |text: &str| prose_height(ui, text, width) <= room - HEADING - MORE;
    let shown = [2, 1].map(|count| beginning(notes, count)).into_iter().find(|text| fits(text));
    if let Some(text) = shown {
        prose_ui(ui, text);
    }
    shown != Some(notes) && ui.link("Read on").on_hover_text(hover).clicked()
}

/// The first sentences of a text, at most `count`.
fn beginning(text: &str, count: usize) -> &str {
    let ends = text.match_indices('.').map(|(at, _)| at + 1);
    let mut ends = ends.filter(|at| text[*at..].starts_with(char::is_whitespace));
    ends.nth(count - 1).map_or(text, |end| &text[..end])
}

/// Shows the glossary. Returns `false` once it is to be closed.
pub fn glossary_ui(ui: &Ui) -> bool {
    let (is_read, is_closed) = dialog_ui(ui, ("glossary", 640.0), ("Glossary", 4.0), |ui| {
        let room = (ui.ctx().content_rect().height() - 130.0).max(80.0);
        ScrollArea::vertical().max_height(room).show(ui, |ui| {
            for word in GLOSSARY {
                ui.label(RichText::new(word).heading());
                ui.label(meaning(word).unwrap_or_default());
                ui.add_space(4.0);
            }
        });
        ui.add_space(8.0);
        close_ui(ui)
    });
    let toggled = ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F2));
    !(is_read || is_closed || toggled)
}

/// Input in the window of the lecturer's notes.
#[derive(Debug, Default)]
pub struct Lectured {
    pub action: Option<LessonAction>,
    /// Whether to close them.
    pub is_closed: bool,
    /// Where their window is on the screen, in points: its upper left corner, and the size within its frame.
    /// `None` where that is not known.
    pub place: Option<Rect>,
}

/// Shows the lecturer's notes in a separate window, made as `builder` says. Its text is magnified by `scale`
/// against the rest of the program.
pub fn lecturer_ui(
    ctx: &egui::Context,
    lesson: &OpenLesson,
    builder: ViewportBuilder,
    scale: f32,
) -> Lectured {
    let mut done = Lectured::default();
    ctx.show_viewport_immediate(ViewportId::from_hash_of("lecturer"), builder, |ui, class| {
        if class == ViewportClass::EmbeddedWindow {
            done.action = lecturer_notes_ui(ui, lesson);
            done.is_closed |= ui.button("Close").clicked();
            return;
        }
        CentralPanel::default_margins().show(ui, |ui| {
            ui.style_mut().text_styles.values_mut().for_each(|font| font.size *= scale);
            done.action = lecturer_notes_ui(ui, lesson);
        });
        ui.input_mut(|input| {
            let view = input.viewport();
            done.is_closed |= view.close_requested();
            let place = view.outer_rect.zip(view.inner_rect);
            done.place = place.map(|(outer, inner)| Rect::from_min_size(outer.min, inner.size()));
            for (key, chosen) in [(Key::PageDown, LessonAction::Next), (Key::PageUp, LessonAction::Back)] {
                if input.consume_key(Modifiers::NONE, key) {
                    done.action = Some(chosen);
                }
            }
            done.is_closed |= input.consume_key(Modifiers::COMMAND, Key::L);
        });
    });
    done
}

fn lecturer_notes_ui(ui: &mut Ui, open: &OpenLesson) -> Option<LessonAction> {
    let lesson = open.lesson();
    let mut action = None;
    let room = (ui.available_height() - 8.0).max(60.0);
    ScrollArea::vertical().auto_shrink(false).max_height(room).show(ui, |ui| {
        ui.label(RichText::new(format!("{}, {} min", lesson.title, lesson.minutes)).heading());
        ui.label(&lesson.goal);
        let part_ui = |ui: &mut Ui, heading: &str, text: &str| {
            if !text.trim().is_empty() {
                ui.add_space(6.0);
                ui.label(RichText::new(heading).heading());
                ui.label(plain(text));
            }
        };
        part_ui(ui, "What students think before", &lesson.misconception);
        if !lesson.lecturer.trim().is_empty() {
            ui.add_space(6.0);
            ui.label(RichText::new("What to do").heading());
            script_ui(ui, open);
        }
        let heading = format!("Step {} of {}", open.number() + 1, lesson.steps.len());
        part_ui(ui, &heading, open.step().text());
        if open.is_covering() {
            ui.horizontal(|ui| {
                ui.label("Votes");
                action = votes_ui(ui, open);
                if ui.button("Reveal to the class").clicked() {
                    action = Some(LessonAction::Reveal);
                }
            });
        }
        match (open.step(), open.outcome()) {
            (Step::Predict { .. }, Outcome::Holds(option)) => {
                let text = format!("{}: {}", letter(option), open.options()[option].text);
                // a mirrored screen would show it to the class
                let heading = RichText::new("What holds").heading();
                let answer = egui::CollapsingHeader::new(heading).id_salt(("holds", open.number()));
                answer.default_open(!open.is_covering()).show_unindented(ui, |ui| ui.label(plain(&text)));
            }
            (Step::Do { hint, .. }, _) => {
                part_ui(ui, "Hint", hint.as_deref().unwrap_or_default());
                let solution = open.solution().iter().map(|(field, value)| format!("{field} = {value}"));
                part_ui(ui, "A solution", &solution.collect::<Vec<_>>().join("\n"));
            }
            _ => {}
        }
    });
    action
}

/// The lecturer's script, with a column of times; the line of the present time is marked.
fn script_ui(ui: &mut Ui, open: &OpenLesson) {
    let lines = script(&open.lesson().lecturer);
    let now = open.open_for(ui.input(|input| input.time));
    let coming = lines.iter().position(|line| line.0 > now);
    if let Some(next) = coming {
        ui.ctx().request_repaint_after_secs((lines[next].0 - now) as f32);
    }
    let present = coming.unwrap_or(lines.len()).checked_sub(1);
    for (number, (_, time, text)) in lines.iter().enumerate() {
        let is_present = Some(number) == present && !time.is_empty();
        let mark = if is_present { ui.visuals().selection.bg_fill } else { Color32::TRANSPARENT };
        Frame::new().fill(mark.gamma_multiply(0.4)).inner_margin(2.0).show(ui, |ui| {
            ui.horizontal_top(|ui| {
                ui.allocate_ui_with_layout(vec2(TIME, 0.0), Layout::top_down(Align::Min), |ui| {
                    ui.set_width(TIME);
                    ui.label(RichText::new(*time).heading());
                    if is_present {
                        ui.label("now");
                    }
                });
                ui.add(Label::new(plain(text)).wrap());
            });
        });
    }
}
