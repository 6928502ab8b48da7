//! The stroboscopic map of a model, by runs of whole periods, and the budget of work of a map of basins.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::dynamics::{Arrival, MapState, Model, Outcome, Pursued, Pursuit, Request, Sample, Summary};
use crate::study::orbit::Units;
use crate::study::{Cancelled, ExponentOptions, Result, average_exponents, finished};
use crate::system::threads::{Pool, UnderWay, share};

/// A displacement, a velocity and the state of a circuit (0 without one) in units of the scene's scales.
pub(super) type Point = [f64; 3];

/// Cost of a forcing period with derivatives, relative to one without.
const WITH_DERIVATIVES: u64 = 4;

/// A model, its limits of displacement, and the threads that run it.
pub(super) struct Stroboscope<'a> {
    pub model: &'a Model,
    /// Smallest and largest displacement in m that the mass can have.
    pub room: (f64, f64),
    pub pool: &'a Pool,
    pub cancel: &'a AtomicBool,
    pub effort: &'a Effort,
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
    /// the limits, end early or come to rest, and for all if they need more work than is left.
    pub fn map(&self, starts: &[(Point, u32)]) -> Result<Vec<Option<Point>>> {
        let mut images = vec![None; starts.len()];
        if !self.effort.has_room_for(starts.iter().map(|(_, periods)| u64::from(*periods)).sum()) {
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
    /// `None` if a motion ends early or they need more work than is left.
    pub fn paths(&self, starts: &[MapState], periods: u32, skipped: usize) -> Result<Option<Vec<MapState>>> {
        if !self.effort.has_room_for(starts.len() as u64 * u64::from(periods)) {
            return Ok(None);
        }
        let period = self.period();
        let times: Vec<f64> = (1..=periods).map(|number| f64::from(number) * period).collect();
        let last = f64::from(periods) * period;
        let path = |(): &mut (), number: usize| {
            let model = self.model.with_start(starts[number]).with_duration(last, last);
            let kept = &times[skipped.min(times.len())..];
            let request = Request { sample_times: kept, cancel: Some(self.cancel), ..Request::default() };
            let run = finished(model.run(&request)).ok_or(Cancelled)?;
            Ok((run.summary.outcome == Outcome::Done).then_some(run.samples))
        };
        let all: Option<Vec<_>> = self.pool.map(starts.len(), || (), path)?.into_iter().collect();
        let state = |&Sample { x, v, electrical, .. }: &Sample| MapState { x, v, electrical };
        Ok(all.map(|paths| paths.iter().flatten().map(state).collect()))
    }

    /// Whether the motion through a state is irregular by its Lyapunov exponent; false without work left.
    pub fn is_irregular(&self, state: MapState) -> bool {
        if !self.effort.has_room_for(WITH_DERIVATIVES * u64::from(ExponentOptions::PERIODS)) {
            return false;
        }
        let phase = self.model.drive_phase(0.0).unwrap_or(0.0);
        let found = average_exponents(self.model, state, phase, ExponentOptions::PERIODS, self.cancel);
        found.is_ok_and(|exponents| exponents.is_irregular())
    }

    /// The results of pursuits in order, with a `tick` for each.
    pub fn pursue(&self, pursuits: &[Pursuit], tick: &(dyn Fn(&Pursuit) + Sync)) -> Result<Vec<Pursued>> {
        let period = self.period();
        let work = |next: &dyn Fn(UnderWay) -> Option<usize>| {
            let mut all = Vec::new();
            let mut ended = |place: usize, pursued| {
                self.effort.add(&pursuits[place], &pursued, period);
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

    fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

pub(super) fn final_state(summary: &Summary) -> MapState {
    MapState { x: summary.final_x, v: summary.final_v, electrical: summary.final_electrical }
}

/// Units of work for orbits and regions: some ellipses of an orbit of 12 periods that passes a kink.
const MAP_WORK: u64 = 20_000_000_000;

/// Units of work per start: four times those of the prototype over 1000 forcing periods.
const START_WORK: u64 = 20_000_000;

/// Number of equal shares of the remaining work that one start may take, since starts differ in work.
const MAX_SHARES: u64 = 4;
/// Units of work that a start may take in any case.
const MIN_START_WORK: u64 = 2_000_000;

/// Budget of work of one map, in the units of a [`Pursuit`].
///
/// If a forcing period contains ten thousand oscillations in a well, a map without a budget would take days.
/// The work allowed for a start depends on what is left between rounds, and therefore not on the number of
/// threads.
#[derive(Debug)]
pub(super) struct Effort {
    budget: u64,
    done: AtomicU64,
    /// Number of forcing periods that this work covered.
    periods: AtomicU64,
}

impl Effort {
    pub fn of_starts(count: usize) -> Self {
        let budget = MAP_WORK + START_WORK.saturating_mul(count as u64);
        Self { budget, done: AtomicU64::new(0), periods: AtomicU64::new(0) }
    }

    /// Adds the work of a pursuit; `period` is the forcing period in s.
    pub fn add(&self, pursuit: &Pursuit, pursued: &Pursued, period: f64) {
        let ended = || match &pursued.arrival {
            Arrival::Unsettled(summary) => summary.outcome.ended_at().map(|at| (at / period) as u64),
            _ => None,
        };
        let periods = pursued.periods.or_else(ended).unwrap_or(pursuit.max_periods);
        self.done.fetch_add(pursued.work, Ordering::Relaxed);
        self.periods.fetch_add(periods, Ordering::Relaxed);
    }

    fn left(&self) -> u64 {
        self.budget.saturating_sub(self.done.load(Ordering::Relaxed))
    }

    /// Units of work allowed for each start while `remaining` starts are still to be followed.
    pub fn of_one(&self, remaining: usize) -> u64 {
        (MAX_SHARES * (self.left() / remaining.max(1) as u64)).max(MIN_START_WORK)
    }

    /// Whether the work left is enough for `periods` more forcing periods of average work.
    pub fn has_room_for(&self, periods: u64) -> bool {
        let (done, before) = (self.done.load(Ordering::Relaxed), self.periods.load(Ordering::Relaxed));
        done as f64 / before.max(1) as f64 * periods as f64 <= self.left() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_start_may_take_some_shares_of_what_is_left_and_a_search_what_fits() {
        let effort = Effort::of_starts(100);
        assert_eq!(effort.of_one(100), MAX_SHARES * (MAP_WORK / 100 + START_WORK));
        assert!(effort.has_room_for(u64::MAX), "nothing is known of the work of a period yet");
        let pursuit = Pursuit {
            start: (0.0, 0.0).into(),
            known: &[],
            regions: &[],
            repeats_from: 0,
            max_periods: 1000,
            releases: 0,
            max_work: u64::MAX,
        };
        let arrival = Arrival::Captured(0);
        let pursued = |work| Pursued { arrival: arrival.clone(), periods: Some(1000), crossings: 0, work };
        effort.add(&pursuit, &pursued(MAP_WORK), 1.0);
        // 2e7 units a period, and 2e9 are left
        assert!(effort.has_room_for(100) && !effort.has_room_for(101));
        effort.add(&pursuit, &pursued(MAP_WORK), 1.0);
        assert!(!effort.has_room_for(1));
        assert_eq!(effort.of_one(3), MIN_START_WORK);
    }
}
