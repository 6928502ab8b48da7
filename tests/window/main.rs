//! The window without a display: what is seen, pressed and dragged, and what that does to the scene and its
//! motion.

mod accuracy;
mod advanced;
mod background;
mod beside;
mod compare;
mod cursors;
mod documents;
mod events;
mod explore;
mod figures;
mod first_minute;
mod flexures;
mod frame;
mod guidance;
mod keyboard;
mod lesson_window;
mod lessons;
mod map;
mod map_looks;
mod measured;
mod memory;
mod newcomer;
mod past;
mod power;
mod quiet;
mod random;
mod screen;
mod sentences;
mod session;
#[path = "../shared/mod.rs"]
mod shared;
mod support;
mod typing;
mod views;
mod written;
