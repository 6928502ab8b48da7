//! Mathematics that knows no mechanics.
