//! Steps of free flight, each up to its end or the first surface.

use crate::dynamics::clock::Instant;
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::End;
use crate::dynamics::motion::Motion;
use crate::dynamics::result::Outcome;
use crate::dynamics::state::Flow;
use crate::dynamics::step::stepper::Step;
use crate::dynamics::step::work::ARRIVAL;
use crate::numeric::Scalar;

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// Whether `steps` more steps of free flight fit into the budget.
    pub fn has_budget_for(&self, steps: u64) -> bool {
        self.stepper.work.has_room_for(steps * self.stepper.costs.step)
    }

    /// One step of free flight; `left` is the time to the end of the run.
    pub fn fly(&mut self, left: T) -> Flow {
        if self.stepper.pass_segment_end(&mut self.state) {
            return None;
        }
        self.stepper.seed(&self.state);
        self.stepper.evaluations += 1;
        let pressed = self.stepper.pressed_rebound(&self.state);
        let flight = match pressed {
            Some((end, rates)) if self.sum_chatter(end, rates) => return None,
            Some((end, rates)) => self.stepper.short_flight(&self.state, end, rates),
            None => None,
        };
        if flight.is_some_and(|_| pressed.is_some_and(|(end, rates)| self.will_rest(end, rates[0]))) {
            return None;
        }
        let (stepper, state) = (&mut self.stepper, &self.state);
        let mode = stepper.mode(state);
        stepper.series.begin(state.x - mode.origin, state.v);
        let alone = stepper.drive.circuit().is_none();
        let extended = flight.is_some_and(|flight| alone && stepper.expand_for(state, flight));
        if extended
            && let Some(flight) = flight
            && let Some((end, length, landing)) = stepper.rebound(state, flight, left)
        {
            let on_the_stop = (mode.end(end).0, landing.v);
            return self.arrive((length, length), landing.bound, on_the_stop, None, Some(end));
        }
        let step = stepper.choose_step(state, (flight, extended), left);
        self.take_any(step)
    }

    /// Takes the chosen step. Without one the series is not finite, which ends the run.
    pub fn take_any(&mut self, step: Option<Step<T>>) -> Flow {
        match step {
            Some(step) => self.take(&step),
            None => Some(Outcome::NotFinite { at: self.stepper.seconds(&self.state) }),
        }
    }

    /// Takes a step of free flight, up to its end or to the first surface.
    pub fn take(&mut self, &Step { length: h, arrival, end }: &Step<T>) -> Flow {
        let mode = self.stepper.mode(&self.state);
        match self.stepper.find_exit(&self.state, h, &end) {
            Some((length, v, exit)) => {
                self.stepper.work.add(ARRIVAL);
                self.arrive((h, length), end.bound, (mode.end(exit).0, v), None, Some(exit))
            }
            None => self.arrive((h, h), end.bound, (end.y + mode.origin, end.v), arrival, None),
        }
    }

    /// Records the part `length` of a step that was chosen `h` long, and moves to its end: the state `(x, v)`
    /// at the instant `arrival`, if that is known, on the surface of the end `touched`, if any.
    pub fn arrive(
        &mut self,
        (h, length): (T, T),
        bound: T,
        (x, v): (T, T),
        arrival: Option<Instant<T>>,
        touched: Option<End>,
    ) -> Flow {
        let circuit = self.stepper.circuit_at(length);
        if !(x.is_finite() && v.is_finite() && circuit.is_none_or(|state| state.is_finite())) {
            return Some(Outcome::NotFinite { at: self.stepper.seconds(&self.state) });
        }
        self.steps += 1;
        self.stepper.work.add(self.stepper.costs.step);
        let step = self.stepper.step_data(&self.state, (h, length, length), bound, (x, v));
        let path = &self.stepper.series;
        if let Some(log) = &mut self.log {
            log.add_step(path, &step);
        }
        self.record.step(path, self.stepper.circuit_series(), &step, self.state.segment);
        let at_once = length == T::zero();
        let state = &mut self.state;
        state.at = arrival.unwrap_or_else(|| self.stepper.clock.advance(&state.at, length));
        (state.x, state.v, state.touch) = (x, v, None);
        state.circuit = circuit.unwrap_or(state.circuit);
        state.turned_back &= at_once;
        touched.and_then(|end| self.reach(end, at_once))
    }
}
