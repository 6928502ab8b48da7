//! A linear oscillator under every drive and beside circuits: stiff, strongly coupled, resistive.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::accuracy::Stopped;
use crate::accuracy::exact::{Coupled, Forcing, Oscillator, State, dd};
use crate::accuracy::measure::{Bench, Trial, Trials, off};
use crate::accuracy::setup::{Setup, coil, layer, polynomial, sine};
use crate::dynamics::{Model, STANDARD_GRAVITY, TonePart};
use crate::numeric::Scalar;
use crate::scene::{Excitation, Record, Transducer};

const MASS: f64 = 0.02;
const STIFFNESS: f64 = 50.0;

/// 20 g on a spring of 50 N/m (7.96 Hz), damped by `c` in N s/m, from 2 mm with -0.1 m/s.
fn sprung(c: f64, drive: Excitation, duration: f64) -> Setup {
    let spring = polynomial(&[0.0, STIFFNESS]);
    let mut setup = Setup::new(spring, (0.002, -0.1), duration).damping(c).drive(drive);
    setup.scene.mass_g = MASS * 1e3;
    setup
}

fn even(duration: f64, count: usize) -> Vec<f64> {
    (1..=count).map(|i| duration * i as f64 / (count as f64 + 0.5)).collect()
}

/// The forcings of the tones of a model, from its exact doubles; a ramp as it is before its end.
fn tones(model: &Model) -> Vec<Forcing> {
    let tone = |tone: &TonePart| {
        let (amplitude, growth) = tone.ramp.map_or((tone.amplitude, dd(0.0)), |(from, over)| {
            (from, (dd(tone.amplitude) - dd(from)) / dd(over))
        });
        let phase = tone.phase + if tone.quarter { 0.25 } else { 0.0 };
        Forcing::Tone { amplitude, growth, frequency: tone.frequency, phase }
    };
    model.excitation().tones.iter().map(tone).collect()
}

fn start(model: &Model) -> State {
    (dd(model.start().0), dd(model.start().1))
}

/// 97 samples of a run beside displacement and velocity at a time in s.
fn sampled(bench: &Bench, name: &'static str, setup: &Setup, exact: impl Fn(&Model, f64) -> State) -> Trials {
    let mut trial = bench.run(name, setup, &even(setup.scene.run.duration_s, 97))?;
    let model = trial.model.clone();
    let fastest = model.excitation().fastest().unwrap_or(0.0);
    trial.linear("state at 97 samples", fastest, |sample| {
        let (x, v) = exact(&model, sample.t);
        (x.to_f64(), v.to_f64(), None)
    });
    Ok(vec![trial])
}

/// The same under the tones of its model.
fn superposed(bench: &Bench, name: &'static str, setup: &Setup, oscillator: Oscillator) -> Trials {
    let forcings = tones(&setup.model()?);
    sampled(bench, name, setup, |model, t| oscillator.state(start(model), dd(0.0), dd(t), &forcings))
}

pub(super) fn ripple(bench: &Bench) -> Trials {
    let parts = vec![sine(0.5, STANDARD_GRAVITY, 0.0), sine(500.0, 1e-3 * STANDARD_GRAVITY, 0.0)];
    let setup = sprung(0.08, Excitation::Sum(parts), 5.0);
    superposed(bench, "1 : 1000", &setup, Oscillator::new(MASS, 0.08, STIFFNESS))
}

pub(super) fn fast_drive(bench: &Bench) -> Trials {
    let setup = Setup::new(polynomial(&[0.0, 1.0]), (0.0, 0.0), 10.0).drive(sine(1e4 / TAU, 1e4, 0.0));
    superposed(bench, "w = 1e4", &setup, Oscillator::new(1.0, 0.0, 1.0))
}

pub(super) fn noise(bench: &Bench) -> Trials {
    let drive = Excitation::Noise { rms_g: 0.5, low_hz: 1.0, high_hz: 40.0, seed: 7, lines: 256 };
    superposed(bench, "256 lines", &sprung(0.08, drive, 10.0), Oscillator::new(MASS, 0.08, STIFFNESS))
}

pub(super) fn long_ramp(bench: &Bench) -> Trials {
    const OVER: f64 = 300.0;
    let drive = Excitation::AmplitudeRamp { frequency_hz: 3.0, from_g: 0.0, to_g: 2.0, over_s: OVER };
    let setup = sprung(0.05, drive, OVER + 10.0);
    let model = setup.model()?;
    let oscillator = Oscillator::new(MASS, 0.05, STIFFNESS);
    let ramp = tones(&model);
    let amplitude = model.excitation().tones[0].amplitude;
    let hold = [Forcing::Tone { amplitude, growth: dd(0.0), frequency: 3.0, phase: 0.0 }];
    let end = oscillator.state(start(&model), dd(0.0), dd(OVER), &ramp);
    sampled(bench, "300 s", &setup, |model, t| match t < OVER {
        true => oscillator.state(start(model), dd(0.0), dd(t), &ramp),
        false => oscillator.state(end, dd(OVER), dd(t), &hold),
    })
}

pub(super) fn shock(bench: &Bench) -> Trials {
    let peak = 50.0 * STANDARD_GRAVITY;
    let record = Record::new(vec![0.0995, 0.1005, 0.1015], vec![0.0, peak, 0.0]);
    recorded(bench, "50 g in 2 ms", record, 1.0)
}

pub(super) fn record(bench: &Bench) -> Trials {
    // fractional parts of multiples of the golden ratio: as uneven as random numbers, the same everywhere
    let jump = |i: u32| (f64::from(i) * 0.618_033_988_749_894_9).fract() - 0.5;
    let times = (0..1000_u32).map(|i| f64::from(i) * 0.005).collect();
    let accelerations = (0..1000_u32).map(|i| STANDARD_GRAVITY * jump(i)).collect();
    recorded(bench, "1000 samples", Record::new(times, accelerations), 5.0)
}

/// An oscillator under a record and, after it, left alone.
fn recorded(bench: &Bench, name: &'static str, record: Record, duration: f64) -> Trials {
    let record = Arc::new(record);
    let drive = Excitation::Recorded { path: "shock".to_owned(), record: Some(Arc::clone(&record)) };
    let setup = sprung(0.05, drive, duration);
    let oscillator = Oscillator::new(MASS, 0.05, STIFFNESS);
    // the state at the start of each line, and the line
    let mut joints = vec![(0.0, start(&setup.model()?), None)];
    let line = |i: usize| {
        let (t0, t1) = (dd(record.times[i]), dd(record.times[i + 1]));
        let (a0, a1) = (dd(record.accelerations[i]), dd(record.accelerations[i + 1]));
        let slope = (a1 - a0) / (t1 - t0);
        Forcing::Line { value: a0 - slope * t0, slope }
    };
    let state = |joints: &[(f64, _, Option<Forcing>)], t: f64| {
        let after = joints.partition_point(|joint| joint.0 <= t);
        let (from, start, forcing) = joints[after.saturating_sub(1)];
        oscillator.state(start, dd(from), dd(t), forcing.as_slice())
    };
    for (i, t) in record.times.iter().enumerate().filter(|(_, t)| **t <= duration) {
        let now = state(&joints, *t);
        joints.push((*t, now, (i + 1 < record.times.len()).then(|| line(i))));
    }
    sampled(bench, name, &setup, |_, t| state(&joints, t))
}

/// Coefficient of the damping beside circuits, N s/m.
const DAMPING: f64 = 0.08;

/// The oscillator with a circuit without current or voltage at the start, shaken with 1 g at 7 Hz.
fn with_circuit(transducer: Transducer, duration: f64) -> Setup {
    sprung(DAMPING, sine(7.0, 9.8, 0.0), duration).beside(transducer, 0.0)
}

/// The closed form of an oscillator with this stiffness, constant force and the circuit of its scene, from
/// the exact doubles of the scene.
pub(super) fn closed_form(setup: &Setup, model: &Model, stiffness: f64, force: f64) -> Coupled {
    let (coupling, storage, loss) = match setup.scene.transducer {
        Transducer::Electromagnetic { coupling_v_s_per_m, coil_ohm, load_ohm, inductance_mh } => {
            (coupling_v_s_per_m, dd(inductance_mh) / dd(1e3), dd(coil_ohm) + dd(load_ohm))
        }
        Transducer::Piezoelectric { coupling_n_per_v, capacitance_nf, load_kohm } => {
            (coupling_n_per_v, dd(capacitance_nf) / dd(1e9), dd(1e-3) / dd(load_kohm))
        }
        Transducer::None => (0.0, dd(1.0), dd(0.0)),
    };
    let tone = model.excitation().tones.first().map_or((0.0, 0.0, 0.0), |tone| {
        (tone.amplitude, tone.frequency, tone.phase + if tone.quarter { 0.25 } else { 0.0 })
    });
    let (mass, damping) = (model.mass(), model.damping());
    Coupled { mass, damping, stiffness, force, coupling, storage, loss, tone }
}

/// Size of the electrical state that a motion of the model's scales induces: limited by its coupling and by
/// its kinetic energy, and no less than at the start.
pub(super) fn electrical_size(model: &Model, exact: &Coupled) -> f64 {
    let (coupling, decay) = exact.rates();
    let time = model.scales().time;
    let moved = coupling.to_f64().abs() * time / (1.0 + decay.to_f64() * time);
    (exact.amount().to_f64() * model.scales().speed * moved.min(1.0)).max(model.start_electrical().abs())
}

/// The oscillator with a circuit beside the exponential of its matrix.
fn coupled(bench: &Bench, name: &'static str, setup: &Setup) -> Result<Trial, Stopped> {
    let mut trial = bench.run(name, setup, &even(setup.scene.run.duration_s, 41))?;
    let exact = closed_form(setup, &trial.model, STIFFNESS, 0.0);
    let (x, v) = start(&trial.model);
    let (start, size) = ([x, v, dd(trial.model.start_electrical())], electrical_size(&trial.model, &exact));
    trial.linear("state at 41 samples", exact.tone.1, |sample| {
        let [x, v, s] = exact.state(start, dd(0.0), dd(sample.t)).map(|value| value.to_f64());
        (x, v, Some(off(sample.electrical, s, size)))
    });
    trial.energy_balance();
    Ok(trial)
}

pub(super) fn stiff_circuit(bench: &Bench) -> Trials {
    let stiff = [
        ("coil 10 us", coil(5.0, 100.0, 1e-3)),
        ("coil 1 us", coil(5.0, 100.0, 1e-4)),
        ("layer 1 us", layer(1e-3, 1e-9, 1e3)),
    ];
    stiff.into_iter().map(|(name, circuit)| coupled(bench, name, &with_circuit(circuit, 0.2))).collect()
}

pub(super) fn strong_coupling(bench: &Bench) -> Trials {
    // K/sqrt(m S) of 5e3 and 5e4 1/s beside 50 1/s
    let strong = [
        ("coil 100 times", coil(22.36, 0.1, 1e-3)),
        ("coil 1000 times", coil(223.6, 0.1, 1e-3)),
        ("layer 100 times", layer(0.7, 1e-6, 1e6)),
    ];
    strong.into_iter().map(|(name, circuit)| coupled(bench, name, &with_circuit(circuit, 1.0))).collect()
}

pub(super) fn no_inductance(bench: &Bench) -> Trials {
    let (coupling, resistance) = (5.0, 100.0);
    let limit = with_circuit(coil(coupling, resistance, 0.0), 0.5);
    let mut none = bench.run("none", &limit, &even(0.5, 41))?;
    let (model, scales) = (none.model.clone(), none.model.scales());
    let damped = Oscillator::new(MASS, DAMPING + coupling * (coupling / resistance), STIFFNESS);
    let forcings = tones(&model);
    none.linear("state and current at 41 samples", 7.0, |sample| {
        let (x, v) = damped.nearest(model.start(), 0.0, sample.t, &forcings);
        let current = model.output(sample).map_or(f64::NAN, |output| output.current);
        let error = off(current, coupling * v / resistance, coupling * scales.speed / resistance);
        (x, v, Some(error))
    });
    none.fact("no state of its own", !model.has_electrical_state());
    let mut trials = Vec::new();
    let mut apart = Vec::new();
    for (name, time_constant) in [("1 ms", 1e-3), ("0.1 ms", 1e-4), ("10 us", 1e-5)] {
        let setup = with_circuit(coil(coupling, resistance, resistance * time_constant), 0.5);
        let trial = coupled(bench, name, &setup)?;
        let distances =
            trial.run.samples.iter().zip(&none.run.samples).map(|(a, b)| off(a.x, b.x, scales.length));
        apart.push(distances.fold(0.0, f64::max) / time_constant);
        trials.push(trial);
    }
    // (its next term is of the order of the time constant over the time scale)
    let alike = (apart[1] / apart[2] - 1.0).abs() < 1e-4 / scales.time;
    none.fact("distance of the first power", alike && apart[2] > 1.0);
    trials.push(none);
    Ok(trials)
}
