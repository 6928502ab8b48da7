//! Properties of a single run, sampled or not.

use interwell::dynamics::{Event, EventKind, Model, Outcome, Phase, Request, Run, Side, Summary};
use interwell::scene::{Scene, Start, Stops};
use proptest::prelude::*;

use super::harness::Verdict;
use super::scenes::distances;

pub fn sign(side: Side) -> f64 {
    match side {
        Side::Left => -1.0,
        Side::Right => 1.0,
    }
}

/// The residual of the ledger that is allowed, in tolerances. Of thirty thousand scenes the most was 4.1; of
/// the thousand that are drawn each day it is 0.2.
pub const LEDGER: f64 = 10.0;

/// Roundings of the place that add up in a ledger, and the tolerance below which rounding is all that it
/// shows.
const PLACES: f64 = 16.0;
const FINEST: f64 = 1e-13;

/// Steps whose errors add up to no more than the tolerance: an undamped mass that rattles between elastic
/// stops makes tens of thousands, and all of them err to one side.
const MANY_STEPS: f64 = 1000.0;

/// Asserts [`sound`].
#[track_caller]
pub fn assert_sound(scene: &Scene, model: &Model, run: &Run, ledger_factor: f64) {
    if let Err(broken) = sound(scene, model, run, ledger_factor) {
        panic!("{broken}");
    }
}

/// Holds of every run of `scene`, whatever it does; `run` has its events and its ledger.
pub fn sound(scene: &Scene, model: &Model, run: &Run, ledger_factor: f64) -> Verdict {
    finite(model, run)?;
    within_stops(scene, run)?;
    extremes_hold(model, run)?;
    events_follow(scene, model, run)?;
    counted(model, run)?;
    ledger_closes(model, run, ledger_factor)
}

/// No number that is not finite without an outcome that says so. Of the ledger it is asked where the energies
/// themselves can be written as doubles.
pub fn finite(model: &Model, run: &Run) -> Verdict {
    if matches!(run.summary.outcome, Outcome::NotFinite { .. }) {
        return Ok(());
    }
    for s in &run.samples {
        prop_assert!([s.t, s.x, s.v, s.base_accel].iter().all(|number| number.is_finite()), "{:?}", s);
    }
    for e in &run.events {
        prop_assert!([e.t, e.v_in, e.v_out].iter().all(|number| number.is_finite()), "{:?}", e);
    }
    let Summary { final_x, final_v, rms_velocity, max_abs_x, impact_share, rested_share, .. } = run.summary;
    let Summary { peak_contact_force, peak_contact_pressure, cpu_s, ledger, outcome, .. } = run.summary;
    let travel = run.summary.travel();
    let optional = [rms_velocity, max_abs_x, travel, impact_share, rested_share];
    let optional =
        optional.into_iter().chain([peak_contact_force, peak_contact_pressure, outcome.ended_at()]);
    let places = run.samples.iter().map(|s| (s.x, s.v)).chain([(final_x, final_v)]);
    let largest = |(x, v)| (model.mechanism().curve.potential(x), model.mass() * v * v);
    let written = places.map(largest).all(|(potential, kinetic)| potential.abs() + kinetic < 1e290);
    let ledger = ledger.filter(|_| written);
    let ledger =
        ledger.map(|l| [l.work_j, l.damping_j, l.impact_j, l.stored_j, l.residual_j, l.energy_residual]);
    let all =
        [final_x, final_v, cpu_s].into_iter().chain(optional.flatten()).chain(ledger.into_iter().flatten());
    prop_assert!(all.into_iter().all(f64::is_finite), "{:?}", run.summary);
    Ok(())
}

/// Never beyond a rigid stop, not by one bit: in the samples, at the end, and in the extremes. At rest
/// exactly on it.
pub fn within_stops(scene: &Scene, run: &Run) -> Verdict {
    if matches!(scene.stops, Stops::Hertz { .. }) {
        return Ok(());
    }
    let [(left, _), (right, _)] = distances(&scene.stops);
    let summary = &run.summary;
    for s in &run.samples {
        prop_assert!(s.x >= -left && s.x <= right, "beyond a stop: {:?}", s);
        match s.phase {
            Phase::Free => {}
            Phase::LeftStop => prop_assert!(s.x == -left && s.v == 0.0, "{:?}", s),
            Phase::RightStop => prop_assert!(s.x == right && s.v == 0.0, "{:?}", s),
        }
    }
    prop_assert!(summary.final_x >= -left && summary.final_x <= right, "beyond a stop: {:?}", summary);
    if let (Some(reach), Some(travel)) = (summary.max_abs_x, summary.travel()) {
        prop_assert!(reach <= left.max(right) && travel <= left + right, "beyond a stop: {:?}", summary);
    }
    Ok(())
}

/// No sample of the settled window lies beyond the extremes that are told of it, nor does it move further.
fn extremes_hold(model: &Model, run: &Run) -> Verdict {
    let (Some(reach), Some(travel)) = (run.summary.max_abs_x, run.summary.travel()) else { return Ok(()) };
    let periods = |period: f64| ((model.duration() - model.settle()) / period + 1e-9).floor() * period;
    let length = model.forcing_period().map(periods).filter(|span| *span > 0.0);
    let end = length.map_or(model.duration(), |length| model.settle() + length) * (1.0 - 1e-9);
    let inside = run.samples.iter().filter(|s| s.t >= model.settle() && s.t <= end);
    let (low, high) =
        inside.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s.x), high.max(s.x)));
    let rounding = 1e-12 * reach;
    prop_assert!(
        low > high || (low.abs().max(high.abs()) <= reach + rounding && high - low <= travel + rounding),
        "{} to {} in {:?}",
        low,
        high,
        run.summary
    );
    Ok(())
}

/// Events come in an order that a mass can follow, and an impact does what its stop does.
fn events_follow(scene: &Scene, model: &Model, run: &Run) -> Verdict {
    let [left, right] = distances(&scene.stops);
    let (mut resting, mut pressing, mut crossed) = (None, None, None);
    let mut before = 0.0;
    for e in &run.events {
        prop_assert!(e.t >= before && e.t <= scene.run.duration_s * (1.0 + 1e-15), "out of order: {:?}", e);
        before = e.t;
        match e.kind {
            EventKind::Impact => {
                prop_assert!(resting.is_none(), "an impact while at rest: {:?}", e);
                let restitution = if e.side == Side::Left { left.1 } else { right.1 };
                prop_assert!(e.v_in * sign(e.side) > 0.0, "not outward: {:?}", e);
                prop_assert!(e.v_out == -(restitution * e.v_in), "{} {:?}", restitution, e);
            }
            EventKind::Rest => {
                prop_assert!(resting.is_none(), "rests twice: {:?}", e);
                resting = Some(e.side);
            }
            EventKind::Release => {
                prop_assert!(resting == Some(e.side), "released from {:?}: {:?}", resting, e);
                resting = None;
            }
            EventKind::Contact => {
                prop_assert!(pressing.is_none(), "touches twice: {:?}", e);
                pressing = Some(e.side);
            }
            EventKind::Separate => {
                prop_assert!(pressing == Some(e.side), "separates from {:?}: {:?}", pressing, e);
                pressing = None;
            }
            EventKind::Crossing => {
                prop_assert!(resting.is_none(), "crosses while at rest: {:?}", e);
                prop_assert!(crossed != Some(e.side), "enters the same well twice: {:?}", e);
                prop_assert!(e.v_in == e.v_out);
                crossed = Some(e.side);
            }
        }
        let rigid = !matches!(e.kind, EventKind::Contact | EventKind::Separate);
        prop_assert!(e.kind == EventKind::Crossing || rigid == model.compliant().is_none(), "{:?}", e);
    }
    let first = run.events.iter().find(|e| e.kind == EventKind::Crossing);
    if let (Some(first), Start::At { x_mm, .. }) = (first, scene.start) {
        let level = model.mechanism().landscape.crossing_position().unwrap();
        let from = x_mm / 1e3;
        prop_assert!(
            (from - level) * sign(first.side) <= 0.0,
            "{:?} from {}, barrier at {}",
            first,
            from,
            level
        );
    }
    Ok(())
}

/// What is counted is what is listed, and it is the same count where nothing is listed.
fn counted(model: &Model, run: &Run) -> Verdict {
    let summary = &run.summary;
    // Impacts count from a speed on.
    let counts = |e: &&Event| {
        !matches!(e.kind, EventKind::Impact | EventKind::Contact)
            || e.v_in.abs() > 1e-6 * model.scales().speed
    };
    let events = |kind| run.events.iter().filter(move |e: &&Event| e.kind == kind).filter(counts);
    let count = |kind| events(kind).count() as u64;
    // A start on a compliant stop is a contact and no impact.
    let stood = events(EventKind::Contact).filter(|e| e.t == 0.0).count() as u64;
    let struck = count(EventKind::Impact) + count(EventKind::Contact);
    prop_assert!(
        summary.total_impacts == struck || summary.total_impacts + stood == struck,
        "{} of {}",
        summary.total_impacts,
        struck
    );
    prop_assert_eq!(summary.total_crossings, count(EventKind::Crossing));
    prop_assert_eq!(summary.rests, count(EventKind::Rest));
    let unlisted = model.run(&Request::default()).summary;
    prop_assert_eq!(
        (unlisted.crossings, unlisted.total_crossings),
        (summary.crossings, summary.total_crossings)
    );
    Ok(())
}

/// The ledger's residual in tolerances: relative to what was moved, or, where that is far below the scene's
/// own scales, to those. Less what the rounding of the place alone makes of it, which is all that is left of
/// a mass that moves by some billionths of its distance from x = 0, and a thousand steps at a time.
pub fn ledger_in_tolerances(model: &Model, run: &Run) -> f64 {
    let ledger = run.summary.ledger.expect("a ledger");
    let curve = &model.mechanism().curve;
    let places = || run.samples.iter().map(|sample| sample.x).chain([run.summary.final_x]);
    let (low, high) = (places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max));
    let force = places().map(|x| (curve.stiffness(x) * x).abs()).fold(0.0, f64::max);
    let residual = (ledger.residual_j.abs() - PLACES * f64::EPSILON * force * (high - low)).max(0.0);
    let scale = model.mass() * model.scales().speed * model.scales().speed;
    let share = residual / ledger.residual_j.abs();
    let relative = if share > 0.0 { share * ledger.energy_residual } else { 0.0 };
    let many = (run.summary.steps as f64 / MANY_STEPS).max(1.0);
    relative.min(residual / scale) / (model.tolerance().max(FINEST) * many)
}

fn ledger_closes(model: &Model, run: &Run, factor: f64) -> Verdict {
    // A motion that runs off to infinity has no energy left to compare.
    let gone = matches!(run.summary.outcome, Outcome::NotFinite { .. });
    let ratio = ledger_in_tolerances(model, run);
    prop_assert!(
        gone || ratio <= factor,
        "{} tolerances of {:e}: {:?}",
        ratio,
        model.tolerance(),
        run.summary.ledger
    );
    Ok(())
}
