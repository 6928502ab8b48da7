//! Amplitude thresholds of a sine, and stops with which the motion crosses.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::bisection::multiple;
use super::settled::followed;
use super::{Cancelled, Family, Found, Onset, Task, Verdict};
use crate::dynamics::{Model, Request, STANDARD_GRAVITY};
use crate::mechanics::{Landscape, Mechanism};
use crate::numeric::round::{ONE_TWO_FIVE, round_down};
use crate::scene::{Files, Scene, Stops};
use crate::system::threads::Pool;
use crate::threshold::{Above, Search, from_rest};

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

/// The amplitudes that are tried from rest where no range is given, so that scenes of any size have the same
/// search: `threshold`, `compare` and the window ask by it.
///
/// The scale is the amplitude whose inertial force equals the largest force of the mechanism between the rest
/// position and the barrier, which slow shaking needs to cross. The values go from 0 in even steps to twice
/// that amplitude, and on in steps of 1 % to thirty times. Without a barrier it is 1 g, and they end at 2 g.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Upward {
    /// Ascending.
    pub values: Vec<f64>,
    pub resolution: f64,
}

/// Least number of even steps up to the scale; the step is 1, 2 or 5 times a power of ten.
const STEPS: f64 = 100.0;
/// Multiple of the scale up to which steps are even.
const EVEN: f64 = 2.0;
/// Ratio of consecutive amplitudes above.
const GROWTH: f64 = 1.01;
/// Multiple of the scale at which the search ends.
const MAX_PUSHES: f64 = 30.0;
/// The resolution as a share of the step.
const RESOLUTION: f64 = 1e-3;

impl Upward {
    /// The values of the amplitude `field` of a scene.
    pub fn of(scene: &Scene, mechanism: &Mechanism, field: &str) -> Self {
        let amplitudes = scene.amplitudes();
        let amplitude = amplitudes.iter().find(|amplitude| amplitude.path == field);
        let in_unit = |g: f64| amplitude.map_or(g, |amplitude| amplitude.of(g * STANDARD_GRAVITY));
        match holding_push(scene, mechanism) {
            Some(push) => Self::new(in_unit(push), MAX_PUSHES),
            None => Self::new(in_unit(1.0), EVEN),
        }
    }

    fn new(scale: f64, pushes: f64) -> Self {
        let step = round_down(scale / STEPS, &ONE_TWO_FIVE);
        let even = (EVEN * scale / step).ceil() as u32;
        // in multiples of the step, so that the reported values are the ones that were run
        let mut values: Vec<f64> = (0..=even).map(|i| multiple(step * f64::from(i), step)).collect();
        while let Some(last) = values.last().filter(|last| **last < pushes * scale) {
            values.push(multiple(last * GROWTH, step));
        }
        Self { values, resolution: RESOLUTION * step }
    }
}

/// The thresholds of the amplitude; `None` without a harmonic drive or a barrier, or if cancelled.
pub fn thresholds(scene: &Scene, mechanism: &Arc<Mechanism>, task: &Task) -> Option<Thresholds> {
    let found = crossing(scene, mechanism, None, None, Above::Searched, task);
    let (crossing, searched_to) = found.ok().flatten()?;
    let frees_at = frees_at(scene, mechanism).map(|acceleration| acceleration / STANDARD_GRAVITY);
    Some(Thresholds { frees_at, crossing, searched_to })
}

/// The smallest amplitude in g of a harmonic drive whose settled motion from rest crosses, and the largest
/// amplitude searched. Runs continue up to `until_settled` in s, if given. `None` without such a drive, or
/// without a barrier between the stops.
pub(crate) fn crossing(
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    pool: Option<&Pool>,
    until_settled: Option<f64>,
    above: Above,
    task: &Task,
) -> Result<Option<(Found, f64)>, Cancelled> {
    let Some(drive) = scene.harmonic().filter(|_| holding_push(scene, mechanism).is_some()) else {
        return Ok(None);
    };
    let trial = Scene { excitation: drive.sine(), ..from_rest(scene) };
    let files = Files::default(); // an amplitude changes no mechanism
    let field = "excitation.amplitude_g";
    let upward = Upward::of(&trial, mechanism, field);
    let family = Family::new(&trial, &files, mechanism, field);
    let search = Search { family, onset: Onset::Crossing, until_settled, task, pool, ahead: 1 };
    let found = search.upward(&trial, mechanism, (field, &upward, above))?;
    Ok(upward.values.last().map(|last| (found, *last)))
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
pub(crate) fn frees_at(scene: &Scene, mechanism: &Mechanism) -> Option<f64> {
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
