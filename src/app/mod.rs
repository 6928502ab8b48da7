//! The window: views of a scene, and the controls that change it.
//!
//! No physics is computed here. [`session`] holds the open scene with undo, its live motion and the answers
//! to background questions, and works without a window; the other modules draw it. A view is a function of
//! a [`views::ViewContext`].
//!
//! `docs/architecture.md` says what each module holds. They come in an order, `task`, `words`, `session`,
//! `export`, `ui`, `panels`, `views`, `window`, and each uses only those before it, which
//! `tests/suite/layers.rs` checks.

pub mod export;
pub mod panels;
pub mod session;
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
    /// The machine has no display or no usable graphics.
    #[error(
        "no window can be opened ({0}); without a display use interwell --headless, see interwell --help"
    )]
    NoWindow(String),
}

/// Opens the window on a scene, and returns when it is closed. If the scene cannot be run, the reason is
/// passed to `refused` before the window opens; the window shows it too, and opens on the first preset.
pub fn run(spec: Option<&str>, refused: impl FnOnce(CannotRun)) -> Result<(), AppError> {
    let opened = Window::open(spec, Settings::default(), Arc::new(|| ())).map(drop);
    if !has_display() {
        opened?;
        return Err(AppError::NoWindow("neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned()));
    }
    opened.unwrap_or_else(refused);
    let viewport = egui::ViewportBuilder::default()
        .with_title("interwell")
        .with_app_id("interwell")
        .with_inner_size([1280.0, 720.0])
        .with_min_inner_size([640.0, 400.0]);
    // no gradients are drawn that would need it, and it costs a processor that paints much of its time
    let dithering = false;
    let options = eframe::NativeOptions { viewport, dithering, ..eframe::NativeOptions::default() };
    let spec = spec.map(str::to_owned);
    let start = move |creation: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
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
    eframe::run_native("interwell", options, Box::new(start)).map_err(|error| {
        let text = error.to_string();
        AppError::NoWindow(text.lines().next().unwrap_or_default().to_owned())
    })
}

/// Whether there is a display; assumed where the environment does not tell (outside Unix, and on macOS).
fn has_display() -> bool {
    let unix = cfg!(all(unix, not(target_os = "macos")));
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !unix || ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(set)
}
