//! Centre lines and curvatures of the flexures.

use std::f64::consts::PI;

use super::basis::{functions, slopes};
use super::beam::{Beam, Shape, dot};
use super::point::Point;
use crate::numeric::{GaussLegendre, elementary};

/// Number of points of a centre line; odd, so that one is the middle.
const LINE_POINTS: usize = 65;

/// Number of positions at which the curvature is evaluated, dense at the clamps, where it is largest on the
/// taut branch.
const CURVATURE_POINTS: usize = 257;

/// Lateral distance of the middle of a centre line from the mean of its ends.
pub(super) fn bump(line: &[[f64; 3]]) -> f64 {
    (line[line.len() / 2][2] - 0.5 * line[line.len() - 1][2]).abs()
}

/// One flexure of a group in its deflected shape.
pub(super) struct Deflected<'a> {
    pub beam: &'a Beam,
    /// Coefficients of the whole rotation, even and odd alternating.
    rotation: Vec<f64>,
    axial: f64,
    lateral: f64,
}

impl<'a> Deflected<'a> {
    pub fn of(beam: &'a Beam, point: &Point, group: usize) -> Self {
        let size = if point.shapes[group] == Shape::Bump { point.q[group].max(0.0).sqrt() } else { 1.0 };
        let mut rotation = vec![0.0; 2 * point.even[group].len()];
        for (i, a) in point.even[group].iter().enumerate() {
            rotation[2 * i] = *a;
        }
        for (i, a) in point.odd[group].iter().enumerate() {
            rotation[2 * i + 1] = size * a;
        }
        Self { beam, rotation, axial: -point.compression / beam.count, lateral: point.lateral[group] }
    }

    /// Points (arc length s, axial and lateral position) along the flexure from its clamp on the frame, in
    /// scaled units.
    pub fn line(&self) -> Vec<[f64; 3]> {
        let rule = GaussLegendre::<f64>::new(4);
        let mut row = vec![0.0; self.rotation.len()];
        let mut points = vec![[0.0; 3]];
        let mut at = [0.0; 2];
        for i in 1..LINE_POINTS {
            let knot = |i: usize| 0.5 - 0.5 * elementary::cos(PI * i as f64 / (LINE_POINTS - 1) as f64);
            let (from, to) = (knot(i - 1), knot(i));
            for (node, weight) in rule.nodes().iter().zip(rule.weights()) {
                functions(2.0 * (from + (to - from) * node) - 1.0, &mut row);
                let (sine, cosine) = elementary::sin_cos(dot(&row, &self.rotation));
                let stretch = 1.0 + self.beam.stretch * (self.axial * cosine + self.lateral * sine);
                let shear = self.beam.shear * (self.lateral * cosine - self.axial * sine);
                let ds = weight * (to - from) * self.beam.length;
                at[0] += ds * (stretch * cosine - shear * sine);
                at[1] += ds * (stretch * sine + shear * cosine);
            }
            points.push([to * self.beam.length, at[0], at[1]]);
        }
        points
    }

    /// The largest change of curvature from the stress-free flexure.
    pub fn curvature(&self) -> f64 {
        let mut row = vec![0.0; self.rotation.len()];
        let mut bend = self.rotation.clone();
        for (i, natural) in self.beam.natural.iter().enumerate() {
            if let Some(b) = bend.get_mut(2 * i + 1) {
                *b -= natural;
            }
        }
        let places =
            (0..CURVATURE_POINTS).map(|i| elementary::cos(PI * i as f64 / (CURVATURE_POINTS - 1) as f64));
        places.fold(0.0, |largest: f64, xi| {
            slopes(xi, &mut row);
            largest.max((dot(&row, &bend) * 2.0 / self.beam.length).abs())
        })
    }
}
