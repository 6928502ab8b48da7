//! Studies of scenes, their tables, and the files and pictures that these become: what the command line and
//! the window of interwell show.
//!
//! It is a crate of its own so that a change of the window compiles no study. Programs use it by the crate
//! `interwell`, which shows its modules as its own.

pub(crate) use interwell_kernel::{dynamics, mechanics, numeric, scene, system};

pub mod output;
#[macro_use]
pub mod study;
pub mod questions;
