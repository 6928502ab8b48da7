//! The machine that the program runs on: threads, clocks and files, which nothing else names.

pub mod clock;
pub mod files;
mod sink;
pub mod threads;

pub use sink::{OpenError, Sink, is_regular, same_target, write};
