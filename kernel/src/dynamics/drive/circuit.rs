//! Circuit of a transducer that has a state of its own, in kernel units.
//!
//! The state w of the circuit (a current or a voltage) is scaled so that w^2/2 is its energy over the mass.
//! It then has the unit of a velocity, and the coupling is the same in both directions:
//!
//! ```text
//! x'' = .. - g w,    w' = g x' - d w.
//! ```
//!
//! Its Taylor coefficients follow from those of the motion by one product and one sum each.

use crate::dynamics::series::ROOM;
use crate::numeric::Scalar;

#[derive(Debug, Clone)]
pub(crate) struct Circuit<T> {
    /// g.
    pub coupling: T,
    /// d.
    pub decay: T,
    /// d/k, by which coefficient k follows from the one before.
    pub rates: [T; ROOM],
    /// Magnitude of the state to which the tolerance is relative.
    pub scale: T,
}

impl<T: Scalar> Circuit<T> {
    pub fn new(coupling: T, decay: T, scale: T) -> Self {
        let mut rates = [T::zero(); ROOM];
        for (k, rate) in rates.iter_mut().enumerate().skip(1) {
            *rate = decay / T::whole(k);
        }
        Self { coupling, decay, rates, scale }
    }

    /// The acceleration that the state `w` takes from a mass held in place, and its first two derivatives.
    pub fn push(&self, w: T) -> [T; 3] {
        let push = self.coupling * w;
        let falling = -(self.decay * push);
        [push, falling, -(self.decay * falling)]
    }
}
