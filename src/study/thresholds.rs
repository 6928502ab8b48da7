//! What would it take to cross: how much more shaking, or stops at which place?

use std::sync::Arc;

use super::Task;
use crate::dynamics::{Model, Regime, Request, STANDARD_GRAVITY};
use crate::mechanics::Mechanism;
use crate::scene::{Excitation, Scene, Start, Stops};

/// How much shaking it takes, in g, each from rest at the scene's frequency.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Thresholds {
    /// The least amplitude that frees the mass from the stop it rests on, in closed form.
    pub frees_at: Option<f64>,
    /// Up from the scene's own amplitude the first one whose run is interwell; without stops, where regular windows
    /// are rare and far up, the first one whose settled motion crosses at all.
    pub crosses_at: Option<f64>,
    /// Down from the scene's own amplitude the last one up to which every run is interwell.
    pub crosses_from: Option<f64>,
}

/// Step of the search in g, and how far up it goes.
const STEP: f64 = 0.01;
const MOST_STEPS: u32 = 200;

/// Searches the amplitudes of a sine around the scene's own. None where the drive is no sine, or the search was cancelled.
///
/// The amplitudes that cross are no interval, so nothing is bisected: every step of 0.01 g is run.
pub fn thresholds(scene: &Scene, mechanism: &Arc<Mechanism>, task: &Task) -> Option<Thresholds> {
    let Excitation::Sine { amplitude_g, .. } = scene.excitation else { return None };
    let mut trial = Scene { start: Start::Rest, ..scene.clone() };
    let mut crosses = |tried: f64| -> Option<bool> {
        if let Excitation::Sine { amplitude_g, .. } = &mut trial.excitation {
            *amplitude_g = tried;
        }
        let model = Model::build(&trial, Arc::clone(mechanism)).ok()?;
        let run = model.run(&Request { cancel: Some(task.cancel), ..Request::default() });
        (task.tick)();
        let irregular_counts = scene.stops == Stops::None && run.summary.regime == Regime::Irregular;
        (!task.is_cancelled()).then_some(irregular_counts || run.summary.regime == Regime::Interwell)
    };
    let mut found = Thresholds { frees_at: frees_at(scene, mechanism), ..Thresholds::default() };
    let own = amplitude_g.abs();
    if crosses(own)? {
        let mut last = own;
        for i in 1..=MOST_STEPS {
            let tried = ((own - STEP * f64::from(i)) / STEP).round() * STEP;
            if tried <= 0.0 || !crosses(tried)? {
                break;
            }
            last = tried;
        }
        found.crosses_from = Some(last);
    } else {
        for i in 1..=MOST_STEPS {
            let tried = ((own + STEP * f64::from(i)) / STEP).round() * STEP;
            if crosses(tried)? {
                found.crosses_at = Some(tried);
                break;
            }
        }
    }
    Some(found)
}

/// The amplitude in g at which the base's push reaches the force that presses the mass on the stop that it rests on.
fn frees_at(scene: &Scene, mechanism: &Mechanism) -> Option<f64> {
    let right = match scene.stops {
        Stops::Rigid { travel_limit_mm, .. } | Stops::Hertz { travel_limit_mm, .. } => travel_limit_mm / 1e3,
        Stops::Uneven { right_mm, .. } => right_mm? / 1e3,
        Stops::None => return None,
    };
    let well = mechanism.landscape.right_stable()?.x;
    let press = -mechanism.curve.force(right);
    (right < well && press > 0.0).then(|| press / (scene.mass_g / 1e3) / STANDARD_GRAVITY)
}

/// The search for stops makes at least so many steps from the well to the middle, and at most two and a half times as
/// many.
const FEWEST_STOPS: f64 = 50.0;

/// From the wells inward the first travel limit in mm, the same on both sides, whose run from rest is interwell under
/// the scene's own excitation; inner `None` where there is none, outer `None` where the search was cancelled.
///
/// The limits that cross are no interval, so nothing is bisected: every step is run, 1, 2 or 5 of a decimal place, a
/// tenth of a millimetre where the wells are some 7 mm away. `restitution` is that of the stops that are tried.
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
    let (leading, place) = round_step(well_mm / FEWEST_STOPS);
    let mut trial = Scene { start: Start::Rest, ..scene.clone() };
    for i in (1..=(well_mm / (leading * 10_f64.powi(place))).floor() as u32).rev() {
        // the decimal itself, not a sum of steps
        let count = leading * f64::from(i);
        let travel_limit_mm =
            if place < 0 { count / 10_f64.powi(-place) } else { count * 10_f64.powi(place) };
        trial.stops = Stops::Rigid { travel_limit_mm, restitution };
        let Ok(model) = Model::build(&trial, Arc::clone(mechanism)) else { continue };
        let run = model.run(&Request { cancel: Some(task.cancel), ..Request::default() });
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

/// The largest of 1, 2 and 5 times a power of ten that is not above `most`, as the digit and the power.
fn round_step(most: f64) -> (f64, i32) {
    let place = most.log10().floor();
    let share = most / 10_f64.powf(place);
    let digit = [5.0, 2.0].into_iter().find(|digit| *digit <= share).unwrap_or(1.0);
    (digit, place as i32)
}
