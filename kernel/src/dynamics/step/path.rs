//! Evaluation of a step, in the parameter in which it is a polynomial.
//!
//! A step of free flight is a polynomial in time; one of contact with a compliant stop is a polynomial in
//! another parameter, and time is a polynomial in it too. Both have the same interface. For a flight the
//! parameter is the time since the start of the step: its methods are those of the series and cost nothing.

use crate::dynamics::clock::Instant;
use crate::dynamics::result::Phase;
use crate::dynamics::series::polynomial;
use crate::dynamics::series::{Integrals, ROOM, Series};
use crate::numeric::{GaussLegendre, Scalar};

/// The motion over one step, in a parameter that is 0 at the step's start and grows with time. Unless a path
/// says otherwise, the parameter is the time.
pub(crate) trait Path<T: Scalar> {
    /// Whether it runs in contact with a compliant stop.
    const IN_CONTACT: bool;

    /// The phase of a sample on it.
    fn phase(&self) -> Phase;
    /// The coefficients of the displacement, if it is a polynomial in time.
    fn in_time(&self) -> Option<&[T]> {
        None
    }
    /// Number of coefficients of the displacement.
    fn known(&self) -> usize;
    /// Displacement from the piece's origin at the step's start.
    fn start(&self) -> T;
    /// The coefficients of the displacement, each times its power of `h`.
    fn scaled(&self, h: T) -> [T; ROOM];
    /// Displacement from the piece's origin.
    fn position(&self, parameter: T) -> T;
    fn velocity(&self, parameter: T) -> T;
    /// Time since the step's start.
    #[inline]
    fn time(&self, parameter: T) -> T {
        parameter
    }
    /// The parameter, up to `length`, at a time since the step's start.
    #[inline]
    fn parameter(&self, time: T, _length: T) -> T {
        time
    }
    /// Integrals over time between two parameters: of the squared velocity and, if `WORK`, of base
    /// acceleration times velocity.
    fn integrals<const WORK: bool>(&self, rule: &GaussLegendre<T>, from: T, to: T) -> (T, T);
    /// Integral over time between two parameters of the displacement from the piece's origin.
    fn moment(&self, rule: &GaussLegendre<T>, from: T, to: T) -> T {
        polynomial::integral(rule, from, to, |t| self.position(t))
    }
}

pub(crate) trait InStop<T: Scalar>: Path<T> {
    /// Energy over mass that the stop dissipates over (from, to) in the path's parameter.
    fn loss(&self, rule: &GaussLegendre<T>, from: T, to: T) -> T;
    /// The larger of `known` and the largest force over mass in a step of length `h`, up to its fraction
    /// `until`.
    fn peak(&self, h: T, until: T, known: T) -> T;
}

/// An accepted step without its path, as the recorder sees it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StepData<T> {
    /// Origin of the piece.
    pub origin: T,
    pub at: Instant<T>,
    /// Length of the step as it was chosen, in the path's parameter.
    pub whole: T,
    /// Length that is kept, at most `whole`.
    pub length: T,
    pub duration: T,
    /// Bound of |x - x(start)| over the step.
    pub bound: T,
    /// Ends of the mode: x never passes them.
    pub limits: (T, T),
    /// Displacement at the end of the kept length.
    pub x: T,
    /// Velocity at the end of the kept length.
    pub v: T,
}

impl<T: Scalar> StepData<T> {
    /// Displacement at a parameter of the step's path, limited to the mode, since its origin is rounded.
    pub fn x_at<P: Path<T>>(&self, path: &P, parameter: T) -> T {
        let x = path.position(parameter) + self.origin;
        x.larger(self.limits.0).smaller(self.limits.1)
    }
}

/// A step of free flight: its parameter is the time since its start.
impl<T: Scalar> Path<T> for Series<T> {
    const IN_CONTACT: bool = false;

    #[inline]
    fn phase(&self) -> Phase {
        Phase::Free
    }
    #[inline]
    fn in_time(&self) -> Option<&[T]> {
        Some(self.coefficients())
    }
    #[inline]
    fn known(&self) -> usize {
        self.known
    }
    #[inline]
    fn start(&self) -> T {
        self.y[0]
    }
    #[inline]
    fn scaled(&self, h: T) -> [T; ROOM] {
        polynomial::scaled(self.coefficients(), h)
    }
    #[inline]
    fn position(&self, parameter: T) -> T {
        polynomial::value(self.coefficients(), parameter)
    }
    #[inline]
    fn velocity(&self, parameter: T) -> T {
        polynomial::slope(self.coefficients(), parameter)
    }
    #[inline]
    fn integrals<const WORK: bool>(&self, rule: &GaussLegendre<T>, from: T, to: T) -> (T, T) {
        let whole = from == T::zero();
        if let Some(known) = self.measured.get().filter(|known| whole && known.until == to) {
            return (known.squared, known.work);
        }
        let (y, a) = (self.coefficients(), self.base_coefficients());
        let (squared, work) = polynomial::integrals::<_, WORK>(y, a, rule, from, to);
        if whole {
            self.measured.set(Some(Integrals { until: to, squared, work }));
        }
        (squared, work)
    }
}
