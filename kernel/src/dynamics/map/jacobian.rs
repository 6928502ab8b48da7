//! Derivatives of a state with respect to an earlier one, and their eigenvalues.

use nalgebra::{Matrix3, Vector3};

use crate::numeric::elementary;

/// Derivatives of a state (rows) with respect to the state at an earlier time (columns), in SI. A state is
/// displacement and velocity, and beside a circuit the current in A or the voltage in V as a third number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jacobian {
    /// By rows; without a circuit the third row and column are 0.
    rows: [[f64; 3]; 3],
    has_circuit: bool,
}

/// An eigenvalue of a [`Jacobian`]: over a period of a motion, a Floquet multiplier, the factor by which a
/// small change of the state grows. The motion is stable if all have a magnitude below 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Multiplier {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Multiplier {
    /// Magnitude.
    pub fn magnitude(self) -> f64 {
        elementary::hypot(self.re, self.im)
    }
}

impl Jacobian {
    /// The derivatives of displacement and velocity without a circuit.
    pub fn mechanical([[a, b], [c, d]]: [[f64; 2]; 2]) -> Self {
        Self { rows: [[a, b, 0.0], [c, d, 0.0], [0.0; 3]], has_circuit: false }
    }

    /// The derivatives of displacement, velocity and the state of a circuit.
    pub fn with_circuit(rows: [[f64; 3]; 3]) -> Self {
        Self { rows, has_circuit: true }
    }

    /// The identity, with or without a circuit.
    pub fn identity(has_circuit: bool) -> Self {
        let delta = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        let size = if has_circuit { 3 } else { 2 };
        let entry = |i: usize, j: usize| if i < size { delta(i, j) } else { 0.0 };
        Self { rows: std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))), has_circuit }
    }

    /// Number of rows and columns: 2, or 3 beside a circuit.
    pub fn size(&self) -> usize {
        if self.has_circuit { 3 } else { 2 }
    }

    /// By rows; without a circuit the third row and column are 0.
    pub fn rows(&self) -> &[[f64; 3]; 3] {
        &self.rows
    }

    /// The derivatives of displacement and velocity with respect to displacement and velocity: the unit of
    /// the second column is s, that of the second row 1/s.
    pub fn of_motion(&self) -> [[f64; 2]; 2] {
        let [[a, b, _], [c, d, _], _] = self.rows;
        [[a, b], [c, d]]
    }

    /// The same derivatives with the unit of each number multiplied by a factor.
    #[must_use]
    pub fn in_units(&self, units: [f64; 3]) -> Self {
        let entry = |i: usize, j: usize| match i == j {
            true => self.rows[i][j],
            false => self.rows[i][j] * units[j] / units[i],
        };
        let rows = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
        Self { rows, ..*self }
    }

    /// Whether all derivatives are finite.
    pub fn is_finite(&self) -> bool {
        self.rows.as_flattened().iter().all(|entry| entry.is_finite())
    }

    /// Whether the later state does not depend on the earlier one.
    pub fn is_zero(&self) -> bool {
        self.rows.as_flattened().iter().all(|entry| *entry == 0.0)
    }

    /// Determinant.
    pub fn determinant(&self) -> f64 {
        let [[a, b, p], [c, d, q], [r, s, t]] = self.rows;
        let of_motion = a * d - b * c;
        match self.has_circuit {
            true => p * (c * s - d * r) + q * (b * r - a * s) + t * of_motion,
            false => of_motion,
        }
    }

    /// The largest of the products of which the determinant is the sum, without their signs; for two rows,
    /// the sum of both.
    pub fn products(&self) -> f64 {
        let [[a, b, p], [c, d, q], [r, s, t]] = self.rows.map(|row| row.map(f64::abs));
        let of_motion = a * d + b * c;
        match self.has_circuit {
            true => p * (c * s + d * r) + q * (b * r + a * s) + t * of_motion,
            false => of_motion,
        }
    }

    /// Trace.
    pub fn trace(&self) -> f64 {
        self.rows[0][0] + self.rows[1][1] + self.rows[2][2]
    }

    /// The value at `unit`, which is 1 or -1, of the characteristic polynomial, up to its sign: 0 where that
    /// is an eigenvalue.
    pub fn characteristic(&self, unit: f64, determinant: f64) -> f64 {
        if !self.has_circuit {
            return 1.0 - unit * self.trace() + determinant;
        }
        let [[a, b, p], [c, d, q], [r, s, t]] = self.rows;
        let minors = (a * d - b * c) + (a * t - p * r) + (d * t - q * s);
        1.0 - unit * self.trace() + minors - unit * determinant
    }

    /// The chain rule: these derivatives, of the later part of a motion, times those of the `earlier` part.
    #[must_use]
    pub fn after(&self, earlier: &Self) -> Self {
        let (later, other) = (&self.rows, &earlier.rows);
        let of_motion = |i: usize, j: usize| later[i][0] * other[0][j] + later[i][1] * other[1][j];
        let entry = |i: usize, j: usize| match self.has_circuit {
            true => of_motion(i, j) + later[i][2] * other[2][j],
            false => of_motion(i, j),
        };
        Self { rows: std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))), ..*self }
    }

    /// The derivatives of the mirrored state.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self { rows: self.rows.map(|row| row.map(|entry| 0.0 - entry)), ..*self }
    }

    /// The step of Newton's method to a fixed point of a map with these derivatives, which is `off` at
    /// present: (1 - J) step = off. `None` where the matrix is singular.
    #[doc(hidden)]
    pub fn newton_step(&self, off: [f64; 3]) -> Option<[f64; 3]> {
        if self.has_circuit {
            let entry = |i: usize, j: usize| if i == j { 1.0 - self.rows[i][j] } else { -self.rows[i][j] };
            return Matrix3::from_fn(entry).lu().solve(&Vector3::from(off)).map(Into::into);
        }
        let [[a, b], [c, d]] = self.of_motion();
        let determinant = (1.0 - a) * (1.0 - d) - b * c;
        let (x, v) = ((1.0 - d) * off[0] + b * off[1], c * off[0] + (1.0 - a) * off[1]);
        Some([x / determinant, v / determinant, 0.0])
    }

    /// Eigenvalues, as many as rows, by falling magnitude; of a conjugate pair first the one above the real
    /// axis. The smallest follows from the `determinant` and the others: since the determinant is known
    /// separately, it keeps its digits however small it is.
    pub fn multipliers(&self, determinant: f64) -> Vec<Multiplier> {
        if self.has_circuit {
            return self.three_multipliers(determinant);
        }
        let half = 0.5 * self.trace();
        // (a - d)^2 / 4 + b c loses no digits where the eigenvalues are close
        let [[a, b], [c, d]] = self.of_motion();
        let discriminant = 0.25 * (a - d) * (a - d) + b * c;
        if discriminant < 0.0 {
            let im = (-discriminant).sqrt();
            return vec![Multiplier { re: half, im }, Multiplier { re: half, im: -im }];
        }
        let larger = half + discriminant.sqrt().copysign(half);
        let smaller = if larger == 0.0 { 0.0 } else { determinant / larger };
        vec![Multiplier { re: larger, im: 0.0 }, Multiplier { re: smaller, im: 0.0 }]
    }

    /// The same for three rows, by the Schur form of the balanced matrix (Parlett and Reinsch 1969).
    fn three_multipliers(&self, determinant: f64) -> Vec<Multiplier> {
        if !self.is_finite() {
            return vec![Multiplier { re: f64::NAN, im: f64::NAN }; 3];
        }
        let values = Matrix3::from_fn(|i, j| self.balanced().rows[i][j]).complex_eigenvalues();
        let mut all: Vec<_> = values.iter().map(|value| Multiplier { re: value.re, im: value.im }).collect();
        all.sort_by(|a, b| b.magnitude().total_cmp(&a.magnitude()).then(b.im.total_cmp(&a.im)));
        let others = all[0].magnitude() * all[1].magnitude();
        if all[2].im == 0.0 {
            let sign = if all[0].im == 0.0 { (all[0].re * all[1].re).signum() } else { 1.0 };
            all[2].re = if others == 0.0 { 0.0 } else { sign * (determinant / others) };
        } else if all[0].re != 0.0 && determinant / all[0].re > 0.0 {
            let change = (determinant / all[0].re).sqrt() / all[1].magnitude();
            for multiplier in &mut all[1..] {
                (multiplier.re, multiplier.im) = (multiplier.re * change, multiplier.im * change);
            }
        }
        all.sort_by(|a, b| b.magnitude().total_cmp(&a.magnitude()).then(b.im.total_cmp(&a.im)));
        all
    }

    /// A similar matrix whose rows and columns have about the same size; the factors are powers of two.
    fn balanced(&self) -> Self {
        let mut balanced = *self;
        for _ in 0..BALANCINGS {
            for k in 0..3 {
                let size = |entry: &dyn Fn(usize) -> f64| {
                    (0..3).filter(|i| *i != k).map(|i| entry(i).abs()).fold(0.0, f64::max)
                };
                let (row, column) = (size(&|i| balanced.rows[k][i]), size(&|i| balanced.rows[i][k]));
                if row > 0.0 && column > 0.0 {
                    let mut units = [1.0; 3];
                    units[k] =
                        elementary::exp2((0.5 * elementary::log2(row / column)).round().clamp(-500.0, 500.0));
                    balanced = balanced.in_units(units);
                }
            }
        }
        balanced
    }
}

/// Number of passes over the rows by which a matrix is balanced.
const BALANCINGS: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random;

    #[test]
    fn real_and_complex_eigenvalues() {
        let real = Jacobian::mechanical([[2.0, 1.0], [1.0, 2.0]]);
        let parts = |jacobian: &Jacobian| -> Vec<(f64, f64)> {
            let all = jacobian.multipliers(jacobian.determinant());
            all.iter().map(|multiplier| (multiplier.re, multiplier.im)).collect()
        };
        assert_eq!(parts(&real), [(3.0, 0.0), (1.0, 0.0)]);
        let turned = Jacobian::mechanical([[0.0, -0.5], [0.5, 0.0]]);
        assert_eq!(parts(&turned), [(0.0, 0.5), (0.0, -0.5)]);
        assert!((turned.multipliers(0.25)[0].magnitude() - 0.5).abs() < 1e-15);
        let nothing = Jacobian::mechanical([[0.0, 0.0], [0.0, 0.0]]);
        assert!(nothing.multipliers(0.0).iter().all(|multiplier| multiplier.magnitude() == 0.0));
        let twice = real.after(&turned);
        assert_eq!(twice.of_motion(), [[0.5, -1.0], [1.0, -0.5]]);
        let stiff = Jacobian::mechanical([[-1e9, 0.0], [1e9, -1e-12]]);
        let parts: Vec<f64> = stiff.multipliers(1e-3).iter().map(|multiplier| multiplier.re).collect();
        assert_eq!(parts, [-1e9, -1e-12]);
    }

    /// The eigenvalues of a similar matrix of any scale: three real ones, or a real one and a pair.
    #[test]
    fn three_eigenvalues() {
        let mut random = random();
        for _ in 0..400 {
            let (l, re, im) = (2.0 * random() - 1.0, 2.0 * random() - 1.0, 2.0 * random() - 1.0);
            let pair = random() < 0.5;
            let block = if pair { [re, im, -im, re] } else { [re, 0.0, 0.0, im] };
            let known = Matrix3::new(l, 0.0, 0.0, 0.0, block[0], block[1], 0.0, block[2], block[3]);
            let basis = Matrix3::from_fn(|i, j| if i == j { 1.0 } else { 0.6 * random() - 0.3 });
            let matrix = basis * known * basis.try_inverse().unwrap();
            let units = [1.0, 10_f64.powf(6.0 * random()), 10_f64.powf(-6.0 * random())];
            let rows = std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]));
            let jacobian = Jacobian::with_circuit(rows).in_units(units);
            let determinant = l * (block[0] * block[3] - block[1] * block[2]);
            assert!((jacobian.determinant() - determinant).abs() < 1e-12);
            let all = jacobian.multipliers(determinant);
            let is_there =
                |re: f64, im: f64| all.iter().any(|found| (found.re - re).hypot(found.im - im) < 1e-10);
            let there = match pair {
                true => is_there(l, 0.0) && is_there(re, im) && is_there(re, -im),
                false => is_there(l, 0.0) && is_there(re, 0.0) && is_there(im, 0.0),
            };
            assert!(there, "{all:?} {l} {re} {im} {pair}");
            for (value, unit) in [(1.0 - l, 1.0), (1.0 + l, -1.0)] {
                let others = if pair { (re - unit).powi(2) + im * im } else { (re - unit) * (im - unit) };
                let characteristic = jacobian.characteristic(unit, determinant);
                assert!((characteristic - value * others).abs() < 1e-10, "{characteristic}");
            }
        }
    }
}
