//! Force curve from a slow pull, with its hysteresis, equilibria and barrier.

use super::turns::{Turn, turns};
use super::{Identified, Identity, Unidentified};
use crate::numeric::regression::{Fit, least_squares, powers, student};
use crate::numeric::{extent, short};
use crate::study::table::{Table, Values};

/// Points of a curve where none are asked for.
pub const FORCE_POINTS: usize = 101;

/// The part of the range of positions by which a pull goes back where it turns.
const TURN: f64 = 0.1;

/// The part of the range next to a turn that is left out: friction and backlash turn there.
const LEFT_OUT: f64 = 0.01;

/// The part of the range on either side over which the curve is fitted at an equilibrium.
const REACH: f64 = 0.04;

/// Standard errors by which the force differs from 0 on both sides of an equilibrium.
const CLEAR: f64 = 3.0;

/// A number with its standard error and the degrees of freedom of that.
#[derive(Debug, Clone, Copy)]
struct Known {
    value: f64,
    error: f64,
    freedom: usize,
}

impl Known {
    fn half(self) -> f64 {
        student(self.freedom) * self.error
    }

    /// The mean of this and another.
    fn and(self, other: Self) -> Self {
        Self {
            value: 0.5 * (self.value + other.value),
            error: 0.5 * self.error.hypot(other.error),
            freedom: self.freedom + other.freedom,
        }
    }
}

/// Samples of one direction, by position. SI.
type Pull = Vec<(f64, f64)>;

/// An equilibrium of the measured curve.
struct Rest {
    x: Known,
    stiffness: Known,
}

/// The force curve of a slow pull: force `force` in N over position `x` in m, in the order in which they were
/// measured, in one direction or in both, any number of times.
///
/// The curve has `points` even positions over the range that all directions cover. At each of them a cubic
/// is fitted by least squares to the samples of one direction up to the neighbouring points. The force of the
/// curve is the mean of both directions, and half their difference the friction. At the equilibria a cubic is
/// fitted over 4 % of the range on either side. Intervals are 95 %, from the residuals of the fits.
///
/// Rows: `x_m,force_n,force_low_n,force_high_n,force_rising_n,force_falling_n`, as a table mechanism reads
/// them.
pub fn force(x: &[f64], force: &[f64], points: usize) -> Result<Identified, Unidentified> {
    let [rising, falling] = directions(x, force);
    let pulls: Vec<&Pull> = [&rising, &falling].into_iter().filter(|own| !own.is_empty()).collect();
    let ends = pulls.iter().filter_map(|own| Some((own.first()?.0, own.last()?.0)));
    let (low, high) =
        ends.fold((f64::NEG_INFINITY, f64::INFINITY), |all, own| (all.0.max(own.0), all.1.min(own.1)));
    if !(low < high && high - low < f64::INFINITY) {
        return Err(Unidentified::Still);
    }
    let points = points.max(4);
    let step = (high - low) / (points - 1) as f64;
    let grid: Vec<f64> = (0..points).map(|i| low + (high - low) * i as f64 / (points - 1) as f64).collect();
    let few = || Unidentified::FewSamples { samples: x.len(), points };
    let along = |pull: &Pull| -> Option<Vec<(Known, f64)>> {
        let at = |x: &f64| {
            let fit: Fit<4> = near(pull, *x, step)?;
            Some((known(&fit, 0, 1.0), fit.coefficients[1] / step))
        };
        grid.iter().map(at).collect()
    };
    let curves = pulls.iter().map(|pull| along(pull)).collect::<Option<Vec<_>>>().ok_or_else(few)?;
    let mean: Vec<(Known, f64)> = (0..points)
        .map(|i| match &curves[..] {
            [one, other] => (one[i].0.and(other[i].0), 0.5 * (one[i].1 + other[i].1)),
            all => all[0][i],
        })
        .collect();

    let column = |pull: &Pull, which: usize| -> Values {
        match pull.is_empty() {
            true => grid.iter().map(|_| f64::NAN).collect(),
            false => curves[which].iter().map(|own| own.0.value).collect(),
        }
    };
    let rows = Table::new()
        .with("x_m", Values::Numbers(grid.clone()))
        .each("force_n", &mean, |own| own.0.value)
        .each("force_low_n", &mean, |own| own.0.value - own.0.half())
        .each("force_high_n", &mean, |own| own.0.value + own.0.half())
        .with("force_rising_n", column(&rising, 0))
        .with("force_falling_n", column(&falling, pulls.len() - 1));

    let rests = equilibria(&grid, &mean, &pulls, REACH * (high - low));
    let mut summary = names(&rests);
    if let [left, top, right] = &rests[..]
        && top.stiffness.value < 0.0
    {
        let height = |well: &Rest| {
            let work = work(&grid, &mean, step, (well, top));
            Identity { value: work.value.abs(), ..Identity::new("", work.value.abs(), work.half()) }
        };
        summary.push(Identity { name: "barrier_from_left_j", ..height(left) });
        summary.push(Identity { name: "barrier_from_right_j", ..height(right) });
    }
    let mut remarks = Vec::new();
    if let [one, other] = &curves[..] {
        let apart = |i: usize| one[i].0.value - other[i].0.value;
        // each sample counts in two of the fits
        let errors: f64 = (0..points).map(|i| one[i].0.error.powi(2) + other[i].0.error.powi(2)).sum();
        let error = (8.0 / 9.0 * errors).sqrt();
        let freedom = one.iter().chain(other).map(|own| own.0.freedom).sum();
        let value = (0..points).map(apart).sum::<f64>() / points as f64;
        let mean = Known { value, error: error / points as f64, freedom };
        let length = high - low;
        summary.push(Identity::new("hysteresis_n", value, mean.half()));
        summary.push(Identity::new("hysteresis_j", value * length, mean.half() * length));
    } else {
        remarks.push("pulled in one direction alone: what of the force is friction is not known".to_owned());
    }
    // what the tolerance of a table is relative to
    let between = |i: &usize| match (rests.first(), rests.last()) {
        (Some(first), Some(last)) if rests.len() > 1 => (first.x.value..last.x.value).contains(&grid[*i]),
        _ => true,
    };
    let largest = (0..points).filter(between).map(|i| mean[i].0.value.abs()).fold(0.0, f64::max);
    let mut halves: Vec<f64> = mean.iter().map(|own| own.0.half()).collect();
    halves.sort_by(f64::total_cmp);
    let share = halves[points / 2] / largest;
    remarks.push(format!(
        "the curve is known to {} % of its force{}; as a mechanism: Table(path: \"FILE\", tolerance: {})",
        short(100.0 * share),
        if rests.len() > 1 { " between the wells" } else { "" },
        short(share.clamp(1e-4, 0.1))
    ));
    let curve: Vec<f64> = mean.iter().map(|own| own.0.value).collect();
    let inside = x.iter().zip(force).filter(|own| (low..=high).contains(own.0));
    let left: Vec<(f64, f64)> =
        inside.map(|(x, own)| (*x, own - through_four((x - low) / step, &curve))).collect();
    let fitted = Table::new().each("x_m", &left, |own| own.0).each("residual_n", &left, |own| own.1);
    Ok(Identified { rows, fitted, summary, remarks })
}

/// The cubic through the four of `values` nearest to the place `u`, of which 0 is the first and 1 the next.
fn through_four(u: f64, values: &[f64]) -> f64 {
    let first = ((u.floor() - 1.0).max(0.0) as usize).min(values.len() - 4);
    let nodes = [0, 1, 2, 3].map(|k| (first + k) as f64);
    let weight = |k: usize| -> f64 {
        let others = (0..4).filter(|j| *j != k);
        others.map(|j| (u - nodes[j]) / (nodes[k] - nodes[j])).product()
    };
    (0..4).map(|k| weight(k) * values[first + k]).sum()
}

/// The samples of rising and of falling position, each sorted by position.
fn directions(x: &[f64], force: &[f64]) -> [Pull; 2] {
    let (low, high) = extent(x.iter().copied());
    let turns = turns(x, TURN * (high - low));
    let mut pulls = [Pull::new(), Pull::new()];
    let margin = LEFT_OUT * (high - low);
    for (k, turn) in turns.iter().enumerate() {
        let next = turns.get(k + 1);
        let apart = |i: usize, turn: &Turn| (x[i] - x[turn.at]).abs() > margin;
        let inside = |i: &usize| apart(*i, turn) && next.is_none_or(|next| apart(*i, next));
        let along = (turn.at..next.map_or(x.len(), |next| next.at)).filter(inside);
        pulls[usize::from(turn.maximum)].extend(along.map(|i| (x[i], force[i])));
    }
    pulls.iter_mut().for_each(|pull| pull.sort_by(|a, b| a.0.total_cmp(&b.0)));
    pulls
}

/// The polynomial in (x - `at`)/`reach` through the samples up to `reach` away.
fn near<const N: usize>(pull: &Pull, at: f64, reach: f64) -> Option<Fit<N>> {
    let inside =
        pull.partition_point(|own| own.0 < at - reach)..pull.partition_point(|own| own.0 <= at + reach);
    let rows: Vec<([f64; N], f64)> =
        pull[inside].iter().map(|(x, force)| (powers((x - at) / reach), *force)).collect();
    least_squares(&rows)
}

/// A coefficient in a unit of this size.
fn known<const N: usize>(fit: &Fit<N>, which: usize, unit: f64) -> Known {
    let error = fit.covariance[(which, which)].sqrt();
    Known { value: fit.coefficients[which] * unit, error: error * unit, freedom: fit.freedom }
}

/// Where the force passes 0, by cubics over `reach` on either side.
fn equilibria(grid: &[f64], mean: &[(Known, f64)], pulls: &[&Pull], reach: f64) -> Vec<Rest> {
    let clear = |i: &usize| mean[*i].0.value.abs() > CLEAR * mean[*i].0.error;
    let signs: Vec<usize> = (0..grid.len()).filter(clear).collect();
    let crossing = |pair: &[usize]| {
        let (a, b) = (mean[pair[0]].0.value, mean[pair[1]].0.value);
        (a * b < 0.0).then(|| grid[pair[0]] - a * (grid[pair[1]] - grid[pair[0]]) / (b - a))
    };
    let rest = |mut x: f64| {
        let mut found = None;
        for _ in 0..4 {
            let fits = pulls.iter().map(|pull| near(pull, x, reach)).collect::<Option<Vec<Fit<4>>>>()?;
            let of =
                |which: usize, unit: f64| fits.iter().map(|fit| known(fit, which, unit)).reduce(Known::and);
            let (force, stiffness) = (of(0, 1.0)?, of(1, 1.0 / reach)?);
            let step = -force.value / stiffness.value;
            if !(step.abs() < reach) {
                return None;
            }
            let error = (force.error / stiffness.value).abs();
            found = Some(Rest { x: Known { value: x, error, freedom: force.freedom }, stiffness });
            x += step;
        }
        found
    };
    signs.windows(2).filter_map(crossing).filter_map(rest).collect()
}

/// The equilibria by name, where they are one well or two with a barrier.
fn names(rests: &[Rest]) -> Vec<Identity> {
    let stable = |own: &Rest| own.stiffness.value > 0.0;
    let names: &[[&'static str; 2]] = match rests {
        [well] if stable(well) => &[["well_m", "well_stiffness_n_per_m"]],
        [left, top, right] if stable(left) && !stable(top) && stable(right) => &[
            ["left_well_m", "left_well_stiffness_n_per_m"],
            ["barrier_m", "barrier_stiffness_n_per_m"],
            ["right_well_m", "right_well_stiffness_n_per_m"],
        ],
        _ => &[],
    };
    let each = |(rest, [x, stiffness]): (&Rest, &[&'static str; 2])| {
        let Rest { x: at, stiffness: slope } = rest;
        [Identity::new(x, at.value, at.half()), Identity::new(stiffness, slope.value, slope.half())]
    };
    rests.iter().zip(names).flat_map(each).collect()
}

/// Integral of the force from one equilibrium to another: by cubics between the points of the curve (the
/// trapezoidal rule with its end correction), whose ends have no force and the stiffness found there.
fn work(grid: &[f64], mean: &[(Known, f64)], step: f64, (from, to): (&Rest, &Rest)) -> Known {
    let (low, high) = if from.x.value < to.x.value { (from, to) } else { (to, from) };
    let inside = (0..grid.len()).filter(|i| (low.x.value..high.x.value).contains(&grid[*i]));
    let inside: Vec<usize> = inside.filter(|i| grid[*i] > low.x.value).collect();
    let end = |own: &Rest| (own.x.value, 0.0, own.stiffness.value);
    let points: Vec<(f64, f64, f64)> = std::iter::once(end(low))
        .chain(inside.iter().map(|i| (grid[*i], mean[*i].0.value, mean[*i].1)))
        .chain([end(high)])
        .collect();
    let piece = |pair: &[(f64, f64, f64)]| {
        let (a, b) = (pair[0], pair[1]);
        let h = b.0 - a.0;
        0.5 * h * (a.1 + b.1) + h * h / 12.0 * (a.2 - b.2)
    };
    // each sample counts in two of the fits, whose errors are 3/2 of those of a mean
    let errors: f64 = inside.iter().map(|i| mean[*i].0.error.powi(2)).sum();
    let freedom = inside.iter().map(|i| mean[*i].0.freedom).sum();
    Known { value: points.windows(2).map(piece).sum(), error: step * (8.0 / 9.0 * errors).sqrt(), freedom }
}
