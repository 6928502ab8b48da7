//! The scene as run: SI units, checked, everything the integrator needs.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::result::Run;
use crate::mechanics::Mechanism;
use crate::scene::{Fault, Scene};

/// A scene as run.
#[derive(Debug, Clone)]
pub struct Model {
    /// Proof mass in kg.
    pub mass: f64,
    /// Damping coefficient in N s/m.
    pub damping: f64,
    /// The mechanism, shared between the cells of a sweep.
    pub mechanism: Arc<Mechanism>,
    /// Duration in s.
    pub duration: f64,
    /// Period of the drive in s, where it has one.
    pub forcing_period: Option<f64>,
    // the rest is private to dynamics
}

/// What a run should keep.
#[derive(Debug, Clone, Copy, Default)]
pub struct Request<'a> {
    /// Times in s at which to sample, ascending, within 0..=duration.
    pub sample_times: &'a [f64],
    /// Whether to keep the list of events.
    pub events: bool,
    /// Whether to keep the energy ledger (a sweep does not need it).
    pub ledger: bool,
    /// Set from elsewhere to end the run early with the outcome `Cancelled`.
    pub cancel: Option<&'a AtomicBool>,
}

impl Model {
    /// Converts a scene that has passed its check; faults that only show here (no equilibrium to rest
    /// at, a ratio without a stable equilibrium, a start beyond a stop) are all reported.
    pub fn build(scene: &Scene, mechanism: Arc<Mechanism>) -> Result<Self, Vec<Fault>> {
        let _ = (scene, mechanism);
        todo!("dynamics")
    }

    /// Runs the model once.
    pub fn run(&self, request: &Request) -> Run {
        let _ = request;
        todo!("dynamics")
    }

    /// Acceleration of the base in m/s^2 at time `t` in s.
    pub fn base_acceleration(&self, t: f64) -> f64 {
        let _ = t;
        todo!("dynamics")
    }

    /// The model in words: a line for each thing that is modelled, then what is left out.
    pub fn describe(&self) -> Vec<String> {
        todo!("dynamics")
    }
}
