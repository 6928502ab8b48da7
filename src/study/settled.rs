//! What does a scene settle to, and where does a mass stand that nothing shakes?

use std::sync::atomic::AtomicBool;

use crate::dynamics::{Event, EventKind, Model, Outcome, Phase, Request, Sample, Side, Summary};

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
