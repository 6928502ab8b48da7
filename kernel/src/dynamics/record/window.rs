//! Settled window of a record: its borders, the stroboscopic states in and before it, the states that a run
//! lists, and the goal of a pursuit.

use super::goal::Goal;
use super::listing::SAME;
use super::recorder::Recorder;
use super::regime::Classifier;
use super::repeats::{LONGEST, Strobe};
use super::sums::Sums;
use crate::dynamics::clock::Instant;
use crate::dynamics::result::{Arrival, MapState, ReleaseIdentity, SectionPoint, Side};
use crate::dynamics::series::polynomial;
use crate::dynamics::state::MotionState;
use crate::dynamics::step::path::{Path, StepData};
use crate::numeric::{CompensatedSum, Scalar};

/// Number of stroboscopic states of a mass at rest that are recorded one by one before some are skipped: more
/// than the longest period that is searched for.
pub(crate) const STILL_STATES: u32 = 32;

/// Forcing periods of the settled window of a pursuit.
const PURSUIT_WINDOW: u64 = 100;

impl<'a, T: Scalar> Recorder<'a, T> {
    pub(crate) fn strobes<P: Path<T>>(&mut self, path: &P, circuit: Option<&[T]>, step: &StepData<T>) {
        while let Some(strobe) = self.next_strobe {
            let into = self.clock.between(&step.at, &strobe);
            if into >= step.duration {
                return;
            }
            let into = path.parameter(into, step.length);
            let circuit = circuit.map_or(T::zero(), |w| polynomial::value(w, into));
            self.strobe(step.x_at(path, into), path.velocity(into), circuit);
        }
    }

    /// Records a stroboscopic state, with that of the circuit.
    pub(crate) fn strobe(&mut self, x: T, v: T, circuit: T) {
        let electrical = if self.goal.is_some() { self.electrical(circuit) } else { 0.0 };
        let Some(strobe) = &mut self.next_strobe else { return };
        self.strobed_circuit = circuit;
        strobe.cycle += self.period_cycles;
        self.strobes_left -= 1;
        if self.strobes_left == 0 || self.clock.between(strobe, &self.window.1) < T::zero() {
            self.next_strobe = None;
        }
        let state = Strobe { x: x.to_f64(), v: v.to_f64() / self.unit };
        let squared = self.settled.squared_velocity.value().to_f64();
        self.classifier.strobe(state, (squared, self.counts.crossings));
        if let Some(goal) = &mut self.goal {
            goal.strobe(&self.classifier, MapState { x: state.x, v: state.v, electrical });
        }
    }

    /// Skips stroboscopic states, all equal, of a mass that stands still at `x` up to `until`, but not the
    /// last ones before the next border of the window.
    pub(crate) fn skip_strobes(&mut self, x: T, until: &Instant<T>) {
        let Some(strobe) = &mut self.next_strobe else { return };
        let left = |border: &Instant<T>| {
            let periods = (self.clock.between(strobe, border) / self.period).to_f64();
            Some(periods).filter(|periods| *periods > 0.0)
        };
        let borders = [until, &self.window.0, &self.window.1];
        let to_border = borders.into_iter().filter_map(left).fold(f64::INFINITY, f64::min);
        let more = (to_border - f64::from(STILL_STATES)).floor() as i64;
        if more > 0 && to_border.is_finite() {
            strobe.cycle += more * self.period_cycles;
            self.classifier.skip_still(more as u64, Strobe { x: x.to_f64(), v: 0.0 });
        }
    }

    /// Records the state at the end of the run as a stroboscopic one, if the window ends there too.
    pub(crate) fn last_strobe(&mut self, state: &MotionState<T>) {
        let due =
            |strobe: &Instant<T>| self.clock.between(strobe, &state.at).abs() <= self.period * T::of(1e-9);
        if self.next_strobe.as_ref().is_some_and(due) {
            self.strobe(state.x, state.v, state.circuit);
        }
    }

    /// Start and end, in s, of the part of the settled window that is reached by a run that ends at `end`.
    pub(crate) fn window_seconds(&self, end: &Instant<T>) -> (f64, f64) {
        let (from, to) = &self.window;
        let reached = if self.clock.between(to, end) > T::zero() { to } else { end };
        // the number in the scene, if it gives this instant
        let in_scene = [self.model.settle, self.model.duration];
        let seconds = |at: &Instant<T>| {
            let as_in_scene = in_scene.into_iter().find(|t| self.clock.at(*t) == *at);
            as_in_scene.unwrap_or_else(|| self.clock.seconds(at))
        };
        let (from, reached) = (seconds(from), seconds(reached));
        (from, reached.max(from))
    }

    /// Begins another settled window at the present instant, the end of the last one. Returns its end, or
    /// `None` if that is after `until` in s or the window has too many stroboscopic states.
    pub fn next_window(&mut self, until: f64) -> Option<Instant<T>> {
        let from = self.window.1;
        let length = self.periods as i64 * self.period_cycles;
        let to = Instant { cycle: from.cycle + length, phase: from.phase };
        if self.clock.seconds(&to) > until || u64::from(self.strobes_left) <= self.periods {
            return None;
        }
        self.window = (from, to);
        self.next_strobe = Some(Instant { cycle: from.cycle + self.period_cycles, phase: from.phase });
        self.settled = Sums::new();
        self.covered = CompensatedSum::new();
        (self.low, self.high) = (T::of(f64::INFINITY), T::of(f64::NEG_INFINITY));
        self.impact_speed = T::zero();
        (self.counts.crossings, self.counts.impacts, self.counts.releases) = (0, 0, 0);
        self.classifier.open_window();
        self.listings.next_window(self.periods);
        Some(to)
    }

    pub(crate) fn list_states<P: Path<T>>(&mut self, path: &P, circuit: Option<&[T]>, step: &StepData<T>) {
        let amount = self.electrical(T::of(1.0));
        for listing in self.listings.each() {
            while let Some(next) = listing.due() {
                let into = self.clock.between(&step.at, &next).larger(T::zero());
                if into >= step.duration {
                    break;
                }
                let into = path.parameter(into, step.length);
                let electrical = circuit.map_or(0.0, |w| amount * polynomial::value(w, into).to_f64());
                let (x, v) = (step.x_at(path, into).to_f64(), path.velocity(into).to_f64() / self.unit);
                listing.add(MapState { x, v, electrical });
            }
        }
    }

    /// Lists the states of a mass that stands still at `x` up to `until`.
    pub(crate) fn list_still(&mut self, x: T, until: &Instant<T>) {
        for listing in self.listings.each() {
            listing.skip_still(&self.clock, self.period, until);
            while listing.due().is_some_and(|next| self.clock.between(&next, until) > T::zero()) {
                listing.add((x.to_f64(), 0.0).into());
            }
        }
    }

    /// Closes the listings at `end`, the end of the run. Returns the section, and the state from which
    /// another run can continue.
    pub(crate) fn listed(
        &mut self,
        end: &Instant<T>,
        state: MapState,
    ) -> (Vec<SectionPoint>, Option<MapState>) {
        let same = self.period * T::of(SAME);
        for listing in self.listings.each() {
            if listing.due().is_some_and(|next| self.clock.between(&next, end).abs() <= same) {
                listing.add(state);
            }
        }
        std::mem::take(&mut self.listings).finish(&self.clock)
    }

    /// Begins a pursuit: stroboscopic states are taken from time 0 on, and the settled window is the last
    /// periods before `max_periods`. Returns the end of the window.
    pub fn pursue(&mut self, goal: Goal<'a>, max_periods: u64) -> Instant<T> {
        let at = |period: u64| Instant { cycle: period as i64 * self.period_cycles, phase: T::zero() };
        self.periods = max_periods.min(PURSUIT_WINDOW);
        let from = max_periods - self.periods;
        self.window = (at(from), at(max_periods));
        self.origin = at(0);
        self.next_strobe = Some(self.origin);
        let scales = (self.model.scales.length, self.model.scales.speed);
        self.classifier = Classifier::new(self.model.rhythm, scales, self.periods, from);
        self.classifier.strobes.longest = LONGEST; // however short the window is
        self.goal = Some(goal);
        self.window.1
    }

    /// Whether the motion has reached its goal, or the crossing that ends the run.
    #[inline]
    pub fn has_arrived(&self) -> bool {
        self.goal.as_ref().is_some_and(|goal| goal.reached.is_some())
            || self.until_crossing && self.counts.total_crossings > 0
    }

    /// The mass was released with this identity. Returns whether the motion is pursued.
    pub fn released(&mut self, at: &Instant<T>, identity: ReleaseIdentity) -> bool {
        let periods = self.periods_until(at);
        self.goal.as_mut().map(|goal| goal.release(identity, periods)).is_some()
    }

    /// The mass rests from `at` on and will never be released.
    pub fn rests_forever(&mut self, at: &Instant<T>, side: Side) {
        let periods = self.periods_until(at);
        if let Some(goal) = &mut self.goal {
            goal.end(Arrival::Rests(side), periods);
        }
    }

    /// The number of the first stroboscopic state at or after `at`.
    fn periods_until(&self, at: &Instant<T>) -> u64 {
        self.in_periods(at).ceil().max(0.0) as u64
    }
}
