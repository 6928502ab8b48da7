//! Accessors of a model, and copies of it with another run.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::Model;
use super::excitation::ExcitationParts;
use super::scales::{MIN_IMPACT, Scales};
use super::stops::StopPair;
use super::transducer::{Circuit, CircuitState, Output};
use crate::dynamics::result::{MapState, Sample};
use crate::mechanics::{Hertz, Mechanism};
use crate::numeric::{DoubleDouble, Number, Scalar};
use crate::scene;

/// Where a run of a model begins. A model that continues a live run has this and all else from its scene.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Beginning {
    start: MapState,
    motionless: bool,
    /// Phase of each tone, and of the drive, in turns.
    phases: (Vec<f64>, f64),
}

/// Defines, for each of these fields, a method of [`Model`] that returns it.
macro_rules! accessors {
    ($($(#[$doc:meta])* $field:ident: $type:ty,)*) => {
        impl Model {
            $($(#[$doc])* pub fn $field(&self) -> $type {
                self.$field
            })*
        }
    };
}

accessors! {
    /// Proof mass in kg.
    mass: f64,
    /// Damping coefficient in N s/m of the mechanism alone.
    damping: f64,
    /// Electrical state at the start in A or V; 0 without one.
    start_electrical: f64,
    /// The stops; `None` if both sides are open.
    stops: Option<StopPair>,
    /// The contact law of the stops, if they are compliant.
    compliant: Option<Hertz>,
    /// Displacement in m and velocity in m/s at the start.
    start: (f64, f64),
    /// Duration in s.
    duration: f64,
    /// Start of the settled window in s.
    settle: f64,
    /// Period of the excitation in s, if it has one.
    forcing_period: Option<f64>,
    /// Length, speed and time to which the tolerance is relative.
    scales: Scales,
    /// Permitted local error, relative to the scales.
    tolerance: f64,
    /// Whether a run may be completed from a recurrence of its motion.
    recurrence: bool,
}

impl Model {
    /// Displacement in m at which crossings are counted: the barrier, or the equilibrium of a single well;
    /// `None` without one, and where no motion can pass it, since it lies on or beyond a rigid stop.
    pub fn crossing_level(&self) -> Option<f64> {
        let rigid = self.stops.filter(|_| self.compliant.is_none());
        self.crossing_level.filter(|level| rigid.is_none_or(|stops| stops.are_around(*level)))
    }

    /// Index of the piece of the force curve at `x` in m; on a stop that stands on a break of the curve, the
    /// piece on the side of the mass.
    pub(in crate::dynamics) fn piece_index(&self, x: f64) -> usize {
        let curve = &self.mechanism.curve;
        match self.stop_positions() {
            (Some(left), _) if left == x => curve.piece_beside(x, true),
            (_, Some(right)) if right == x => curve.piece_beside(x, false),
            _ => curve.piece_index(x),
        }
    }

    /// Damping coefficient in N s/m that acts on the motion, including that of a transducer without an
    /// electrical state.
    pub fn total_damping(&self) -> f64 {
        self.damping + self.transducer.map_or(0.0, |transducer| transducer.damping)
    }

    /// Logarithm of the factor by which damping and the circuit contract volumes of states in `time` s
    /// without impacts; it is negative.
    pub fn contraction(&self, time: f64) -> f64 {
        let by_circuit = self.circuit().map_or(0.0, |circuit| circuit.decay * time);
        -(self.total_damping() * time / self.mass + by_circuit)
    }

    /// The kind of the circuit's state; `None` without a circuit.
    pub fn circuit_state(&self) -> Option<CircuitState> {
        self.circuit().map(|circuit| match circuit.is_voltage {
            true => CircuitState::Voltage,
            false => CircuitState::Current,
        })
    }

    /// Unit in A or V of the state of the circuit whose energy is that of the mass at the velocity scale;
    /// `None` without a circuit.
    pub fn electrical_scale(&self) -> Option<f64> {
        self.circuit().map(|circuit| circuit.amount * self.scales.speed)
    }

    /// Whether the scene has a transducer.
    pub fn has_transducer(&self) -> bool {
        self.transducer.is_some()
    }

    /// The transducer as given in the scene.
    pub fn transducer(&self) -> scene::Transducer {
        self.transducer.map_or(scene::Transducer::None, |transducer| transducer.described)
    }

    /// Output of the transducer at a sample of the motion; `None` without a transducer.
    pub fn output(&self, sample: &Sample) -> Option<Output> {
        self.transducer.map(|transducer| transducer.output(sample.v, sample.electrical))
    }

    /// Whether the transducer has an electrical state, a current or a voltage, that is integrated with the
    /// motion.
    pub fn has_electrical_state(&self) -> bool {
        self.circuit().is_some()
    }

    /// Whether the circuit has no resistance, so that an open layer keeps its charge or a coil its flux:
    /// starts with different charges or fluxes have no attractor in common.
    pub fn keeps_charge(&self) -> bool {
        self.circuit().is_some_and(|circuit| circuit.decay == 0.0)
    }

    /// Explains why a circuit that is far faster than the motion makes the steps short, and how to model the
    /// scene without it; `None` if there is no such circuit.
    pub fn fast_circuit(&self) -> Option<String> {
        self.transducer.as_ref()?.fast_circuit(self.mass, self.scales.time)
    }

    /// The circuit of the transducer, if it has a state.
    pub(in crate::dynamics) fn circuit(&self) -> Option<&Circuit> {
        self.transducer.as_ref().and_then(|transducer| transducer.circuit.as_ref())
    }

    /// Energy in J that the transducer stores in this electrical state.
    pub(in crate::dynamics) fn electrical_energy(&self, electrical: f64) -> f64 {
        self.circuit().map_or(0.0, |circuit| 0.5 * self.mass * circuit.state(electrical).powi(2))
    }

    /// The electrical state of this model when it takes over from another one in the state `electrical`.
    pub(in crate::dynamics) fn electrical_after(&self, before: &Self, electrical: f64) -> f64 {
        let pair = self.transducer.as_ref().zip(before.transducer.as_ref());
        pair.map_or(0.0, |(present, previous)| present.electrical_after(previous, electrical))
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &Arc<Mechanism> {
        &self.mechanism
    }

    /// The excitation.
    #[doc(hidden)]
    pub fn excitation(&self) -> &ExcitationParts {
        &self.excitation
    }

    /// Phase of the drive at a time in s, in turns: the argument of its sine or cosine, or for a sum the
    /// fraction of the common period since the start. `None` if the drive does not repeat.
    pub fn drive_phase(&self, t: f64) -> Option<f64> {
        let frequency = self.excitation.fastest().filter(|_| self.repeats())?;
        let cycles = DoubleDouble::of(self.window_periods().1 as f64);
        let turns = DoubleDouble::product(t, frequency) / cycles + DoubleDouble::of(self.start_phase);
        let share = (turns - turns.floor()).to_f64();
        Some(if share < 1.0 { share } else { 0.0 })
    }

    /// The speed in m/s above which an impact is counted. A chatter has infinitely many impacts, and how many
    /// of the slower ones are computed one by one depends on the tolerance.
    pub fn min_impact_speed(&self) -> f64 {
        MIN_IMPACT * self.scales.speed
    }

    /// The same model with another tolerance.
    pub fn with_tolerance(&self, tolerance: f64) -> Self {
        Self { tolerance, ..self.clone() }
    }

    /// The same model, with the same scales, from another start: displacement in m and velocity in m/s.
    /// Precondition: the start lies in the curve and between the stops.
    pub fn with_start(&self, start: impl Into<MapState>) -> Self {
        let MapState { x, v, electrical } = start.into();
        Self { start: (x, v), start_electrical: electrical, motionless: false, ..self.clone() }
    }

    /// Where its runs begin.
    #[doc(hidden)]
    pub fn beginning(&self) -> Beginning {
        let start = MapState { x: self.start.0, v: self.start.1, electrical: self.start_electrical };
        let phases = self.excitation.tones.iter().map(|tone| tone.phase).collect();
        Beginning { start, motionless: self.motionless, phases: (phases, self.start_phase) }
    }

    /// The model of the same scene whose runs begin as those of another one.
    #[must_use]
    #[doc(hidden)]
    pub fn begun_at(&self, beginning: &Beginning) -> Self {
        let Beginning { start, motionless, phases } = beginning;
        let mut model = Self { motionless: *motionless, start_phase: phases.1, ..self.with_start(*start) };
        for (tone, phase) in model.excitation.tones.iter_mut().zip(&phases.0) {
            tone.phase = *phase;
        }
        model
    }

    /// The same model without stops.
    pub fn without_stops(&self) -> Self {
        Self { stops: None, compliant: None, ..self.clone() }
    }

    /// The same model, which counts a crossing at another displacement in m than the barrier.
    pub fn with_crossing_level(&self, level: f64) -> Self {
        Self { crossing_level: Some(level), ..self.clone() }
    }

    /// The same model with recurrence on or off.
    pub fn with_recurrence(&self, recurrence: bool) -> Self {
        Self { recurrence, ..self.clone() }
    }

    /// The same model with a run of another duration in s, whose settled window begins at `settle` in s.
    pub fn with_duration(&self, duration: f64, settle: f64) -> Self {
        Self { duration, settle, ..self.clone() }
    }

    /// The same model, continuing from a state of a run of `before`, as in
    /// [`Run::carried`](crate::dynamics::Run::carried). A stop of this model that lies on the other side of
    /// the mass carries it along and takes its speed, as does the end of the known curve. A current continues
    /// as a current and a voltage as a voltage.
    #[must_use]
    pub fn carried_on(mut self, before: &Self, state: impl Into<MapState>) -> Self {
        let MapState { x, v, electrical } = state.into();
        let pressed = before.compliant.and(self.compliant).and_then(|_| before.pressed_depth(x));
        self.start = self.held_within((x, v), pressed.map_or(0.0, |(depth, _)| depth));
        self.start_electrical = self.electrical_after(before, electrical);
        self.motionless = false;
        self
    }

    /// Moves a state to between the stops, or up to `depth` into them, and into the known curve. A mass that
    /// has to be moved loses its speed.
    #[doc(hidden)]
    pub fn held_within(&self, (x, v): (f64, f64), depth: f64) -> (f64, f64) {
        let domain = self.mechanism.curve.domain();
        let (left, right) = self.stop_positions();
        let low = left.map_or(domain.0, |stop| (stop - depth).max(domain.0));
        let high = right.map_or(domain.1, |stop| (stop + depth).min(domain.1));
        if !(x <= high) {
            (high, 0.0)
        } else if x < low {
            (low, 0.0)
        } else {
            (x, v)
        }
    }
}
