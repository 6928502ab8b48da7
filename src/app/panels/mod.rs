//! Panels around the views: controls, status line, transport bar, notes, first-minute hint, lessons.

mod advanced;
pub mod best_stops;
pub mod controls;
mod fields;
mod geometry;
pub(super) mod glossary;
pub(super) mod hint;
pub(super) mod lecturer;
pub(super) mod lesson;
pub(super) mod notes;
pub(super) mod status_line;
pub mod transport;
