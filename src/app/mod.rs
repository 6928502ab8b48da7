//! The window: views of a scene, and the controls that change it.
//!
//! No physics is computed here. [`session`] holds the open scene with undo, its live motion and the answers
//! to background questions, and works without a window; the other modules draw it. A view is a function of
//! a [`views::ViewContext`].
//!
//! `docs/architecture.md` says what each module holds. They come in an order, `start`, `task`, `words`,
//! `session`, `export`, `ui`, `panels`, `views`, `window`, and each uses only those before it, which
//! `tests/suite/layers.rs` checks.

pub mod export;
pub mod panels;
pub mod session;
mod start;
pub mod task;
pub mod ui;
pub mod views;
pub mod window;
pub mod words;

use std::sync::Arc;

use eframe::egui;

pub use session::CannotRun;
use ui::settings::Settings;
use window::Window;

/// Why no window can be opened.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// The scene cannot be run.
    #[error(transparent)]
    Scene(#[from] CannotRun),
    /// The machine has no display, or lacks a library or usable graphics.
    #[error(
        "no window can be opened: {0}; or work without one by interwell --headless, see interwell --help"
    )]
    NoWindow(String),
}

/// Opens the window on a scene, and returns when it is closed. If the scene cannot be run, the reason is
/// passed to `refused` before the window opens; the window shows it too, and opens on the first preset.
pub fn run(spec: Option<&str>, refused: impl FnOnce(CannotRun)) -> Result<(), AppError> {
    let opened = Window::open(spec, Settings::default(), Arc::new(|| ())).map(drop);
    if !has_display() {
        opened?;
        return Err(AppError::NoWindow(start::NO_DISPLAY.to_owned()));
    }
    opened.unwrap_or_else(refused);
    let viewport = egui::ViewportBuilder::default()
        .with_title("interwell")
        .with_app_id("interwell")
        .with_icon(icon())
        .with_inner_size([1280.0, 720.0])
        .with_min_inner_size([640.0, 400.0]);
    // no gradients are drawn that would need it, and it costs a processor that paints much of its time
    let dithering = false;
    let options = eframe::NativeOptions { viewport, dithering, ..eframe::NativeOptions::default() };
    let spec = spec.map(str::to_owned);
    let started = start::Started::default();
    let begun = started.clone();
    let start = move |creation: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        begun.now();
        window::prepare(&creation.egui_ctx);
        let settings = creation
            .storage
            .and_then(|storage| eframe::get_value(storage, eframe::APP_KEY))
            .unwrap_or_default();
        let ctx = creation.egui_ctx.clone();
        let wake = Arc::new(move || ctx.request_repaint());
        let mut window = Window::start(spec.as_deref(), settings, wake)?;
        if let Some(storage) = creation.storage {
            window.restore(storage);
        }
        window.remember_file();
        Ok(Box::new(window))
    };
    started
        .guard(|| {
            eframe::run_native("interwell", options, Box::new(start)).map_err(|error| error.to_string())
        })
        .map_err(|reason| AppError::NoWindow(start::remedy(&reason)))
}

/// The drawing of `packaging/icon.svg`.
fn icon() -> egui::IconData {
    eframe::icon_data::from_png_bytes(include_bytes!("../../assets/icon.png")).unwrap_or_default()
}

/// Whether there is a display; assumed where the environment does not tell (outside Unix, and on macOS).
fn has_display() -> bool {
    let unix = cfg!(all(unix, not(target_os = "macos")));
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !unix || ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(set)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_icon_is_a_picture() {
        assert_eq!((super::icon().width, super::icon().height), (128, 128));
    }
}
