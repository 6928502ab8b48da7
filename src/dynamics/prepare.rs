//! From a model to a run: the drive and the number type are chosen once, here.

use super::clock::{Clock, Instant};
use super::drive::{Drive, Ramp, Sine, Still, Tone, Tones, TurnsPerCycle};
use super::equation::Equation;
use super::model::{BaseMotion, Model, Request};
use super::motion::Motion;
use super::result::Run;
use super::series::ROOM;
use crate::numeric::{Ratio, Scalar};

/// Cycle of the clock without a drive, in kernel time units.
const SHORTEST_CYCLE: f64 = 1.0 / 65536.0;

/// Runs the model in numbers of type `T`.
pub(crate) fn run<T: Scalar>(model: &Model, request: &Request, tolerance: f64) -> Run {
    let watch = cpu_time::ThreadTime::now();
    let unit = model.scales.unit();
    let equation = Equation::<T>::new(model, unit);
    let clock = clock(model, unit);
    let mut run = match drive_kind(&model.drive) {
        Kind::Still => with_drive(model, request, tolerance, &equation, clock, &still(model, unit)),
        Kind::Sine => with_drive(model, request, tolerance, &equation, clock, &sine(model, unit)),
        Kind::Tones => with_drive(model, request, tolerance, &equation, clock, &tones(model, unit, &clock)),
    };
    run.summary.cpu_s = watch.elapsed().as_secs_f64();
    run
}

/// Acceleration of the base in m/s^2 at `t` in s.
pub(crate) fn base_acceleration(model: &Model, t: f64) -> f64 {
    let unit = model.scales.unit();
    let clock = clock::<f64>(model, unit);
    let drive = tones(model, unit, &clock);
    let at = clock.at(t);
    let segment = drive.segment_ends.iter().filter(|end| clock.between(end, &at) >= 0.0).count();
    base_at(&drive, &clock, segment, &at, unit)
}

pub(super) fn base_at<T: Scalar, D: Drive<T>>(
    drive: &D,
    clock: &Clock<T>,
    segment: usize,
    at: &Instant<T>,
    unit: f64,
) -> f64 {
    let mut a = [T::zero(); ROOM];
    drive.seed(clock, at, segment, &mut a, &mut D::Rolling::default());
    a[0].to_f64() / (unit * unit)
}

enum Kind {
    Still,
    Sine,
    Tones,
}

fn drive_kind(drive: &BaseMotion) -> Kind {
    match drive.tones.as_slice() {
        [] => Kind::Still,
        [tone] if drive.constant == 0.0 && tone.ramp.is_none() => Kind::Sine,
        _ => Kind::Tones,
    }
}

fn clock<T: Scalar>(model: &Model, unit: f64) -> Clock<T> {
    let frequency = model.drive.fastest().unwrap_or_else(|| {
        // Without a drive: so short a cycle that its phase is exact, a power of two of the time unit, and not so
        // many cycles that they could not be counted.
        let units = model.duration / unit;
        1.0 / (unit * SHORTEST_CYCLE.max((units.log2().ceil() - 50.0).exp2()))
    });
    Clock::new(frequency, unit)
}

fn still<T: Scalar>(model: &Model, unit: f64) -> Still<T> {
    Still { acceleration: T::of(model.drive.constant * (unit * unit)) }
}

fn sine<T: Scalar>(model: &Model, unit: f64) -> Sine<T> {
    Sine { tone: tone(&model.drive, 0, unit, usize::MAX) }
}

fn tone<T: Scalar>(drive: &BaseMotion, index: usize, unit: f64, holds_from_segment: usize) -> Tone<T> {
    let tone = &drive.tones[index];
    let fastest = drive.fastest().unwrap_or(tone.frequency);
    let square = unit * unit;
    Tone {
        amplitude: T::of(tone.amplitude * square),
        frequency: T::of(tone.frequency * unit),
        ratio: Ratio::of_decimals(tone.frequency, fastest)
            .map_or(TurnsPerCycle::Rounded(tone.frequency / fastest), TurnsPerCycle::Exact),
        phase: T::of(tone.phase),
        quarter: tone.quarter,
        ramp: tone.ramp.map(|(from, over)| Ramp {
            from: T::of(from * square),
            rate: T::of(tone.amplitude * square - from * square) / T::of(over / unit),
            holds_from_segment,
        }),
    }
}

fn tones<T: Scalar>(model: &Model, unit: f64, clock: &Clock<T>) -> Tones<T> {
    let drive = &model.drive;
    let mut ends: Vec<f64> = drive.tones.iter().filter_map(|t| t.ramp.map(|r| r.1)).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let after = |over: f64| ends.iter().take_while(|e| **e <= over).count();
    Tones {
        constant: T::of(drive.constant * (unit * unit)),
        tones: (0..drive.tones.len())
            .map(|i| tone(drive, i, unit, drive.tones[i].ramp.map_or(0, |r| after(r.1))))
            .collect(),
        segment_ends: ends.iter().map(|e| clock.at(*e)).collect(),
        common_cycles: drive.common_cycles().map(|c| c as i64),
    }
}

fn with_drive<T: Scalar, D: Drive<T>>(
    model: &Model,
    request: &Request,
    tolerance: f64,
    equation: &Equation<T>,
    clock: Clock<T>,
    drive: &D,
) -> Run {
    if request.ledger {
        Motion::<T, D, true>::new(model, request, tolerance, equation, clock, drive).run(model, request)
    } else {
        Motion::<T, D, false>::new(model, request, tolerance, equation, clock, drive).run(model, request)
    }
}
