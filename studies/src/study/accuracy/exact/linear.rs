//! Linear systems in closed form: a damped oscillator under a sum of forcings, and one with a circuit.

use std::array::from_fn;

use super::{dd, turns};
use crate::numeric::{DoubleDouble, Number, Scalar};

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
    /// (amplitude + growth t) sin(2 pi (frequency t + phase)); growth in m/s^3, frequency in Hz, phase
    /// in turns.
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

/// The exponential of `rates` times `t`, by scaling and squaring of its Taylor series; each squaring may cost
/// a bit.
fn exponential<const N: usize>(rates: Matrix<N>, t: DoubleDouble) -> Matrix<N> {
    let sizes = rates.map(|row| row.iter().map(|rate| (*rate * t).abs().to_f64()).sum::<f64>());
    let largest = sizes.into_iter().fold(0.0, f64::max);
    // below 1/16, where 18 terms leave 1e-38
    let squarings = (largest * 16.0).log2().ceil().max(0.0);
    let small = rates.map(|row| row.map(|rate| rate * t * dd((-squarings).exp2())));
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
