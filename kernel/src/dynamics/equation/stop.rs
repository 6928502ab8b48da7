//! Laws of the stops. A rigid stop returns the mass with its restitution times the speed (Newton).

use crate::numeric::Scalar;

/// A stop as seen by the mass that touches it, in kernel units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stop<T> {
    pub restitution: T,
    /// Outward acceleration by the mechanism alone at the stop: a positive one presses the mass onto it.
    pub acceleration: T,
    /// Its rounding error.
    pub acceleration_rounding: T,
    /// Slope of force over mass at the stop.
    pub stiffness: T,
}

/// A compliant stop: stiffness d^1.5 (1 + loss d') over mass, d the depth, kernel units; contact by
/// Hertz, loss by Hunt and Crossley (1975). The force is clipped to 0 where the law would pull.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Compliant<T> {
    pub stiffness: T,
    pub loss: T,
}

impl<T: Scalar> Compliant<T> {
    /// Force over mass at the root `u` of the depth and the inward speed `w`, if it is not clipped.
    pub fn force(&self, u: T, w: T) -> T {
        self.stiffness * (u * u * u) * (T::of(1.0) + self.loss * w)
    }

    /// Whether the contact is clipped at the inward speed `w`: the stop would have to pull.
    pub fn is_clipped(&self, w: T) -> bool {
        T::of(1.0) + self.loss * w < T::zero()
    }

    /// The inward speed below which the contact is clipped.
    pub fn clipping_speed(&self) -> T {
        T::of(-1.0) / self.loss
    }

    /// Elastic energy over mass at a root of the depth.
    pub fn stored(&self, root: T) -> T {
        let square = root * root;
        self.stiffness * (square * square * root) * T::of(2.0) / T::of(5.0)
    }
}
