//! A circuit with stops: limits in which it vanishes, decay at rest, releases and impacts.

use std::f64::consts::TAU;

use super::linear::{closed_form, electrical_size};
use crate::accuracy::exact::{dd, exp, sin_cos};
use crate::accuracy::measure::{Bench, CHANGE, STEP_ERROR, Trials, hard_impacts, off, pairs, times};
use crate::accuracy::setup::{Setup, coil, layer, polynomial, rigid, sine, stops_at};
use crate::dynamics::EventKind;
use crate::numeric::{DoubleDouble, Number, Scalar, bisect, elementary};
use crate::scene::{Mechanism, Transducer};

pub(super) fn open_and_short(bench: &Bench) -> Trials {
    let nominal = || Setup::nominal(4.0, 0.36, sine(3.0, 14.7, 0.0), 1.0).start(4e-3, -0.1).damping(0.03);
    let (coupling, capacitance) = (0.01, 5e-6);
    let open = nominal().beside(layer(coupling, capacitance, f64::INFINITY), coupling * 4e-3 / capacitance);
    let mut spring = nominal();
    spring.scene.mechanism = Mechanism::Cubic {
        linear_n_per_m: -40.0 + coupling * coupling / capacitance,
        cubic_n_per_m3: 40.0 / 49e-6,
    };
    let mut reference = bench.reference(&open, &[], CHANGE, hard_impacts)?;
    reference.numbers = hard_impacts(&bench.exact(&spring, &[])?);
    let mut open = bench.run("open layer", &open, &[])?;
    open.impacts_beside(&reference, hard_impacts);
    let mut trials = vec![open];
    let bare = bench.run("", &nominal(), &[])?.run;
    let coil_damping = 0.5 * (0.5 / 100.0);
    let damped = bench.run("", &nominal().damping(0.03 + coil_damping), &[])?.run;
    let of_100_ohm = |load_ohm: f64, inductance_mh: f64| Transducer::Electromagnetic {
        coupling_v_s_per_m: 0.5,
        coil_ohm: 100.0,
        load_ohm,
        inductance_mh,
    };
    for (name, transducer, same) in [
        ("short-circuited layer", layer(coupling, capacitance, 0.0), &bare),
        ("short-circuited coil", of_100_ohm(0.0, 0.0), &damped),
        ("open coil", of_100_ohm(f64::INFINITY, 1e3), &bare),
    ] {
        let mut trial = bench.run(name, &nominal().beside(transducer, 0.0), &[])?;
        let run = &trial.run;
        let equal = run.events == same.events && run.summary.final_x == same.summary.final_x;
        trial.fact("the same bits", equal && trial.run.events.len() > 10);
        trials.push(trial);
    }
    Ok(trials)
}

pub(super) fn circuit_at_rest(bench: &Bench) -> Trials {
    let mut trials = Vec::new();
    for (name, constant) in [("1 ms", 1e-3), ("0.1 s", 0.1), ("4 s", 4.0)] {
        // 1 N/V and 1 uF
        let mut setup = Setup::new(polynomial(&[1.0]), (1.0, 0.0), 1.0)
            .stops(stops_at(None, Some(1000.0), 0.5))
            .beside(layer(1.0, 1e-6, constant / 1e-6), -2.0);
        let exact = closed_form(&setup, &setup.model()?, 0.0, 1.0);
        let rate = exact.rates().1;
        let two = |t: DoubleDouble| exp(rate * t) < dd(2.0);
        let released = bisect(dd(0.6 * constant), dd(0.8 * constant), 110, two).1;
        let release = released.to_f64();
        let end = release + 0.3;
        setup.scene.run.duration_s = end;
        let at: Vec<f64> = (1..20).map(|i| 0.05 * f64::from(i) * release).chain([end]).collect();
        let mut trial = bench.run(name, &setup, &at)?;
        let samples = &trial.run.samples;
        let voltages = samples.iter().filter(|sample| sample.t < release).map(|sample| {
            let voltage = -2.0 * exp(-(rate * dd(sample.t))).to_f64();
            (off(sample.electrical, voltage, 2.0), STEP_ERROR)
        });
        let voltages = voltages.collect();
        let left = [dd(1.0), dd(0.0), dd(-2.0) * exp(-(rate * released))];
        let [x, _, voltage] = exact.state(left, released, dd(end)).map(|value| value.to_f64());
        let last = samples.last().map_or(f64::NAN, |sample| sample.electrical);
        let size = electrical_size(&trial.model, &exact);
        let summary = trial.run.summary;
        let after = off(summary.final_x, x, trial.model.scales().length).max(off(last, voltage, size));
        trial.worst("voltage at rest", voltages);
        trial.time("time of release", EventKind::Release, release, 5.0 * STEP_ERROR);
        trial.number("state 0.3 s later", after, trial.added());
        trial.fact("one rest and one release", summary.rests == 1 && summary.releases == 1);
        trials.push(trial);
    }
    Ok(trials)
}

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

pub(super) fn circuit_release(bench: &Bench) -> Trials {
    let (dip, turns) = (0.3, 0.15);
    let angle = TAU * turns;
    let reach = TAU * dip * elementary::cos(angle);
    let (press, push) = (elementary::sin(angle) + reach, -reach * elementary::exp(turns / dip));
    let mut trials = Vec::new();
    for (name, constant, press, push, amplitude) in [
        ("during the decay", 0.1, 1.0, -0.6, 1.4),
        ("after the decay", 1e-4, 1.0, 0.9, 1.4),
        ("a slow decay", 300.0, 1.0, -0.1, 1.4),
        ("dip 1e-9 deep", dip, press * (1.0 - 1e-9), push, 1.0),
        ("dip 1e-9 short", dip, press * (1.0 + 1e-9), push, 1.0),
    ] {
        let setup = Setup::new(polynomial(&[-press]), (1.0, 0.0), 0.4)
            .stops(stops_at(None, Some(1000.0), 0.5))
            .drive(sine(1.0, amplitude, 0.0))
            .beside(layer(1.0, 1e-6, constant / 1e-6), -push);
        let mut trial = bench.run(name, &setup, &[])?;
        let rate = closed_form(&setup, &trial.model, 0.0, 0.0).rates().1;
        let amplitude = trial.model.excitation().tones[0].amplitude;
        let pulls = Pulls { press, push, rate, amplitude };
        match pulls.root(0.4) {
            None => {
                let stays = trial.first(EventKind::Release).is_nan() && trial.run.summary.final_x == 1.0;
                trial.fact("stays at rest", stays);
            }
            Some(root) => {
                let (slope, t) = (pulls.net(root).1.to_f64().abs(), root.to_f64());
                let allowed = STEP_ERROR * (press + push.abs() + amplitude) / slope / t + f64::EPSILON;
                trial.time("time of release", EventKind::Release, t, allowed);
            }
        }
        trials.push(trial);
    }
    Ok(trials)
}

pub(super) fn circuit_at_impacts(bench: &Bench) -> Trials {
    /// A time in s so short that the state hardly changes in it, except at an impact.
    const JUST: f64 = 1e-12;
    const RESTITUTION: f64 = 0.8;
    const STIFFNESS: f64 = 50.0;
    let mut setup = Setup::new(polynomial(&[0.0, STIFFNESS]), (0.0, 0.4), 1.0)
        .damping(0.02)
        .stops(rigid(2.0, RESTITUTION))
        .drive(sine(11.0, 29.4, 0.0))
        .beside(coil(5.0, 100.0, 0.5), 0.0);
    setup.scene.mass_g = 20.0;
    let impacts = times(&bench.run("", &setup, &[])?.run, EventKind::Impact);
    // the current at each impact, and just before it
    let at: Vec<f64> = impacts.iter().flat_map(|t| [t - JUST, *t]).collect();
    let mut trial = bench.run("1 s", &setup, &at)?;
    let model = &trial.model;
    let exact = closed_form(&setup, model, STIFFNESS, 0.0);
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
    let reference = bench.reference(&setup, &at, CHANGE, |run| {
        let currents = run.samples.iter().skip(1).step_by(2).map(|sample| sample.electrical);
        times(run, EventKind::Impact).into_iter().chain(currents).collect()
    })?;
    let allowed = reference.allowed(&trial);
    let size = electrical_size(model, &exact);
    let late = pairs(&impacts, &hits, &allowed, &hits);
    let fastest = exact.coupling * model.scales().speed / exact.storage.to_f64();
    let samples = || trial.run.samples.chunks(2);
    let of_currents = samples().zip(&currents).zip(&allowed[impacts.len()..]);
    let of_currents = of_currents.map(|((pair, exact), allowed)| {
        let sampled = f64::EPSILON * pair[1].t * fastest;
        (off(pair[1].electrical, *exact, size), (allowed + sampled) / size)
    });
    let of_currents = of_currents.collect();
    let turns = samples().all(|pair| {
        let kept = off(pair[1].electrical, pair[0].electrical, size) < 1e-9;
        kept && off(pair[1].v, -RESTITUTION * pair[0].v, pair[0].v.abs()) < 1e-7
    });
    trial.worst("impact times", late);
    trial.worst("current at impacts", of_currents);
    trial.fact("it stays inside between impacts", inside && impacts.len() > 20);
    trial.fact("the current is kept and the speed turned", turns);
    Ok(vec![trial])
}
