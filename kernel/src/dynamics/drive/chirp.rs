//! Chirp: a sine of growing frequency, and its series.

use crate::dynamics::clock::{Clock, Instant};
use crate::numeric::{DoubleDouble, Number, Scalar};

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
/// (k + 1) s\[k+1\] = w c\[k\] + b c\[k-1\], and the cosine likewise with the sign turned.
pub(crate) fn next_chirp<T: Scalar>(last: &mut ChirpState<T>, share: T) {
    let ChirpState { sine, cosine, rate, growth, .. } = *last;
    let s = (rate * cosine[1] + growth * cosine[0]) * share;
    let c = -((rate * sine[1] + growth * sine[0]) * share);
    last.sine = [sine[1], s];
    last.cosine = [cosine[1], c];
}

/// The last two coefficients of a chirp's sine and cosine, and what their recurrence needs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChirpState<T> {
    pub sine: [T; 2],
    pub cosine: [T; 2],
    pub rate: T,
    pub growth: T,
    pub amplitude: T,
}
