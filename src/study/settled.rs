//! What does a scene settle to, and how much more or less shaking would change that?

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::Task;
use crate::dynamics::{
    Event, EventKind, Model, Outcome, Phase, Regime, Request, STANDARD_GRAVITY, Sample, Side, Summary,
};
use crate::mechanics::Mechanism;
use crate::scene::{Excitation, Scene, Start, Stops};

/// The settled motion of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// Its statistics.
    pub summary: Summary,
    /// Smallest and largest displacement of the settled window in m; none where the run ended before it.
    pub range: Option<(f64, f64)>,
    /// Forcing periods in the settled window, where the drive has a period.
    pub periods: Option<f64>,
    /// How many of those forcing periods have a crossing in them.
    pub crossing_periods: u64,
    /// How many of those forcing periods have a release in them.
    pub release_periods: u64,
    /// Length of the settled window in s.
    pub window: f64,
}

/// Runs `model` once for its settled motion. None where it was cancelled.
pub fn settled(model: &Model, cancel: &AtomicBool) -> Option<Settled> {
    let request = Request { events: true, ledger: true, cancel: Some(cancel), ..Request::default() };
    let run = model.run(&request);
    let summary = run.summary;
    if matches!(summary.outcome, Outcome::Cancelled { .. }) {
        return None;
    }
    // The largest |x| is one end of the range, and the motion's last place tells which one where it stays on a side.
    let range = summary.max_abs_x.zip(summary.travel).map(|(reach, travel)| {
        if summary.final_x >= 0.0 { (reach - travel, reach) } else { (-reach, travel - reach) }
    });
    let length = model.duration - model.settle();
    let periods = model.forcing_period.map(|period| (length / period + 1e-9).floor());
    let window = match (periods, model.forcing_period) {
        (Some(periods), Some(period)) if periods > 0.0 => periods * period,
        _ => length,
    };
    // the forcing periods of the window in which something of this kind happened
    let periods_with = |kind: EventKind| {
        let Some(period) = model.forcing_period else { return 0 };
        let since = |event: &&Event| event.kind == kind && event.t >= model.settle();
        let mut all: Vec<u64> =
            run.events.iter().filter(since).map(|e| ((e.t - model.settle()) / period) as u64).collect();
        all.dedup();
        all.iter().filter(|index| (**index as f64) < periods.unwrap_or(0.0)).count() as u64
    };
    Some(Settled {
        summary,
        range,
        periods,
        crossing_periods: periods_with(EventKind::Crossing),
        release_periods: periods_with(EventKind::Release),
        window,
    })
}

/// How much shaking it takes, in g, each from rest at the scene's frequency.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Thresholds {
    /// The least amplitude that frees the mass from the stop it rests on, in closed form.
    pub frees_at: Option<f64>,
    /// Up from the scene's own amplitude the first one whose run is interwell; without stops, where regular windows
    /// are rare and far up, the first one whose settled motion crosses at all.
    pub crosses_at: Option<f64>,
    /// Down from the scene's own amplitude the last one up to which every run is interwell.
    pub crosses_from: Option<f64>,
}

/// Step of the search in g, and how far up it goes.
const STEP: f64 = 0.01;
const MOST_STEPS: u32 = 200;

/// Searches the amplitudes of a sine around the scene's own. None where the drive is no sine, or the search was cancelled.
///
/// The amplitudes that cross are no interval, so nothing is bisected: every step of 0.01 g is run.
pub fn thresholds(scene: &Scene, mechanism: &Arc<Mechanism>, task: &Task) -> Option<Thresholds> {
    let Excitation::Sine { amplitude_g, .. } = scene.excitation else { return None };
    let mut trial = Scene { start: Start::Rest, ..scene.clone() };
    let mut crosses = |tried: f64| -> Option<bool> {
        if let Excitation::Sine { amplitude_g, .. } = &mut trial.excitation {
            *amplitude_g = tried;
        }
        let model = Model::build(&trial, Arc::clone(mechanism)).ok()?;
        let run = model.run(&Request { cancel: Some(task.cancel), ..Request::default() });
        (task.tick)();
        let irregular_counts = scene.stops == Stops::None && run.summary.regime == Regime::Irregular;
        (!task.is_cancelled()).then_some(irregular_counts || run.summary.regime == Regime::Interwell)
    };
    let mut found = Thresholds { frees_at: frees_at(scene, mechanism), ..Thresholds::default() };
    let own = amplitude_g.abs();
    if crosses(own)? {
        let mut last = own;
        for i in 1..=MOST_STEPS {
            let tried = ((own - STEP * f64::from(i)) / STEP).round() * STEP;
            if tried <= 0.0 || !crosses(tried)? {
                break;
            }
            last = tried;
        }
        found.crosses_from = Some(last);
    } else {
        for i in 1..=MOST_STEPS {
            let tried = ((own + STEP * f64::from(i)) / STEP).round() * STEP;
            if crosses(tried)? {
                found.crosses_at = Some(tried);
                break;
            }
        }
    }
    Some(found)
}

/// The amplitude in g at which the base's push reaches the force that presses the mass on the stop that it rests on.
fn frees_at(scene: &Scene, mechanism: &Mechanism) -> Option<f64> {
    let right = match scene.stops {
        Stops::Rigid { travel_limit_mm, .. } | Stops::Hertz { travel_limit_mm, .. } => travel_limit_mm / 1e3,
        Stops::Uneven { right_mm, .. } => right_mm? / 1e3,
        Stops::None => return None,
    };
    let well = mechanism.landscape.right_stable()?.x;
    let press = -mechanism.curve.force(right);
    (right < well && press > 0.0).then(|| press / (scene.mass_g / 1e3) / STANDARD_GRAVITY)
}

/// Where a mass stands, or swings, that nothing shakes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// The well it is in.
    pub side: Side,
    /// Force in N that presses it on its stop, where it rests on one.
    pub pressed_n: Option<f64>,
    /// Mechanical energy in J above the lowest place that it can reach there.
    pub energy_j: f64,
    /// Energy in J that lifts it from that place over the barrier.
    pub needed_j: f64,
}

/// Where the mass is in the landscape, in words' numbers; none where there is no barrier.
pub fn standing(model: &Model, state: &Sample) -> Option<Standing> {
    let curve = &model.mechanism.curve;
    let barrier = model.mechanism.landscape.barrier?;
    let side = if state.x >= barrier.x { Side::Right } else { Side::Left };
    let (left, right) = model.stop_positions();
    let lowest = match side {
        Side::Right => right.map_or(barrier.right_well, |stop| stop.min(barrier.right_well)),
        Side::Left => left.map_or(barrier.left_well, |stop| stop.max(barrier.left_well)),
    };
    let floor = curve.potential(lowest);
    Some(Standing {
        side,
        pressed_n: (state.phase != Phase::Free).then(|| curve.force(state.x).abs()),
        energy_j: 0.5 * model.mass * state.v * state.v + curve.potential(state.x) - floor,
        needed_j: curve.potential(barrier.x) - floor,
    })
}
