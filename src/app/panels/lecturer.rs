//! Notes for the lecturer of the open lesson, in a window of their own.

use eframe::egui::{
    self, CentralPanel, Key, Modifiers, RichText, ScrollArea, Ui, ViewportBuilder, ViewportClass, ViewportId,
};

use crate::app::session::lesson::{OpenLesson, Outcome};
use crate::app::words::lesson::plain;
use crate::scene::lesson::Step;

use super::lesson::{LessonAct, letter};

/// Shows them; what was asked for there, and whether they are to be closed.
pub fn lecturer_ui(ctx: &egui::Context, lesson: &OpenLesson) -> (Option<LessonAct>, bool) {
    let builder =
        ViewportBuilder::default().with_title("Lecturer's notes - interwell").with_inner_size([520.0, 420.0]);
    let (mut asked, mut closed) = (None, false);
    ctx.show_viewport_immediate(ViewportId::from_hash_of("lecturer"), builder, |ui, class| {
        let is_own = class != ViewportClass::EmbeddedWindow;
        if is_own {
            CentralPanel::default_margins().show(ui, |ui| notes_ui(ui, lesson));
        } else {
            notes_ui(ui, lesson);
            closed |= ui.button("Close").clicked();
        }
        closed |= ui.input(|input| input.viewport().close_requested()) && is_own;
        ui.input_mut(|input| {
            for (key, act) in [(Key::PageDown, LessonAct::Next), (Key::PageUp, LessonAct::Back)] {
                if is_own && input.consume_key(Modifiers::NONE, key) {
                    asked = Some(act);
                }
            }
            closed |= is_own && input.consume_key(Modifiers::COMMAND, Key::L);
        });
    });
    (asked, closed)
}

fn notes_ui(ui: &mut Ui, lesson: &OpenLesson) {
    let own = lesson.lesson();
    ScrollArea::vertical().auto_shrink(false).max_height((ui.available_height() - 8.0).max(60.0)).show(
        ui,
        |ui| {
            ui.label(RichText::new(format!("{}, {} min", own.title, own.minutes)).heading());
            ui.label(&own.goal);
            let part_ui = |ui: &mut Ui, heading: &str, text: &str| {
                if !text.trim().is_empty() {
                    ui.add_space(6.0);
                    ui.label(RichText::new(heading).heading());
                    ui.label(plain(text));
                }
            };
            part_ui(ui, "What students think before", &own.misconception);
            part_ui(ui, "What to do", &own.lecturer);
            let heading = format!("Step {} of {}", lesson.number() + 1, own.steps.len());
            part_ui(ui, &heading, lesson.step().text());
            match (lesson.step(), lesson.outcome()) {
                (Step::Predict { .. }, Outcome::Holds(option)) => {
                    let text = format!("{}: {}", letter(option), lesson.options()[option].text);
                    part_ui(ui, "What holds", &text);
                }
                (Step::Do { hint, .. }, _) => {
                    part_ui(ui, "Hint", hint.as_deref().unwrap_or_default());
                    let solution = lesson.solution().iter().map(|own| format!("{} = {}", own.0, own.1));
                    part_ui(ui, "A solution", &solution.collect::<Vec<_>>().join("\n"));
                }
                _ => {}
            }
        },
    );
}
