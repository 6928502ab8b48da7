//! Alignment of two evenly spaced records: the lag at which they differ least.

use realfft::RealFftPlanner;

/// Position of one record relative to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alignment {
    /// Number of steps by which the second record is delayed; not necessarily whole.
    pub lag: f64,
    /// Whether another local minimum of the difference fits as well.
    pub ambiguous: bool,
}

/// Factor on the smallest mean square difference up to which another lag fits equally well.
const EQUAL_FIT_FACTOR: f64 = 1.05;

/// Share of the first record's mean square that is added to that limit.
const EQUAL_FIT_SHARE: f64 = 1e-4;

/// The lag of `other` against `first` with the smallest mean square difference, among lags at which at least
/// `min_overlap` values overlap. Both records are spaced by one step. Of equally good lags the smallest wins.
///
/// Method: the sum of squared differences is the sum of squares of the overlapping parts less twice the
/// correlation, which a fast Fourier transform gives for all lags at once; a parabola interpolates between
/// steps. Returns `None` if no lag has enough overlap.
pub fn alignment(first: &[f64], other: &[f64], min_overlap: usize) -> Option<Alignment> {
    let size = (first.len() + other.len()).next_power_of_two();
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(size), planner.plan_fft_inverse(size));
    let transformed = |values: &[f64]| {
        let mut values = values.to_vec();
        values.resize(size, 0.0);
        let mut lines = forward.make_output_vec();
        forward.process(&mut values, &mut lines).ok().map(|()| lines)
    };
    let mut product = transformed(first)?;
    product.iter_mut().zip(transformed(other)?).for_each(|(a, b)| *a *= b.conj());
    // the first and the last line are real; rounding leaves an imaginary part
    let last = product.len() - 1;
    (product[0].im, product[last].im) = (0.0, 0.0);
    let mut correlation = inverse.make_output_vec();
    inverse.process(&mut product, &mut correlation).ok()?;
    let squares = |values: &[f64]| {
        let mut sums = Vec::with_capacity(values.len() + 1);
        sums.push(0.0);
        values.iter().zip(0..).for_each(|(value, k)| sums.push(sums[k] + value * value));
        sums
    };
    let (first_squares, other_squares) = (squares(first), squares(other));
    let mean_square = |lag: i64| -> Option<f64> {
        let from = lag.max(0);
        let to = (first.len() as i64).min(other.len() as i64 + lag);
        let count = to - from;
        if count < min_overlap.max(1) as i64 {
            return None;
        }
        let part = |sums: &[f64], low: i64, high: i64| sums[high as usize] - sums[low as usize];
        let crossed = correlation[lag.rem_euclid(size as i64) as usize] / size as f64;
        let sum = part(&first_squares, from, to) + part(&other_squares, from - lag, to - lag) - 2.0 * crossed;
        Some(sum.max(0.0) / count as f64)
    };
    let (low, high) = (1 - other.len() as i64, first.len() as i64 - 1);
    let best = (low..=high).filter_map(mean_square).fold(f64::INFINITY, f64::min);
    let good = EQUAL_FIT_FACTOR * best + EQUAL_FIT_SHARE * first_squares[first.len()] / first.len() as f64;
    let is_minimum = |lag: &i64| {
        let is_lower =
            |here: f64| [lag - 1, lag + 1].into_iter().filter_map(mean_square).all(|near| here <= near);
        mean_square(*lag).is_some_and(|here| here <= good && is_lower(here))
    };
    let minima: Vec<i64> = (low..=high).filter(is_minimum).collect();
    let lag = minima.iter().copied().min_by_key(|lag| lag.abs())?;
    let vertex = || {
        let (before, here, after) = (mean_square(lag - 1)?, mean_square(lag)?, mean_square(lag + 1)?);
        let step = 0.5 * (before - after) / (before - 2.0 * here + after);
        Some(step).filter(|step| step.abs() <= 1.0)
    };
    Some(Alignment { lag: lag as f64 + vertex().unwrap_or(0.0), ambiguous: minima.len() > 1 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shifted_record_is_found() {
        let signal = |t: f64| (0.2 * t).sin() * (-((t - 150.0) / 60.0).powi(2)).exp();
        let one: Vec<f64> = (0..400).map(|i| signal(f64::from(i))).collect();
        for lag in [-40.0, 0.0, 12.25, 60.0] {
            let other: Vec<f64> = (0..300).map(|i| signal(f64::from(i) + lag)).collect();
            let found = alignment(&one, &other, 100).unwrap();
            assert!((found.lag - lag).abs() < 0.02 && !found.ambiguous, "{found:?} {lag}");
        }
        let wave: Vec<f64> = (0..400).map(|i| (std::f64::consts::TAU * f64::from(i) / 50.0).sin()).collect();
        let found = alignment(&wave, &wave[20..], 200).unwrap();
        // the overlap is not a whole number of periods, so the parabola is slightly skewed
        assert!((found.lag - 20.0).abs() < 1e-3 && found.ambiguous, "{found:?}");
        assert_eq!(alignment(&wave, &wave[..10], 20), None);
    }
}
