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
    const fn new(name: &'static str, trials: fn(&Bench) -> Trials) -> Self {
        Self { name, trials }
    }

    /// Runs the case. Reports no progress within the case; stops soon after cancellation.
    pub fn find(&self, task: &Task) -> Result<Vec<Variant>, Stopped> {
        Ok((self.trials)(&Bench { task })?.into_iter().map(|trial| trial.variant).collect())
    }
}

/// All of them, in the order in which they are shown.
pub const HARD_CASES: &[HardCase] = &[
    HardCase::new("separatrix", free::separatrix),
    HardCase::new("elastic-box", free::elastic_box),
    HardCase::new("bouncing-ball", free::bouncing_ball),
    HardCase::new("elastic-press", free::elastic_press),
    HardCase::new("chatter-curved", pressed::chatter_curved),
    HardCase::new("chatter-incomplete", pressed::chatter_incomplete),
    HardCase::new("chatter-at-release", pressed::chatter_at_release),
    HardCase::new("release-threshold", pressed::release_threshold),
    HardCase::new("release-zero-slope", pressed::release_zero_slope),
    HardCase::new("bias-at-threshold", pressed::bias_at_threshold),
    HardCase::new("plastic-sine", pressed::plastic_sine),
    HardCase::new("grazing", free::grazing),
    HardCase::new("excursion", free::excursion),
    HardCase::new("narrow-gap", free::narrow_gap),
    HardCase::new("impact-at-release", pressed::impact_at_release),
    HardCase::new("ripple", linear::ripple),
    HardCase::new("long-ramp", linear::long_ramp),
    HardCase::new("fast-drive", linear::fast_drive),
    HardCase::new("shock", linear::shock),
    HardCase::new("noise", linear::noise),
    HardCase::new("record", linear::record),
    HardCase::new("kink", curves::kink),
    HardCase::new("stop-on-break", curves::stop_on_break),
    HardCase::new("stop-at-equilibrium", curves::stop_at_equilibrium),
    HardCase::new("stop-at-force-maximum", curves::stop_at_force_maximum),
    HardCase::new("stops-on-one-side", curves::stops_on_one_side),
    HardCase::new("stiff-circuit", linear::stiff_circuit),
    HardCase::new("strong-coupling", linear::strong_coupling),
    HardCase::new("no-inductance", linear::no_inductance),
    HardCase::new("open-and-short", circuit::open_and_short),
    HardCase::new("circuit-at-rest", circuit::circuit_at_rest),
    HardCase::new("circuit-release", circuit::circuit_release),
    HardCase::new("circuit-at-impacts", circuit::circuit_at_impacts),
    HardCase::new("chaos", long::chaos),
    HardCase::new("units", long::units),
];
