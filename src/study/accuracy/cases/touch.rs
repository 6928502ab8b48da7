//! Contacts that are easily missed or found twice: grazing, tiny excursions, narrow gaps, coincidences.

use std::f64::consts::FRAC_PI_2;

use super::HardCase;
use super::ball::times;
use crate::dynamics::{EventKind, Side};
use crate::numeric::Scalar;
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::{Pressed, dd, sine_turns};
use crate::study::accuracy::measure::{Bench, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, polynomial, right_stop, rigid, sine};

pub(super) const GRAZING: HardCase = HardCase {
    name: "grazing",
    problem: "x = sin t (1 kg, 1 N/m, from 0 with 1 m/s) and an elastic stop exactly at its crest, 1e-12 m \
              beyond it, 1e-12 m before it.",
    answer: "Beyond: no impact, x(3) = sin 3. Before, by h: impact at asin(1 - h) with u = sqrt(2 h - h^2), \
             then the phase goes on mirrored. Exactly: at most one impact, of a speed that rounding gives.",
    conditioning: "n d in the state. At the stop an error of n d in the energy is one of n d/u in the speed: \
                   relatively n d/u^2, which for 1e-12 m leaves three digits; its effect on what follows is \
                   2 n d/u. A graze exactly at the stop has u = sqrt(2 n d) at most, and turns the phase by \
                   up to twice that.",
    find: grazing,
};

pub(super) const EXCURSION: HardCase = HardCase {
    name: "excursion",
    problem: "The same with the stop 1e-10 m before the crest: out and back takes 28 us, a \
              hundred-thousandth of a step, and both ends of the step lie inside.",
    answer: "One impact at asin(1 - h) with u = sqrt(2 h - h^2).",
    conditioning: "As for grazing: n d/u^2 in the speed, n d/u in the time.",
    find: excursion,
};

fn grazing(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let mut variants = vec![];
    for (name, beyond) in [("1e-12 m beyond", 1e-12), ("exactly", 0.0), ("1e-12 m before", -1e-12)] {
        variants.push(crest(bench, name, 1.0 + beyond)?);
    }
    Ok(variants)
}

fn excursion(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    Ok(vec![crest(bench, "1e-10 m before", 1.0 - 1e-10)?])
}

/// The orbit sin t with an elastic stop near its crest.
fn crest(bench: &Bench, name: &'static str, stop: f64) -> Result<Variant, Stopped> {
    let model =
        Setup::new(polynomial(&[0.0, 1.0]), (0.0, 1.0), 3.0).stops(right_stop(stop * 1e3, 1.0)).model()?;
    let run = bench.run(&model, &[])?;
    let stop = model.stop_positions().1.unwrap_or(f64::NAN);
    let n = run.summary.steps as f64;
    let depth = 1.0 - stop;
    let variant = Variant::of(name, &run).fact("few steps", n < 40.0);
    let impacts: Vec<_> = run.events.iter().filter(|event| event.kind == EventKind::Impact).collect();
    let straight = off(run.summary.final_x, 3.0_f64.sin(), 1.0);
    Ok(if depth < 0.0 {
        variant.fact("no impact", impacts.is_empty()).number("displacement at 3 s", straight, n * STEP_ERROR)
    } else if depth == 0.0 {
        let touched = 2.0 * (2.0 * n * STEP_ERROR).sqrt();
        variant.fact("at most one impact and no rest", impacts.len() <= 1 && run.summary.rests == 0).number(
            "displacement at 3 s",
            straight,
            touched,
        )
    } else {
        let speed = (depth * (2.0 - depth)).sqrt();
        let angle = (sine_turns(dd(stop)) * crate::numeric::DoubleDouble::tau()).to_f64();
        let (late, slow) = impacts.first().map_or((f64::NAN, f64::NAN), |impact| {
            (off(impact.t, angle, angle), off(impact.v_in, speed, speed))
        });
        // the impact cuts off the crest: the rest of the wave comes earlier by the duration of the crest
        let cut = 2.0 * (FRAC_PI_2 - angle);
        let error = off(run.summary.final_x, (3.0 + cut).sin(), 1.0);
        variant
            .fact("one impact", impacts.len() == 1)
            .number("time of impact", late, n * STEP_ERROR / speed)
            .number("speed of impact", slow, n * STEP_ERROR / (speed * speed))
            .number("displacement at 3 s", error, n * STEP_ERROR * (1.0 + 2.0 / speed))
    })
}

pub(super) const GAP: HardCase = HardCase {
    name: "narrow-gap",
    problem: "A free mass with 1 m/s between elastic stops 2 um apart: 5000 impacts in 10 ms, on opposite \
              stops, many within what would be one step.",
    answer: "The i-th impact, from 0, at (2 i + 1) D/v, right and left in turn.",
    conditioning: "As for the elastic box: d + eps.",
    find: gap,
};

fn gap(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let model = Setup::new(polynomial(&[0.0]), (0.0, 1.0), 0.01).stops(rigid(0.001, 1.0)).model()?;
    let run = bench.run(&model, &[])?;
    let distance = model.stop_positions().1.unwrap_or(f64::NAN);
    let impacts = run.events.iter().filter(|event| event.kind == EventKind::Impact);
    let late = impacts.clone().enumerate().map(|(i, impact)| {
        let exact = (dd(2.0 * i as f64 + 1.0) * dd(distance)).to_f64();
        (off(impact.t, exact, exact), STEP_ERROR + f64::EPSILON)
    });
    let turns = |(i, side): (usize, Side)| side == if i % 2 == 0 { Side::Right } else { Side::Left };
    let in_turn = impacts.clone().map(|impact| impact.side).enumerate().all(turns);
    Ok(vec![
        Variant::of("5000 impacts", &run)
            .worst("impact times", late)
            .fact("all in turn", in_turn && run.summary.total_impacts == 5000),
    ])
}

pub(super) const COINCIDENT: HardCase = HardCase {
    name: "impact-at-release",
    problem: "Pressed with 1 m/s^2 against a plastic stop and shaken with 1.2 m/s^2 at 1 Hz, thrown so that \
              it lands at the very instant t* at which the press changes sign; and with the speeds 8 \
              spacings of the doubles on either side.",
    answer: "Landed before, it rests for an instant and is released; after, it leaves at once: either way it \
             starts from rest at t*, then in closed form, 0.3 s.",
    conditioning: "The landing is off t* by 8 eps of the flight and n d L over its speed, e. A rest or a \
                   flight in that time changes the start by a e^2, a the press's change: nothing; n d is \
                   left.",
    find: coincident,
};

fn coincident(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let pressed = Pressed { press: 1.0, amplitude: 1.2, frequency: 1.0 };
    let leaves = pressed.release();
    let gap = 0.1;
    // the gap at t* is linear in the start speed
    let missing = pressed.flight((dd(gap), dd(0.0)), dd(0.0), leaves).0;
    let exact = -(missing / leaves);
    let end = leaves.to_f64() + 0.3;
    let mut variants = Vec::new();
    for (name, ulps) in [("just before", 8), ("at it", 0), ("just after", -8)] {
        // faster towards the stop lands sooner
        let rate = exact.to_f64();
        let speed = rate.abs() + f64::from(ulps) * f64::EPSILON * rate.abs();
        let toward = if rate < 0.0 { speed } else { -speed };
        let model = Setup::new(polynomial(&[-1.0]), (1.0 - gap, toward), end)
            .stops(right_stop(1000.0, 0.0))
            .drive(sine(1.0, 1.2, 0.0))
            .model()?;
        let run = bench.run(&model, &[])?;
        let after = pressed.flight((dd(0.0), dd(0.0)), leaves, dd(end)).0;
        let impacts = times(&run, EventKind::Impact);
        let late = impacts.first().map_or(f64::NAN, |t| off(*t, leaves.to_f64(), leaves.to_f64()));
        let landing = pressed.flight((dd(gap), exact), dd(0.0), leaves).1.to_f64().abs();
        let n = run.summary.steps as f64;
        let scales = model.scales();
        let moved = n * STEP_ERROR + 8.0 * f64::EPSILON;
        variants.push(
            Variant::of(name, &run)
                .number("time of impact", late, moved * scales.length / landing / leaves.to_f64())
                .number(
                    "displacement 0.3 s later",
                    off(run.summary.final_x, 1.0 - after.to_f64(), 1.0),
                    n * STEP_ERROR,
                )
                .fact("one impact", impacts.len() == 1),
        );
    }
    Ok(variants)
}
