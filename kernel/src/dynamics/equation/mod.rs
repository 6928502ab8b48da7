//! Equation of motion in kernel units: time in a power of two of a second, mass 1.
//!
//! Each piece of the force curve becomes a *mode*: the interval in which one polynomial gives the force, and
//! the kind of its ends (a stop, a break before the next piece, the end of the known curve).

pub(crate) mod force;
mod mode;
mod stop;

use crate::dynamics::model::Model;
use crate::dynamics::model::stops::StopAt;
use crate::numeric::Scalar;
use force::PieceForce;
use mode::cut;

pub(crate) use mode::{End, EndKind, Mode};
pub(crate) use stop::{Compliant, Stop};

/// Displacement of an end that does not exist: far away, but safe to compute with.
pub(crate) const FAR: f64 = 1e200;

#[derive(Debug, Clone)]
pub(crate) struct Equation<T> {
    /// c/m.
    pub damping: T,
    pub modes: Vec<Mode<T>>,
    pub left: Option<Stop<T>>,
    pub right: Option<Stop<T>>,
    /// The contact law of both stops, if they are compliant.
    pub compliant: Option<Compliant<T>>,
    /// Seconds per kernel time unit.
    pub unit: f64,
}

impl<T: Scalar> Equation<T> {
    pub fn new(model: &Model, unit: f64) -> Self {
        let curve = &model.mechanism.curve;
        let square = T::of(unit * unit) / T::of(model.mass);
        let compliant = model.compliant.map(|stop| Compliant {
            stiffness: T::of(stop.stiffness) * square,
            loss: T::of(stop.loss) / T::of(unit),
        });
        let (left_stop, right_stop) = model.sides();
        let rigid = |stop: Option<StopAt>| stop.filter(|_| compliant.is_none());
        let mut modes: Vec<Mode<T>> = Vec::with_capacity(curve.pieces().len());
        for (index, piece) in curve.pieces().iter().enumerate() {
            let (left, right) = curve.piece_interval(index);
            let coefficients: Vec<T> = piece.coefficients.iter().map(|c| T::of(*c) * square).collect();
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
            let (origin, force) = (T::of(piece.origin), PieceForce { coefficients });
            let about = [Vec::new(), Vec::new()];
            modes.push(Mode { piece: index, force, origin, low, high, low_kind, high_kind, about });
        }
        let stop = |at: Option<StopAt>, sign: T| {
            at.map(|s| {
                let mode = &modes[model.piece_index(s.x)];
                let (f, slope, size) = mode.force.value(T::of(s.x) - mode.origin);
                Stop {
                    restitution: T::of(s.restitution),
                    acceleration: -(sign * f),
                    acceleration_rounding: size,
                    stiffness: slope,
                }
            })
        };
        let (left, right) = (stop(left_stop, T::of(-1.0)), stop(right_stop, T::of(1.0)));
        if compliant.is_some() {
            for at in [left_stop, right_stop].into_iter().flatten() {
                modes = cut(modes, T::of(at.x));
            }
        }
        modes.iter_mut().for_each(Mode::expand_about_stops);
        let damping = T::of(model.total_damping() * unit) / T::of(model.mass);
        Self { damping, modes, left, right, compliant, unit }
    }

    /// The highest degree of a piece's force.
    pub fn degree(&self) -> usize {
        self.modes.iter().map(|mode| mode.force.degree()).max().unwrap_or(0)
    }

    /// The mode of a mass at `x`, which lies on `piece` of the force curve. On the surface of a compliant
    /// stop it is the mode outside the stop.
    pub fn mode_at(&self, x: T, piece: usize) -> usize {
        if self.compliant.is_none() {
            return piece;
        }
        let side = if x < T::zero() { End::Low } else { End::High };
        let outside = |mode: &Mode<T>| mode.end(side) == (x, EndKind::Compliant);
        let holds = |mode: &Mode<T>| mode.piece == piece && mode.low <= x && x <= mode.high;
        let found = self.modes.iter().position(outside).or(self.modes.iter().position(holds));
        found.unwrap_or(piece)
    }

    /// Displacement of the surface of the compliant stop of `end`.
    pub fn surface(&self, end: End) -> Option<T> {
        let surface = |mode: &&Mode<T>| {
            // The mode outside it: the surface is its end on that side.
            mode.end(end).1 == EndKind::Compliant && (mode.end(end).0 < T::zero()) == (end == End::Low)
        };
        self.modes.iter().find(surface).map(|mode| mode.end(end).0)
    }

    #[inline]
    pub fn stop(&self, end: End) -> Option<&Stop<T>> {
        match end {
            End::Low => self.left.as_ref(),
            End::High => self.right.as_ref(),
        }
    }
}
