//! Exponential envelope of a decaying oscillation, through its turning points.

use super::bisect::{bisect, golden_section};
use super::regression::{least_squares, student};

/// The fewest turning points: four numbers are fitted to them.
pub const FEWEST_TURNS: usize = 6;

/// Rates that are tried beside the one that the first and the last swing tell, and how far to either side of
/// it, in parts of itself and in nepers over the whole.
const TRIED: u32 = 20;
const BESIDE: (f64, f64) = (0.5, 0.2);

/// How often the trials move on where the best one is the outermost.
const MOST_MOVES: usize = 100;

/// Steps towards the best rate, and towards the ends of its interval.
const HALVINGS: u32 = 60;

/// Nepers over the whole beyond which the end of an interval is not looked for.
const FARTHEST: f64 = 60.0;

/// A turning point of an oscillation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurningPoint {
    /// When.
    pub t: f64,
    /// Its value.
    pub value: f64,
    /// Whether it is a maximum.
    pub maximum: bool,
    /// What it counts in a fit: one over the variance of its error, in any unit.
    pub weight: f64,
}

/// A rate of decay with what it makes of the turning points: they lie at
/// level + drift (1 - e^-rt)/r +- swing e^-rt, with t from the middle on.
///
/// The level goes from one value to another at the same rate, so that the two sides of an oscillation about a
/// kink of its force may have unlike amplitudes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Envelope {
    /// The decay of the amplitude in unit time, r.
    pub rate: f64,
    level: f64,
    drift: f64,
    swing: f64,
    middle: f64,
    /// Weighted sum of the squares of what is left over.
    square: f64,
}

impl Envelope {
    /// The envelope of the least weighted squares; `None` for fewer than [`FEWEST_TURNS`], or where the
    /// turning points do not decide.
    ///
    /// Method: level, drift and swing are linear and follow from the rate; the rate is found by trials and by
    /// the golden section between them.
    pub fn fit(points: &[TurningPoint]) -> Option<Self> {
        if points.len() < FEWEST_TURNS {
            return None;
        }
        let last = points.len() - 1;
        let length = points[last].t - points[0].t;
        let swing = |k: usize| (points[k + 1].value - points[k].value).abs();
        let between = points[last - 1].t - points[0].t;
        let mut rate = (swing(0) / swing(last - 1)).ln() / between;
        if !rate.is_finite() || !(length > 0.0) {
            return None;
        }
        let square = |rate: f64| Self::of(points, rate).map_or(f64::INFINITY, |envelope| envelope.square);
        let step = (BESIDE.0 * rate.abs()).max(BESIDE.1 / length) / f64::from(TRIED);
        for _ in 0..MOST_MOVES {
            let tried = (0..=2 * TRIED).map(|i| rate + (f64::from(i) - f64::from(TRIED)) * step);
            let best = tried.map(|rate| (rate, square(rate))).min_by(|a, b| a.1.total_cmp(&b.1))?.0;
            let outermost = (best - rate).abs() > (f64::from(TRIED) - 0.5) * step;
            rate = best;
            if !outermost {
                break;
            }
        }
        Self::of(points, golden_section(rate - step, rate + step, HALVINGS, square))
    }

    /// The envelope of this rate.
    fn of(points: &[TurningPoint], rate: f64) -> Option<Self> {
        let middle = 0.5 * (points[0].t + points[points.len() - 1].t);
        let row = |point: &TurningPoint| {
            let t = point.t - middle;
            let (left, count) = ((-rate * t).exp(), point.weight.sqrt());
            let side = if point.maximum { left } else { -left };
            ([count, count * gone(rate, t), count * side], count * point.value)
        };
        let fit = least_squares(&points.iter().map(row).collect::<Vec<_>>())?;
        let [level, drift, swing] = fit.coefficients.into();
        Some(Self { rate, level, drift, swing, middle, square: fit.variance * fit.freedom as f64 })
    }

    /// The rates that are not told from this one by the scatter of the turning points: the 95 % interval.
    ///
    /// Method: the rates at which the least squares have grown by the quantile of Fisher's distribution of 1
    /// and n - 4 degrees of freedom. Unlike the interval of the linearised problem it holds also where the
    /// turning points are few. An end that is not found is infinite.
    pub fn interval(&self, points: &[TurningPoint]) -> (f64, f64) {
        let freedom = points.len().saturating_sub(4).max(1);
        let most = self.square * (1.0 + student(freedom).powi(2) / freedom as f64);
        let unit = 1.0 / (points[points.len() - 1].t - points[0].t);
        let end = |side: f64| {
            let inside = |away: f64| {
                Self::of(points, self.rate + side * away * unit).is_some_and(|other| other.square <= most)
            };
            let mut away = 1e-12;
            while inside(away) {
                away *= 2.0;
                if away > FARTHEST {
                    return side * f64::INFINITY;
                }
            }
            self.rate + side * unit * bisect(0.5 * away, away, HALVINGS, inside).1
        };
        (end(-1.0), end(1.0))
    }

    /// The value about which it swings at a time, and by how much.
    pub fn at(&self, t: f64) -> (f64, f64) {
        let t = t - self.middle;
        (self.level + self.drift * gone(self.rate, t), (self.swing * (-self.rate * t).exp()).abs())
    }
}

/// (1 - e^-rt)/r.
fn gone(rate: f64, t: f64) -> f64 {
    if rate == 0.0 { t } else { -(-rate * t).exp_m1() / rate }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decay_with_unlike_sides_is_recovered() {
        for (rate, count) in [(0.3, 6), (0.02, 40), (-0.1, 9), (2.5, 7)] {
            let exact = |k: usize| {
                let t = 2.0 + 0.5 * k as f64;
                let left = f64::exp(-rate * t);
                let value = 7.0 + if k % 2 == 1 { 0.2 * left } else { -0.5 * left };
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
