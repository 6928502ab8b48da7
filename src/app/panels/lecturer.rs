//! Lecturer's notes of the open lesson, in a separate window.

use eframe::egui::{
    self, CentralPanel, Key, Modifiers, RichText, ScrollArea, Ui, ViewportBuilder, ViewportClass, ViewportId,
};

use crate::app::session::lesson::{OpenLesson, Outcome};
use crate::app::words::lesson::plain;
use crate::scene::lesson::Step;

use super::lesson::{LessonAction, letter};

/// Shows the notes. Returns the action that was chosen there, and whether to close the notes.
pub fn lecturer_ui(ctx: &egui::Context, lesson: &OpenLesson) -> (Option<LessonAction>, bool) {
    let builder =
        ViewportBuilder::default().with_title("Lecturer's notes - interwell").with_inner_size([520.0, 420.0]);
    let (mut action, mut closed) = (None, false);
    ctx.show_viewport_immediate(ViewportId::from_hash_of("lecturer"), builder, |ui, class| {
        let is_separate = class != ViewportClass::EmbeddedWindow;
        if is_separate {
            CentralPanel::default_margins().show(ui, |ui| notes_ui(ui, lesson));
        } else {
            notes_ui(ui, lesson);
            closed |= ui.button("Close").clicked();
        }
        closed |= ui.input(|input| input.viewport().close_requested()) && is_separate;
        ui.input_mut(|input| {
            for (key, chosen) in [(Key::PageDown, LessonAction::Next), (Key::PageUp, LessonAction::Back)] {
                if is_separate && input.consume_key(Modifiers::NONE, key) {
                    action = Some(chosen);
                }
            }
            closed |= is_separate && input.consume_key(Modifiers::COMMAND, Key::L);
        });
    });
    (action, closed)
}

fn notes_ui(ui: &mut Ui, open: &OpenLesson) {
    let lesson = open.lesson();
    ScrollArea::vertical().auto_shrink(false).max_height((ui.available_height() - 8.0).max(60.0)).show(
        ui,
        |ui| {
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
            part_ui(ui, "What to do", &lesson.lecturer);
            let heading = format!("Step {} of {}", open.number() + 1, lesson.steps.len());
            part_ui(ui, &heading, open.step().text());
            match (open.step(), open.outcome()) {
                (Step::Predict { .. }, Outcome::Holds(option)) => {
                    let text = format!("{}: {}", letter(option), open.options()[option].text);
                    part_ui(ui, "What holds", &text);
                }
                (Step::Do { hint, .. }, _) => {
                    part_ui(ui, "Hint", hint.as_deref().unwrap_or_default());
                    let solution = open.solution().iter().map(|(field, value)| format!("{field} = {value}"));
                    part_ui(ui, "A solution", &solution.collect::<Vec<_>>().join("\n"));
                }
                _ => {}
            }
        },
    );
}
