//! What keeps the window from opening, as a sentence with a remedy.

use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

pub const NO_DISPLAY: &str =
    "neither DISPLAY nor WAYLAND_DISPLAY is set: start it on a desktop or through ssh -X";

/// Parts of the error messages of the crates below, each with a cause and a remedy; the first match counts.
const REMEDIES: &[(&str, &str)] = &[
    (
        "libxkbcommon",
        "a library for the keyboard is missing: install libxkbcommon-x11 (on Debian libxkbcommon-x11-0)",
    ),
    (
        "xlib's shared libraries",
        "a library of X11 is missing: install libX11, libX11-xcb, libXcursor and libXi (on Debian libx11-6, \
         libx11-xcb1, libxcursor1 and libxi6)",
    ),
    ("connection to X server", "the display that DISPLAY names does not answer: name one that does"),
    (
        "wayland compositor",
        "the display that WAYLAND_DISPLAY names does not answer: unset it to use the one of DISPLAY",
    ),
    (
        "wayland library",
        "the library of Wayland is missing: install libwayland-client (on Debian libwayland-client0)",
    ),
    ("glutin", NO_OPENGL),
    ("OpenGL", NO_OPENGL),
    ("egui_glow", NO_OPENGL),
];

const NO_OPENGL: &str = "there is no usable OpenGL: install the driver of the graphics card, or Mesa, which \
                         needs no card (on Debian libgl1)";

/// Whether the window has come up: from then on a panic is a fault of this program and is shown as such. The
/// crates below panic where a library is missing.
#[derive(Clone, Default)]
pub struct Started(Arc<AtomicBool>);

impl Started {
    pub fn now(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    fn has(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Runs the window; a panic before it has come up is returned as an error.
    pub fn guard(&self, run: impl FnOnce() -> Result<(), String>) -> Result<(), String> {
        let reason = Arc::new(Mutex::new(String::new()));
        let usual = Arc::new(panic::take_hook());
        let (started, kept, before) = (self.clone(), reason.clone(), usual.clone());
        panic::set_hook(Box::new(move |info| {
            if started.has() {
                before(info);
            } else if let Some(text) = info.payload_as_str() {
                text.clone_into(&mut kept.lock().unwrap_or_else(PoisonError::into_inner));
            }
        }));
        let ended = panic::catch_unwind(AssertUnwindSafe(run));
        panic::set_hook(Box::new(move |info| usual(info)));
        match ended {
            Ok(result) => result,
            Err(panic) if self.has() => panic::resume_unwind(panic),
            Err(_) => Err(reason.lock().unwrap_or_else(PoisonError::into_inner).clone()),
        }
    }
}

/// The cause and the remedy of an error message, or its first line if neither is known.
pub fn remedy(reason: &str) -> String {
    let known = REMEDIES.iter().find(|(words, _)| reason.contains(words));
    let first = || reason.lines().next().unwrap_or_default().trim_end_matches('.');
    known.map_or_else(|| first().to_owned(), |(_, remedy)| (*remedy).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_before_the_window_is_a_reason_and_one_after_it_stays_a_panic() {
        let before = Started::default();
        assert_eq!(before.guard(|| panic!("no {}", "library")), Err("no library".to_owned()));
        assert_eq!(before.guard(|| Err("no display".to_owned())), Err("no display".to_owned()));
        let started = Started::default();
        let run = || {
            started.guard(|| {
                started.now();
                panic::resume_unwind(Box::new("a fault"))
            })
        };
        assert!(panic::catch_unwind(AssertUnwindSafe(run)).is_err());
    }

    #[test]
    fn what_is_missing_is_named_with_its_package() {
        for (reason, word) in [
            ("Library libxkbcommon-x11.so could not be loaded.", "libxkbcommon-x11-0"),
            (
                "winit EventLoopError: os error at a.rs:1: Failed to load one of xlib's shared libraries",
                "libxi6",
            ),
            ("winit EventLoopError: os error at a.rs:1: Failed to open connection to X server", "DISPLAY"),
            ("winit EventLoopError: os error at a.rs:1: Could not find wayland compositor", "unset"),
            ("Found no glutin configs matching the template: ..", "libgl1"),
            ("glutin error: [a7] GLXBadFBConfig", "libgl1"),
            ("something else.\nmore", "something else"),
        ] {
            let text = remedy(reason);
            assert!(text.contains(word) && text.lines().count() == 1, "{text}");
        }
    }
}
