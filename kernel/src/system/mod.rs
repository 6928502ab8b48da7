//! Access to threads, clocks and files of the machine; no other folder uses those of the standard library.

pub mod checksum;
pub mod clock;
pub mod files;
mod journal;
mod part;
mod sink;
pub mod threads;

pub use journal::Block;
pub use part::{Opened, Part, PartError};
pub use sink::{OpenError, Sink, is_regular, same_target, write_file};
