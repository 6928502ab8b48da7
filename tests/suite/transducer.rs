//! Transducers: power, damping, states of their own and limits against exact answers.

mod circuit;
mod fast;
mod known;
mod live;
mod refused;
mod resistive;
mod rest;
