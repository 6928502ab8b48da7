//! Turning points of a free decay, each fitted to the samples around it, with their weights.

use std::f64::consts::{FRAC_PI_4, TAU};
use std::ops::Range;

use nalgebra::SVector;

use super::{Turn, Unidentified, median};
use crate::numeric::regression::{Fit, least_squares};
use crate::numeric::{Envelope, MIN_TURNS, TurningPoint, elementary, short};

/// Share of a period on each side of a turning point over which it is fitted.
const REACH: f64 = 0.125;

/// Relative fall of a cosine within that reach of its turning point.
const DEPTH: f64 = 0.1464;

/// Share of the reach within which an oscillation must fall by [`DEPTH`] for a narrower fit.
const NARROW: f64 = 0.75;

/// Number of standard deviations of the noise that this fall must exceed for its width to be measured.
const CLEAR: f64 = 6.0;

/// Number of widths around a turning point whose median is used.
const WIDTHS: usize = 5;
/// Number of periods and curvatures on each side of a turning point whose median is used.
const NEIGHBOURS: usize = 3;

/// Number of standard errors by which the median curvature must differ from that of a cosine to replace it.
const DIFFERENT: f64 = 2.0;

/// Number of turning points on each side from which the time of one is computed.
const AROUND: usize = 8;

/// Range of the duration of an oscillation, relative to those around it.
const EVEN: std::ops::RangeInclusive<f64> = 0.6..=1.6;
/// Largest shift of the centre within a period, as a share of the oscillation.
const MOVED: f64 = 0.25;

/// Smallest number of samples of a fit.
pub const MIN_SAMPLES: usize = 5;
/// Smallest number of samples of a fit with the second harmonic.
const MIN_SAMPLES_OF_HARMONICS: usize = 9;

/// Number of passes: the times and the decay follow from the fits of the pass before.
const PASSES: usize = 4;

/// A turning point, fitted.
#[derive(Debug, Clone)]
pub struct Peak {
    /// Its number in the record.
    pub number: f64,
    /// Its value at the time that was computed from its neighbours, and the weight of the value.
    pub point: TurningPoint,
    /// Its time from its own fit, and the weight of this time: one over the variance, in any unit.
    pub found: (f64, f64),
    period: f64,
    /// Share of the usual reach over which it is fitted.
    narrow: f64,
}

/// Fit to the samples around a turning point.
struct Local {
    value: f64,
    slope: f64,
    curvature: f64,
    /// Variances of the three where the samples have errors of variance 1.
    value_variance: f64,
    slope_variance: f64,
    curvature_variance: f64,
    /// Variance of the samples about the fit, and its degrees of freedom.
    variance: f64,
    freedom: usize,
}

/// The fitted turning points `turns` of a decay, and the time from which on they have too few samples, if
/// any. `noise` is the standard deviation of the values.
///
/// Each is the extremum of a decaying oscillation about its own centre, with the second harmonic if there are
/// enough samples. It is fitted by least squares over an eighth of the period on each side, or less if the
/// oscillation turns faster than a cosine, as beyond a kink of the force. The times are then smoothed by a
/// straight line through about sixteen of them, and the value is taken at the smoothed time: the extremum of
/// a noisy curve is biased outward, whereas the value at a nearly independent time is not.
///
/// The variance of each value follows from that of the samples, which has a constant part and a part that
/// grows with the square of the amplitude, due to errors of the times; both are estimated from the residuals
/// of the fits.
pub fn peaks(
    times: &[f64],
    values: &[f64],
    turns: &[Turn],
    noise: f64,
) -> Result<(Vec<Peak>, Option<f64>), Unidentified> {
    let rough: Vec<f64> = turns.iter().map(|turn| times[turn.at]).collect();
    let periods = periods(&rough)?;
    stays(&rough, &turns.iter().map(|turn| values[turn.at]).collect::<Vec<_>>())?;
    let narrow = narrow(times, values, turns, &periods, noise);
    let peak = |k: usize| Peak {
        number: k as f64,
        point: TurningPoint { t: rough[k], value: f64::NAN, maximum: turns[k].maximum, weight: 1.0 },
        found: (rough[k], 1.0),
        period: periods[k],
        narrow: narrow[k],
    };
    let mut peaks: Vec<Peak> = (0..turns.len()).map(peak).collect();
    let (mut rate, mut sparse) = (0.0, None);
    for pass in 0..PASSES {
        let mut fits = Vec::with_capacity(peaks.len());
        let mut kept = Vec::with_capacity(peaks.len());
        for peak in peaks {
            match local(times, values, &peak, rate) {
                Ok(Some(fit)) => {
                    fits.push(fit);
                    kept.push(peak);
                }
                // the times change slightly from pass to pass, which must not end the record early
                Err(samples) if pass == 0 => {
                    sparse = Some((peak.point.t, samples));
                    break;
                }
                _ => {}
            }
        }
        peaks = kept;
        if peaks.len() < MIN_TURNS {
            let few = Unidentified::FewSwings { found: peaks.len(), noise: short(noise) };
            let too_few = |(at, samples)| Unidentified::Sparse(short(at), samples);
            return Err(sparse.map_or(few, too_few));
        }
        peaks.iter_mut().zip(&fits).for_each(|(peak, fit)| peak.point.value = fit.value);
        rate = weigh(&mut peaks, &fits)?;
        smooth(&mut peaks);
    }
    Ok((peaks, sparse.map(|(at, _)| at)))
}

/// The period about each turning point: the median of those around, each from the turn before to that after.
fn periods(times: &[f64]) -> Result<Vec<f64>, Unidentified> {
    let lengths: Vec<f64> = times.windows(3).map(|turns| turns[2] - turns[0]).collect();
    let usual: Vec<f64> = (0..lengths.len()).map(|k| around(&lengths, k)).collect();
    let even = |k: &usize| EVEN.contains(&(lengths[*k] / usual[*k]));
    match (0..lengths.len()).find(|k| !even(k)) {
        None => Ok((0..times.len()).map(|k| usual[k.saturating_sub(1).min(usual.len() - 1)]).collect()),
        Some(k) => Err(Unidentified::Uneven(short(times[k]), short(lengths[k]), short(usual[k]))),
    }
}

fn around(values: &[f64], k: usize) -> f64 {
    let near = k.saturating_sub(NEIGHBOURS)..(k + NEIGHBOURS + 1).min(values.len());
    median(values[near].to_vec()).unwrap_or(f64::NAN)
}

fn within(times: &[f64], from: f64, to: f64) -> Range<usize> {
    times.partition_point(|t| *t < from)..times.partition_point(|t| *t <= to)
}

/// Checks that the swings stay about one place, as they do in one well.
fn stays(times: &[f64], values: &[f64]) -> Result<(), Unidentified> {
    let middles: Vec<f64> =
        values.windows(3).map(|turns| 0.25 * (turns[0] + turns[2]) + 0.5 * turns[1]).collect();
    let moved =
        |k: &usize| (middles[*k + 2] - middles[*k]).abs() > MOVED * (values[*k + 1] - values[*k]).abs();
    match (0..middles.len().saturating_sub(2)).find(moved) {
        None => Ok(()),
        Some(k) => Err(Unidentified::Moved(short(times[k]))),
    }
}

/// The part of the usual reach over which each turning point is fitted.
fn narrow(times: &[f64], values: &[f64], turns: &[Turn], periods: &[f64], noise: f64) -> Vec<f64> {
    let swing = |k: usize| (values[turns[k + 1].at] - values[turns[k].at]).abs();
    let width = |k: usize| -> Option<f64> {
        let last = turns.len() - 1;
        let depth = DEPTH * swing(k.saturating_sub(1)).min(swing(k.min(last - 1)));
        let (value, t, reach) = (values[turns[k].at], times[turns[k].at], 2.0 * REACH * periods[k]);
        let range = within(times, t - reach, t + reach);
        let inside = t - reach >= times[0] && t + reach <= times[times.len() - 1];
        if !inside || range.len() < 2 || depth < CLEAR * noise {
            return None;
        }
        let step = (times[range.end - 1] - times[range.start]) / (range.len() - 1) as f64;
        let near = values[range].iter().filter(|other| (value - **other).abs() <= depth).count();
        Some(near as f64 * step / reach)
    };
    let widths: Vec<Option<f64>> = (0..turns.len()).map(width).collect();
    let mut narrow = vec![1.0; turns.len()];
    for first in [0, 1] {
        let known: Vec<(usize, f64)> =
            (first..turns.len()).step_by(2).filter_map(|k| Some((k, widths[k]?))).collect();
        for k in (first..turns.len()).step_by(2) {
            let at = known.partition_point(|width| width.0 < k);
            let begin = at.saturating_sub(WIDTHS / 2).min(known.len().saturating_sub(WIDTHS));
            let near = &known[begin..(begin + WIDTHS).min(known.len())];
            let usual = median(near.iter().map(|width| width.1).collect()).unwrap_or(1.0);
            narrow[k] = if usual > NARROW { 1.0 } else { usual };
        }
    }
    narrow
}

/// The fit to the samples around a turning point; `None` if the record does not reach far enough on both
/// sides. The error is the number of samples, if they are too few.
fn local(times: &[f64], values: &[f64], peak: &Peak, rate: f64) -> Result<Option<Local>, usize> {
    let (centre, usual) = (peak.point.t, peak.narrow * REACH * peak.period);
    let frequency = FRAC_PI_4 / usual;
    let mut samples = 0;
    // twice as far if there are few samples
    for reach in [usual, 2.0 * usual] {
        if !(centre - reach >= times[0] && centre + reach <= times[times.len() - 1]) {
            return Ok(None);
        }
        let range = within(times, centre - reach, centre + reach);
        samples = range.len();
        let near = times[range.clone()].iter().map(|t| t - centre).zip(values[range].iter().copied());
        if samples >= MIN_SAMPLES_OF_HARMONICS {
            return Ok(swing::<5>(near, frequency, rate));
        }
        if samples >= MIN_SAMPLES {
            return Ok(swing::<3>(near, frequency, rate));
        }
    }
    Err(samples)
}

/// The oscillation of a circular frequency w and a rate of decay r, and with five terms its second harmonic
/// as well, that fits values over times, as seen at time 0.
///
/// With z = e^((-r + iw)t) the terms are 1, s = Im z, c = Re (1 - z), and the parts of (1 - z)^2 of higher
/// order in t: c s and s^2 - c^2 - 2 c + (2 r/w) s. So they are about as independent as powers of t.
fn swing<const N: usize>(samples: impl Iterator<Item = (f64, f64)>, w: f64, r: f64) -> Option<Local> {
    let terms = |t: f64| {
        let (left, (sine, cosine)) = (elementary::exp(-r * t), elementary::sin_cos(w * t));
        let (s, c) = (left * sine, 1.0 - left * cosine);
        [1.0, s, c, c * s, s * s - c * c - 2.0 * c + 2.0 * r / w * s]
    };
    let rows: Vec<([f64; N], f64)> =
        samples.map(|(t, value)| (std::array::from_fn(|k| terms(t)[k]), value)).collect();
    let fit: Fit<N> = least_squares(&rows)?;
    let [slopes, curvatures] =
        [[0.0, w, r, 0.0, 0.0], [0.0, -2.0 * r * w, w * w - r * r, 2.0 * r * w, -4.0 * r * r]]
            .map(|of_terms| SVector::<f64, N>::from_fn(|k, _| of_terms[k]));
    Some(Local {
        value: fit.coefficients[0],
        slope: slopes.dot(&fit.coefficients),
        curvature: curvatures.dot(&fit.coefficients),
        value_variance: fit.inverse[(0, 0)],
        slope_variance: (slopes.transpose() * fit.inverse * slopes)[0],
        curvature_variance: (curvatures.transpose() * fit.inverse * curvatures)[0],
        variance: fit.variance,
        freedom: fit.freedom,
    })
}

/// Sets the weights of the turning points and the times from their fits; returns the rate of decay.
fn weigh(peaks: &mut [Peak], fits: &[Local]) -> Result<f64, Unidentified> {
    let envelope = |peaks: &[Peak]| {
        Envelope::fit(&peaks.iter().map(|peak| peak.point).collect::<Vec<_>>()).ok_or(Unidentified::NoDecay)
    };
    let sizes = |envelope: &Envelope, peaks: &[Peak]| -> Vec<f64> {
        peaks.iter().map(|peak| envelope.at(peak.point.t).1).collect()
    };
    let first = envelope(peaks)?;
    let variances = variances(fits, &sizes(&first, peaks));
    let weights: Vec<f64> =
        fits.iter().zip(&variances).map(|(fit, variance)| 1.0 / (fit.value_variance * variance)).collect();
    let mean = weights.iter().sum::<f64>() / weights.len() as f64;
    peaks.iter_mut().zip(&weights).for_each(|(peak, weight)| peak.point.weight = weight / mean);
    let envelope = envelope(peaks)?;
    let sizes = sizes(&envelope, peaks);
    // the relative curvature is that of a cosine, or the median of the neighbours if that clearly differs; a
    // noisy curvature would make the scatter of the times too small or too large
    let side = |k: usize| if peaks[k].point.maximum { 1.0 } else { -1.0 };
    let bend = |k: usize| -side(k) * fits[k].curvature / sizes[k];
    let mut curvatures = vec![0.0; peaks.len()];
    for maximum in [false, true] {
        let same: Vec<usize> = (0..peaks.len()).filter(|k| peaks[*k].point.maximum == maximum).collect();
        let bends: Vec<f64> = same.iter().map(|k| bend(*k)).collect();
        for (i, k) in same.iter().copied().enumerate() {
            let (usual, cosine) = (around(&bends, i), (TAU / peaks[k].period).powi(2));
            let error = (fits[k].curvature_variance * variances[k]).sqrt() / sizes[k];
            let differs = (usual - cosine).abs() > DIFFERENT * error;
            curvatures[k] = sizes[k] * if differs { usual } else { cosine };
        }
    }
    let late = |k: usize| side(k) * fits[k].slope / curvatures[k];
    let found: Vec<(f64, f64)> = (0..peaks.len())
        .map(|k| {
            (peaks[k].point.t + late(k), curvatures[k].powi(2) / (fits[k].slope_variance * variances[k]))
        })
        .collect();
    let mean = found.iter().map(|found| found.1).sum::<f64>() / found.len() as f64;
    if !mean.is_finite() {
        return Err(Unidentified::NoDecay);
    }
    peaks.iter_mut().zip(found).for_each(|(peak, (t, weight))| peak.found = (t, weight / mean));
    Ok(envelope.rate)
}

/// The variance of a sample near each turning point: a + b size^2 with a and b of 0 or more, which follow the
/// residuals of the fits best, each counted by its degrees of freedom.
fn variances(fits: &[Local], sizes: &[f64]) -> Vec<f64> {
    let largest = sizes.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let squares: Vec<f64> = sizes.iter().map(|size| (size / largest).powi(2)).collect();
    let far = fits.iter().map(|fit| fit.value.abs()).fold(0.0, f64::max);
    // below this a residual is rounding
    let rounding = (1e-13 * far).powi(2).max(f64::MIN_POSITIVE);
    let mut variances = vec![1.0; fits.len()];
    for _ in 0..PASSES {
        let mut sums = [0.0; 5];
        let scale = variances.iter().copied().fold(0.0, f64::max);
        for ((fit, square), variance) in fits.iter().zip(&squares).zip(&variances) {
            let count = fit.freedom as f64 * (scale / variance).powi(2);
            let terms = [1.0, *square, square * square, fit.variance, fit.variance * square];
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += count * term);
        }
        let [n, x, xx, y, xy] = sums;
        let slope = (n * xy - x * y) / (n * xx - x * x);
        let (constant, slope) = match (y - slope * x) / n {
            _ if !(slope > 0.0) => (y / n, 0.0),
            constant if constant > 0.0 => (constant, slope),
            _ => (0.0, xy / xx),
        };
        let floor = rounding.max(1e-12 * (constant + slope));
        variances = squares.iter().map(|square| (constant + slope * square).max(floor)).collect();
    }
    variances
}

/// Moves each turning point to a line through those around it, with an offset between maxima and minima.
fn smooth(peaks: &mut [Peak]) {
    let line = |k: usize| {
        let here = &peaks[k];
        let around = &peaks[k.saturating_sub(AROUND)..(k + AROUND + 1).min(peaks.len())];
        let row = |peak: &Peak| {
            let weight = peak.found.1.sqrt();
            let side = if peak.point.maximum == here.point.maximum { 0.0 } else { weight };
            ([weight, weight * (peak.number - here.number), side], weight * (peak.found.0 - here.point.t))
        };
        least_squares(&around.iter().map(row).collect::<Vec<_>>())
    };
    let lines: Vec<Option<Fit<3>>> = (0..peaks.len()).map(line).collect();
    for (peak, line) in peaks.iter_mut().zip(lines) {
        if let Some(line) = line
            && line.coefficients[1] > 0.0
        {
            peak.point.t += line.coefficients[0];
            peak.period = 2.0 * line.coefficients[1];
        }
    }
}
