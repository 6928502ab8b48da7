//! The window without a display: what is seen, pressed and dragged, and what that does to the scene and its motion.

mod first_minute;
mod map;
mod sentences;
mod support;
