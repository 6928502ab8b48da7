//! Scenes, mechanisms and the integrator: the base of the studies, the command line and the window of
//! interwell.
//!
//! It is a separate crate so that a change in the studies or the window does not recompile the integrator.
//! Programs use the crate `interwell`, which re-exports these modules and describes each layer.

// Tests compare with the functions of std.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod dynamics;
pub mod mechanics;
pub mod numeric;
pub mod scene;
pub mod system;
