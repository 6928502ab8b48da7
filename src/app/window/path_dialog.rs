//! Dialog in which a path is typed, for a desktop without a file dialog.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Key, RichText, TextEdit, Ui};

use crate::app::ui::widgets::{dialog, dialog_width};
use crate::system::files;

use super::wanted::Wanted;

/// A path that is being typed, and its purpose.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PathDialog {
    pub wanted: Wanted,
    pub path: String,
    /// Whether the field has had the keyboard focus.
    had_focus: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum PathAnswer {
    Chosen(PathBuf),
    Cancelled,
}

impl PathDialog {
    /// A dialog with a suggested path.
    pub fn new(wanted: Wanted, path: &Path) -> Self {
        Self { wanted, path: path.to_string_lossy().into_owned(), had_focus: false }
    }

    /// Whether the path can be chosen, and a remark: why not, or what happens to the file.
    fn remark(&self) -> (bool, Option<&'static str>) {
        let path = Path::new(self.path.trim());
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        if self.path.trim().is_empty() {
            (false, Some("A path is needed."))
        } else if files::is_folder(path) {
            (false, Some("This is a folder: add the name of a file."))
        } else if self.wanted.is_read() {
            if files::is_file(path) { (true, None) } else { (false, Some("There is no such file.")) }
        } else if folder.is_some_and(|folder| !files::is_folder(folder)) {
            (false, Some("There is no such folder."))
        } else if files::exists(path) {
            (true, Some("This file exists and will be replaced."))
        } else {
            (true, None)
        }
    }

    /// Draws the dialog. Returns the answer once there is one.
    pub fn ui(&mut self, ui: &Ui) -> Option<PathAnswer> {
        let answer = dialog(ui.ctx(), "path").show(ui.ctx(), |ui| {
            ui.set_width(dialog_width(ui, 520.0));
            ui.heading(self.wanted.words().0);
            ui.label("This desktop has no file dialog to offer (xdg-desktop-portal or zenity would be one).");
            ui.add_space(4.0);
            let name = ui.label("path of the file");
            let field = TextEdit::singleline(&mut self.path).desired_width(f32::INFINITY);
            let field = ui.add(field).labelled_by(name.id);
            if !self.had_focus {
                field.request_focus();
                self.had_focus = true;
            }
            let (taken, remark) = self.remark();
            ui.label(RichText::new(remark.unwrap_or(" ")).small());
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            if entered && !taken {
                field.request_focus();
            }
            ui.horizontal(|ui| {
                let done = ui.add_enabled(taken, egui::Button::new(self.wanted.verb())).clicked();
                let cancelled = ui.button("Cancel").clicked();
                if taken && (done || entered) {
                    Some(PathAnswer::Chosen(PathBuf::from(self.path.trim())))
                } else {
                    cancelled.then_some(PathAnswer::Cancelled)
                }
            })
            .inner
        });
        let closed = answer.should_close().then_some(PathAnswer::Cancelled);
        answer.inner.or(closed)
    }
}
