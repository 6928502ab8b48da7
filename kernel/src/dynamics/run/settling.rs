//! Verdict whether a motion whose settled window repeats has settled.

use crate::dynamics::clock::Instant;
use crate::dynamics::drive::Drive;
use crate::dynamics::map::Repetition;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::recorder::Recorder;
use crate::dynamics::record::repeats::{STATE_MATCH, Strobe};
use crate::dynamics::result::MapState;
use crate::numeric::{Scalar, elementary};

/// Multiple of the difference of two states that repeat by which the extremes of the motions through them may
/// differ.
const TURNING: f64 = 10.0;

/// Share of a forcing period that each rest lasts at least of a motion that rests for certain, and the same
/// in tolerances. Of 21 700 such motions between stops of any restitution that rest for 0.002 to 0.05 of a
/// period, at tolerances from 1e-8 to 1e-5, all rested at ten times the tolerance too; of 7000 at 1e-4, where
/// none is certain, three did not.
const LONG_REST: f64 = 0.01;
const LOST: f64 = 1e4;

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// Decides, at the end of a settled window that repeats, whether an orbit attracts the motion. A mass
    /// that has not moved needs no orbit.
    pub fn judge(&mut self) {
        let Some(periods) = self.record.classifier.without_verdict() else { return };
        if self.record.has_moved() {
            let verdict = self.attractor(periods);
            self.record.classifier.decide(verdict);
        }
    }

    /// The period of the orbit that attracts the motion, which comes back after `periods` forcing periods.
    fn attractor(&self, periods: u32) -> Option<u32> {
        let (record, model) = (&self.record, self.record.model);
        let alone = !model.has_electrical_state();
        // what follows a release depends on the drive alone, if there is one in each lap
        let laps = record.periods / u64::from(periods);
        let rests = record.counts.releases > 0 && record.counts.releases + 1 >= laps;
        let rested = record.rested.filter(|_| alone && rests);
        let strobes = &record.classifier.strobes;
        if alone
            && rested.is_none()
            && !self.turns_at_the_barrier()
            && let Some(period) = strobes.decayed_to(periods, self.contraction(periods))
        {
            return Some(period);
        }
        let periods = if rested.is_some() { strobes.shortest(periods) } else { periods };
        if rested.is_some() && periods == 1 && self.rests_long() {
            return Some(periods);
        }
        let phase = |at: &Instant<T>| (at.cycle, (at.phase / record.clock.period).to_f64());
        let map = model.stroboscopic_map(0.0)?.beginning_at(phase(&record.window.1));
        let Strobe { x, v } = strobes.last();
        let motion = Repetition {
            state: MapState { x, v, electrical: record.electrical(record.strobed_circuit) },
            periods,
            longest: strobes.longest as u32,
            rested: rested.map(|(at, side)| (phase(&at), side)),
            crosses: (!model.one_well).then_some(record.counts.crossings > 0),
        };
        match record.cancel {
            Some(cancel) => map.cancelled_by(cancel).attractor(&motion),
            None => map.attractor(&motion),
        }
    }

    /// Whether a motion that rests in every forcing period rests for certain: so long each time that no error
    /// of a period ends a rest, and it does not turn just before the barrier.
    fn rests_long(&self) -> bool {
        let share = self.record.shortest_rest / self.record.period.to_f64();
        let least = LONG_REST.max(LOST * self.record.model.tolerance);
        share >= least && !self.turns_at_the_barrier()
    }

    /// Whether the motion turns so near to the barrier that what is left of a transient may decide whether it
    /// crosses.
    fn turns_at_the_barrier(&self) -> bool {
        let Recorder { barrier, low, high, model, .. } = &self.record;
        let near = |extreme: &T, level: T| {
            (*extreme - level).abs().to_f64() <= TURNING * STATE_MATCH * model.scales.length
        };
        barrier.is_some_and(|level| near(low, level) || near(high, level))
    }

    /// The factor, as a logarithm to base 2, by which areas of states shrink over these forcing periods at
    /// least: by damping, and by the impacts on rigid stops.
    fn contraction(&self, periods: u32) -> f64 {
        let (record, model) = (&self.record, self.record.model);
        let seconds = model.forcing_period.unwrap_or(0.0) * f64::from(periods);
        let damped = model.contraction(seconds) * std::f64::consts::LOG2_E;
        let (left, right) = model.sides();
        let elastic = [left, right].into_iter().flatten().map(|stop| stop.restitution).fold(0.0, f64::max);
        let impacts = record.counts.impacts * u64::from(periods) / record.periods.max(1);
        match model.compliant.is_none() && impacts > 0 {
            true => damped + 2.0 * impacts as f64 * elementary::log2(elastic),
            false => damped,
        }
    }
}
