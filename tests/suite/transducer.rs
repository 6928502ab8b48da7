//! Transducers: power, damping, states of their own and limits against exact answers.

mod circuit;
mod known;
mod live;
mod refused;
mod resistive;
mod rest;
