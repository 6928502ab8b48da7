//! Questions about unsaved changes and about comments that would be lost.

use eframe::egui::Ui;

use crate::app::ui::widgets::{dialog, dialog_width, primary};

/// What to do once the present scene may be closed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Next {
    /// A scene file or a built-in scene.
    Open(String),
    Text(String),
    /// A file that the user has yet to choose.
    Choose,
    Quit,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    Save,
    /// Discard the changes, or save to another file.
    DontSave,
    Cancel,
}

/// Asks whether to save the changes. Returns `None` until there is an answer; Escape cancels.
pub fn question_ui(ui: &Ui, title: &str) -> Option<Answer> {
    let text = format!("{title} has changes that are not saved.");
    choice_ui(ui, "unsaved", "Save the changes?", &text, "Don't save")
}

/// Asks before a file loses its comments. Returns `None` until there is an answer.
pub fn comments_ui(ui: &Ui, path: &str) -> Option<Answer> {
    let text = format!(
        "{path} has comments. They are no part of the scene, and saving over the file does not keep them; \
         its title and notes stay."
    );
    choice_ui(ui, "comments", "Save without the comments?", &text, "Save as...")
}

/// A question with three answers. `second` is the label of the second one; Save has the focus first.
fn choice_ui(ui: &Ui, id: &str, heading: &str, text: &str, second: &str) -> Option<Answer> {
    let answer = dialog(ui.ctx(), id).show(ui.ctx(), |ui: &mut Ui| {
        ui.set_max_width(dialog_width(ui, 460.0));
        ui.heading(heading);
        ui.add_space(6.0);
        ui.label(text);
        ui.add_space(10.0);
        ui.horizontal(|ui| {
            let mut chosen = None;
            for (label, answer) in
                [("Save", Answer::Save), (second, Answer::DontSave), ("Cancel", Answer::Cancel)]
            {
                let button = match answer {
                    Answer::Save => ui.add(primary(ui, label)),
                    _ => ui.button(label),
                };
                if answer == Answer::Save && ui.memory(|memory| memory.focused().is_none()) {
                    button.request_focus();
                }
                if button.clicked() {
                    chosen = Some(answer);
                }
            }
            chosen
        })
        .inner
    });
    answer.inner.or_else(|| answer.should_close().then_some(Answer::Cancel))
}
