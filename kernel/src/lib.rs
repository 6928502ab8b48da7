//! Scenes, mechanisms and their motion: what the studies, the command line and the window of interwell use.
//!
//! It is a crate of its own so that a change above it compiles no integrator. Programs use it by the crate
//! `interwell`, which shows its modules as its own and says what each layer holds.

pub mod dynamics;
pub mod mechanics;
pub mod numeric;
pub mod scene;
pub mod system;
