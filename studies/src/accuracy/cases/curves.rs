//! Force curves with kinks, and stops at special points of a curve.

use std::f64::consts::PI;

use crate::accuracy::Stopped;
use crate::accuracy::exact::Corner;
use crate::accuracy::measure::{Bench, CHANGE, STEP_ERROR, Trial, Trials, hard_impacts, off, times};
use crate::accuracy::setup::{Setup, polynomial, rigid, sine, stops_at, unit_well};
use crate::dynamics::{EventKind, Outcome};
use crate::numeric::elementary;

pub(super) fn kink(bench: &Bench) -> Trials {
    Ok(vec![flexures(bench)?, corner(bench)?])
}

fn corner(bench: &Bench) -> Result<Trial, Stopped> {
    const PERIODS: f64 = 5000.0;
    let (corner, v) = (Corner { at: 0.3, outer: 25.0 }, 1.0);
    let period = corner.period(v);
    let setup = Setup::new(polynomial(&[0.0]), (0.0, v), PERIODS * period).on(corner.curve());
    let mut trial = bench.run("corner 1e4 times", &setup, &[])?;
    let scales = trial.model.scales();
    let steps = trial.run.summary.steps as f64;
    let energy_step = STEP_ERROR * (corner.largest_force(v) * scales.length + v * scales.speed);
    let slope = (corner.period(v + 1e-6) - corner.period(v - 1e-6)).abs() / 2e-6 / v;
    let each = steps / PERIODS;
    let late = slope * each * energy_step * PERIODS * (PERIODS + 1.0) / 2.0
        + steps * STEP_ERROR * scales.time
        // rounding of the period itself
        + PERIODS * period * 2.0 * f64::EPSILON;
    let energy = |x: f64, v: f64| 0.5 * v * v + trial.model.mechanism().curve.potential(x);
    let end = energy(trial.run.summary.final_x, trial.run.summary.final_v);
    let drift = off(end, energy(0.0, v), 0.5 * v * v);
    trial.final_x("displacement after 5000 periods", 0.0, scales.length, late * v / scales.length);
    trial.number("energy", drift, steps * energy_step / (0.5 * v * v));
    Ok(trial)
}

fn flexures(bench: &Bench) -> Result<Trial, Stopped> {
    const NAME: &str = "flexures 1e4 times";
    let mut setup = Setup::preset("paper", &["stops=None", "excitation=None", "damping=None"])?;
    let probe = setup.clone().start(0.0, 0.0).model()?;
    let (curve, landscape) = (&probe.mechanism().curve, &probe.mechanism().landscape);
    let kinks = landscape.kinks.iter().map(|kink| kink.x);
    let outermost = kinks.fold(0.0_f64, f64::max).max(*curve.breaks().first().unwrap_or(&0.0));
    let x0 = outermost + 0.8e-3;
    setup = setup.start(x0, 0.0);
    // some 2500 periods of four crossings each: measured from a short run
    setup.scene.run.duration_s = 20.0;
    setup.scene.run.settle_s = Some(0.0);
    let rate = bench.run_bare(NAME, &setup)?.run.summary.total_crossings as f64 / 20.0;
    if !(rate > 0.0) {
        return Err(Stopped::Scene("the flexures' orbit does not go over the barrier".to_owned()));
    }
    setup.scene.run.duration_s = 5100.0 / rate;
    let mut trial = bench.run_bare(NAME, &setup)?;
    let (model, summary) = (&trial.model, &trial.run.summary);
    let energy = |x: f64, v: f64| {
        let (kinetic, potential) = model.energies(x, v);
        kinetic + potential
    };
    let wells = landscape.equilibria.iter().map(|equilibrium| model.energies(equilibrium.x, 0.0).1);
    let depth = model.energies(x0, 0.0).1 - wells.fold(f64::INFINITY, f64::min);
    let fastest = (2.0 * depth / model.mass()).sqrt();
    let force = curve.force(x0).abs();
    let scales = model.scales();
    let energy_step = STEP_ERROR * (force * scales.length + model.mass() * fastest * scales.speed);
    let drift = off(energy(summary.final_x, summary.final_v), energy(x0, 0.0), depth);
    let allowed = summary.steps as f64 * energy_step / depth;
    let complete = summary.total_crossings >= 5000 && summary.outcome == Outcome::Done;
    trial.number("energy", drift, allowed);
    trial.fact("all passages", complete);
    Ok(trial)
}

pub(super) fn stop_on_break(bench: &Bench) -> Trials {
    let b = 300.0 / 1e3;
    let curve = Corner { at: b, outer: 1e6 }.curve();
    let stops = stops_at(None, Some(300.0), 0.5);
    let setup = |v: f64| Setup::new(polynomial(&[0.0]), (b, v), 2.0).on(curve.clone()).stops(stops);
    let mut impact = bench.run("impact", &setup(0.5), &[])?;
    let exact = elementary::hypot(b, 0.25) * elementary::cos(2.0 + elementary::atan2(0.25, b));
    impact.final_x("displacement at 2 s", exact, impact.model.scales().length, impact.added());
    impact.fact("one impact at 0", times(&impact.run, EventKind::Impact) == [0.0]);
    let mut release = bench.run("release", &setup(0.0).drive(sine(0.25, 1.0, 270.0)), &[])?;
    let (angle, kind) = (elementary::acos(b), EventKind::Release);
    release.time("time of release", kind, angle / (0.5 * PI), STEP_ERROR / elementary::tan(angle) / angle);
    release.fact("rests at 0", release.first(EventKind::Rest) == 0.0);
    Ok(vec![impact, release])
}

pub(super) fn stop_at_equilibrium(bench: &Bench) -> Trials {
    let setup = |amplitude: f64| {
        Setup::new(unit_well(), (1.0, 0.0), 1.0).stops(rigid(1000.0, 0.5)).drive(sine(1.0, amplitude, 0.0))
    };
    let mut pulled = bench.run("pulled", &setup(1.0), &[0.01])?;
    let leaves = pulled.run.samples.first().is_some_and(|sample| sample.x < 1.0);
    let first = pulled.run.events.first();
    let leaves = leaves && first.is_none_or(|event| event.kind != EventKind::Rest && event.t > 0.01);
    pulled.fact("leaves at once", leaves);
    let mut pressed = bench.run("pressed", &setup(-1.0), &[])?;
    pressed.time("time of release", EventKind::Release, 0.5, 2.0 * STEP_ERROR / (2.0 * PI));
    pressed.fact("rests at 0", pressed.first(EventKind::Rest) == 0.0);
    let mut alone = bench.run("alone", &setup(0.0), &[])?;
    alone.fact("stays", alone.run.summary.final_x == 1.0 && alone.run.events.is_empty());
    Ok(vec![pulled, pressed, alone])
}

pub(super) fn stop_at_force_maximum(bench: &Bench) -> Trials {
    let setup = Setup::nominal(7.0 / 3.0_f64.sqrt(), 0.36, sine(3.0, 1.6 * 9.80665, 0.0), 2.0);
    let reference = bench.reference(&setup, &[], CHANGE, hard_impacts)?;
    let mut trial = bench.run("2 s", &setup, &[])?;
    trial.impacts_beside(&reference, hard_impacts);
    Ok(vec![trial])
}

pub(super) fn stops_on_one_side(bench: &Bench) -> Trials {
    let setup = Setup::new(polynomial(&[-6.0, 11.0, -6.0, 1.0]), (0.5, -1.0), 20.0)
        .stops(stops_at(Some(300.0), Some(500.0), 0.8))
        .damping(0.1);
    let reference = bench.reference(&setup, &[], CHANGE, hard_impacts)?;
    let mut trial = bench.run("e = 0.8", &setup, &[])?;
    trial.impacts_beside(&reference, hard_impacts);
    let summary = trial.run.summary;
    let at_rest = summary.final_x == 0.5 && summary.rests == 1 && summary.total_crossings == 0;
    trial.fact("rests on the right stop", at_rest);
    Ok(vec![trial])
}
