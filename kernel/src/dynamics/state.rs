//! State of a motion: all data that its next step depends on.

use super::clock::Instant;
use super::equation::End;
use super::result::{Outcome, Phase};
use crate::numeric::Scalar;

/// The state at the start of a run.
pub(crate) struct Start<T> {
    /// Velocity and state of the circuit, kernel units.
    pub v: T,
    pub circuit: T,
    pub mode: usize,
    /// Displacement in m.
    pub x: f64,
    /// Energy in J stored in a compliant stop.
    pub stop_energy: f64,
}

impl<T: Scalar> Default for Start<T> {
    fn default() -> Self {
        Self { v: T::zero(), circuit: T::zero(), mode: 0, x: 0.0, stop_energy: 0.0 }
    }
}

/// A surface that the mass touches at the start of a step, and the derivative that opens the gap to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Touch {
    pub end: End,
    pub opening: Opening,
}

/// The derivative of the motion that opens the gap to a touched surface. As a number it is the multiplicity
/// of the root of the gap there: how many of its leading coefficients are 0 by definition.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(crate) enum Opening {
    Speed = 1,
    Acceleration,
    Jerk,
    Snap,
    /// None of these; the next coefficients decide.
    Undecided,
    /// The surface is ignored for one step: the mass leaves a break on neither side.
    Ignored,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Contact {
    Free,
    Resting(End),
    /// At rest in an equilibrium that nothing disturbs.
    Motionless,
    /// In the compliant stop at this end, which pushes back.
    Compressing(End),
    /// In the compliant stop at this end, with the force clipped to 0, since the stop would have to pull.
    Clipped(End),
}

/// Depth of a mass in a compliant stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Depth<T> {
    /// Root of the depth; 0 outside.
    pub root: T,
    /// Whether clipping of the contact force began or ended at this instant.
    pub clip_changed: bool,
}

/// The state of a motion. The cursor of the drive's series is not part of it: it only caches numbers that
/// would be computed again with the same bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MotionState<T> {
    pub at: Instant<T>,
    pub x: T,
    pub v: T,
    /// State of the circuit of a transducer; 0 without one.
    pub circuit: T,
    pub mode: usize,
    pub segment: usize,
    pub touch: Option<Touch>,
    pub contact: Contact,
    /// The instant of a release after which the mass did not leave the stop.
    pub failed_release: Option<Instant<T>>,
    /// Whether the mass has changed its mode at a break without moving.
    pub turned_back: bool,
    pub depth: Depth<T>,
}

impl<T: Scalar> MotionState<T> {
    /// The state at time 0 in the drive's first segment.
    pub fn new((x, v): (T, T), mode: usize, contact: Contact) -> Self {
        Self {
            at: Instant { cycle: 0, phase: T::zero() },
            x,
            v,
            circuit: T::zero(),
            mode,
            segment: 0,
            touch: None,
            contact,
            failed_release: None,
            turned_back: false,
            depth: Depth { root: T::zero(), clip_changed: false },
        }
    }

    pub fn phase(&self) -> Phase {
        match self.contact {
            Contact::Resting(End::Low) | Contact::Compressing(End::Low) | Contact::Clipped(End::Low) => {
                Phase::LeftStop
            }
            Contact::Resting(End::High) | Contact::Compressing(End::High) | Contact::Clipped(End::High) => {
                Phase::RightStop
            }
            // The stops stand on both sides of 0.
            Contact::Motionless if self.depth.root > T::zero() && self.x < T::zero() => Phase::LeftStop,
            Contact::Motionless if self.depth.root > T::zero() => Phase::RightStop,
            Contact::Free | Contact::Motionless => Phase::Free,
        }
    }

    /// Its mirror image; `modes` is the number of modes. No stop may be compliant.
    pub fn mirrored(self, modes: usize) -> Self {
        let minus = |value: T| T::zero() - value;
        let contact = match self.contact {
            Contact::Resting(end) => Contact::Resting(end.other()),
            contact => contact,
        };
        Self {
            x: minus(self.x),
            v: minus(self.v),
            circuit: minus(self.circuit),
            mode: modes - 1 - self.mode,
            touch: self.touch.map(|touch| Touch { end: touch.end.other(), ..touch }),
            contact,
            ..self
        }
    }

    /// The mass crosses an end of its mode into the next one.
    #[inline]
    pub fn enter(&mut self, end: End) {
        match end {
            End::Low => self.mode -= 1,
            End::High => self.mode += 1,
        }
    }
}

/// A motion between two steps: another motion of the same scene can continue from it as if it were this one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Checkpoint<T> {
    pub state: MotionState<T>,
    /// The side of the barrier that the recorder saw last.
    pub barrier_side: i8,
}

/// Identity of a release from rest, computed from the drive alone: equal motions follow equal labels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Label<T> {
    pub end: End,
    /// Cycle of the clock within the drive's common period.
    pub turn: i64,
    pub phase: T,
}

/// `None` while the motion continues; otherwise how the run has ended.
pub(crate) type Flow = Option<Outcome>;
