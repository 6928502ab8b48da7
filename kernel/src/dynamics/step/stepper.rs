//! Stepper: equation, drive and clock, settings that follow from the tolerance, and the series of the present
//! step.

use super::impact::Impact;
use super::path::StepData;
use super::penetration::Penetration;
use super::quasi_static::QuasiStatic;
use super::work::{Costs, Work};
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::{End, Equation, Mode};
use crate::dynamics::model::Model;
use crate::dynamics::series::{Endpoint, MAX_ORDER, Series};
use crate::dynamics::state::MotionState;
use crate::numeric::{Scalar, elementary, fast_log2};

/// Maximum number of halvings of a step before it is given up.
pub(super) const MAX_HALVINGS: u32 = 200;

/// Tolerance of a step relative to that of the scene. The errors of some hundred steps add up; with this
/// share even the energy of an undamped run of some hundred periods stays within the tolerance. A share five
/// times smaller takes a tenth more time.
const LOCAL_SHARE: f64 = 0.02;

/// Largest permitted ratio of the residual at the end of a step to the neglected term for which the step was
/// chosen. It is rarely above 3 if the coefficients are representative, and soon above 1e3 if they are not.
pub(crate) const RESIDUAL: f64 = 20.0;

/// Number of roundings of the terms that add up in a residual.
pub(crate) const ROUNDINGS: f64 = 32.0;

/// Order from which the errors of a step are near rounding: that of a tolerance of 1e-12.
const HIGH_ORDER: usize = 20;

pub(crate) struct Settings<T> {
    pub order: usize,
    pub tolerance: f64,
    pub tolerance_log2: f64,
    pub speed: T,
    pub speed_log2: f64,
    pub longest: f64,
}

impl<T: Scalar> Settings<T> {
    /// The residual that a step of the full order may leave.
    pub fn residual_of_a_full_step(&self) -> T {
        T::of(RESIDUAL * self.order as f64 * self.tolerance) * self.speed
    }

    /// The order is the cheapest in measurements on the nominal cubic: about 5/4 coefficients per digit.
    pub fn new(model: &Model, unit: f64, tolerance: f64) -> Self {
        let local = tolerance * LOCAL_SHARE;
        let order = (3.0 - 1.25 * elementary::log10(local)).round().clamp(8.0, MAX_ORDER as f64) as usize;
        let speed = model.scales.speed * unit;
        let (at_high_order, otherwise) = model.scales.longest_step;
        let longest = if order >= HIGH_ORDER { at_high_order } else { otherwise };
        Self {
            order,
            tolerance: local,
            tolerance_log2: elementary::log2(local),
            speed: T::of(speed),
            speed_log2: fast_log2(speed),
            longest: longest / unit,
        }
    }
}

/// The data of a step apart from the state and the record.
pub(crate) struct Stepper<'a, T: Scalar, D: Drive<T>> {
    pub equation: &'a Equation<T>,
    pub drive: &'a D,
    pub clock: Clock<T>,
    pub settings: Settings<T>,
    pub series: Series<T>,
    pub cursor: D::Cursor,
    /// Workspace of contact with a compliant stop, made at the first contact.
    pub penetration: Option<Box<Penetration<T>>>,
    /// The same for an impact from touch to separation.
    pub impact: Option<Box<Impact<T>>>,
    /// The same for a mass that a slow load presses into the stop.
    pub quasi_static: Option<Box<QuasiStatic<T>>>,
    pub end: Instant<T>,
    pub evaluations: u64,
    pub work: Work<'a>,
    pub costs: Costs,
}

/// A step of free flight that has been chosen.
pub(crate) struct Step<T> {
    pub length: T,
    /// The instant at which it ends, if that is the end of the run or of the drive's segment.
    pub arrival: Option<Instant<T>>,
    pub end: Endpoint<T>,
}

impl<'a, T: Scalar, D: Drive<T>> Stepper<'a, T, D> {
    pub fn new(
        equation: &'a Equation<T>,
        drive: &'a D,
        clock: Clock<T>,
        settings: Settings<T>,
        end: Instant<T>,
        work: Work<'a>,
    ) -> Self {
        Self {
            equation,
            drive,
            clock,
            costs: Costs::new(settings.order, equation.degree(), drive),
            settings,
            series: Series::new(equation.degree()),
            cursor: D::Cursor::default(),
            penetration: None,
            impact: None,
            quasi_static: None,
            end,
            evaluations: 0,
            work,
        }
    }

    #[inline]
    pub fn mode(&self, state: &MotionState<T>) -> &'a Mode<T> {
        &self.equation.modes[state.mode]
    }

    /// Fills the first coefficients of the drive.
    #[inline]
    pub fn seed(&mut self, state: &MotionState<T>) {
        self.drive.seed(&state.at, state.segment, &mut self.series.a, &mut self.cursor);
        D::begin_circuit(&mut self.cursor, state.circuit);
    }

    /// The data of a step from this state: the chosen and the kept length, the duration, a bound of the
    /// displacement, and the state at its end.
    #[inline]
    pub fn step_data(
        &self,
        state: &MotionState<T>,
        (whole, length, duration): (T, T, T),
        bound: T,
        (x, v): (T, T),
    ) -> StepData<T> {
        let Mode { origin, low, high, .. } = *self.mode(state);
        StepData { origin, at: state.at, whole, length, duration, bound, limits: (low, high), x, v }
    }

    #[inline]
    pub fn left(&self, state: &MotionState<T>) -> T {
        self.clock.between(&state.at, &self.end)
    }

    pub fn seconds(&self, state: &MotionState<T>) -> f64 {
        self.clock.seconds(&state.at)
    }

    /// The end of the drive's segment or of the run, whichever comes first.
    #[inline]
    pub fn segment_limit(&self, state: &MotionState<T>) -> Instant<T> {
        match self.drive.segment_end(state.segment) {
            Some(border) if self.clock.between(&border, &self.end) > T::zero() => border,
            _ => self.end,
        }
    }

    /// Shortens a step to the end of the run, `left` away, or of the drive's segment; returns the instant of
    /// that.
    #[inline(always)]
    pub fn arrival(&self, state: &MotionState<T>, left: T, length: &mut T) -> Option<Instant<T>> {
        let mut arrival = None;
        if left <= *length {
            (*length, arrival) = (left, Some(self.end));
        }
        if let Some(border) = self.drive.segment_end(state.segment) {
            let to_border = self.clock.between(&state.at, &border);
            if to_border <= *length {
                (*length, arrival) = (to_border, Some(border));
            }
        }
        arrival
    }

    /// Enters the drive's next segment if the present one has ended. Returns whether it has.
    #[inline]
    pub fn pass_segment_end(&self, state: &mut MotionState<T>) -> bool {
        let end = self.drive.segment_end(state.segment);
        let ended = end.is_some_and(|border| self.clock.between(&state.at, &border) <= T::zero());
        state.segment += usize::from(ended);
        ended
    }

    /// Outward acceleration of a mass held at the stop of `end`, and its first two time derivatives.
    pub fn contact_acceleration(&mut self, state: &MotionState<T>, end: End) -> [T; 3] {
        self.seed(state);
        self.seeded_contact_acceleration(end)
    }

    /// The same, if the drive is already seeded.
    #[inline]
    pub fn seeded_contact_acceleration(&self, end: End) -> [T; 3] {
        let (a, sign) = (&self.series.a, end.sign::<T>());
        let stop = self.equation.stop(end).map_or(T::zero(), |stop| stop.acceleration);
        let rates = [stop - sign * a[0], -(sign * a[1]), -(sign * a[2] * T::of(2.0))];
        match self.circuit_push() {
            Some(push) => std::array::from_fn(|i| rates[i] - sign * push[i]),
            None => rates,
        }
    }

    /// The acceleration that the circuit takes from a mass held in place, and its first two derivatives, at
    /// the start of the series.
    #[inline(always)]
    pub fn circuit_push(&self) -> Option<[T; 3]> {
        let state = self.drive.circuit_state(&self.cursor)?;
        self.drive.circuit().map(|circuit| circuit.push(state[0]))
    }

    /// Bound of the rounding of the contact acceleration.
    #[inline]
    pub fn contact_acceleration_rounding(&self, end: End) -> T {
        let stop = self.equation.stop(end).map_or(T::zero(), |stop| stop.acceleration_rounding);
        let rounding = stop + self.series.a[0].abs() * T::of(4.0 * T::EPSILON);
        match self.circuit_push() {
            Some(push) => rounding + push[0].abs() * T::of(4.0 * T::EPSILON),
            None => rounding,
        }
    }
}
