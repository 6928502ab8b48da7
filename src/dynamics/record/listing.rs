//! Stroboscopic states that a run lists: those of its settled window at a phase of the drive, and the last at
//! the phase of its start.

use super::recorder::{MOST_STROBES, Recorder};
use crate::dynamics::clock::{Clock, Instant};
use crate::dynamics::result::{Request, SectionPoint};
use crate::dynamics::step::path::{Path, StepView};
use crate::numeric::Scalar;

/// Instants closer than this share of a forcing period are the same: more than rounding can set apart.
const SAME: f64 = 1e-9;

/// States once a forcing period.
#[derive(Debug, Clone)]
pub(crate) struct Listing<T> {
    /// The instant of the next one, and how many are still to be listed.
    next: Instant<T>,
    left: u64,
    /// Cycles of the clock from one to the next.
    cycles: i64,
    /// Displacement in m and velocity in m/s of those since `first`; where only the last is kept, of that.
    states: Vec<(f64, f64)>,
    first: Instant<T>,
    last_only: bool,
}

/// What a run lists.
#[derive(Debug, Clone)]
pub(crate) struct Listings<T> {
    section: Option<Listing<T>>,
    carried: Option<Listing<T>>,
}

/// How far the listings had come at an instant: the states of the section, and the next instants.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Listed<T> {
    states: usize,
    next: [Option<Instant<T>>; 2],
}

impl<T: Scalar> Listing<T> {
    fn add(&mut self, (x, v): (f64, f64)) {
        if self.last_only {
            self.states.clear();
        }
        self.states.push((x, v));
        self.left -= 1;
        self.next.cycle += self.cycles;
    }

    /// The next instant, where one is still to be listed.
    fn due(&self) -> Option<Instant<T>> {
        (self.left > 0).then_some(self.next)
    }
}

impl<T> Default for Listings<T> {
    fn default() -> Self {
        Self { section: None, carried: None }
    }
}

impl<T: Scalar> Listings<T> {
    /// What `request` asks of a run whose settled window begins at `from` and holds so many `periods`, each
    /// of so many `cycles` of the clock; `start` is the drive's phase at the start in turns.
    pub fn new(
        request: &Request,
        clock: &Clock<T>,
        from: Instant<T>,
        (periods, cycles): (u64, i64),
        start: f64,
    ) -> Self {
        if cycles == 0 {
            return Self::default();
        }
        let listing = |first: Instant<T>, left: u64, last_only: bool| {
            let room = if last_only { 1 } else { 0 };
            Listing { next: first, left, cycles, states: Vec::with_capacity(room), first, last_only }
        };
        let section = request.section.map(|phase| {
            let turns = (phase - start).rem_euclid(1.0) * cycles as f64;
            let whole = turns.floor();
            let mut first = Instant { cycle: whole as i64, phase: T::of(turns - whole) * clock.period() };
            let same = T::of(SAME * cycles as f64) * clock.period();
            first.cycle += (from.cycle - first.cycle).div_euclid(cycles) * cycles;
            while clock.between(&from, &first) < -same {
                first.cycle += cycles;
            }
            if clock.between(&from, &first).abs() <= same {
                first = from;
            }
            listing(first, periods.min(MOST_STROBES.into()), false)
        });
        let start = Instant { cycle: 0, phase: T::zero() };
        Self { section, carried: request.carry.then(|| listing(start, u64::MAX, true)) }
    }

    /// Whether there are none.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.section.is_none() && self.carried.is_none()
    }

    fn each(&mut self) -> impl Iterator<Item = &mut Listing<T>> {
        self.section.iter_mut().chain(&mut self.carried)
    }

    /// The instants that come next.
    #[inline]
    pub fn due(&self) -> impl Iterator<Item = Instant<T>> {
        self.section.iter().chain(&self.carried).filter_map(Listing::due)
    }

    pub fn listed(&self) -> Listed<T> {
        let next = [&self.section, &self.carried].map(|own| own.as_ref().map(|own| own.next));
        Listed { states: self.section.as_ref().map_or(0, |own| own.states.len()), next }
    }

    /// Adds `laps` more laps of `cycles` cycles of the clock, each like the one from `before` to `after`.
    pub fn repeat(&mut self, before: &Listed<T>, after: &Listed<T>, laps: i64, cycles: i64) {
        for (own, next) in [&mut self.section, &mut self.carried].into_iter().zip([0, 1]) {
            let Some(own) = own else { continue };
            if before.next[next] == after.next[next] {
                continue; // the lap lies before all of them
            }
            own.next.cycle += laps * cycles;
            if !own.last_only {
                let lap = own.states.get(before.states..after.states).unwrap_or_default().to_vec();
                let more = ((lap.len() as u64).saturating_mul(laps as u64)).min(own.left);
                own.states.extend(lap.iter().cycle().take(more as usize));
                own.left -= more;
            }
        }
    }

    /// The settled window of so many `periods` begins anew at its end.
    pub fn next_window(&mut self, periods: u64) {
        if let Some(own) = &mut self.section {
            own.states.clear();
            own.first = own.next;
            own.left = periods.min(MOST_STROBES.into());
        }
    }
}

impl<T: Scalar, const LEDGER: bool> Recorder<'_, T, LEDGER> {
    /// Lists the states within a step.
    pub(crate) fn list_states<P: Path<T>>(&mut self, step: &StepView<T, P>) {
        for own in self.listings.each() {
            while let Some(next) = own.due() {
                let into = self.clock.between(&step.at, &next).larger(T::zero());
                if into >= step.duration {
                    break;
                }
                let into = step.path.parameter(into, step.length);
                own.add((step.x_at(into).to_f64(), step.path.velocity(into).to_f64() / self.unit));
            }
        }
    }

    /// Lists the states of a mass that stands still at `x` up to `until`.
    pub(crate) fn list_still(&mut self, x: T, until: &Instant<T>) {
        for own in self.listings.each() {
            if own.last_only {
                let periods = (self.clock.between(&own.next, until) / self.period).floor().to_f64();
                own.next.cycle += (periods as i64 - 1).max(0) * own.cycles;
            }
            while own.due().is_some_and(|next| self.clock.between(&next, until) > T::zero()) {
                own.add((x.to_f64(), 0.0));
            }
        }
    }

    /// Closes the listings at `end`, the end of the run: the section, and the state that is carried.
    pub(crate) fn listed(
        &mut self,
        end: &Instant<T>,
        (x, v): (f64, f64),
    ) -> (Vec<SectionPoint>, Option<(f64, f64)>) {
        let same = self.period * T::of(SAME);
        for own in self.listings.each() {
            if own.due().is_some_and(|next| self.clock.between(&next, end).abs() <= same) {
                own.add((x, v));
            }
        }
        let Listings { section, carried } = std::mem::take(&mut self.listings);
        let points = section.into_iter().flat_map(|Listing { first, cycles, states, .. }| {
            let clock = self.clock;
            states.into_iter().zip(0..).map(move |((x, v), number)| {
                let at = Instant { cycle: first.cycle + number * cycles, phase: first.phase };
                SectionPoint { t: clock.seconds(&at), x, v }
            })
        });
        (points.collect(), carried.and_then(|own| own.states.last().copied()))
    }
}
