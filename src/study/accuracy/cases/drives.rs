//! Cases of every kind of drive on a linear oscillator, all with a closed form.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::HardCase;
use crate::dynamics::{Model, Run, STANDARD_GRAVITY};
use crate::scene::{Excitation, Record};
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::{Forcing, Oscillator, dd};
use crate::study::accuracy::measure::{Bench, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, polynomial, sine};

/// Conditioning of all cases here: no eigenvalue of a damped oscillator grows, so errors only add up.
const LINEAR: &str = "A linear oscillator carries an error on without growth: n steps add n d; the phase of \
                      the drive at a time t is a product of two doubles, 2 pi f t eps.";

const MASS: f64 = 0.02;
const STIFFNESS: f64 = 50.0;
const START: (f64, f64) = (0.002, -0.1);

/// 20 g on a spring of 50 N/m (7.96 Hz), damped by `c` in N s/m.
fn sprung(c: f64, drive: Excitation, duration: f64) -> Setup {
    let mut setup = Setup::new(polynomial(&[0.0, STIFFNESS]), START, duration).damping(c).drive(drive);
    setup.scene.mass_g = MASS * 1e3;
    setup
}

/// The forcings of the tones of a model, from its exact doubles; a ramp as it is before its end.
pub(super) fn tones(model: &Model) -> Vec<Forcing> {
    let tone = |tone: &crate::dynamics::TonePart| {
        let (amplitude, growth) = tone.ramp.map_or((tone.amplitude, dd(0.0)), |(from, over)| {
            (from, (dd(tone.amplitude) - dd(from)) / dd(over))
        });
        let phase = tone.phase + if tone.quarter { 0.25 } else { 0.0 };
        Forcing::Tone { amplitude, growth, frequency: tone.frequency, phase }
    };
    model.excitation().tones.iter().map(tone).collect()
}

/// Evenly spaced times within a run.
pub(super) fn even(duration: f64, count: usize) -> Vec<f64> {
    (1..=count).map(|i| duration * i as f64 / (count as f64 + 0.5)).collect()
}

/// Errors of all samples in units of the scene's scales, each with the error allowed at its time.
fn against(model: &Model, run: &Run, fastest: f64, exact: impl Fn(f64) -> (f64, f64)) -> Vec<(f64, f64)> {
    let scales = model.scales();
    let share = run.summary.steps as f64 * STEP_ERROR;
    let error = |sample: &crate::dynamics::Sample| {
        let (x, v) = exact(sample.t);
        let error = off(sample.x, x, scales.length).max(off(sample.v, v, scales.speed));
        // at least one step, and the drive's phase
        let progress = (sample.t / model.duration()).max(1.0 / run.summary.steps as f64);
        (error, share * progress + TAU * fastest * sample.t * f64::EPSILON)
    };
    run.samples.iter().map(error).collect()
}

/// A variant of a linear oscillator under the tones of its model.
fn superposed(
    bench: &Bench,
    name: &'static str,
    setup: &Setup,
    oscillator: Oscillator,
) -> Result<Variant, Stopped> {
    let model = setup.model()?;
    let run = bench.run(&model, &even(model.duration(), 97))?;
    let forcings = tones(&model);
    let fastest = model.excitation().fastest().unwrap_or(0.0);
    let errors = against(&model, &run, fastest, |t| oscillator.nearest(model.start(), 0.0, t, &forcings));
    Ok(Variant::of(name, &run).worst("state at 97 samples", errors))
}

pub(super) const RIPPLE: HardCase = HardCase {
    name: "ripple",
    problem: "1 g at 0.5 Hz with a thousandth of it at 500 Hz on an oscillator of 7.96 Hz, 5 s.",
    answer: "Superposition in closed form.",
    conditioning: LINEAR,
    find: |bench| {
        let parts = vec![sine(0.5, STANDARD_GRAVITY, 0.0), sine(500.0, 1e-3 * STANDARD_GRAVITY, 0.0)];
        let setup = sprung(0.08, Excitation::Sum(parts), 5.0);
        Ok(vec![superposed(bench, "1 : 1000", &setup, Oscillator::new(MASS, 0.08, STIFFNESS))?])
    },
};

pub(super) const RAMP: HardCase = HardCase {
    name: "long-ramp",
    problem: "An amplitude that grows from 0 to 2 g over 300 s at 3 Hz, and holds for 10 s more, on an \
              oscillator of 7.96 Hz.",
    answer: "Closed form of the ramp and of what follows, joined at its end.",
    conditioning: LINEAR,
    find: ramp,
};

fn ramp(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    const OVER: f64 = 300.0;
    let drive = Excitation::AmplitudeRamp { frequency_hz: 3.0, from_g: 0.0, to_g: 2.0, over_s: OVER };
    let model = sprung(0.05, drive, OVER + 10.0).model()?;
    let run = bench.run(&model, &even(model.duration(), 97))?;
    let oscillator = Oscillator::new(MASS, 0.05, STIFFNESS);
    let ramp = tones(&model);
    let hold = [Forcing::Tone {
        amplitude: model.excitation().tones[0].amplitude,
        growth: dd(0.0),
        frequency: 3.0,
        phase: 0.0,
    }];
    let start = (dd(model.start().0), dd(model.start().1));
    let at_end = oscillator.state(start, dd(0.0), dd(OVER), &ramp);
    let errors = against(&model, &run, 3.0, |t| {
        use crate::numeric::Scalar;
        let (x, v) = if t < OVER {
            oscillator.state(start, dd(0.0), dd(t), &ramp)
        } else {
            oscillator.state(at_end, dd(OVER), dd(t), &hold)
        };
        (x.to_f64(), v.to_f64())
    });
    Ok(vec![Variant::of("300 s", &run).worst("state at 97 samples", errors)])
}

pub(super) const FAST: HardCase = HardCase {
    name: "fast-drive",
    problem: "x'' + x = -A sin(w t), w = 1e4 and A = 1e4 m/s^2, from rest at 0: a drive at 1e4 times the \
              natural frequency, 16 000 cycles.",
    answer: "Closed form.",
    conditioning: LINEAR,
    find: |bench| {
        let setup = Setup::new(polynomial(&[0.0, 1.0]), (0.0, 0.0), 10.0).drive(sine(1e4 / TAU, 1e4, 0.0));
        Ok(vec![superposed(bench, "w = 1e4", &setup, Oscillator::new(1.0, 0.0, 1.0))?])
    },
};

pub(super) const NOISE: HardCase = HardCase {
    name: "noise",
    problem: "Band-limited noise (0.5 g, 1 to 40 Hz, 256 lines, seed 7) on an oscillator of 7.96 Hz, 10 s.",
    answer: "The superposition of its 256 lines, in closed form.",
    conditioning: LINEAR,
    find: |bench| {
        let drive = Excitation::Noise { rms_g: 0.5, low_hz: 1.0, high_hz: 40.0, seed: 7, lines: 256 };
        let setup = sprung(0.08, drive, 10.0);
        Ok(vec![superposed(bench, "256 lines", &setup, Oscillator::new(MASS, 0.08, STIFFNESS))?])
    },
};

pub(super) const SHOCK: HardCase = HardCase {
    name: "shock",
    problem: "A triangular pulse of 50 g over 2 ms and nothing else, recorded, on an oscillator of 7.96 Hz, \
              1 s.",
    answer: "Closed form of a linear acceleration, joined from line to line.",
    conditioning: LINEAR,
    find: |bench| {
        let peak = 50.0 * STANDARD_GRAVITY;
        let record = Record::new(vec![0.0995, 0.1005, 0.1015], vec![0.0, peak, 0.0]);
        Ok(vec![recorded(bench, "50 g in 2 ms", record, 1.0)?])
    },
};

pub(super) const RECORD: HardCase = HardCase {
    name: "record",
    problem: "A recorded acceleration of 1000 samples, 5 ms apart, which jump by up to 1 g from one to the \
              next, on an oscillator of 7.96 Hz, 5 s.",
    answer: "Closed form of a linear acceleration, joined from line to line.",
    conditioning: LINEAR,
    find: |bench| {
        // the fractional parts of multiples of the golden ratio: as uneven as random numbers, the
        // same everywhere
        let jump = |i: u32| (f64::from(i) * 0.618_033_988_749_894_9).fract() - 0.5;
        let times = (0..1000_u32).map(|i| f64::from(i) * 0.005).collect();
        let accelerations = (0..1000_u32).map(|i| STANDARD_GRAVITY * jump(i)).collect();
        Ok(vec![recorded(bench, "1000 samples", Record::new(times, accelerations), 5.0)?])
    },
};

/// An oscillator under a record and, after it, left alone.
fn recorded(bench: &Bench, name: &'static str, record: Record, duration: f64) -> Result<Variant, Stopped> {
    let record = Arc::new(record);
    let drive = Excitation::Recorded { path: "shock".to_owned(), record: Some(Arc::clone(&record)) };
    let model = sprung(0.05, drive, duration).model()?;
    let run = bench.run(&model, &even(duration, 97))?;
    let oscillator = Oscillator::new(MASS, 0.05, STIFFNESS);
    // the state at the start of each line, and the line
    let mut joints = vec![(0.0, (dd(model.start().0), dd(model.start().1)), None)];
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
    let errors = against(&model, &run, 0.0, |t| {
        use crate::numeric::Scalar;
        let (x, v) = state(&joints, t);
        (x.to_f64(), v.to_f64())
    });
    Ok(Variant::of(name, &run).worst("state at 97 samples", errors))
}
