//! Start of the program on a desktop: the display, the window of the system, and what keeps it from opening.

mod start;

use std::sync::Arc;

use eframe::egui;

use super::ui::settings::Settings;
use super::window::{Window, begin};
use crate::questions::Error;

/// Why no window can be opened.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// The scene cannot be run.
    #[error(transparent)]
    Scene(#[from] Error),
    /// The machine has no display, or lacks a library or usable graphics.
    #[error(
        "no window can be opened: {0}; or work without one by interwell --headless, see interwell --help"
    )]
    NoWindow(String),
}

/// Opens the window on a scene, and returns when it is closed. If the scene cannot be run, the reason is
/// passed to `refused` before the window opens; the window shows it too, and opens on the first preset.
pub fn run(spec: Option<&str>, refused: impl FnOnce(Error)) -> Result<(), AppError> {
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
    // nothing in the window has a gradient that needs dithering, which is slow where the processor paints
    let dithering = false;
    let options = eframe::NativeOptions { viewport, dithering, ..eframe::NativeOptions::default() };
    let spec = spec.map(str::to_owned);
    let started = start::Started::default();
    let begun = started.clone();
    let start = move |creation: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        begun.now();
        let window = begin(creation, spec.as_deref(), false)?;
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

/// Whether the environment names a display; on macOS and outside Unix one is assumed.
fn has_display() -> bool {
    let unix = cfg!(all(unix, not(target_os = "macos")));
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !unix || ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(set)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_icon_is_a_picture() {
        assert_eq!((icon().width, icon().height), (128, 128));
    }
}
