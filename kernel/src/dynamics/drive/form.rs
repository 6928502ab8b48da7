//! Builder of a model's drive, in kernel units.

use std::sync::Arc;

use super::general::{FEW_TONES, General};
use super::lines::Lines;
use super::record::{Line, Record};
use super::tone::{Chirp, Ramp, Sine, Tone, TurnsPerCycle};
use super::{Base, Circuit, Constant};
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::equation::Equation;
use crate::dynamics::model::Model;
use crate::dynamics::model::excitation::TonePart;
use crate::dynamics::model::scales::Scales;
use crate::numeric::pieces::Piece;
use crate::numeric::{Scalar, elementary};
use crate::scene;

/// Permitted change of the speed by a polynomial that replaces lines of a record, as a share of the
/// tolerance. It does not add up from piece to piece.
const SPEED_SHARE: f64 = 1.0;
/// The same for the displacement; only the displacement acts on the force.
const LENGTH_SHARE: f64 = 0.02;

/// Shortest cycle of the clock without a drive, in kernel time units.
const SHORTEST_CYCLE: f64 = 1.0 / 65536.0;

impl Model {
    /// Acceleration of the base in m/s^2 at time `t` in s.
    pub fn base_acceleration(&self, t: f64) -> f64 {
        let unit = self.scales.unit();
        let clock = clock::<f64>(self, unit);
        let drive = sum(self, &clock);
        let at = clock.at(t);
        let segment = drive.segment_ends.iter().filter(|end| clock.between(end, &at) >= 0.0).count();
        drive.in_si(&at, segment, unit)
    }
}

/// Equation, clock and drive of a model, in kernel units.
#[derive(Debug)]
pub(crate) struct Kernel<T> {
    pub equation: Equation<T>,
    pub clock: Clock<T>,
    pub drive: Form<T>,
}

impl<T: Scalar> Kernel<T> {
    pub fn new(model: &Model) -> Self {
        let unit = model.scales.unit();
        let clock = clock(model, unit);
        Self { equation: Equation::new(model, unit), drive: form(model, &clock), clock }
    }
}

/// A drive in its fastest type.
#[derive(Debug)]
pub(crate) enum Form<T> {
    Constant(Constant<T>),
    Sine(Sine<T>),
    General(General<T>),
}

/// Evaluates an expression with the drive of a form in its concrete type.
macro_rules! with_drive {
    ($form:expr, $drive:ident => $call:expr) => {
        match $form {
            $crate::dynamics::drive::form::Form::Constant($drive) => $call,
            $crate::dynamics::drive::form::Form::Sine($drive) => $call,
            $crate::dynamics::drive::form::Form::General($drive) => $call,
        }
    };
}
pub(crate) use with_drive;

/// This model's drive in its fastest type.
pub(crate) fn form<T: Scalar>(model: &Model, clock: &Clock<T>) -> Form<T> {
    let (drive, unit) = (&model.excitation, clock.unit);
    let alone = drive.has_only_tones() && model.circuit().is_none();
    match drive.tones.as_slice() {
        [] if alone => Form::Constant(Constant { acceleration: T::of(drive.constant * (unit * unit)) }),
        [part] if alone && drive.constant == 0.0 && part.ramp.is_none() => {
            Form::Sine(Sine { tone: tone(part, part, unit, |_| None), clock: *clock })
        }
        _ => Form::General(sum(model, clock)),
    }
}

/// Equation, clock and drive of a model with the drive in the general type, which any drive fits.
pub(crate) fn general<T: Scalar>(model: &Model) -> (Equation<T>, Clock<T>, General<T>) {
    let Kernel { equation, clock, drive } = Kernel::new(model);
    let drive = match drive {
        Form::Constant(_) => General { only_constant: true, ..sum(model, &clock) },
        Form::Sine(sine) => General { sine: Some(sine), ..sum(model, &clock) },
        Form::General(general) => general,
    };
    (equation, clock, drive)
}

pub(crate) fn clock<T: Scalar>(model: &Model, unit: f64) -> Clock<T> {
    let frequency = model.excitation.fastest().unwrap_or_else(|| {
        // Without a drive: a power of two of the time unit, short enough for the phase to be exact and long
        // enough for the cycles to be countable.
        let units = model.duration / unit;
        1.0 / (unit * SHORTEST_CYCLE.max(elementary::exp2(elementary::log2(units).ceil() - 50.0)))
    });
    Clock::new(frequency, unit)
}

/// The circuit of the model's transducer, if that has a state.
fn circuit<T: Scalar>(model: &Model, unit: f64) -> Option<Circuit<T>> {
    let circuit = model.circuit()?;
    let (coupling, decay) = (circuit.coupling * unit, circuit.decay * unit);
    let Scales { speed, time, .. } = model.scales;
    let (speed, time) = (speed * unit, time / unit);
    // The size of the state during the motion, limited by the decay and by the speed of the mass.
    let moved = speed * (coupling.abs() * time / (1.0 + decay * time)).min(1.0);
    let scale = if moved > 0.0 { moved } else { circuit.state(model.start_electrical) * unit };
    Some(Circuit::new(T::of(coupling), T::of(decay), T::of(scale.abs())))
}

/// A tone; `holds_from` gives the segment of the drive that begins where a ramp of this length in s ends.
fn tone<T: Scalar>(
    tone: &TonePart,
    fastest: &TonePart,
    unit: f64,
    holds_from: impl Fn(f64) -> Option<usize>,
) -> Tone<T> {
    let square = unit * unit;
    Tone {
        amplitude: T::of(tone.amplitude * square),
        frequency: T::of(tone.frequency * unit),
        ratio: tone
            .ratio_to(fastest)
            .map_or(TurnsPerCycle::Rounded(tone.frequency / fastest.frequency), TurnsPerCycle::Exact),
        phase: T::of(tone.phase),
        quarter: tone.quarter,
        ramp: tone.ramp.map(|(from, over)| Ramp {
            from: T::of(from * square),
            rate: T::of(tone.amplitude * square - from * square) / T::of(over / unit),
            holds_from_segment: holds_from(over),
        }),
    }
}

/// The sum of a drive's parts, and the circuit.
fn sum<T: Scalar>(model: &Model, clock: &Clock<T>) -> General<T> {
    let (drive, unit) = (&model.excitation, clock.unit);
    let square = unit * unit;
    let ramps = drive.tones.iter().filter_map(|t| t.ramp.map(|r| r.1));
    let chirps = drive.chirps.iter().map(|c| c.over);
    let pieces: Vec<_> = drive.records.iter().map(|record| (record, pieces::<T>(model, record))).collect();
    let samples = pieces.iter().flat_map(|(record, pieces)| corners(record, pieces));
    let outlasting = ramps.clone().any(|over| over > model.duration);
    let mut ends: Vec<f64> =
        ramps.chain(chirps).chain(samples).filter(|t| *t > 0.0 && *t <= model.duration).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    // the segment that begins at a time
    let segment = |time: f64| ends.partition_point(|end| *end <= time);
    let holds_from = |over: f64| (over <= model.duration).then(|| segment(over));
    let clocked = drive.fastest_tone();
    let tones = drive.tones.iter().map(|part| tone(part, clocked.unwrap_or(part), unit, holds_from));
    let tones: Vec<Tone<T>> = tones.collect();
    let is_line = |tone: &Tone<T>| !tone.quarter && tone.ramp.is_none();
    let many = tones.iter().filter(|tone| is_line(tone)).count() > FEW_TONES;
    let (steady, tones): (Vec<_>, Vec<_>) = tones.into_iter().partition(|tone| many && is_line(tone));
    let chirps = drive.chirps.iter().map(|chirp| Chirp {
        amplitude: T::of(chirp.amplitude * square),
        from: chirp.from,
        to: chirp.to,
        over: chirp.over,
        holds_from_segment: holds_from(chirp.over),
    });
    let records =
        pieces.iter().map(|(source, pieces)| record((source, Arc::clone(pieces)), model, clock, segment));
    let reach = drive.tones.iter().map(TonePart::largest).sum::<f64>()
        + drive.chirps.iter().map(|c| c.amplitude.abs()).sum::<f64>()
        + drive.records.iter().map(|r| r.peak()).sum::<f64>();
    let moving = drive.tones.iter().filter(|t| t.largest() > 0.0).map(|t| t.frequency);
    let sweeping = drive.chirps.iter().filter(|c| c.amplitude != 0.0).map(|c| c.from.max(c.to));
    let fastest = moving.chain(sweeping).fold(0.0, f64::max) * unit;
    General {
        clock: *clock,
        sine: None,
        only_constant: false,
        circuit: circuit(model, unit),
        constant: T::of(drive.constant * square),
        tones,
        lines: Lines::new(&steady),
        chirps: chirps.collect(),
        records: records.collect(),
        segment_ends: ends.iter().map(|e| clock.at(*e)).collect(),
        // a ramp that outlasts the run never lets it repeat
        common_cycles: drive.common_cycles().map(|c| c as i64).filter(|_| !outlasting),
        // a bound: rounding must not hide a root
        reach: T::of(reach * square * (1.0 + 1e-9)),
        fastest: T::tau() * T::of(fastest),
    }
}

/// The times of the samples at which lines or polynomials meet, and that of the last sample.
fn corners(source: &scene::Record, pieces: &[Piece]) -> impl Iterator<Item = f64> {
    let ends = pieces.iter().flat_map(|piece| {
        let begins = if piece.polynomial.is_some() { 1 } else { piece.lines };
        piece.first..piece.first + begins
    });
    ends.map(|sample| source.times[sample]).chain(source.times.last().copied())
}

/// The lines of a record, and the polynomials that replace lines, up to the end of the run.
fn record<T: Scalar>(
    (source, pieces): (&Arc<scene::Record>, Arc<Vec<Piece>>),
    model: &Model,
    clock: &Clock<T>,
    segment: impl Fn(f64) -> usize,
) -> Record<T> {
    let (times, values, unit) = (&source.times, &source.accelerations, clock.unit);
    let square = unit * unit;
    let zero_time = Instant { cycle: 0, phase: T::zero() };
    let mut lines = Vec::new();
    let mut add = |sample: usize, end: Option<usize>, piece: Option<usize>| {
        if times[sample] > model.duration || end.is_some_and(|end| times[end] <= 0.0) {
            return;
        }
        let first_segment = if times[sample] <= 0.0 { 0 } else { segment(times[sample]) };
        let mut line = Line { first_segment, at: zero_time, value: T::zero(), slope: T::zero(), piece };
        if times[sample] > 0.0 {
            line.at = clock.at(times[sample]);
        }
        if let Some(end) = end.filter(|_| piece.is_none()) {
            let slope = T::of(values[end] - values[sample]) / T::of(times[end] - times[sample]);
            let value = T::of(values[sample]) - slope * T::of(times[sample].min(0.0));
            (line.value, line.slope) = (value * T::of(square), slope * T::of(square * unit));
        }
        lines.push(line);
    };
    for (number, piece) in pieces.iter().enumerate() {
        let end = piece.first + piece.lines;
        match piece.polynomial {
            Some(_) => add(piece.first, Some(end), Some(number)),
            None => (piece.first..end).for_each(|sample| add(sample, Some(sample + 1), None)),
        }
    }
    add(times.len() - 1, None, None);
    Record { lines, source: Arc::clone(source), pieces, clock: *clock }
}

/// The pieces of a record, with polynomials in place of lines if the tolerance allows. Polynomials are not
/// used in double-double arithmetic, nor with another part of the drive, a circuit or rigid stops: the search
/// for a release uses the lines of a record, and a flight along a polynomial might begin pressed back.
fn pieces<T: Scalar>(model: &Model, source: &scene::Record) -> Arc<Vec<Piece>> {
    let drive = &model.excitation;
    let parts = drive.tones.len() + drive.chirps.len() + drive.records.len();
    let rests = model.stops.is_some() && model.compliant.is_none();
    if parts > 1 || rests || model.circuit().is_some() || T::EPSILON < f64::EPSILON {
        return Arc::new(vec![Piece { first: 0, lines: source.times.len() - 1, polynomial: None }]);
    }
    let Scales { speed, length, .. } = model.scales;
    source.pieces((SPEED_SHARE * model.tolerance * speed, LENGTH_SHARE * model.tolerance * length))
}
