//! The window: views of a scene, and the controls that change it.
//!
//! No physics is computed here. [`session`] holds the open scene with undo, its live motion and the answers
//! to background questions, and works without a window; the other modules draw it. A view is a function of
//! a [`views::ViewContext`].
//!
//! `docs/architecture.md` says what each module holds. They come in an order, `task`, `words`, `session`,
//! `export`, `ui`, `panels`, `views`, `window`, `desktop`, and each uses only those before it, which
//! `tests/suite/layers.rs` checks. A web page has no `desktop`: the crate `interwell-web` calls [`begin`].

#[cfg(not(target_arch = "wasm32"))]
mod desktop;
pub mod export;
pub mod panels;
pub mod session;
pub mod task;
pub mod ui;
pub mod views;
pub mod window;
pub mod words;

use std::sync::Arc;

#[cfg(not(target_arch = "wasm32"))]
pub use desktop::{AppError, run};
pub use session::CannotRun;
use ui::settings::Settings;
use window::Window;

/// The window on a scene, with what was kept from the last time; the first time it is `dark` or light. If the
/// scene cannot be run, the window says why and opens on the first preset.
pub fn begin(
    creation: &eframe::CreationContext<'_>,
    spec: Option<&str>,
    dark: bool,
) -> Result<Window, CannotRun> {
    window::prepare(&creation.egui_ctx);
    let kept = creation.storage.and_then(|storage| eframe::get_value(storage, eframe::APP_KEY));
    let ctx = creation.egui_ctx.clone();
    let settings = kept.unwrap_or(Settings { dark, ..Settings::default() });
    let mut window = Window::start(spec, settings, Arc::new(move || ctx.request_repaint()))?;
    if let Some(storage) = creation.storage {
        window.restore(storage);
    }
    window.remember_file();
    Ok(window)
}
