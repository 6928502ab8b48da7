//! Homoclinic orbit of a barrier: the undamped motion that leaves the top of the barrier, turns in a well and
//! comes back to the top, both in infinite time.
//!
//! With u the distance from the barrier and L that of the turning point, u = L sech^2 s takes the orbit from
//! the turning point (s = 0) to the barrier (s to infinity), and the velocity per distance is smooth in s
//! wherever the force is. Integrals along the orbit are sums of Gauss-Legendre rules over panels of s, with a
//! border at each break of the curve.

use super::curve::ForceCurve;
use super::landscape::Well;
use crate::numeric::{Scalar, bisect, elementary};

/// Width of a panel in s, a sixth of the distance of the nearest pole of sech.
const PANEL: f64 = 0.25;
/// Points of the rule in a panel.
const POINTS: usize = 16;
/// End of the integrals in s, at which u is below 1e-17 L.
const END: f64 = 20.0;
/// Share of L below which the potential is the parabola at the top of the barrier.
const NEAR: f64 = 1e-6;
/// Relative jump of the stiffness at the top from which on the barrier has a kink.
const KINK: f64 = 1e-6;
/// Smallest share of the integral of |v| that the transform of v may have: below it, more
/// than 1e-8 of it may be rounding.
const LOST: f64 = 1e-5;
/// Doublings of the distance within which the turning point is searched where the curve has no end.
const DOUBLINGS: i32 = 60;
/// Share of the depth of the well by which another top on its far side must be higher.
const SAME_HEIGHT: f64 = 1e-6;

/// The orbit of one barrier into one of its wells.
///
/// The motion without damping and drive that leaves the top of the barrier and returns to it. Melnikov's
/// threshold is made of its integrals (Guckenheimer and Holmes 1983, section 4.5); see
/// `questions::Threshold::melnikov`.
#[derive(Debug, Clone)]
pub struct Homoclinic<'a> {
    curve: &'a ForceCurve,
    /// Position of the barrier in m.
    barrier: f64,
    /// Position of the turning point in m.
    turn: f64,
    /// Stiffness at the top without its sign, in N/m.
    stiffness: f64,
}

impl<'a> Homoclinic<'a> {
    /// The orbit from the barrier at `barrier` in m into `well`, which lies beside it.
    ///
    /// Returns `None` if the barrier has a kink or no curvature, or if the potential does not rise to its
    /// height on the other side of the well: where the curve ends sooner, or another barrier is lower.
    pub fn new(curve: &'a ForceCurve, barrier: f64, well: &Well) -> Option<Self> {
        let (left, right) = curve.stiffness_on_both_sides(barrier);
        let stiffness = -0.5 * (left + right);
        if !(stiffness > 0.0 && (left - right).abs() <= KINK * stiffness) {
            return None;
        }
        let (outward, top, end) = match well.x > barrier {
            true => (1.0, well.right_top, curve.domain().1),
            false => (-1.0, well.left_top, curve.domain().0),
        };
        let is_below = |x: f64| curve.potential_change(barrier, x) < 0.0;
        let last = top.unwrap_or(end);
        let distance = (well.x - barrier).abs();
        let outer = match last.is_finite() {
            true => last,
            false => {
                let mut steps =
                    (0..DOUBLINGS).map(|k| well.x + outward * distance * elementary::powi(2.0, k));
                steps.find(|x| !is_below(*x))?
            }
        };
        // at another top of the same height the motion would not come back
        let depth = -curve.potential_change(barrier, well.x);
        let margin = if top.is_some() { SAME_HEIGHT * depth } else { 0.0 };
        if !(depth > 0.0 && curve.potential_change(barrier, outer) >= margin) {
            return None;
        }
        let (turn, _) = bisect(well.x, outer, u32::MAX, is_below);
        Some(Self { curve, barrier, turn, stiffness })
    }

    /// Position of the turning point in m.
    pub fn turn(&self) -> f64 {
        self.turn
    }

    /// Integral of the squared velocity over the whole orbit in m^2/s, for a mass in kg. Times the mass it is
    /// the action, and times a damping coefficient the energy that weak damping takes.
    pub fn squared_velocity(&self, mass: f64) -> f64 {
        let (mut sum, rule) = (0.0, f64::gauss_legendre(POINTS));
        self.panels(|from, to| {
            for (node, weight) in rule.nodes().iter().zip(rule.weights()) {
                let s = from + node * (to - from);
                sum += weight * (to - from) * self.speed(s, mass) * self.slope(s);
            }
        });
        2.0 * sum
    }

    /// |Integral of v(t) exp(i w t)| over the whole orbit in m, at an angular frequency w in rad/s, for a
    /// mass in kg. `None` if it is so much smaller than the travel of the orbit that it is lost in rounding,
    /// as at frequencies some ten times the rate at which motions leave the barrier.
    pub fn transform(&self, mass: f64, angular_frequency: f64) -> Option<f64> {
        let rule = f64::gauss_legendre(POINTS);
        // dt/ds; the velocity is odd in time from the turning point
        let pace = |s: f64| self.slope(s) / self.speed(s, mass);
        let integral = |from: f64, to: f64| {
            let terms = rule.nodes().iter().zip(rule.weights());
            terms.map(|(node, weight)| weight * pace(from + node * (to - from))).sum::<f64>() * (to - from)
        };
        let (mut sum, mut time) = (0.0, 0.0);
        self.panels(|from, to| {
            for (node, weight) in rule.nodes().iter().zip(rule.weights()) {
                let s = from + node * (to - from);
                let phase = angular_frequency * (time + integral(from, s));
                sum += weight * (to - from) * self.slope(s) * elementary::sin(phase);
            }
            time += integral(from, to);
        });
        let travel = (self.turn - self.barrier).abs();
        (sum.abs() > LOST * travel).then(|| 2.0 * sum.abs())
    }

    /// |dx/ds| in m.
    fn slope(&self, s: f64) -> f64 {
        let sech = 1.0 / elementary::cosh(s);
        2.0 * (self.turn - self.barrier).abs() * sech * sech * elementary::tanh(s)
    }

    /// |v| in m/s.
    fn speed(&self, s: f64, mass: f64) -> f64 {
        let sech = 1.0 / elementary::cosh(s);
        let share = sech * sech;
        let apart = self.turn - self.barrier;
        if share < NEAR {
            return apart.abs() * share * (self.stiffness / mass).sqrt();
        }
        // each potential difference is taken from the nearer end, where it is small
        let kinetic = match share > 0.5 {
            true => {
                let x = self.turn - apart * elementary::tanh(s) * elementary::tanh(s);
                -self.curve.potential_change(self.turn, x)
            }
            false => -self.curve.potential_change(self.barrier, self.barrier + apart * share),
        };
        (2.0 * kinetic.max(0.0) / mass).sqrt()
    }

    /// Calls `each` with the ends of all panels, ascending from 0.
    fn panels(&self, mut each: impl FnMut(f64, f64)) {
        let apart = self.turn - self.barrier;
        let place = |share: f64| elementary::acosh((1.0 / share).sqrt());
        let inside = |share: &f64| *share > NEAR && *share < 1.0;
        let breaks = self.curve.breaks().iter().map(|x| (x - self.barrier) / apart).filter(inside);
        let mut borders: Vec<f64> = breaks.map(place).chain([0.0, place(NEAR), END]).collect();
        borders.sort_by(f64::total_cmp);
        for pair in borders.windows(2) {
            let count = ((pair[1] - pair[0]) / PANEL).ceil();
            let border = |i: f64| pair[0] + (pair[1] - pair[0]) * (i / count);
            (0..count as usize).for_each(|i| each(border(i as f64), border(i as f64 + 1.0)));
        }
    }
}
