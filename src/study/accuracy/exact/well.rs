//! The free unit double well: m = 1 kg, F = x^3 - x, wells at +-1 m, barrier 1/4 J.

use super::dd;
use super::elementary::elliptic_k;
use crate::numeric::{DoubleDouble, Scalar};

/// An orbit of the unit double well that is released at rest at `x0` in m, 1 < x0, x0 not the separatrix's
/// sqrt 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitWell {
    /// Where it is released.
    pub x0: f64,
}

impl UnitWell {
    /// Potential in J at `x` in m.
    pub fn potential(x: f64) -> f64 {
        x * x * (0.25 * x * x - 0.5)
    }

    /// Period in s. Within a well, x0 < sqrt 2: 2 K(k) sqrt 2/x0 with 1 - k^2 = (2 - x0^2)/x0^2; around both
    /// 4 K(k)/sqrt(x0^2 - 1) with 1 - k^2 = (x0^2 - 2)/(2 (x0^2 - 1)).
    pub fn period(self) -> DoubleDouble {
        period(dd(self.x0))
    }

    /// |dT/dE| in s/J, T the period and E the energy: by central differences a thousandth of the distance
    /// from the separatrix wide, good to six digits.
    pub fn period_slope(self) -> f64 {
        let x0 = dd(self.x0);
        let step = (x0 - dd(2.0).sqrt()) * dd(1e-3);
        let slope = (period(x0 + step) - period(x0 - step)) / (step + step);
        (slope.to_f64() / self.force()).abs()
    }

    /// Force in N at the release.
    pub fn force(self) -> f64 {
        self.x0 * (self.x0 * self.x0 - 1.0)
    }

    /// Energy above the barrier in J: positive for an orbit around both wells.
    pub fn above_barrier(self) -> f64 {
        let square = dd(self.x0) * dd(self.x0);
        (square * (square - dd(2.0))).to_f64() * 0.25
    }
}

fn period(x0: DoubleDouble) -> DoubleDouble {
    let square = x0 * x0;
    let (one, two) = (dd(1.0), dd(2.0));
    if square < two {
        dd(2.0) * elliptic_k((two - square) / square) * two.sqrt() / x0
    } else {
        dd(4.0) * elliptic_k((square - two) / (two * (square - one))) / (square - one).sqrt()
    }
}
