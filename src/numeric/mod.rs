//! Mathematics that knows no mechanics.

pub mod fit;
pub mod real_roots;
