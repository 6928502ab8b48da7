//! A record of displacement for the fit of impacts, with the acceleration of the base if that is known.

use std::ops::Range;

use super::base::Base;
use super::drift::Drift;
use crate::identify::clipped::{CutOff, cut_off};
use crate::identify::outliers::outliers;
use crate::identify::{Turn, noise_between_impacts, reach};
use crate::numeric::extent;
use crate::numeric::orthogonal::{Orthogonal, Tangent};
use crate::scene::Timing;

/// A record of displacement relative to the base, without clipped samples and those that lie off. SI.
pub struct Motion {
    pub times: Vec<f64>,
    pub x: Vec<f64>,
    /// Where swings were cut off, at the least displacement and at the greatest.
    pub cut: [Option<CutOff>; 2],
    /// Whether samples between the one before and this one were cut off.
    after_cut: Vec<bool>,
    /// Number of samples that lay off and are left out.
    pub outliers: usize,
    pub timing: Timing,
    /// Motion of the stops in the record, which is subtracted.
    pub drift: Drift,
    /// Least and greatest displacement.
    pub extent: (f64, f64),
    pub noise: f64,
    /// Largest reversal of the displacement that noise alone can cause.
    pub back: f64,
    /// The displacement less that which the acceleration of the base alone causes.
    smooth: Vec<f64>,
    base: Option<Base>,
}

impl Motion {
    /// The record, with the acceleration of the base at the same times where it was recorded: the mass obeys
    /// x'' = -a + smooth forces, so that -a, integrated twice, can be subtracted, which leaves a smoother
    /// function than the displacement.
    ///
    /// Samples in flat tops are left out, and where they were the record has a gap; so are samples that lie
    /// off.
    pub fn new(times: &[f64], x: &[f64], accelerations: Option<&[f64]>) -> Self {
        let timing = Timing::of(times);
        let base = accelerations.map(|accelerations| Base::new(times, accelerations));
        let cut = cut_off(times, x);
        let is_cut = |x: f64| cut.iter().flatten().any(|cut| x == cut.limit);
        let free = |i: &usize| x[*i] - base.as_ref().map_or(0.0, |base| base.at(times[*i])[0]);
        let of = |kept: &[usize], values: &[f64]| kept.iter().map(|i| values[*i]).collect::<Vec<f64>>();
        let seen: Vec<usize> = (0..x.len()).filter(|i| !is_cut(x[*i])).collect();
        let smooth: Vec<f64> = seen.iter().map(free).collect();
        let off = outliers(&of(&seen, times), &smooth, noise_between_impacts(&smooth));
        let (mut kept, mut after_cut) = (Vec::with_capacity(seen.len()), Vec::with_capacity(seen.len()));
        let mut is_after = false;
        for (i, off) in seen.iter().zip(&off) {
            is_after |= *i > 0 && is_cut(x[i - 1]);
            if !off {
                kept.push(*i);
                after_cut.push(is_after);
                is_after = false;
            }
        }
        let smooth: Vec<f64> = kept.iter().map(free).collect();
        let (outliers, [times, x]) = (seen.len() - kept.len(), [times, x].map(|values| of(&kept, values)));
        let noise = noise_between_impacts(&smooth);
        let (extent, back) = (extent(x.iter().copied()), reach(&x, noise));
        let drift = Drift::default();
        Self { times, x, cut, after_cut, outliers, timing, drift, extent, noise, back, smooth, base }
    }

    /// Subtracts a motion of the stops that was not subtracted yet.
    pub fn subtract(&mut self, drift: &Drift) {
        for i in 0..self.x.len() {
            let (moved, _) = drift.at(self.part(self.times[i]));
            self.x[i] -= moved;
            self.smooth[i] -= moved;
        }
        self.extent = extent(self.x.iter().copied());
        self.back = reach(&self.x, self.noise);
        self.drift = Drift { coefficients: self.drift.coefficients + drift.coefficients, ..*drift };
    }

    /// A time as -1 to 1 over the record.
    pub fn part(&self, t: f64) -> f64 {
        (t - 0.5 * (self.timing.span.0 + self.timing.span.1)) / self.half()
    }

    /// Half of the duration.
    pub fn half(&self) -> f64 {
        0.5 * (self.timing.span.1 - self.timing.span.0)
    }

    /// Whether an impact at a turning point may be cut off.
    pub fn is_hidden(&self, turn: Turn) -> bool {
        let drift = self.drift.at(self.part(self.times[turn.at])).0;
        let cut = self.cut[usize::from(turn.maximum)];
        cut.is_some_and(|cut| (self.x[turn.at] + drift - cut.limit).abs() < self.back)
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

    /// How far a sample is from a fit with `terms` coefficients, and the standard error for samples of
    /// variance 1.
    pub fn residual(&self, fit: &Orthogonal, sample: usize, terms: usize) -> (f64, f64) {
        let found = fit.at(self.times[sample], terms);
        ((self.smooth[sample] - found.value).abs(), (1.0 + found.value_variance).sqrt())
    }

    /// Root of the mean square velocity.
    pub fn speed(&self) -> f64 {
        let steps = self.times.windows(2).zip(self.x.windows(2));
        let square: f64 = steps.map(|(t, x)| (x[1] - x[0]).powi(2) / (t[1] - t[0])).sum();
        (square / (2.0 * self.half())).sqrt()
    }

    /// Displacement, velocity and acceleration at a time, of a fit with `terms` coefficients.
    pub fn at(&self, fit: &Orthogonal, t: f64, terms: usize) -> Tangent {
        let mut found = fit.at(t, terms);
        if let Some(base) = &self.base {
            let [y, v, a] = base.at(t);
            found.value += y;
            found.slope += v;
            found.bend += a;
        }
        found
    }
}
