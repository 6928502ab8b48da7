//! The stops of a record, and the drift of the picture in which they lie.

use nalgebra::{SMatrix, SVector};

use super::contacts::Contact;
use super::{Motion, NORMAL, median};
use crate::numeric::regression::{least_squares, student};

/// Impacts on one stop differ in place by less than this share of the range and six standard errors.
const SAME_STOP: f64 = 0.005;

/// The fastest drift that is looked for, as a share of the usual jump of the velocity at an impact.
const FASTEST: f64 = 0.25;

/// Most impacts of a side between which slopes are tried.
const TRIED: usize = 24;

/// Standard errors by which a coefficient of a drift that is not uniform has to differ from 0.
const CLEAR: f64 = 4.0;

/// A place where impacts lie, in the frame of the drift. SI.
#[derive(Debug, Clone)]
pub struct Stop {
    pub right: bool,
    pub x: f64,
    /// Number of the impacts by which it was found.
    pub impacts: usize,
    /// Times of the first and the last of them.
    pub span: (f64, f64),
    /// How far the samples of its impacts usually lie beyond it.
    pub beyond: f64,
}

/// Motion of the stops in the record: a polynomial of u without a constant, where u goes from -1 to 1 over
/// the record.
#[derive(Debug, Clone, Copy, Default)]
pub struct Drift {
    pub coefficients: SVector<f64, 3>,
    /// Their covariance, where the impacts tell it.
    pub covariance: Option<SMatrix<f64, 3, 3>>,
    /// Factor on a standard error that gives half of an interval.
    pub student: f64,
}

/// Tolerance of the place of an impact with this standard error.
pub fn tolerance(motion: &Motion, error: f64) -> f64 {
    6.0 * error + SAME_STOP * motion.range()
}

/// The stop of a side at a time: the one whose impacts are nearest.
pub fn stop_at(stops: &[Stop], right: bool, t: f64) -> Option<usize> {
    let away = |stop: &Stop| (stop.span.0 - t).max(t - stop.span.1).max(0.0);
    let of_side = stops.iter().enumerate().filter(|(_, stop)| stop.right == right);
    of_side.min_by(|a, b| away(a.1).total_cmp(&away(b.1))).map(|(k, _)| k)
}

/// An impact as a candidate for a stop.
#[derive(Debug, Clone, Copy)]
struct Place {
    contact: usize,
    t: f64,
    x: f64,
    tolerance: f64,
    /// 1 on the right, -1 on the left.
    side: f64,
}

/// The stops on which the impacts lie, and for each contact the number of its stop, if it has an impact
/// there.
///
/// Impacts lie on one stop if their places agree; if some share of the range is `loose`, up to that and a
/// uniform drift of both sides: of the slopes between impacts, the one that most agree with. A stop may end,
/// as a table from which a ball rolls: what comes after it lies farther out.
pub fn stops(motion: &Motion, contacts: &[Contact], loose: f64) -> (Vec<Stop>, Vec<Option<usize>>) {
    let place = |(contact, of): (usize, &Contact)| {
        let impact = of.impact?;
        let side = if of.right { 1.0 } else { -1.0 };
        let tolerance = tolerance(motion, impact.error) + loose * motion.range();
        Some(Place { contact, t: impact.t, x: impact.x, tolerance, side })
    };
    let places: Vec<Place> = contacts.iter().enumerate().filter_map(place).collect();
    let sides = [-1.0, 1.0].map(|side| places.iter().copied().filter(|p| p.side == side).collect::<Vec<_>>());
    let slope = if loose > 0.0 { slope(contacts, &sides) } else { 0.0 };
    let mut found = (Vec::new(), vec![None; contacts.len()]);
    for side in sides {
        let level = side.into_iter().map(|p| Place { x: p.x - slope * p.t, ..p }).collect();
        split(motion, contacts, level, 1, &mut found);
    }
    found
}

/// The slope that the places of most impacts follow.
fn slope(contacts: &[Contact], sides: &[Vec<Place>; 2]) -> f64 {
    let jumps = contacts.iter().filter_map(|contact| Some(contact.impact?.jump)).collect();
    let fastest = FASTEST * median(jumps).unwrap_or(0.0);
    let probes = sides.each_ref().map(|side| {
        let apart = side.len().div_ceil(TRIED).max(1);
        side.iter().step_by(apart).copied().collect::<Vec<_>>()
    });
    let count = |slope: f64| -> usize {
        let of_side = |(probes, side): (&Vec<Place>, &Vec<Place>)| {
            let agree = |probe: &Place| side.iter().filter(|other| probe.agrees(other, slope)).count();
            probes.iter().map(agree).max().unwrap_or(0)
        };
        probes.iter().zip(sides).map(of_side).sum()
    };
    let pairs = probes.iter().flat_map(|probes| {
        let pairs = probes.iter().enumerate().flat_map(|(k, a)| probes[k + 1..].iter().map(move |b| (a, b)));
        pairs.map(|(a, b)| (b.x - a.x) / (b.t - a.t)).collect::<Vec<_>>()
    });
    let mut slopes: Vec<f64> = pairs.filter(|slope| slope.abs() < fastest).collect();
    slopes.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let (mut best, mut most) = (0.0, count(0.0));
    for slope in slopes {
        let count = count(slope);
        if count > most {
            (best, most) = (slope, count);
        }
    }
    best
}

impl Place {
    /// Whether another one lies on a line of this slope through it, as closely as the other is known.
    fn agrees(&self, other: &Self, slope: f64) -> bool {
        (other.x - self.x - slope * (other.t - self.t)).abs() < other.tolerance
    }
}

/// Splits the impacts of a side into those of the stop on which most lie, and those of stops before and after
/// it, which have at least as many impacts as `least`.
fn split(
    motion: &Motion,
    contacts: &[Contact],
    places: Vec<Place>,
    least: usize,
    found: &mut (Vec<Stop>, Vec<Option<usize>>),
) {
    let members = |x: f64| places.iter().filter(move |p| (p.x - x).abs() < p.tolerance);
    let counted = places.iter().map(|p| (members(p.x).count(), p));
    let better = |a: &(usize, &Place), b: &(usize, &Place)| {
        a.0.cmp(&b.0).then(b.1.tolerance.total_cmp(&a.1.tolerance))
    };
    let Some((_, centre)) = counted.max_by(better) else { return };
    let Some(x) = median(members(centre.x).map(|p| p.x).collect()) else { return };
    let on_it: Vec<Place> = members(x).copied().collect();
    let Some((first, last)) = on_it.first().zip(on_it.last()).filter(|_| on_it.len() >= least) else {
        return;
    };
    let side = first.side;
    let beyond = on_it.iter().map(|p| (side * (motion.x[contacts[p.contact].at] - p.x)).max(0.0));
    let beyond = median(beyond.collect()).unwrap_or(0.0);
    let stop = Stop { right: side > 0.0, x, impacts: on_it.len(), span: (first.t, last.t), beyond };
    let (stops, of) = found;
    on_it.iter().for_each(|p| of[p.contact] = Some(stops.len()));
    stops.push(stop);
    let outside = |p: &Place| side * (p.x - x) > p.tolerance;
    let later = places.iter().copied().filter(|p| p.t > last.t && outside(p)).collect();
    let inside = |p: &Place| side * (p.x - x) < -p.tolerance;
    let earlier = places.iter().copied().filter(|p| p.t < first.t && inside(p)).collect();
    split(motion, contacts, later, 1, found);
    // a mass may turn anywhere before it reaches a stop
    split(motion, contacts, earlier, 2, found);
}

/// The rate for u at which stops would have to move so that the impacts which lie on none are on them, if
/// these are not few beside the others; else 0.
pub fn unexplained(motion: &Motion, contacts: &[Contact], stops: &[Stop], members: &[Option<usize>]) -> f64 {
    let lone = contacts.iter().zip(members).filter(|(_, stop)| stop.is_none());
    let rate = |(contact, _): (&Contact, &Option<usize>)| {
        let impact = contact.impact?;
        let stop = &stops[stop_at(stops, contact.right, impact.t)?];
        let [u, first, last] = [impact.t, stop.span.0, stop.span.1].map(|t| motion.part(t));
        Some((impact.x - stop.x).abs() / (u - first).abs().max((u - last).abs()))
    };
    let rates: Vec<f64> = lone.filter_map(rate).collect();
    let few = 2 * rates.len() < members.iter().flatten().count();
    if few { 0.0 } else { rates.into_iter().fold(0.0, f64::max) }
}

impl Drift {
    /// The drift that the impacts of these contacts show, each on the stop of this number.
    ///
    /// Least squares of the places, with a place of its own for each stop and weights from the errors. The
    /// drift is uniform unless a square or a cube clearly differs from 0. If there is no impact more than
    /// unknowns, nothing tells a drift from stops at several places, and the error of the drift is itself.
    pub fn of(motion: &Motion, contacts: &[Contact], stops: usize, members: &[Option<usize>]) -> Self {
        let impact = |(contact, stop): (&Contact, &Option<usize>)| Some((contact.impact?, (*stop)?));
        let impacts: Vec<_> = contacts.iter().zip(members).filter_map(impact).collect();
        let usual = median(impacts.iter().map(|(impact, _)| impact.error).collect()).unwrap_or(0.0);
        let floor = usual.max(1e-12 * motion.range()).powi(2);
        let weight = |error: f64| 1.0 / (error * error + floor);
        let mut sums = vec![[0.0; 5]; stops];
        for (impact, group) in &impacts {
            let (w, u) = (weight(impact.error), motion.part(impact.t));
            let terms = [w, w * u, w * u * u, w * u * u * u, w * impact.x];
            sums[*group].iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        }
        let rows: Vec<([f64; 3], f64)> = impacts
            .iter()
            .map(|(impact, group)| {
                let (root, u, [w, sums @ ..]) =
                    (weight(impact.error).sqrt(), motion.part(impact.t), sums[*group]);
                let [a, b, c, x] = sums.map(|sum| sum / w);
                ([root * (u - a), root * (u * u - b), root * (u * u * u - c)], root * (impact.x - x))
            })
            .collect();
        let groups = sums.iter().filter(|sums| sums[0] > 0.0).count();
        let cubic = fitted::<3>(&rows, groups);
        let square = fitted::<2>(&rows, groups);
        let clear = |drift: &Self, k: usize| {
            let error = drift.covariance.map_or(f64::INFINITY, |covariance| covariance[(k, k)].sqrt());
            drift.coefficients[k].abs() > CLEAR * error
        };
        cubic
            .filter(|drift| clear(drift, 2))
            .or_else(|| square.filter(|drift| clear(drift, 1)))
            .or_else(|| fitted::<1>(&rows, groups))
            .unwrap_or_else(|| Self::of_two(&rows, groups, motion.drift.coefficients[0]))
    }

    /// The drift with an error that holds this rate too.
    pub fn or(mut self, rate: f64) -> Self {
        if let Some(covariance) = &mut self.covariance {
            covariance[(0, 0)] += (rate / self.student).powi(2);
        }
        self
    }

    /// A uniform drift of this much for u from 0 to 1.
    pub fn uniform(rate: f64) -> Self {
        Self { coefficients: SVector::from([rate, 0.0, 0.0]), ..Self::default() }
    }

    /// The drift of one impact more than stops, beside one that was subtracted, or of none more.
    fn of_two(rows: &[([f64; 3], f64)], groups: usize, subtracted: f64) -> Self {
        let (product, square) =
            rows.iter().fold((0.0, 0.0), |(xy, xx), (row, x)| (xy + row[0] * x, xx + row[0] * row[0]));
        if rows.len() != groups + 1 || !(square > 0.0) {
            return Self::default();
        }
        let rate = product / square;
        let mut covariance = SMatrix::zeros();
        covariance[(0, 0)] = ((subtracted + rate) / NORMAL).powi(2) + 1.0 / square;
        Self { covariance: Some(covariance), student: NORMAL, ..Self::uniform(rate) }
    }

    /// Displacement, and velocity for u, at u.
    pub fn at(&self, u: f64) -> (f64, f64) {
        let c = &self.coefficients;
        (u * (c[0] + u * (c[1] + u * c[2])), c[0] + u * (2.0 * c[1] + 3.0 * u * c[2]))
    }

    /// Half of the intervals of displacement and velocity at u; `None` if the drift is unknown.
    pub fn halves(&self, u: f64) -> Option<(f64, f64)> {
        let covariance = self.covariance?;
        let half =
            |row: SVector<f64, 3>| self.student * (row.transpose() * covariance * row)[0].max(0.0).sqrt();
        Some((half(SVector::from([u, u * u, u * u * u])), half(SVector::from([1.0, 2.0 * u, 3.0 * u * u]))))
    }
}

/// The drift of N coefficients, where the places of each of the stops are those less their mean.
fn fitted<const N: usize>(rows: &[([f64; 3], f64)], groups: usize) -> Option<Drift> {
    let freedom = rows.len().checked_sub(groups + N).filter(|freedom| *freedom > 0)?;
    let rows: Vec<([f64; N], f64)> =
        rows.iter().map(|(row, x)| (std::array::from_fn(|k| row[k]), *x)).collect();
    let fit = least_squares(&rows)?;
    // the means of the stops were fitted too
    let factor = fit.freedom as f64 / freedom as f64;
    let mut drift = Drift { student: student(freedom), ..Drift::default() };
    let mut covariance = SMatrix::zeros();
    for i in 0..N {
        drift.coefficients[i] = fit.coefficients[i];
        for j in 0..N {
            covariance[(i, j)] = factor * fit.covariance[(i, j)];
        }
    }
    drift.covariance = Some(covariance);
    Some(drift)
}
