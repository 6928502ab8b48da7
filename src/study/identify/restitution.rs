//! Coefficient of restitution from a bounce record, or from the times of impacts.

use std::ops::Range;

use nalgebra::SVector;

use super::turns::{Turn, noise, reach, turns};
use super::{Identified, Identity, Unidentified};
use crate::numeric::regression::{Fit, geometric, least_squares, powers, student};
use crate::study::table::{Table, Values};

/// The fewest samples on either side of an impact.
const FEWEST: usize = 6;

/// The part of the way to the next turning point over which a side is fitted.
const REACH: f64 = 0.7;

/// Samples nearest to the turning point that are left out, where the contact itself may show.
const LEFT_OUT: usize = 1;

/// An impact, fitted. SI.
struct Impact {
    t: f64,
    x: f64,
    /// The sample where the motion turns next.
    after: usize,
    right: bool,
    v_in: f64,
    v_out: f64,
    restitution: f64,
    /// Standard error, and degrees of freedom of it.
    error: f64,
    freedom: usize,
}

/// Restitution of the impacts in a record of displacement `x` in m over `times` in s.
///
/// On either side of a turning point a cubic is fitted by least squares over most of the way to the next one.
/// The two meet at the impact, where their slopes are the speeds before and after it. A turning point is an
/// impact where the slopes differ in sign, both by more than three standard errors, and their jump is more
/// than half of what the curvature makes of the slopes over the fits: the top of a flight is none. The error
/// of each ratio follows from the residuals of both fits, that of the time at which they meet included.
///
/// Rows, one an impact: `t_s,side,v_in_m_per_s,v_out_m_per_s,restitution,restitution_low,restitution_high`.
/// The one number is the mean with weights 1/error^2; where the impacts differ by more than their errors, the
/// interval is as much wider (Birge 1932).
pub fn restitution(times: &[f64], x: &[f64]) -> Result<Identified, Unidentified> {
    let all = turns(x, reach(x, noise(x)));
    let sides = |k: usize| {
        let before = if k == 0 { 0 } else { all[k - 1].at };
        let after = all.get(k + 1).map_or(x.len() - 1, |own| own.at);
        (before, after)
    };
    let fitted = (0..all.len()).filter_map(|k| impact(times, x, all[k], sides(k)));
    let impacts: Vec<Impact> = fitted.collect();
    if impacts.is_empty() {
        return Err(Unidentified::NoImpact { least: FEWEST });
    }
    let half = |own: &Impact| student(own.freedom) * own.error;
    let side = |own: &Impact| if own.right { "right" } else { "left" };
    let rows = Table::new()
        .each("t_s", &impacts, |own| own.t)
        .each("side", &impacts, side)
        .each("v_in_m_per_s", &impacts, |own| own.v_in)
        .each("v_out_m_per_s", &impacts, |own| own.v_out)
        .each("restitution", &impacts, |own| own.restitution)
        .each("restitution_low", &impacts, |own| own.restitution - half(own))
        .each("restitution_high", &impacts, |own| own.restitution + half(own));
    let mut summary = vec![mean("restitution", &impacts.iter().collect::<Vec<_>>()).0];
    let mut remarks = Vec::new();
    for (name, right) in [("restitution_left", false), ("restitution_right", true)] {
        let own: Vec<&Impact> = impacts.iter().filter(|own| own.right == right).collect();
        if !own.is_empty() && own.len() < impacts.len() {
            summary.push(mean(name, &own).0);
        }
    }
    if mean("restitution", &impacts.iter().collect::<Vec<_>>()).1 > 2.0 {
        remarks.push(
            "the impacts differ by more than their intervals: the restitution depends on speed, side or what \
             else the rows show, and the one number is a mean"
                .to_owned(),
        );
    }
    let fitted = Table::new()
        .each("t_s", &impacts, |own| own.t)
        .each("x_m", &impacts, |own| own.x)
        .each("rebound_t_s", &impacts, |own| times[own.after])
        .each("rebound_x_m", &impacts, |own| x[own.after]);
    Ok(Identified { rows, fitted, summary, remarks })
}

/// The impact at a turning point between two others; none where it is smooth, or has too few samples.
fn impact(times: &[f64], x: &[f64], turn: Turn, (before, after): (usize, usize)) -> Option<Impact> {
    let at = times[turn.at];
    let from = at - REACH * (at - times[before]);
    let to = at + REACH * (times[after] - at);
    let left = times.partition_point(|t| *t < from)..turn.at.saturating_sub(LEFT_OUT);
    let right = turn.at + 1 + LEFT_OUT..times.partition_point(|t| *t <= to);
    if left.len() < FEWEST || right.len() < FEWEST {
        return None;
    }
    let near = times[right.start] - times[left.end - 1];
    let scale = (at - from).max(to - at);
    let side = |range: Range<usize>, centre: f64| -> Option<Fit<4>> {
        let rows: Vec<([f64; 4], f64)> = range.map(|i| (powers((times[i] - centre) / scale), x[i])).collect();
        least_squares(&rows)
    };
    // where the two meet, found from fits about it
    let mut centre = at;
    for _ in 0..3 {
        let (one, other) = (side(left.clone(), centre)?, side(right.clone(), centre)?);
        let apart = one.coefficients - other.coefficients;
        let step = -apart[0] / apart[1] * scale;
        if !step.is_finite() {
            return None;
        }
        centre = (centre + step).clamp(at - near, at + near);
    }
    let (one, other) = (side(left.clone(), centre)?, side(right.clone(), centre)?);
    let [_, v_in, bend_in, _] = one.coefficients.into();
    let [_, v_out, bend_out, _] = other.coefficients.into();
    let slope = SVector::<f64, 4>::new(0.0, 1.0, 0.0, 0.0);
    let clear = |fit: &Fit<4>, v: f64| v.abs() > 3.0 * fit.form(&slope).1;
    let smooth = |bend: f64, reach: f64| (2.0 * bend * reach / scale).abs();
    let jump = (v_in - v_out).abs();
    let towards = if turn.maximum { v_in > 0.0 && v_out < 0.0 } else { v_in < 0.0 && v_out > 0.0 };
    let kinked = jump > 0.5 * (smooth(bend_in, at - from) + smooth(bend_out, to - at));
    if !(towards && kinked && clear(&one, v_in) && clear(&other, v_out)) {
        return None;
    }
    let ratio = -v_out / v_in;
    // e = -v_out/v_in at the time where the fits meet, to first order in all coefficients
    let late = 2.0 * (bend_out + ratio * bend_in) / (v_in - v_out) / v_in;
    let of_one = SVector::<f64, 4>::new(late, -ratio / v_in, 0.0, 0.0);
    let of_other = SVector::<f64, 4>::new(-late, -1.0 / v_in, 0.0, 0.0);
    let (a, b) = (one.form(&of_one).1.powi(2), other.form(&of_other).1.powi(2));
    // Welch 1947, Satterthwaite 1946
    let freedom = (a + b).powi(2) / (a * a / one.freedom as f64 + b * b / other.freedom as f64);
    Some(Impact {
        t: centre,
        x: one.coefficients[0],
        after,
        right: turn.maximum,
        v_in: v_in / scale,
        v_out: v_out / scale,
        restitution: ratio,
        error: (a + b).sqrt(),
        freedom: if freedom.is_finite() { freedom as usize } else { one.freedom },
    })
}

/// The weighted mean, and the Birge ratio.
fn mean(name: &'static str, impacts: &[&Impact]) -> (Identity, f64) {
    // below this an error is rounding
    let weight = |own: &&Impact| own.error.max(1e-13 * own.restitution.abs()).powi(-2);
    let total: f64 = impacts.iter().map(weight).sum();
    let mean = impacts.iter().map(|own| weight(own) * own.restitution).sum::<f64>() / total;
    let square: f64 = impacts.iter().map(|own| weight(own) * (own.restitution - mean).powi(2)).sum();
    let others = impacts.len() - 1;
    let birge = if others > 0 { (square / others as f64).sqrt() } else { 1.0 };
    let freedom: usize = impacts.iter().map(|own| own.freedom).sum();
    let spread = if birge > 1.0 { birge * student(others) } else { student(freedom) };
    (Identity::new(name, mean, spread / total.sqrt()), birge)
}

/// Restitution of the impacts at these `times` in s of a body that bounces on one stop under a constant
/// acceleration: then each flight is as much shorter than the one before, and the times follow
/// c + a e^k, which is fitted by least squares.
///
/// Rows, one for each impact between two flights: `t_s,restitution,restitution_low,restitution_high`.
pub fn restitution_of_times(times: &[f64]) -> Result<Identified, Unidentified> {
    let none = |why| Unidentified::NoBounces(times.len(), why);
    let law = geometric(times).ok_or_else(|| none("give more, or such as lie between bounces alone"))?;
    let e = law.coefficients[2];
    if !(e > 0.0 && law.coefficients[1] < 0.0) {
        return Err(none("the flights do not become shorter; give such as lie between bounces alone"));
    }
    let misfit =
        |(k, t): (usize, &f64)| (t - law.coefficients[0] - law.coefficients[1] * e.powi(k as i32)).powi(2);
    let noise = (times.iter().enumerate().map(misfit).sum::<f64>() / law.freedom as f64).sqrt();
    let row = |own: &[f64]| {
        let flight = own[1] - own[0];
        let ratio = (own[2] - own[1]) / flight;
        let error = noise / flight * (1.0 + ratio.powi(2) + (1.0 + ratio).powi(2)).sqrt();
        [own[1], ratio, student(law.freedom) * error]
    };
    let rows: Vec<[f64; 3]> = times.windows(3).map(row).collect();
    let rows = Table::new()
        .each("t_s", &rows, |own| own[0])
        .with("restitution", rows.iter().map(|own| own[1]).collect::<Values>())
        .each("restitution_low", &rows, |own| own[1] - own[2])
        .each("restitution_high", &rows, |own| own[1] + own[2]);
    let half = student(law.freedom) * law.covariance[(2, 2)].sqrt();
    let remarks = vec![
        "of impact times: the ratio of successive flights, which is the restitution where the acceleration \
         of the flights is constant"
            .to_owned(),
    ];
    let summary = vec![Identity::new("restitution", e, half)];
    Ok(Identified { rows, fitted: Table::new(), summary, remarks })
}
