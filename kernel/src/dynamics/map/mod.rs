//! Stroboscopic map: the state after one forcing period, and its derivatives through every event.
//!
//! The stepper is written for any number type. With [`Dual`] numbers it also computes the derivatives of the
//! end of a motion with respect to its beginning. Those of a step follow from the arithmetic of its series.
//! The instant of an event is a root, and one step of Newton's method at the root gives its derivatives; at
//! an impact this amounts to the saltation matrix (Müller 1995; Kong et al. 2024). After a rest on a stop all
//! derivatives are 0, since the release depends on the drive alone.

#[cfg(test)]
mod differences;
mod jacobian;
mod passage;

use super::clock::Instant;
use super::drive::form::{Kernel, with_drive};
use super::model::Model;
use crate::numeric::{Dual, Scalar};

pub use jacobian::{Jacobian, Multiplier};
use passage::Traced;
pub use passage::{Miss, Passage};

/// Length of one application of the map.
#[derive(Debug, Clone, Copy)]
enum Length {
    /// Cycles of the clock.
    Cycles(i64),
    /// Time in s.
    Seconds(f64),
}

/// The map from a state to the state one forcing period later.
#[derive(Debug)]
pub struct StroboscopicMap {
    model: Model,
    plain: Kernel<f64>,
    dual: Kernel<Dual>,
    /// Cycles of the clock up to the strobe: their whole number and the fraction.
    phase: (i64, f64),
    length: Length,
    /// Time in s that one application takes.
    period: f64,
}

impl Model {
    /// The map from the state at a phase of the drive, in forcing periods from 0 to 1, to the state one
    /// forcing period later. `None` if the drive has no period, or if a transducer has an electrical state.
    pub fn stroboscopic_map(&self, phase: f64) -> Option<StroboscopicMap> {
        let alone = self.repeats() && !self.has_electrical_state();
        let period = self.forcing_period.filter(|_| alone)?;
        let cycles = self.cycles_per_period;
        let turns = (phase - self.start_phase).rem_euclid(1.0) * cycles as f64;
        Some(StroboscopicMap {
            phase: (turns.floor() as i64, turns - turns.floor()),
            length: Length::Cycles(cycles),
            ..StroboscopicMap::over(self, period)
        })
    }
}

impl StroboscopicMap {
    /// The map from the state at time 0 to the state after `seconds`, for any drive.
    pub fn over(model: &Model, seconds: f64) -> Self {
        Self {
            plain: Kernel::new(model),
            dual: Kernel::new(model),
            // the settled window is empty, so nothing is classified
            model: model.with_duration(seconds, seconds),
            phase: (0, 0.0),
            length: Length::Seconds(seconds),
            period: seconds,
        }
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Time in s of the first strobe of a run.
    pub fn first_strobe(&self) -> f64 {
        let Kernel { clock, equation, .. } = &self.plain;
        (self.phase.0 as f64 + self.phase.1) * clock.period * equation.unit
    }

    /// Time in s that one application takes: the forcing period.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// The motion from a displacement in m and a velocity in m/s over this many forcing periods.
    ///
    /// The displacement must not lie beyond a stop or the curve; this is not checked.
    pub fn pass(&self, state: (f64, f64), periods: u32) -> Passage {
        self.pass_between(state, (0.0, f64::from(periods)))
    }

    /// The same over a part of the forcing period, from 0 to 1.
    pub fn pass_part(&self, state: (f64, f64), part: f64) -> Passage {
        self.pass_between(state, (0.0, part))
    }

    /// The same between two times after a strobe, in forcing periods.
    pub fn pass_between(&self, (x, v): (f64, f64), span: (f64, f64)) -> Passage {
        let unit = self.model.scales.unit();
        self.trace(&self.plain, (x, v * unit), span).passage
    }

    /// The same with the derivatives of the state at the end with respect to that at the start. All are 0 if
    /// the mass has rested on a stop. Some are infinite or NaN if it has touched one without speed. Those of
    /// a mass that stands on a stop or a break of the curve are one-sided.
    pub fn pass_with_jacobian(&self, state: (f64, f64), periods: u32) -> (Passage, Jacobian) {
        self.pass_part_with_jacobian(state, (0.0, f64::from(periods)))
    }

    /// The same between two times after a strobe, in forcing periods.
    pub fn pass_part_with_jacobian(&self, (x, v): (f64, f64), span: (f64, f64)) -> (Passage, Jacobian) {
        let unit = self.model.scales.unit();
        // Derivatives in units of the scales, so that they affect the length of a step as the state does.
        let scales = [self.model.scales.length, self.model.scales.speed * unit];
        let start =
            (Dual { value: x, slopes: [scales[0], 0.0] }, Dual { value: v * unit, slopes: [0.0, scales[1]] });
        let Traced { passage, end, rested } = self.trace(&self.dual, start, span);
        if rested {
            return (passage, Jacobian { rows: [[0.0; 2]; 2] });
        }
        let in_si = [1.0, unit];
        let row = |end: Dual, out: f64| std::array::from_fn(|j| end.slopes[j] / scales[j] * in_si[j] / out);
        (passage, Jacobian { rows: [row(end.0, 1.0), row(end.1, unit)] })
    }

    fn trace<T: Scalar>(&self, kernel: &Kernel<T>, start: (T, T), (from, to): (f64, f64)) -> Traced<T> {
        let Kernel { equation, clock, drive } = kernel;
        let strobe = Instant { cycle: self.phase.0, phase: T::of(self.phase.1) * clock.period };
        let after = |periods: f64| match self.length {
            Length::Cycles(cycles) => {
                let cycles = periods * cycles as f64;
                let later = Instant { cycle: strobe.cycle + cycles.floor() as i64, ..strobe };
                clock.advance(&later, T::of(cycles - cycles.floor()) * clock.period)
            }
            Length::Seconds(seconds) => clock.at(seconds * periods),
        };
        let span = (after(from), after(to));
        with_drive!(drive, drive => passage::trace(&self.model, equation, *clock, drive, start, span))
    }
}
