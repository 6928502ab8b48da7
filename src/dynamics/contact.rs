//! What happens where the mass touches a stop, a break or the end of the curve?

use super::clock::Instant;
use super::drive::{Drive, Fall, Press, Span};
use super::equation::{End, EndKind, FAR};
use super::motion::{BY_ACCELERATION, BY_JERK, BY_SPEED, Contact, Flow, HELD, Motion, Touch, UNDECIDED};
use super::prepare::base_at;
use super::recurrence::Label;
use super::result::{Outcome, Phase, Side};
use crate::numeric::Scalar;

/// A rebound slower than this share of the speed scale may be part of a closed-form sum.
const CHATTER_SPEED: f64 = 1e-6;

/// Share of the clock's cycle by which the search for a release skips an instant at which the press only
/// touched 0: well above what the rounding of a double root spans, well below any press worth resolving.
const PAST_A_TOUCH: f64 = 1e-6;

impl<T: Scalar, D: Drive<T>, const LEDGER: bool> Motion<'_, T, D, LEDGER> {
    /// Decides what a start on a surface is.
    pub(super) fn place_at_start(&mut self) {
        if self.equation.compliant.is_some() && self.start_pressed_in() {
            return;
        }
        if self.contact != Contact::Free {
            return;
        }
        let arena = &self.equation.arenas[self.arena];
        for end in [End::Low, End::High] {
            let (level, kind) = arena.end(end);
            if self.x != level || kind == EndKind::Unknown {
                continue;
            }
            let outward = end.sign::<T>() * self.v;
            if kind == EndKind::Compliant {
                self.meet(end, outward);
            } else if kind == EndKind::Stop {
                if outward > T::zero() {
                    self.strike(end, outward);
                } else if outward < T::zero() {
                    self.touch = Some(Touch { end, order: BY_SPEED });
                } else {
                    self.settle(end);
                }
            } else if outward > T::zero() {
                self.enter_neighbour(end);
            } else if outward < T::zero() {
                self.touch = Some(Touch { end, order: BY_SPEED });
            } else {
                self.balance(end);
            }
            return;
        }
    }

    /// Outward acceleration of a mass held at the stop of `end`, and its first two time derivatives.
    pub(super) fn press(&mut self, end: End) -> [T; 3] {
        self.drive.seed(&self.clock, &self.at, self.segment, &mut self.series.a, &mut self.roll);
        let sign = end.sign::<T>();
        let stop = self.equation.stop(end).map_or(T::zero(), |s| s.press);
        let a = &self.series.a;
        [stop - sign * a[0], -(sign * a[1]), -(sign * a[2] * T::of(2.0))]
    }

    /// The mass stands at the stop of `end` with no speed: none where it is pressed on it, else the touch with which it
    /// leaves. The first derivative of the pressing acceleration that is not 0 (to the rounding of its terms) decides; if
    /// none is, nothing presses, and it stays there, free.
    pub(super) fn leaves(&mut self, end: End) -> Option<Touch> {
        let rates = self.press(end);
        let stop_rounding = self.equation.stop(end).map_or(T::zero(), |s| s.press_rounding);
        let rounding = stop_rounding + self.series.a[0].abs() * T::of(4.0 * T::EPSILON);
        self.v = T::zero();
        for (order, rate) in (BY_ACCELERATION..).zip(rates) {
            let size = if order == BY_ACCELERATION { rounding } else { T::zero() };
            if rate > size {
                return None;
            }
            if rate < -size {
                return Some(Touch { end, order });
            }
        }
        Some(Touch { end, order: UNDECIDED })
    }

    /// The mass stands at the stop of `end` with no speed: it rests or leaves.
    fn settle(&mut self, end: End) {
        self.touch = self.leaves(end);
        if self.touch.is_some() {
            self.contact = Contact::Free;
        } else {
            self.contact = Contact::Resting(end);
            self.record.rest(&self.at, side(end));
        }
    }

    /// The mass stands still until `until`.
    pub(super) fn stand(&mut self, until: Instant<T>, phase: Phase) {
        let (drive, clock, segment, unit) = (self.drive, self.clock, self.segment, self.equation.unit);
        self.record
            .stand(&self.at, &until, (self.x, self.v), phase, |at| base_at(drive, &clock, segment, at, unit));
        self.at = until;
    }

    /// A rest on the stop of `end`, up to its release, the end of the drive's segment, or the run's end.
    pub(super) fn rest(&mut self, end: End) {
        let phase = match end {
            End::Low => Phase::LeftStop,
            End::High => Phase::RightStop,
        };
        self.steps += 1;
        let until = self.segment_limit();
        let mut from = self.at;
        if self.refused == Some(self.at) {
            // The press only touched 0 here, to rounding: look beyond.
            from = self.clock.advance(&from, self.clock.period() * T::of(PAST_A_TOUCH));
        }
        let threshold = self.equation.stop(end).map_or(T::zero(), |s| s.press);
        let press = Press { threshold, sign: end.sign::<T>() };
        let since = self.searched.take().filter(|(segment, _)| *segment == self.segment);
        let since = since.map_or(from, |(_, since)| since);
        let span = Span { from, until, segment: self.segment, since };
        let (fall, work) = self.drive.next_fall(&self.clock, &span, press, &mut self.roll);
        self.work.add(self.costs.check + work);
        match fall {
            Fall::At(fall, turn) => {
                self.stand(fall, phase);
                self.release(end, BY_JERK);
                self.label = turn.filter(|_| self.recurs).map(|turn| Label { end, turn, phase: fall.phase });
            }
            Fall::NotBefore(later) => {
                self.searched = Some((self.segment, since));
                self.stand(later, phase);
            }
            Fall::Never => {
                self.stand(until, phase);
                if self.pass_segment_end() {
                    let rounding = self.equation.stop(end).map_or(T::zero(), |s| s.press_rounding);
                    let press = self.press(end)[0];
                    if press < -(rounding + self.series.a[0].abs() * T::of(4.0 * T::EPSILON)) {
                        self.release(end, BY_ACCELERATION);
                    }
                }
            }
        }
    }

    fn release(&mut self, end: End, order: usize) {
        self.record.release(&self.at, side(end));
        self.contact = Contact::Free;
        self.touch = Some(Touch { end, order });
    }

    /// Enters the drive's next segment where the present one has ended.
    pub(super) fn pass_segment_end(&mut self) -> bool {
        let ended = self
            .drive
            .segment_end(self.segment)
            .is_some_and(|border| self.clock.between(&self.at, &border) <= T::zero());
        if ended {
            self.segment += 1;
        }
        ended
    }

    /// The mass reaches the stop of `end` with outward speed `speed` > 0.
    fn strike(&mut self, end: End, speed: T) {
        let sign = end.sign::<T>();
        let restitution = self.equation.stop(end).map_or(T::of(1.0), |s| s.restitution);
        let rebound = restitution * speed;
        self.work.add_impacts(1);
        // 0 - keeps a rebound of 0 from being -0
        self.record.impact(&self.at, side(end), sign * speed, T::zero() - sign * rebound);
        if rebound > T::zero() {
            self.v = -(sign * rebound);
            self.touch = Some(Touch { end, order: BY_SPEED });
        } else {
            self.settle(end);
        }
    }

    /// The mass passes the break at `end` of its arena.
    pub(super) fn enter_neighbour(&mut self, end: End) {
        match end {
            End::Low => self.arena -= 1,
            End::High => self.arena += 1,
        }
        self.touch = Some(Touch { end: end.other(), order: BY_SPEED });
    }

    /// The mass stands on the break at `end` of its arena with no speed: the first derivative of its motion that is
    /// not 0 (to the rounding of its terms) chooses the side; where none is, it stays on this one.
    fn balance(&mut self, end: End) {
        let sign = end.sign::<T>();
        let arena = &self.equation.arenas[self.arena];
        let (force, _, rounding) = arena.force.value(arena.end(end).0 - arena.origin);
        self.drive.seed(&self.clock, &self.at, self.segment, &mut self.series.a, &mut self.roll);
        let a = &self.series.a;
        let rates = [-(sign * (force + a[0])), -(sign * a[1]), -(sign * a[2])];
        let rounding = rounding + a[0].abs() * T::of(4.0 * T::EPSILON);
        self.v = T::zero();
        self.touch = Some(Touch { end, order: HELD });
        for (order, rate) in (BY_ACCELERATION..).zip(rates) {
            let size = if order == BY_ACCELERATION { rounding } else { T::zero() };
            if rate > size {
                self.enter_neighbour(end);
                self.touch = Some(Touch { end: end.other(), order });
                return;
            }
            if rate < -size {
                self.touch = Some(Touch { end, order });
                return;
            }
        }
    }

    /// A pressed rebound, slow enough: sums what remains of the chatter in closed form. Expects the
    /// drive to be seeded.
    ///
    /// The sum of the flights is S (1 - (2 j/a + g) S/6) + O(S^3), S = 2 v/(a (1 - e)), a the pressing
    /// acceleration, j its rate, g = c/m. It is used where its own error is below the tolerance and the pressing
    /// cannot end before it does.
    pub(super) fn sum_chatter(&mut self, end: End, rates: [T; 3]) -> bool {
        let Some(stop) = self.equation.stop(end) else { return false };
        let one = T::of(1.0);
        let speed = self.v.abs();
        let [press, jerk, snap] = rates;
        if !(press > T::zero()
            && stop.restitution < one
            && speed < self.settings.speed * T::of(CHATTER_SPEED))
        {
            return false;
        }
        let damping = self.equation.damping;
        let whole = T::of(2.0) * speed / (press * (one - stop.restitution));
        let squares = (jerk.abs() / press) * (jerk.abs() / press)
            + damping * damping
            + stop.stiffness.abs()
            + snap.abs() / press;
        let change = whole * whole * squares;
        if change > T::of(2.5e-3) || whole * change > T::of(0.1 * self.settings.tolerance) {
            return false;
        }
        let sum = whole * (one - (T::of(2.0) * jerk / press + damping) * whole / T::of(6.0));
        let until = self.clock.advance(&self.at, sum);
        let limit = self.segment_limit();
        if self.clock.between(&until, &limit) <= T::zero() {
            return false;
        }
        self.record.chatter_sum(&self.at, speed);
        self.stand(until, Phase::Free);
        self.v = T::zero();
        self.steps += 1;
        self.work.add(self.costs.check);
        self.contact = Contact::Resting(end);
        self.touch = None;
        self.record.rest(&self.at, side(end));
        true
    }

    /// The mass has reached an end of its arena; `at_once` where the step began there and led outward.
    pub(super) fn reach(&mut self, end: End, at_once: bool) -> Flow {
        let outward = end.sign::<T>() * self.v;
        let (level, kind) = self.equation.arenas[self.arena].end(end);
        match kind {
            EndKind::Stop if outward > T::zero() => self.strike(end, outward),
            EndKind::Stop if at_once => {
                // It was let go where the press is 0 to rounding, and does not leave: it rests on.
                self.refused = Some(self.at);
                self.v = T::zero();
                self.contact = Contact::Resting(end);
                self.record.rest(&self.at, side(end));
            }
            EndKind::Stop => self.settle(end), // a touch without speed is no impact
            EndKind::Compliant if outward > T::zero() || at_once => self.enter_stop(end, outward),
            EndKind::Compliant => self.meet(end, outward),
            EndKind::Break if outward > T::zero() => self.enter_neighbour(end),
            EndKind::Break => {
                // A touch of the break; where both sides lead out, by rounding, it stays on this one.
                self.v = T::zero();
                if !at_once {
                    self.balance(end);
                } else if self.turned_back {
                    self.touch = Some(Touch { end, order: HELD });
                } else {
                    self.turned_back = true;
                    self.enter_neighbour(end);
                    self.touch = Some(Touch { end: end.other(), order: BY_ACCELERATION });
                }
            }
            EndKind::Unknown if level.abs() >= T::of(FAR) => {
                return Some(Outcome::NotFinite { at: self.clock.seconds(&self.at) });
            }
            EndKind::Unknown => return Some(Outcome::LeftTable { at: self.clock.seconds(&self.at) }),
        }
        None
    }
}

pub(super) fn side(end: End) -> Side {
    match end {
        End::Low => Side::Left,
        End::High => Side::Right,
    }
}
