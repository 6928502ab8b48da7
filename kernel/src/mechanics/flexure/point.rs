//! Equilibrium of the whole mechanism at one displacement, and its vector of unknowns.

use super::basis::Basis;
use super::beam::{Rotation, Shape};

/// An equilibrium of the whole mechanism at one x, in scaled units.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Point {
    pub x: f64,
    pub shapes: [Shape; 2],
    pub even: [Vec<f64>; 2],
    /// Coefficients of psi with a leading 1 for a bump, of the odd part for a bow; empty for
    /// a straight group.
    pub odd: [Vec<f64>; 2],
    pub q: [f64; 2],
    /// Lateral force of one flexure of each group.
    pub lateral: [f64; 2],
    /// Axial compression, equal for both groups.
    pub compression: f64,
    /// dV/dx.
    pub force: f64,
    /// d2V/dx2.
    pub stiffness: f64,
    /// Strain energy.
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

    /// The vector of unknowns: for each group the even coefficients and the odd coefficients, if any (q takes
    /// the place of the leading 1 of a bump); then the lateral forces and the compression.
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

    /// Sets the unknowns; the inverse of [`Self::unknowns`].
    pub(super) fn set_unknowns(&mut self, all: &[f64]) {
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

    /// The same state with other shapes. A new bump has amplitude 0 and the form of the first buckling mode;
    /// a group that becomes straight loses its odd part.
    pub fn reshaped(&self, shapes: [Shape; 2], basis: &Basis) -> Self {
        let mut point = Self { shapes, ..self.clone() };
        for (group, shape) in shapes.into_iter().enumerate() {
            match shape {
                Shape::Straight => {
                    point.odd[group] = Vec::new();
                    point.q[group] = 0.0;
                }
                Shape::Bump if self.shapes[group] != Shape::Bump => {
                    point.odd[group] = basis.first_buckling_mode();
                    let leading = point.odd[group][0];
                    point.odd[group].iter_mut().for_each(|c| *c /= leading);
                    point.q[group] = 0.0;
                }
                _ => {}
            }
        }
        point
    }

    /// The same state with `modes` functions of each parity; the coefficients of the new ones are 0.
    pub fn padded(&self, modes: usize) -> Self {
        let mut point = self.clone();
        for group in 0..2 {
            point.even[group].resize(modes, 0.0);
            if point.shapes[group] != Shape::Straight {
                point.odd[group].resize(modes, 0.0);
            }
        }
        point
    }

    /// Magnitude of the last coefficients of the rotations relative to the largest: an estimate of what more
    /// functions would add.
    pub fn tail(&self) -> f64 {
        let size = |g: usize| if self.shapes[g] == Shape::Bowed { 1.0 } else { self.q[g].abs().sqrt() };
        let parts = [0, 1].map(|g| [(1.0, &self.even[g]), (size(g), &self.odd[g])]);
        let largest_of_last = |count: usize| {
            let last = |(size, part): &(f64, &Vec<f64>)| {
                part.iter().rev().take(count).fold(0.0_f64, |largest, a| largest.max((a * size).abs()))
            };
            parts.iter().flatten().map(last).fold(0.0, f64::max)
        };
        let (largest, last) = (largest_of_last(usize::MAX), largest_of_last(2));
        if largest > 0.0 { last / largest } else { 0.0 }
    }

    /// A guess at `x` by Lagrange interpolation of the unknowns of solved points with the same shapes. If
    /// `mirrored`, the mirror images of points at x > 0 are used as well: the even coefficients (the sway)
    /// and the lateral forces are odd in x, all other unknowns are even.
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
        let mut guess = points[0].clone();
        let mut odd_in_x = Vec::new();
        for group in 0..2 {
            odd_in_x.extend(vec![true; guess.even[group].len()]);
            odd_in_x.extend(vec![false; guess.odd[group].len()]);
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
        guess.set_unknowns(&sum);
        guess.x = x;
        guess
    }
}
