//! Instants, compensated sums and a trial step of all lanes.

use crate::dynamics::clock::Instant;
use crate::dynamics::series::Endpoint;
use crate::numeric::{CompensatedSum, Lanes};

/// Instants; the cycles are whole numbers below 2^53.
#[derive(Clone, Copy)]
pub(super) struct Clocks<const W: usize> {
    pub cycle: Lanes<W>,
    pub phase: Lanes<W>,
}

impl<const W: usize> Clocks<W> {
    pub fn set(&mut self, lane: usize, at: &Instant<f64>) {
        (self.cycle.0[lane], self.phase.0[lane]) = (at.cycle as f64, at.phase);
    }

    pub fn get(&self, lane: usize) -> Instant<f64> {
        Instant { cycle: self.cycle.0[lane] as i64, phase: self.phase.0[lane] }
    }

    /// Like [`Clock::advance`](crate::dynamics::clock::Clock::advance), for steps of up to a cycle; a longer
    /// step leaves the phase beyond the cycle.
    #[inline(always)]
    pub fn advance(&self, by: &Lanes<W>, period: &Lanes<W>) -> Self {
        let mut later = *self;
        for lane in 0..W {
            let (period, phase) = (period.0[lane], self.phase.0[lane] + by.0[lane]);
            let whole = if phase >= period { 1.0 } else { 0.0 };
            later.phase.0[lane] = phase - whole * period;
            later.cycle.0[lane] = self.cycle.0[lane] + whole;
        }
        later
    }
}

#[derive(Clone, Copy)]
pub(super) struct CompensatedSums<const W: usize> {
    pub sum: Lanes<W>,
    pub carry: Lanes<W>,
}

impl<const W: usize> CompensatedSums<W> {
    pub fn set(&mut self, lane: usize, sum: &CompensatedSum<f64>) {
        (self.sum.0[lane], self.carry.0[lane]) = sum.parts();
    }

    #[inline(always)]
    pub fn get(&self, lane: usize) -> CompensatedSum<f64> {
        CompensatedSum::of_parts(self.sum.0[lane], self.carry.0[lane])
    }

    /// The parts of a sum with one more term.
    #[inline(always)]
    pub fn with(&self, lane: usize, term: f64) -> (f64, f64) {
        let mut sum = self.get(lane);
        sum.add(term);
        sum.parts()
    }
}

/// A step computed in all lanes.
pub(crate) struct Trial<const W: usize> {
    /// Active lanes that did not take the step, since an event is possible on it.
    pub stopped: [bool; W],
    pub taken: [bool; W],
    /// Lanes that took the step up to a break of the force curve and are to enter the neighbouring mode.
    pub passed: [bool; W],
    /// Whether the polynomial satisfies the equation of motion at the step's end.
    pub holds: [bool; W],
    pub length: Lanes<W>,
    pub end: Endpoint<Lanes<W>>,
    /// The end of the step.
    pub at: Clocks<W>,
    /// The drive and its time derivative per unit amplitude there.
    pub unit: (Lanes<W>, Lanes<W>),
    /// Integral of the squared velocity over the whole step, if `measured`.
    pub squared: Lanes<W>,
    pub measured: [bool; W],
}

impl<const W: usize> Trial<W> {
    pub fn new() -> Self {
        let (zero, none) = (Lanes([0.0; W]), [false; W]);
        Self {
            stopped: none,
            taken: none,
            passed: none,
            holds: none,
            length: zero,
            end: Endpoint { y: zero, v: zero, acceleration: zero, bound: zero },
            at: Clocks { cycle: zero, phase: zero },
            unit: (zero, zero),
            squared: zero,
            measured: none,
        }
    }

    /// The end of the polynomial of a lane.
    pub fn end(&self, lane: usize) -> Endpoint<f64> {
        let Endpoint { y, v, acceleration, bound } = &self.end;
        Endpoint { y: y.0[lane], v: v.0[lane], acceleration: acceleration.0[lane], bound: bound.0[lane] }
    }
}
