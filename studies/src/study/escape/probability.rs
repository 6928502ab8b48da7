//! Thresholds in probability: the value of a field at which a share of the runs under noise crosses in time.
//!
//! With the random numbers of a run kept, its answer changes with the field alone, and a bisection finds its
//! own threshold. The threshold in probability is a quantile of those of all runs, and two of them bound it,
//! whatever their distribution ([`QuantileRanks`]).

use std::sync::Arc;

use super::{Until, escape_fault, prepared, waited};
use crate::mechanics::Mechanism;
use crate::numeric::QuantileRanks;
use crate::scene::{Fault, Files, Scene};
use crate::study::bisection::between;
use crate::study::grid_study::Cells;
use crate::study::thresholds::from_rest;
use crate::study::{Cancelled, Family, Grid, NoModel, NoThresholds, Onset, Scan, Table, Task};
use crate::system::threads::Pool;

/// What is asked of the runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chance {
    /// Share of the runs that are to cross, above 0 and below 1.
    pub probability: f64,
    /// Number of runs, each with another seed, at least 1.
    pub runs: u64,
    /// Time in s within which they are to cross.
    pub within: f64,
}

/// The least values of a cell that make its runs cross, ascending; infinite for runs that do not cross at the
/// end of the range, and `None` if the mechanism was not solved.
type Firsts = Option<Vec<f64>>;

/// The thresholds in probability of every cell of `grid`: the swept fields, then
/// `of,probability,value,low,high,runs,crossed`. All runs begin at rest. The thresholds of the runs are
/// multiples of the resolution of `scan`, of whose values only the first and the last are used.
///
/// A bisection takes it that a run which crosses at a value crosses at all higher ones. Where that is not so,
/// it finds one of the values of the range at which the answer changes. Ticks for each run.
pub fn probable_threshold_table(
    scene: &Scene,
    files: &Files,
    grid: &Grid,
    scan: &Scan,
    chance: &Chance,
    pool: &Pool,
    task: &Task,
) -> Result<Table, NoThresholds> {
    let cells = Cells::new(scene, files, grid.clone());
    let cancelled = |Cancelled| NoThresholds::Cancelled;
    let fault = |scene: &Scene, mechanism: &Arc<Mechanism>| {
        faults(&prepared(&from_rest(scene), 0, chance.within), mechanism, files, scan)
    };
    let wrong = cells.wrong(pool, task, fault).map_err(cancelled)?;
    if !wrong.is_empty() {
        return Err(NoThresholds::Wrong(wrong));
    }
    let (count, runs) = (grid.cells() as usize, chance.runs as usize);
    let begin = || cells.base.clone();
    let first = |scene: &mut Scene, part: usize| {
        task.check_cancelled()?;
        let built = cells.mechanism((part / runs) as u64, 0, scene, task.cancel).ok_or(Cancelled)?;
        let found = match built {
            Ok(mechanism) => {
                let prepared = prepared(&from_rest(scene), (part % runs) as u64, chance.within);
                let family = Family::new(&prepared, files, &mechanism, &scan.field);
                Some(least(&family, scan, task)?)
            }
            Err(_) => None,
        };
        (task.tick)();
        Ok(found)
    };
    let found = pool.map(count * runs, begin, first).map_err(cancelled)?;
    let of_cell = |cell: &[Option<f64>]| {
        let mut ascending = cell.iter().copied().collect::<Option<Vec<f64>>>()?;
        ascending.sort_by(f64::total_cmp);
        Some(ascending)
    };
    let found: Vec<Firsts> = found.chunks(runs).map(of_cell).collect();
    let ranks = QuantileRanks::of(chance.runs, chance.probability);
    let at = |rank: Option<u64>| {
        move |cell: &Firsts| {
            let value = *cell.as_ref()?.get(rank? as usize - 1)?;
            Some(value).filter(|value| value.is_finite())
        }
    };
    Ok(grid
        .table(|| 0..grid.cells())
        .each("of", &found, |_| Onset::Crossing.name())
        .each("probability", &found, |_| chance.probability)
        .each("value", &found, at(Some(ranks.value)))
        .each("low", &found, at(ranks.low))
        .each("high", &found, at(ranks.high))
        .each("runs", &found, |cell| cell.as_ref().map(|_| chance.runs))
        .each("crossed", &found, |cell| {
            Some(cell.as_ref()?.iter().filter(|value| value.is_finite()).count() as u64)
        }))
}

/// The faults at the first value of the scan, if no value gives a model whose runs may cross.
fn faults(scene: &Scene, mechanism: &Arc<Mechanism>, files: &Files, scan: &Scan) -> Option<Vec<Fault>> {
    let family = Family::new(scene, files, mechanism, &scan.field);
    let mut first = None;
    for value in &scan.values {
        let faults = match family.model(*value) {
            Ok(model) => vec![escape_fault(&model, scene)?],
            Err(NoModel::NoField | NoModel::Unsolved) => return None,
            Err(NoModel::Faults(faults)) => faults,
        };
        first = first.or(Some(faults));
    }
    first
}

/// The least value at which the run crosses in time; infinite if it does not at the last value.
fn least(family: &Family, scan: &Scan, task: &Task) -> Result<f64, Cancelled> {
    let crosses = |value: f64| match family.model(value) {
        Ok(model) => Ok(waited(&model, Until::Crossing, task.cancel)?.waiting.happened),
        Err(_) => Ok(false),
    };
    let (Some(&first), Some(&last)) = (scan.values.first(), scan.values.last()) else {
        return Ok(f64::INFINITY);
    };
    if crosses(first)? {
        return Ok(first);
    }
    if !crosses(last)? {
        return Ok(f64::INFINITY);
    }
    let (mut low, mut high) = (first, last);
    while let Some(middle) = between(low, high, scan.resolution) {
        task.check_cancelled()?;
        *(if crosses(middle)? { &mut high } else { &mut low }) = middle;
    }
    Ok(high)
}
