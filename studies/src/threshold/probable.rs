//! Thresholds in probability: the value of a field at which a share of the runs under noise crosses in time.
//!
//! With the random numbers of a run kept, its answer changes with the field alone, and a bisection finds its
//! own threshold. The threshold in probability is a quantile of those of all runs, and two of them bound it,
//! whatever their distribution ([`QuantileRanks`]).

use super::{NoThresholds, Onset, Scan, faults, from_rest};
use crate::escape::{Until, escape_fault, prepared, waited};
use crate::numeric::QuantileRanks;
use crate::scene::Scene;
use crate::study::bisection::between;
use crate::study::{Built, Cancelled, Cells, ColumnOf, Family, Heading, Table, Task, column};
use crate::system::threads::Pool;

/// The share of runs that are to cross, their number and their time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Chance {
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

/// The thresholds in probability of every cell. Those of the runs are multiples of the resolution of `scan`,
/// of whose values only the first and the last are used. Ticks for each run.
pub(super) fn table(
    cells: &Cells,
    scan: &Scan,
    chance: &Chance,
    pool: &Pool,
    task: &Task,
) -> Result<Table, NoThresholds> {
    cells.check(pool, task, |scene, mechanism| {
        let prepared = prepared(&from_rest(scene), 0, chance.within);
        let tried = (&*scan.field, &*scan.values);
        faults(&prepared, mechanism, &cells.files, tried, |model| escape_fault(model, &prepared))
    })?;
    let first = |scene: &Scene, built: Built, run: u64| {
        let found = match built {
            Ok(mechanism) => {
                let prepared = prepared(&from_rest(scene), run, chance.within);
                let family = Family::new(&prepared, &cells.files, &mechanism, &scan.field);
                Some(least(&family, scan, task)?)
            }
            Err(_) => None,
        };
        (task.tick)();
        Ok(found)
    };
    let runs = chance.runs as usize;
    let found = cells.map(runs, pool, task, first)?;
    let of_cell = |cell: &[Option<f64>]| {
        let mut ascending = cell.iter().copied().collect::<Option<Vec<f64>>>()?;
        ascending.sort_by(f64::total_cmp);
        Some(ascending)
    };
    let found: Vec<Firsts> = found.chunks(runs).map(of_cell).collect();
    Ok(cells.table().with_columns(&columns(chance), &found))
}

/// The columns and what they mean.
pub(super) fn headings() -> Vec<Heading> {
    let chance = Chance { probability: 0.5, runs: 1, within: 1.0 };
    columns(&chance).into_iter().map(|column| column.heading).collect()
}

fn columns(chance: &Chance) -> Vec<ColumnOf<'_, Firsts>> {
    let ranks = QuantileRanks::of(chance.runs, chance.probability);
    let at = |rank: Option<u64>| {
        move |cell: &Firsts| {
            let value = *cell.as_ref()?.get(rank? as usize - 1)?;
            Some(value).filter(|value| value.is_finite())
        }
    };
    vec![
        column("of", "", |_: &Firsts| Onset::Crossing.name()),
        column("probability", "`crossing`, and P", |_: &Firsts| chance.probability),
        column(
            "value",
            "the least value at which at least a share P of the runs crosses: a quantile of the thresholds \
             of the single runs; empty where fewer cross at the end of the range",
            at(Some(ranks.value)),
        ),
        column("low", "", at(ranks.low)),
        column(
            "high",
            "its 95 % interval, two of these thresholds whose ranks follow from the binomial distribution, \
             whatever that of the thresholds (David and Nagaraja 2003, section 7.1); an end is empty where \
             there are too few runs to have one, or where it lies beyond the range",
            at(ranks.high),
        ),
        column("runs", "", |cell: &Firsts| cell.as_ref().map(|_| chance.runs)),
        column("crossed", "runs, and how many of them cross at the end of the range", |cell: &Firsts| {
            Some(cell.as_ref()?.iter().filter(|value| value.is_finite()).count() as u64)
        }),
    ]
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
