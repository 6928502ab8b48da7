//! Motions with a closed form.
//!
//! They are computed in double-double arithmetic (some 31 digits) from the exact doubles that a model
//! holds, so that their rounding adds nothing to an error measured against them. Only those for a corner
//! are in doubles.

use std::array::from_fn;
use std::f64::consts::{FRAC_PI_2, PI};

use crate::mechanics::{ForceCurve, Piece};
use crate::numeric::{DoubleDouble, Number, Scalar, elementary};

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
    sum * dd(elementary::exp2(half)) * dd(elementary::exp2(halvings - half))
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
    let mut angle = dd(elementary::atan2(sine.to_f64(), cosine.to_f64()));
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

/// An orbit of the unit double well that is released at rest at `x0` in m, above 1 and not sqrt 2.
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
            .expect("two pieces have one break")
    }

    /// Time in s from the corner with speed `v` in m/s to the right and back to it: y'' = -at - outer y.
    pub fn time_beyond(self, v: f64) -> f64 {
        let w = self.outer.sqrt();
        2.0 * (FRAC_PI_2 - elementary::atan(self.at / self.outer * w / v)) / w
    }

    /// Period in s of the orbit that passes x = 0 with speed `v` in m/s, above `at`/s: half a turn to the
    /// left of 0, twice the way from 0 to the corner, and the time beyond it.
    pub fn period(self, v: f64) -> f64 {
        PI + 2.0 * elementary::asin(self.at / v) + self.time_beyond((v * v - self.at * self.at).sqrt())
    }

    /// The largest force in N on that orbit, at its right turn: v^2 = at^2 + 2 at y + outer y^2.
    pub fn largest_force(self, v: f64) -> f64 {
        (self.at * self.at + self.outer * (v * v - self.at * self.at)).sqrt()
    }
}

/// x'' + g x' + k x = -a(t).
#[derive(Debug, Clone, Copy)]
pub struct Oscillator {
    /// g = c/m in 1/s.
    damping: DoubleDouble,
    /// k = stiffness over mass in 1/s^2, above 0.
    stiffness: DoubleDouble,
}

/// A base acceleration with a closed form. SI; time is that of the run.
#[derive(Debug, Clone, Copy)]
pub enum Forcing {
    /// (amplitude + growth t) sin(2 pi (frequency t + phase)).
    Tone {
        /// Amplitude at time 0 in m/s^2.
        amplitude: f64,
        /// Growth of the amplitude in m/s^3.
        growth: DoubleDouble,
        /// Frequency in Hz.
        frequency: f64,
        /// Phase in turns.
        phase: f64,
    },
    /// value + slope t.
    Line {
        /// Value at time 0 in m/s^2.
        value: DoubleDouble,
        /// Slope in m/s^3.
        slope: DoubleDouble,
    },
}

type Complex = (DoubleDouble, DoubleDouble);

/// Displacement and velocity in m and m/s.
pub type State = (DoubleDouble, DoubleDouble);

impl Oscillator {
    /// `mass` in kg, `damping` c in N s/m, `stiffness` in N/m above 0.
    pub fn new(mass: f64, damping: f64, stiffness: f64) -> Self {
        Self { damping: dd(damping) / dd(mass), stiffness: dd(stiffness) / dd(mass) }
    }

    /// The particular solution under one forcing at time `t` of the run.
    ///
    /// Under (a + r t) sin(w t + phase) it is the imaginary part of (P + Q t) exp(i (w t + phase)), with Q L
    /// = -r, P L + Q L' = -a, L = k - w^2 + i g w, L' = g + 2 i w.
    fn driven(&self, forcing: &Forcing, t: DoubleDouble) -> State {
        match *forcing {
            Forcing::Line { value, slope } => {
                let beta = -(slope / self.stiffness);
                let alpha = (-value - self.damping * beta) / self.stiffness;
                (alpha + beta * t, beta)
            }
            Forcing::Tone { amplitude, growth, frequency, phase } => {
                let zero = DoubleDouble::zero();
                let w = DoubleDouble::tau() * dd(frequency);
                let l = (self.stiffness - w * w, self.damping * w);
                let q = divide((-growth, zero), l);
                let ql = multiply(q, (self.damping, w + w));
                let p = divide((-dd(amplitude) - ql.0, -ql.1), l);
                let z = (p.0 + q.0 * t, p.1 + q.1 * t);
                let (sin, cos) = turns(dd(frequency) * t + dd(phase));
                let value = z.0 * sin + z.1 * cos;
                let slope = q.0 * sin + q.1 * cos + w * (z.0 * cos - z.1 * sin);
                (value, slope)
            }
        }
    }

    /// The state at time `t` of a motion that is at `start` at `from`, under the sum of forcings.
    pub fn state(&self, start: State, from: DoubleDouble, t: DoubleDouble, forcings: &[Forcing]) -> State {
        let sum = |at: DoubleDouble| {
            forcings.iter().fold((dd(0.0), dd(0.0)), |sum, forcing| {
                let part = self.driven(forcing, at);
                (sum.0 + part.0, sum.1 + part.1)
            })
        };
        let (at_start, now) = (sum(from), sum(t));
        let (x, v) = (start.0 - at_start.0, start.1 - at_start.1);
        let rates = [[dd(0.0), dd(1.0)], [-self.stiffness, -self.damping]];
        let [of_x, of_v] = exponential(rates, t - from).map(|row| row[0] * x + row[1] * v);
        (of_x + now.0, of_v + now.1)
    }

    /// The same from doubles, rounded to doubles.
    pub fn nearest(&self, start: (f64, f64), from: f64, t: f64, forcings: &[Forcing]) -> (f64, f64) {
        let state = self.state((dd(start.0), dd(start.1)), dd(from), dd(t), forcings);
        (state.0.to_f64(), state.1.to_f64())
    }
}

fn multiply(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn divide(a: Complex, b: Complex) -> Complex {
    let size = b.0 * b.0 + b.1 * b.1;
    let z = multiply(a, (b.0, -b.1));
    (z.0 / size, z.1 / size)
}

/// m x'' + c x' + k x + f + K s = -m A sin(2 pi (frequency t + phase)) and S s' + r s = K x', whose state s
/// is a current or a voltage. SI.
#[derive(Debug, Clone, Copy)]
pub struct Coupled {
    /// Mass m in kg.
    pub mass: f64,
    /// Damping c in N s/m.
    pub damping: f64,
    /// Stiffness k in N/m; it may be 0.
    pub stiffness: f64,
    /// Force f in N at x = 0.
    pub force: f64,
    /// Coupling K in N/A or N/V.
    pub coupling: f64,
    /// Inductance or capacitance S in H or F.
    pub storage: DoubleDouble,
    /// Resistance or conductance r in ohm or S.
    pub loss: DoubleDouble,
    /// Amplitude A in m/s^2, frequency in Hz and phase in turns.
    pub tone: (f64, f64, f64),
}

type Matrix<const N: usize> = [[DoubleDouble; N]; N];

impl Coupled {
    /// The electrical state whose energy is that of the mass at 1 m/s.
    pub fn amount(&self) -> DoubleDouble {
        (dd(self.mass) / self.storage).sqrt()
    }

    /// Rate of the coupling K/sqrt(m S) and of the decay r/S in 1/s.
    pub fn rates(&self) -> (DoubleDouble, DoubleDouble) {
        (dd(self.coupling) * self.amount() / dd(self.mass), self.loss / self.storage)
    }

    /// Displacement, velocity and electrical state in m, m/s, and A or V at time `t` of a motion that is at
    /// `start` at `from`, both in s: sine and cosine of the tone and 1 are states too, so that it is the
    /// exponential of a matrix.
    pub fn state(&self, start: [DoubleDouble; 3], from: DoubleDouble, t: DoubleDouble) -> [DoubleDouble; 3] {
        let (amplitude, frequency, phase) = self.tone;
        let (coupling, decay) = self.rates();
        // of displacement, velocity, the state as a velocity, sine and cosine of the tone, and 1
        let [mut x, mut v, mut w, mut sine, mut cosine, one] = [[DoubleDouble::zero(); 6]; 6];
        x[1] = dd(1.0);
        let per_mass = [self.stiffness, self.damping].map(|coefficient| -(dd(coefficient) / dd(self.mass)));
        [v[0], v[1], v[2], v[3]] = [per_mass[0], per_mass[1], -coupling, -dd(amplitude)];
        v[5] = -(dd(self.force) / dd(self.mass));
        [w[1], w[2]] = [coupling, -decay];
        sine[4] = DoubleDouble::tau() * dd(frequency);
        cosine[3] = -sine[4];
        let flow = exponential([x, v, w, sine, cosine, one], t - from);
        let (sin, cos) = turns(dd(frequency) * from + dd(phase));
        let before = [start[0], start[1], start[2] / self.amount(), sin, cos, dd(1.0)];
        let after = |row: usize| {
            flow[row].iter().zip(before).fold(DoubleDouble::zero(), |sum, (entry, part)| sum + *entry * part)
        };
        [after(0), after(1), after(2) * self.amount()]
    }
}

/// The exponential of `rates` times `t`, by scaling and squaring of its series; a squaring may cost a bit.
fn exponential<const N: usize>(rates: Matrix<N>, t: DoubleDouble) -> Matrix<N> {
    let sizes = rates.map(|row| row.iter().map(|rate| (*rate * t).abs().to_f64()).sum::<f64>());
    let largest = sizes.into_iter().fold(0.0, f64::max);
    // below 1/16, where 18 terms leave 1e-38
    let squarings = elementary::log2(largest * 16.0).ceil().max(0.0);
    let small = rates.map(|row| row.map(|rate| rate * t * dd(elementary::exp2(-squarings))));
    let unit = |i, j| dd(if i == j { 1.0 } else { 0.0 });
    let mut sum = from_fn(|i| from_fn(|j| unit(i, j)));
    for order in (1..=18).rev() {
        let terms = product(&small, &sum);
        sum = from_fn(|i| from_fn(|j| unit(i, j) + terms[i][j] / dd(f64::from(order))));
    }
    (0..squarings as u32).fold(sum, |power, _| product(&power, &power))
}

fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    let entry = |i: usize, j: usize| (0..N).fold(DoubleDouble::zero(), |sum, k| sum + a[i][k] * b[k][j]);
    from_fn(|i| from_fn(|j| entry(i, j)))
}
