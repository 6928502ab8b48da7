//! Derivatives of a state with respect to an earlier one, and their eigenvalues.

/// Derivatives of displacement and velocity (rows) with respect to displacement and velocity at an earlier
/// time (columns), in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jacobian {
    /// By rows: the unit of the second column is s, that of the second row 1/s.
    pub rows: [[f64; 2]; 2],
}

/// A complex number.
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
        self.re.hypot(self.im)
    }
}

impl Jacobian {
    /// The identity.
    pub const IDENTITY: Self = Self { rows: [[1.0, 0.0], [0.0, 1.0]] };

    /// Determinant.
    pub fn determinant(&self) -> f64 {
        let [[a, b], [c, d]] = self.rows;
        a * d - b * c
    }

    /// Trace.
    pub fn trace(&self) -> f64 {
        self.rows[0][0] + self.rows[1][1]
    }

    /// The chain rule: these derivatives, of the later part of a motion, times those of the `earlier` part.
    #[must_use]
    pub fn after(&self, earlier: &Self) -> Self {
        let (later, other) = (&self.rows, &earlier.rows);
        let entry = |i: usize, j: usize| later[i][0] * other[0][j] + later[i][1] * other[1][j];
        Self { rows: [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]] }
    }

    /// The derivatives of the mirrored state.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self { rows: self.rows.map(|row| row.map(|entry| -entry)) }
    }

    /// Eigenvalues, the one of larger magnitude first; of a conjugate pair first the one above the real axis.
    /// The smaller real one is `determinant` over the larger: since the determinant is known separately, it
    /// keeps its digits however small it is.
    pub fn multipliers(&self, determinant: f64) -> [Multiplier; 2] {
        let half = 0.5 * self.trace();
        // (a - d)^2 / 4 + b c loses no digits where the eigenvalues are close
        let [[a, b], [c, d]] = self.rows;
        let discriminant = 0.25 * (a - d) * (a - d) + b * c;
        if discriminant < 0.0 {
            let im = (-discriminant).sqrt();
            return [Multiplier { re: half, im }, Multiplier { re: half, im: -im }];
        }
        let larger = half + discriminant.sqrt().copysign(half);
        let smaller = if larger == 0.0 { 0.0 } else { determinant / larger };
        [Multiplier { re: larger, im: 0.0 }, Multiplier { re: smaller, im: 0.0 }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn real_and_complex_eigenvalues() {
        let real = Jacobian { rows: [[2.0, 1.0], [1.0, 2.0]] };
        let parts = |jacobian: &Jacobian| {
            jacobian.multipliers(jacobian.determinant()).map(|multiplier| (multiplier.re, multiplier.im))
        };
        assert_eq!(parts(&real), [(3.0, 0.0), (1.0, 0.0)]);
        let turned = Jacobian { rows: [[0.0, -0.5], [0.5, 0.0]] };
        assert_eq!(parts(&turned), [(0.0, 0.5), (0.0, -0.5)]);
        assert!((turned.multipliers(0.25)[0].magnitude() - 0.5).abs() < 1e-15);
        let nothing = Jacobian { rows: [[0.0, 0.0], [0.0, 0.0]] };
        assert!(nothing.multipliers(0.0).iter().all(|multiplier| multiplier.magnitude() == 0.0));
        let twice = real.after(&turned);
        assert_eq!(twice.rows, [[0.5, -1.0], [1.0, -0.5]]);
        let stiff = Jacobian { rows: [[-1e9, 0.0], [1e9, -1e-12]] };
        assert_eq!(stiff.multipliers(1e-3).map(|multiplier| multiplier.re), [-1e9, -1e-12]);
    }
}
