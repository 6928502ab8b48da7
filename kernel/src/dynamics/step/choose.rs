//! Choice of the length of a step of free flight, and the state of a circuit along it. It must stay equal to
//! the bit with the two other event-free steps, see `run/event_free.rs`.

use super::stepper::{MAX_HALVINGS, RESIDUAL, ROUNDINGS, Step, Stepper};
use crate::dynamics::drive::Drive;
use crate::dynamics::series::{Endpoint, natural_steps, polynomial};
use crate::dynamics::state::{MotionState, Opening};
use crate::numeric::{Scalar, fast_log2};

/// Order that is sufficient for the series of most rebounds.
const LOW_ORDER: usize = 8;

impl<T: Scalar, D: Drive<T>> Stepper<'_, T, D> {
    /// Extends the series as far as the step needs it, unless it is already `extended` for a `flight`.
    /// Returns `None` if the coefficients are not finite.
    ///
    /// Several consecutive coefficients may vanish although the next one does not (a high power near its flat
    /// middle, tones that cancel); the last coefficients then suggest too long a step. So each step is
    /// checked against the equation of motion at its end, and halved until it satisfies it.
    #[inline(always)]
    pub fn choose_step(
        &mut self,
        state: &MotionState<T>,
        (flight, extended): (Option<T>, bool),
        left: T,
    ) -> Option<Step<T>> {
        let length = match flight {
            Some(flight) if extended => flight,
            _ => {
                self.expand(state);
                let natural = self.natural_step();
                flight.map_or(natural, |flight| flight.smaller(natural))
            }
        };
        self.shorten(state, length, left)
    }

    #[inline]
    fn natural_step(&self) -> T {
        let s = &self.settings;
        let natural = self.series.natural_step(s.speed_log2, s.tolerance_log2, s.longest);
        T::of(self.circuit_step().map_or(natural, |step| natural.min(step)))
    }

    /// The step of up to length `h` that ends before the borders and satisfies the equation of motion.
    #[inline(always)]
    pub fn shorten(&mut self, state: &MotionState<T>, mut h: T, left: T) -> Option<Step<T>> {
        for attempt in 0..MAX_HALVINGS {
            if !(h > T::zero()) {
                return None;
            }
            if attempt > 0 {
                self.work.add(self.costs.check);
            }
            let arrival = self.arrival(state, left, &mut h);
            let end = self.series.state(h);
            if self.step_holds(state, h, &end) {
                return Some(Step { length: h, arrival, end });
            }
            if self.series.known <= self.settings.order {
                self.expand(state);
                h = h.smaller(self.natural_step());
            } else {
                h = h * T::of(0.5);
            }
        }
        None
    }

    #[inline]
    fn expand(&mut self, state: &MotionState<T>) {
        let (mode, damping, order) = (self.mode(state), self.equation.damping, self.settings.order);
        let Self { series, drive, cursor, .. } = self;
        if series.known == 2 && state.touch.is_some_and(|touch| touch.opening >= Opening::Jerk) {
            series.extend(2, &mode.force, damping, *drive, cursor);
            series.y[2] = T::zero(); // a release: the net force is 0 by definition
        }
        series.extend(order, &mode.force, damping, *drive, cursor);
    }

    /// Extends the series, just begun, until two consecutive terms are negligible over `flight` relative to
    /// the speed of the rebound. Returns false if the full order is not enough for that.
    #[inline(never)] // large
    pub fn expand_for(&mut self, state: &MotionState<T>, flight: T) -> bool {
        let negligible = state.v.abs() * T::of(self.settings.tolerance * 0.1);
        let mode = self.mode(state);
        let (order, damping) = (self.settings.order, self.equation.damping);
        let Self { series, drive, cursor, .. } = self;
        let about = state.touch.map_or(&[][..], |touch| mode.about(touch.end, state.x));
        let (mut power, mut small) = (flight, 0);
        // A force of high degree is prepared for a longer series only if that is needed.
        for order in [order.min(LOW_ORDER), order] {
            series.extend_while(
                order,
                (&mode.force, about),
                damping,
                *drive,
                cursor,
                #[inline(always)]
                |k, c| {
                    if k > 2 {
                        power = power * flight;
                        let term = (c * power).abs() * T::whole(k);
                        small = if term <= negligible { small + 1 } else { 0 };
                    }
                    small < 2
                },
            );
            if small == 2 {
                return true;
            }
        }
        false
    }

    /// Whether the polynomial satisfies the equation of motion at the end of the step, within tolerance and
    /// rounding: the residual is left by the first neglected terms.
    #[inline]
    pub fn step_holds(
        &mut self,
        state: &MotionState<T>,
        h: T,
        &Endpoint { y, v, acceleration, .. }: &Endpoint<T>,
    ) -> bool {
        let mode = self.mode(state);
        let at = self.clock.advance(&state.at, h);
        let series = &self.series;
        let base = self.drive.value(&at, state.segment, || series.base(h), &mut self.cursor);
        let sum = (acceleration + self.equation.damping * v) + base;
        let push = self.drive.circuit().and_then(|circuit| Some(circuit.coupling * self.circuit_at(h)?));
        let sum = push.map_or(sum, |push| sum + push);
        let residual = (mode.force.at(y) + sum).abs() * h;
        let order = self.series.known - 1;
        let speed = if order < self.settings.order { state.v.abs() } else { self.settings.speed };
        let allowed = T::of(RESIDUAL * order as f64 * self.settings.tolerance) * speed;
        if residual <= allowed {
            return self.circuit_holds(h, v);
        }
        // larger than permitted: it may be rounding
        let (_, _, rounding) = mode.force.value(y);
        let size = acceleration.abs() + (self.equation.damping * v).abs() + base.abs();
        let size = push.map_or(size, |push| size + push.abs());
        residual <= (rounding + size * T::of(T::EPSILON)) * h * T::of(ROUNDINGS) && self.circuit_holds(h, v)
    }

    /// Coefficients of the circuit's state that belong to those of the motion; `None` without a circuit.
    #[inline(always)]
    pub fn circuit_series(&self) -> Option<&[T]> {
        self.drive.circuit_state(&self.cursor).map(|state| &state[..self.series.known - 1])
    }

    #[inline(always)]
    pub fn circuit_at(&self, t: T) -> Option<T> {
        self.circuit_series().map(|state| polynomial::value(state, t))
    }

    /// Effect of the circuit on a mass that moves little, as a stiffness over mass: its squared coupling.
    #[inline(always)]
    pub fn circuit_stiffness(&self) -> Option<T> {
        self.drive.circuit().map(|circuit| circuit.coupling * circuit.coupling)
    }

    /// The longest step whose first neglected term in the circuit's state stays below the tolerance.
    #[inline(always)]
    pub fn circuit_step(&self) -> Option<f64> {
        let (circuit, state) = (self.drive.circuit()?, self.circuit_series()?);
        let (s, order) = (&self.settings, self.series.known - 1);
        // as for the velocity, whose coefficient k - 1 is k times coefficient k of the displacement
        let coefficient = |k: usize| [state[k - 1].magnitude() / k as f64];
        let scale = fast_log2(circuit.scale.to_f64());
        let [step] = natural_steps(order, coefficient, &[scale], s.tolerance_log2, &[s.longest]);
        Some(step)
    }

    /// Whether the polynomial of the state satisfies the circuit's equation at time `h` into the step, where
    /// the velocity is `v`, within tolerance and rounding.
    #[inline(always)]
    pub fn circuit_holds(&self, h: T, v: T) -> bool {
        let Some((circuit, state)) = self.drive.circuit().zip(self.circuit_series()) else { return true };
        let residual = polynomial::slope(state, h) + circuit.decay * polynomial::value(state, h);
        let residual = (residual - circuit.coupling * v).abs() * h;
        let allowed = T::of(RESIDUAL * state.len() as f64 * self.settings.tolerance) * circuit.scale;
        if residual <= allowed {
            return true;
        }
        // larger than permitted: it may be rounding
        let (mut size, mut power) = (T::zero(), T::of(1.0));
        for (k, c) in state.iter().enumerate() {
            size += c.abs() * power * (T::whole(k) + circuit.decay * h);
            power = power * h;
        }
        let size = size + (circuit.coupling * v * h).abs();
        residual <= size * T::of(T::EPSILON * ROUNDINGS)
    }
}
