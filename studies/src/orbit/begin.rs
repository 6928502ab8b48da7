//! Which of the periodic motions of a scene is meant: that of its run, that near a state, or one of a kind.

use std::str::FromStr;
use std::sync::atomic::AtomicBool;

use nalgebra::Vector3;
use serde::Deserialize;

use super::{NoOrbit, OrbitAnswer, Units, allowed, ended, map_of, orbit_near};
use crate::dynamics::{MapState, Model, Outcome, Regime, StroboscopicMap};
use crate::study::{number, settled};

/// Number of strobes of a motion without a period that are searched for a near return.
const STROBES: usize = 400;

/// Longest period, in forcing periods, that is tried near a state.
const LONGEST: u32 = 12;

/// Starts in each direction from which a motion with a number of impacts is searched for.
const STARTS: u32 = 15;
/// Largest displacement and velocity of these starts, in the scales.
const EXTENT: f64 = 2.0;
/// Forcing periods for which a start is followed before Newton's method is tried once more.
const PERIODS: u32 = 50;

/// Which of the periodic motions of a scene is meant.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
pub enum Begin {
    /// That near the settled motion of the scene's run.
    #[default]
    Run,
    /// That nearest to a state at the phase of the drive.
    State(MapState),
    /// One with this many impacts in its period, stable or not.
    Impacts(u64),
}

impl FromStr for Begin {
    type Err = String;

    /// Reads `X_MM,V_M_PER_S`, with A or V of a circuit as a third number, or `impacts=N`; the error says so.
    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "write X_MM,V_M_PER_S, such as 1.5,0.02, with A or V of a circuit as a third \
                            number, or impacts=N, such as impacts=1";
        if let Some(impacts) = text.strip_prefix("impacts=") {
            return impacts.trim().parse().map(Self::Impacts).map_err(|_| FORM.to_owned());
        }
        let numbers = text.split(',').map(number(FORM)).collect::<Result<Vec<f64>, String>>()?;
        match numbers[..] {
            [x_mm, v] => Ok(Self::State((x_mm * 1e-3, v).into())),
            [x_mm, v, electrical] => Ok(Self::State(MapState { x: x_mm * 1e-3, v, electrical })),
            _ => Err(FORM.to_owned()),
        }
    }
}

/// The periodic orbit that is meant, at a phase of the drive in forcing periods; with the period `period`, if
/// given.
///
/// Precondition: the drive repeats.
pub fn begun(
    model: &Model,
    phase: f64,
    period: Option<u32>,
    begin: Begin,
    cancel: &AtomicBool,
) -> Result<OrbitAnswer, NoOrbit> {
    let map = || map_of(model, phase, cancel).ok_or(NoOrbit::NotSettled);
    match begin {
        Begin::Run => orbit(model, phase, period, cancel),
        Begin::State(state) => nearest(&map()?, state, period),
        Begin::Impacts(impacts) => with_impacts(&map()?, period.unwrap_or(1), impacts),
    }
}

/// The periodic orbit near the settled motion of a run of `model`, at a phase of the drive in forcing
/// periods; with the period `period`, if given.
///
/// Precondition: the drive repeats.
pub fn orbit(
    model: &Model,
    phase: f64,
    period: Option<u32>,
    cancel: &AtomicBool,
) -> Result<OrbitAnswer, NoOrbit> {
    let (Some(map), Some(forcing)) = (map_of(model, phase, cancel), model.forcing_period()) else {
        return Err(NoOrbit::NotSettled);
    };
    let summary = settled(model, cancel).ok_or(NoOrbit::Cancelled)?;
    if summary.outcome != Outcome::Done {
        return Err(NoOrbit::Ended(summary.outcome));
    }
    // a mass at rest has the period 1
    let still = (summary.regime == Regime::Rest).then_some(1);
    let periods = period.or(summary.period).or(still).ok_or(NoOrbit::NotSettled)?;
    let since = (summary.window.1.max(summary.settles_at.unwrap_or(0.0)) / forcing).ceil();
    let (x, v) = model.start();
    let start = MapState { x, v, electrical: model.start_electrical() };
    let until = map.first_strobe() + since * forcing;
    let run = StroboscopicMap::over(model, until).cancelled_by(cancel).pass(start, 1);
    let state = MapState::from(&run);
    let guess = if summary.period.or(still).is_some() { state } else { closest_return(&map, state, periods) };
    of_period(orbit_near(&map, guess, periods)?, period)
}

/// The stroboscopic state after `from` with the closest return after `periods`.
fn closest_return(map: &StroboscopicMap, from: MapState, periods: u32) -> MapState {
    let units = Units::of(map.model(), 1.0);
    let next = |state: &MapState| {
        let passage = map.pass(*state, 1);
        (passage.outcome == Outcome::Done).then(|| MapState::from(&passage))
    };
    let states: Vec<_> = std::iter::successors(Some(from), next).take(STROBES + periods as usize).collect();
    let returns = states.iter().zip(states.iter().skip(periods as usize));
    let far = |(a, b): (&MapState, &MapState)| Vector3::from(units.apart(*b, *a)).norm();
    returns.min_by(|a, b| far(*a).total_cmp(&far(*b))).map_or(from, |(state, _)| *state)
}

/// The orbit, if it has the period that is asked for.
fn of_period(orbit: OrbitAnswer, period: Option<u32>) -> Result<OrbitAnswer, NoOrbit> {
    match period {
        Some(period) if orbit.period != period => Err(NoOrbit::Shorter(orbit.period)),
        _ => Ok(orbit),
    }
}

/// The orbit nearest to a state, of this period or one of at most [`LONGEST`].
fn nearest(map: &StroboscopicMap, state: MapState, period: Option<u32>) -> Result<OrbitAnswer, NoOrbit> {
    if period.is_some() {
        return of_period(orbit_near(map, state, period.unwrap_or(1))?, period);
    }
    let units = Units::of(map.model(), 1.0);
    let far = |orbit: &OrbitAnswer| Vector3::from(units.apart(state, orbit.state)).norm();
    let mut best = Err(NoOrbit::NotConverged);
    for period in 1..=LONGEST {
        match orbit_near(map, state, period) {
            Ok(found) if best.as_ref().is_ok_and(|known| far(&found) >= far(known)) => {}
            Err(NoOrbit::Cancelled) => return Err(NoOrbit::Cancelled),
            Ok(found) => best = Ok(found),
            Err(_) => {}
        }
    }
    best
}

/// The first orbit with a period and this many impacts to which a start leads, at once or after some periods.
fn with_impacts(map: &StroboscopicMap, period: u32, impacts: u64) -> Result<OrbitAnswer, NoOrbit> {
    let scales = map.model().scales();
    let share = |place: u32| EXTENT * (2.0 * f64::from(place) / f64::from(STARTS - 1) - 1.0);
    let starts = (0..STARTS * STARTS).map(|number| {
        let (x, v) = (share(number % STARTS) * scales.length, share(number / STARTS) * scales.speed);
        allowed(map.model(), MapState { x, v, electrical: 0.0 })
    });
    for state in starts {
        let later = || {
            let run = map.pass(state, PERIODS);
            if run.outcome == Outcome::Done { Ok(MapState::from(&run)) } else { Err(ended(run.outcome)) }
        };
        for guess in [Ok(state), later()] {
            match guess.and_then(|guess| orbit_near(map, guess, period)) {
                Ok(orbit) if orbit.period == period && orbit.passage.impacts == impacts => return Ok(orbit),
                Err(NoOrbit::Cancelled) => return Err(NoOrbit::Cancelled),
                _ => {}
            }
        }
    }
    Err(NoOrbit::NotFound { starts: STARTS * STARTS, period, impacts })
}
