//! Bistable mechanisms with hard travel limits.

pub mod dynamics;
pub mod mechanics;
pub mod numeric;
pub mod output;
pub mod scene;
pub mod study;
