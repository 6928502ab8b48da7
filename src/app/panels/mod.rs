//! Panels around the views: controls, status line, transport bar, notes, first-minute hint, lessons.

mod advanced;
pub mod controls;
pub(super) mod hint;
pub(super) mod lesson;
mod lesson_options;
pub(super) mod notes;
pub(super) mod status_line;
pub mod transport;
