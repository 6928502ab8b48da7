//! Files that the user chooses: their purposes, the answers, and the dialog in which a path is typed.

use std::path::{Path, PathBuf};

use eframe::egui::{Key, RichText, TextEdit, Ui};

use crate::app::ui::widgets::{dialog_ui, primary};
use crate::system::files;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    Open,
    Lesson,
    /// Measured data, to be drawn over the computed motion or curve.
    Measured,
    Save,
    Motion,
    Run,
    Events,
    Curve,
    Map,
    Picture,
    Figure,
}

impl Wanted {
    /// The question where a path is typed, the kind of file, and its extension.
    pub(super) fn words(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Open => ("Open which scene?", "scene", "ron"),
            Self::Lesson => ("Open which lesson?", "lesson", "ron"),
            Self::Measured => ("Open which measured data?", "measured data", "csv"),
            Self::Save => ("Save the scene to which file?", "scene", "ron"),
            Self::Motion => ("Save the motion that was seen to which file?", "motion", "csv"),
            Self::Run => ("Save the whole run to which file?", "run", "csv"),
            Self::Events => ("Save the events to which file?", "events", "csv"),
            Self::Curve => ("Save the force curve to which file?", "curve", "csv"),
            Self::Map => ("Save the map to which file?", "map", "csv"),
            Self::Picture => ("Save the picture to which file?", "picture", "png"),
            Self::Figure => ("Save the figure to which file?", "figure", "pdf"),
        }
    }

    pub(super) fn is_read(self) -> bool {
        matches!(self, Self::Open | Self::Lesson | Self::Measured)
    }
}

/// The answer of a file dialog.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Chosen {
    File(Wanted, PathBuf),
    /// The desktop has no dialog; the path that it would have suggested.
    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "a page always has a dialog"))]
    NoDialog(Wanted, PathBuf),
    /// A file that was dropped on a page, and has been read.
    #[cfg(target_arch = "wasm32")]
    Dropped(PathBuf),
    /// Why a file of a page is not opened.
    #[cfg(target_arch = "wasm32")]
    Refused(String),
}

/// Beginning of a remark where a path has to be typed.
pub(super) const NO_DIALOG: &str =
    "This desktop has no file dialog (xdg-desktop-portal or zenity provides one)";

/// Why no file can be written to a path; `None` if one can.
pub(super) fn path_fault(path: &Path) -> Option<&'static str> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if files::is_folder(path) {
        Some("This is a folder: add the name of a file.")
    } else {
        folder.is_some_and(|folder| !files::is_folder(folder)).then_some("There is no such folder.")
    }
}

/// A path that is being typed, and its purpose.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PathDialog {
    pub wanted: Wanted,
    pub path: String,
    had_focus: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum PathAnswer {
    Chosen(PathBuf),
    Cancelled,
}

impl PathDialog {
    pub fn new(wanted: Wanted, path: &Path) -> Self {
        Self { wanted, path: path.to_string_lossy().into_owned(), had_focus: false }
    }

    /// Whether the path can be chosen, and a remark: why not, or what happens to the file.
    fn remark(&self) -> (bool, Option<&'static str>) {
        let path = Path::new(self.path.trim());
        let fault = match self.wanted.is_read() {
            _ if self.path.trim().is_empty() => Some("A path is needed."),
            true if !files::is_folder(path) => (!files::is_file(path)).then_some("There is no such file."),
            _ => path_fault(path),
        };
        let replaces = !self.wanted.is_read() && files::exists(path);
        (fault.is_none(), fault.or(replaces.then_some("This file exists and will be replaced.")))
    }

    pub fn ui(&mut self, ui: &Ui) -> Option<PathAnswer> {
        let (question, ..) = self.wanted.words();
        let (answer, is_closed) = dialog_ui(ui, ("path", 520.0), (question, 0.0), |ui| {
            ui.set_min_width(ui.available_width());
            ui.label(format!("{NO_DIALOG}."));
            ui.add_space(4.0);
            let name = ui.label("path of the file");
            let field = TextEdit::singleline(&mut self.path).desired_width(f32::INFINITY);
            let field = ui.add(field).labelled_by(name.id);
            if !std::mem::replace(&mut self.had_focus, true) {
                field.request_focus();
            }
            let (taken, remark) = self.remark();
            ui.label(RichText::new(remark.unwrap_or(" ")).small());
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            if entered && !taken {
                field.request_focus();
            }
            ui.horizontal(|ui| {
                let verb = if self.wanted.is_read() { "Open" } else { "Save" };
                let done = ui.add_enabled(taken, primary(ui, verb)).clicked();
                let cancelled = ui.button("Cancel").clicked();
                if taken && (done || entered) {
                    Some(PathAnswer::Chosen(PathBuf::from(self.path.trim())))
                } else {
                    cancelled.then_some(PathAnswer::Cancelled)
                }
            })
            .inner
        });
        answer.or(is_closed.then_some(PathAnswer::Cancelled))
    }
}
