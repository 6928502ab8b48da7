//! What can be read of a model, and models that differ from it in their run alone.

use std::sync::Arc;

use super::Model;
use super::excitation::ExcitationParts;
use super::scales::Scales;
use super::stops::StopPair;
use crate::mechanics::{Hertz, Mechanism};

impl Model {
    /// Proof mass in kg.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Damping coefficient in N s/m.
    pub fn damping(&self) -> f64 {
        self.damping
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &Arc<Mechanism> {
        &self.mechanism
    }

    /// The stops; none where both sides are open.
    pub fn stops(&self) -> Option<StopPair> {
        self.stops
    }

    /// What the stops are made of, where they are compliant.
    pub fn compliant(&self) -> Option<Hertz> {
        self.compliant
    }

    /// The excitation.
    pub fn excitation(&self) -> &ExcitationParts {
        &self.excitation
    }

    /// Displacement in m and velocity in m/s at the start.
    pub fn start(&self) -> (f64, f64) {
        self.start
    }

    /// Displacement in m at which crossings are counted, where the mechanism has a barrier.
    pub fn crossing_level(&self) -> Option<f64> {
        self.crossing_level
    }

    /// Duration in s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Begin of the settled window in s.
    pub fn settle(&self) -> f64 {
        self.settle
    }

    /// Period of the excitation in s, where it has one.
    pub fn forcing_period(&self) -> Option<f64> {
        self.forcing_period
    }

    /// Length, speed and time that the tolerance is relative to.
    pub fn scales(&self) -> Scales {
        self.scales
    }

    /// Local error allowed, relative to the scales.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Whether a run may be completed from a recurrence of its motion.
    pub fn recurrence(&self) -> bool {
        self.recurrence
    }

    /// The same model run at another tolerance.
    pub fn with_tolerance(&self, tolerance: f64) -> Self {
        Self { tolerance, ..self.clone() }
    }

    /// The same model with another start, displacement in m and velocity in m/s, and the scales that it has.
    /// Precondition: the start lies in the curve and between the stops.
    pub fn with_start(&self, start: (f64, f64)) -> Self {
        Self { start, motionless: false, ..self.clone() }
    }

    /// The same model with recurrence on or off.
    pub fn with_recurrence(&self, recurrence: bool) -> Self {
        Self { recurrence, ..self.clone() }
    }

    /// The same model with a run of another duration in s, whose settled window begins at `settle` in s.
    pub fn with_duration(&self, duration: f64, settle: f64) -> Self {
        Self { duration, settle, ..self.clone() }
    }
}
