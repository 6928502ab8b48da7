//! Hard cases: problems that break integrators of impacts, each with its answer and what its
//! conditioning allows.
//!
//! What a case runs, where its answer comes from and the bound of its error stand in `../list.txt`, as
//! `accuracy --list` shows them. Throughout, d is the error that one step may make
//! ([`STEP_ERROR`](super::STEP_ERROR)), relative to the scene's length L and speed V, and n the number of
//! steps. All run at the tolerance 1e-14; at 1e-9 some sixty of their checks fail, so the bounds are tight.

mod circuit;
mod curves;
mod free;
mod linear;
mod long;
mod pressed;

use super::Stopped;
use super::measure::{Bench, Trials, Variant};
use crate::study::Task;

/// A problem whose answer is known.
#[derive(Debug)]
pub struct HardCase {
    /// The word that selects it.
    pub name: &'static str,
    trials: fn(&Bench) -> Trials,
}

impl HardCase {
    /// Runs the case. Reports no progress within the case; stops soon after cancellation.
    pub fn find(&self, task: &Task) -> Result<Vec<Variant>, Stopped> {
        Ok((self.trials)(&Bench { task })?.into_iter().map(|trial| trial.variant).collect())
    }
}

/// All of them, in the order in which they are shown.
pub const HARD_CASES: &[HardCase] = &[
    HardCase { name: "separatrix", trials: free::separatrix },
    HardCase { name: "elastic-box", trials: free::elastic_box },
    HardCase { name: "bouncing-ball", trials: free::bouncing_ball },
    HardCase { name: "elastic-press", trials: free::elastic_press },
    HardCase { name: "chatter-curved", trials: pressed::chatter_curved },
    HardCase { name: "chatter-incomplete", trials: pressed::chatter_incomplete },
    HardCase { name: "chatter-at-release", trials: pressed::chatter_at_release },
    HardCase { name: "release-threshold", trials: pressed::release_threshold },
    HardCase { name: "release-zero-slope", trials: pressed::release_zero_slope },
    HardCase { name: "bias-at-threshold", trials: pressed::bias_at_threshold },
    HardCase { name: "plastic-sine", trials: pressed::plastic_sine },
    HardCase { name: "grazing", trials: free::grazing },
    HardCase { name: "excursion", trials: free::excursion },
    HardCase { name: "narrow-gap", trials: free::narrow_gap },
    HardCase { name: "impact-at-release", trials: pressed::impact_at_release },
    HardCase { name: "ripple", trials: linear::ripple },
    HardCase { name: "long-ramp", trials: linear::long_ramp },
    HardCase { name: "fast-drive", trials: linear::fast_drive },
    HardCase { name: "shock", trials: linear::shock },
    HardCase { name: "noise", trials: linear::noise },
    HardCase { name: "record", trials: linear::record },
    HardCase { name: "kink", trials: curves::kink },
    HardCase { name: "stop-on-break", trials: curves::stop_on_break },
    HardCase { name: "stop-at-equilibrium", trials: curves::stop_at_equilibrium },
    HardCase { name: "stop-at-force-maximum", trials: curves::stop_at_force_maximum },
    HardCase { name: "stops-on-one-side", trials: curves::stops_on_one_side },
    HardCase { name: "stiff-circuit", trials: linear::stiff_circuit },
    HardCase { name: "strong-coupling", trials: linear::strong_coupling },
    HardCase { name: "no-inductance", trials: linear::no_inductance },
    HardCase { name: "open-and-short", trials: circuit::open_and_short },
    HardCase { name: "circuit-at-rest", trials: circuit::circuit_at_rest },
    HardCase { name: "circuit-release", trials: circuit::circuit_release },
    HardCase { name: "circuit-at-impacts", trials: circuit::circuit_at_impacts },
    HardCase { name: "chaos", trials: long::chaos },
    HardCase { name: "units", trials: long::units },
];
