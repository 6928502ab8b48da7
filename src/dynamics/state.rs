//! State of a motion: everything that its next step depends on.

use super::clock::Instant;
use super::equation::End;
use super::result::{Outcome, Phase};
use crate::numeric::Scalar;

/// A surface that the mass touches at the start of a step, and the multiplicity of the leading zero of the
/// gap there: how many of its coefficients are 0 by definition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Touch {
    pub end: End,
    pub multiplicity: usize,
}

/// Multiplicities of a touch: the gap opens with the speed, the acceleration, or what follows them.
pub(crate) const BY_SPEED: usize = 1;
pub(crate) const BY_ACCELERATION: usize = 2;
pub(crate) const BY_JERK: usize = 3;
/// Nothing up to the fourth coefficient opens the gap: what follows decides.
pub(crate) const UNDECIDED: usize = 5;
/// The surface is ignored for one step: on neither side of a break does the mass leave it.
pub(crate) const HELD: usize = usize::MAX;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Contact {
    Free,
    /// At rest on the stop of this end.
    Resting(End),
    /// At rest in an equilibrium that nothing disturbs.
    Motionless,
    /// In contact with the compliant stop of this end.
    Compressing(End),
    /// In clipped contact with it: behind its surface, where the stop does not follow, since it would have to
    /// pull.
    Clipped(End),
}

/// How far a mass has pressed in a compliant stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Depth<T> {
    /// Root of the depth; 0 outside.
    pub root: T,
    /// The contact became clipped, or ceased to be, right here.
    pub clip_changed: bool,
}

/// The state of a motion. The cursor of the drive's series is no part of it: that only keeps what would be
/// computed again, to the bit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MotionState<T> {
    pub at: Instant<T>,
    pub x: T,
    pub v: T,
    /// State of the circuit of a transducer; 0 where there is none.
    pub circuit: T,
    pub mode: usize,
    /// Segment of the drive.
    pub segment: usize,
    pub touch: Option<Touch>,
    pub contact: Contact,
    /// The instant of a release that turned out to be none.
    pub refused: Option<Instant<T>>,
    /// Whether the mass has changed its mode at a break without moving.
    pub turned_back: bool,
    pub depth: Depth<T>,
}

impl<T: Scalar> MotionState<T> {
    /// At time 0 in the drive's first segment.
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
            refused: None,
            turned_back: false,
            depth: Depth { root: T::zero(), clip_changed: false },
        }
    }

    /// What a sample here is.
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

    /// Its mirror image where `modes` is their number and no stop is compliant.
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

/// A motion between two steps: from it another motion of the same scene goes on as if it were this one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Checkpoint<T> {
    pub state: MotionState<T>,
    /// The side of the barrier that the recorder saw last.
    pub barrier_side: i8,
}

/// Identity of a release from rest, computed from the drive alone: equal labels are followed by equal
/// motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Label<T> {
    pub end: End,
    /// Cycle of the clock within the drive's common period.
    pub turn: i64,
    pub phase: T,
}

/// Whether a motion goes on or the run has ended.
pub(crate) type Flow = Option<Outcome>;
