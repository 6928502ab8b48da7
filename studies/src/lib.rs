//! Studies of scenes, their result tables, and the output of these tables as files and pictures: the base of
//! the command line and the window of interwell.
//!
//! It is a separate crate so that a change in the window does not recompile the studies. Programs use the
//! crate `interwell`, which re-exports [`questions`] and [`output`]. The studies themselves, which the
//! questions ask, are for the command line, the window and the tests of this workspace.

// Tests compare with the functions of std.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

// Examples in the documentation find all layers in one crate, as programs do in `interwell`.
#[doc(hidden)]
pub use interwell_kernel::{dynamics, mechanics, numeric, scene, system};

pub mod output;
#[macro_use]
#[doc(hidden)]
pub mod study;
mod accuracy;
mod basins;
mod best;
mod compare;
mod curve;
mod distance;
mod escape;
mod exponents;
mod identify;
mod lesson;
mod orbit;
pub mod questions;
mod section;
mod simulate;
mod spectrum;
mod sweep;
mod threshold;
