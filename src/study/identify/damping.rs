//! Damping ratio from a free decay, by the logarithmic decrement.

use std::f64::consts::PI;

use super::turns::{noise, reach, turns};
use super::{Identified, Identity, Unidentified};
use crate::numeric::regression::{Fit, geometric, least_squares, powers, student};
use crate::numeric::short;
use crate::scene::Channel;
use crate::study::table::{Table, Values};

/// The fewest turning points of a decay: three numbers are fitted to them.
const FEWEST: usize = 6;

/// Pieces of the line that is drawn as an envelope.
const ENVELOPE: u32 = 400;

/// Turning points in a row of the table.
const GROUP: usize = 8;

/// The part of a period on either side of a turning point over which it is fitted.
const REACH: f64 = 0.125;

/// Swings count down to this many times the reach of the noise.
const CLEAR: f64 = 1.5;

/// Turning points on either side from which the time of one follows.
const AROUND: usize = 8;

/// The fewest samples of such a fit, and of one of degree 4.
const FEWEST_SAMPLES: usize = 5;
const FEWEST_OF_DEGREE_4: usize = 9;

/// A turning point, fitted.
struct Peak {
    t: f64,
    value: f64,
    /// Its distance from the rest position: the error of its time is in inverse proportion to it.
    size: f64,
}

/// Damping ratio and frequency of a free decay, over the whole record and as they change with the amplitude.
///
/// Each turning point is the extreme of a polynomial of degree 4 (of degree 2 where samples are few) that is
/// fitted by least squares over an eighth of a period on either side. The turning points follow
/// c + a q^k, where -ln(-q) is half the logarithmic decrement: the damping ratio is d/sqrt(pi^2 + d^2) with
/// d = -ln(-q). The law is fitted by least squares to the turning points themselves, so that those lost in
/// noise count for little, and the rest position c need not be known. Intervals are 95 %, from the scatter
/// of the turning points about the law.
///
/// Begins at the largest swing of the record. Rows: `turns,from_s,to_s,amplitude,damping_ratio,
/// damping_ratio_low,damping_ratio_high,frequency_hz,frequency_low_hz,frequency_high_hz`, each of some eight
/// turning points in order of time; the amplitude has the ending of the channel's unit.
pub fn damping(times: &[f64], channel: &Channel) -> Result<Identified, Unidentified> {
    let values = &channel.values;
    let noise = noise(values);
    let back = reach(values, noise);
    let all = turns(values, back);
    let few = |found: usize| Unidentified::FewSwings { found, least: FEWEST, noise: short(noise) };
    let swing = |k: usize| (values[all[k + 1].at] - values[all[k].at]).abs();
    let swings = all.len().saturating_sub(1);
    let largest = (0..swings).max_by(|a, b| swing(*a).total_cmp(&swing(*b))).unwrap_or(0);
    // a swing near the reach of the noise may be missed, and would be counted as half of a long one
    let clear = (largest..swings).take_while(|k| swing(*k) > CLEAR * back).count();
    let raw: Vec<f64> = all.iter().skip(largest).take(clear + 1).map(|turn| times[turn.at]).collect();
    if raw.len() < FEWEST {
        return Err(few(raw.len()));
    }
    let period = even_period(&raw)?;
    let reach = REACH * period;
    let mut peaks = Vec::with_capacity(raw.len());
    for near in raw {
        peaks.extend(turn_near(times, values, near, reach)?);
    }
    if peaks.len() < FEWEST {
        return Err(few(peaks.len()));
    }
    let law =
        geometric(&peaks.iter().map(|own| own.value).collect::<Vec<_>>()).ok_or(Unidentified::NoDecay)?;
    for (k, peak) in peaks.iter_mut().enumerate() {
        peak.size = (law.coefficients[1] * law.coefficients[2].powi(k as i32)).abs();
    }
    at_smooth_times(times, values, &mut peaks, reach)?;
    let whole = Decay::of(&peaks).ok_or(Unidentified::NoDecay)?;
    let groups = (peaks.len() / GROUP).max(1);
    let group = |i: usize| {
        let end = if i + 1 == groups { peaks.len() } else { (i + 1) * GROUP };
        Decay::of(&peaks[i * GROUP..end])
    };
    let rows: Vec<Decay> = (0..groups).filter_map(group).collect();
    let mut remarks = Vec::new();
    let amplitudes = rows.first().zip(rows.last()).map(|(first, last)| (first.amplitude, last.amplitude));
    if let Some((first, last)) = amplitudes {
        let (unit, of) = (channel.quantity.ending().replace("_per_", "/"), channel.quantity.name());
        remarks.push(format!(
            "the rows go from an amplitude of {} to one of {} {} ({of})",
            short(first),
            short(last),
            unit.trim_start_matches('_')
        ));
    }
    if differ(&rows, whole.ratio.value) {
        remarks.push(
            "the ratio changes with the amplitude by more than its intervals: the number for all is a mean"
                .to_owned(),
        );
    }
    let natural = (1.0 - whole.ratio.value.powi(2)).sqrt();
    let scaled = |own: f64| own / natural;
    let (low, high) = whole.frequency.interval;
    let natural = Identity {
        name: "natural_frequency_hz",
        value: scaled(whole.frequency.value),
        interval: (scaled(low), scaled(high)),
    };
    let table = table(&rows, &format!("amplitude{}", channel.quantity.ending()));
    Ok(Identified {
        rows: table,
        fitted: whole.envelope(),
        summary: vec![whole.ratio, whole.frequency, natural],
        remarks,
    })
}

/// The period of turning points, which are half of one apart.
fn even_period(turns: &[f64]) -> Result<f64, Unidentified> {
    let mut lengths: Vec<f64> = turns.windows(3).map(|own| own[2] - own[0]).collect();
    let uneven = lengths.clone();
    let middle = lengths.len() / 2;
    let usual = *lengths.select_nth_unstable_by(middle, f64::total_cmp).1;
    match uneven.iter().position(|own| !(0.6 * usual..=1.6 * usual).contains(own)) {
        None => Ok(usual),
        Some(k) => {
            Err(Unidentified::Uneven { at: short(turns[k]), own: short(uneven[k]), usual: short(usual) })
        }
    }
}

/// The polynomial in (t - `centre`)/`reach` through the samples up to `reach` away; none where the record
/// does not reach so far on both sides.
fn polynomial(
    times: &[f64],
    values: &[f64],
    centre: f64,
    reach: f64,
) -> Result<Option<Vec<f64>>, Unidentified> {
    if centre - reach < times[0] || centre + reach > times[times.len() - 1] {
        return Ok(None);
    }
    let range =
        times.partition_point(|t| *t < centre - reach)..times.partition_point(|t| *t <= centre + reach);
    let samples = range.len();
    let u = |i: usize| (times[i] - centre) / reach;
    let found: Option<Vec<f64>> = if samples >= FEWEST_OF_DEGREE_4 {
        let rows: Vec<([f64; 5], f64)> = range.map(|i| (powers(u(i)), values[i])).collect();
        least_squares(&rows).map(|fit| fit.coefficients.iter().copied().collect())
    } else if samples >= FEWEST_SAMPLES {
        let rows: Vec<([f64; 3], f64)> = range.map(|i| (powers(u(i)), values[i])).collect();
        least_squares(&rows).map(|fit| fit.coefficients.iter().copied().collect())
    } else {
        None
    };
    let sparse = Unidentified::Sparse { at: short(centre), samples, least: FEWEST_SAMPLES };
    found.map(Some).ok_or(sparse)
}

/// The turning point near a time, where the record reaches far enough on both sides.
fn turn_near(times: &[f64], values: &[f64], near: f64, reach: f64) -> Result<Option<Peak>, Unidentified> {
    let mut centre = near;
    let mut value = f64::NAN;
    for _ in 0..3 {
        let Some(fit) = polynomial(times, values, centre, reach)? else { return Ok(None) };
        let sum = |of: &dyn Fn(i32, f64) -> f64| (0..).zip(&fit).map(|(k, c)| of(k, *c)).sum::<f64>();
        let mut u = 0.0_f64;
        for _ in 0..20 {
            let slope = sum(&|k, c| f64::from(k) * c * u.powi((k - 1).max(0)));
            let bend = sum(&|k, c| f64::from(k * (k - 1)) * c * u.powi((k - 2).max(0)));
            let step = slope / bend;
            u = if step.is_finite() { (u - step).clamp(-1.0, 1.0) } else { 0.0 };
        }
        centre += u * reach;
        value = sum(&|k, c| c * u.powi(k));
    }
    Ok(Some(Peak { t: centre, value, size: 0.0 }))
}

/// Reads the values anew at times that follow from the turning points around each: a straight line in their
/// number, and what sets maxima apart from minima. The extreme of a noisy curve lies too far out; the value
/// at a time that hardly depends on its own noise does not.
fn at_smooth_times(
    times: &[f64],
    values: &[f64],
    peaks: &mut [Peak],
    reach: f64,
) -> Result<(), Unidentified> {
    let parity = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -1.0 };
    let smooth = |k: usize| -> Option<f64> {
        let around = k.saturating_sub(AROUND)..(k + AROUND + 1).min(peaks.len());
        let row = |j: usize| {
            let (size, t) = (peaks[j].size, peaks[j].t - peaks[k].t);
            ([size, size * (j as f64 - k as f64), size * parity(j)], size * t)
        };
        let fit = least_squares(&around.map(row).collect::<Vec<_>>())?;
        Some(peaks[k].t + fit.coefficients[0] + parity(k) * fit.coefficients[2])
    };
    let smooth: Vec<Option<f64>> = (0..peaks.len()).map(smooth).collect();
    for (peak, t) in peaks.iter_mut().zip(smooth) {
        if let Some(t) = t
            && let Some(fit) = polynomial(times, values, t, reach)?
        {
            peak.value = fit[0];
        }
    }
    Ok(())
}

/// A decay through some turning points.
struct Decay {
    turns: usize,
    span: (f64, f64),
    /// Geometric mean of the amplitudes.
    amplitude: f64,
    ratio: Identity,
    frequency: Identity,
    /// The turning points are c + a q^k, at the times t + k times a step.
    law: [f64; 3],
    line: [f64; 2],
}

impl Decay {
    fn of(peaks: &[Peak]) -> Option<Self> {
        let law = geometric(&peaks.iter().map(|own| own.value).collect::<Vec<_>>())?;
        let [_, size, q] = law.coefficients.into();
        let rows: Vec<([f64; 2], f64)> = peaks
            .iter()
            .enumerate()
            .map(|(k, own)| ([own.size, own.size * k as f64], own.size * own.t))
            .collect();
        let line: Fit<2> = least_squares(&rows)?;
        let half = |fit_error: f64, freedom: usize| student(freedom) * fit_error;
        let of_q = |q: f64| {
            let decrement = -(-q).ln();
            decrement / PI.hypot(decrement)
        };
        let spread = half(law.covariance[(2, 2)].sqrt(), law.freedom);
        let step = line.coefficients[1];
        let late = half(line.covariance[(1, 1)].sqrt(), line.freedom);
        let decays = q < 0.0 && step > 0.0;
        decays.then(|| Self {
            turns: peaks.len(),
            span: (peaks[0].t, peaks[peaks.len() - 1].t),
            amplitude: (size * (-q).powf(0.5 * (peaks.len() - 1) as f64)).abs(),
            ratio: Identity {
                name: "damping_ratio",
                value: of_q(q),
                interval: (of_q(q - spread), of_q((q + spread).min(0.0))),
            },
            frequency: Identity {
                name: "frequency_hz",
                value: 0.5 / step,
                interval: (0.5 / (step + late), 0.5 / (step - late)),
            },
            law: law.coefficients.into(),
            line: line.coefficients.into(),
        })
    }

    /// The lines on which the maxima and the minima lie.
    fn envelope(&self) -> Table {
        let ([centre, size, q], [begin, step]) = (self.law, self.line);
        let last = self.turns.saturating_sub(1) as f64;
        let places: Vec<f64> = (0..=ENVELOPE).map(|i| last * f64::from(i) / f64::from(ENVELOPE)).collect();
        let away = |k: &f64| (size * (-q).powf(*k)).abs();
        Table::new()
            .each("t_s", &places, |k| begin + step * k)
            .each("upper", &places, |k| centre + away(k))
            .each("lower", &places, |k| centre - away(k))
    }
}

/// Whether the ratios of the rows differ from that of the whole by more than their intervals explain.
fn differ(rows: &[Decay], whole: f64) -> bool {
    let outside = |own: &&Decay| !(own.ratio.interval.0..=own.ratio.interval.1).contains(&whole);
    // of rows that agree one in twenty lies outside
    rows.iter().filter(outside).count() > 1 + rows.len() / 5
}

fn table(rows: &[Decay], amplitude: &str) -> Table {
    let turns = rows.iter().map(|own| Some(own.turns as u64)).collect();
    Table::new()
        .with("turns", Values::Counts(turns))
        .each("from_s", rows, |own| own.span.0)
        .each("to_s", rows, |own| own.span.1)
        .each(amplitude, rows, |own| own.amplitude)
        .each("damping_ratio", rows, |own| own.ratio.value)
        .each("damping_ratio_low", rows, |own| own.ratio.interval.0)
        .each("damping_ratio_high", rows, |own| own.ratio.interval.1)
        .each("frequency_hz", rows, |own| own.frequency.value)
        .each("frequency_low_hz", rows, |own| own.frequency.interval.0)
        .each("frequency_high_hz", rows, |own| own.frequency.interval.1)
}
