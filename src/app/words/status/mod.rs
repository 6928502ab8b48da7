//! Sentence about what the mass does.
//!
//! Its form is: name of the motion: what the mass does; a number; what it would take to cross. Every number
//! comes from a run. Motion that has not been on the screen yet is described in the future tense, and a fact
//! that is not known is called unknown.

mod driven;
mod remedy;

use crate::dynamics::{Model, Outcome, Phase, Sample};
use interwell_studies::study::{Standing, ended_remedy, standing};

pub use super::kind::Kind;
pub use super::numbers::{as_set, mm_beside, seconds, speed};
use super::numbers::{energy, length_beside, newtons, with_minus};
use super::wells::well_name;
pub use driven::{DrivenMotion, driven};
pub use remedy::{in_unit, threshold, ways};

/// What the status line says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sentence {
    pub kind: Kind,
    pub text: String,
    /// What it would take to cross; empty until that is known, or while a lesson hides it.
    pub remedy: String,
}

impl Sentence {
    fn new(kind: Kind, text: impl Into<String>) -> Self {
        Self { kind, text: text.into(), remedy: String::new() }
    }

    /// The sentence about a scene that cannot be run, with its first fault.
    pub fn fault(error: &str) -> Self {
        let first = error.lines().next().unwrap_or(error);
        Self::new(Kind::Fault, format!("This scene cannot run: {first}"))
    }

    /// The sentence until it is known what the motion settles to.
    pub fn waiting() -> Self {
        Self::new(Kind::Other, "Working out what this settles to.")
    }

    /// The sentence after the user has stopped the computation of what the motion settles to.
    pub fn stopped() -> Self {
        let text = "Stopped before it was known what this settles to: a shorter run length is known sooner.";
        Self::new(Kind::Other, text)
    }

    pub fn whole(&self) -> String {
        if self.remedy.is_empty() { self.text.clone() } else { format!("{} {}", self.text, self.remedy) }
    }
}

/// Share of the scene's acceleration scale below which a mass without speed is at rest.
const STILL_PULL: f64 = 1e-3;

/// Share of the mechanism's largest force below which it is said not to pull.
const NO_PULL: f64 = 2e-3;

pub fn held(model: &Model, state: &Sample) -> Sentence {
    let force = model.mechanism().curve.force(state.x);
    let middle = model.mechanism().landscape.barrier.map_or(0.0, |barrier| barrier.x);
    let outward = (state.x - middle) * force < 0.0;
    let largest =
        model.mechanism().landscape.extrema.iter().map(|extremum| extremum.force.abs()).fold(0.0, f64::max);
    let (place, size) = (with_minus(&length_beside(state.x, model.stop_positions())), force.abs());
    let text = if size <= NO_PULL * largest || size == 0.0 {
        format!("Held at {place}: nothing pulls.")
    } else {
        let way = if outward { "outwards" } else { "inwards" };
        format!("Held at {place}: it pulls {way} with {}.", newtons(size))
    };
    Sentence::new(Kind::Other, text)
}

pub fn ended(model: &Model, outcome: Outcome) -> Sentence {
    let at = outcome.ended_at().unwrap_or(0.0);
    let (low, high) = model.mechanism().curve.domain();
    let end = length_beside(low.abs().min(high), (None, None));
    let remedy = ended_remedy(model, outcome).unwrap_or_default();
    let why = match outcome {
        Outcome::LeftTable { .. } if model.mechanism().flexures.is_some() => format!(
            "the mass went further than the flexures were computed, {end}. Set stops inside that, or \
             shake less."
        ),
        Outcome::LeftTable { .. } => format!(
            "the mass left the force table, which ends at {end}. Set stops inside it or extend the table."
        ),
        Outcome::ImpactBudget { count, .. } => {
            format!("it reached the limit of {count} impacts. Lower the restitution.")
        }
        Outcome::StepBudget { .. } => format!("it reached the limit of work of a run; {remedy}."),
        Outcome::NotFinite { .. } => format!("a number was no longer finite; {remedy}."),
        Outcome::Inaccurate { .. } => {
            return Sentence::new(Kind::Fault, format!("The energy does not balance; {remedy}."));
        }
        Outcome::Cancelled { .. } | Outcome::Done => "it was stopped.".to_owned(),
    };
    Sentence::new(Kind::Fault, format!("The run ended at {at:.2} s: {why}"))
}

pub fn unshaken(model: &Model, state: &Sample) -> Sentence {
    let base = model.base_acceleration(state.t);
    let pull = model.acceleration(state.x, state.v, base).abs() * model.scales().time / model.scales().speed;
    let rests = state.phase != Phase::Free || pull < STILL_PULL;
    let still = state.v.abs() < 1e-4 * model.scales().speed && rests;
    let Some(Standing { well, pressed_n, energy_j, needed_j }) = standing(model, state) else {
        if still {
            return Sentence::new(Kind::Resting, "At rest; nothing shakes it.");
        }
        let speed = speed(state.v.abs());
        return Sentence::new(Kind::Other, format!("Moving at {speed} mm/s; nothing shakes it."));
    };
    let wells = model.mechanism().landscape.wells().len();
    let (well, needed, left) = (well_name(well, wells), energy(needed_j), energy(energy_j));
    let lift = format!("nothing shakes it. {needed} would lift it over the barrier.");
    let (kind, text) = match pressed_n {
        Some(force) => {
            let side = if state.phase == Phase::LeftStop { "left-hand" } else { "right-hand" };
            (Kind::Resting, format!("Pressed on the {side} stop with {}; {lift}", newtons(force)))
        }
        None if still && energy_j < 1e-3 * needed_j => {
            (Kind::Resting, format!("At rest in the {well}; {lift}"))
        }
        None if energy_j < needed_j => (
            Kind::Intrawell,
            format!("Ringing down in the {well}: {left} of energy left, {needed} needed to cross."),
        ),
        None => {
            let all = if wells == 2 { "both" } else { "several" };
            let below = format!("below {needed} it stays in one");
            (Kind::Other, format!("Ringing down over {all} wells: {left} of energy left, {below}."))
        }
    };
    Sentence::new(kind, text)
}
