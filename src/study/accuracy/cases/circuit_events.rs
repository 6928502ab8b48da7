//! Cases of a circuit with stops: decay at rest, releases that it decides, impacts at which it must not jump.

use super::HardCase;
use super::ball::times;
use super::circuit::{closed_form, electrical_size};
use crate::dynamics::EventKind;
use crate::numeric::{DoubleDouble, Number, Scalar, bisect};
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::{dd, exp, sin_cos};
use crate::study::accuracy::measure::{Bench, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, coil, layer, polynomial, right_stop, rigid, sine};

pub(super) const AT_REST: HardCase = HardCase {
    name: "circuit-at-rest",
    problem: "1 kg at 1 m on a stop, pulled off it by 1 N and pressed on it by a voltage that begins with 2 \
              N and decays, with time constants of 1 ms, 0.1 s and 4 s: nothing but the decay lets it go.",
    answer: "The voltage is u0 exp(-t/T); release at T ln 2; then, for 0.3 s, the exponential of the matrix \
             of mass and circuit.",
    conditioning: "An exponential of t/T rounded moves by t/T exp(-t/T) eps, below eps; the net force falls \
                   at 1/T of what is left of the voltage, so that d in its parts is 3 d T in the time, and d \
                   of the time scale in the motion that follows, n times.",
    find: at_rest,
};

fn at_rest(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let mut variants = Vec::new();
    for (name, constant) in [("1 ms", 1e-3), ("0.1 s", 0.1), ("4 s", 4.0)] {
        // 1 N/V and 1 uF
        let beside = |duration: f64| {
            let transducer = layer(1.0, 1e-6, constant / 1e-6);
            let mut setup = Setup::new(polynomial(&[1.0]), (1.0, 0.0), duration)
                .stops(right_stop(1000.0, 0.5))
                .beside(transducer, -2.0);
            setup.scene.mass_g = 1000.0;
            setup
        };
        let exact = closed_form(&beside(1.0), &beside(1.0).model()?, (0.0, 1.0));
        let rate = exact.rates().1;
        let two = |t: DoubleDouble| exp(rate * t) < dd(2.0);
        let released = bisect(dd(0.6 * constant), dd(0.8 * constant), 110, two).1;
        let setup = beside(released.to_f64() + 0.3);
        let model = setup.model()?;
        let mut at: Vec<f64> = (1..20).map(|i| 0.05 * f64::from(i) * released.to_f64()).collect();
        at.push(model.duration());
        let run = bench.run(&model, &at)?;
        let mut voltages: Vec<(f64, f64)> = Vec::new();
        for sample in run.samples.iter().filter(|sample| sample.t < released.to_f64()) {
            let voltage = -2.0 * exp(-(rate * dd(sample.t))).to_f64();
            voltages.push((off(sample.electrical, voltage, 2.0), STEP_ERROR));
        }
        let end = dd(model.duration());
        let left = [dd(1.0), dd(0.0), dd(-2.0) * exp(-(rate * released))];
        let [x, _, voltage] = exact.state(left, released, end).map(|value| value.to_f64());
        let released_at = times(&run, EventKind::Release).first().copied().unwrap_or(f64::NAN);
        let (scales, allowed) = (model.scales(), run.summary.steps as f64 * STEP_ERROR);
        let last = run.samples.last().map_or(f64::NAN, |sample| sample.electrical);
        let size = electrical_size(&model, &exact);
        let after = off(run.summary.final_x, x, scales.length).max(off(last, voltage, size));
        variants.push(
            Variant::of(name, &run)
                .worst("voltage at rest", voltages)
                .number(
                    "time of release",
                    off(released_at, released.to_f64(), released.to_f64()),
                    5.0 * STEP_ERROR,
                )
                .number("state 0.3 s later", after, allowed)
                .fact("one rest and one release", run.summary.rests == 1 && run.summary.releases == 1),
        );
    }
    Ok(variants)
}

pub(super) const RELEASE: HardCase = HardCase {
    name: "circuit-release",
    problem: "1 kg pressed on a stop by a force and by a voltage that decays, shaken at 1 Hz: released \
              during the decay, after it, and where the two leave a dip of the net force below 0 that is \
              1e-9 of it deep, or that ends 1e-9 above.",
    answer: "The first root of press + push exp(-t/T) - A sin(2 pi t), by bisection in double-double \
             arithmetic; above 0 there is none. The dip touches 0 at 0.15 s where press = A (sin a + w T cos \
             a) and push = -A w T cos a exp(0.15 s/T), a = 54 degrees.",
    conditioning: "d in each of the three over the slope of their sum; at the bottom of a dip of the depth h \
                   that is the root of 2 h times its curvature.",
    find: release,
};

/// A constant press, a push that decays, and a sine that pulls.
struct Pulls {
    press: f64,
    push: f64,
    rate: DoubleDouble,
    amplitude: f64,
}

impl Pulls {
    /// Net acceleration towards the stop at `t` in s, and its slope.
    fn net(&self, t: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
        let push = dd(self.push) * exp(-(self.rate * t));
        let (sin, cos) = sin_cos(DoubleDouble::tau() * t);
        let (sin, cos) = (dd(self.amplitude) * sin, dd(self.amplitude) * cos);
        (dd(self.press) + push - sin, -(self.rate * push) - DoubleDouble::tau() * cos)
    }

    /// The first root up to `until` in s, bracketed in steps of a 20 000th of it.
    fn root(&self, until: f64) -> Option<DoubleDouble> {
        let at = |i: u32| dd(until * f64::from(i) / 2e4);
        let is_pressed = |t: DoubleDouble| self.net(t).0 >= dd(0.0);
        let first = (1..=20_000).find(|i| !is_pressed(at(*i)))?;
        Some(bisect(at(first - 1), at(first), 110, is_pressed).1)
    }
}

fn release(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let (dip, turns) = (0.3, 0.15);
    let angle = std::f64::consts::TAU * turns;
    let reach = std::f64::consts::TAU * dip * angle.cos();
    let (press, push) = (angle.sin() + reach, -reach * (turns / dip).exp());
    let mut variants = Vec::new();
    for (name, constant, press, push, amplitude) in [
        ("during the decay", 0.1, 1.0, -0.6, 1.4),
        ("after the decay", 1e-4, 1.0, 0.9, 1.4),
        ("a slow decay", 300.0, 1.0, -0.1, 1.4),
        ("dip 1e-9 deep", dip, press * (1.0 - 1e-9), push, 1.0),
        ("dip 1e-9 short", dip, press * (1.0 + 1e-9), push, 1.0),
    ] {
        let setup = Setup::new(polynomial(&[-press]), (1.0, 0.0), 0.4)
            .stops(right_stop(1000.0, 0.5))
            .drive(sine(1.0, amplitude, 0.0))
            .beside(layer(1.0, 1e-6, constant / 1e-6), -push);
        let model = setup.model()?;
        let rate = closed_form(&setup, &model, (0.0, 0.0)).rates().1;
        let amplitude = model.excitation().tones[0].amplitude;
        let pulls = Pulls { press, push, rate, amplitude };
        let run = bench.run(&model, &[])?;
        let releases = times(&run, EventKind::Release);
        let variant = Variant::of(name, &run);
        variants.push(match pulls.root(0.4) {
            None => variant.fact("stays at rest", releases.is_empty() && run.summary.final_x == 1.0),
            Some(root) => {
                let (slope, t) = (pulls.net(root).1.to_f64().abs(), root.to_f64());
                let allowed = STEP_ERROR * (press + push.abs() + amplitude) / slope / t + f64::EPSILON;
                let error = releases.first().map_or(f64::NAN, |found| off(*found, t, t));
                variant.number("time of release", error, allowed)
            }
        });
    }
    Ok(variants)
}

pub(super) const AT_IMPACTS: HardCase = HardCase {
    name: "circuit-at-impacts",
    problem: "20 g on a spring of 50 N/m between stops at 2 mm with e = 0.8, shaken with 3 g at 11 Hz, \
              beside a coil with a time constant of 5 ms: 1 s, in which the speed turns at every impact and \
              the current must not.",
    answer: "The exponential of the matrix of mass, circuit and drive from impact to impact; their times are \
             its roots, by Newton's method in double-double arithmetic.",
    conditioning: "Sensitivity of each impact's time, and of the current there, to all data, by the \
                   reference; and a spacing of the doubles in the time at which it is sampled.",
    find: at_impacts,
};

/// A time in s so short that the state hardly changes in it, except at an impact.
const JUST: f64 = 1e-12;

const STOP: f64 = 0.002;
const RESTITUTION: f64 = 0.8;
const STIFFNESS: f64 = 50.0;

fn at_impacts(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let mut setup = Setup::new(polynomial(&[0.0, STIFFNESS]), (0.0, 0.4), 1.0)
        .damping(0.02)
        .stops(rigid(STOP * 1e3, RESTITUTION))
        .drive(sine(11.0, 29.4, 0.0))
        .beside(coil(5.0, 100.0, 0.5), 0.0);
    setup.scene.mass_g = 20.0;
    let model = setup.model()?;
    let impacts = times(&bench.run(&model, &[])?, EventKind::Impact);
    // the current at each impact, and just before it
    let at: Vec<f64> = impacts.iter().flat_map(|t| [t - JUST, *t]).collect();
    let run = bench.run(&model, &at)?;
    let exact = closed_form(&setup, &model, (STIFFNESS, 0.0));
    let stop = dd(model.stop_positions().1.unwrap_or(f64::NAN));
    let (mut state, mut since) = ([dd(model.start().0), dd(model.start().1), dd(0.0)], dd(0.0));
    let (mut hits, mut currents, mut inside) = (Vec::new(), Vec::new(), true);
    for t in &impacts {
        let mut hit = dd(*t);
        let side = if exact.state(state, since, hit)[0] > dd(0.0) { stop } else { -stop };
        for _ in 0..3 {
            let [x, v, _] = exact.state(state, since, hit);
            hit -= (x - side) / v;
        }
        let between = (1..8).map(|i| since + (hit - since) * dd(f64::from(i) / 8.0));
        inside &= between.into_iter().all(|t| exact.state(state, since, t)[0].abs() < stop);
        let [_, v, current] = exact.state(state, since, hit);
        (state, since) = ([side, -(dd(RESTITUTION) * v), current], hit);
        hits.push(hit.to_f64());
        currents.push(current.to_f64());
    }
    let sensitivity = bench.sensitivity(&setup, &at, |run| {
        let currents = run.samples.iter().skip(1).step_by(2).map(|sample| sample.electrical);
        times(run, EventKind::Impact).into_iter().chain(currents).collect()
    })?;
    let allowed = Bench::allowed(&model, run.summary.steps, &sensitivity);
    let size = electrical_size(&model, &exact);
    let late = impacts
        .iter()
        .zip(&hits)
        .zip(&allowed)
        .map(|((t, exact), allowed)| (off(*t, *exact, *exact), allowed / exact));
    let fastest = exact.coupling * model.scales().speed / exact.storage.to_f64();
    let pairs = run.samples.chunks(2).zip(&currents).zip(&allowed[impacts.len()..]);
    let off_by = pairs.map(|((pair, exact), allowed)| {
        let sampled = f64::EPSILON * pair[1].t * fastest;
        (off(pair[1].electrical, *exact, size), (allowed + sampled) / size)
    });
    let turns = run.samples.chunks(2).all(|pair| {
        let kept = off(pair[1].electrical, pair[0].electrical, size) < 1e-9;
        kept && off(pair[1].v, -RESTITUTION * pair[0].v, pair[0].v.abs()) < 1e-7
    });
    Ok(vec![
        Variant::of("1 s", &run)
            .worst("impact times", late)
            .worst("current at impacts", off_by)
            .fact("it stays inside between impacts", inside && impacts.len() > 20)
            .fact("the current is kept and the speed turned", turns),
    ])
}
