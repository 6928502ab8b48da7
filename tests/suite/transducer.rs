//! Transducers: power, damping and limits against exact answers.

mod resistive;
