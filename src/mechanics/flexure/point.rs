//! Equilibrium of the whole mechanism at one displacement, as the vector of its unknowns.

use super::basis::Basis;
use super::beam::{Rotation, Shape};

/// An equilibrium of the whole mechanism at one x, in scaled units.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Point {
    pub x: f64,
    pub shapes: [Shape; 2],
    pub even: [Vec<f64>; 2],
    /// Coefficients of psi with a leading 1 (a bump), of the odd part (bowed), or nothing.
    pub odd: [Vec<f64>; 2],
    pub q: [f64; 2],
    /// Lateral force of one flexure of each group.
    pub lateral: [f64; 2],
    /// Compression that the groups exchange.
    pub compression: f64,
    /// dV/dx, its derivative, and the strain energy.
    pub force: f64,
    pub stiffness: f64,
    pub energy: f64,
}

impl Point {
    pub(super) fn rotation(&self, group: usize, count: f64) -> Rotation<'_> {
        Rotation {
            shape: self.shapes[group],
            even: &self.even[group],
            odd: &self.odd[group],
            q: self.q[group],
            axial: -self.compression / count,
            lateral: self.lateral[group],
        }
    }

    /// The unknowns in a row: for each group the even coefficients and, where there are any, the odd ones (of
    /// a bump, q stands in place of the leading 1); then the lateral forces and the compression.
    pub(super) fn unknowns(&self) -> Vec<f64> {
        let mut all = Vec::new();
        for group in 0..2 {
            all.extend(&self.even[group]);
            all.extend(&self.odd[group]);
            if self.shapes[group] == Shape::Bump {
                let leading = all.len() - self.odd[group].len();
                all[leading] = self.q[group];
            }
        }
        all.extend(self.lateral);
        all.push(self.compression);
        all
    }

    /// Takes the unknowns back; the inverse of [`Self::unknowns`].
    pub(super) fn take(&mut self, all: &[f64]) {
        let mut at = 0;
        for group in 0..2 {
            for part in [&mut self.even[group], &mut self.odd[group]] {
                let end = at + part.len();
                part.copy_from_slice(&all[at..end]);
                at = end;
            }
            if self.shapes[group] == Shape::Bump {
                self.q[group] = std::mem::replace(&mut self.odd[group][0], 1.0);
            }
        }
        self.lateral = [all[at], all[at + 1]];
        self.compression = all[at + 2];
    }

    /// The same state with other shapes: a bump that appears has vanishing size and the form of the first
    /// buckling mode, one that goes leaves nothing.
    pub fn reshaped(&self, shapes: [Shape; 2], basis: &Basis) -> Self {
        let mut own = Self { shapes, ..self.clone() };
        for (group, shape) in shapes.into_iter().enumerate() {
            match shape {
                Shape::Straight => {
                    own.odd[group] = Vec::new();
                    own.q[group] = 0.0;
                }
                Shape::Bump if self.shapes[group] != Shape::Bump => {
                    own.odd[group] = basis.first_buckling_mode();
                    let leading = own.odd[group][0];
                    own.odd[group].iter_mut().for_each(|c| *c /= leading);
                    own.q[group] = 0.0;
                }
                _ => {}
            }
        }
        own
    }

    /// The same state with more functions, whose coefficients are 0.
    pub fn padded(&self, modes: usize) -> Self {
        let mut own = self.clone();
        for group in 0..2 {
            own.even[group].resize(modes, 0.0);
            if own.shapes[group] != Shape::Straight {
                own.odd[group].resize(modes, 0.0);
            }
        }
        own
    }

    /// How large the last coefficients of the rotations are beside the largest: what further functions would
    /// add.
    pub fn tail(&self) -> f64 {
        let all = (0..2).flat_map(|g| {
            let size = self.q[g].abs().sqrt();
            let bowed = self.shapes[g] == Shape::Bowed;
            let odd: Vec<f64> = self.odd[g].iter().map(|a| if bowed { *a } else { a * size }).collect();
            [self.even[g].clone(), odd]
        });
        let parts: Vec<Vec<f64>> = all.collect();
        let largest = parts.iter().flatten().fold(0.0_f64, |most, a| most.max(a.abs()));
        let last = parts
            .iter()
            .flat_map(|part| part.iter().rev().take(2))
            .fold(0.0_f64, |most, a| most.max(a.abs()));
        if largest > 0.0 { last / largest } else { 0.0 }
    }

    /// A guess at `x` from solved points of the same shapes: Lagrange's interpolation of the unknowns. Points
    /// at x >= 0 stand for their mirror images too where `mirrored`: rotation and lateral force of the sway
    /// are odd in x, everything else is even.
    pub fn between(points: &[&Self], x: f64, mirrored: bool) -> Self {
        let modes = points.iter().map(|p| p.even[0].len()).max().unwrap_or(0);
        let points: Vec<Self> = points.iter().map(|p| p.padded(modes)).collect();
        let nodes: Vec<f64> = points
            .iter()
            .flat_map(|p| if mirrored && p.x > 0.0 { vec![p.x, -p.x] } else { vec![p.x] })
            .collect();
        let weight = |node: f64| -> f64 {
            nodes.iter().filter(|other| **other != node).map(|other| (x - other) / (node - other)).product()
        };
        let mut own = points[0].clone();
        let mut odd_in_x = Vec::new();
        for group in 0..2 {
            odd_in_x.extend(vec![true; own.even[group].len()]);
            odd_in_x.extend(vec![false; own.odd[group].len()]);
        }
        odd_in_x.extend([true, true, false]);
        let mut sum = vec![0.0; odd_in_x.len()];
        for point in &points {
            let right = weight(point.x);
            let left = if mirrored && point.x > 0.0 { weight(-point.x) } else { 0.0 };
            for ((s, value), odd) in sum.iter_mut().zip(point.unknowns()).zip(&odd_in_x) {
                *s += value * if *odd { right - left } else { right + left };
            }
        }
        own.take(&sum);
        own.x = x;
        own
    }
}
