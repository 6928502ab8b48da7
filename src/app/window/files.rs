//! Opening of scenes and measured data, choice of files, and questions to the user.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::channel;

use eframe::egui::{self, Ui};

use crate::app::session::editor::Editor;
use crate::app::session::measured::{MeasuredRecord, file_name};
use crate::app::ui::style::STATUS;
use crate::app::views::View;
use crate::questions::Error;
use crate::scene::{Quantity, is_link};
use crate::system::files;

use super::Window;
use super::choice::Choice;
use super::leave::{self, Answer, Next};
use super::lessons;
use super::measured_dialog::{ENDINGS, MeasuredAnswer, MeasuredDialog, is_measured};
use super::messages::{CANNOT_OPEN, Messages};
use super::wanted::{Chosen, NO_DIALOG, PathAnswer, PathDialog, Wanted};

impl Window {
    /// Opens another scene or lesson. If it cannot be opened, the present one stays and an alert says why.
    pub fn open_another(&mut self, spec: &str) {
        if lessons::is_lesson(spec) {
            return self.open_lesson(spec);
        }
        self.open_editor(Editor::open(spec).map_err(Error::from));
    }

    fn open_editor(&mut self, editor: Result<Editor, Error>) {
        let wake = Arc::clone(&self.wake);
        match editor.and_then(|editor| Self::with_editor(editor, self.settings, wake)) {
            Ok(window) => {
                self.leave_lesson();
                let measured = std::mem::take(&mut self.session.measured);
                *self = Self {
                    file_dialog: std::mem::take(&mut self.file_dialog),
                    opens_dialogs: self.opens_dialogs,
                    recent: std::mem::take(&mut self.recent),
                    custom: self.custom.take(),
                    shown_title: std::mem::take(&mut self.shown_title),
                    window_size: std::mem::take(&mut self.window_size),
                    written: std::mem::replace(&mut self.written, channel()),
                    run: std::mem::take(&mut self.run),
                    figures: std::mem::take(&mut self.figures),
                    covered: self.covered,
                    lessons: std::mem::take(&mut self.lessons),
                    messages: Messages { alert: None, notice: self.messages.notice.take() },
                    applied: self.applied,
                    memory: self.memory.for_another_scene(),
                    ..window
                };
                self.session.measured = measured;
                self.remember_file();
            }
            Err(error) => self.messages.alert(CANNOT_OPEN, error.to_string()),
        }
    }

    /// Carries out `next` once the changes of the present scene are saved or discarded.
    pub fn leave_for(&mut self, ctx: &egui::Context, next: Next) {
        self.session.end_gesture();
        // a lesson suspends the scene without losing its changes
        let suspends = matches!(&next, Next::Open(spec) if lessons::is_lesson(spec));
        if self.is_unsaved() && !suspends {
            self.leave_lesson();
            self.pending = Some(next);
        } else {
            self.proceed(ctx, next);
        }
    }

    /// Whether the scene has unsaved changes that are worth a question; the scene of a lesson does not count.
    fn is_unsaved(&self) -> bool {
        let editor = &self.lessons.suspended().unwrap_or(&self.session).editor;
        editor.is_dirty() && !editor.is_play()
    }

    fn proceed(&mut self, ctx: &egui::Context, next: Next) {
        match next {
            Next::Open(spec) => self.open_another(&spec),
            Next::Text(text) if is_link(&text) => self.open_another(text.trim()),
            Next::Text(text) => self.open_editor(Editor::from_text(&text).map_err(Error::from)),
            Next::Choose => self.choose(Wanted::Open),
            Next::Quit => {
                self.leaving = true;
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
        }
    }

    /// Saves to the file of the scene, or asks for one.
    pub(super) fn save(&mut self, ctx: &egui::Context) {
        match self.session.editor.path().map(PathBuf::from) {
            Some(path) => self.save_to(ctx, &path),
            None => self.choose(Wanted::Save),
        }
    }

    /// Saves to a file; asks first if that is the file of the scene and its comments would be lost.
    pub fn save_to(&mut self, ctx: &egui::Context, path: &Path) {
        // in a page it replaces nothing, but is a download
        let replaces = self.session.editor.path() == Some(path) && cfg!(not(target_arch = "wasm32"));
        if replaces && self.session.editor.has_comments() {
            self.over_comments = Some(path.to_owned());
        } else {
            self.save_over(ctx, path);
        }
    }

    /// Saves to a file, and then carries out the action that waited for that.
    fn save_over(&mut self, ctx: &egui::Context, path: &Path) {
        if let Some(next) = self.write_scene(path) {
            self.proceed(ctx, next);
        }
    }

    pub(super) fn take_choice(&mut self, ctx: &egui::Context) {
        if let Some(chosen) = self.file_dialog.take() {
            match chosen {
                Chosen::File(wanted, path) => self.take_file(ctx, wanted, path),
                #[cfg(target_arch = "wasm32")]
                Chosen::Dropped(path) => self.take_dropped(ctx, &path),
                #[cfg(target_arch = "wasm32")]
                Chosen::Refused(why) => self.messages.alert("Not opened", why),
                Chosen::NoDialog(Wanted::Figure, _) => {
                    self.figures.problem = Some(format!("{NO_DIALOG}: type the path."));
                }
                Chosen::NoDialog(wanted, path) => self.path_dialog = Some(PathDialog::new(wanted, &path)),
            }
        } else if !self.file_dialog.is_running() && self.over_comments.is_none() && self.path_dialog.is_none()
        {
            // with a dialog, the action that waited for the save is cancelled
            self.after_save = None;
        }
    }

    fn take_file(&mut self, ctx: &egui::Context, wanted: Wanted, path: PathBuf) {
        match wanted {
            Wanted::Open => self.open_another(&path.to_string_lossy()),
            Wanted::Lesson => self.open_lesson(&path.to_string_lossy()),
            Wanted::Measured => self.open_measured(&path),
            Wanted::Save => self.save_to(ctx, &path),
            Wanted::Motion => self.write_motion(&path),
            Wanted::Run => self.write_run(path),
            Wanted::Events => self.write_events(&path),
            Wanted::Curve => self.write_curve(&path),
            Wanted::Map => self.write_map(&path),
            Wanted::Picture => self.write_picture(ctx, path),
            Wanted::Figure => self.figures.choose(&path),
        }
    }

    /// Takes input from outside the panels: closing of the window, dropped files, the clipboard.
    pub(super) fn take_input(&mut self, ctx: &egui::Context) {
        if ctx.input(|input| input.viewport().close_requested()) && !self.leaving && self.is_unsaved() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.leave_for(ctx, Next::Quit);
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        #[cfg(target_arch = "wasm32")]
        if !dropped.is_empty() {
            super::choice::read_dropped(dropped, &mut self.file_dialog, &self.wake);
        }
        #[cfg(not(target_arch = "wasm32"))]
        match dropped.as_slice() {
            [] => {}
            [one] => self.take_dropped(ctx, one.path()),
            _ => self.messages.alert(
                "One file at a time",
                "Drop a single scene or lesson (.ron), or a file of measured data (.csv), on the window.",
            ),
        }
        if !self.waits_for_answer() && !ctx.text_edit_focused() {
            let events = ctx.input(|input| input.events.clone());
            if events.contains(&egui::Event::Copy) {
                self.copy_scene(ctx);
            }
            let pasted = |event| if let egui::Event::Paste(text) = event { Some(text) } else { None };
            if let Some(text) = events.into_iter().rev().find_map(pasted) {
                self.leave_for(ctx, Next::Text(text));
            }
        }
        self.report_written();
        let dirty = if self.is_unsaved() { "* " } else { "" };
        let name = self.lesson().map_or(&self.session.scene().title, |open| &open.lesson().title);
        let title = format!("{dirty}{name} - interwell");
        if title != self.shown_title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.shown_title = title;
        }
    }

    pub fn take_dropped(&mut self, ctx: &egui::Context, path: &Path) {
        match is_measured(path) {
            true if self.waits_for_answer() && self.columns.is_none() => {}
            true if self.lesson().is_some() => self.messages.notify("Leave the lesson first"),
            true => self.open_measured(path),
            false => self.leave_for(ctx, Next::Open(path.to_string_lossy().into_owned())),
        }
    }

    pub(super) fn questions_ui(&mut self, ui: &Ui, ctx: &egui::Context) {
        if self.pending.is_some()
            && let Some(answer) = leave::question_ui(ui, &self.session.scene().title)
            && let Some(next) = self.pending.take()
        {
            match answer {
                Answer::Save => {
                    self.after_save = Some(next);
                    self.save(ctx);
                }
                Answer::DontSave => self.proceed(ctx, next),
                Answer::Cancel => {}
            }
        }
        let shown = self.over_comments.as_ref().map(|path| path.display().to_string());
        if let Some(shown) = shown
            && let Some(answer) = leave::comments_ui(ui, &shown)
            && let Some(path) = self.over_comments.take()
        {
            match answer {
                Answer::Save => self.save_over(ctx, &path),
                Answer::DontSave => self.choose(Wanted::Save),
                Answer::Cancel => self.after_save = None,
            }
        }
        if let Some(dialog) = &mut self.path_dialog
            && let Some(answer) = dialog.ui(ui)
        {
            let wanted = dialog.wanted;
            self.path_dialog = None;
            if let PathAnswer::Chosen(path) = answer {
                self.take_file(ctx, wanted, path);
            }
        }
        if ui.input(|input| !input.raw.hovered_files.is_empty()) {
            let painter =
                ctx.layer_painter(egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop")));
            let rect = ctx.content_rect();
            painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color.gamma_multiply(0.8));
            let font = egui::FontId::proportional(STATUS);
            let (at, ink) = (rect.center(), ui.visuals().text_color());
            painter.text(at, egui::Align2::CENTER_CENTER, "Drop the file to open it", font, ink);
        }
    }

    /// Opens no file dialogs from now on: a request for one is ignored.
    pub fn without_dialogs(&mut self) {
        self.opens_dialogs = false;
    }

    /// Opens the dialog in which a path is typed, as on a desktop without a file dialog.
    pub fn type_path(&mut self, wanted: Wanted) {
        self.path_dialog = Some(PathDialog::new(wanted, Path::new("")));
    }

    pub(super) fn choose(&mut self, wanted: Wanted) {
        if !self.opens_dialogs {
            return;
        }
        let (_, kind, ending) = wanted.words();
        let path = self.session.editor.path().map(Path::to_path_buf);
        let stem = path.as_ref().and_then(|path| path.file_stem());
        let stem = stem.map_or_else(|| "scene".to_owned(), |stem| stem.to_string_lossy().into_owned());
        let folder = path.as_ref().and_then(|path| path.parent()).map(Path::to_path_buf);
        // the kind of a table is in its name, so that the tables of a scene have different names
        let name = match ending {
            "csv" => format!("{stem}-{kind}.{ending}"),
            _ => format!("{stem}.{ending}"),
        };
        // the suggested path if the desktop has no dialog
        let start = folder.clone().unwrap_or_else(files::working_folder);
        let start = if wanted.is_read() { start.join("") } else { start.join(&name) };
        let endings = if wanted == Wanted::Measured { &ENDINGS[..] } else { &[ending][..] };
        let endings = endings.iter().map(|ending| (*ending).to_owned()).collect();
        let choice = Choice { wanted, kind, endings, name, folder, start };
        choice.ask(&mut self.file_dialog, &self.wake);
    }

    pub fn open_measured(&mut self, path: &Path) {
        self.columns = Some(MeasuredDialog::new(path, &self.wake));
    }

    /// Draws a record over the view of its quantity, with a card beside Compare.
    pub fn overlay(&mut self, record: MeasuredRecord) {
        let view = match record.values.quantity {
            Quantity::Velocity => View::Velocity,
            Quantity::Acceleration => View::BaseAcceleration,
            Quantity::Force => View::ForceCurve,
            _ => View::Displacement,
        };
        self.session.measured.lay(record);
        self.filled = None;
        self.tiling.show_beside(View::Measured, View::Compare);
        // the view is in front if it shares tabs with the card
        self.tiling.show(view, true);
    }

    pub(super) fn measured_ui(&mut self, ui: &Ui) {
        let Some(answer) = self.columns.as_mut().and_then(|dialog| dialog.ui(ui, &self.wake)) else { return };
        match answer {
            MeasuredAnswer::Overlay(record) => self.overlay(*record),
            MeasuredAnswer::Shake(path, record) => match self.session.shake_with(&path, &record) {
                Ok(warnings) => {
                    let name = file_name(&record.path);
                    let done = format!("The base is shaken with {name}, from its start");
                    match warnings.is_empty() {
                        true => self.messages.notify(done),
                        false => self.messages.alert(done, format!("The record {}.", warnings.join("; it "))),
                    }
                    self.tiling.show(View::BaseAcceleration, true);
                }
                Err(why) => {
                    if let Some(dialog) = &mut self.columns {
                        dialog.refuse(why);
                    }
                    return;
                }
            },
            MeasuredAnswer::Cancelled => {}
        }
        self.columns = None;
    }
}
