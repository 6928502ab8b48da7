//! How does a mass fly as long as nothing happens to it?
//!
//! Most steps of most scenes meet no stop, no break, no border of the drive or of the settled window. What the general
//! step asks of each of them (a touch, a rest, a label, a sample, a strobe, the budgets) is asked here once for all of
//! them, before the first: from one to the next only state, clock and what is summed go on. The first step on which
//! something may happen is handed to the general step. The arithmetic is the same, so the result has the same bits.

use crate::dynamics::drive::Drive;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::barrier::{StepCrossings, side_of};
use crate::dynamics::record::event_free::{EventFree, MARGIN};
use crate::dynamics::series::polynomial;
use crate::dynamics::state::Contact;
use crate::dynamics::step::chord::{CLEARANCE, Chord};
use crate::dynamics::step::stepper::{Step, Stepper};
use crate::numeric::Scalar;

/// How a flight has ended.
pub(crate) enum FastPath<T> {
    /// It has not ended: it is time to look at budgets and the cancel flag.
    On,
    /// With this step, on which something may happen; the series holds it.
    To(Step<T>),
    /// Before a step of up to this length, which must be chosen with more care; the series holds it.
    Before(T),
    /// It has not begun.
    Not,
}

impl<T: Scalar, D: Drive<T>, const LEDGER: bool> Motion<'_, T, D, LEDGER> {
    /// Takes steps for as long as nothing happens.
    #[inline]
    pub fn event_free_steps(&mut self) -> FastPath<T> {
        let free = self.state.contact == Contact::Free && self.state.touch.is_none();
        if LEDGER || !free || self.log.is_some() || !self.record.is_quiet() {
            return FastPath::Not;
        }
        let most = self.stepper.work.pieces_until_look(self.stepper.costs.step);
        if self.has_budget_for(most) { self.fly_on(most) } else { FastPath::Not }
    }

    fn fly_on(&mut self, most: u64) -> FastPath<T> {
        if self.stepper.pass_segment_end(&mut self.state) {
            return FastPath::On;
        }
        let mut now = self.record.begin_event_free(&self.state.at, &self.stepper.segment_limit(&self.state));
        let mode = self.stepper.mode(&self.state);
        let (origin, limits) = (mode.origin, (mode.low, mode.high));
        let Self { stepper, state, record, .. } = self;
        let Stepper { equation, drive, clock, settings, series, cursor, work, costs, evaluations, .. } =
            stepper;
        let (damping, segment) = (equation.damping, state.segment);
        let allowed = settings.residual_of_a_full_step();
        let margin = T::of(MARGIN) * clock.period();
        let rule = record.rule_of_steps();
        let (mut at, mut x, mut v) = (state.at, state.x, state.v);
        let mut ended = FastPath::On;
        let (mut flown, mut crossed) = (0, 0);
        for _ in 0..most {
            drive.seed(clock, &at, segment, &mut series.a, cursor);
            series.begin(x - origin, v);
            series.extend(settings.order, &mode.force, damping, *drive, cursor);
            let length =
                T::of(series.natural_step(settings.speed_log2, settings.tolerance_log2, settings.longest));
            let left = clock.between(&at, &now.border) - margin;
            if !(length > T::zero() && length < left) {
                ended = FastPath::Before(length);
                break;
            }
            let end = series.state(length);
            let next = clock.advance(&at, length);
            let base = drive.value(clock, &next, segment, || series.base(length), cursor);
            let sum = (end.acceleration + damping * end.v) + base;
            let residual = (mode.force.at(end.y) + sum).abs() * length;
            if !(residual <= allowed) {
                ended = FastPath::Before(length);
                break;
            }

            let chord = Chord {
                start: series.y[0] + origin,
                end: end.y + origin,
                bound: end.bound,
                bend: T::of(f64::INFINITY),
                limits,
            };
            let bend = || polynomial::chord_deviation(&series.y[..=settings.order], length);
            let clear = x - limits.0 > end.bound && limits.1 - x > end.bound
                || Chord { bend: bend(), ..chord }.is_clear() == (true, true);
            let mut quiet = clear && end.v.is_finite();
            // (without a top it is infinitely far away)
            let gap = chord.start - now.barrier.unwrap_or(T::of(f64::NEG_INFINITY));
            if quiet && !(gap.abs() > end.bound * T::of(CLEARANCE)) {
                let step = (&series.y[..=settings.order], length, v);
                match now.passages(&chord, step, length + length < left) {
                    Some((side, count)) => {
                        now.side = side;
                        crossed += count;
                    }
                    None => quiet = false,
                }
            }
            if now.inside && quiet {
                let y = &series.y[..=settings.order];
                let squared = polynomial::integrals::<_, false>(y, &[], rule, T::zero(), length).0;
                quiet = now.take_in(&chord, bend, (length, squared));
                if !quiet {
                    series.measured = Some((length, squared));
                }
            }
            if !quiet {
                ended = FastPath::To(Step { length, arrival: None, end });
                break;
            }
            (at, x, v) = (next, chord.end, end.v);
            flown += 1;
        }
        if flown > 0 {
            state.turned_back = false;
            (state.at, state.x, state.v) = (at, x, v);
            record.end_event_free((now.low, now.high), now.squared, now.covered);
            record.end_event_free_crossings(now.side, crossed);
        }
        self.steps += flown;
        work.add(flown * costs.step);
        *evaluations += flown + u64::from(!matches!(ended, FastPath::On));
        ended
    }
}

impl<T: Scalar> EventFree<T> {
    /// The side of the top after a step that comes near it, and how often the top is passed; none where it must be known
    /// when. Of the step are given coefficients, length, and velocity at its start, and whether it ends well before the
    /// border.
    #[inline(never)] // rare, and large
    fn passages(&self, chord: &Chord<T>, (y, length, v): (&[T], T, T), early: bool) -> Option<(i8, u64)> {
        let Some(top) = self.barrier else { return Some((self.side, 0)) };
        let (gap, end) = (chord.start - top, side_of(chord.end, top));
        if end == self.side && gap.abs() > chord.bound {
            return Some((end, 0));
        }
        // Inside the window, and where it is listed, it must.
        let countable = early && !self.inside && !self.listed;
        // Where the velocity keeps its sign the ends tell.
        let monotone = T::of(8.0) * polynomial::chord_deviation(y, length) < v.abs() * length;
        if monotone && self.side != 0 && end != 0 && side_of(gap, T::zero()) == self.side {
            return (countable || end == self.side).then(|| (end, u64::from(end != self.side)));
        }
        if !countable {
            return None;
        }
        let mut g = polynomial::scaled(y, length);
        g[0] = gap;
        let Some(passages) = StepCrossings::new(&mut g[..y.len()], self.side, end) else {
            return Some((self.side, 0));
        };
        let count = passages.count();
        Some((passages.side_after(count), count as u64))
    }

    /// Takes in a step inside the settled window of this length and integral of the squared velocity, where no turning point
    /// within it may be an extreme. What it `bends` by is only asked for where that may be.
    #[inline(always)]
    fn take_in(&mut self, chord: &Chord<T>, bends: impl Fn() -> T, (length, squared): (T, T)) -> bool {
        let (low, high, mut turns) = chord.extremes((self.low, self.high));
        if turns {
            (_, _, turns) = Chord { bend: bends(), ..*chord }.extremes((low, high));
        }
        if turns {
            return false;
        }
        (self.low, self.high) = (low, high);
        self.squared.add(squared);
        self.covered.add(length);
        true
    }
}
