//! Files that the window writes: scene, motion, whole run, events, force curve, map, picture.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use crate::app::export;
use crate::output::write_file;

use super::Window;
use super::leave::Next;
use super::messages::Written;

impl Window {
    /// Writes the scene; what was to come once it is saved.
    pub(super) fn write_scene(&mut self, path: &Path) -> Option<Next> {
        let next = self.after_save.take();
        match self.session.editor.save_to(path) {
            Ok(brought) => {
                self.remember_file();
                let also = match brought.as_slice() {
                    [] => String::new(),
                    names => format!(" and, beside it, what it needs: {}", names.join(", ")),
                };
                self.messages.tell(format!("Saved {}{also}", file_name(path)));
                next
            }
            Err(error) => {
                self.messages.say("The scene was not saved", error);
                None
            }
        }
    }

    /// Copies the scene as text.
    pub(super) fn copy_scene(&mut self, ctx: &egui::Context) {
        match self.session.editor.text() {
            Ok(text) => {
                ctx.copy_text(text);
                self.messages.tell("Copied: the scene as text");
            }
            Err(error) => self.messages.say("The scene was not copied", error),
        }
    }

    /// Says what was written on other threads.
    pub(super) fn tell_written(&mut self) {
        let run = self.run.take();
        for written in run.into_iter().chain(self.written.1.try_iter()) {
            self.messages.tell_written(written);
        }
    }

    fn put(&mut self, path: &Path, text: &str) {
        self.messages.tell_written(put(path, text));
    }

    /// Writes the motion that is remembered as CSV.
    pub fn write_motion(&mut self, path: &Path) {
        self.put(path, &export::motion_csv(&self.session.player));
    }

    /// Computes the run of the scene from its start and writes it as CSV, on a thread of its own.
    pub fn write_run(&mut self, path: PathBuf) {
        let (scene, model) = (self.session.scene().clone(), self.session.model().clone());
        if let Some(fault) = self.session.fault() {
            return self.messages.say("The run was not written", fault);
        }
        self.run.ask((), &self.wake, move |(), cancel, _| {
            let text = export::run_csv(&scene, &model, cancel)?;
            Some(text.and_then(|text| put(&path, &text)))
        });
        self.messages.tell("Computing the run");
    }

    /// Waits until a run is written, for `limit` at the longest.
    pub fn wait_for_run(&mut self, limit: std::time::Duration) {
        self.run.wait(limit);
        self.tell_written();
    }

    /// Writes the events that are remembered as CSV.
    pub fn write_events(&mut self, path: &Path) {
        self.put(path, &export::events_csv(&self.session.player));
    }

    /// Writes the force curve as CSV.
    pub fn write_curve(&mut self, path: &Path) {
        let text = export::curve_csv(&self.session).map_err(|error| error.to_string());
        self.messages.tell_written(text.and_then(|text| put(path, &text)));
    }

    /// Writes the map as the rows of a sweep.
    pub(super) fn write_map(&mut self, path: &Path) {
        let Some(text) = self.session.map.csv() else { return };
        self.put(path, &text);
    }

    /// Has the window's picture written once it has been drawn.
    pub(super) fn write_picture(&mut self, ctx: &egui::Context, path: PathBuf) {
        let (written, wake) = (self.written.0.clone(), Arc::clone(&self.wake));
        // nothing that goes by itself is in the picture
        self.messages.drop_told();
        ctx.request_screenshot(move |image| {
            let bytes = export::png(&image);
            let saved = bytes.and_then(|bytes| write_file(&path, &bytes));
            written.send(saved.map(|()| format!("Saved {}", file_name(&path)))).ok();
            wake();
        });
    }
}

/// Writes a text; what was written, in words.
fn put(path: &Path, text: &str) -> Written {
    write_file(path, text.as_bytes()).map(|()| format!("Saved {}", file_name(path)))
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
