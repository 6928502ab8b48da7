//! Walks over a field: runs each of which goes on from where the one before was, upwards and downwards.
//!
//! [`Sweep`](super::Sweep) makes tables of such walks; here the runs are handed over one by one, as a picture
//! that grows needs them.

use super::family::Family;
use super::walk::Carried;
use super::{Direction, Task};
use crate::dynamics::{Request, Run, Summary};
use crate::system::threads::Pool;

/// The most stroboscopic states that are kept of one run.
const MOST_STROBES: usize = 60;

/// A run of a walk.
#[derive(Debug, Clone, PartialEq)]
pub struct Visit {
    /// The direction of its walk.
    pub direction: Direction,
    /// The value of the field.
    pub value: f64,
    /// Its summary.
    pub summary: Summary,
    /// Displacements in m at the drive's phase 0, once a forcing period: the last 60 of the settled window.
    pub strobes: Vec<f64>,
}

/// Walks a family over `values`, ascending, upwards and downwards side by side, and hands over each run as
/// soon as it is known, those of a direction in their order. A value that makes no model is skipped. Returns
/// false if cancelled.
pub fn up_and_down(
    family: &Family,
    values: &[f64],
    pool: &Pool,
    task: &Task,
    each: &(dyn Fn(Visit) + Sync),
) -> bool {
    let request =
        Request { section: Some(0.0), carry: true, cancel: Some(task.cancel), ..Request::default() };
    let walk = |_: &mut (), number: usize| {
        let direction = [Direction::Up, Direction::Down][number];
        let mut values: Vec<f64> = values.to_vec();
        if direction == Direction::Down {
            values.reverse();
        }
        walk_over(family, &values, &request, |value, run| {
            let skipped = run.section.len().saturating_sub(MOST_STROBES);
            let strobes = run.section[skipped..].iter().map(|point| point.x).collect();
            if !task.is_cancelled() {
                each(Visit { direction, value, summary: run.summary, strobes });
                (task.tick)();
            }
            !task.is_cancelled()
        });
        if task.is_cancelled() { Err(()) } else { Ok(()) }
    };
    pool.map(2, || (), walk).is_ok()
}

/// Runs the family at one value after the other, each from the state in which the one before ended, until
/// `each` returns false. Values that make no model are skipped; returns their number.
pub(super) fn walk_over(
    family: &Family,
    values: &[f64],
    request: &Request,
    mut each: impl FnMut(f64, &Run) -> bool,
) -> usize {
    let (mut carried, mut unfit) = (Carried::default(), 0);
    for value in values {
        let Ok(model) = family.model(*value) else {
            unfit += 1;
            continue;
        };
        let model = carried.on(model);
        let run = model.run(request);
        if !each(*value, &run) {
            break;
        }
        carried.keep(&model, &run);
    }
    unfit
}
