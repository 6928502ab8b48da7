//! Geometrically exact beam (Reissner 1972, "On one-dimensional finite-strain beam theory: the plane
//! problem"), in weak form.
//!
//! With theta the rotation of the cross-section, (H, Q) the constant force on the cut (axial, lateral; H
//! positive in tension), N = H cos theta + Q sin theta, V = -H sin theta + Q cos theta, axial strain N/EA and
//! shear strain V/GA_s:
//!
//! ```text
//! EI (theta - theta_0)'' + V + kappa N V = 0,   kappa = 1/EA - 1/GA_s,   theta = 0 at both ends
//! y(L) = int sin theta + N/EA sin theta + V/GA_s cos theta = x
//! u    = int 1 - cos theta - N/EA cos theta + V/GA_s sin theta          (shortening)
//! ```
//!
//! All three are derivatives of one potential of theta, H and Q, so that the matrices below are symmetric and
//! shortening and deflection are far more accurate than theta itself.
//!
//! **The bump.** Split theta = even + odd about the middle. If the flexure has a bump, the odd part is
//! written as sqrt(q) psi with the leading coefficient of psi set to 1, and the odd equations are divided by
//! sqrt(q). Everything is then analytic in q, the square of the bump's amplitude, and regular where the bump
//! vanishes. With the coefficients themselves as unknowns the equations are singular there, with a second,
//! unstable solution close by.

use super::basis::Basis;
use crate::numeric::elementary;

/// One flexure of a group, in the scaled units of the mechanism.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Beam {
    /// Number of equal flexures.
    pub count: f64,
    pub length: f64,
    /// EI.
    pub bending: f64,
    /// 1/EA.
    pub stretch: f64,
    /// 1/GA_s.
    pub shear: f64,
    /// Coefficients of the rotation of the stress-free flexure; empty if it is straight.
    pub natural: Vec<f64>,
    /// Arc length of the stress-free flexure less the distance between its ends.
    pub natural_shortening: f64,
}

/// Form of the odd part of a flexure's rotation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// No odd part.
    Straight,
    /// A bump that may point to either side: sqrt(q) psi.
    Bump,
    /// A bump whose side is given by an initial bow: plain coefficients.
    Bowed,
}

/// The state of one flexure: coefficients of its rotation and the force on its cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rotation<'a> {
    pub shape: Shape,
    /// Coefficients of the even part.
    pub even: &'a [f64],
    /// Coefficients of psi for a bump, of the odd part itself for a bow; empty for a straight flexure.
    pub odd: &'a [f64],
    /// The square of the bump's amplitude; 1 for a bowed flexure.
    pub q: f64,
    /// Axial force H, positive in tension.
    pub axial: f64,
    /// Lateral force Q.
    pub lateral: f64,
}

/// The equations of one flexure and their derivatives. The odd rows are divided by sqrt(q).
#[derive(Debug, Clone, Default)]
pub(super) struct Terms {
    pub modes: usize,
    /// Even part of the residual of the moment equation.
    pub even: Vec<f64>,
    /// Odd part of that residual.
    pub odd: Vec<f64>,
    /// Derivatives of the even residual with respect to the even coefficients, row by row.
    pub even_even: Vec<f64>,
    /// Derivatives of the odd residual with respect to the odd coefficients, row by row.
    pub odd_odd: Vec<f64>,
    /// Derivatives of the odd residual (rows) with respect to the even coefficients (columns), row by row.
    pub odd_even: Vec<f64>,
    /// Derivatives of the even residual with respect to H, Q and q.
    pub even_by: [Vec<f64>; 3],
    /// Derivatives of the odd residual with respect to H, Q and q.
    pub odd_by: [Vec<f64>; 3],
    /// Deflection y(L).
    pub deflection: f64,
    /// Shortening u.
    pub shortening: f64,
    /// du/dH at fixed rotation (negative).
    pub shortening_by_axial: f64,
    /// du/dQ = -dy/dH at fixed rotation.
    pub shortening_by_lateral: f64,
    /// dy/dQ at fixed rotation.
    pub deflection_by_lateral: f64,
    /// Strain energy.
    pub energy: f64,
}

/// cos(sqrt(q) psi), sin(sqrt(q) psi)/sqrt(q) and its derivative with respect to q: analytic, also for q < 0.
fn odd_functions(q: f64, psi: f64) -> (f64, f64, f64) {
    let square = q * psi * psi;
    if square.abs() <= 1.0 {
        let (mut cosine, mut sine, mut by_q) = (0.0, 0.0, 0.0);
        // Terms (-square)^k/(2k)!; the last one is below 1/20!.
        let mut term = 1.0;
        for k in 0..11 {
            let k = f64::from(k);
            cosine += term;
            sine += term / (2.0 * k + 1.0);
            by_q -= term / (2.0 * (2.0 * k + 1.0) * (2.0 * k + 3.0));
            term *= -square / ((2.0 * k + 1.0) * (2.0 * k + 2.0));
        }
        (cosine, psi * sine, psi * psi * psi * by_q)
    } else if q > 0.0 {
        let root = q.sqrt();
        let (sine, cosine) = elementary::sin_cos(root * psi);
        (cosine, sine / root, (psi * cosine - sine / root) / (2.0 * q))
    } else {
        let root = (-q).sqrt();
        let (sine, cosine) = (elementary::sinh(root * psi), elementary::cosh(root * psi));
        (cosine, sine / root, (psi * cosine - sine / root) / (2.0 * q))
    }
}

impl Beam {
    /// Shortening of the straight group of equal flexures under unit compression of the group.
    pub fn compliance(&self) -> f64 {
        self.length * self.stretch / self.count
    }

    /// Evaluates the equations. Method: Gauss-Legendre quadrature of the products over one half.
    pub fn terms(&self, basis: &Basis, state: &Rotation) -> Terms {
        let n = basis.modes;
        let odd_modes = if state.shape == Shape::Straight { 0 } else { n };
        let kappa = self.stretch - self.shear;
        let (h, lateral, q) = (state.axial, state.lateral, state.q);
        let bend = self.bending * 2.0 / self.length;
        let mut t = Terms {
            modes: n,
            even: state.even.iter().map(|a| bend * a).collect(),
            odd: state.odd.iter().map(|a| bend * a).collect(),
            even_even: vec![0.0; n * n],
            odd_odd: vec![0.0; n * n],
            odd_even: vec![0.0; odd_modes * n],
            even_by: std::array::from_fn(|_| vec![0.0; n]),
            odd_by: std::array::from_fn(|_| vec![0.0; odd_modes]),
            ..Terms::default()
        };
        let mut bending_square: f64 = state.even.iter().map(|a| a * a).sum();
        if state.shape == Shape::Bowed {
            for ((residual, a), natural) in t.odd.iter_mut().zip(state.odd).zip(&self.natural) {
                *residual -= bend * natural;
                bending_square += (a - natural) * (a - natural);
            }
        } else {
            bending_square += q * state.odd.iter().map(|a| a * a).sum::<f64>();
        }
        t.energy = self.bending / self.length * bending_square
            + 0.25 * self.length * (h * h + lateral * lateral) * (self.stretch + self.shear);
        t.shortening = -0.5 * self.length * h * (self.stretch + self.shear) - self.natural_shortening;
        t.deflection = 0.5 * self.length * lateral * (self.stretch + self.shear);
        t.shortening_by_axial = -0.5 * self.length * (self.stretch + self.shear);
        t.deflection_by_lateral = -t.shortening_by_axial;
        for i in 0..n {
            t.even_even[i * n + i] = bend;
            t.odd_odd[i * n + i] = bend;
        }
        for (point, weight) in basis.weights.iter().enumerate() {
            let even = &basis.even[point * n..(point + 1) * n];
            let odd = &basis.odd[point * n..(point + 1) * n];
            let weight = weight * self.length;
            let angle = dot(even, state.even);
            let psi = if odd_modes > 0 { dot(odd, state.odd) } else { 0.0 };
            let (sine, cosine) = elementary::sin_cos(angle);
            let (c, s, s_by_q) = odd_functions(q, psi);
            let (cosine_2, sine_2) = (cosine * cosine - sine * sine, 2.0 * sine * cosine);
            // The cosine of the doubled odd part, and its sine over sqrt(q).
            let (c_2, s_2) = (1.0 - 2.0 * q * s * s, 2.0 * s * c);
            // N and V of the even part alone, and from them N^2 - V^2 and 2 N V.
            let normal = h * cosine + lateral * sine;
            let shear = -h * sine + lateral * cosine;
            let difference = normal * normal - shear * shear;
            let product = 2.0 * normal * shear;
            let even_load = c * shear + 0.5 * kappa * c_2 * product;
            let odd_load = -s * normal - 0.5 * kappa * s_2 * difference;
            let even_weight = c * normal + kappa * c_2 * difference;
            let odd_weight = s * shear + kappa * s_2 * product;
            // The shares of shortening and deflection from axial and shear strain depend on
            // the doubled angle.
            let along = 0.5 * (h * cosine_2 + lateral * sine_2);
            let across = 0.5 * (h * sine_2 - lateral * cosine_2);
            let half = odd_functions(q, 0.5 * psi).1;
            let half_sine = elementary::sin(0.5 * angle);
            let shortened = 2.0 * half_sine * half_sine + cosine * q * 2.0 * half * half;
            t.deflection += weight * (c * sine + kappa * c_2 * across);
            t.shortening += weight * (shortened - kappa * c_2 * along);
            t.shortening_by_axial -= 0.5 * weight * kappa * c_2 * cosine_2;
            t.shortening_by_lateral -= 0.5 * weight * kappa * c_2 * sine_2;
            t.deflection_by_lateral -= 0.5 * weight * kappa * c_2 * cosine_2;
            t.energy += 0.25 * weight * kappa * c_2 * difference;
            let by_axial = cosine * shear - sine * normal;
            let by_lateral = sine * shear + cosine * normal;
            let even_by = [
                -c * sine + kappa * c_2 * by_axial,
                c * cosine + kappa * c_2 * by_lateral,
                -0.5 * psi * (s * shear + kappa * s_2 * product),
            ];
            let odd_by = [
                -s * cosine - kappa * s_2 * (normal * cosine + shear * sine),
                -s * sine - kappa * s_2 * (normal * sine - shear * cosine),
                -s_by_q * normal - kappa * (s_by_q * c - 0.5 * psi * s * s) * difference,
            ];
            add(&mut t.even, -weight * even_load, even);
            for (table, factor) in t.even_by.iter_mut().zip(even_by) {
                add(table, -weight * factor, even);
            }
            add_product(&mut t.even_even, weight * even_weight, even, even);
            add_product(&mut t.odd_odd, weight * even_weight, odd, odd);
            if odd_modes > 0 {
                add(&mut t.odd, -weight * odd_load, odd);
                for (table, factor) in t.odd_by.iter_mut().zip(odd_by) {
                    add(table, -weight * factor, odd);
                }
                add_product(&mut t.odd_even, weight * odd_weight, odd, even);
            }
        }
        t
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(sum: &mut [f64], factor: f64, values: &[f64]) {
    for (s, value) in sum.iter_mut().zip(values) {
        *s += factor * value;
    }
}

/// Adds `factor` times the products of `rows` and `columns`.
fn add_product(table: &mut [f64], factor: f64, rows: &[f64], columns: &[f64]) {
    for (row, value) in table.chunks_exact_mut(columns.len()).zip(rows) {
        add(row, factor * value, columns);
    }
}
