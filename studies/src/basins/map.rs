//! A map of basins: how starts are followed.

use std::sync::Arc;

use super::rounds::{PATIENCE, Rounds};
use super::{Starts, sure};
use crate::dynamics::{Model, Request};
use crate::mechanics::Mechanism;
use crate::scene::{Damping, Excitation, Fault, Scene, Start, Stops};
use crate::study::{Levels, STRIDES};

/// Why a scene has no basins.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoBasins {
    /// The scene is wrong.
    #[error("the scene is wrong")]
    Faults(Vec<Fault>),
    /// Its drive does not repeat.
    #[error(
        "its excitation does not repeat, so there is no state once a period to compare; take a Sine, a Sum \
         of sines whose frequencies have a common period, or None"
    )]
    NoPeriod,
    /// It loses no energy.
    #[error(
        "it has no damping, no transducer and no stop that takes energy, so that no motion attracts others; \
         set damping, such as damping=Ratio(0.02)"
    )]
    NoLoss,
    /// Its circuit keeps its charge.
    #[error(
        "transducer: a circuit without resistance keeps its charge or flux, so that each start has motions \
         of its own; give it a finite load, or the layer as a spring (Sum with Linear)"
    )]
    KeepsCharge,
    /// No start lies between the limits of displacement.
    #[error("all starts lie beyond {what} at {at_mm} mm; start between {from_mm} and {to_mm} mm")]
    Beyond {
        /// `the left stop`, or `the end of the force curve`.
        what: &'static str,
        /// Its position in mm.
        at_mm: f64,
        /// Smallest possible displacement in mm.
        from_mm: f64,
        /// Largest possible displacement in mm.
        to_mm: f64,
    },
}

/// Number of small oscillations over which the cost of a forcing period is measured.
const MEASURED: f64 = 300.0;

/// A map of basins, computed from coarse to fine.
#[derive(Debug)]
pub struct BasinMap {
    pub(super) model: Model,
    pub(super) starts: Starts,
    pub(super) levels: Levels,
    /// Number of levels that have been run.
    pub(super) done: usize,
    pub(super) room: (f64, f64),
    pub(super) rounds: Rounds,
    /// Units of work that a forcing period takes.
    pub(super) work_of_a_period: f64,
    /// The model at a finer tolerance, if the answers are to be checked.
    pub(super) finer: Option<Model>,
}

impl BasinMap {
    /// Number of forcing periods after which a motion that has reached no known attractor is classified.
    pub const PATIENCE: u64 = PATIENCE;

    /// The map of a scene over these starts, before any run; of the start of the scene only the state of a
    /// circuit is taken. States are taken once per forcing period or, without a drive, once per period of
    /// small oscillations.
    pub fn new(scene: &Scene, mechanism: Arc<Mechanism>, starts: Starts) -> Result<Self, NoBasins> {
        if !loses_energy(scene) {
            return Err(NoBasins::NoLoss);
        }
        let electrical = if let Start::At { electrical, .. } = scene.start { electrical } else { 0.0 };
        let at_rest = |excitation: &Excitation| {
            let (left, right) = mechanism.curve.domain();
            let [left_stop, right_stop] = scene.stops.positions_mm();
            let left = left_stop.map_or(left * 1e3, |stop| stop.max(left * 1e3));
            let right = right_stop.map_or(right * 1e3, |stop| stop.min(right * 1e3));
            let start = Start::At { x_mm: 0.0_f64.max(left).min(right), v_m_per_s: 0.0, electrical };
            let scene = Scene { start, excitation: excitation.clone(), ..scene.clone() };
            Model::build(&scene, Arc::clone(&mechanism)).map_err(NoBasins::Faults)
        };
        let mut model = at_rest(&scene.excitation)?;
        if let Some(excitation) = shaken(scene, &model) {
            model = at_rest(&excitation)?;
        }
        if !model.repeats() {
            return Err(NoBasins::NoPeriod);
        }
        if model.keeps_charge() {
            return Err(NoBasins::KeepsCharge);
        }
        let stops = model.stop_positions();
        let (left, right) = mechanism.curve.domain();
        let room = (stops.0.unwrap_or(left).max(left), stops.1.unwrap_or(right).min(right));
        let (levels, rounds) = (starts.levels(), Rounds::new(starts.count()));
        let (steps, _) = cost_of_a_period(&model);
        let work_of_a_period = steps * model.cost_of_a_step(model.tolerance()).0 as f64;
        let basins = Self { model, starts, levels, done: 0, room, rounds, work_of_a_period, finer: None };
        if !(0..basins.starts.count()).any(|row| is_inside(room, basins.starts.at(row).0)) {
            return Err(basins.beyond());
        }
        Ok(basins)
    }

    /// The same map, of which each start is followed once more to see whether its answer is
    /// [sure](crate::questions::Basins).
    #[must_use]
    pub fn checked(self) -> Self {
        Self { finer: Some(sure::other(&self.model)), ..self }
    }

    fn beyond(&self) -> NoBasins {
        let (from, to) = self.room;
        let is_left = self.starts.at(0).0 / 1e3 < from;
        let stops = self.model.stop_positions();
        let (stop, at) = if is_left { (stops.0, from) } else { (stops.1, to) };
        let what = match (stop == Some(at), is_left) {
            (true, true) => "the left stop",
            (true, false) => "the right stop",
            (false, _) => "the end of the force curve",
        };
        NoBasins::Beyond { what, at_mm: at * 1e3, from_mm: from * 1e3, to_mm: to * 1e3 }
    }

    /// The starts.
    pub fn starts(&self) -> &Starts {
        &self.starts
    }

    /// The model of their motions; its own start is the middle, at rest.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Smallest and largest displacement in m that the mass can have.
    pub fn room(&self) -> (f64, f64) {
        self.room
    }

    /// The levels of the map, and how many of them have been run.
    pub fn levels(&self) -> (&Levels, usize) {
        (&self.levels, self.done)
    }

    /// Approximate number of steps and CPU time in s of a forcing period, measured in a run of the model.
    pub fn cost_of_a_period(&self) -> (f64, f64) {
        cost_of_a_period(&self.model)
    }

    /// Whether every start has been run.
    pub fn is_whole(&self) -> bool {
        self.done == STRIDES.len()
    }
}

fn cost_of_a_period(model: &Model) -> (f64, f64) {
    let period = model.forcing_period().unwrap_or(1.0);
    let time = period.min(MEASURED * model.natural_time());
    let summary = model.with_duration(time, 0.0).run(&Request::default()).summary;
    let periods = summary.outcome.ended_at().unwrap_or(time) / period;
    (summary.steps as f64 / periods, summary.cpu_s / periods)
}

/// Whether a displacement in mm lies between limits in m.
pub(super) fn is_inside(room: (f64, f64), x_mm: f64) -> bool {
    (room.0..=room.1).contains(&(x_mm / 1e3))
}

/// Whether damping, a circuit or a stop dissipates energy.
fn loses_energy(scene: &Scene) -> bool {
    let damped = match scene.damping {
        Damping::None => false,
        Damping::Ratio(xi) => xi > 0.0,
        Damping::Coefficient { c_n_s_per_m } => c_n_s_per_m > 0.0,
    };
    damped
        || scene.transducer.dissipates()
        || scene.stops.restitutions().into_iter().flatten().any(|restitution| restitution < 1.0)
        || matches!(scene.stops, Stops::Hertz { loss_s_per_m, .. } if loss_s_per_m > 0.0)
}

/// A constant excitation with an additional sine of amplitude 0, which has the period of small oscillations.
fn shaken(scene: &Scene, model: &Model) -> Option<Excitation> {
    if model.forcing_period().is_some() || !model.excitation().is_constant() {
        return None;
    }
    let frequency_hz = 1.0 / model.natural_time();
    let still = Excitation::Sine { frequency_hz, amplitude_g: 0.0, phase_deg: 0.0 };
    Some(match &scene.excitation {
        Excitation::None => still,
        other => Excitation::Sum(vec![other.clone(), still]),
    })
}
