//! Scan of the whole range, refinement around its best designs, and the margins of the best one: the
//! distances at which its value falls or a constraint is violated.

use super::evaluate::{Evaluator, Judged};
use super::plan::{Part, Plan};
use super::{DesignRange, NoBest, Optimum};
use crate::numeric::round::{ONE_TWO_FIVE, round_down};
use crate::study::bisection::multiple;
use crate::study::grid::places;

/// Stride of the coarse scan before the full one.
const COARSE: usize = 4;

/// Number of best designs that are refined, since the scan may miss the maximum of a narrow window.
pub(super) const REFINED: usize = 5;

/// Numbers of intervals on each side of the middle in a refinement, for one to four fields.
const SIDES: [usize; 4] = [4, 2, 1, 1];

/// Inverse of the resolution of a field relative to its range.
const PARTS: f64 = 5e3;

#[derive(Debug)]
pub(super) struct Found {
    pub optimum: Optimum,
    /// Whether all designs have the same value.
    pub flat: bool,
}

/// Resolution of a field: 1, 2 or 5 times a power of ten, and at least 1 for whole numbers.
pub(super) fn resolution(range: &DesignRange) -> f64 {
    let parts = round_down((range.high - range.low) / PARTS, &ONE_TWO_FIVE);
    if range.whole { parts.max(1.0) } else { parts }
}

fn place(over: &[DesignRange], indices: &[usize]) -> Vec<f64> {
    let at = |(range, index): (&DesignRange, &usize)| match *index {
        0 => range.low,
        i if i == range.intervals => range.high,
        i => rounded(range, range.low + range.step() * i as f64),
    };
    over.iter().zip(indices).map(at).collect()
}

/// A value limited to the range and rounded to a multiple of the resolution, except at the ends.
pub(super) fn rounded(range: &DesignRange, value: f64) -> f64 {
    multiple(value, resolution(range)).clamp(range.low, range.high)
}

/// All indices of a scan, the first field slowest.
fn indices(lengths: &[usize]) -> impl Iterator<Item = Vec<usize>> {
    let count: u64 = lengths.iter().map(|length| *length as u64).product();
    (0..count).map(|index| places(lengths.iter().copied(), index).collect())
}

/// The best of some evaluated designs, the first of equal ones.
fn highest(places: &[Vec<f64>], judged: &[Judged]) -> Option<Optimum> {
    let optima = places.iter().zip(judged).filter_map(|(at, design)| design.optimum(at));
    optima.reduce(|best, next| if next.value > best.value { next } else { best })
}

pub(super) fn search(
    evaluator: &Evaluator,
    plan: &mut Plan,
    preview: &mut dyn FnMut(&Optimum),
) -> Result<Found, NoBest> {
    let over = &evaluator.over;
    let lengths: Vec<usize> = over.iter().map(|range| range.intervals + 1).collect();
    let coarse = |node: &Vec<usize>| node.iter().all(|index| index.is_multiple_of(COARSE));
    let (mut places, mut judged) = (Vec::new(), Vec::new());
    for first in [true, false] {
        let mut part = Vec::new();
        for node in indices(&lengths) {
            evaluator.check_cancelled()?;
            if coarse(&node) == first {
                part.push(place(over, &node));
            }
        }
        plan.is_at(Part::Scan, (lengths.iter().product::<usize>() - places.len()) as u64);
        judged.extend(evaluator.judge(&part)?);
        places.extend(part);
        if let Some(best) = highest(&places, &judged).filter(|_| first) {
            preview(&best);
        }
    }
    let Some(best) = highest(&places, &judged) else { return Err(none(&places, &judged)) };
    let all_equal = judged.iter().all(|design| design.value() == Some(best.value));
    let mut order: Vec<usize> = (0..places.len()).filter(|i| judged[*i].value().is_some()).collect();
    order.sort_by(|a, b| judged[*b].value().partial_cmp(&judged[*a].value()).unwrap_or(a.cmp(b)));
    // a plateau starts only one box, at its best design
    let mut begins: Vec<usize> = Vec::new();
    for i in order {
        let apart = |other: &usize| {
            over.iter()
                .enumerate()
                .any(|(field, range)| (places[i][field] - places[*other][field]).abs() > 2.5 * range.step())
        };
        if begins.iter().all(apart) {
            begins.push(i);
        }
        if begins.len() == REFINED || all_equal {
            break;
        }
    }
    let starts = begins.iter().filter_map(|i| judged[*i].optimum(&places[*i])).collect();
    let refined = refine(evaluator, plan, starts)?.into_iter();
    let best = refined.fold(best, |best, next| if next.value > best.value { next } else { best });
    preview(&best);
    Ok(Found { optimum: best, flat: all_equal })
}

/// A box that shrinks around its best design.
struct Closer {
    best: Optimum,
    /// Designs that have been tried and are not better.
    tried: Vec<Vec<f64>>,
}

/// Scans a box around each design, moves it to its best design and shrinks it, down to the resolution.
fn refine(evaluator: &Evaluator, plan: &mut Plan, starts: Vec<Optimum>) -> Result<Vec<Optimum>, NoBest> {
    let over = &evaluator.over;
    let sides = SIDES[over.len() - 1];
    let mut half: Vec<f64> = over.iter().map(DesignRange::step).collect();
    let mut left = most_refined(over, starts.len());
    let closer = |best: Optimum| Closer { tried: vec![best.at.clone()], best };
    let mut boxes: Vec<Closer> = starts.into_iter().map(closer).collect();
    let grid: Vec<Vec<usize>> = indices(&vec![2 * sides + 1; over.len()]).collect();
    loop {
        // the boxes are scanned together, so that no thread is idle
        let places: Vec<Vec<Vec<f64>>> = boxes.iter().map(|area| around(area, over, &grid, &half)).collect();
        plan.is_at(Part::Refinement, left);
        let judged = evaluator.judge(&places.concat())?;
        left = left.saturating_sub((boxes.len() * (grid.len() - 1)) as u64);
        let mut rest = judged.as_slice();
        for (area, places) in boxes.iter_mut().zip(places) {
            let (judged, after) = rest.split_at(places.len());
            rest = after;
            if let Some(better) = highest(&places, judged).filter(|better| better.value > area.best.value) {
                area.best = better;
            }
            area.tried.extend(places);
        }
        if !smaller(&mut half, over) {
            return Ok(boxes.into_iter().map(|area| area.best).collect());
        }
    }
}

/// Makes a box smaller; `false` if it was the last one.
fn smaller(half: &mut [f64], over: &[DesignRange]) -> bool {
    let sides = SIDES[over.len() - 1];
    let finest = half.iter().zip(over).all(|(half, range)| half / sides as f64 <= resolution(range));
    // with one interval on each side the maximum may lie anywhere in the box, so that it is only halved
    let smaller = if sides == 1 { 0.5 } else { 1.0 / sides as f64 };
    for (half, range) in half.iter_mut().zip(over) {
        *half = (*half * smaller).max(resolution(range));
    }
    !finest && (sides > 1 || half.iter().zip(over).any(|(half, range)| *half > resolution(range)))
}

/// The most designs that a refinement around so many places can run.
pub(super) fn most_refined(over: &[DesignRange], places: usize) -> u64 {
    let mut half: Vec<f64> = over.iter().map(DesignRange::step).collect();
    let of_box = (2 * SIDES[over.len() - 1] as u64 + 1).pow(over.len() as u32) - 1;
    let mut boxes = 1;
    while smaller(&mut half, over) {
        boxes += 1;
    }
    boxes * of_box * places as u64
}

/// The untried places of a box on a grid of indices, `half` to each side.
fn around(area: &Closer, over: &[DesignRange], grid: &[Vec<usize>], half: &[f64]) -> Vec<Vec<f64>> {
    let sides = SIDES[over.len() - 1] as f64;
    let place = |indices: &Vec<usize>| -> Vec<f64> {
        let at = |(field, index): (usize, &usize)| {
            let offset = half[field] * (*index as f64 / sides - 1.0);
            rounded(&over[field], area.best.at[field] + offset)
        };
        indices.iter().enumerate().map(at).collect()
    };
    let mut places: Vec<Vec<f64>> = grid.iter().map(place).filter(|at| !area.tried.contains(at)).collect();
    places.sort_by(|a: &Vec<f64>, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    places.dedup();
    places
}

/// Why no design has a value.
fn none(places: &[Vec<f64>], judged: &[Judged]) -> NoBest {
    let broken = places.iter().zip(judged).filter_map(|(at, design)| match design {
        Judged::Broken(by, results, _) => Some((by, at, results)),
        _ => None,
    });
    if let Some((_, nearest, results)) = broken.min_by(|a, b| a.0.total_cmp(b.0)) {
        return NoBest::NoneMeets { nearest: nearest.clone(), results: results.clone() };
    }
    let invalid = judged.iter().find_map(|design| match design {
        Judged::Invalid(faults) if !faults.is_empty() => Some(faults.clone()),
        _ => None,
    });
    match invalid {
        Some(faults) if judged.iter().all(|design| matches!(design, Judged::Invalid(_))) => {
            NoBest::Invalid(faults)
        }
        _ => NoBest::NoValue,
    }
}

/// Relative fall of the value that ends the margin.
const FALL: f64 = 0.1;

/// Least number of outward steps per step of the scan.
const FINER: f64 = 4.0;

/// Number of outward steps of one resolution, from which on a step is this part of the distance: a margin is
/// as exact for its size as a place is for its range.
const NEAR: f64 = 64.0;

/// Number of designs that are evaluated together.
const TOGETHER: usize = 16;

/// How far a field may move in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Side {
    /// The smallest tried distance at which the value has fallen; `None` if it does not within the range.
    pub margin: Option<f64>,
    /// The longest step up to there, or to the end of the range: a narrower dip may be missed.
    pub step: f64,
}

/// The sides of each field, below and above.
pub(super) fn margins(
    evaluator: &Evaluator,
    plan: &mut Plan,
    found: &Found,
) -> Result<Vec<[Side; 2]>, NoBest> {
    let tried =
        |field: usize| [-1.0, 1.0].map(|way| outward(&evaluator.over[field], found.optimum.at[field], way));
    let tried: Vec<[Vec<f64>; 2]> = (0..evaluator.over.len()).map(tried).collect();
    let mut left: u64 = tried.as_flattened().iter().map(|values| values.len() as u64).sum();
    let mut side = |field: usize, values: &[f64]| {
        plan.is_at(Part::Margins, left);
        left -= values.len() as u64;
        side(evaluator, found, field, values)
    };
    let sides = tried.iter().enumerate();
    sides.map(|(field, [low, high])| Ok([side(field, low)?, side(field, high)?])).collect()
}

/// The values that are tried from `middle` in the direction `way` (-1 or 1) to the end of the range.
pub(super) fn outward(range: &DesignRange, middle: f64, way: f64) -> Vec<f64> {
    let (end, finest) = (if way > 0.0 { range.high } else { range.low }, resolution(range));
    let longest = (range.step() / FINER).max(finest);
    let (mut values, mut last) = (Vec::new(), middle);
    while (end - last) * way > 0.0 {
        let step = ((last - middle).abs() / NEAR).clamp(finest, longest);
        let next = rounded(range, last + way * step);
        // a range of a few last digits has no steps
        last = if next == last { end } else { next };
        values.push(last);
    }
    values
}

fn side(evaluator: &Evaluator, found: &Found, field: usize, values: &[f64]) -> Result<Side, NoBest> {
    let range = &evaluator.over[field];
    let (best, middle) = (&found.optimum, found.optimum.at[field]);
    let floor = best.value - FALL * best.value.abs();
    let holds = |judged: &Judged| judged.value().is_some_and(|value| value >= floor);
    let at = |value: f64| {
        let mut at = best.at.clone();
        at[field] = value;
        at
    };
    let (mut inside, mut longest) = (middle, resolution(range));
    for part in values.chunks(TOGETHER) {
        let judged = evaluator.judge(&part.iter().map(|value| at(*value)).collect::<Vec<_>>())?;
        for (value, design) in part.iter().zip(&judged) {
            longest = longest.max(multiple((value - inside).abs(), resolution(range)));
            if holds(design) {
                inside = *value;
                continue;
            }
            let mut outside = *value;
            while (outside - inside).abs() > 1.5 * resolution(range) {
                let middle = rounded(range, 0.5 * (inside + outside));
                if holds(&evaluator.judge(&[at(middle)])?[0]) { inside = middle } else { outside = middle }
            }
            // a multiple of the resolution, except at an end of the range
            let margin = Some(multiple((outside - middle).abs(), resolution(range)));
            return Ok(Side { margin, step: longest });
        }
    }
    Ok(Side { margin: None, step: longest })
}
