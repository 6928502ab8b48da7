//! The studies as an API for programs.
//!
//! A [`Simulation`] is a checked scene with its model. Each question is a struct of options with a method
//! `run`, which takes a simulation and, unless it is short, a [`Progress`]. It returns tables in SI units, or
//! an [`Error`] that lists all faults.

mod design;
mod error;
mod grid;
mod motion;
mod progress;
mod record;
mod simulation;

pub use design::{Best, BestAnswer, Compare, in_environment, needs_a_sine};
pub use error::{Error, FaultAt, check_until_settled};
pub use grid::{Exponents, Section, Sweep, Threshold, column_names, drive_alone, refuse_electrical_state};
pub use motion::{Basins, BasinsAnswer, Branch, Curve, Orbit, Spectrum, can_have_orbits, no_orbit};
pub use progress::Progress;
pub use record::{Identify, IdentifyAnswer, WhatToIdentify, columns_read};
pub use simulation::{Recorded, Simulation};

pub use crate::study::{
    Answer, BestDesign, BestQuestion, Carry, Column, EvenRange, ExponentOptions, Grid, Identified, Onset,
    Rated, Sampling, SectionAt, SectionOptions, Signal, Table, Values,
};
