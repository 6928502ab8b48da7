//! Settings of the stepper, derived from the tolerance.

use crate::dynamics::model::Model;
use crate::dynamics::series::MAX_ORDER;
use crate::numeric::{Scalar, fast_log2};

/// Tolerance of a step relative to that of the scene: the errors of some hundred steps add up, and even the
/// energy of an undamped run of some hundred periods then stays within the tolerance. A fifth of this share
/// costs a tenth more.
const LOCAL_SHARE: f64 = 0.02;

/// Largest permitted ratio of the residual at the end of a step to the neglected term for which the step was
/// chosen. It is rarely above 3 if the coefficients are representative, and soon above 1e3 if they are not.
pub(crate) const RESIDUAL: f64 = 20.0;

/// Number of roundings of the terms that add up in a residual.
pub(crate) const ROUNDINGS: f64 = 32.0;

/// Order, that of a tolerance of 1e-12, from which on the errors of a step are near rounding.
const HIGH_ORDER: usize = 20;

/// Settings of the stepper that follow from the tolerance.
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
        let order = (3.0 - 1.25 * local.log10()).round().clamp(8.0, MAX_ORDER as f64) as usize;
        let speed = model.scales.speed * unit;
        let (at_high_order, otherwise) = model.scales.longest_step;
        let longest = if order >= HIGH_ORDER { at_high_order } else { otherwise };
        Self {
            order,
            tolerance: local,
            tolerance_log2: local.log2(),
            speed: T::of(speed),
            speed_log2: fast_log2(speed),
            longest: longest / unit,
        }
    }
}
