//! How long is a step of free flight, and what does it run into?

use super::drive::Drive;
use super::equation::End;
use super::glide::Glide;
use super::motion::{BY_JERK, BY_SPEED, HELD, MOST_HALVINGS, Motion, Step, Touch};
use super::path::Path;
use super::series::{ROOM, SEEDED, State};
use super::settings::{RESIDUAL, ROUNDINGS};
use super::taylor;
use crate::numeric::{PolynomialRoots, Scalar};

/// The order up to which the series of a rebound is extended at once: all that the drive's first coefficients are there for.
const FEW: usize = SEEDED + 1;

impl<T: Scalar, D: Drive<T>, const LEDGER: bool> Motion<'_, T, D, LEDGER> {
    /// Extends the series as far as the step needs; none where the coefficients are not finite.
    ///
    /// Coefficients may vanish one after the other without the next one vanishing (a high power from its flat
    /// middle, tones that cancel), and then the last ones promise too long a step. So each step is checked
    /// against the equation of motion at its end, and halved until it holds.
    pub(super) fn choose_step(&mut self, flight: Option<T>, left: T) -> Option<Step<T>> {
        let length = match flight {
            Some(flight) if self.expand_for(flight) => flight,
            _ => {
                self.expand();
                let natural = self.natural_step();
                flight.map_or(natural, |flight| flight.smaller(natural))
            }
        };
        self.shorten(length, left)
    }

    fn natural_step(&self) -> T {
        let s = &self.settings;
        T::of(self.series.natural_step(s.speed_log2, s.tolerance_log2, s.longest))
    }

    /// The step of up to length `h` that ends in time, and with which the equation of motion holds.
    pub(super) fn shorten(&mut self, mut h: T, left: T) -> Option<Step<T>> {
        let border = self.drive.segment_end(self.segment);
        for attempt in 0..MOST_HALVINGS {
            if !(h > T::zero()) {
                return None;
            }
            if attempt > 0 {
                self.work.add(self.costs.check);
            }
            let mut arrival = None;
            if left <= h {
                h = left;
                arrival = Some(self.end);
            }
            if let Some(border) = border {
                let to_border = self.clock.between(&self.at, &border);
                if to_border <= h {
                    h = to_border;
                    arrival = Some(border);
                }
            }
            let end = self.series.state(h);
            if self.step_holds(h, &end) {
                return Some(Step { length: h, arrival, end });
            }
            if self.series.known <= self.settings.order {
                self.expand();
                h = h.smaller(self.natural_step());
            } else {
                h = h * T::of(0.5);
            }
        }
        None
    }

    /// Extends the series to the full order.
    fn expand(&mut self) {
        if let (2, Some(Touch { order: BY_JERK.., .. })) = (self.series.known, self.touch) {
            self.push();
        }
        let arena = &self.equation.arenas[self.arena];
        let order = self.settings.order;
        self.series.extend(order, &arena.force, self.equation.damping, self.drive, &mut self.roll);
    }

    fn push(&mut self) {
        let arena = &self.equation.arenas[self.arena];
        let next = self.series.known;
        self.series.extend(next, &arena.force, self.equation.damping, self.drive, &mut self.roll);
        if self.series.known == 3
            && let Some(Touch { order: BY_JERK.., .. }) = self.touch
        {
            self.series.y[2] = T::zero(); // a release: the net force is 0 by definition
        }
    }

    /// Extends the series, just begun, until two terms in a row are negligible over `flight`, against the rebound's own
    /// speed; false where the full order is not enough for that.
    pub(super) fn expand_for(&mut self, flight: T) -> bool {
        let negligible = self.v.abs() * T::of(self.settings.tolerance * 0.1);
        let arena = &self.equation.arenas[self.arena];
        let (order, damping) = (self.settings.order, self.equation.damping);
        let Self { series, drive, roll, .. } = self;
        let mut known = series.known;
        let mut power = T::of(1.0);
        let mut small = 0;
        while known <= order {
            if known == series.known {
                // the first few are always needed; a drive goes on once for each of the others
                series.extend(known.max(FEW).min(order), &arena.force, damping, *drive, roll);
            }
            power = power * flight;
            if known >= 3 {
                let term = (series.y[known] * power).abs() * T::whole(known);
                small = if term <= negligible { small + 1 } else { 0 };
            }
            known += 1;
            if small == 2 {
                series.known = known;
                return true;
            }
        }
        false
    }

    /// Whether the step's polynomial satisfies the equation of motion at its end, as far as the tolerance and
    /// rounding ask: the residual is what the first neglected terms leave.
    pub(super) fn step_holds(&mut self, h: T, &State { y, v, acceleration, .. }: &State<T>) -> bool {
        let arena = &self.equation.arenas[self.arena];
        let at = self.clock.advance(&self.at, h);
        let series = &self.series;
        let base = self.drive.value(&self.clock, &at, self.segment, || series.base(h), &mut self.roll);
        let sum = (acceleration + self.equation.damping * v) + base;
        let residual = (arena.force.at(y) + sum).abs() * h;
        let order = self.series.known - 1;
        let speed = if order < self.settings.order { self.v.abs() } else { self.settings.speed };
        let allowed = T::of(RESIDUAL * order as f64 * self.settings.tolerance) * speed;
        if residual <= allowed {
            return true;
        }
        // larger than asked for: rounding?
        let (_, _, rounding) = arena.force.value(y);
        let size = acceleration.abs() + (self.equation.damping * v).abs() + base.abs();
        residual <= (rounding + size * T::of(T::EPSILON)) * h * T::of(ROUNDINGS)
    }

    /// The first contact with an end of the arena within the step, as a share of it; of the step's end is known how it
    /// lies in the piece.
    pub(super) fn find_exit(&mut self, h: T, &State { y: end, bound, .. }: &State<T>) -> Option<(T, End)> {
        let zero = T::zero();
        let arena = &self.equation.arenas[self.arena];
        let n = self.series.known;
        let mut first: Option<(T, End)> = None;
        let mut scaled = None;
        if self.touch.is_none() {
            let limits = (arena.low, arena.high);
            let near = !(self.x - limits.0 > bound && limits.1 - self.x > bound);
            if !near {
                return None;
            }
            let (y, to) = (&self.series.y[..n], end + arena.origin);
            let bend = taylor::bend(y, h);
            if (Glide { start: self.x, end: to, bound, bend, limits }).is_clear() == (true, true) {
                return None;
            }
        }
        for end in [End::Low, End::High] {
            let sign = end.sign::<T>();
            let gap = sign * (arena.end(end).0 - self.x);
            let touch = self.touch.filter(|t| t.end == end);
            if touch.map_or(gap > bound, |touch| touch.order == HELD) {
                continue;
            }
            let mut g = [zero; ROOM];
            let scaled = scaled.get_or_insert_with(|| self.series.scaled(h));
            for (slot, c) in g[1..n].iter_mut().zip(&scaled[1..n]) {
                *slot = -(sign * *c);
            }
            g[0] = gap;
            // Beyond the surface only by rounding, after it was held, and not on the way out: it is touched.
            let returns = touch.is_none() && gap < zero && sign * self.v <= zero;
            let mut from = if returns { BY_SPEED } else { touch.map_or(0, |t| t.order.min(n - 1)) };
            // A coefficient that is exactly 0 decides nothing.
            while from + 1 < n && g[from] == zero {
                from += 1;
            }
            let g = &g[from..n];
            let s = if g[0] > zero {
                PolynomialRoots::new(g).first()
            } else if g[0] < zero {
                Some(zero) // outward at once
            } else {
                None // it stays where it is
            };
            if let Some(s) = s
                && first.is_none_or(|f| s < f.0)
            {
                first = Some((s, end));
            }
        }
        first
    }
}
