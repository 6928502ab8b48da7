//! Recording of events between steps: rests, impacts, releases, contacts.

use super::recorder::Recorder;
use super::window::STILL_STATES;
use crate::dynamics::clock::Instant;
use crate::dynamics::result::{EventKind, Phase, Sample, Side};
use crate::numeric::{Scalar, decay};

/// A recorder call other than a step. Velocities are signed, in kernel units.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Call<T> {
    // The mass stands still in this state: at rest on a stop, in an equilibrium, or during the unresolved
    // last bounces of a chatter (then with phase free and the speed of its first instant).
    Stand { at: Instant<T>, until: Instant<T>, state: (T, T), phase: Phase },
    Impact { at: Instant<T>, side: Side, v_in: T, v_out: T },
    // A chatter that begins at speed `v` is summed in closed form and dissipates its kinetic energy.
    Chatter { at: Instant<T>, v: T },
    Rest { at: Instant<T>, side: Side },
    Release { at: Instant<T>, side: Side },
}

impl<T: Scalar> Call<T> {
    pub fn map_instants(mut self, instant: impl Fn(&Instant<T>) -> Instant<T>) -> Self {
        match &mut self {
            Self::Stand { at, until, .. } => (*at, *until) = (instant(at), instant(until)),
            Self::Impact { at, .. }
            | Self::Chatter { at, .. }
            | Self::Rest { at, .. }
            | Self::Release { at, .. } => *at = instant(at),
        }
        self
    }

    pub fn mirrored(mut self) -> Self {
        let minus = |value: T| T::zero() - value;
        match &mut self {
            Self::Stand { state: (x, v), phase, .. } => {
                (*x, *v) = (minus(*x), minus(*v));
                *phase = match phase {
                    Phase::Free => Phase::Free,
                    Phase::LeftStop => Phase::RightStop,
                    Phase::RightStop => Phase::LeftStop,
                };
            }
            Self::Impact { side, v_in, v_out, .. } => {
                (*side, *v_in, *v_out) = (side.other(), minus(*v_in), minus(*v_out));
            }
            Self::Chatter { .. } => {}
            Self::Rest { side, .. } | Self::Release { side, .. } => *side = side.other(),
        }
        self
    }
}

impl<T: Scalar> Recorder<'_, T> {
    #[inline(always)]
    pub fn report(&mut self, call: &Call<T>, segment: usize) {
        match call {
            Call::Stand { at, until, state, phase } => self.stand((at, until), *state, *phase, segment),
            Call::Impact { at, side, v_in, v_out } => self.impact(at, *side, *v_in, *v_out),
            Call::Chatter { at, v } => self.chatter_sum(at, *v),
            Call::Rest { at, side } => self.rest(at, *side),
            Call::Release { at, side } => self.release(at, *side),
        }
    }

    fn stand(
        &mut self,
        (at, until): (&Instant<T>, &Instant<T>),
        (x, v): (T, T),
        phase: Phase,
        segment: usize,
    ) {
        let length = self.clock.between(at, until);
        if let Some((from, to)) = self.overlap(at, length) {
            self.covered.add(to - from);
            if phase != Phase::Free {
                self.settled.rested.add(to - from);
            }
            if self.ledger {
                self.settled.displacement.add(x * (to - from));
            }
            self.low = self.low.smaller(x);
            self.high = self.high.larger(x);
        }
        let mut recorded = 0;
        while let Some(strobe) = self.next_strobe {
            if self.clock.between(&strobe, until) <= T::zero() {
                break;
            }
            let circuit = self.standing_circuit.map_or(T::zero(), |(since, state, rate)| {
                state * decay(rate * self.clock.between(&since, &strobe).larger(T::zero())).0
            });
            self.strobe(x, T::zero(), circuit);
            recorded += 1;
            if recorded == STILL_STATES {
                recorded = 0;
                self.skip_strobes(x, until);
            }
        }
        self.list_still(x, until);
        if self.next_time < self.times.len() {
            let (begin, end) = (self.clock.seconds(at), self.clock.seconds(until));
            while let Some(t) = self.next_sample(end) {
                let base_accel = self.base(&self.clock.at(t), segment);
                let v = if t <= begin { v.to_f64() / self.unit } else { 0.0 };
                self.samples.push(Sample { t, x: x.to_f64(), v, base_accel, phase, electrical: 0.0 });
                self.next_time += 1;
            }
        }
    }

    fn impact(&mut self, at: &Instant<T>, side: Side, v_in: T, v_out: T) {
        let taken = (v_in * v_in - v_out * v_out) * T::of(0.5);
        self.whole.impact.add(taken);
        if self.ledger {
            self.peak_kinetic = self.peak_kinetic.max(0.5 * (v_in * v_in).to_f64());
        }
        if self.in_window(at) {
            self.settled.impact.add(taken);
        }
        self.count_impact(at, v_in);
        self.event(at, EventKind::Impact, side, v_in.to_f64() / self.unit, v_out.to_f64() / self.unit);
    }

    /// Counts an impact at this signed velocity, if it is fast enough.
    fn count_impact(&mut self, at: &Instant<T>, v: T) {
        if v.to_f64().abs() / self.unit <= self.model.min_impact_speed() {
            return;
        }
        self.counts.total_impacts += 1;
        if self.in_window(at) {
            self.counts.impacts += 1;
            self.impact_speed = self.impact_speed.larger(v.abs());
        }
    }

    /// The mass touches a compliant stop with this signed velocity in kernel units. `strikes` is false for a
    /// mass that is in the stop at the start of the run.
    pub fn touch(&mut self, at: &Instant<T>, side: Side, v: T, strikes: bool) {
        if strikes {
            self.count_impact(at, v);
        }
        if self.ledger {
            self.peak_kinetic = self.peak_kinetic.max(0.5 * (v * v).to_f64());
        }
        let v = v.to_f64() / self.unit;
        self.event(at, EventKind::Contact, side, v, v);
    }

    /// The mass leaves a compliant stop with this signed velocity in kernel units.
    pub fn separate(&mut self, at: &Instant<T>, side: Side, v: T) {
        let v = v.to_f64() / self.unit;
        self.event(at, EventKind::Separate, side, v, v);
    }

    fn chatter_sum(&mut self, at: &Instant<T>, v: T) {
        let taken = v * v * T::of(0.5);
        self.counts.sums += 1;
        self.whole.impact.add(taken);
        if self.in_window(at) {
            self.settled.impact.add(taken);
        }
    }

    fn rest(&mut self, at: &Instant<T>, side: Side) {
        self.counts.rests += 1;
        self.rests_since = Some(*at);
        self.event(at, EventKind::Rest, side, 0.0, 0.0);
    }

    fn release(&mut self, at: &Instant<T>, side: Side) {
        if self.in_window(at) {
            self.counts.releases += 1;
        }
        if let Some(since) = self.rests_since.take() {
            let lasted = self.clock.between(&since, at);
            self.shortest_rest = self.shortest_rest.min(lasted.to_f64());
            self.rested = Some((self.clock.advance(&since, lasted * T::of(0.5)), side));
        }
        self.classifier.release(self.in_periods(at), self.clock.seconds(at));
        self.event(at, EventKind::Release, side, 0.0, 0.0);
    }
}
