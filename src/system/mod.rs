//! Threads, clocks and files of the machine; no other folder uses the standard library's own.

pub mod clock;
pub mod files;
mod sink;
pub mod threads;

pub use sink::{OpenError, Sink, is_regular, same_target, write_file};
