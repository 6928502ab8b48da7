//! Distance from the best design to where its value falls or a constraint breaks.

use super::design::NoBest;
use super::evaluate::{Evaluator, Judged};
use super::search::{Found, resolution, rounded};
use crate::study::bisection::multiple;

/// Relative fall of the value that ends the margin.
const FALL: f64 = 0.1;

/// Steps of the walk outward in one step of the scan.
const FINER: f64 = 4.0;

/// Places that are tried together.
const TOGETHER: usize = 16;

/// Of each field, the distance below and above.
pub(super) fn margins(evaluator: &Evaluator, found: &Found) -> Result<Vec<[Option<f64>; 2]>, NoBest> {
    let fields = 0..evaluator.over.len();
    fields
        .map(|field| Ok([side(evaluator, found, field, -1.0)?, side(evaluator, found, field, 1.0)?]))
        .collect()
}

/// The least distance in direction `way` at which the value has fallen, with every finer step tried, since
/// the values that hold form no interval.
fn side(evaluator: &Evaluator, found: &Found, field: usize, way: f64) -> Result<Option<f64>, NoBest> {
    let range = &evaluator.over[field];
    let (best, middle) = (&found.optimum, found.optimum.at[field]);
    let floor = best.value - FALL * best.value.abs();
    let holds = |judged: &Judged| judged.value().is_some_and(|value| value >= floor);
    let at = |value: f64| {
        let mut at = best.at.clone();
        at[field] = value;
        at
    };
    let (step, end) = (range.step() / FINER, if way > 0.0 { range.high } else { range.low });
    let mut values: Vec<f64> = Vec::new();
    for i in 1.. {
        let value = rounded(range, middle + way * step * f64::from(i));
        if values.last() != Some(&value) && value != middle {
            values.push(value);
        }
        if (end - value) * way <= 0.0 {
            break;
        }
    }
    let mut inside = middle;
    for part in values.chunks(TOGETHER) {
        let judged = evaluator.judge(&part.iter().map(|value| at(*value)).collect::<Vec<_>>())?;
        for (value, design) in part.iter().zip(&judged) {
            if holds(design) {
                inside = *value;
                continue;
            }
            let mut outside = *value;
            while (outside - inside).abs() > 1.5 * resolution(range) {
                let middle = rounded(range, 0.5 * (inside + outside));
                match holds(&evaluator.judge(&[at(middle)])?[0]) {
                    true => inside = middle,
                    false => outside = middle,
                }
            }
            // a multiple of the resolution, except at an end of the range
            return Ok(Some(multiple((outside - middle).abs(), resolution(range))));
        }
    }
    Ok(None)
}
