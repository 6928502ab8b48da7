//! What does the integrator run on? The model in kernel units: time in a power of two of a second, mass 1.
//!
//! Each piece of the force curve becomes an *arena*: the interval in which the mass moves under one
//! polynomial, and what stands at its two ends (a stop, a break behind which the next piece begins, the end
//! of the known curve). The arena is the mode of the motion.

pub(crate) mod force;

use crate::dynamics::model::Model;
use crate::dynamics::model::stops::StopAt;
use crate::dynamics::result::Side;
use crate::numeric::Scalar;
use force::PieceForce;

/// Stands in for an end that does not exist; far, yet safe to compute with.
pub(crate) const FAR: f64 = 1e200;

/// What stands at an end of an arena.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EndKind {
    /// A rigid stop.
    Stop,
    /// The surface of a compliant stop, free flight on one side and contact on the other.
    Compliant,
    /// A break: the neighbouring piece begins.
    Break,
    /// Nothing is known beyond.
    Unknown,
}

/// One end of an arena: low (left) or high (right).
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

    /// The side that it is on.
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

/// A compliant stop: stiffness d^1.5 (1 + loss d') over mass, kernel units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Compliant<T> {
    pub stiffness: T,
    pub loss: T,
}

impl<T: Scalar> Compliant<T> {
    /// Elastic energy over mass at a root of the depth.
    pub fn stored(&self, root: T) -> T {
        let square = root * root;
        self.stiffness * (square * square * root) * T::of(2.0) / T::of(5.0)
    }
}

/// The interval in which one polynomial rules.
#[derive(Debug, Clone)]
pub(crate) struct Arena<T> {
    /// The piece of the force curve that it lies in.
    pub piece: usize,
    pub force: PieceForce<T>,
    pub origin: T,
    pub low: T,
    pub high: T,
    pub low_kind: EndKind,
    pub high_kind: EndKind,
}

impl<T: Scalar> Arena<T> {
    #[inline]
    pub fn end(&self, end: End) -> (T, EndKind) {
        match end {
            End::Low => (self.low, self.low_kind),
            End::High => (self.high, self.high_kind),
        }
    }
}

/// What a stop does to the mass that touches it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stop<T> {
    pub restitution: T,
    /// Outward acceleration by the mechanism alone at the stop: positive presses.
    pub press: T,
    /// Rounding error of `press`.
    pub press_rounding: T,
    /// Slope of force over mass at the stop.
    pub stiffness: T,
}

/// The equation of motion in kernel units.
#[derive(Debug, Clone)]
pub(crate) struct Equation<T> {
    /// c/m.
    pub damping: T,
    pub arenas: Vec<Arena<T>>,
    pub left: Option<Stop<T>>,
    pub right: Option<Stop<T>>,
    /// What the two stops are made of, where they are compliant.
    pub compliant: Option<Compliant<T>>,
    /// Seconds per kernel time unit.
    pub unit: f64,
}

/// The arenas with the surface of a compliant stop at `x` between two of them; a curve that ends there or before has
/// no stop.
fn cut<T: Scalar>(arenas: Vec<Arena<T>>, x: T) -> Vec<Arena<T>> {
    let mut parts = Vec::with_capacity(arenas.len() + 1);
    let last = arenas.len() - 1;
    for (index, mut arena) in arenas.into_iter().enumerate() {
        if arena.low < x && x < arena.high {
            let beyond = Arena { low: x, low_kind: EndKind::Compliant, ..arena.clone() };
            (arena.high, arena.high_kind) = (x, EndKind::Compliant);
            parts.extend([arena, beyond]);
            continue;
        }
        if arena.low == x && index > 0 {
            arena.low_kind = EndKind::Compliant;
        }
        if arena.high == x && index < last {
            arena.high_kind = EndKind::Compliant;
        }
        parts.push(arena);
    }
    parts
}

impl<T: Scalar> Equation<T> {
    pub fn new(model: &Model, unit: f64) -> Self {
        let curve = &model.mechanism.curve;
        let square = T::of(unit * unit) / T::of(model.mass);
        let compliant = model.compliant.map(|own| Compliant {
            stiffness: T::of(own.stiffness) * square,
            loss: T::of(own.loss) / T::of(unit),
        });
        let left_stop = model.stops.as_ref().and_then(|s| s.left);
        let right_stop = model.stops.as_ref().and_then(|s| s.right);
        let rigid = |stop: Option<StopAt>| stop.filter(|_| compliant.is_none());
        let mut arenas: Vec<Arena<T>> = Vec::with_capacity(curve.pieces().len());
        for (index, piece) in curve.pieces().iter().enumerate() {
            let (left, right) = curve.piece_interval(index);
            let coefficients: Vec<T> = piece.coefficients.iter().map(|c| T::of(*c) * square).collect();
            let odd = coefficients.len() > 2
                && coefficients.len().is_multiple_of(2)
                && piece.coefficients.iter().step_by(2).all(|c| *c == 0.0);
            let end = |x: f64, outermost: bool, stop: Option<StopAt>, inside: bool| match stop {
                Some(s) if inside => (T::of(s.x), EndKind::Stop),
                _ if outermost && !x.is_finite() => (T::of(FAR.copysign(x)), EndKind::Unknown),
                _ if outermost => (T::of(x), EndKind::Unknown),
                _ => (T::of(x), EndKind::Break),
            };
            let last = index + 1 == curve.pieces().len();
            let (low, low_kind) =
                end(left, index == 0, rigid(left_stop), left_stop.is_some_and(|s| s.x >= left));
            let (high, high_kind) =
                end(right, last, rigid(right_stop), right_stop.is_some_and(|s| s.x <= right));
            arenas.push(Arena {
                piece: index,
                force: PieceForce::new(coefficients, odd),
                origin: T::of(piece.origin),
                low,
                high,
                low_kind,
                high_kind,
            });
        }
        let stop = |at: Option<StopAt>, sign: T| {
            at.map(|s| {
                let arena = &arenas[curve.piece_index(s.x).min(arenas.len() - 1)];
                let (f, slope, size) = arena.force.value(T::of(s.x) - arena.origin);
                Stop {
                    restitution: T::of(s.restitution),
                    press: -(sign * f),
                    press_rounding: size,
                    stiffness: slope,
                }
            })
        };
        let left = stop(left_stop, T::of(-1.0));
        let right = stop(right_stop, T::of(1.0));
        if compliant.is_some() {
            for at in [left_stop, right_stop].into_iter().flatten() {
                arenas = cut(arenas, T::of(at.x));
            }
        }
        Self {
            damping: T::of(model.damping * unit) / T::of(model.mass),
            arenas,
            left,
            right,
            compliant,
            unit,
        }
    }

    /// The most products of series that a piece's force takes beyond the first.
    pub fn most_products(&self) -> usize {
        self.arenas.iter().map(|arena| arena.force.products()).max().unwrap_or(0)
    }

    /// The arena of a mass at `x`, which lies on `piece` of the force curve; on the surface of a compliant stop the one
    /// outside it.
    pub fn arena_at(&self, x: T, piece: usize) -> usize {
        if self.compliant.is_none() {
            return piece;
        }
        let surface = |end: End, arena: &Arena<T>| arena.end(end) == (x, EndKind::Compliant);
        let holds = |arena: &Arena<T>| arena.piece == piece && arena.low <= x && x <= arena.high;
        let middle = x < T::zero();
        let outside = |arena: &Arena<T>| surface(if middle { End::Low } else { End::High }, arena);
        let found = self.arenas.iter().position(outside).or(self.arenas.iter().position(holds));
        found.unwrap_or(piece)
    }

    /// Displacement of the surface of the compliant stop of `end`.
    pub fn surface(&self, end: End) -> Option<T> {
        let surface = |arena: &&Arena<T>| {
            // The arena outside it: the surface is its end on that side.
            arena.end(end).1 == EndKind::Compliant && (arena.end(end).0 < T::zero()) == (end == End::Low)
        };
        self.arenas.iter().find(surface).map(|arena| arena.end(end).0)
    }

    /// The stop at an end.
    #[inline]
    pub fn stop(&self, end: End) -> Option<&Stop<T>> {
        match end {
            End::Low => self.left.as_ref(),
            End::High => self.right.as_ref(),
        }
    }
}
