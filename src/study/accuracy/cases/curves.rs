//! Cases of force curves with kinks, and of stops at special points of a curve.

use std::f64::consts::PI;

use super::HardCase;
use super::ball::times;
use crate::dynamics::{EventKind, Outcome, Run};
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::Corner;
use crate::study::accuracy::measure::{Bench, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, polynomial, right_stop, rigid, sine, unit_well};

pub(super) const KINK: HardCase = HardCase {
    name: "kink",
    problem: "A kink of the force crossed 1e4 times, undamped: the prototype's flexures, on an orbit over \
              both wells and 0.8 mm beyond the kink on either side; and a corner of two straight lines (1 \
              and 25 N/m).",
    answer: "Energy is conserved, with the curve's own potential. On the corner the period is closed: half \
             turns of two oscillators; the state after 5000 periods is that of the start.",
    conditioning: "A step changes the energy by at most d (Fmax L + vmax V) =: q, n steps by n q. With s \
                   steps a period the state after k periods is late by at most dT/dE s q k (k + 1)/2 + k s d \
                   L/V, and off by that times its speed.",
    find: kink,
};

fn kink(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    Ok(vec![flexures(bench)?, straight(bench)?])
}

fn straight(bench: &Bench) -> Result<Variant, Stopped> {
    const PERIODS: f64 = 5000.0;
    let (corner, v) = (Corner { at: 0.3, outer: 25.0 }, 1.0);
    let period = corner.period(v);
    let setup = Setup::new(polynomial(&[0.0]), (0.0, v), PERIODS * period).on(corner.curve());
    let model = setup.model()?;
    let run = bench.run(&model, &[])?;
    let summary = &run.summary;
    let scales = model.scales();
    let steps = summary.steps as f64;
    let energy_step = STEP_ERROR * (corner.largest_force(v) * scales.length + v * scales.speed);
    let slope = (corner.period(v + 1e-6) - corner.period(v - 1e-6)).abs() / 2e-6 / v;
    let each = steps / PERIODS;
    let late = slope * each * energy_step * PERIODS * (PERIODS + 1.0) / 2.0
        + steps * STEP_ERROR * scales.time
        // rounding of the period itself
        + PERIODS * period * 2.0 * f64::EPSILON;
    let energy = |x: f64, v: f64| 0.5 * v * v + model.mechanism().curve.potential(x);
    let drift = off(energy(summary.final_x, summary.final_v), energy(0.0, v), 0.5 * v * v);
    Ok(Variant::of("corner 1e4 times", &run)
        .number(
            "displacement after 5000 periods",
            off(summary.final_x, 0.0, scales.length),
            late * v / scales.length,
        )
        .number("energy", drift, steps * energy_step / (0.5 * v * v)))
}

fn flexures(bench: &Bench) -> Result<Variant, Stopped> {
    let mut setup = Setup::preset("paper", &["stops=None", "excitation=None", "damping=None"])?;
    let probe = setup.clone().start(0.0, 0.0).model()?;
    let breaks = probe.mechanism().curve.breaks();
    let kinks: Vec<f64> = probe.mechanism().landscape.kinks.iter().map(|kink| kink.x).collect();
    let outermost = kinks.iter().copied().fold(0.0_f64, f64::max).max(*breaks.first().unwrap_or(&0.0));
    let x0 = outermost + 0.8e-3;
    setup = setup.start(x0, 0.0);
    // some 2500 periods of four crossings each: measured from a short run
    setup.scene.run.duration_s = 20.0;
    setup.scene.run.settle_s = Some(0.0);
    let rate = bench.run_bare(&setup.model()?)?.summary.total_crossings as f64 / 20.0;
    if !(rate > 0.0) {
        return Err(Stopped::Scene("the flexures' orbit does not go over the barrier".to_owned()));
    }
    setup.scene.run.duration_s = 5100.0 / rate;
    let model = setup.model()?;
    let run = bench.run_bare(&model)?;
    let summary = &run.summary;
    let (x, v) = (summary.final_x, summary.final_v);
    let energy = |x: f64, v: f64| {
        let (kinetic, potential) = model.energies(x, v);
        kinetic + potential
    };
    let depth = model.energies(x0, 0.0).1
        - model
            .mechanism()
            .landscape
            .equilibria
            .iter()
            .map(|e| model.energies(e.x, 0.0).1)
            .fold(f64::INFINITY, f64::min);
    let fastest = (2.0 * depth / model.mass()).sqrt();
    let force = model.mechanism().curve.force(x0).abs();
    let scales = model.scales();
    let energy_step = STEP_ERROR * (force * scales.length + model.mass() * fastest * scales.speed);
    Ok(Variant::of("flexures 1e4 times", &run)
        .number(
            "energy",
            off(energy(x, v), energy(x0, 0.0), depth),
            summary.steps as f64 * energy_step / depth,
        )
        .fact("all passages", summary.total_crossings >= 5000 && summary.outcome == Outcome::Done))
}

pub(super) const STOP_ON_A_BREAK: HardCase = HardCase {
    name: "stop-on-break",
    problem: "A stop exactly on the corner of a curve (1 N/m inside, 1e6 N/m outside), e = 0.5: thrown at it \
              from the break itself, and pressed on it by a sine.",
    answer: "The inner piece holds: after the impact x = r cos(t + p), r^2 = b^2 + (v/2)^2; pressed, it is \
             let go where the sine has fallen to the inner force, cos(w t) = b.",
    conditioning: "n d in the state; a release at angle p to d/tan(p) over p.",
    find: stop_on_a_break,
};

fn stop_on_a_break(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let b = 300.0 / 1e3;
    let setup = |v: f64| {
        Setup::new(polynomial(&[0.0]), (b, v), 2.0)
            .on(Corner { at: b, outer: 1e6 }.curve())
            .stops(right_stop(300.0, 0.5))
    };
    let model = setup(0.5).model()?;
    let run = bench.run(&model, &[])?;
    let exact = b.hypot(0.25) * (2.0 + 0.25_f64.atan2(b)).cos();
    let allowed = run.summary.steps as f64 * STEP_ERROR;
    let impact = Variant::of("impact", &run)
        .number("displacement at 2 s", off(run.summary.final_x, exact, model.scales().length), allowed)
        .fact("one impact at 0", times(&run, EventKind::Impact) == [0.0]);
    let run = bench.run(&setup(0.0).drive(sine(0.25, 1.0, 270.0)).model()?, &[])?;
    let angle = b.acos();
    let exact = angle / (0.5 * PI);
    let released = times(&run, EventKind::Release);
    let error = released.first().map_or(f64::NAN, |t| off(*t, exact, exact));
    let press = Variant::of("release", &run)
        .number("time of release", error, STEP_ERROR / angle.tan() / angle)
        .fact("rests at 0", times(&run, EventKind::Rest).first() == Some(&0.0));
    Ok(vec![impact, press])
}

pub(super) const STOP_AT_THE_EQUILIBRIUM: HardCase = HardCase {
    name: "stop-at-equilibrium",
    problem: "Stops exactly at the wells of the unit double well: no force there. At rest on one, under a \
              sine that begins to pull, one that begins to press, and none.",
    answer: "Pulled: it leaves at once and never rests there first. Pressed: released as the sine changes \
             sign, at 0.5 s. None: it stays.",
    conditioning: "The sign change of a sine of slope w A is known to d/(2 pi) of a period.",
    find: stop_at_the_equilibrium,
};

fn stop_at_the_equilibrium(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let setup = |amplitude: f64| {
        Setup::new(unit_well(), (1.0, 0.0), 1.0).stops(rigid(1000.0, 0.5)).drive(sine(1.0, amplitude, 0.0))
    };
    let pulled = bench.run(&setup(1.0).model()?, &[0.01])?;
    let leaves = pulled.samples.first().is_some_and(|sample| sample.x < 1.0);
    let first = pulled.events.first().is_none_or(|event| event.kind != EventKind::Rest && event.t > 0.01);
    let pressed = bench.run(&setup(-1.0).model()?, &[])?;
    let released = times(&pressed, EventKind::Release);
    let error = released.first().map_or(f64::NAN, |t| off(*t, 0.5, 0.5));
    let still = bench.run(&setup(0.0).model()?, &[])?;
    Ok(vec![
        Variant::of("pulled", &pulled).fact("leaves at once", leaves && first),
        Variant::of("pressed", &pressed)
            .number("time of release", error, 2.0 * STEP_ERROR / (2.0 * PI))
            .fact("rests at 0", times(&pressed, EventKind::Rest).first() == Some(&0.0)),
        Variant::of("alone", &still).fact("stays", still.summary.final_x == 1.0 && still.events.is_empty()),
    ])
}

pub(super) const STOP_AT_THE_FORCE_MAXIMUM: HardCase = HardCase {
    name: "stop-at-force-maximum",
    problem: "Stops at the force maximum of the nominal cubic well, 7/sqrt 3 mm, 1.6 g at 3 Hz, e = 0.36, 2 \
              s: the slope of the press vanishes there, and its curvature shapes the small flights.",
    answer: "All impacts above 1 cm/s by the program in double-double arithmetic.",
    conditioning: "Sensitivity of each impact's time to all data, by the reference.",
    find: stop_at_the_force_maximum,
};

/// Times of the impacts above 1 cm/s.
pub(super) fn hard_impacts(run: &Run) -> Vec<f64> {
    let hard = |event: &&crate::dynamics::Event| event.kind == EventKind::Impact && event.v_in.abs() > 1e-2;
    run.events.iter().filter(hard).map(|event| event.t).collect()
}

/// The times of a run compared with the reference run of an equivalent scene; errors and allowed errors are
/// relative to the times.
pub(super) fn by_reference(
    bench: &Bench,
    name: &'static str,
    (setup, alike): (&Setup, &Setup),
    numbers: impl Fn(&Run) -> Vec<f64>,
) -> Result<Variant, Stopped> {
    let model = setup.model()?;
    let run = bench.run(&model, &[])?;
    let exact = numbers(&bench.reference(&alike.model()?, &[])?);
    let found = numbers(&run);
    let allowed = Bench::allowed(&model, run.summary.steps, &bench.sensitivity(setup, &[], &numbers)?);
    let pairs: Vec<_> = found
        .iter()
        .zip(&exact)
        .zip(&allowed)
        .map(|((value, exact), allowed)| (off(*value, *exact, *exact), allowed / exact))
        .collect();
    Ok(Variant::of(name, &run)
        .worst("impact times", pairs)
        .fact("all impacts", found.len() == exact.len() && !found.is_empty()))
}

fn stop_at_the_force_maximum(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let setup = Setup::nominal(7.0 / 3.0_f64.sqrt(), 0.36, sine(3.0, 1.6 * 9.80665, 0.0), 2.0);
    Ok(vec![by_reference(bench, "2 s", (&setup, &setup), hard_impacts)?])
}

pub(super) const BOTH_STOPS_ON_ONE_SIDE: HardCase = HardCase {
    name: "stops-on-one-side",
    problem: "F = (x - 2)^3 - (x - 2), wells at 1 and 3 m, stops at -0.3 and 0.5 m: both left of everything. \
              Thrown from 0.5 m with -1 m/s, e = 0.8, damped.",
    answer: "The impacts above 1 cm/s by the program in double-double arithmetic; it ends at rest on the \
             right stop.",
    conditioning: "Sensitivity of each impact's time to all data, by the reference.",
    find: both_stops_on_one_side,
};

fn both_stops_on_one_side(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let setup = Setup::new(polynomial(&[-6.0, 11.0, -6.0, 1.0]), (0.5, -1.0), 20.0)
        .stops(crate::scene::Stops::Uneven {
            left_mm: Some(300.0),
            right_mm: Some(500.0),
            restitution_left: Some(0.8),
            restitution_right: Some(0.8),
        })
        .damping(0.1);
    let variant = by_reference(bench, "e = 0.8", (&setup, &setup), hard_impacts)?;
    let run = bench.run(&setup.model()?, &[])?;
    let at_rest = run.summary.final_x == 0.5 && run.summary.rests == 1 && run.summary.total_crossings == 0;
    Ok(vec![variant.fact("rests on the right stop", at_rest)])
}
