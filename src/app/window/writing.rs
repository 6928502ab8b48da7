//! Files that the window writes: scene, motion, whole run, events, force curve, map, picture.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use crate::app::export::{self, RunQuestion, write_text};
use crate::app::session::measured::file_name;
use crate::output::write_file;

use super::Window;
use super::leave::Next;

impl Window {
    /// Writes the scene. Returns what was to be done once it is saved.
    pub(super) fn write_scene(&mut self, path: &Path) -> Option<Next> {
        let next = self.after_save.take();
        match self.session.editor.save_to(path) {
            Ok(companions) => {
                self.remember_file();
                let also = match companions.as_slice() {
                    [] => String::new(),
                    names => format!(" and, beside it, the files that it names: {}", names.join(", ")),
                };
                self.messages.notify(format!("Saved {}{also}", file_name(path)));
                next
            }
            Err(error) => {
                self.messages.alert("The scene was not saved", error);
                None
            }
        }
    }

    pub(super) fn copy_scene(&mut self, ctx: &egui::Context) {
        match self.session.editor.text() {
            Ok(text) => self.messages.copy(ctx, text, "the scene as text"),
            Err(error) => self.messages.alert("The scene was not copied", error),
        }
    }

    pub(super) fn report_written(&mut self) {
        let run = self.run.take();
        for result in run.into_iter().chain(self.written.1.try_iter()) {
            self.messages.report_written(result);
        }
    }

    fn write(&mut self, path: &Path, text: &str) {
        self.messages.report_written(write_text(path, text));
    }

    pub fn write_motion(&mut self, path: &Path) {
        self.write(path, &export::motion_csv(&self.session.player));
    }

    /// Computes the run of the scene from its start and writes it as CSV, in the background.
    pub fn write_run(&mut self, path: PathBuf) {
        if let Some(fault) = self.session.fault() {
            return self.messages.alert("The run was not written", fault);
        }
        self.run.ask(RunQuestion { model: self.session.model.clone(), path }, &self.wake);
        self.messages.notify("Computing the run");
    }

    pub fn wait_for_run(&mut self, timeout: std::time::Duration) {
        self.run.wait(timeout);
        self.report_written();
    }

    pub fn write_events(&mut self, path: &Path) {
        self.write(path, &export::events_csv(&self.session.player));
    }

    pub fn write_curve(&mut self, path: &Path) {
        let text = export::curve_csv(&self.session).map_err(|error| error.to_string());
        self.messages.report_written(text.and_then(|text| write_text(path, &text)));
    }

    pub(super) fn write_map(&mut self, path: &Path) {
        let Some(text) = self.session.map.csv() else { return };
        self.write(path, &text);
    }

    /// Requests a picture of the window, to be written once it has been drawn.
    pub(super) fn write_picture(&mut self, ctx: &egui::Context, path: PathBuf) {
        let (written, wake) = (self.written.0.clone(), Arc::clone(&self.wake));
        // the picture shows no notice
        self.messages.notice = None;
        ctx.request_screenshot(move |image| {
            let bytes = export::png(&image);
            let saved = bytes.and_then(|bytes| write_file(&path, &bytes));
            written.send(saved.map(|()| format!("Saved {}", file_name(&path)))).ok();
            wake();
        });
    }
}
