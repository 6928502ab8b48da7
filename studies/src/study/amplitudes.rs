//! Amplitude thresholds of a sine, and stops with which the motion crosses.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::bisection::multiple;
use super::settled::followed;
use super::thresholds::{Answers, Search, from_rest};
use super::{Cancelled, Family, Found, Onset, Task, Verdict};
use crate::dynamics::{Model, Request, STANDARD_GRAVITY};
use crate::mechanics::{Landscape, Mechanism};
use crate::numeric::elementary;
use crate::numeric::round::{ONE_TWO_FIVE, decade, round_down};
use crate::scene::{Files, Scene, Stops};
use crate::system::threads::Pool;

/// The place value of the third significant digit.
fn third_digit(value: f64) -> f64 {
    elementary::powi(10.0, decade(value) - 2)
}

/// Threshold amplitudes in g of motions from rest at the frequency of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Thresholds {
    /// Smallest amplitude that releases the mass from the stop on which it rests, in closed form.
    pub frees_at: Option<f64>,
    /// Smallest amplitude whose settled motion crosses, up to [`searched_to`](Self::searched_to). Windows,
    /// gaps and the first amplitude that is known to cross are searched up to 1.5 times this amplitude.
    pub crossing: Found,
    /// The largest amplitude searched.
    pub searched_to: f64,
}

/// Number of steps of the scan up to the amplitude whose inertial force equals the largest force of the
/// mechanism, and again up to twice that amplitude.
const FINE_STEPS: u32 = 50;
/// Ratio of consecutive amplitudes above that range.
const GROWTH: f64 = 1.02;

/// Number of steps that are run together before checking whether one of them crosses.
const TOGETHER: usize = 32;

/// Multiple of that amplitude at which the search ends.
const MAX_PUSHES: f64 = 30.0;

/// Number of steps above the crossing threshold in which changes are searched.
const GAP_STEPS: u32 = 50;
/// Length of such a step, as a share of the threshold.
const GAP_STEP: f64 = 0.01;

/// The thresholds of the amplitude; `None` without a harmonic drive or a barrier, or if cancelled.
pub fn thresholds(scene: &Scene, mechanism: &Arc<Mechanism>, task: &Task) -> Option<Thresholds> {
    let found = crossing(scene, mechanism, None, None, Above::Searched, task);
    let (crossing, searched_to) = found.ok().flatten()?;
    let frees_at = frees_at(scene, mechanism).map(|acceleration| acceleration / STANDARD_GRAVITY);
    Some(Thresholds { frees_at, crossing, searched_to })
}

/// Whether the range above a threshold is searched for windows, gaps and values known to cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Above {
    Searched,
    Skipped,
}

/// The smallest amplitude in g of a harmonic drive whose settled motion from rest crosses, and the largest
/// amplitude searched. Runs continue up to `until_settled` in s, if given. `None` without such a drive, or
/// without a barrier between the stops.
pub(super) fn crossing(
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    pool: Option<&Pool>,
    until_settled: Option<f64>,
    above: Above,
    task: &Task,
) -> Result<Option<(Found, f64)>, Cancelled> {
    let Some(drive) = scene.harmonic() else { return Ok(None) };
    let Some(push) = holding_push(scene, mechanism) else { return Ok(None) };
    let step = push / f64::from(FINE_STEPS);
    let mut values: Vec<f64> = (1..=2 * FINE_STEPS).map(|i| step * f64::from(i)).collect();
    while let Some(last) = values.last().filter(|last| **last < MAX_PUSHES * push) {
        values.push(last * GROWTH);
    }
    // rounded as in the report, so that the reported value is one that was run
    values.iter_mut().for_each(|value| *value = multiple(*value, third_digit(*value)));
    values.dedup();
    let searched_to = values.last().copied().unwrap_or(push);
    let trial = Scene { excitation: drive.sine(), ..from_rest(scene) };
    let files = Files::default(); // an amplitude changes no mechanism
    let family = Family::new(&trial, &files, mechanism, "excitation.amplitude_g");
    let search = Search { family, onset: Onset::Crossing, until_settled, task, pool, ahead: 1 };
    let (mut answers, mut resolution) = (Answers::default(), third_digit(push));
    for part in values.chunks(TOGETHER) {
        resolution = third_digit(answers.scan.last().map_or(part[0], |last| last.0));
        search.scan(&mut answers, part, resolution)?;
        if let Some(first) = answers.first_with_motion() {
            // values beyond the threshold are dropped, since their number depends on where a part ends
            answers.scan.truncate(first + 1);
            break;
        }
    }
    let mut found = answers.found(resolution);
    if let Some(value) = found.value.filter(|_| above == Above::Searched) {
        let tried = (1..=GAP_STEPS).map(|i| value * (1.0 + GAP_STEP * f64::from(i)));
        let mut tried: Vec<f64> = tried.map(|value| multiple(value, third_digit(value))).collect();
        tried.dedup();
        let mut answers = Answers::begun_with(value);
        search.scan(&mut answers, &tried, resolution)?;
        let Found { high, windows, without_gap, .. } = answers.found(resolution);
        let high = [found.high, high].into_iter().flatten().reduce(f64::min);
        found = Found { high, windows, without_gap, ..found };
    }
    Ok(Some((found, searched_to)))
}

/// The amplitude in g whose inertial force equals the largest one between the rest position and the barrier.
fn holding_push(scene: &Scene, mechanism: &Mechanism) -> Option<f64> {
    let Landscape { barrier, extrema, .. } = &mechanism.landscape;
    let barrier = barrier.as_ref().filter(|_| can_cross(scene, mechanism))?;
    let rests = stops(scene)[1].map_or(barrier.right_well, |stop| stop.min(barrier.right_well));
    let between = |x: f64| x >= barrier.x && x <= rests;
    let inside = extrema.iter().filter(|extremum| between(extremum.x)).map(|extremum| extremum.force.abs());
    let force = inside.fold(mechanism.curve.force(rests).abs(), f64::max);
    Some(force / (scene.mass_g / 1e3) / STANDARD_GRAVITY).filter(|push| *push > 0.0 && push.is_finite())
}

/// Whether there is a barrier between the stops of a scene. A mass passes beyond compliant stops.
pub fn can_cross(scene: &Scene, mechanism: &Mechanism) -> bool {
    let [left, right] = stops(scene);
    let soft = matches!(scene.stops, Stops::Hertz { .. });
    let between = |x: f64| left.is_none_or(|stop| stop < x) && right.is_none_or(|stop| x < stop);
    let Landscape { barrier, left_barrier, .. } = &mechanism.landscape;
    barrier.map(|barrier| barrier.x).into_iter().chain(*left_barrier).any(|x| soft || between(x))
}

/// Displacements of the left and the right stop in m.
fn stops(scene: &Scene) -> [Option<f64>; 2] {
    scene.stops.positions_mm().map(|stop| stop.map(|mm| mm / 1e3))
}

/// The amplitude in m/s^2 of a harmonic drive whose inertial force is that of the mass on its stop.
pub(super) fn frees_at(scene: &Scene, mechanism: &Mechanism) -> Option<f64> {
    scene.harmonic()?;
    let right = stops(scene)[1]?;
    let well = mechanism.landscape.right_stable()?.x;
    let press = -mechanism.curve.force(right);
    (right < well && press > 0.0).then(|| press / (scene.mass_g / 1e3))
}

/// Smallest number of steps from the well to the middle in the search for stops; up to 2.5 times as many.
const MIN_STEPS: f64 = 50.0;

/// The largest travel limit in mm inside the wells, the same on both sides, whose motion from rest is
/// known to be interwell under the scene's excitation; `None` if there is none.
///
/// The limits that cross need not form an interval, so every step is run: 1, 2 or 5 times a power of ten, 0.1
/// mm if the wells are about 7 mm away. All stops have this `restitution`.
pub fn stops_that_cross(
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    restitution: f64,
    task: &Task,
) -> Result<Option<f64>, Cancelled> {
    let landscape = &mechanism.landscape;
    let Some(well) = landscape.right_stable().filter(|_| landscape.barrier.is_some()) else {
        return Ok(None);
    };
    let well_mm = well.x.abs() * 1e3;
    let step = round_down(well_mm / MIN_STEPS, &ONE_TWO_FIVE);
    let mut trial = from_rest(scene);
    for i in (1..=(well_mm / step).floor() as u32).rev() {
        let travel_limit_mm = multiple(f64::from(i) * step, step);
        trial.stops = Stops::Rigid { travel_limit_mm, restitution };
        let Ok(model) = Model::build(&trial, Arc::clone(mechanism)) else { continue };
        let (model, request) = followed(model, None);
        let run = model.run(&Request { cancel: Some(task.cancel), ..request });
        (task.tick)();
        task.check_cancelled()?;
        if Onset::Interwell.verdict(&run.summary) == (Verdict { does: true, known: true }) {
            return Ok(Some(travel_limit_mm));
        }
    }
    Ok(None)
}
