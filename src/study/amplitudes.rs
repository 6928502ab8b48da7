//! Thresholds of the amplitude of a sine, and the stops that make a motion cross.

use std::sync::Arc;

use super::Task;
use super::bisection::multiple;
use super::push::{AMPLITUDE, frees_at, holding_push};
use super::thresholds::{Onset, Scan, longest, threshold_on};
use crate::dynamics::{Model, Regime, Request};
use crate::mechanics::Mechanism;
use crate::numeric::round::{ONE_TWO_FIVE, decade, round_down};
use crate::scene::{Excitation, Files, Scene, Start, Stops};
use crate::system::threads::Pool;

/// One in the last of three significant digits of a value.
fn third_digit(value: f64) -> f64 {
    10_f64.powi(decade(value) - 2)
}

/// How much shaking it takes, in g, each from rest at the scene's frequency, whatever the scene's own
/// amplitude is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds {
    /// The least amplitude that frees the mass from the stop it rests on, in closed form.
    pub frees_at: Option<f64>,
    /// The least amplitude whose settled motion crosses; none where none does up to
    /// [`searched_to`](Self::searched_to).
    pub crosses_from: Option<f64>,
    /// From this amplitude on every one that was tried crosses; none where the greatest does not.
    pub without_gap: Option<f64>,
    /// Up to where was searched.
    pub searched_to: f64,
}

/// Steps of the scan up to the push that holds the mass against the mechanism's largest force, as many more
/// of the same length above it, and by how much each further one is longer than the last.
const FINE_STEPS: u32 = 50;
const GROWTH: f64 = 1.02;

/// Steps that are run before it is looked whether one of them crosses.
const TOGETHER: usize = 32;

/// How many times that push is tried at most before nothing is said to cross.
const MOST_PUSHES: f64 = 30.0;

/// Above the first amplitude that crosses, gaps are looked for in so many steps of this share of it.
const GAP_STEPS: u32 = 50;
const GAP_STEP: f64 = 0.01;

/// Searches the amplitudes of a sine. None where the drive is no sine, nothing is to be crossed, or the
/// search was cancelled.
pub fn thresholds(scene: &Scene, mechanism: &Arc<Mechanism>, task: &Task) -> Option<Thresholds> {
    thresholds_on(None, scene, mechanism, task)
}

/// The same, by the threads of a pool.
pub(super) fn thresholds_on(
    pool: Option<&Pool>,
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    task: &Task,
) -> Option<Thresholds> {
    let Excitation::Sine { .. } = scene.excitation else { return None };
    let push = holding_push(scene, mechanism)?;
    let step = push / f64::from(FINE_STEPS);
    let mut values: Vec<f64> = (1..=2 * FINE_STEPS).map(|i| step * f64::from(i)).collect();
    while let Some(last) = values.last().filter(|last| **last < MOST_PUSHES * push) {
        values.push(last * GROWTH);
    }
    // as they are said: what is said to cross has been run
    values.iter_mut().for_each(|value| *value = multiple(*value, third_digit(*value)));
    values.dedup();
    let searched_to = values.last().copied().unwrap_or(push);
    let files = Files::default(); // an amplitude changes no mechanism
    let scan = |values: Vec<f64>| {
        let resolution = third_digit(values.first().copied().unwrap_or(push));
        let scan = Scan { field: AMPLITUDE.to_owned(), values, resolution };
        threshold_on((pool, 1), scene, mechanism, &files, (&scan, Onset::Crossing), task)
    };
    let mut found = Thresholds {
        frees_at: frees_at(scene, mechanism),
        crosses_from: None,
        without_gap: None,
        searched_to,
    };
    for part in values.chunks(TOGETHER) {
        // the last value before it, so that the first one that crosses can be located
        let first = values.iter().position(|own| *own == part[0]).unwrap_or(0);
        let Some(value) = scan(values[first.saturating_sub(1)..first + part.len()].to_vec())?.value else {
            continue;
        };
        let above = (0..=GAP_STEPS).map(|i| value * (1.0 + GAP_STEP * f64::from(i)));
        let above = above.map(|own| multiple(own, third_digit(own))).collect();
        found.crosses_from = Some(value);
        found.without_gap = scan(above)?.without_gap;
        break;
    }
    Some(found)
}

/// The search for stops makes at least so many steps from the well to the middle, and at most two and a half
/// times as many.
const FEWEST_STOPS: f64 = 50.0;

/// From the wells inward the first travel limit in mm, the same on both sides, whose run from rest is
/// interwell under the scene's own excitation; inner `None` where there is none, outer `None` where the
/// search was cancelled.
///
/// The limits that cross are no interval, so nothing is bisected: every step is run, 1, 2 or 5 of a decimal
/// place, a tenth of a millimetre where the wells are some 7 mm away. `restitution` is that of the stops that
/// are tried.
pub fn stops_that_cross(
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    restitution: f64,
    task: &Task,
) -> Option<Option<f64>> {
    let landscape = &mechanism.landscape;
    let Some(well) = landscape.right_stable().filter(|_| landscape.barrier.is_some()) else {
        return Some(None);
    };
    let well_mm = well.x.abs() * 1e3;
    let step = round_down(well_mm / FEWEST_STOPS, &ONE_TWO_FIVE);
    let mut trial = Scene { start: Start::Rest, ..scene.clone() };
    for i in (1..=(well_mm / step).floor() as u32).rev() {
        let travel_limit_mm = multiple(f64::from(i) * step, step);
        trial.stops = Stops::Rigid { travel_limit_mm, restitution };
        let Ok(model) = Model::build(&trial, Arc::clone(mechanism)) else { continue };
        let until_settled = Some(longest(&model));
        let request = Request { cancel: Some(task.cancel), until_settled, ..Request::default() };
        let run = model.run(&request);
        (task.tick)();
        if task.is_cancelled() {
            return None;
        }
        if run.summary.regime == Regime::Interwell {
            return Some(Some(travel_limit_mm));
        }
    }
    Some(None)
}
