//! Recording of the crossings of the barrier within a step.

use super::barrier::{StepCrossings, side_of};
use super::recorder::Recorder;
use crate::dynamics::clock::Instant;
use crate::dynamics::result::{EventKind, Side};
use crate::dynamics::series::ROOM;
use crate::dynamics::step::chord::Chord;
use crate::dynamics::step::path::{Path, StepData};
use crate::numeric::Scalar;

impl<T: Scalar> Recorder<'_, T> {
    /// Records the crossings within a step that starts `gap` to the right of the barrier and ends on
    /// `end_side`.
    pub fn crossings<P: Path<T>>(&mut self, path: &P, step: &StepData<T>, gap: T, end_side: i8) {
        // If the velocity keeps its sign, the ends of the step decide.
        if end_side == self.barrier_side
            && end_side == side_of(gap, T::zero())
            && let Some(y) = path.in_time()
            && Chord::new(y, (gap, step.x), (step.length, step.v), step.bound, step.limits).is_monotone()
        {
            return;
        }
        let mut g = path.scaled(step.whole);
        g[0] = gap;
        let g = &mut g[..path.known()];
        let Some(crossings) = StepCrossings::new(g, self.barrier_side, end_side) else { return };
        self.barrier_side = crossings.from;
        if !self.instants_matter(step) {
            let count = crossings.count();
            self.barrier_side = crossings.side_after(count);
            self.counts.total_crossings += count as u64;
            if self.in_window(&step.at) {
                self.counts.crossings += count as u64;
            }
            return;
        }
        let mut found = [T::zero(); ROOM];
        let mut count = crossings.at_once;
        crossings.roots.each_sign_change(&mut |s| {
            let t = s * step.whole;
            if t > step.length || count == found.len() {
                return false;
            }
            found[count] = t;
            count += 1;
            true
        });
        if count == 0 {
            found[0] = step.length;
        }
        for t in &found[..crossings.corrected_count(count)] {
            self.crossing(path, step, *t);
        }
    }

    /// Whether the instants of crossings within the step are needed and not only their number: for the list
    /// of events, for the regime, and for a step that was cut short or lies near an end of the window, which
    /// may hold a crossing beyond it.
    fn instants_matter(&self, step: &StepData<T>) -> bool {
        // Two lengths of the step are more than the rounding of its end.
        let clear = |border: &Instant<T>| {
            let left = self.clock.between(&step.at, border);
            left <= T::zero() || left > step.duration + step.duration
        };
        self.lists_crossings()
            || step.length != step.whole
            || !(clear(&self.window.0) && clear(&self.window.1))
            || (self.period > T::zero() && self.in_window(&step.at))
    }

    fn crossing<P: Path<T>>(&mut self, path: &P, step: &StepData<T>, into: T) {
        self.barrier_side = -self.barrier_side;
        let at = self.clock.advance(&step.at, path.time(into));
        let v = path.velocity(into).to_f64() / self.unit;
        let side = if self.barrier_side > 0 { Side::Right } else { Side::Left };
        self.counts.total_crossings += 1;
        if self.in_window(&at) {
            self.counts.crossings += 1;
        }
        self.classifier.crossing(self.in_periods(&at), side, self.clock.seconds(&at));
        self.event(&at, EventKind::Crossing, side, v, v);
    }
}
