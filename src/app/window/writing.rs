//! Files that the window writes: the scene, its motion, its whole run, events, force curve, map and picture.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use crate::app::export;
use crate::app::map::Map;
use crate::output;

use super::Window;

/// What was written, in words, or why it was not.
pub(super) type Written = Result<String, String>;

impl Window {
    /// Saves to a file; one that was written by hand with comments only once it is said that they go.
    pub fn save_to(&mut self, ctx: &egui::Context, path: &Path) {
        let own = self.session.editor.path() == Some(path);
        if own && self.session.editor.has_comments() {
            self.over_comments = Some(path.to_owned());
        } else {
            self.write_scene(ctx, path);
        }
    }

    pub(super) fn write_scene(&mut self, ctx: &egui::Context, path: &Path) {
        let next = self.after_save.take();
        match self.session.editor.save_to(path) {
            Ok(brought) => {
                self.remember_file();
                let also = match brought.as_slice() {
                    [] => String::new(),
                    names => format!(" and, beside it, what it needs: {}", names.join(", ")),
                };
                self.tell(format!("Saved {}{also}", file_name(path)));
                if let Some(next) = next {
                    self.go_on(ctx, next);
                }
            }
            Err(error) => self.say("The scene was not saved", error),
        }
    }

    /// Says what was written, or why it was not.
    pub(super) fn tell_written(&mut self, written: Written) {
        match written {
            Ok(text) => self.tell(text),
            Err(error) => self.say("Not written", error),
        }
    }

    fn put(&mut self, path: &Path, text: &str) {
        self.tell_written(put(path, text));
    }

    /// Writes the motion that is remembered as CSV.
    pub fn write_motion(&mut self, path: &Path) {
        self.put(path, &export::motion_csv(&self.session.player));
    }

    /// Computes the run of the scene from its start and writes it as CSV, on a thread of its own.
    pub fn write_run(&mut self, path: PathBuf) {
        let (scene, model) = (self.session.scene().clone(), self.session.model().clone());
        if let Some(fault) = self.session.fault() {
            return self.say("The run was not written", fault.to_owned());
        }
        self.run.ask(&self.wake, move |cancel| {
            let text = export::run_csv(&scene, &model, cancel)?;
            Some(text.and_then(|text| put(&path, &text)))
        });
        self.tell("Computing the run");
    }

    /// Waits until a run is written, at most so long.
    pub fn wait_for_run(&mut self, most: std::time::Duration) {
        if self.run.wait(most)
            && let Some(written) = self.run.current().cloned()
        {
            self.run.clear();
            self.tell_written(written);
        }
    }

    /// Writes the events that are remembered as CSV.
    pub fn write_events(&mut self, path: &Path) {
        self.put(path, &export::events_csv(&self.session.player));
    }

    /// Writes the force curve as CSV.
    pub fn write_curve(&mut self, path: &Path) {
        let text = export::curve_csv(&self.session).map_err(|error| error.to_string());
        self.tell_written(text.and_then(|text| put(path, &text)));
    }

    /// Writes the map as the rows of a sweep.
    pub(super) fn write_map(&mut self, path: &Path) {
        let Some(text) = self.session.map.map().and_then(Map::csv) else { return };
        self.put(path, &text);
    }

    /// Has the window's picture written once it has been drawn.
    pub(super) fn write_picture(&mut self, ctx: &egui::Context, path: PathBuf) {
        let (written, wake) = (self.written.0.clone(), Arc::clone(&self.wake));
        // nothing that goes by itself is in the picture
        self.told = None;
        ctx.request_screenshot(move |image| {
            let bytes = export::png(&image);
            let saved = bytes.and_then(|bytes| output::write(&path, &bytes));
            written.send(saved.map(|()| format!("Saved {}", file_name(&path)))).ok();
            wake();
        });
    }
}

/// Writes a text; what was written, in words.
fn put(path: &Path, text: &str) -> Written {
    output::write(path, text.as_bytes()).map(|()| format!("Saved {}", file_name(path)))
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
