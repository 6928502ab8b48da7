//! A linear oscillator with a circuit, under a constant force and a sine.

use super::dd;
use super::elementary::turns;
use crate::numeric::{DoubleDouble, Number, Scalar};

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

/// Displacement, velocity and electrical state in m, m/s, and A or V.
type State = [DoubleDouble; 3];

/// Displacement, velocity, the state as a velocity, sine and cosine of the tone, and 1.
const N: usize = 6;

type Matrix = [[DoubleDouble; N]; N];

impl Coupled {
    /// The electrical state whose energy is that of the mass at 1 m/s.
    pub fn amount(&self) -> DoubleDouble {
        (dd(self.mass) / self.storage).sqrt()
    }

    /// Rate of the coupling K/sqrt(m S) and of the decay r/S in 1/s.
    pub fn rates(&self) -> (DoubleDouble, DoubleDouble) {
        (dd(self.coupling) * self.amount() / dd(self.mass), self.loss / self.storage)
    }

    /// The state at time `t` of a motion that is at `start` at `from`, both in s: sine and cosine of the tone
    /// and 1 are states too, so that it is the exponential of a matrix.
    pub fn state(&self, start: State, from: DoubleDouble, t: DoubleDouble) -> State {
        let (amplitude, frequency, phase) = self.tone;
        let (coupling, decay) = self.rates();
        let [mut x, mut v, mut w, mut sine, mut cosine] = [[DoubleDouble::zero(); N]; N - 1];
        x[1] = dd(1.0);
        let per_mass = [self.stiffness, self.damping].map(|coefficient| -(dd(coefficient) / dd(self.mass)));
        [v[0], v[1], v[2], v[3]] = [per_mass[0], per_mass[1], -coupling, -dd(amplitude)];
        v[5] = -(dd(self.force) / dd(self.mass));
        [w[1], w[2]] = [coupling, -decay];
        sine[4] = DoubleDouble::tau() * dd(frequency);
        cosine[3] = -sine[4];
        let flow = exponential([x, v, w, sine, cosine, [DoubleDouble::zero(); N]], t - from);
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
fn exponential(rates: Matrix, t: DoubleDouble) -> Matrix {
    let sizes = rates.map(|row| row.iter().map(|rate| (*rate * t).abs().to_f64()).sum::<f64>());
    let largest = sizes.into_iter().fold(0.0, f64::max);
    // below 1/16, where 18 terms leave 1e-38
    let squarings = (largest * 16.0).log2().ceil().max(0.0);
    let small = rates.map(|row| row.map(|rate| rate * t * dd((-squarings).exp2())));
    let mut sum = unit();
    for i in (1..=18).rev() {
        let product = multiply(&small, &sum);
        sum = unit();
        for (row, terms) in sum.iter_mut().zip(product) {
            for (entry, part) in row.iter_mut().zip(terms) {
                *entry += part / dd(f64::from(i));
            }
        }
    }
    (0..squarings as u32).fold(sum, |power, _| multiply(&power, &power))
}

fn unit() -> Matrix {
    let entry = |same: bool| dd(if same { 1.0 } else { 0.0 });
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i == j)))
}

fn multiply(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| (0..N).fold(DoubleDouble::zero(), |sum, k| sum + a[i][k] * b[k][j]);
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

#[cfg(test)]
mod tests {
    use super::super::{Forcing, Oscillator};
    use super::*;

    /// 20 g on 50 N/m with 0.08 N s/m, shaken, with a circuit.
    fn coupled(coupling: f64, loss: f64) -> Coupled {
        let tone = (9.0, 7.0, 0.125);
        let (storage, loss) = (dd(0.5), dd(loss));
        Coupled { mass: 0.02, damping: 0.08, stiffness: 50.0, force: 0.0, coupling, storage, loss, tone }
    }

    fn apart(a: DoubleDouble, b: DoubleDouble) -> f64 {
        (a - b).abs().to_f64()
    }

    #[test]
    fn uncoupled_it_is_the_oscillator_and_a_decay() {
        let tone = Forcing::Tone { amplitude: 9.0, growth: dd(0.0), frequency: 7.0, phase: 0.125 };
        let oscillator = Oscillator::new(0.02, 0.08, 50.0);
        let start = [dd(0.002), dd(-0.1), dd(0.3)];
        for t in [0.3, 1.7, 20.0] {
            let (x, v) = oscillator.state((start[0], start[1]), dd(0.1), dd(t), &[tone]);
            let found = coupled(0.0, 4.0).state(start, dd(0.1), dd(t));
            let state = start[2] * super::super::exp(-(dd(8.0) * (dd(t) - dd(0.1))));
            let errors = [apart(found[0], x), apart(found[1], v), apart(found[2], state)];
            assert!(errors.iter().all(|error| *error < 1e-26), "{t}: {errors:?}");
        }
    }

    #[test]
    fn without_a_loss_it_is_a_spring() {
        // K^2/S is added to the stiffness; from x = 0 without a charge the state is K x/S
        let system = coupled(3.0, 0.0);
        let spring = Oscillator::new(0.02, 0.08, 50.0 + 18.0);
        let tone = Forcing::Tone { amplitude: 9.0, growth: dd(0.0), frequency: 7.0, phase: 0.125 };
        for t in [0.05, 1.0, 30.0] {
            let (x, v) = spring.state((dd(0.0), dd(0.4)), dd(0.0), dd(t), &[tone]);
            let found = system.state([dd(0.0), dd(0.4), dd(0.0)], dd(0.0), dd(t));
            let errors = [apart(found[0], x), apart(found[1], v), apart(found[2], dd(6.0) * x)];
            assert!(errors.iter().all(|error| *error < 1e-26), "{t}: {errors:?}");
        }
    }

    #[test]
    fn a_fast_circuit_keeps_the_digits() {
        // time constant 0.1 us; two successive spans must give the state of the whole
        let system = coupled(3.0, 5e6);
        let start = [dd(0.002), dd(-0.1), dd(0.3)];
        let whole = system.state(start, dd(0.0), dd(2.0));
        let parts = system.state(system.state(start, dd(0.0), dd(0.7)), dd(0.7), dd(2.0));
        for (whole, part) in whole.into_iter().zip(parts) {
            assert!(apart(whole, part) < 1e-22 * whole.abs().to_f64().max(1e-6), "{whole:?} {part:?}");
        }
    }
}
