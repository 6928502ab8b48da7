//! Cases of release: near the threshold, at it, and after plastic impacts.

use super::HardCase;
use super::ball::times;
use crate::dynamics::EventKind;
use crate::numeric::{DoubleDouble, Scalar};
use crate::scene::Excitation;
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::{Pressed, dd, sine_turns};
use crate::study::accuracy::measure::{Bench, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, constant, polynomial, right_stop, sine};

pub(super) const THRESHOLD: HardCase = HardCase {
    name: "release-threshold",
    problem: "Pressed on a stop at 4 mm of the nominal cubic well, shaken at 3 Hz with the release amplitude \
              |F(D)|/m times 1 +- 1e-6 and 1 +- 1e-10.",
    answer: "Above: released at asin(s)/(2 pi f), s the ratio of |F(D)|/m to the amplitude, from the very \
             doubles of the scene. Below: never.",
    conditioning: "An error of d in press or amplitude moves the angle by d tan(angle), relatively d \
                   tan(angle)/angle.",
    find: threshold,
};

const D_MM: f64 = 4.0;

/// |F(D)|/m of the nominal cubic in m/s^2, from the doubles of its scene.
fn threshold_acceleration() -> DoubleDouble {
    let d = dd(D_MM / 1e3);
    let force = dd(40.0) * d - dd(40.0 / 49e-6) * d * d * d;
    force / dd(15.2 / 1e3)
}

fn threshold(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let mut variants = Vec::new();
    for (name, over) in
        [("1e-6 above", 1e-6), ("1e-6 below", -1e-6), ("1e-10 above", 1e-10), ("1e-10 below", -1e-10)]
    {
        let amplitude = threshold_acceleration().to_f64() * (1.0 + over);
        let model = Setup::nominal(D_MM, 0.36, sine(3.0, amplitude, 0.0), 0.3).model()?;
        let run = bench.run(&model, &[])?;
        let released = times(&run, EventKind::Release);
        let variant = Variant::of(name, &run);
        variants.push(if over > 0.0 {
            let amplitude = dd(model.excitation().tones[0].amplitude);
            let exact = (sine_turns(threshold_acceleration() / amplitude) / dd(3.0)).to_f64();
            let angle = exact * 3.0 * std::f64::consts::TAU;
            let error = released.first().map_or(f64::NAN, |t| off(*t, exact, exact));
            variant.number("time of release", error, STEP_ERROR * angle.tan() / angle)
        } else {
            variant.fact("stays at rest", released.is_empty() && run.summary.final_x == D_MM / 1e3)
        });
    }
    Ok(variants)
}

pub(super) const ZERO_SLOPE: HardCase = HardCase {
    name: "release-zero-slope",
    problem: "Pressed with exactly 1 m/s^2 and shaken with exactly 1 m/s^2: the press touches 0 in each \
              crest without changing sign; by a sine and by a constant with a sine.",
    answer: "It stays at rest for all 20 periods: a touch is no release.",
    conditioning: "A fact: press and crest are the same double.",
    find: zero_slope,
};

fn zero_slope(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let sum = Excitation::Sum(vec![constant(0.5), sine(1.0, 0.5, 90.0)]);
    let mut variants = Vec::new();
    for (name, drive) in [("sine", sine(1.0, 1.0, 0.0)), ("constant + sine", sum)] {
        let model = Setup::new(polynomial(&[-1.0]), (1.0, 0.0), 20.25)
            .stops(right_stop(1000.0, 0.36))
            .drive(drive)
            .model()?;
        let run = bench.run(&model, &[])?;
        let crest = (0..=4).map(|i| model.base_acceleration(0.25 * f64::from(i))).fold(0.0, f64::max);
        variants.push(
            Variant::of(name, &run)
                .fact("the crest is the press", crest == 1.0)
                .fact("stays at rest", run.summary.final_x == 1.0 && run.summary.total_impacts == 0),
        );
    }
    Ok(variants)
}

pub(super) const BIAS: HardCase = HardCase {
    name: "bias-at-threshold",
    problem: "On a stop with a constant base acceleration of exactly |F(D)|/m: nothing presses and nothing \
              pulls; and with the next double on either side, for 1 s.",
    answer: "It stays where it is; pressed by a spacing of the doubles u it rests; pulled by u it goes -u \
             t^2/2.",
    conditioning: "Facts, and a displacement of 1e-16 m, which D = 1 m rounds to a spacing of the doubles: 2 \
                   eps.",
    find: bias,
};

fn bias(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let mut variants = Vec::new();
    let base = constant(1.0);
    let Excitation::Constant { accel_g } = base else { return Ok(variants) };
    let neighbours =
        [("at it", accel_g), ("just below", accel_g.next_down()), ("just above", accel_g.next_up())];
    for (name, accel_g) in neighbours {
        let model = Setup::new(polynomial(&[-1.0]), (1.0, 0.0), 1.0)
            .stops(right_stop(1000.0, 0.36))
            .drive(Excitation::Constant { accel_g })
            .model()?;
        let run = bench.run(&model, &[])?;
        let net = 1.0 - model.base_acceleration(0.0);
        let gone = if net < 0.0 { 0.5 * net } else { 0.0 };
        variants.push(
            Variant::of(name, &run)
                .number("displacement", off(run.summary.final_x, 1.0 + gone, 1.0), 2.0 * f64::EPSILON)
                .fact("no impact in few steps", run.summary.total_impacts == 0 && run.summary.steps < 100),
        );
    }
    Ok(variants)
}

pub(super) const PLASTIC: HardCase = HardCase {
    name: "plastic-sine",
    problem: "Pressed with 1 m/s^2 on a plastic stop (e = 0) and shaken with 1.8 m/s^2 at 1 Hz for 10 \
              periods: released, flies, lands, rests, is released again.",
    answer: "Release at asin(1/1.8)/(2 pi) and whole periods later; the flight in closed form and its \
             landing by bisection, in double-double arithmetic.",
    conditioning: "A release is known to d tan(angle); in flight each of s steps adds d L, and the landing \
                   at speed u is off by that over u. Nothing is carried over a rest.",
    find: plastic,
};

fn plastic(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let pressed = Pressed { press: 1.0, amplitude: 1.8, frequency: 1.0 };
    let model = Setup::new(polynomial(&[-1.0]), (1.0, 0.0), 10.0)
        .stops(right_stop(1000.0, 0.0))
        .drive(sine(1.0, 1.8, 0.0))
        .model()?;
    let run = bench.run(&model, &[])?;
    let first = pressed.release();
    let landing = pressed.landing(first).unwrap_or(dd(f64::NAN));
    let speed = pressed.flight((dd(0.0), dd(0.0)), first, landing).1.to_f64().abs();
    let angle = (1.0_f64 / 1.8).asin();
    let per_flight = run.summary.steps as f64 / 10.0;
    let in_time = |found: Vec<f64>, first: DoubleDouble, allowed: f64| {
        let pairs: Vec<_> = found
            .into_iter()
            .enumerate()
            .map(move |(i, t)| {
                let exact = (first + dd(i as f64)).to_f64();
                (off(t, exact, 1.0), allowed + f64::EPSILON * exact)
            })
            .collect();
        pairs
    };
    let released = STEP_ERROR * angle.tan();
    let landed = released + per_flight * STEP_ERROR * model.scales().length / speed;
    let releases = in_time(times(&run, EventKind::Release), first, released);
    let impacts = in_time(times(&run, EventKind::Impact), landing, landed);
    let rests = times(&run, EventKind::Rest);
    // a rest at the start and one after each landing, before the next release
    let complete = (releases.len(), impacts.len()) == (10, 10) && rests.len() == 11;
    Ok(vec![
        Variant::of("10 periods", &run)
            .worst("releases in periods", releases)
            .worst("landings in periods", impacts)
            .fact("ten flights each to rest", complete && landing.to_f64() < 1.0 + first.to_f64()),
    ])
}
