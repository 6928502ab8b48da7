//! Mode of the motion: the interval in which one polynomial gives the force, and the kind of its ends.

use super::force::PieceForce;
use crate::dynamics::result::Side;
use crate::numeric::Scalar;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EndKind {
    Stop,
    /// The surface of a compliant stop, free flight on one side and contact on the other.
    Compliant,
    /// A break: the neighbouring piece begins.
    Break,
    /// The end of the known curve.
    Unknown,
}

/// One end of a mode: low (left) or high (right).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    Low,
    High,
}

impl End {
    /// -1 for low, +1 for high.
    #[inline]
    pub fn sign<T: Scalar>(self) -> T {
        match self {
            Self::Low => T::of(-1.0),
            Self::High => T::of(1.0),
        }
    }

    pub fn side(self) -> Side {
        match self {
            Self::Low => Side::Left,
            Self::High => Side::Right,
        }
    }

    pub fn other(self) -> Self {
        match self {
            Self::Low => Self::High,
            Self::High => Self::Low,
        }
    }
}

/// The interval in which one polynomial gives the force.
#[derive(Debug, Clone)]
pub(crate) struct Mode<T> {
    /// The piece of the force curve that it lies in.
    pub piece: usize,
    pub force: PieceForce<T>,
    pub origin: T,
    pub low: T,
    pub high: T,
    pub low_kind: EndKind,
    pub high_kind: EndKind,
    /// Coefficients of force over mass about its low and its high end, if that end is a stop and the degree
    /// of the force is 4 or more.
    pub(super) about: [Vec<T>; 2],
}

impl<T: Scalar> Mode<T> {
    pub(super) fn expand_about_stops(&mut self) {
        for (end, place) in [(End::Low, 0), (End::High, 1)] {
            let (level, kind) = self.end(end);
            if self.force.degree() > 3 && matches!(kind, EndKind::Stop | EndKind::Compliant) {
                self.force.about(level - self.origin, &mut self.about[place]);
            }
        }
    }

    /// Coefficients of force over mass about `x`, if that is a stop and they are known; otherwise empty.
    #[inline]
    pub fn about(&self, end: End, x: T) -> &[T] {
        match end {
            End::Low if x == self.low => &self.about[0],
            End::High if x == self.high => &self.about[1],
            _ => &[],
        }
    }

    #[inline]
    pub fn end(&self, end: End) -> (T, EndKind) {
        match end {
            End::Low => (self.low, self.low_kind),
            End::High => (self.high, self.high_kind),
        }
    }
}

/// Cuts the modes at the surface of a compliant stop at `x`. A curve that ends by `x` has no stop there.
pub(super) fn cut<T: Scalar>(modes: Vec<Mode<T>>, x: T) -> Vec<Mode<T>> {
    let mut parts = Vec::with_capacity(modes.len() + 1);
    let last = modes.len() - 1;
    for (index, mut mode) in modes.into_iter().enumerate() {
        if mode.low < x && x < mode.high {
            let beyond = Mode { low: x, low_kind: EndKind::Compliant, ..mode.clone() };
            (mode.high, mode.high_kind) = (x, EndKind::Compliant);
            parts.extend([mode, beyond]);
            continue;
        }
        if mode.low == x && index > 0 {
            mode.low_kind = EndKind::Compliant;
        }
        if mode.high == x && index < last {
            mode.high_kind = EndKind::Compliant;
        }
        parts.push(mode);
    }
    parts
}
