//! The stroboscopic map of a model by runs of whole forcing periods.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::dynamics::{Arrival, Model, Outcome, Pursuit, Request};
use crate::study::exponents::{ExponentOptions, average_exponents};
use crate::system::threads::{Pool, UnderWay, share};

/// A displacement and a velocity in units of the scene's scales.
type Point = [f64; 2];

/// A model, its range, and the threads that run it.
pub(super) struct Stroboscope<'a> {
    pub model: &'a Model,
    /// Displacements in m that the mass may have.
    pub room: (f64, f64),
    pub pool: &'a Pool,
    pub cancel: &'a AtomicBool,
}

impl Stroboscope<'_> {
    /// Length and speed that points are measured in.
    pub fn units(&self) -> (f64, f64) {
        let scales = self.model.scales();
        (scales.length, scales.speed)
    }

    /// A state in m and m/s as a point.
    pub fn point(&self, (x, v): (f64, f64)) -> Point {
        let (length, speed) = self.units();
        [x / length, v / speed]
    }

    /// A point as a state in m and m/s.
    pub fn state(&self, [x, v]: Point) -> (f64, f64) {
        let (length, speed) = self.units();
        (x * length, v * speed)
    }

    /// Whether a motion may begin in a point.
    pub fn has(&self, point: Point) -> bool {
        let (x, v) = self.state(point);
        x >= self.room.0 && x <= self.room.1 && v.is_finite()
    }

    /// Where motions from points are after so many forcing periods each; none of those that begin outside the
    /// room, end early, or come to rest on the way, after which the map has no inverse. None at all where it
    /// was cancelled.
    pub fn map(&self, starts: &[(Point, u32)]) -> Option<Vec<Option<Point>>> {
        let valid: Vec<usize> = (0..starts.len()).filter(|own| self.has(starts[*own].0)).collect();
        let pursuits: Vec<Pursuit> = valid
            .iter()
            .map(|own| Pursuit {
                start: self.state(starts[*own].0),
                known: &[],
                regions: &[],
                repeats_from: u64::MAX,
                most_periods: starts[*own].1.into(),
                releases: 0,
            })
            .collect();
        let mut images = vec![None; starts.len()];
        for (place, arrival) in valid.into_iter().zip(self.pursue(&pursuits, &|_| ())?) {
            images[place] = match arrival {
                Arrival::Unsettled(end) if end.outcome == Outcome::Done => {
                    Some(self.point((end.final_x, end.final_v)))
                }
                _ => None,
            };
        }
        Some(images)
    }

    /// States of motions, once a period for so many `periods` without the first ones; none where one of them
    /// ends early. None at all where it was cancelled.
    pub fn paths(
        &self,
        starts: &[(f64, f64)],
        periods: u32,
        skipped: usize,
    ) -> Option<Option<Vec<(f64, f64)>>> {
        let period = self.model.forcing_period().unwrap_or(1.0);
        let times: Vec<f64> = (1..=periods).map(|own| f64::from(own) * period).collect();
        let last = f64::from(periods) * period;
        let path = |(): &mut (), own: usize| {
            let model = self.model.with_start(starts[own]).with_duration(last, last);
            let kept = &times[skipped.min(times.len())..];
            let request = Request { sample_times: kept, cancel: Some(self.cancel), ..Request::default() };
            let run = model.run(&request);
            match run.summary.outcome {
                Outcome::Done => Ok(Some(run.samples)),
                Outcome::Cancelled { .. } => Err(()),
                _ => Ok(None),
            }
        };
        let all = self.pool.map(starts.len(), || (), path).ok()?;
        let all: Option<Vec<_>> = all.into_iter().collect();
        Some(all.map(|all| all.iter().flatten().map(|sample| (sample.x, sample.v)).collect()))
    }

    /// Whether the motion that has a state in m and m/s once a period is irregular by its exponent.
    pub fn is_irregular(&self, state: (f64, f64)) -> bool {
        let phase = self.model.drive_phase(0.0).unwrap_or(0.0);
        let found = average_exponents(self.model, (state, phase), ExponentOptions::PERIODS, self.cancel);
        found.is_ok_and(|own| own.is_irregular())
    }

    /// What pursuits come to, in their order; `tick` is called for each. None where it was cancelled.
    pub fn pursue(&self, pursuits: &[Pursuit], tick: &(dyn Fn(&Pursuit) + Sync)) -> Option<Vec<Arrival>> {
        let work = |next: &dyn Fn(UnderWay) -> Option<usize>| {
            let mut arrivals = Vec::new();
            let mut ended = |place: usize, arrival| {
                tick(&pursuits[place]);
                arrivals.push((place, arrival));
            };
            let mut next = |held: UnderWay| next(held).filter(|_| !self.is_cancelled());
            self.model.pursue(pursuits, Some(self.cancel), &mut next, &mut ended);
            if self.is_cancelled() { Err(()) } else { Ok(arrivals) }
        };
        share(Some(self.pool), pursuits.len(), work).ok()
    }

    fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}
