//! Motions with a closed form.
//!
//! They are computed in double-double arithmetic (some 31 digits) from the exact doubles that a model
//! holds, so that their rounding adds nothing to an error measured against them. Only those for a corner
//! are in doubles.

mod linear;

use std::f64::consts::{FRAC_PI_2, PI};

pub use linear::{Coupled, Forcing, Oscillator, State};

use crate::mechanics::{ForceCurve, Piece};
use crate::numeric::{DoubleDouble, Number, Scalar};

/// A double as a double-double.
pub(crate) fn dd(value: f64) -> DoubleDouble {
    Number::of(value)
}

/// e^x, to some 29 digits, for |x| below 700.
///
/// Reduced by ln 2 and halved eight times, then Taylor's series and eight squarings, which cost some
/// two digits.
pub fn exp(x: DoubleDouble) -> DoubleDouble {
    let ln_2 = dd(std::f64::consts::LN_2) + dd(2.319_046_813_846_299_6e-17);
    let halvings = (x / ln_2 + dd(0.5)).floor().to_f64();
    let small = (x - ln_2 * dd(halvings)) * dd(1.0 / 256.0);
    // Sum of small^i/i!, innermost factor first; small is below 1.4e-3.
    let mut sum = dd(1.0);
    for i in (1..=12).rev() {
        sum = dd(1.0) + small * sum / dd(f64::from(i));
    }
    for _ in 0..8 {
        sum = sum * sum;
    }
    // in two halves, since 2^halvings itself may be out of range
    let half = (halvings * 0.5).floor();
    sum * dd(half.exp2()) * dd((halvings - half).exp2())
}

/// (sin, cos) of an angle in radians, to some 30 digits of a turn.
pub fn sin_cos(angle: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    turns(angle / DoubleDouble::tau())
}

/// (sin, cos) of an angle in turns, which may be large.
pub(super) fn turns(turns: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    DoubleDouble::sin_cos_turns(turns - turns.floor())
}

/// The angle in turns, 0 to 1/4, whose sine is `sine`, 0 to 1. Newton's method from the double: near a
/// quarter turn the angle has half the digits of the sine.
pub fn sine_turns(sine: DoubleDouble) -> DoubleDouble {
    let one = dd(1.0);
    let cosine = ((one - sine) * (one + sine)).sqrt();
    let mut angle = dd(sine.to_f64().atan2(cosine.to_f64()));
    for _ in 0..3 {
        let (s, c) = sin_cos(angle);
        // the difference of two angles from the sine of it, which stays well conditioned near a quarter turn
        angle += sine * c - cosine * s;
    }
    angle / DoubleDouble::tau()
}

/// The complete elliptic integral K, given the complementary parameter 1 - k^2 above 0: pi over twice the
/// arithmetic-geometric mean of 1 and the root of it (Gauss).
pub fn elliptic_k(complement: DoubleDouble) -> DoubleDouble {
    let (mut a, mut b) = (dd(1.0), complement.sqrt());
    for _ in 0..12 {
        (a, b) = ((a + b) * dd(0.5), (a * b).sqrt());
    }
    DoubleDouble::tau() * dd(0.25) / a
}

/// Time in s of the first hit after a drop from `height` in m under `gravity` in m/s^2: sqrt(2 h/g).
pub fn first_hit(height: f64, gravity: f64) -> DoubleDouble {
    (dd(2.0) * dd(height) / dd(gravity)).sqrt()
}

/// Time of the `n`-th impact, from 1, of a dropped ball that first hits at `first`:
/// first (1 + 2 (e + e^2 + .. + e^(n-1))).
pub fn impact_time(first: DoubleDouble, restitution: f64, n: u32) -> DoubleDouble {
    let mut sum = DoubleDouble::zero();
    let mut power = dd(1.0);
    for _ in 1..n {
        power = power * dd(restitution);
        sum += power;
    }
    first * (dd(1.0) + sum + sum)
}

/// Time at which it rests, the sum of all flights: first (1 + e)/(1 - e).
pub fn rest_time(first: DoubleDouble, restitution: f64) -> DoubleDouble {
    first * (dd(1.0) + dd(restitution)) / (dd(1.0) - dd(restitution))
}

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
