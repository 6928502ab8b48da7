//! Turning points of a noisy record.

use crate::numeric::extent;

/// Noise of values that vary slowly from sample to sample: the standard deviation of what is random in each.
///
/// Third differences of a smooth record vanish, those of independent errors of standard deviation s have
/// s sqrt(20); their median magnitude does not see the few at impacts. Of values that stand still for many
/// samples, as those of a converter with few bits do, the least change counts.
pub fn noise(values: &[f64]) -> f64 {
    /// Median magnitude over standard deviation of normal numbers.
    const NORMAL: f64 = 0.674_489_750_196_081_7;
    let third = |own: &[f64]| (own[3] - 3.0 * own[2] + 3.0 * own[1] - own[0]).abs();
    let mut sizes: Vec<f64> = values.windows(4).map(third).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    let random = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 / (NORMAL * 20_f64.sqrt());
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let still = steps.clone().filter(|step| *step == 0.0).count();
    let least = steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    if 10 * still > values.len() && least.is_finite() { random.max(least) } else { random }
}

/// A turning point: a sample from which the values go back by more than noise does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Turn {
    /// Which sample.
    pub at: usize,
    /// Whether it is a maximum.
    pub maximum: bool,
}

/// How far values with noise of this standard deviation go back where they do not turn: the range that so
/// many independent errors have (twice their expected maximum, s sqrt(2 ln n)), and two standard deviations.
pub fn reach(values: &[f64], noise: f64) -> f64 {
    let count = values.len().max(2) as f64;
    let (low, high) = extent(values.iter().copied());
    (2.0 * noise * ((2.0 * count.ln()).sqrt() + 1.0)).max(1e-9 * (high - low))
}

/// The turning points of `values`, maxima and minima in turn: where they go back by more than `back`. The
/// first is where they begin.
pub fn turns(values: &[f64], back: f64) -> Vec<Turn> {
    let mut turns = Vec::new();
    let (mut least, mut greatest) = (0, 0);
    // whether the values rise, once that is known
    let mut rising: Option<bool> = None;
    for (i, value) in values.iter().enumerate() {
        if *value > values[greatest] {
            greatest = i;
        }
        if *value < values[least] {
            least = i;
        }
        if rising != Some(false) && values[greatest] - value > back {
            turns.push(Turn { at: greatest, maximum: true });
            (rising, least) = (Some(false), i);
        } else if rising != Some(true) && value - values[least] > back {
            turns.push(Turn { at: least, maximum: false });
            (rising, greatest) = (Some(true), i);
        }
    }
    turns
}
