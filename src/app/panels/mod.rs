//! Panels around the views: controls, status line, transport, notes and the hints of the first minute.

mod advanced;
pub mod controls;
mod fields;
mod geometry;
pub(super) mod hint;
pub(super) mod notes;
pub(super) mod status_line;
pub mod transport;
