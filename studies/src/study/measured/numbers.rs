//! Characteristic numbers of a measured and of the computed motion.

use crate::dynamics::Model;
use crate::identify::{noise, reach};
use crate::numeric::{Turn, extent, turns};
use crate::scene::{Excitation, Quantity, Scene};
use crate::study::Table;

/// Distance from a stop below which a turning point is an impact, as a share of the distance of the stops.
const AT_STOP: f64 = 0.1;

/// A row: quantity, unit, measured, computed.
pub(super) type Row = (&'static str, &'static str, f64, f64);

/// The table of the numbers, from `times` in s, measured and computed values.
pub fn table(
    scene: &Scene,
    model: &Model,
    quantity: Quantity,
    times: &[f64],
    measured: &[f64],
    computed: &[f64],
) -> Table {
    let unit = match quantity {
        Quantity::Velocity => "m/s",
        Quantity::Acceleration => "m/s2",
        _ => "m",
    };
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let [rms_of_each, minimum, maximum] = statistics(unit, measured, computed);
    let mut rows = vec![
        ("rms_difference", unit, f64::NAN, f64::NAN),
        rms_of_each,
        ("mean", unit, mean(measured), mean(computed)),
        minimum,
        maximum,
    ];
    if quantity == Quantity::Displacement {
        rows.extend(crossing(scene, model, times, measured, computed));
        rows.extend(rebounds(model, times, measured, computed));
    }
    let apart: Vec<f64> = measured.iter().zip(computed).map(|(m, c)| c - m).collect();
    assembled(&rows, rms(&apart), rms(measured))
}

pub(super) fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

pub(super) fn statistics(unit: &'static str, measured: &[f64], computed: &[f64]) -> [Row; 3] {
    let fold = |values: &[f64], of: fn(f64, f64) -> f64| values.iter().copied().fold(f64::NAN, of);
    let both = |name, of: &dyn Fn(&[f64]) -> f64| (name, unit, of(measured), of(computed));
    [
        both("rms", &rms),
        both("minimum", &|values| fold(values, f64::min)),
        both("maximum", &|values| fold(values, f64::max)),
    ]
}

/// The table of these rows; `rms_difference` and the largest difference are in percent of the RMS measured.
pub(super) fn assembled(rows: &[Row], rms_difference: f64, of_measured: f64) -> Table {
    let difference = |row: &Row| if row.0 == "rms_difference" { rms_difference } else { row.3 - row.2 };
    let in_percent = |row: &Row| {
        let of_rms = matches!(row.0, "rms_difference" | "largest_difference");
        percent(difference(row), if of_rms { of_measured } else { row.2.abs() })
    };
    Table::new()
        .each("quantity", rows, |row| row.0)
        .each("unit", rows, |row| row.1)
        .each("measured", rows, |row| row.2)
        .each("computed", rows, |row| row.3)
        .each("difference", rows, difference)
        .each("difference_percent", rows, in_percent)
}

/// A difference in percent of a size; NaN, which is an empty cell, of 0.
pub(super) fn percent(difference: f64, of: f64) -> f64 {
    let percent = 100.0 * difference / of;
    if percent.is_finite() { percent } else { f64::NAN }
}

/// Displacement in m at which a crossing counts, as in a summary; `None` without a barrier.
fn barrier(model: &Model) -> Option<f64> {
    model.crossing_level().filter(|_| model.mechanism().landscape.barrier.is_some())
}

/// The first crossing of the barrier: its time and, for an amplitude ramp, its amplitude.
fn crossing(scene: &Scene, model: &Model, times: &[f64], measured: &[f64], computed: &[f64]) -> Vec<Row> {
    let Some(barrier) = barrier(model) else { return Vec::new() };
    let back = 0.5 * reach(measured, noise(measured));
    let first = |values: &[f64]| -> f64 {
        let clear = |x: &f64| (x - barrier).abs() > back;
        let Some(begin) = values.iter().position(clear) else { return f64::NAN };
        let right = values[begin] > barrier;
        let over = |x: &f64| if right { barrier - x > back } else { x - barrier > back };
        let Some(end) = values.iter().skip(begin).position(over).map(|k| begin + k) else { return f64::NAN };
        let across = |k: &usize| (values[*k] > barrier) == right;
        let last = (begin..end).rev().find(across).unwrap_or(begin);
        let share = (barrier - values[last]) / (values[last + 1] - values[last]);
        times[last] + share * (times[last + 1] - times[last])
    };
    let (measured_at, computed_at) = (first(measured), first(computed));
    let mut rows = vec![("first_crossing", "s", measured_at, computed_at)];
    if let Excitation::AmplitudeRamp { from_g, to_g, over_s, .. } = scene.excitation {
        let amplitude =
            |t: f64| if t.is_nan() { t } else { from_g + (to_g - from_g) * (t / over_s).min(1.0) };
        rows.push(("first_crossing_amplitude", "g", amplitude(measured_at), amplitude(computed_at)));
    }
    rows
}

struct Rebound {
    /// Time of the impact in s.
    t: f64,
    height: f64,
}

/// Heights of the first rebound from each stop after a motion from the other side of the barrier. Each
/// measured one is compared with the computed one nearest in time.
fn rebounds(model: &Model, times: &[f64], measured: &[f64], computed: &[f64]) -> Vec<Row> {
    let Some(stops) = model.stops() else { return Vec::new() };
    let sides = [stops.left.map(|stop| stop.x), stops.right.map(|stop| stop.x)];
    let room = match sides {
        [Some(left), Some(right)] => right - left,
        _ => {
            let (low, high) = extent(measured.iter().copied());
            high - low
        }
    };
    let barrier = barrier(model);
    let back = reach(measured, noise(measured));
    let found = |values: &[f64], stop: f64, right: bool| -> Vec<Rebound> {
        let all = turns(values, back);
        let rebound = |three: &[Turn]| {
            let [from, at, to] = [0, 1, 2].map(|k| values[three[k].at]);
            let beside = |x: f64| barrier.is_none_or(|barrier| (x > barrier) == right);
            let arrives = barrier.is_none() || !beside(from);
            let strikes = three[1].maximum == right && (at - stop).abs() < AT_STOP * room;
            let counts = arrives && strikes && beside(to);
            counts.then(|| Rebound { t: times[three[1].at], height: (at - to).abs() })
        };
        all.windows(3).filter_map(rebound).collect()
    };
    let mut rows = Vec::new();
    let names = [
        ["rebounds_left", "rebound_height_left", "rebound_height_left_worst"],
        ["rebounds_right", "rebound_height_right", "rebound_height_right_worst"],
    ];
    for ((stop, right), [count, height, worst]) in sides.into_iter().zip([false, true]).zip(names) {
        let Some(stop) = stop else { continue };
        let (seen, expected) = (found(measured, stop, right), found(computed, stop, right));
        let pairs = paired(&seen, &expected);
        let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / pairs.len() as f64;
        rows.push((count, "", seen.len() as f64, expected.len() as f64));
        rows.push((height, "m", mean(|pair| pair.0), mean(|pair| pair.1)));
        let error = |pair: &&(f64, f64)| (pair.1 / pair.0 - 1.0).abs();
        let largest = pairs.iter().max_by(|a, b| error(a).total_cmp(&error(b)));
        let (seen, expected) = largest.copied().unwrap_or((f64::NAN, f64::NAN));
        rows.push((worst, "m", seen, expected));
    }
    rows
}

/// Pairs of heights of the rebounds nearest in time, if nearer than half the shortest measured interval.
fn paired(measured: &[Rebound], computed: &[Rebound]) -> Vec<(f64, f64)> {
    let apart = measured.windows(2).map(|pair| pair[1].t - pair[0].t).fold(f64::INFINITY, f64::min);
    let partner = |rebound: &Rebound| {
        let far = |other: &Rebound| (other.t - rebound.t).abs();
        let nearest = computed.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
        (far(nearest) < 0.5 * apart).then_some((rebound.height, nearest.height))
    };
    measured.iter().filter_map(partner).collect()
}
