//! Motions known in closed form from contact to contact: a well, boxes, balls, a stop at a crest.

use std::f64::consts::{FRAC_PI_2, SQRT_2};

use crate::accuracy::Stopped;
use crate::accuracy::exact::{UnitWell, dd, first_hit, impact_time, rest_time, sine_turns};
use crate::accuracy::measure::{Bench, STEP_ERROR, Trial, Trials, off, times};
use crate::accuracy::setup::{Setup, polynomial, rigid, stops_at, unit_well};
use crate::dynamics::{EventKind, Outcome, Side};
use crate::numeric::{DoubleDouble, Scalar, elementary};

pub(super) fn separatrix(bench: &Bench) -> Trials {
    let starts = [
        ("1e-3 inside", -1e-3),
        ("1e-3 outside", 1e-3),
        ("1e-6 inside", -1e-6),
        ("1e-6 outside", 1e-6),
        ("1e-9 inside", -1e-9),
        ("1e-9 outside", 1e-9),
        ("1e-12 inside", -1e-12),
        ("1e-12 outside", 1e-12),
    ];
    starts.into_iter().map(|(name, distance)| beside_the_separatrix(bench, name, distance)).collect()
}

fn beside_the_separatrix(bench: &Bench, name: &'static str, distance: f64) -> Result<Trial, Stopped> {
    const PERIODS: f64 = 100.0;
    let mut setup = Setup::new(unit_well(), (SQRT_2 + distance, 0.0), 1.0);
    // the answer is for the double to which the scene's millimetres are converted
    let orbit = UnitWell { x0: setup.model()?.start().0 };
    let period = orbit.period().to_f64();
    setup.scene.run.duration_s = PERIODS * period;
    let mut trial = bench.run(name, &setup, &[period, PERIODS * period])?;
    let (scales, steps) = (trial.model.scales(), trial.run.summary.steps as f64);
    let fastest = (2.0 * (0.25 + orbit.above_barrier())).sqrt();
    let energy_step = STEP_ERROR * (orbit.force().abs() * scales.length + fastest * scales.speed);
    let returns = [("first return", 1.0), ("100th return", PERIODS)];
    for ((quantity, k), sample) in returns.into_iter().zip(trial.run.samples.clone()) {
        let each = steps / PERIODS;
        let allowed = orbit.period_slope() * each * energy_step * k * (k + 1.0) / 2.0
            + k * each * STEP_ERROR * scales.time;
        // the mass is at rest there, so that its velocity measures how late it is, unless the phase is lost
        let late = (sample.v / orbit.force()).abs();
        if allowed < 0.1 * period {
            let far = off(sample.x, orbit.x0, 1.0) > 0.1;
            trial.number(quantity, if far { 1.0 } else { late / period }, allowed / period);
        }
    }
    let (x, v) = (trial.run.summary.final_x, trial.run.summary.final_v);
    let energy = 0.5 * v * v + UnitWell::potential(x);
    let error = off(energy, UnitWell::potential(orbit.x0), 0.25);
    trial.number("energy", error, steps * energy_step / 0.25);
    Ok(trial)
}

/// A free mass between perfect stops: the i-th impact, from 0, is at (2 i + 1) D/v.
fn between_stops(
    bench: &Bench,
    name: &'static str,
    limit_mm: f64,
    speed: f64,
    duration: f64,
) -> Result<Trial, Stopped> {
    let setup = Setup::new(polynomial(&[0.0]), (0.0, speed), duration).stops(rigid(limit_mm, 1.0));
    let mut trial = bench.run(name, &setup, &[])?;
    let distance = trial.model.stop_positions().1.unwrap_or(f64::NAN);
    let late = trial.impacts().enumerate().map(|(i, impact)| {
        let exact = (dd(2.0 * i as f64 + 1.0) * dd(distance) / dd(speed)).to_f64();
        (off(impact.t, exact, exact), STEP_ERROR + f64::EPSILON)
    });
    trial.worst("impact times", late.collect());
    Ok(trial)
}

pub(super) fn elastic_box(bench: &Bench) -> Trials {
    let mut trial = between_stops(bench, "1e6 impacts", 10.0, 0.05, 400_000.1)?;
    let kept = trial.impacts().all(|impact| impact.v_in.abs() == 0.05 && impact.v_out == -impact.v_in);
    trial.fact("speed kept bit for bit", kept);
    trial.fact("none lost", trial.run.summary.total_impacts == 1_000_000);
    Ok(vec![trial])
}

pub(super) fn narrow_gap(bench: &Bench) -> Trials {
    let mut trial = between_stops(bench, "5000 impacts", 0.001, 1.0, 0.01)?;
    let turns = |(i, side): (usize, Side)| side == if i % 2 == 0 { Side::Right } else { Side::Left };
    let in_turn = trial.impacts().map(|impact| impact.side).enumerate().all(turns);
    trial.fact("all in turn", in_turn && trial.run.summary.total_impacts == 5000);
    Ok(vec![trial])
}

pub(super) fn bouncing_ball(bench: &Bench) -> Trials {
    let restitutions =
        [("e = 0", 0.0), ("e = 0.36", 0.36), ("e = 0.9", 0.9), ("e = 0.99", 0.99), ("e = 0.999", 0.999)];
    restitutions.into_iter().map(|(name, e)| ball(bench, name, e)).collect()
}

fn ball(bench: &Bench, name: &'static str, e: f64) -> Result<Trial, Stopped> {
    let first = first_hit(1.0, 9.81);
    let speed = (2.0 * 9.81_f64).sqrt();
    let rest = rest_time(first, e).to_f64();
    let floor = stops_at(Some(1000.0), None, e);
    let setup = Setup::new(polynomial(&[9.81]), (0.0, 0.0), 1.1 * rest).stops(floor);
    let mut trial = bench.run(name, &setup, &[])?;
    let reach = 1.0 / (1.0 - e);
    let (mut late, mut slow) = (Vec::new(), Vec::new());
    // the closed form is summed incrementally: impact_time for each impact would be quadratic
    let mut power = dd(1.0);
    let mut sum = dd(0.0);
    for (i, impact) in trial.impacts().enumerate() {
        let count = i as f64 + 1.0;
        let exact = (first * (dd(1.0) + sum + sum)).to_f64();
        late.push((off(impact.t, exact, exact), STEP_ERROR * (1.0 + count.min(reach))));
        let exact = speed * power.to_f64();
        slow.push((off(impact.v_in.abs(), exact, exact), STEP_ERROR * (1.0 + count)));
        power = power * dd(e);
        sum += power;
    }
    let tenth = trial.impacts().nth(9).map(|impact| impact.t);
    let tenth = tenth.map(|t| off(t, impact_time(first, e, 10).to_f64(), t));
    let rests = times(&trial.run, EventKind::Rest).len();
    trial.worst("impact times", late);
    trial.worst("impact speeds", slow);
    trial.time("time of rest", EventKind::Rest, rest, STEP_ERROR * (1.0 + reach));
    trial.fact("one rest on the stop", rests == 1 && trial.run.summary.final_x == -1.0);
    trial.fact("tenth impact by its own sum", tenth.is_none_or(|error| error <= STEP_ERROR * 11.0));
    Ok(trial)
}

pub(super) fn elastic_press(bench: &Bench) -> Trials {
    let v0: f64 = 1e-5;
    let setup =
        Setup::new(polynomial(&[1.0]), (-1.0, v0), 1e6).stops(stops_at(Some(1000.0), None, 1.0)).damping(1.0);
    let mut trial = bench.run_bare("2e6 impacts", &setup)?;
    let impacts = if let Outcome::ImpactBudget { count, .. } = trial.run.summary.outcome { count } else { 0 };
    let n = impacts as f64;
    let exact = v0 / (1.0 + 2.0 / 3.0 * n * v0);
    // a = g = 1, so that z0 = v0
    let allowed = v0 * v0 * 2.0 / 45.0 + n * STEP_ERROR;
    trial.number("speed at the end", off(trial.run.summary.final_v.abs(), exact, exact), allowed);
    trial.fact("ends by its budget", impacts >= 2_000_000);
    Ok(vec![trial])
}

pub(super) fn grazing(bench: &Bench) -> Trials {
    let places = [("1e-12 m beyond", 1e-12), ("exactly", 0.0), ("1e-12 m before", -1e-12)];
    places.into_iter().map(|(name, beyond)| crest(bench, name, 1.0 + beyond)).collect()
}

pub(super) fn excursion(bench: &Bench) -> Trials {
    Ok(vec![crest(bench, "1e-10 m before", 1.0 - 1e-10)?])
}

/// The orbit sin t with an elastic stop near its crest.
fn crest(bench: &Bench, name: &'static str, stop: f64) -> Result<Trial, Stopped> {
    let setup =
        Setup::new(polynomial(&[0.0, 1.0]), (0.0, 1.0), 3.0).stops(stops_at(None, Some(stop * 1e3), 1.0));
    let mut trial = bench.run(name, &setup, &[])?;
    let stop = trial.model.stop_positions().1.unwrap_or(f64::NAN);
    let (depth, added) = (1.0 - stop, trial.added());
    let impacts: Vec<_> = trial.impacts().copied().collect();
    trial.fact("few steps", trial.run.summary.steps < 40);
    if depth < 0.0 {
        trial.fact("no impact", impacts.is_empty());
        trial.final_x("displacement at 3 s", elementary::sin(3.0), 1.0, added);
    } else if depth == 0.0 {
        trial.fact("at most one impact and no rest", impacts.len() <= 1 && trial.run.summary.rests == 0);
        trial.final_x("displacement at 3 s", elementary::sin(3.0), 1.0, 2.0 * (2.0 * added).sqrt());
    } else {
        let speed = (depth * (2.0 - depth)).sqrt();
        let angle = (sine_turns(dd(stop)) * DoubleDouble::tau()).to_f64();
        let slow = impacts.first().map_or(f64::NAN, |impact| off(impact.v_in, speed, speed));
        // the impact cuts off the crest: the rest of the wave comes earlier by the duration of the crest
        let exact = elementary::sin(3.0 + 2.0 * (FRAC_PI_2 - angle));
        trial.fact("one impact", impacts.len() == 1);
        trial.time("time of impact", EventKind::Impact, angle, added / speed);
        trial.number("speed of impact", slow, added / (speed * speed));
        trial.final_x("displacement at 3 s", exact, 1.0, added * (1.0 + 2.0 / speed));
    }
    Ok(trial)
}
