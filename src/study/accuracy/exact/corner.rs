//! A force of two straight lines with a corner between them.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::mechanics::{ForceCurve, Piece};

/// Slope 1 N/m to the left of the corner, another to the right of it; force 0 at x = 0. For a mass of 1 kg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Place of the corner in m, above 0 and below 1.
    pub at: f64,
    /// Slope to the right of it in N/m, above 0.
    pub outer: f64,
}

impl Corner {
    /// The force curve, known from -5 to 5 m. The origins of its two pieces are off the break, so that the
    /// two sides of it differ in rounding.
    pub fn curve(self) -> ForceCurve {
        let Self { at, outer } = self;
        let inner = Piece { origin: -0.1, coefficients: vec![-0.1, 1.0], potential_at_origin: 0.0 };
        let far = at + 0.7;
        let coefficients = vec![at + outer * (far - at), outer];
        let right = Piece { origin: far, coefficients, potential_at_origin: 0.0 };
        ForceCurve::from_pieces(vec![inner, right], vec![at], (-5.0, 5.0), false, None)
    }

    /// Time in s from the corner with speed `v` in m/s to the right and back to the corner: y'' = -at - outer
    /// y from y = 0.
    pub fn time_beyond(self, v: f64) -> f64 {
        let w = self.outer.sqrt();
        2.0 * (FRAC_PI_2 - (self.at / self.outer * w / v).atan()) / w
    }

    /// Period in s of the orbit that passes x = 0 with speed `v` in m/s, above `at`/s: half a turn to the
    /// left of 0, twice the way from 0 to the corner, and the time beyond it.
    pub fn period(self, v: f64) -> f64 {
        PI + 2.0 * (self.at / v).asin() + self.time_beyond((v * v - self.at * self.at).sqrt())
    }

    /// The largest force in N on that orbit, at its right turn: outer y = force - at, v^2 = at^2 + 2 at y +
    /// outer y^2.
    pub fn largest_force(self, v: f64) -> f64 {
        (self.at * self.at + self.outer * (v * v - self.at * self.at)).sqrt()
    }
}
