//! Questions about unsaved changes and about comments that would be lost.

use eframe::egui::Ui;

use crate::app::ui::widgets::{dialog_ui, focus_first, primary};

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
    let (chosen, is_closed) = dialog_ui(ui, (id, 460.0), (heading, 6.0), |ui| {
        ui.label(text);
        ui.add_space(10.0);
        ui.horizontal(|ui| {
            let save = ui.add(primary(ui, "Save"));
            focus_first(ui, &save);
            let other = ui.button(second).clicked().then_some(Answer::DontSave);
            let cancel = ui.button("Cancel").clicked().then_some(Answer::Cancel);
            save.clicked().then_some(Answer::Save).or(other).or(cancel)
        })
        .inner
    });
    chosen.or(is_closed.then_some(Answer::Cancel))
}
