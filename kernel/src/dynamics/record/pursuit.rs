//! Record of a pursued motion: when it reaches its goal.

use super::goal::Goal;
use super::recorder::Recorder;
use crate::dynamics::clock::Instant;
use crate::dynamics::result::{Arrival, ReleaseIdentity, Side};
use crate::numeric::Scalar;

/// Forcing periods of the settled window of a pursuit.
const WINDOW: u64 = 100;

impl<'a, T: Scalar> Recorder<'a, T> {
    /// Begins a pursuit: stroboscopic states are taken from time 0 on, and the settled window is the last
    /// periods before `max_periods`. Returns the end of the window.
    pub fn pursue(&mut self, goal: Goal<'a>, max_periods: u64) -> Instant<T> {
        let at = |period: u64| Instant { cycle: period as i64 * self.period_cycles, phase: T::zero() };
        self.periods = max_periods.min(WINDOW);
        let from = max_periods - self.periods;
        self.window = (at(from), at(max_periods));
        self.origin = at(0);
        self.next_strobe = Some(self.origin);
        self.judge = self.judge.for_window(self.periods, from);
        self.goal = Some(goal);
        self.window.1
    }

    /// Whether the motion has reached its goal.
    #[inline]
    pub fn has_arrived(&self) -> bool {
        self.goal.as_ref().is_some_and(|goal| goal.reached.is_some())
    }

    /// Takes what the motion has reached.
    pub fn arrival(&mut self) -> Option<Arrival> {
        self.goal.as_mut().and_then(|goal| goal.reached.take())
    }

    /// The mass was released with this identity. Returns whether the motion is pursued.
    pub fn released(&mut self, at: &Instant<T>, identity: ReleaseIdentity) -> bool {
        let periods = self.periods_until(at);
        let goal = self.goal.as_mut().map(|goal| goal.release(Arrival::Released { identity, periods }));
        goal.is_some()
    }

    /// The mass rests from `at` on and will never be released.
    pub fn rests_forever(&mut self, at: &Instant<T>, side: Side) {
        let periods = self.periods_until(at);
        if let Some(goal) = &mut self.goal {
            goal.end(Arrival::Rests { side, periods });
        }
    }

    /// The number of the first stroboscopic state at or after `at`.
    fn periods_until(&self, at: &Instant<T>) -> u64 {
        self.in_periods(at).ceil().max(0.0) as u64
    }
}
