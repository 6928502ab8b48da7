//! The file dialog of the system, or of a web page.

use std::path::PathBuf;

use crate::app::task::{Background, Wake};

use super::wanted::{Chosen, Wanted};

/// What a file dialog offers.
#[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "a page has no folders"))]
pub(super) struct Choice {
    pub wanted: Wanted,
    /// The kind of the files, and the endings of their names, the usual one first.
    pub kind: &'static str,
    pub endings: Vec<String>,
    /// The name of a file that is to be written.
    pub name: String,
    pub folder: Option<PathBuf>,
    /// The path to begin with where the desktop has no dialog.
    pub start: PathBuf,
}

#[cfg(not(target_arch = "wasm32"))]
impl Choice {
    /// Time in ms below which a dialog that is closed again has not been visible.
    const UNSEEN: u128 = 300;

    /// Asks for a path.
    pub fn ask(self, dialog: &mut Background<(), Chosen>, wake: &Wake) {
        use crate::system::clock::WallClock;
        use crate::system::files;

        let Self { wanted, kind, endings, name, folder, start } = self;
        dialog.ask_job((), wake, move |(), _, _| {
            let mut dialog = rfd::FileDialog::new().add_filter(kind, &endings);
            if let Some(folder) = folder.filter(|folder| files::is_folder(folder)) {
                dialog = dialog.set_directory(folder);
            }
            let since = WallClock::start();
            let chosen =
                if wanted.is_read() { dialog.pick_file() } else { dialog.set_file_name(name).save_file() };
            let Some(mut path) = chosen else {
                let is_unseen = since.elapsed().as_millis() < Self::UNSEEN;
                return is_unseen.then_some(Chosen::NoDialog(wanted, start));
            };
            if !wanted.is_read() && path.extension().is_none() {
                path.set_extension(&endings[0]);
            }
            Some(Chosen::File(wanted, path))
        });
    }
}

#[cfg(target_arch = "wasm32")]
impl Choice {
    /// Asks for a file that is read; one that is written is a download.
    pub fn ask(self, dialog: &mut Background<(), Chosen>, wake: &Wake) {
        use crate::system::page;

        let Self { wanted, kind, endings, name, .. } = self;
        if !wanted.is_read() {
            return dialog.ask_job((), wake, move |(), _, _| Some(Chosen::File(wanted, name.into())));
        }
        dialog.ask_page((), wake, move |answer| {
            wasm_bindgen_futures::spawn_local(async move {
                let dialog = rfd::AsyncFileDialog::new().add_filter(kind, &endings);
                let Some(file) = dialog.pick_file().await else { return answer(None) };
                let name = file.file_name();
                let buffer = wasm_bindgen_futures::JsFuture::from(file.inner().array_buffer()).await;
                answer(Some(match buffer {
                    Ok(buffer) => {
                        let bytes = js_sys::Uint8Array::new(&buffer).to_vec();
                        Chosen::File(wanted, page::keep(&name, bytes))
                    }
                    Err(_) => Chosen::Refused(unreadable(&name)),
                }));
            });
        });
    }
}

#[cfg(target_arch = "wasm32")]
fn unreadable(name: &str) -> String {
    format!("The browser cannot read {name}: it may have been moved or changed since. Choose it again.")
}

/// Reads files that were dropped on the page, and chooses the scene or lesson among them, or else the first.
#[cfg(target_arch = "wasm32")]
pub(super) fn read_dropped(
    files: Vec<eframe::egui::DroppedFileHandle>,
    dialog: &mut Background<(), Chosen>,
    wake: &Wake,
) {
    use crate::system::page;

    dialog.ask_page((), wake, move |answer| {
        wasm_bindgen_futures::spawn_local(async move {
            let mut paths = Vec::new();
            for file in files {
                let name = file.path().to_string_lossy().into_owned();
                match file.bytes_async().await {
                    Ok(bytes) => paths.push(page::keep(&name, bytes)),
                    Err(_) => return answer(Some(Chosen::Refused(unreadable(&name)))),
                }
            }
            let mut scenes =
                paths.iter().filter(|path| path.extension().is_some_and(|ending| ending == "ron"));
            let (scene, another) = (scenes.next(), scenes.next());
            let chosen = scene.or(paths.first()).cloned().map(Chosen::Dropped);
            answer(match another {
                Some(_) => Some(Chosen::Refused("Drop one scene or lesson at a time.".to_owned())),
                None => chosen,
            });
        });
    });
}
