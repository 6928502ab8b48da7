//! Fast path of consecutive steps without an event.
//!
//! Most steps of most scenes meet no stop, no break, no border of the drive or of the settled window. The
//! checks that the general step makes each time (touch, rest, release, sample, stroboscopic state, budgets)
//! are made here once, before the first step; from step to step only state, clock and sums change. The first
//! step on which an event is possible is left to the general step. The event-free step is written three
//! times: here, as the general step of a single motion (`step/choose.rs` with `advance/flight.rs`), and for a
//! batch (`lanes/columns/step.rs`). The three do the same arithmetic and must stay equal to the bit.

use crate::dynamics::drive::Drive;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::barrier::{StepCrossings, side_of};
use crate::dynamics::record::event_free::{EventFree, MARGIN};
use crate::dynamics::series::{Integrals, polynomial};
use crate::dynamics::state::Contact;
use crate::dynamics::step::chord::{CLEARANCE, Chord};
use crate::dynamics::step::stepper::{Step, Stepper};
use crate::numeric::Scalar;

/// How a sequence of event-free steps has ended.
pub(crate) enum FastPath<T> {
    /// It has not ended: budgets and the cancel flag must be checked.
    Paused,
    /// At this step, on which an event is possible; the series holds it.
    EventPossible(Step<T>),
    /// Before a step of at most this length, whose length the general step must choose; the series holds it.
    TooLong(T),
    /// No step was taken.
    NotTaken,
}

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// Takes steps as long as they are event-free.
    #[inline]
    pub fn event_free_steps(&mut self) -> FastPath<T> {
        let free = self.state.contact == Contact::Free && self.state.touch.is_none();
        let alone = self.stepper.drive.circuit().is_none();
        let samples = self.record.next_time < self.record.times.len();
        if self.record.ledger || !alone || !free || self.log.is_some() || samples {
            return FastPath::NotTaken;
        }
        let max_steps = self.stepper.work.pieces_until_check(self.stepper.costs.step);
        if self.has_budget_for(max_steps) {
            self.take_event_free_steps(max_steps)
        } else {
            FastPath::NotTaken
        }
    }

    fn take_event_free_steps(&mut self, max_steps: u64) -> FastPath<T> {
        if self.stepper.pass_segment_end(&mut self.state) {
            return FastPath::Paused;
        }
        let mut part = self.record.begin_event_free(&self.state.at, &self.stepper.segment_limit(&self.state));
        let mode = self.stepper.mode(&self.state);
        let (origin, limits) = (mode.origin, (mode.low, mode.high));
        let Self { stepper, state, record, .. } = self;
        let Stepper { equation, drive, clock, settings, series, cursor, work, costs, evaluations, .. } =
            stepper;
        let (damping, segment) = (equation.damping, state.segment);
        let allowed = settings.residual_of_a_full_step();
        let margin = T::of(MARGIN) * clock.period;
        let rule = record.rule_of_steps();
        let (mut at, mut x, mut v) = (state.at, state.x, state.v);
        let mut ended = FastPath::Paused;
        let (mut steps, mut crossed) = (0, 0);
        for _ in 0..max_steps {
            drive.seed(&at, segment, &mut series.a, cursor);
            series.begin(x - origin, v);
            series.extend(settings.order, &mode.force, damping, *drive, cursor);
            let length =
                T::of(series.natural_step(settings.speed_log2, settings.tolerance_log2, settings.longest));
            let left = clock.between(&at, &part.border) - margin;
            if !(length > T::zero() && length < left) {
                ended = FastPath::TooLong(length);
                break;
            }
            let end = series.state(length);
            let next = clock.advance(&at, length);
            let base = drive.value(&next, segment, || series.base(length), cursor);
            let sum = (end.acceleration + damping * end.v) + base;
            let residual = (mode.force.at(end.y) + sum).abs() * length;
            if !(residual <= allowed) {
                ended = FastPath::TooLong(length);
                break;
            }

            let chord = Chord {
                start: series.y[0] + origin,
                end: end.y + origin,
                bound: end.bound,
                deviations: (T::of(f64::INFINITY), T::of(f64::INFINITY), T::of(f64::INFINITY)),
                slopes: (v * length, end.v * length),
                curvatures: (T::zero(), T::zero()),
                limits,
            };
            let deviations = || polynomial::chord_deviations(&series.y[..=settings.order], length);
            let clear = x - limits.0 > end.bound && limits.1 - x > end.bound || {
                let square = length * length;
                let curvatures = ((series.y[2] + series.y[2]) * square, end.acceleration * square);
                Chord { deviations: deviations(), curvatures, ..chord }.stays_clear()
            };
            let mut event_free = clear && end.v.is_finite();
            // a missing barrier counts as infinitely far away
            let gap = chord.start - part.barrier.unwrap_or(T::of(f64::NEG_INFINITY));
            if event_free && !(gap.abs() > end.bound * T::of(CLEARANCE)) {
                let step = (&series.y[..=settings.order], length);
                match part.crossings(&chord, step, length + length < left) {
                    Some((side, count)) => {
                        part.side = side;
                        crossed += count;
                    }
                    None => event_free = false,
                }
            }
            if part.inside && event_free {
                let y = &series.y[..=settings.order];
                let squared = polynomial::integrals::<_, false>(y, &[], rule, T::zero(), length).0;
                event_free = part.record_step(&chord, deviations, (length, squared));
                if !event_free {
                    series.measured.set(Some(Integrals { until: length, squared, work: T::zero() }));
                }
            }
            if !event_free {
                ended = FastPath::EventPossible(Step { length, arrival: None, end });
                break;
            }
            (at, x, v) = (next, chord.end, end.v);
            steps += 1;
        }
        if steps > 0 {
            state.turned_back = false;
            (state.at, state.x, state.v) = (at, x, v);
            record.end_event_free((part.low, part.high), part.squared, part.covered, part.side, crossed);
        }
        self.steps += steps;
        work.add(steps * costs.step);
        *evaluations += steps + u64::from(!matches!(ended, FastPath::Paused));
        ended
    }
}

impl<T: Scalar> EventFree<T> {
    /// The side of the barrier after a step that comes near it, and the number of crossings; `None` if their
    /// instants are needed. `y` and `length` are the coefficients and the length of the step, `early` whether
    /// it ends well before the border.
    #[inline(never)] // rare, and large
    fn crossings(&self, chord: &Chord<T>, (y, length): (&[T], T), early: bool) -> Option<(i8, u64)> {
        let Some(barrier) = self.barrier else { return Some((self.side, 0)) };
        let (gap, end) = (chord.start - barrier, side_of(chord.end, barrier));
        if end == self.side && gap.abs() > chord.bound {
            return Some((end, 0));
        }
        // Instants are needed inside the window, and if crossings are listed.
        let countable = early && !self.inside && !self.listed;
        // If the velocity keeps its sign, the ends decide.
        let monotone = Chord { deviations: polynomial::chord_deviations(y, length), ..*chord }.is_monotone();
        if monotone && self.side != 0 && end != 0 && side_of(gap, T::zero()) == self.side {
            return (countable || end == self.side).then(|| (end, u64::from(end != self.side)));
        }
        if !countable {
            return None;
        }
        let mut g = polynomial::scaled(y, length);
        g[0] = gap;
        let Some(crossings) = StepCrossings::new(&mut g[..y.len()], self.side, end) else {
            return Some((self.side, 0));
        };
        let count = crossings.count();
        Some((crossings.side_after(count), count as u64))
    }

    /// Records a step inside the settled window of this length and integral of the squared velocity. Returns
    /// false if a turning point within it may be an extreme. `deviations` computes the deviations from the
    /// chords, if they are needed.
    #[inline(always)]
    fn record_step(
        &mut self,
        chord: &Chord<T>,
        deviations: impl Fn() -> (T, T, T),
        (length, squared): (T, T),
    ) -> bool {
        let (low, high, mut turns) = chord.extremes((self.low, self.high));
        if turns {
            (_, _, turns) = Chord { deviations: deviations(), ..*chord }.extremes((low, high));
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
