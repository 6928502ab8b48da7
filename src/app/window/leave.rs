//! Questions before a scene that is not saved gives way to another.

use eframe::egui::Ui;

use crate::app::ui::widgets::{dialog, dialog_width};

/// What is to come once the present scene may go.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Next {
    /// A scene file or a built-in scene.
    Open(String),
    /// A scene as text.
    Text(String),
    /// A file that is still to be chosen.
    Choose,
    Quit,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    Save,
    /// Let the changes go, or save to another file.
    DontSave,
    Cancel,
}

/// Asks; none while there is no answer. The keyboard begins on Save, Escape stays.
pub fn question_ui(ui: &Ui, title: &str) -> Option<Answer> {
    let text = format!("{title} has changes that are not saved.");
    choice_ui(ui, "unsaved", "Save the changes?", &text, "Don't save")
}

/// Asks before a file that was written by hand is written over; none while there is no answer. Its comments
/// are no part of a scene, and go.
pub fn comments_ui(ui: &Ui, path: &str) -> Option<Answer> {
    let text = format!(
        "{path} has comments. They are no part of the scene, and saving over the file does not keep them; \
         its title and notes stay."
    );
    choice_ui(ui, "comments", "Save without the comments?", &text, "Save as...")
}

/// A question with three answers, of which the second one is called `second`.
fn choice_ui(ui: &Ui, id: &str, heading: &str, text: &str, second: &str) -> Option<Answer> {
    let answer = dialog(ui.ctx(), id).show(ui.ctx(), |ui: &mut Ui| {
        ui.set_max_width(dialog_width(ui, 460.0));
        ui.heading(heading);
        ui.add_space(6.0);
        ui.label(text);
        ui.add_space(10.0);
        ui.horizontal(|ui| {
            let mut chosen = None;
            for (way, means) in
                [("Save", Answer::Save), (second, Answer::DontSave), ("Cancel", Answer::Cancel)]
            {
                let button = ui.button(way);
                if means == Answer::Save && ui.memory(|memory| memory.focused().is_none()) {
                    button.request_focus();
                }
                if button.clicked() {
                    chosen = Some(means);
                }
            }
            chosen
        })
        .inner
    });
    answer.inner.or_else(|| answer.should_close().then_some(Answer::Cancel))
}
