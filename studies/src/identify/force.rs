//! Force curve from a slow pull test, with its hysteresis, equilibria and barrier.

use super::rests::Rest;
use super::{Identified, Identity, Unidentified, median, noise, turns, with_interval};
use crate::numeric::regression::{Fit, least_squares, powers, student};
use crate::numeric::{elementary, extent, short};
use crate::study::{Table, Values};

/// Number of points of a curve by default, if the samples are enough for them.
pub const FORCE_POINTS: usize = 101;
/// Least number of points, those of a cubic.
pub(super) const LEAST_POINTS: usize = 4;

/// Reversal of the position that ends a pull in one direction, as a share of the range.
const TURN: f64 = 0.1;

/// Distance from a reversal, in standard deviations of the position, below which samples are left out, since
/// the noise of the position is biased there.
const TURNING: f64 = 6.0;

/// Share of the range after a reversal that is left out if the directions differ in its outermost quarter by
/// less than half of their difference further in, since friction and backlash reverse there.
const LEFT_OUT: f64 = 0.01;
/// End of the range further in, in multiples of that share.
const FURTHER_IN: f64 = 5.0;

/// Number of standard errors by which the force must differ from 0 on both sides of an equilibrium.
const CLEAR: f64 = 3.0;

/// A number with its standard error and the degrees of freedom of that error.
#[derive(Debug, Clone, Copy)]
pub struct Known {
    pub value: f64,
    pub error: f64,
    pub freedom: usize,
}

impl Known {
    pub fn half(self) -> f64 {
        student(self.freedom) * self.error
    }

    /// The mean of this and another.
    pub fn and(self, other: Self) -> Self {
        Self {
            value: 0.5 * (self.value + other.value),
            error: 0.5 * elementary::hypot(self.error, other.error),
            freedom: self.freedom + other.freedom,
        }
    }
}

/// Samples of one direction, by position. SI.
pub type Pull = Vec<(f64, f64)>;

/// The force curve at even positions: force with its error, and slope.
struct Curve {
    positions: Vec<f64>,
    step: f64,
    directions: Vec<Vec<(Known, f64)>>,
    mean: Vec<(Known, f64)>,
}

/// The force curve of a slow pull: force `force` in N over position `x` in m, in the order in which they were
/// measured, in one direction or in both, any number of times.
///
/// The curve has `points` even positions over the range that all directions cover, by default the largest
/// number up to [`FORCE_POINTS`] for which the samples are enough. At each a cubic is fitted by least squares
/// to the samples of one direction up to the neighbouring points, or up to a kink beside an equilibrium. The
/// force is the mean of both directions, half their difference the friction. The equilibria are fitted
/// separately (see `Rest::near`). Intervals are 95 %, from the residuals of the fits. A table mechanism reads
/// the rows.
pub fn force(x: &[f64], force: &[f64], points: Option<usize>) -> Result<Identified, Unidentified> {
    let [rising, falling] = directions(x, force);
    let pulls: Vec<&Pull> = [&rising, &falling].into_iter().filter(|pull| !pull.is_empty()).collect();
    let ends = pulls.iter().filter_map(|pull| Some((pull.first()?.0, pull.last()?.0)));
    let (low, high) =
        ends.fold((f64::NEG_INFINITY, f64::INFINITY), |all, ends| (all.0.max(ends.0), all.1.min(ends.1)));
    if !(low < high && high - low < f64::INFINITY) {
        return Err(Unidentified::Still);
    }
    let curve = |points: usize| {
        let rough = Curve::of(&pulls, (low, high), points, &[])?;
        let rests = rough.equilibria(&pulls, high - low);
        let kinks: Vec<f64> = rests.iter().filter_map(|rest| rest.kink).map(|kink| kink[0]).collect();
        let curve = if kinks.is_empty() { rough } else { Curve::of(&pulls, (low, high), points, &kinks)? };
        Some((curve, rests))
    };
    let found = match points {
        Some(points) => curve(points.max(LEAST_POINTS)),
        None => (LEAST_POINTS..=FORCE_POINTS).rev().find_map(curve),
    };
    let (curve, rests) = found.ok_or_else(|| {
        let fewer = points.filter(|_| curve(LEAST_POINTS).is_some());
        Unidentified::FewSamples(x.len(), fewer.unwrap_or(LEAST_POINTS))
    })?;
    let forces = |pull: &Pull, direction: usize| -> Values {
        match pull.is_empty() {
            true => curve.positions.iter().map(|_| f64::NAN).collect(),
            false => curve.directions[direction].iter().map(|row| row.0.value).collect(),
        }
    };
    let rows = Table::new().each("x_m", &curve.positions, |x| *x);
    let rows = with_interval(rows, "force_n", &curve.mean, |(force, _)| {
        Identity::new("force_n", force.value, force.half())
    })
    .with("force_rising_n", forces(&rising, 0))
    .with("force_falling_n", forces(&falling, pulls.len() - 1));
    let (mut summary, mut remarks) = curve.landscape(&rests);
    if let [one, other] = &curve.directions[..] {
        summary.extend(hysteresis(one, other, high - low));
    } else {
        remarks.push("pulled in one direction alone: what of the force is friction is not known".to_owned());
    }
    let (remark, tolerance) = curve.tolerance(&rests);
    remarks.push(remark);
    let forces: Vec<f64> = curve.mean.iter().map(|row| row.0.value).collect();
    let inside = x.iter().zip(force).filter(|sample| (low..=high).contains(sample.0));
    let left: Vec<(f64, f64)> =
        inside.map(|(x, force)| (*x, force - through_four((x - low) / curve.step, &forces))).collect();
    let fitted =
        Table::new().each("x_m", &left, |sample| sample.0).each("residual_n", &left, |sample| sample.1);
    let tolerance = Some(tolerance).filter(|share| share.is_finite());
    Ok(Identified { rows, fitted, summary, remarks, tolerance })
}

impl Curve {
    /// The curve of these pulls, which breaks at `kinks`; `None` if the samples are too few.
    fn of(pulls: &[&Pull], (low, high): (f64, f64), points: usize, kinks: &[f64]) -> Option<Self> {
        let step = (high - low) / (points - 1) as f64;
        let position = |i: usize| low + (high - low) * i as f64 / (points - 1) as f64;
        let positions: Vec<f64> = (0..points).map(position).collect();
        let at = |pull: &Pull, x: f64| -> Option<(Known, f64)> {
            let between = |from: f64, to: f64| near(pull, x, (from, to), step);
            let from = kinks.iter().copied().filter(|kink| *kink < x).fold(x - step, f64::max);
            let to = kinks.iter().copied().filter(|kink| *kink >= x).fold(x + step, f64::min);
            let fit = between(from, to).or_else(|| between(x - step, x + step))?;
            let error = fit.covariance[(0, 0)].sqrt();
            let force = Known { value: fit.coefficients[0], error, freedom: fit.freedom };
            Some((force, fit.coefficients[1] / step))
        };
        let along = |pull: &&Pull| positions.iter().map(|x| at(pull, *x)).collect::<Option<Vec<_>>>();
        let directions = pulls.iter().map(along).collect::<Option<Vec<_>>>()?;
        let mean = |i: usize| match &directions[..] {
            [one, other] => (one[i].0.and(other[i].0), 0.5 * (one[i].1 + other[i].1)),
            all => all[0][i],
        };
        let mean = (0..points).map(mean).collect();
        Some(Self { positions, step, directions, mean })
    }

    fn equilibria(&self, pulls: &[&Pull], range: f64) -> Vec<Rest> {
        let clear = |i: &usize| self.mean[*i].0.value.abs() > CLEAR * self.mean[*i].0.error;
        let signs: Vec<usize> = (0..self.positions.len()).filter(clear).collect();
        let crossing = |pair: &[usize]| {
            let (a, b) = (self.mean[pair[0]].0.value, self.mean[pair[1]].0.value);
            let (from, to) = (self.positions[pair[0]], self.positions[pair[1]]);
            (a * b < 0.0).then(|| from - a * (to - from) / (b - a))
        };
        signs.windows(2).filter_map(crossing).filter_map(|x| Rest::near(x, pulls, range)).collect()
    }

    /// Equilibria and barrier by name, and remarks on them.
    fn landscape(&self, rests: &[Rest]) -> (Vec<Identity>, Vec<String>) {
        const WELL: [&str; 2] = ["well_m", "well_stiffness_n_per_m"];
        const LEFT: [&str; 2] = ["left_well_m", "left_well_stiffness_n_per_m"];
        const RIGHT: [&str; 2] = ["right_well_m", "right_well_stiffness_n_per_m"];
        const TOP: [&str; 2] = ["barrier_m", "barrier_stiffness_n_per_m"];
        let stable: Vec<bool> = rests.iter().map(Rest::is_stable).collect();
        let names: &[[&'static str; 2]] = match stable[..] {
            [true] => &[WELL],
            [false] => &[TOP],
            [true, false] => &[LEFT, TOP],
            [false, true] => &[TOP, RIGHT],
            [true, false, true] => &[LEFT, TOP, RIGHT],
            _ => &[],
        };
        let mut summary: Vec<Identity> =
            rests.iter().zip(names).flat_map(|(rest, names)| rest.identities(*names)).collect();
        let top = names.iter().position(|name| *name == TOP);
        for (well, name) in [(LEFT, "barrier_from_left_j"), (RIGHT, "barrier_from_right_j")] {
            if let (Some(well), Some(top)) = (names.iter().position(|name| *name == well), top)
                && let Some(work) = self.work(&rests[well], &rests[top])
            {
                summary.push(Identity::new(name, work.value.abs(), work.half()));
            }
        }
        let mut remarks = Vec::new();
        if names.is_empty() {
            let at: Vec<String> = rests.iter().map(|rest| short(1e3 * rest.x.0)).collect();
            remarks.push(match at.is_empty() {
                true => {
                    "the force passes 0 nowhere that stands out from its noise: no equilibrium".to_owned()
                }
                false => format!("the force passes 0 at {} mm: no wells with one barrier", at.join(", ")),
            });
        }
        for rest in rests {
            if let Some([x, left, right]) = rest.kink {
                let [mm, um, left, right] = [1e3 * x, 1e6 * (x - rest.x.0).abs(), left, right].map(short);
                remarks.push(format!(
                    "kink at {mm} mm, {um} um from an equilibrium: the slope of the force jumps from {left} \
                     to {right} N/m, and a swing over both sides has neither stiffness"
                ));
            }
        }
        (summary, remarks)
    }

    /// Integral of the force from one equilibrium to another: near them that of their fits, elsewhere by
    /// cubics between the points of the curve (the trapezoidal rule with its end correction).
    fn work(&self, one: &Rest, other: &Rest) -> Option<Known> {
        let (low, high) = if one.x.0 < other.x.0 { (one, other) } else { (other, one) };
        let apart = high.x.0 - low.x.0;
        let (from, to) = (low.x.0 + low.reach().min(0.3 * apart), high.x.0 - high.reach().min(0.3 * apart));
        let ([first, from_force, from_slope], [last, to_force, to_slope]) =
            (low.work_to(from)?, high.work_to(to)?);
        let inside: Vec<usize> = (0..self.positions.len())
            .filter(|i| self.positions[*i] > from && self.positions[*i] < to)
            .collect();
        let points: Vec<(f64, f64, f64)> = std::iter::once((from, from_force.value, from_slope.value))
            .chain(inside.iter().map(|i| (self.positions[*i], self.mean[*i].0.value, self.mean[*i].1)))
            .chain([(to, to_force.value, to_slope.value)])
            .collect();
        let piece = |pair: &[(f64, f64, f64)]| {
            let (a, b) = (pair[0], pair[1]);
            let h = b.0 - a.0;
            0.5 * h * (a.1 + b.1) + h * h / 12.0 * (a.2 - b.2)
        };
        // each sample counts in two of the fits, whose errors are 3/2 of those of a mean
        let errors: f64 = inside.iter().map(|i| self.mean[*i].0.error.powi(2)).sum();
        let middle = self.step * (8.0 / 9.0 * errors).sqrt();
        let freedom: usize = inside.iter().map(|i| self.mean[*i].0.freedom).sum();
        Some(Known {
            value: first.value + points.windows(2).map(piece).sum::<f64>() - last.value,
            error: elementary::hypot(elementary::hypot(first.error, last.error), middle),
            freedom: freedom + first.freedom + last.freedom,
        })
    }

    /// A text with the accuracy of the curve, and the tolerance for a table made of it.
    fn tolerance(&self, rests: &[Rest]) -> (String, f64) {
        let between = |x: &f64| match (rests.first(), rests.last()) {
            (Some(first), Some(last)) if rests.len() > 1 => (first.x.0..last.x.0).contains(x),
            _ => true,
        };
        let inside = self.positions.iter().zip(&self.mean).filter(|point| between(point.0));
        let largest = inside.map(|point| point.1.0.value.abs()).fold(0.0, f64::max);
        let half = median(self.mean.iter().map(|row| row.0.half()).collect());
        let share = half.unwrap_or(f64::NAN) / largest;
        let tolerance = share.clamp(1e-4, 0.1);
        let text = format!(
            "the curve is known to {} % of its force{}; as a mechanism: Table(path: \"FILE\", tolerance: {})",
            short(100.0 * share),
            if rests.len() > 1 { " between the wells" } else { "" },
            short(tolerance)
        );
        (text, tolerance)
    }
}

/// The mean difference of two directions, and the energy of the loop over a range of this length.
fn hysteresis(one: &[(Known, f64)], other: &[(Known, f64)], length: f64) -> [Identity; 2] {
    let points = one.len() as f64;
    // each sample counts in two of the fits
    let errors: f64 = one.iter().chain(other).map(|row| row.0.error.powi(2)).sum();
    let apart = one.iter().zip(other).map(|(one, other)| one.0.value - other.0.value);
    let mean = Known {
        value: apart.sum::<f64>() / points,
        error: (8.0 / 9.0 * errors).sqrt() / points,
        freedom: one.iter().chain(other).map(|row| row.0.freedom).sum(),
    };
    [("hysteresis_n", 1.0), ("hysteresis_j", length)]
        .map(|(name, unit)| Identity::new(name, mean.value * unit, mean.half() * unit))
}

/// The cubic through the four of `values` nearest to the index `u`, evaluated there.
fn through_four(u: f64, values: &[f64]) -> f64 {
    let first = ((u.floor() - 1.0).max(0.0) as usize).min(values.len() - 4);
    let nodes = [0, 1, 2, 3].map(|k| (first + k) as f64);
    let weight = |k: usize| -> f64 {
        let other_nodes = (0..4).filter(|j| *j != k);
        other_nodes.map(|j| (u - nodes[j]) / (nodes[k] - nodes[j])).product()
    };
    (0..4).map(|k| weight(k) * values[first + k]).sum()
}

/// The samples of rising and of falling position, each sorted by position.
fn directions(x: &[f64], force: &[f64]) -> [Pull; 2] {
    let (low, high) = extent(x.iter().copied());
    let range = high - low;
    let turns = turns(x, TURN * range);
    let mut pulls = [Pull::new(), Pull::new()];
    let margin = TURNING * noise(x);
    for (k, turn) in turns.iter().enumerate() {
        let next = turns.get(k + 1).map_or(x.len(), |next| next.at);
        let inside = |i: &usize| x[*i] > low + margin && x[*i] < high - margin || margin == 0.0;
        pulls[usize::from(turn.maximum)].extend((turn.at..next).filter(inside).map(|i| (x[i], force[i])));
    }
    pulls.iter_mut().for_each(|pull| pull.sort_by(|a, b| a.0.total_cmp(&b.0)));
    let [rising, falling] = &pulls;
    let (after_low, after_high) =
        (turning(falling, rising, (low, range)), turning(rising, falling, (high, -range)));
    if after_low {
        pulls[0].retain(|sample| sample.0 > low + LEFT_OUT * range);
    }
    if after_high {
        pulls[1].retain(|sample| sample.0 < high - LEFT_OUT * range);
    }
    pulls
}

/// Whether friction still reverses after the reversal at `end`, over a share of `range`.
fn turning(before: &Pull, after: &Pull, (end, range): (f64, f64)) -> bool {
    let apart = |(x, force): &(f64, f64)| -> Option<f64> {
        let next = before.partition_point(|sample| sample.0 < *x);
        let ((left, at_left), (right, at_right)) = (*before.get(next.checked_sub(1)?)?, *before.get(next)?);
        Some(at_left + (at_right - at_left) * (x - left) / (right - left).max(f64::MIN_POSITIVE) - force)
    };
    let mean = |from: f64, to: f64| {
        let inside = |sample: &&(f64, f64)| (from..to).contains(&((sample.0 - end) / range));
        let found: Vec<f64> = after.iter().filter(inside).filter_map(apart).collect();
        (found.iter().sum::<f64>() / found.len() as f64, found.len())
    };
    let (near, count) = mean(0.0, 0.25 * LEFT_OUT);
    let (usual, _) = mean(LEFT_OUT, FURTHER_IN * LEFT_OUT);
    count > 0 && near.abs() < 0.5 * usual.abs()
}

/// The samples of a pull between two places.
pub fn within(pull: &Pull, from: f64, to: f64) -> &[(f64, f64)] {
    &pull[pull.partition_point(|sample| sample.0 < from)..pull.partition_point(|sample| sample.0 <= to)]
}

/// The cubic in (x - `at`)/`unit` through the samples between two places.
fn near(pull: &Pull, at: f64, (from, to): (f64, f64), unit: f64) -> Option<Fit<4>> {
    let row = |(x, force): &(f64, f64)| (powers((x - at) / unit), *force);
    least_squares(&within(pull, from, to).iter().map(row).collect::<Vec<_>>())
}
