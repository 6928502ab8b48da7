//! Samples that lie off a record whose motion goes on as if they were not there.

use super::noise;
use crate::numeric::orthogonal::Orthogonal;

/// Numbers of samples from which the motion is continued: the most that follow a parabola within noise.
const WINDOWS: [usize; 3] = [9, 6, 4];

/// Coefficients of a parabola.
const TERMS: usize = 3;

/// Number of samples after one that is off within which the record comes back to the motion.
const BACK: usize = 3;

/// Standard deviations by which a sample lies off.
const OFF: f64 = 7.0;

/// Part of the deviation within which the record comes back; after an impact it deviates ever more.
const RETURNS: f64 = 0.25;

/// Which of the values at ascending times lie off, where the others have errors of standard deviation
/// `noise`.
///
/// The samples before one are continued by a parabola. If the sample is off, it lies far from the parabola,
/// and one of the next few comes back to it, which none does after an impact. The record is read in both
/// directions, since shortly after an impact a motion can be continued backward alone. Next to an impact a
/// sample is off if it is far from the motion before it and from the one after it.
pub fn outliers(times: &[f64], values: &[f64], noise: f64) -> Vec<bool> {
    let mut off = vec![false; times.len()];
    let far = read(times, values, noise, &mut off);
    let [times, values]: [Vec<f64>; 2] =
        [times.iter().rev().map(|t| -t).collect(), values.iter().rev().copied().collect()];
    off.reverse();
    let far_back = read(&times, &values, noise, &mut off);
    off.reverse();
    let both = far.iter().zip(far_back.iter().rev()).map(|(far, back)| *far && *back);
    off.iter_mut().zip(both).for_each(|(off, both)| *off |= both);
    off
}

/// Times and values without those that lie off, and a remark on these.
pub fn without_outliers(times: &[f64], values: &[f64]) -> (Vec<f64>, Vec<f64>, Option<String>) {
    let off = outliers(times, values, noise(values));
    let on = |values: &[f64]| values.iter().zip(&off).filter(|(_, off)| !**off).map(|(x, _)| *x).collect();
    (on(times), on(values), remark(off.iter().filter(|off| **off).count()))
}

/// That so many samples are left out, if there are any.
pub fn remark(count: usize) -> Option<String> {
    let text = match count {
        0 => return None,
        1 => "1 sample lies off the motion around it and is left out".to_owned(),
        _ => format!("{count} samples lie off the motion around them and are left out"),
    };
    Some(text)
}

/// Sets `off` for samples from which the record comes back; returns which lie far from the motion before
/// them.
fn read(times: &[f64], values: &[f64], noise: f64, off: &mut [bool]) -> Vec<bool> {
    let lerp = |a: usize, i: usize, b: usize| {
        values[a] + (values[b] - values[a]) * (times[i] - times[a]) / (times[b] - times[a])
    };
    let mut far = vec![false; times.len()];
    let (mut before, mut at): (Vec<usize>, Vec<f64>) = Default::default();
    for i in WINDOWS[WINDOWS.len() - 1]..times.len().saturating_sub(1) {
        // a sample near the line through its neighbours is none
        if off[i] || (values[i] - lerp(i - 1, i, i + 1)).abs() < noise {
            continue;
        }
        for window in WINDOWS {
            before.clear();
            before.extend((0..i).rev().filter(|k| !off[*k]).take(window));
            if before.len() < window {
                continue;
            }
            before.reverse();
            at.clear();
            at.extend(before.iter().map(|k| times[*k]));
            let earlier: Vec<f64> = before.iter().map(|k| values[*k]).collect();
            let fit = Orthogonal::fit(&at, &earlier);
            let freedom = (window - TERMS) as f64;
            let square = fit.squared_residuals(TERMS).unwrap_or(f64::INFINITY) / freedom;
            // what is above four standard deviations of a variance is no parabola
            if square > noise * noise * (1.0 + 4.0 * (2.0 / freedom).sqrt()) {
                continue;
            }
            let apart = |k: usize| {
                let found = fit.at(times[k], TERMS);
                ((values[k] - found.value).abs(), noise * (1.0 + found.value_variance).sqrt())
            };
            let (away, error) = apart(i);
            let returns = |k: usize| {
                let (rest, error) = apart(k);
                rest < RETURNS * away && rest < OFF * error
            };
            far[i] = away > OFF * error;
            off[i] = far[i] && (i + 1..times.len()).filter(|k| !off[*k]).take(BACK).any(returns);
            break;
        }
    }
    far
}
