//! The stroboscopic map of a model, by runs of whole periods, and the work that a map of basins may take.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::dynamics::{Arrival, MapState, Model, Outcome, Pursued, Pursuit, Request, Sample, Summary};
use crate::study::orbit::Units;
use crate::study::{Cancelled, ExponentOptions, Result, average_exponents, finished};
use crate::system::threads::{Pool, UnderWay, share};

/// A displacement, a velocity and the state of a circuit (0 without one) in units of the scene's scales.
pub(super) type Point = [f64; 3];

/// Cost of a forcing period with derivatives, relative to one without.
const WITH_DERIVATIVES: u64 = 4;

/// A model, its limits of displacement, and the threads that run it.
#[derive(Clone, Copy)]
pub(super) struct Stroboscope<'a> {
    pub model: &'a Model,
    /// Smallest and largest displacement in m that the mass can have.
    pub room: (f64, f64),
    pub pool: &'a Pool,
    pub cancel: &'a AtomicBool,
    /// Units of work that a forcing period takes.
    pub work_of_a_period: f64,
}

impl Stroboscope<'_> {
    /// Units of points.
    pub fn units(&self) -> Units {
        Units::of(self.model, 1.0)
    }

    pub fn point(&self, MapState { x, v, electrical }: MapState) -> Point {
        let [length, speed, charge] = self.units().of_state();
        [x / length, v / speed, electrical / charge]
    }

    pub fn state(&self, [x, v, w]: Point) -> MapState {
        let [length, speed, charge] = self.units().of_state();
        MapState { x: x * length, v: v * speed, electrical: w * charge }
    }

    /// The state of the circuit at each start.
    pub fn electrical(&self) -> f64 {
        self.model.start_electrical()
    }

    /// Number of coordinates of a point that vary: two, or three beside a circuit.
    pub fn size(&self) -> usize {
        if self.model.has_electrical_state() { 3 } else { 2 }
    }

    /// Whether a point lies between the limits of displacement.
    pub fn has(&self, point: Point) -> bool {
        let MapState { x, v, electrical } = self.state(point);
        x >= self.room.0 && x <= self.room.1 && v.is_finite() && electrical.is_finite()
    }

    /// The images of points, each after its number of forcing periods. `None` for motions that begin outside
    /// the limits, end early or come to rest, and for all if they need more work than a search may take.
    pub fn map(&self, starts: &[(Point, u32)]) -> Result<Vec<Option<Point>>> {
        let mut images = vec![None; starts.len()];
        if self.is_beyond(starts.iter().map(|(_, periods)| u64::from(*periods)).sum()) {
            return Ok(images);
        }
        let valid: Vec<usize> = (0..starts.len()).filter(|place| self.has(starts[*place].0)).collect();
        let pursuits: Vec<Pursuit> = valid
            .iter()
            .map(|place| Pursuit {
                start: self.state(starts[*place].0),
                known: &[],
                regions: &[],
                repeats_from: Pursuit::NEVER,
                max_periods: starts[*place].1.into(),
                releases: 0,
                max_work: u64::MAX,
                beside: None,
            })
            .collect();
        for (place, pursued) in valid.into_iter().zip(self.pursue(&pursuits, &|_| ())?) {
            images[place] = match pursued.arrival {
                Arrival::Unsettled(end) if end.outcome == Outcome::Done => {
                    Some(self.point(final_state(&end)))
                }
                _ => None,
            };
        }
        Ok(images)
    }

    /// Stroboscopic states of motions over `periods` forcing periods, without the first `skipped` ones;
    /// `None` if a motion ends early or they need more work than a search may take.
    pub fn paths(&self, starts: &[MapState], periods: u32, skipped: usize) -> Result<Option<Vec<MapState>>> {
        if self.is_beyond(starts.len() as u64 * u64::from(periods)) {
            return Ok(None);
        }
        let period = self.period();
        let times: Vec<f64> = (1..=periods).map(|number| f64::from(number) * period).collect();
        let last = f64::from(periods) * period;
        let path = |number: usize| {
            let model = self.model.with_start(starts[number]).with_duration(last, last);
            let kept = &times[skipped.min(times.len())..];
            let request = Request { sample_times: kept, cancel: Some(self.cancel), ..Request::default() };
            let run = finished(model.run(&request)).ok_or(Cancelled)?;
            Ok((run.summary.outcome == Outcome::Done).then_some(run.samples))
        };
        let all: Option<Vec<_>> = self.pool.map(starts.len(), path)?.into_iter().collect();
        let state = |&Sample { x, v, electrical, .. }: &Sample| MapState { x, v, electrical };
        Ok(all.map(|paths| paths.iter().flatten().map(state).collect()))
    }

    /// Whether the motion through a state is irregular by its Lyapunov exponent; false if that takes more
    /// work than a search may.
    pub fn is_irregular(&self, state: MapState) -> bool {
        if self.is_beyond(WITH_DERIVATIVES * u64::from(ExponentOptions::PERIODS)) {
            return false;
        }
        let phase = self.model.drive_phase(0.0).unwrap_or(0.0);
        let found = average_exponents(self.model, state, phase, ExponentOptions::PERIODS, self.cancel);
        found.is_ok_and(|exponents| exponents.is_irregular())
    }

    /// The results of pursuits in order, with a `tick` for each.
    pub fn pursue(&self, pursuits: &[Pursuit], tick: &(dyn Fn(&Pursuit) + Sync)) -> Result<Vec<Pursued>> {
        let work = |next: &dyn Fn(UnderWay) -> Option<usize>| {
            let mut all = Vec::new();
            let mut ended = |place: usize, pursued| {
                tick(&pursuits[place]);
                all.push((place, pursued));
            };
            let mut next = |under_way: UnderWay| next(under_way).filter(|_| !self.is_cancelled());
            self.model.pursue(pursuits, Some(self.cancel), &mut next, &mut ended);
            if self.is_cancelled() { Err(Cancelled) } else { Ok(all) }
        };
        share(Some(self.pool), pursuits.len(), work)
    }

    /// The forcing period in s.
    fn period(&self) -> f64 {
        self.model.forcing_period().unwrap_or(1.0)
    }

    /// Whether so many forcing periods take more work than a search may.
    fn is_beyond(&self, periods: u64) -> bool {
        periods as f64 * self.work_of_a_period > SEARCH_WORK
    }

    fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

pub(super) fn final_state(summary: &Summary) -> MapState {
    MapState { x: summary.final_x, v: summary.final_v, electrical: summary.final_electrical }
}

/// Units of work that a start may take, about a second of one core: twenty times those of the prototype over
/// 1000 forcing periods. If a period contains ten thousand oscillations in a well, a map without this limit
/// would take days. It is the same for each start, so that no answer depends on other starts.
pub(super) const START_WORK: u64 = 100_000_000;

/// Units of work of one search for an ellipse or a region: those of all circles around an orbit of 12 periods
/// of the prototype, over the largest multiple of its period.
const SEARCH_WORK: f64 = 2e9;
