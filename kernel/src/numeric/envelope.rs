//! Exponential envelope of a decaying oscillation, fitted to its turning points.

use super::bisect::{bisect, golden_section};
use super::elementary;
use super::regression::{least_squares, student};

/// Smallest number of turning points: four numbers are fitted to them.
pub const MIN_TURNS: usize = 6;

/// Number of trial rates on either side of the estimate from the first and the last swing.
const TRIALS: u32 = 20;
/// Half the range of the trial rates, as a share of the estimate.
const TRIAL_RANGE: f64 = 0.5;
/// Smallest half of that range, in nepers over the record.
const MIN_TRIAL_RANGE: f64 = 0.2;

/// Largest number of times that the range moves because its outermost rate is the best.
const MAX_MOVES: usize = 100;

/// Steps of the search for the best rate, and for each end of its interval.
const SEARCH_STEPS: u32 = 60;

/// Largest distance, in nepers over the record, at which the end of an interval is searched for.
const MAX_DISTANCE: f64 = 60.0;

/// A turning point of an oscillation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurningPoint {
    /// Time.
    pub t: f64,
    /// Value.
    pub value: f64,
    /// Whether it is a maximum.
    pub maximum: bool,
    /// Weight in a fit: one over the variance of its error, in any unit.
    pub weight: f64,
}

/// A decay with turning points at level + drift (1 - e^-rt)/r +- swing e^-rt, where t = 0 in the middle.
///
/// The level changes at the same rate, so that the two sides of an oscillation about a kink of its force may
/// have different amplitudes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Envelope {
    /// The rate r at which the amplitude decays.
    pub rate: f64,
    level: f64,
    drift: f64,
    swing: f64,
    middle: f64,
    sum_of_squares: f64,
}

impl Envelope {
    /// The envelope with the smallest weighted sum of squares; `None` for fewer than [`MIN_TURNS`] points,
    /// or if they do not determine it.
    ///
    /// Method: level, drift and swing follow from the rate by linear least squares; the rate is found by
    /// trials and a golden-section search around the best one.
    pub fn fit(points: &[TurningPoint]) -> Option<Self> {
        if points.len() < MIN_TURNS {
            return None;
        }
        let last = points.len() - 1;
        let length = points[last].t - points[0].t;
        let swing = |k: usize| (points[k + 1].value - points[k].value).abs();
        let between = points[last - 1].t - points[0].t;
        let mut rate = elementary::ln(swing(0) / swing(last - 1)) / between;
        if !rate.is_finite() || !(length > 0.0) {
            return None;
        }
        let sum_of_squares =
            |rate: f64| Self::of(points, rate).map_or(f64::INFINITY, |envelope| envelope.sum_of_squares);
        let step = (TRIAL_RANGE * rate.abs()).max(MIN_TRIAL_RANGE / length) / f64::from(TRIALS);
        for _ in 0..MAX_MOVES {
            let trials = (0..=2 * TRIALS).map(|i| rate + (f64::from(i) - f64::from(TRIALS)) * step);
            let best = trials.map(|rate| (rate, sum_of_squares(rate))).min_by(|a, b| a.1.total_cmp(&b.1))?.0;
            let outermost = (best - rate).abs() > (f64::from(TRIALS) - 0.5) * step;
            rate = best;
            if !outermost {
                break;
            }
        }
        Self::of(points, golden_section(rate - step, rate + step, SEARCH_STEPS, sum_of_squares))
    }

    /// The best envelope with this rate.
    fn of(points: &[TurningPoint], rate: f64) -> Option<Self> {
        let middle = 0.5 * (points[0].t + points[points.len() - 1].t);
        let row = |point: &TurningPoint| {
            let t = point.t - middle;
            let (decay, weight) = (elementary::exp(-rate * t), point.weight.sqrt());
            let side = if point.maximum { decay } else { -decay };
            ([weight, weight * decayed(rate, t), weight * side], weight * point.value)
        };
        let fit = least_squares(&points.iter().map(row).collect::<Vec<_>>())?;
        let [level, drift, swing] = fit.coefficients.into();
        Some(Self { rate, level, drift, swing, middle, sum_of_squares: fit.variance * fit.freedom as f64 })
    }

    /// The 95 % confidence interval of the rate, given the scatter of the turning points.
    ///
    /// Method: the rates at which the sum of squares has grown by the quantile of Fisher's distribution with
    /// 1 and n - 4 degrees of freedom. Unlike the interval of the linearised problem it also holds for few
    /// turning points. An end that is not found is infinite.
    pub fn interval(&self, points: &[TurningPoint]) -> (f64, f64) {
        let freedom = points.len().saturating_sub(4).max(1);
        let limit = self.sum_of_squares * (1.0 + student(freedom).powi(2) / freedom as f64);
        let unit = 1.0 / (points[points.len() - 1].t - points[0].t);
        let end = |side: f64| {
            let inside = |away: f64| {
                Self::of(points, self.rate + side * away * unit)
                    .is_some_and(|other| other.sum_of_squares <= limit)
            };
            let mut away = 1e-12;
            while inside(away) {
                away *= 2.0;
                if away > MAX_DISTANCE {
                    return side * f64::INFINITY;
                }
            }
            self.rate + side * unit * bisect(0.5 * away, away, SEARCH_STEPS, inside).1
        };
        (end(-1.0), end(1.0))
    }

    /// The value about which the oscillation swings at time `t`, and its amplitude.
    pub fn at(&self, t: f64) -> (f64, f64) {
        let t = t - self.middle;
        (
            self.level + self.drift * decayed(self.rate, t),
            (self.swing * elementary::exp(-self.rate * t)).abs(),
        )
    }
}

/// (1 - e^-rt)/r.
fn decayed(rate: f64, t: f64) -> f64 {
    if rate == 0.0 { t } else { -elementary::exp_m1(-rate * t) / rate }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decay_with_unlike_sides_is_recovered() {
        for (rate, count) in [(0.3, 6), (0.02, 40), (-0.1, 9), (2.5, 7)] {
            let exact = |k: usize| {
                let t = 2.0 + 0.5 * k as f64;
                let decay = f64::exp(-rate * t);
                let value = 7.0 + if k % 2 == 1 { 0.2 * decay } else { -0.5 * decay };
                TurningPoint { t, value, maximum: k % 2 == 1, weight: 1.0 + k as f64 }
            };
            let points: Vec<TurningPoint> = (0..count).map(exact).collect();
            let envelope = Envelope::fit(&points).unwrap();
            assert!((envelope.rate - rate).abs() < 1e-7 * rate.abs(), "{envelope:?}");
            let (low, high) = envelope.interval(&points);
            assert!(high - low < 1e-6 * rate.abs(), "{low} {high}");
            for point in &points {
                let (centre, swing) = envelope.at(point.t);
                let value = centre + if point.maximum { swing } else { -swing };
                assert!((value - point.value).abs() < 1e-9, "{point:?}");
            }
        }
        let still = TurningPoint { t: 0.0, value: 1.0, maximum: true, weight: 1.0 };
        assert_eq!(Envelope::fit(&[still; 9]), None);
        assert_eq!(Envelope::fit(&[still; 3]), None);
    }
}
