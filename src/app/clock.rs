//! The clock of the machine: the only place of the window that asks for the time.

pub use std::time::Instant;
