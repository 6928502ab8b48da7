//! A record of displacement for the fit of impacts, with the acceleration of the base if that is known.

use std::ops::Range;

use crate::numeric::extent;
use crate::numeric::orthogonal::{Orthogonal, Tangent};
use crate::scene::Timing;
use crate::study::identify::clipped::{CutOff, cut_off};
use crate::study::identify::{noise, reach};

/// A record of displacement relative to the base, without clipped samples. SI.
pub struct Motion {
    pub times: Vec<f64>,
    pub x: Vec<f64>,
    /// Where swings were cut off, at the least displacement and at the greatest.
    pub cut: [Option<CutOff>; 2],
    /// Whether samples between the one before and this one were cut off.
    after_cut: Vec<bool>,
    pub timing: Timing,
    /// Least and greatest displacement.
    pub extent: (f64, f64),
    pub noise: f64,
    /// Largest reversal of the displacement that noise alone can cause.
    pub back: f64,
    /// The displacement less that which the acceleration of the base alone causes.
    smooth: Vec<f64>,
    /// Displacement, velocity and acceleration at each sample that the acceleration of the base alone causes.
    base: Vec<[f64; 3]>,
}

impl Motion {
    /// The record, with the acceleration of the base at the same times where it was recorded: the mass obeys
    /// x'' = -a + smooth forces, so that -a, interpolated linearly and integrated twice, can be subtracted,
    /// which leaves a smoother function than the displacement.
    ///
    /// Samples in flat tops are left out, and where they were the record has a gap.
    pub fn new(times: &[f64], x: &[f64], accelerations: Option<&[f64]>) -> Self {
        let timing = Timing::of(times);
        let mut base = accelerations.map_or(Vec::new(), |a| integrated(times, a));
        let cut = cut_off(times, x);
        let is_cut = |x: f64| cut.iter().flatten().any(|cut| x == cut.limit);
        let kept: Vec<usize> = (0..x.len()).filter(|i| !is_cut(x[*i])).collect();
        let after_cut = kept.iter().map(|i| *i > 0 && is_cut(x[i - 1])).collect();
        let [times, x] = [times, x].map(|values| kept.iter().map(|i| values[*i]).collect::<Vec<f64>>());
        if !base.is_empty() {
            base = kept.iter().map(|i| base[*i]).collect();
        }
        let smooth = match base.is_empty() {
            true => x.clone(),
            false => x.iter().zip(&base).map(|(x, base)| x - base[0]).collect(),
        };
        let noise = noise(&x);
        let (extent, back) = (extent(x.iter().copied()), reach(&x, noise));
        Self { times, x, cut, after_cut, timing, extent, noise, back, smooth, base }
    }

    pub fn range(&self) -> f64 {
        self.extent.1 - self.extent.0
    }

    /// The first sample at a time or after it.
    pub fn from(&self, t: f64) -> usize {
        self.times.partition_point(|time| *time < t)
    }

    /// Whether there is a gap before a sample, or samples were cut off there.
    pub fn is_gap(&self, sample: usize) -> bool {
        let step = |i: usize| self.times[i] - self.times[i - 1];
        (1..self.times.len()).contains(&sample)
            && (self.after_cut[sample] || self.timing.is_gap(step(sample)))
    }

    /// Whether samples are missing about a time: those before and after it are more than three usual steps
    /// apart, in which a short rebound may hide, or were cut off.
    pub fn is_missing(&self, t: f64) -> bool {
        let next = self.from(t);
        let around = (1..self.times.len()).contains(&next);
        !around || self.after_cut[next] || self.times[next] - self.times[next - 1] > 3.5 * self.timing.step
    }

    /// Polynomials through samples.
    pub fn fit(&self, samples: Range<usize>) -> Orthogonal {
        Orthogonal::fit(&self.times[samples.clone()], &self.smooth[samples])
    }

    /// Polynomials through the samples of two ranges together.
    pub fn fit_both(&self, one: Range<usize>, other: Range<usize>) -> Orthogonal {
        let both = |of: &[f64]| [&of[one.clone()], &of[other.clone()]].concat();
        Orthogonal::fit(&both(&self.times), &both(&self.smooth))
    }

    /// Displacement, velocity and acceleration at a time, of a fit with `terms` coefficients.
    pub fn at(&self, fit: &Orthogonal, t: f64, terms: usize) -> Tangent {
        let mut found = fit.at(t, terms);
        if !self.base.is_empty() {
            let k = self.from(t).clamp(1, self.times.len() - 1) - 1;
            let ([y, v, a], h) = (self.base[k], t - self.times[k]);
            let jerk = (self.base[k + 1][2] - a) / (self.times[k + 1] - self.times[k]);
            found.value += y + h * (v + h * (a / 2.0 + h * jerk / 6.0));
            found.slope += v + h * (a + h * jerk / 2.0);
            found.bend += a + h * jerk;
        }
        found
    }
}

/// Displacement, velocity and acceleration at each sample of a free mass relative to a base that accelerates
/// along straight lines between its samples.
fn integrated(times: &[f64], accelerations: &[f64]) -> Vec<[f64; 3]> {
    let (mut y, mut v) = (0.0, 0.0);
    let mut before: Option<(f64, f64)> = None;
    let next = |(t, a): (&f64, &f64)| {
        let a = -a;
        if let Some((last, first)) = before {
            let h = t - last;
            y += h * (v + h * (2.0 * first + a) / 6.0);
            v += 0.5 * h * (first + a);
        }
        before = Some((*t, a));
        [y, v, a]
    };
    times.iter().zip(accelerations).map(next).collect()
}
