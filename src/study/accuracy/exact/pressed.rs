//! A mass that a constant force presses on a stop while a sine shakes it: flights, releases and landings in
//! closed form.

use super::dd;
use super::elementary::{sine_turns, turns};
use crate::numeric::{DoubleDouble, Number, Scalar, bisect};

/// In the gap y from the stop: y'' = -press + amplitude sin(2 pi frequency t), y >= 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pressed {
    /// Pressing acceleration in m/s^2, above 0.
    pub press: f64,
    /// Amplitude in m/s^2, above the press if there is to be a release.
    pub amplitude: f64,
    /// Frequency in Hz.
    pub frequency: f64,
}

impl Pressed {
    /// The first instant in s at which the press falls through 0: asin(press/amplitude)/(2 pi frequency).
    pub fn release(&self) -> DoubleDouble {
        sine_turns(dd(self.press) / dd(self.amplitude)) / dd(self.frequency)
    }

    /// Gap in m and its rate at `t` after gap and rate `start` at `from`, both in s, in free flight.
    pub fn flight(
        &self,
        start: (DoubleDouble, DoubleDouble),
        from: DoubleDouble,
        t: DoubleDouble,
    ) -> (DoubleDouble, DoubleDouble) {
        let w = DoubleDouble::tau() * dd(self.frequency);
        let gain = dd(self.amplitude) / w;
        let ((s0, c0), (s, c)) = (turns(dd(self.frequency) * from), turns(dd(self.frequency) * t));
        let d = t - from;
        let press = dd(self.press);
        let rate = start.1 - press * d - gain * (c - c0);
        let gap = start.0 + (start.1 + gain * c0) * d - press * d * d * dd(0.5) - gain / w * (s - s0);
        (gap, rate)
    }

    /// When a flight from rest on the stop at `from` lands again: the first root of the gap, bracketed
    /// on a grid of 1/4096 of the period and bisected to all digits; `None` if it does not land within
    /// four periods.
    pub fn landing(&self, from: DoubleDouble) -> Option<DoubleDouble> {
        let start = (DoubleDouble::zero(), DoubleDouble::zero());
        let step = dd(1.0) / dd(4096.0 * self.frequency);
        let gap = |t: DoubleDouble| self.flight(start, from, t).0;
        let zero = DoubleDouble::zero();
        let first = (1..4 * 4096).find(|i| gap(from + step * dd(f64::from(*i))) <= zero)?;
        let [low, high] = [first - 1, first].map(|i| from + step * dd(f64::from(i)));
        Some(bisect(low, high, 110, |t| gap(t) > zero).1)
    }
}
