//! Tone: one sine with an optional amplitude ramp, its series, and its release root. Chirp: a sine of growing
//! frequency, and its series.

use super::{Base, ContactAcceleration, Drive, ReleaseRoot, Span};
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::series::{ROOM, Tail};
use crate::numeric::{DoubleDouble, Number, Ratio, Scalar, elementary};

/// Linear growth of a tone's amplitude from the run's start to an instant; constant from there.
#[derive(Debug, Clone)]
pub(crate) struct Ramp<T> {
    /// Amplitude at time 0.
    pub from: T,
    /// Growth per kernel time unit.
    pub rate: T,
    /// The segment of the drive that begins where the ramp ends; `None` if it outlasts the run.
    pub holds_from_segment: Option<usize>,
}

/// amplitude sin(2 pi (frequency t) + phase).
#[derive(Debug, Clone)]
pub(crate) struct Tone<T> {
    /// Amplitude (after the ramp, if there is one), any sign.
    pub amplitude: T,
    /// Turns per kernel time unit.
    pub frequency: T,
    /// This tone's frequency over the clock's.
    pub ratio: TurnsPerCycle,
    /// Phase at time 0 in turns, without the quarter turn.
    pub phase: T,
    /// Whether the tone is a quarter turn ahead: a cosine.
    pub quarter: bool,
    /// Growth of the amplitude, if there is one.
    pub ramp: Option<Ramp<T>>,
}

/// Turns that a tone makes in one cycle of the clock.
#[derive(Debug, Clone, Copy)]
pub(crate) enum TurnsPerCycle {
    /// An exact ratio of the decimal frequencies.
    Exact(Ratio),
    /// No common measure within reach: the rounded quotient.
    Rounded(f64),
}

impl TurnsPerCycle {
    /// The fraction of a turn that the tone has completed at the start of a cycle.
    #[inline]
    pub fn fraction(self, cycle: i64) -> f64 {
        match self {
            Self::Exact(ratio) => ratio.fraction_of_multiple(cycle.unsigned_abs()),
            Self::Rounded(ratio) => {
                let turns = DoubleDouble::product(cycle as f64, ratio);
                (turns - turns.floor()).to_f64()
            }
        }
    }
}

impl<T: Scalar> Tone<T> {
    /// Value and time derivative per unit amplitude.
    #[inline]
    pub fn unit(&self, at: &Instant<T>) -> (T, T) {
        self.after(at.phase, T::of(self.ratio.fraction(at.cycle)) + self.phase)
    }

    /// The same for a tone that has made `start` turns at phase 0 of the cycle.
    #[inline(always)]
    fn after(&self, phase: T, start: T) -> (T, T) {
        let turns = phase * self.frequency + start;
        let (s, c) = T::sin_cos_turns(turns);
        let omega = T::tau() * self.frequency;
        if self.quarter { (c, -(s * omega)) } else { (s, c * omega) }
    }

    /// -(2 pi frequency)^2.
    #[inline(always)]
    pub fn curvature(&self) -> T {
        let omega = T::tau() * self.frequency;
        -(omega * omega)
    }

    /// Amplitude and its growth at an instant.
    pub fn amplitude_at(&self, clock: &Clock<T>, at: &Instant<T>, segment: usize) -> (T, T) {
        match &self.ramp {
            Some(ramp) if ramp.holds_from_segment.is_none_or(|first| segment < first) => {
                let start = Instant { cycle: 0, phase: T::zero() };
                (ramp.from + ramp.rate * clock.between(&start, at), ramp.rate)
            }
            _ => (self.amplitude, T::zero()),
        }
    }
}

/// One sine. Its frequency is the clock's, so its release root has the same phase in every cycle.
#[derive(Debug, Clone)]
pub(crate) struct Sine<T> {
    pub tone: Tone<T>,
    pub clock: Clock<T>,
}

/// Where a tone was evaluated last, with its value and time derivative per unit amplitude.
pub(crate) type LastValue<T> = Option<(Instant<T>, (T, T))>;

/// Harmonic drive: the series of a tone of this curvature, -(2 pi frequency)^2.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Harmonic<T> {
    pub curvature: T,
}

impl<T: Number> Harmonic<T> {
    /// The first coefficients from value and time derivative.
    #[inline(always)]
    pub fn seed(self, value: T, slope: T, a: &mut [T; ROOM]) {
        a[0] = value;
        a[1] = slope;
        a[2] = self.curvature * a[0] * T::of(0.5);
        a[3] = self.curvature * a[1] / T::of(6.0);
    }
}

impl<T: Number> Tail<T> for Harmonic<T> {
    type Cursor = ();

    #[inline(always)]
    fn extend(&self, k: usize, a: &mut [T; ROOM], inverse: &[T; ROOM], (): &mut ()) {
        a[k] = self.curvature * a[k - 2] * inverse[k];
    }
}

impl<T: Scalar> Sine<T> {
    /// Value and time derivative per unit amplitude: each cycle begins at the same turn.
    #[inline(always)]
    fn unit(&self, at: &Instant<T>) -> (T, T) {
        self.tone.after(at.phase, self.tone.phase)
    }

    /// The same, from the last evaluation if that was at the same instant.
    #[inline(always)]
    pub fn unit_from(&self, at: &Instant<T>, last: &LastValue<T>) -> (T, T) {
        match last {
            Some((when, unit)) if when == at => *unit,
            _ => self.unit(at),
        }
    }
}

impl<T: Scalar> Tail<T> for Sine<T> {
    /// A step begins where the last one was checked.
    type Cursor = LastValue<T>;

    #[inline(always)]
    fn extend(&self, k: usize, a: &mut [T; ROOM], inverse: &[T; ROOM], _: &mut Self::Cursor) {
        Harmonic { curvature: self.tone.curvature() }.extend(k, a, inverse, &mut ());
    }
}

impl<T: Scalar> Base<T> for Sine<T> {
    fn acceleration(&self, at: &Instant<T>, _: usize) -> T {
        self.tone.amplitude * self.unit(at).0
    }
}

impl<T: Scalar> Drive<T> for Sine<T> {
    fn is_odd(&self) -> bool {
        true
    }

    fn second_derivative_bound(&self) -> Option<T> {
        Some((self.tone.amplitude * self.tone.curvature()).abs())
    }

    #[inline(always)]
    fn seed(&self, at: &Instant<T>, _: usize, a: &mut [T; ROOM], last: &mut Self::Cursor) {
        let (s, d) = match last {
            Some((when, unit)) if when == at => *unit,
            _ => {
                let unit = self.unit(at);
                *last = Some((*at, unit));
                unit
            }
        };
        let swing = Harmonic { curvature: self.tone.curvature() };
        swing.seed(self.tone.amplitude * s, self.tone.amplitude * d, a);
    }

    #[inline(always)]
    fn value(&self, at: &Instant<T>, _: usize, _: impl Fn() -> T, last: &mut Self::Cursor) -> T {
        let unit = self.unit(at);
        *last = Some((*at, unit));
        self.tone.amplitude * unit.0
    }

    fn next_release(
        &self,
        &Span { from, until, .. }: &Span<T>,
        ContactAcceleration { threshold, sign, .. }: ContactAcceleration<T>,
        _: &mut Self::Cursor,
    ) -> (ReleaseRoot<T>, u64) {
        // threshold - b sin = 0 with sin rising through it (b > 0) or falling (b < 0).
        let b = self.tone.amplitude * sign;
        let height = threshold / b.abs();
        if !(height.abs() < T::of(1.0)) {
            return (ReleaseRoot::Never, 0); // never reached, or touched without a change of sign
        }
        let mut turns = T::of(elementary::asin(height.to_f64()) / std::f64::consts::TAU);
        for _ in 0..3 {
            // Newton's method corrects the last bits, and in a longer number type all of them
            let (s, c) = T::sin_cos_turns(turns);
            let slope = c * T::tau();
            if slope.to_f64() > 1e-6 {
                turns -= (s - height) / slope;
            }
        }
        if b < T::zero() {
            turns -= T::of(0.5);
        }
        let quarter = if self.tone.quarter { T::of(0.25) } else { T::zero() };
        let mut turns = (turns - quarter) - self.tone.phase;
        turns -= turns.floor();
        let mut phase = turns / self.tone.frequency;
        if phase >= self.clock.period {
            phase = T::zero();
        }
        let behind = from.phase - phase;
        // A root that lies in the past by no more than rounding counts as now.
        let slack = self.clock.period * T::of(8.0 * T::EPSILON);
        // There is one root in each cycle. `from` only approximates it and gets no cycle.
        let (root, turn) = if behind <= T::zero() {
            (Instant { cycle: from.cycle, phase }, Some(0))
        } else if behind <= slack {
            (from, None)
        } else {
            (Instant { cycle: from.cycle + 1, phase }, Some(0))
        };
        (ReleaseRoot::within(&self.clock, root, turn, &until), 0)
    }
}

/// A sine whose frequency grows evenly up to an instant and then holds.
#[derive(Debug, Clone)]
pub(crate) struct Chirp<T> {
    pub amplitude: T,
    /// Frequency at time 0 in Hz.
    pub from: f64,
    /// Frequency from the end of the chirp on in Hz.
    pub to: f64,
    pub over: f64,
    /// The segment of the drive that begins where the chirp ends; `None` if it outlasts the run.
    pub holds_from_segment: Option<usize>,
}

impl<T: Scalar> Chirp<T> {
    /// (sin, cos) at an instant, angular frequency there and its growth, in kernel units. The phase is
    /// computed in double-double arithmetic; only its fraction of a turn is rounded.
    pub fn state(&self, clock: &Clock<T>, at: &Instant<T>, segment: usize) -> (T, T, T, T) {
        let dd = DoubleDouble::of;
        let time = clock.exact_seconds(at);
        let growth = (dd(self.to) - dd(self.from)) / dd(self.over);
        let holding = self.holds_from_segment.is_some_and(|first| segment >= first);
        let (turns, frequency, growth) = if holding {
            let before = (dd(self.from) + dd(self.to)) * dd(self.over) * dd(0.5);
            (before + (time - dd(self.over)) * dd(self.to), dd(self.to), dd(0.0))
        } else {
            let frequency = dd(self.from) + growth * time;
            (time * (dd(self.from) + growth * time * dd(0.5)), frequency, growth)
        };
        let (s, c) = T::sin_cos_turns(T::of_pair(turns - turns.floor()));
        let unit = clock.unit;
        let omega = T::tau() * T::of_pair(frequency * dd(unit));
        (s, c, omega, T::tau() * T::of_pair(growth * dd(unit * unit)))
    }
}

/// The next coefficients of sine and cosine of a phase with rate w and growth b, from the last two of each:
/// (k + 1) s\[k+1\] = w c\[k\] + b c\[k-1\], and the cosine likewise with the opposite sign.
pub(crate) fn next_chirp<T: Scalar>(last: &mut ChirpState<T>, share: T) {
    let ChirpState { sine, cosine, rate, growth, .. } = *last;
    let s = (rate * cosine[1] + growth * cosine[0]) * share;
    let c = -((rate * sine[1] + growth * sine[0]) * share);
    last.sine = [sine[1], s];
    last.cosine = [cosine[1], c];
}

/// The last two coefficients of a chirp's sine and cosine, and the parameters of their recurrence.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChirpState<T> {
    pub sine: [T; 2],
    pub cosine: [T; 2],
    pub rate: T,
    pub growth: T,
    pub amplitude: T,
}
