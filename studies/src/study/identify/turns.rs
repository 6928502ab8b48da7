//! Turning points of a noisy record.

use crate::numeric::extent;
pub use crate::numeric::{Turn, turns};

/// Noise of values that vary slowly from sample to sample: the standard deviation of what is random in each.
///
/// Third differences of a smooth record vanish, those of independent errors of standard deviation s have s
/// sqrt(20); their median magnitude is insensitive to the few at impacts. Of values that stand still for many
/// samples, as those of a converter with few bits do, the least change counts.
pub fn noise(values: &[f64]) -> f64 {
    /// Median magnitude over standard deviation of normal numbers.
    const NORMAL: f64 = 0.674_489_750_196_081_7;
    let third = |window: &[f64]| (window[3] - 3.0 * window[2] + 3.0 * window[1] - window[0]).abs();
    let Some(size) = median(values.windows(4).map(third).collect()) else { return 0.0 };
    let random = size / (NORMAL * 20_f64.sqrt());
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let still = steps.clone().filter(|step| *step == 0.0).count();
    let least = steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    if 10 * still > values.len() && least.is_finite() { random.max(least) } else { random }
}

/// How far values with noise of this standard deviation go back where they do not turn: the range of as many
/// independent errors (twice their expected maximum, s sqrt(2 ln n)), and two standard deviations.
pub fn reach(values: &[f64], noise: f64) -> f64 {
    let count = values.len().max(2) as f64;
    let (low, high) = extent(values.iter().copied());
    (2.0 * noise * ((2.0 * count.ln()).sqrt() + 1.0)).max(1e-9 * (high - low))
}

/// The median of some values; the greater of two middle ones.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
