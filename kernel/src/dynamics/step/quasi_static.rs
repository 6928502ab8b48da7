//! Quasi-static motion of a mass that a slow load presses into a compliant stop.
//!
//! A mass pressed onto the stop rings at some kilohertz, and the ringing decays. The remaining motion follows
//! the load:
//!
//! ```text
//! k d^1.5 (1 + a d') = A(t, d) - g d' - d'',
//! ```
//!
//! where A is the inward acceleration by mechanism and base, g = c/m, and d' and d'' are small if the load is
//! slow compared with the ringing. So the equation is solved for d by iteration: each sweep puts the last d
//! into the right-hand side and takes the power 2/3 of its series in time. (This is the slow manifold of the
//! motion; Fenichel 1979, "Geometric singular perturbation theory for ordinary differential equations".)
//!
//! The residual r of the equation of motion over a step would make the mass ring at a speed of at most the
//! integral of |r| over the step, since neither loss nor damping adds energy. A step is taken only if this
//! speed and that of the ringing at its start are below the tolerance; otherwise the motion is integrated
//! like any contact, as it is before a release, where the stop becomes soft.

use super::path::{InStop, Path};
use crate::dynamics::equation::Compliant;
use crate::dynamics::equation::force::PieceForce;
use crate::dynamics::result::Phase;
use crate::dynamics::series::{ROOM, Series, polynomial, square};
use crate::numeric::{GaussLegendre, PolynomialRoots, Scalar};

/// One step of quasi-static motion, in the time since its start, and the workspace.
#[derive(Debug, Clone)]
pub(crate) struct QuasiStatic<T: Copy> {
    /// Displacement from the piece's origin, and the base's acceleration.
    pub series: Series<T>,
    pub depth: [T; ROOM],
    /// Elastic force of the stop over mass.
    elastic: [T; ROOM],
    /// Coefficients of the mechanism's force about the surface of the stop.
    pub about: Vec<T>,
    pub stop: Compliant<T>,
    pub sign: T,
}

impl<T: Scalar> QuasiStatic<T> {
    pub fn new(stop: Compliant<T>) -> Self {
        let zeros = [T::zero(); ROOM];
        let about = Vec::new();
        Self { series: Series::new(0), depth: zeros, elastic: zeros, about, stop, sign: T::of(1.0) }
    }

    /// Solves for the depth up to `order` in `sweeps` from the root of the depth at the start; `order + 2
    /// sweeps` terms of the base's acceleration must be known.
    pub fn solve(&mut self, root: T, (order, sweeps): (usize, usize), surface: T, damping: T) {
        let zero = T::zero();
        let Self { series: Series { y, a, .. }, depth, elastic, about, stop, sign } = self;
        let inverse_stiffness = T::of(1.0) / stop.stiffness;
        let mut top = order + 2 * sweeps;
        depth[..=top].fill(zero);
        elastic[..=top].fill(zero);
        depth[0] = root * root;
        let mut start = root;
        for sweep in 0..sweeps {
            top -= 2;
            let mut force = [zero; ROOM];
            for k in 0..=top {
                let mechanism = about[1] * depth[k] + *sign * about[2] * square(depth, k);
                let constant = if k == 0 { *sign * about[0] } else { zero };
                let mut sum = -(mechanism + constant + *sign * a[k]);
                if sweep > 0 {
                    let slope = |k: usize| depth[k + 1] * T::whole(k + 1);
                    let lost = (0..=k).fold(zero, |sum, i| sum + slope(i) * elastic[k - i]);
                    sum = sum - damping * slope(k) - stop.loss * lost;
                    sum -= depth[k + 2] * T::whole((k + 1) * (k + 2));
                }
                force[k] = sum;
            }
            *elastic = force;
            // d = (elastic / k)^(2/3): first the root of d, whose third power is known.
            let cube = force[0] * inverse_stiffness;
            for _ in 0..8 {
                let change = (start * start * start - cube) / (T::of(3.0) * start * start);
                start -= change;
                if !(change.abs() > start * T::of(T::ROUGH)) {
                    break;
                }
            }
            start -= (start * start * start - cube) / (T::of(3.0) * start * start);
            depth[0] = start * start;
            let inverse = T::of(1.0) / force[0];
            let third = T::of(1.0) / T::of(3.0);
            for k in 1..=top {
                let mut sum = zero;
                for i in 1..=k {
                    // (2/3) i - (k - i), times three
                    let share = T::whole(5 * i) - T::whole(3 * k);
                    sum += share * force[i] * depth[k - i];
                }
                depth[k] = sum * third * inverse / T::whole(k);
            }
        }
        for k in 0..=order {
            y[k] = *sign * depth[k];
        }
        y[0] += surface;
        self.series.known = order + 1;
    }

    fn order(&self) -> usize {
        self.series.known - 1
    }

    /// Residual of the equation of motion at time `t`.
    pub fn residual(&self, t: T, surface: T, force: &PieceForce<T>, damping: T) -> T {
        let (mut depth, mut speed, mut half) = (T::zero(), T::zero(), T::zero());
        for c in self.depth[..=self.order()].iter().rev() {
            half = half * t + speed;
            speed = speed * t + depth;
            depth = depth * t + *c;
        }
        let displacement = surface + self.sign * depth;
        let load = -(self.sign * (force.at(displacement) + self.series.base(t))) - damping * speed;
        (half + half) - load + self.stop.force(depth.larger(T::zero()).sqrt(), speed)
    }
}

impl<T: Scalar> InStop<T> for QuasiStatic<T> {
    fn loss(&self, rule: &GaussLegendre<T>, from: T, to: T) -> T {
        let coefficients = &self.depth[..=self.order()];
        let lost = polynomial::integral(rule, from, to, |t| {
            let speed = polynomial::slope(coefficients, t);
            let root = polynomial::value(coefficients, t).sqrt();
            root * root * root * (speed * speed)
        });
        self.stop.stiffness * self.stop.loss * lost
    }

    /// From the extremes of the depth: the speed there is 0, and it is nearly 0 where the force is largest.
    fn peak(&self, h: T, _: T, known: T) -> T {
        let coefficients = &self.depth[..=self.order()];
        let force = |t: T| {
            let depth = polynomial::value(coefficients, t).larger(T::zero());
            self.stop.force(depth.sqrt(), polynomial::slope(coefficients, t))
        };
        let scaled = polynomial::scaled(coefficients, h);
        let max_depth = scaled[..coefficients.len()].iter().fold(T::zero(), |sum, c| sum + c.abs());
        let speed = polynomial::chord_deviations(coefficients, h).0 * T::of(8.0) / h + coefficients[1].abs();
        if !(self.stop.force(max_depth.sqrt(), speed) > known) {
            return known;
        }
        let mut peak = known.larger(force(T::zero())).larger(force(h));
        let slope = polynomial::derivative(&scaled[..coefficients.len()]);
        PolynomialRoots::new(&slope[..coefficients.len() - 1]).each_sign_change(&mut |s| {
            peak = peak.larger(force(s * h));
            true
        });
        peak
    }
}

impl<T: Scalar> Path<T> for QuasiStatic<T> {
    const IN_CONTACT: bool = true;

    fn phase(&self) -> Phase {
        if self.sign < T::zero() { Phase::LeftStop } else { Phase::RightStop }
    }
    fn in_time(&self) -> Option<&[T]> {
        Some(self.series.coefficients())
    }
    fn known(&self) -> usize {
        self.series.known
    }
    fn start(&self) -> T {
        self.series.y[0]
    }
    fn scaled(&self, h: T) -> [T; ROOM] {
        polynomial::scaled(self.series.coefficients(), h)
    }
    fn position(&self, parameter: T) -> T {
        polynomial::value(self.series.coefficients(), parameter)
    }
    fn velocity(&self, parameter: T) -> T {
        polynomial::slope(self.series.coefficients(), parameter)
    }
    fn integrals<const WORK: bool>(&self, rule: &GaussLegendre<T>, from: T, to: T) -> (T, T) {
        let (y, a) = (self.series.coefficients(), self.series.base_coefficients());
        polynomial::integrals::<_, WORK>(y, a, rule, from, to)
    }
}
