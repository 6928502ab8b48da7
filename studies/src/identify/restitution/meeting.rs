//! Intersection of two polynomials: the time and place of an impact, and the speeds before and after it.

use super::{Motion, median};
use crate::numeric::orthogonal::Orthogonal;

/// The motion before an impact and after it, as polynomials.
pub struct Sides {
    pub before: Orthogonal,
    pub after: Orthogonal,
}

/// An impact. SI; variances are those for errors of variance 1 in the samples.
#[derive(Debug, Clone, Copy)]
pub struct Meeting {
    pub t: f64,
    pub x: f64,
    /// 1 if the stop is on the right, -1 if it is on the left.
    pub side: f64,
    /// Speed towards the stop before it, and away from the stop after it.
    pub towards: f64,
    pub away: f64,
    pub of_t: f64,
    pub of_x: f64,
    pub of_towards: f64,
    pub of_away: f64,
    /// Covariance of both speeds.
    pub of_speeds: f64,
}

/// Largest number of steps of Newton's method; two parabolas need about five.
const MAX_STEPS: usize = 10;

impl Sides {
    /// The intersection of the polynomials with `terms` coefficients nearest to a time; `right` says whether
    /// the stop is on the right.
    ///
    /// This is the joint least squares fit of two polynomials in t - t_0 with one constant x_s, where t_0 and
    /// x_s are unknown: it has as many unknowns as the two polynomials, and at their intersection the
    /// displacement is continuous. Errors of the samples are propagated to first order, including that of
    /// t_0.
    pub fn meet(&self, motion: &Motion, terms: usize, near: f64, right: bool) -> Option<Meeting> {
        self.before.squared_residuals(terms).and(self.after.squared_residuals(terms))?;
        let sign = if right { 1.0 } else { -1.0 };
        let mut t = near;
        for _ in 0..MAX_STEPS {
            let (before, after) = (motion.at(&self.before, t, terms), motion.at(&self.after, t, terms));
            let step = (after.value - before.value) / (before.slope - after.slope);
            if !step.is_finite() {
                return None;
            }
            t += step;
            if step.abs() <= 1e-12 * motion.timing.step {
                break;
            }
        }
        let (before, after) = (motion.at(&self.before, t, terms), motion.at(&self.after, t, terms));
        let jump = before.slope - after.slope;
        // errors l of the first and r of the second value shift the intersection by (r - l)/jump
        let (a, b) = (before.bend / jump, after.bend / jump);
        let (l, r) = (-after.slope / jump, before.slope / jump);
        Some(Meeting {
            t,
            x: l * before.value + r * after.value,
            side: sign,
            towards: sign * before.slope,
            away: -sign * after.slope,
            of_t: (before.value_variance + after.value_variance) / jump.powi(2),
            of_x: l * l * before.value_variance + r * r * after.value_variance,
            of_towards: before.slope_variance - 2.0 * a * before.covariance
                + a * a * (before.value_variance + after.value_variance),
            of_away: after.slope_variance
                + 2.0 * b * after.covariance
                + b * b * (before.value_variance + after.value_variance),
            of_speeds: b * before.covariance
                - a * after.covariance
                - a * b * (before.value_variance + after.value_variance),
        })
    }

    /// The sum of the squared residuals of both, and the samples less the coefficients.
    pub fn rest(&self, terms: usize) -> Option<(f64, usize)> {
        let square = self.before.squared_residuals(terms)? + self.after.squared_residuals(terms)?;
        Some((square, self.before.samples() + self.after.samples() - 2 * terms))
    }
}

impl Meeting {
    /// The restitution and its variance.
    pub fn ratio(&self) -> (f64, f64) {
        let e = self.away / self.towards;
        (e, self.of_residual(e) / self.towards.powi(2))
    }

    fn of_residual(&self, e: f64) -> f64 {
        self.of_away + e * (e * self.of_towards - 2.0 * self.of_speeds)
    }
}

/// The restitution of impacts together. Variances are those for errors of variance 1 in the samples.
#[derive(Debug, Clone, Copy)]
pub struct Common {
    pub value: f64,
    pub variance: f64,
    /// Sum of the squared residuals of the impacts, each over its variance.
    pub square: f64,
    /// Derivative of the value to the velocity of the stops.
    pub of_drift: f64,
}

/// The restitution of impacts together.
///
/// Both speeds have errors, so that a mean of ratios would be biased. This is the maximum likelihood estimate
/// of e with the true speeds as further unknowns (Deming 1943, with a covariance for each impact), by
/// fixed-point iteration. Impacts are treated as independent, although two that share a flight are weakly
/// correlated.
pub fn restitution(impacts: &[&Meeting]) -> Option<Common> {
    let mut e = median(impacts.iter().map(|impact| impact.ratio().0).collect())?;
    let (mut weight, mut rest, mut drift) = (f64::NAN, 0.0, 0.0);
    for _ in 0..30 {
        let (mut product, mut square) = (0.0, 0.0);
        (weight, rest, drift) = (0.0, 0.0, 0.0);
        for impact in impacts {
            let (residual, variance) = (impact.away - e * impact.towards, impact.of_residual(e));
            let shift = (impact.of_speeds - e * impact.of_towards) / variance * residual;
            let speed = impact.towards - shift;
            product += speed * impact.away / variance;
            square += speed * impact.towards / variance;
            weight += speed * speed / variance;
            rest += residual * residual / variance;
            drift += impact.side * speed / variance;
        }
        let step = product / square - e;
        e += step;
        if !(step.abs() > 1e-14 * e.abs()) {
            break;
        }
    }
    let common =
        Common { value: e, variance: 1.0 / weight, square: rest, of_drift: (1.0 + e) * drift / weight };
    (e.is_finite() && weight > 0.0).then_some(common)
}

/// The place of impacts on one stop, the mean with weights 1/variance, its variance, and the sum of the
/// squared residuals, each over its variance.
pub fn place(impacts: &[&Meeting]) -> Option<(f64, f64, f64)> {
    let total: f64 = impacts.iter().map(|impact| 1.0 / impact.of_x).sum();
    let mean = impacts.iter().map(|impact| impact.x / impact.of_x).sum::<f64>() / total;
    let square = impacts.iter().map(|impact| (impact.x - mean).powi(2) / impact.of_x).sum();
    mean.is_finite().then_some((mean, 1.0 / total, square))
}
