//! Reading of a step, in whichever parameter it is a polynomial.
//!
//! A step of free flight is a polynomial in time; one of contact with a compliant stop is a polynomial in
//! another parameter, of which time is itself a polynomial. What is asked of either is the same, and for a
//! flight the parameter is the time since the step's start: there these methods are the series' own, and cost
//! nothing.

use crate::dynamics::clock::Instant;
use crate::dynamics::result::Phase;
use crate::dynamics::series::polynomial;
use crate::dynamics::series::{ROOM, Series};
use crate::numeric::{GaussLegendre, Scalar};

/// The motion over one step, in a parameter that is 0 at the step's start and grows with time.
pub(crate) trait Path<T: Scalar> {
    /// Whether it runs in contact with a compliant stop.
    const IN_CONTACT: bool;

    /// What a sample on it is.
    fn phase(&self) -> Phase;
    /// The coefficients of displacement and base, where they are of powers of time.
    fn in_time(&self) -> Option<(&[T], &[T])> {
        None
    }
    /// The coefficients of a circuit's state, where there is one.
    #[inline(always)]
    fn circuit(&self) -> Option<&[T]> {
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
    /// Velocity.
    fn velocity(&self, parameter: T) -> T;
    /// Time since the step's start.
    fn time(&self, parameter: T) -> T;
    /// The parameter, up to `length`, of a time since the step's start.
    fn parameter(&self, time: T, length: T) -> T;
    /// Integrals over time between two parameters: of the squared velocity and, where `WORK`, of base
    /// acceleration times velocity.
    fn integrals<const WORK: bool>(&self, rule: &GaussLegendre<T>, from: T, to: T) -> (T, T);
    /// Integral over time between two parameters of the displacement from the piece's origin.
    fn moment(&self, rule: &GaussLegendre<T>, from: T, to: T) -> T;
}

/// What is told of a step within a compliant stop, beside its path.
pub(crate) trait InStop<T: Scalar>: Path<T> {
    /// Energy over mass that the stop keeps over (from, to) in the path's parameter.
    fn loss(&self, rule: &GaussLegendre<T>, from: T, to: T) -> T;
    /// The largest force over mass within a step of `h`, up to its share `until`, where it may exceed
    /// `known`.
    fn peak(&self, h: T, until: T, known: T) -> T;
}

/// One accepted step, as the recorder sees it.
pub(crate) struct StepView<'a, T, P = Series<T>> {
    pub path: &'a P,
    /// Origin that the series is about.
    pub origin: T,
    /// When the step starts.
    pub at: Instant<T>,
    /// Length of the step as it was chosen, in the path's parameter.
    pub whole: T,
    /// Length that is kept, up to the whole.
    pub length: T,
    /// The time that it takes.
    pub duration: T,
    /// Bound of |x - x(start)| over the step.
    pub bound: T,
    /// Ends of the mode: x never passes them.
    pub limits: (T, T),
    /// State at the end of what is kept.
    pub x: T,
    pub v: T,
}

impl<T: Scalar, P: Path<T>> StepView<'_, T, P> {
    /// The same step along another path.
    pub fn along<'a, Q>(&self, path: &'a Q) -> StepView<'a, T, Q> {
        let Self { origin, at, whole, length, duration, bound, limits, x, v, .. } = *self;
        StepView { path, origin, at, whole, length, duration, bound, limits, x, v }
    }

    /// Displacement at a parameter of the step, never beyond the mode by the rounding of its origin.
    pub fn x_at(&self, t: T) -> T {
        let x = self.path.position(t) + self.origin;
        x.larger(self.limits.0).smaller(self.limits.1)
    }
}

/// A step whose parameter is the time since its start.
pub(crate) trait InTime {
    /// The number that it is made of.
    type Number: Scalar;

    /// Coefficients of the displacement from the piece's origin.
    fn coefficients(&self) -> &[Self::Number];
    /// Coefficients of the base's acceleration.
    fn base_coefficients(&self) -> &[Self::Number];
    /// Those of a circuit's state, where there is one.
    #[inline(always)]
    fn circuit(&self) -> Option<&[Self::Number]> {
        None
    }

    /// As [`Path::integrals`].
    #[inline]
    fn integrals_in_time<const WORK: bool>(
        &self,
        rule: &GaussLegendre<Self::Number>,
        from: Self::Number,
        to: Self::Number,
    ) -> (Self::Number, Self::Number) {
        polynomial::integrals::<_, WORK>(self.coefficients(), self.base_coefficients(), rule, from, to)
    }
}

impl<T: Scalar> InTime for Series<T> {
    type Number = T;

    #[inline]
    fn coefficients(&self) -> &[T] {
        &self.y[..self.known]
    }
    #[inline]
    fn base_coefficients(&self) -> &[T] {
        Series::base_coefficients(self)
    }
    #[inline]
    fn integrals_in_time<const WORK: bool>(&self, rule: &GaussLegendre<T>, from: T, to: T) -> (T, T) {
        match self.measured {
            Some((length, squared)) if !WORK && from == T::zero() && to == length => (squared, T::zero()),
            _ => polynomial::integrals::<_, WORK>(
                self.coefficients(),
                self.base_coefficients(),
                rule,
                from,
                to,
            ),
        }
    }
}

impl<T: Scalar, P: InTime<Number = T>> Path<T> for P {
    const IN_CONTACT: bool = false;

    #[inline]
    fn phase(&self) -> Phase {
        Phase::Free
    }
    #[inline]
    fn in_time(&self) -> Option<(&[T], &[T])> {
        Some((self.coefficients(), self.base_coefficients()))
    }
    #[inline(always)]
    fn circuit(&self) -> Option<&[T]> {
        InTime::circuit(self)
    }
    #[inline]
    fn known(&self) -> usize {
        self.coefficients().len()
    }
    #[inline]
    fn start(&self) -> T {
        self.coefficients()[0]
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
    fn time(&self, parameter: T) -> T {
        parameter
    }
    #[inline]
    fn parameter(&self, time: T, _: T) -> T {
        time
    }
    #[inline]
    fn integrals<const WORK: bool>(&self, rule: &GaussLegendre<T>, from: T, to: T) -> (T, T) {
        self.integrals_in_time::<WORK>(rule, from, to)
    }
    fn moment(&self, rule: &GaussLegendre<T>, from: T, to: T) -> T {
        polynomial::moment(self.coefficients(), rule, from, to)
    }
}
