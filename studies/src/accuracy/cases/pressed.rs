//! A mass that is pressed on a stop and shaken: releases, and chatter that ends near one.

use std::f64::consts::TAU;

use crate::accuracy::Stopped;
use crate::accuracy::exact::{State, dd, sine_turns, turns};
use crate::accuracy::measure::{Bench, CHANGE, STEP_ERROR, Trials, off, times};
use crate::accuracy::setup::{Setup, constant, polynomial, sine, stops_at};
use crate::dynamics::{EventKind, Run};
use crate::numeric::{DoubleDouble, Scalar, bisect, elementary};
use crate::scene::{Damping, Excitation};

/// 1 kg that 1 N presses to a right stop at 1 m, from a gap in m with a velocity in m/s.
fn pressed(gap: f64, v: f64, restitution: f64, drive: Excitation, duration: f64) -> Setup {
    Setup::new(polynomial(&[-1.0]), (1.0 - gap, v), duration)
        .stops(stops_at(None, Some(1000.0), restitution))
        .drive(drive)
}

/// The same with a sine of 1 Hz in closed form, in the gap y from the stop: y'' = -1 + amplitude sin(2 pi t).
struct ClosedForm {
    /// In m/s^2, above 1.
    amplitude: f64,
}

impl ClosedForm {
    /// The first instant in s at which the press falls through 0: asin(1/amplitude)/(2 pi).
    fn release(&self) -> DoubleDouble {
        sine_turns(dd(1.0) / dd(self.amplitude))
    }

    /// Gap in m and its rate at `t` after gap and rate `start` at `from`, both in s, in free flight.
    fn flight(&self, start: (f64, DoubleDouble), from: DoubleDouble, t: DoubleDouble) -> State {
        let w = DoubleDouble::tau();
        let gain = dd(self.amplitude) / w;
        let ((s0, c0), (s, c)) = (turns(from), turns(t));
        let d = t - from;
        let rate = start.1 - d - gain * (c - c0);
        let gap = dd(start.0) + (start.1 + gain * c0) * d - d * d * dd(0.5) - gain / w * (s - s0);
        (gap, rate)
    }

    /// When a flight from rest on the stop at `from` lands again: the first root of the gap, bracketed on a
    /// grid of 1/4096 s and bisected to all digits; NaN if it does not land within four periods.
    fn landing(&self, from: DoubleDouble) -> DoubleDouble {
        let at = |i: u32| from + dd(f64::from(i) / 4096.0);
        let is_open = |t: DoubleDouble| self.flight((0.0, dd(0.0)), from, t).0 > dd(0.0);
        let first = (1..4 * 4096).find(|i| !is_open(at(*i)));
        first.map_or(dd(f64::NAN), |first| bisect(at(first - 1), at(first), 110, is_open).1)
    }
}

pub(super) fn chatter_curved(bench: &Bench) -> Trials {
    let mut trials = Vec::new();
    for (name, e) in [("e = 0.36", 0.36), ("e = 0.9", 0.9), ("e = 0.99", 0.99)] {
        let mut setup = Setup::nominal(4.0, e, sine(3.0, 1.0, 30.0), 1.5).start(4e-3, -0.1);
        setup.scene.damping = Damping::Ratio(0.05);
        let rest = |run: &Run| vec![times(run, EventKind::Rest).first().copied().unwrap_or(f64::NAN)];
        let reference = bench.reference(&setup, &[], CHANGE, rest)?;
        let mut trial = bench.run(name, &setup, &[])?;
        trial.beside("time of rest", &rest(&trial.run), &reference, &reference.numbers);
        trial.fact("one rest", trial.run.summary.rests == 1);
        trials.push(trial);
    }
    Ok(trials)
}

pub(super) fn chatter_incomplete(bench: &Bench) -> Trials {
    let setup = pressed(0.0, -0.02, 0.9, sine(1.0, 1.2, 0.0), 1.0);
    let impacts = |run: &Run| times(run, EventKind::Impact);
    let reference = bench.reference(&setup, &[], CHANGE, impacts)?;
    let mut trial = bench.run("e = 0.9", &setup, &[])?;
    let found = impacts(&trial.run);
    let leaves = ClosedForm { amplitude: 1.2 }.release().to_f64();
    let is_before = |times: &[f64]| times.iter().any(|t| *t < leaves);
    let rests_before = is_before(&times(&trial.run, EventKind::Rest));
    let in_chatter = is_before(&found) && found.len() == reference.numbers.len() && !rests_before;
    trial.beside("impact times", &found, &reference, &reference.numbers);
    trial.fact("leaves in mid-chatter", in_chatter);
    Ok(vec![trial])
}

pub(super) fn chatter_at_release(bench: &Bench) -> Trials {
    /// Time in s after the release at which both are compared.
    const AFTER: f64 = 0.3;
    let closed_form = ClosedForm { amplitude: 1.2 };
    let leaves = closed_form.release();
    let end = leaves.to_f64() + AFTER;
    let setup = |v: f64| pressed(0.0, -v, 0.5, sine(1.0, 1.2, 0.0), end);
    // the order of events decides, not their times, which may be equal
    let comes_to_rest = |v: f64| -> Result<bool, Stopped> {
        Ok(bench.run("", &setup(v), &[])?.first(EventKind::Rest) <= leaves.to_f64())
    };
    let (mut low, mut high): (f64, f64) = (1e-4, 0.1);
    let bracketed = comes_to_rest(low)? && !comes_to_rest(high)?;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if comes_to_rest(middle)? { low = middle } else { high = middle }
    }
    let neighbours = bracketed && high.to_bits() - low.to_bits() == 1;
    let (gap, _) = closed_form.flight((0.0, dd(0.0)), leaves, dd(end));
    let exact = (dd(1.0) - gap).to_f64();
    let mut trials = Vec::new();
    for (name, v) in [("just rests", low), ("just does not", high)] {
        let mut trial = bench.run(name, &setup(v), &[])?;
        let scales = trial.model.scales();
        let rebounds = trial.impacts().count() as f64;
        let allowed = (rebounds + 2.0) * STEP_ERROR * (scales.speed * AFTER / scales.length) + trial.added();
        trial.final_x("displacement 0.3 s later", exact, scales.length, allowed);
        trial.fact("the two are neighbours", neighbours);
        trials.push(trial);
    }
    Ok(trials)
}

pub(super) fn release_threshold(bench: &Bench) -> Trials {
    const D_MM: f64 = 4.0;
    // |F(D)|/m of the nominal cubic in m/s^2, from the doubles of its scene
    let d = dd(D_MM / 1e3);
    let force = dd(40.0) * d - dd(40.0 / 49e-6) * d * d * d;
    let threshold = force / dd(15.2 / 1e3);
    let mut trials = Vec::new();
    for (name, over) in
        [("1e-6 above", 1e-6), ("1e-6 below", -1e-6), ("1e-10 above", 1e-10), ("1e-10 below", -1e-10)]
    {
        let amplitude = threshold.to_f64() * (1.0 + over);
        let mut trial = bench.run(name, &Setup::nominal(D_MM, 0.36, sine(3.0, amplitude, 0.0), 0.3), &[])?;
        if over > 0.0 {
            let amplitude = dd(trial.model.excitation().tones[0].amplitude);
            let exact = (sine_turns(threshold / amplitude) / dd(3.0)).to_f64();
            let angle = exact * 3.0 * TAU;
            trial.time(
                "time of release",
                EventKind::Release,
                exact,
                STEP_ERROR * elementary::tan(angle) / angle,
            );
        } else {
            let stays = trial.first(EventKind::Release).is_nan() && trial.run.summary.final_x == D_MM / 1e3;
            trial.fact("stays at rest", stays);
        }
        trials.push(trial);
    }
    Ok(trials)
}

pub(super) fn release_zero_slope(bench: &Bench) -> Trials {
    let sum = Excitation::Sum(vec![constant(0.5), sine(1.0, 0.5, 90.0)]);
    let mut trials = Vec::new();
    for (name, drive) in [("sine", sine(1.0, 1.0, 0.0)), ("constant + sine", sum)] {
        let mut trial = bench.run(name, &pressed(0.0, 0.0, 0.36, drive, 20.25), &[])?;
        let base = |i: u32| trial.model.base_acceleration(0.25 * f64::from(i));
        let (crest, summary) = ((0..=4).map(base).fold(0.0, f64::max), trial.run.summary);
        trial.fact("the crest is the press", crest == 1.0);
        trial.fact("stays at rest", summary.final_x == 1.0 && summary.total_impacts == 0);
        trials.push(trial);
    }
    Ok(trials)
}

pub(super) fn bias_at_threshold(bench: &Bench) -> Trials {
    let mut trials = Vec::new();
    let Excitation::Constant { accel_g } = constant(1.0) else { return Ok(trials) };
    let neighbours =
        [("at it", accel_g), ("just below", accel_g.next_down()), ("just above", accel_g.next_up())];
    for (name, accel_g) in neighbours {
        let setup = pressed(0.0, 0.0, 0.36, Excitation::Constant { accel_g }, 1.0);
        let mut trial = bench.run(name, &setup, &[])?;
        let (net, summary) = (1.0 - trial.model.base_acceleration(0.0), trial.run.summary);
        let gone = if net < 0.0 { 0.5 * net } else { 0.0 };
        trial.final_x("displacement", 1.0 + gone, 1.0, 2.0 * f64::EPSILON);
        trial.fact("no impact in few steps", summary.total_impacts == 0 && summary.steps < 100);
        trials.push(trial);
    }
    Ok(trials)
}

pub(super) fn plastic_sine(bench: &Bench) -> Trials {
    let closed_form = ClosedForm { amplitude: 1.8 };
    let mut trial = bench.run("10 periods", &pressed(0.0, 0.0, 0.0, sine(1.0, 1.8, 0.0), 10.0), &[])?;
    let first = closed_form.release();
    let landing = closed_form.landing(first);
    let speed = closed_form.flight((0.0, dd(0.0)), first, landing).1.to_f64().abs();
    let angle = elementary::asin(1.0 / 1.8);
    let per_flight = trial.run.summary.steps as f64 / 10.0;
    let in_time = |kind: EventKind, first: DoubleDouble, allowed: f64| -> Vec<(f64, f64)> {
        let pair = |(i, t): (usize, f64)| {
            let exact = (first + dd(i as f64)).to_f64();
            (off(t, exact, 1.0), allowed + f64::EPSILON * exact)
        };
        times(&trial.run, kind).into_iter().enumerate().map(pair).collect()
    };
    let released = STEP_ERROR * elementary::tan(angle);
    let landed = released + per_flight * STEP_ERROR * trial.model.scales().length / speed;
    let releases = in_time(EventKind::Release, first, released);
    let impacts = in_time(EventKind::Impact, landing, landed);
    // a rest at the start and one after each landing, before the next release
    let rests = times(&trial.run, EventKind::Rest).len();
    let complete = (releases.len(), impacts.len(), rests) == (10, 10, 11);
    trial.worst("releases in periods", releases);
    trial.worst("landings in periods", impacts);
    trial.fact("ten flights each to rest", complete && landing.to_f64() < 1.0 + first.to_f64());
    Ok(vec![trial])
}

pub(super) fn impact_at_release(bench: &Bench) -> Trials {
    let closed_form = ClosedForm { amplitude: 1.2 };
    let leaves = closed_form.release();
    let gap = 0.1;
    // the gap at t* is linear in the start speed
    let missing = closed_form.flight((gap, dd(0.0)), dd(0.0), leaves).0;
    let exact = -(missing / leaves);
    let end = leaves.to_f64() + 0.3;
    let after = closed_form.flight((0.0, dd(0.0)), leaves, dd(end)).0.to_f64();
    let landing = closed_form.flight((gap, exact), dd(0.0), leaves).1.to_f64().abs();
    let mut trials = Vec::new();
    for (name, ulps) in [("just before", 8), ("at it", 0), ("just after", -8)] {
        // faster towards the stop lands sooner
        let rate = exact.to_f64();
        let speed = rate.abs() + f64::from(ulps) * f64::EPSILON * rate.abs();
        let toward = if rate < 0.0 { speed } else { -speed };
        let mut trial = bench.run(name, &pressed(gap, toward, 0.0, sine(1.0, 1.2, 0.0), end), &[])?;
        let (added, length) = (trial.added(), trial.model.scales().length);
        let late = (added + 8.0 * f64::EPSILON) * length / landing / leaves.to_f64();
        trial.time("time of impact", EventKind::Impact, leaves.to_f64(), late);
        trial.final_x("displacement 0.3 s later", 1.0 - after, 1.0, added);
        trial.fact("one impact", trial.impacts().count() == 1);
        trials.push(trial);
    }
    Ok(trials)
}
