//! Stroboscopic map: the state after one forcing period, and its derivatives through every event.
//!
//! The stepper is written for any number type. With [`Dual`] numbers it also computes the derivatives of the
//! end of a motion with respect to its beginning. Those of a step follow from the arithmetic of its series.
//! The instant of an event is a root, and one step of Newton's method at the root gives its derivatives; at
//! an impact this amounts to the saltation matrix (Müller 1995; Kong et al. 2024). After a rest on a stop
//! all derivatives are 0, since the release depends on the drive alone; beside a circuit it depends on its
//! state too, which then is all that the later motion remembers.

mod attraction;
#[cfg(test)]
mod differences;
mod jacobian;
mod passage;

use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

use super::clock::{Clock, Instant};
use super::drive::Drive;
use super::drive::form::{Kernel, general, with_drive};
use super::drive::general::General;
use super::equation::Equation;
use super::model::Model;
use super::result::MapState;
use crate::numeric::{Dual, Number, Scalar};

pub(super) use attraction::Repetition;
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

impl From<&Passage> for MapState {
    /// The state at the end of a passage.
    fn from(passage: &Passage) -> Self {
        Self { electrical: passage.electrical, ..passage.state.into() }
    }
}

/// Equation, clock and drive in numbers with derivatives: with respect to displacement and velocity, or to
/// the state of the circuit as well, which only scenes with one need.
#[derive(Debug)]
enum DualKernel {
    Motion(Box<Kernel<Dual<2>>>),
    WithCircuit(Box<(Equation<Dual<3>>, Clock<Dual<3>>, General<Dual<3>>)>),
}

impl DualKernel {
    fn new(model: &Model) -> Self {
        if !model.has_electrical_state() {
            return Self::Motion(Box::new(Kernel::new(model)));
        }
        Self::WithCircuit(Box::new(general(model)))
    }
}

/// The map from a state to the state one forcing period later.
///
/// [`Model::stroboscopic_map`] makes it. A fixed point of it, or of several applications, is a periodic
/// orbit; its derivatives are carried through impacts and releases by saltation matrices (Müller 1995). The
/// question `questions::Orbit` finds such points.
#[derive(Debug)]
pub struct StroboscopicMap<'a> {
    model: Model,
    plain: Kernel<f64>,
    /// Built for the first passage with derivatives.
    dual: OnceLock<DualKernel>,
    /// Whether passages list the points at which the mass turned back before a stop.
    lists_misses: bool,
    /// Cycles of the clock up to the strobe: their whole number and the fraction.
    phase: (i64, f64),
    length: Length,
    /// Time in s that one application takes.
    period: f64,
    /// Set by another thread to cancel a passage.
    cancel: Option<&'a AtomicBool>,
}

impl Model {
    /// The map from the state at a phase of the drive, in forcing periods from 0 to 1, to the state one
    /// forcing period later. `None` if the drive has no period.
    pub fn stroboscopic_map(&self, phase: f64) -> Option<StroboscopicMap<'static>> {
        let period = self.forcing_period.filter(|_| self.repeats())?;
        let cycles = self.cycles_per_period;
        let turns = (phase - self.start_phase).rem_euclid(1.0) * cycles as f64;
        Some(StroboscopicMap {
            phase: (turns.floor() as i64, turns - turns.floor()),
            length: Length::Cycles(cycles),
            ..StroboscopicMap::over(self, period)
        })
    }
}

impl StroboscopicMap<'static> {
    /// The map from the state at time 0 to the state after `seconds`, for any drive.
    pub fn over(model: &Model, seconds: f64) -> Self {
        Self {
            plain: Kernel::new(model),
            dual: OnceLock::new(),
            lists_misses: true,
            // the settled window is empty, so nothing is classified
            model: model.with_duration(seconds, seconds),
            phase: (0, 0.0),
            length: Length::Seconds(seconds),
            period: seconds,
            cancel: None,
        }
    }
}

impl StroboscopicMap<'_> {
    /// The same map, whose passages end soon after `cancel` is set, with the outcome `Cancelled`.
    #[must_use]
    pub fn cancelled_by(self, cancel: &AtomicBool) -> StroboscopicMap<'_> {
        StroboscopicMap { cancel: Some(cancel), ..self }
    }

    /// The same map between the instants at this one, in cycles of the clock and a fraction of one, and whole
    /// forcing periods later, whose passages list no misses.
    pub(super) fn beginning_at(self, phase: (i64, f64)) -> Self {
        Self { phase, lists_misses: false, ..self }
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

    /// The motion from a state over this many forcing periods.
    ///
    /// The displacement must not lie beyond a stop or the curve; this is not checked.
    pub fn pass(&self, state: impl Into<MapState>, periods: u32) -> Passage {
        self.pass_between(state, (0.0, f64::from(periods)))
    }

    /// The same between two times after a strobe, in forcing periods.
    pub fn pass_between(&self, state: impl Into<MapState>, span: (f64, f64)) -> Passage {
        self.motion(state.into(), span)
    }

    // not generic, so that callers do not compile the integrator again
    fn motion(&self, MapState { x, v, electrical }: MapState, span: (f64, f64)) -> Passage {
        let [_, by_v, by_electrical] = self.kernel_units();
        let start = [x, v * by_v, electrical * by_electrical];
        let Kernel { equation, clock, drive } = &self.plain;
        let span = self.span(clock, span);
        with_drive!(drive, drive => self.trace(equation, *clock, drive, start, span)).passage
    }

    fn trace<T: Scalar, D: Drive<T>>(
        &self,
        equation: &Equation<T>,
        clock: Clock<T>,
        drive: &D,
        start: [T; 3],
        span: (Instant<T>, Instant<T>),
    ) -> Traced<T> {
        let listed = self.lists_misses;
        passage::trace(&self.model, equation, clock, drive, start, span, (listed, self.cancel))
    }

    /// The same with the derivatives of the state at the end with respect to that at the start. Without a
    /// circuit all are 0 if the mass has rested on a stop. Some are infinite or NaN if it has touched one
    /// without speed. Those of a mass that stands on a stop or a break of the curve are one-sided.
    pub fn pass_with_jacobian(&self, state: impl Into<MapState>, periods: u32) -> (Passage, Jacobian) {
        self.pass_part_with_jacobian(state, (0.0, f64::from(periods)))
    }

    /// The same between two times after a strobe, in forcing periods.
    pub fn pass_part_with_jacobian(
        &self,
        state: impl Into<MapState>,
        span: (f64, f64),
    ) -> (Passage, Jacobian) {
        self.motion_with_jacobian(state.into(), span)
    }

    fn motion_with_jacobian(
        &self,
        MapState { x, v, electrical }: MapState,
        span: (f64, f64),
    ) -> (Passage, Jacobian) {
        match self.dual.get_or_init(|| DualKernel::new(&self.model)) {
            DualKernel::Motion(kernel) => {
                let Kernel { equation, clock, drive } = &**kernel;
                let [x, v] = self.variables([x, v]);
                let (start, span) = ([x, v, Dual::of(0.0)], self.span(clock, span));
                let traced = with_drive!(drive, drive => self.trace(equation, *clock, drive, start, span));
                let [x, v, _] = traced.end;
                let [by_x, by_v] = self.slopes([x, v], traced.passage.rested);
                (traced.passage, Jacobian::mechanical([by_x, by_v]))
            }
            DualKernel::WithCircuit(kernel) => {
                let (equation, clock, drive) = &**kernel;
                let (start, span) = (self.variables([x, v, electrical]), self.span(clock, span));
                let Traced { passage, end } = self.trace(equation, *clock, drive, start, span);
                let rows = self.slopes(end, false);
                (passage, Jacobian::with_circuit(rows))
            }
        }
    }

    /// Kernel units of displacement, velocity and the state of the circuit, per SI unit.
    fn kernel_units(&self) -> [f64; 3] {
        let unit = self.model.scales.unit();
        [1.0, unit, self.model.circuit().map_or(0.0, |circuit| unit / circuit.amount)]
    }

    /// Scales of displacement, velocity and the state of the circuit in kernel units. Derivatives are by
    /// these, so that they affect the length of a step as the state does.
    fn kernel_scales(&self) -> [f64; 3] {
        let speed = self.model.scales.speed * self.model.scales.unit();
        [self.model.scales.length, speed, speed]
    }

    /// A state in SI as numbers that are varied.
    fn variables<const N: usize>(&self, state: [f64; N]) -> [Dual<N>; N] {
        let (units, scales) = (self.kernel_units(), self.kernel_scales());
        std::array::from_fn(|i| {
            let mut slopes = [0.0; N];
            slopes[i] = scales[i];
            Dual { value: state[i] * units[i], slopes }
        })
    }

    /// The derivatives in SI of a state at an end; all 0 where nothing of the start is left.
    fn slopes<const N: usize>(&self, end: [Dual<N>; N], forgotten: bool) -> [[f64; N]; N] {
        if forgotten {
            return [[0.0; N]; N];
        }
        let (units, scales) = (self.kernel_units(), self.kernel_scales());
        let entry = |i: usize, j: usize| end[i].slopes[j] / scales[j] * units[j] / units[i];
        std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
    }

    /// The instants at these times after a strobe, in forcing periods.
    fn span<T: Scalar>(&self, clock: &Clock<T>, (from, to): (f64, f64)) -> (Instant<T>, Instant<T>) {
        let strobe = Instant { cycle: self.phase.0, phase: T::of(self.phase.1) * clock.period };
        let after = |periods: f64| match self.length {
            Length::Cycles(cycles) => {
                let cycles = periods * cycles as f64;
                let later = Instant { cycle: strobe.cycle + cycles.floor() as i64, ..strobe };
                clock.advance(&later, T::of(cycles - cycles.floor()) * clock.period)
            }
            Length::Seconds(seconds) => clock.at(seconds * periods),
        };
        (after(from), after(to))
    }
}
