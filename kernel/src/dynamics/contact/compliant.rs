//! Contact with a compliant stop: touch, compression, separation.
//!
//! Contact is a phase of the motion like free flight: each step is a series (`penetration`) that includes the
//! drive, and every event is a root of the step's polynomials. Contact begins where free flight reaches the
//! surface and ends where the depth returns to 0. Steps of free flight cost the same with and without a
//! compliant stop.
//!
//! A mass that rests on such a stop oscillates at some kilohertz about a depth of a tenth of a micrometre.
//! The oscillation is integrated while it is above the tolerance: on the prototype's stops at tolerance 1e-9
//! this takes about 36 steps per period if the oscillation reaches the surface, and one or two if it is
//! small. Below the tolerance the mass follows its load (`quasi_static`).
//!
//! Most impacts end before anything but the stop force changes much. Such an impact is a single step
//! (`impact`); any other takes 12 to 18 steps at tolerances from 1e-3 to 1e-14.

use crate::dynamics::drive::Drive;
use crate::dynamics::equation::{Compliant, End, EndKind};
use crate::dynamics::motion::Motion;
use crate::dynamics::result::Outcome;
use crate::dynamics::state::{Contact, Depth, Flow, Opening, Touch};
use crate::dynamics::step::choose_quasi_static::QuasiStaticStep;
use crate::dynamics::step::contact::{ContactStep, Reached};
use crate::dynamics::step::impact::{Impact, Separation};
use crate::dynamics::step::path::InStop;
use crate::dynamics::step::penetration::Penetration;
use crate::dynamics::step::quasi_static::QuasiStatic;
use crate::numeric::Scalar;

/// Minimum speed of a touch, in eps^2 times the speed scale. The series of a contact needs a speed at touch
/// that is not 0. A mass pressed onto the surface at rest gets this speed, which is too small to appear in
/// any output.
const MIN_TOUCH_SPEED: f64 = 1.0;

impl<T: Scalar, D: Drive<T>> Motion<'_, T, D> {
    /// Puts the mass into contact if the run begins beyond the surface of a stop. Returns whether it does.
    pub fn start_inside_a_stop(&mut self) -> bool {
        for end in [End::Low, End::High] {
            let (sign, level) = (end.sign::<T>(), self.stepper.equation.surface(end));
            let Some(depth) = level.map(|level| sign * (self.state.x - level)).filter(|d| *d > T::zero())
            else {
                continue;
            };
            self.state.depth = Depth { root: depth.sqrt(), clip_changed: false };
            self.record.touch(&self.state.at, end.side(), self.state.v, false);
            let Some(stop) = self.stepper.equation.compliant else { return true };
            if self.state.contact == Contact::Free {
                let clipped = stop.is_clipped(sign * self.state.v);
                self.state.contact = if clipped { Contact::Clipped(end) } else { Contact::Compressing(end) };
            } else {
                self.record.peak_contact = stop.force(self.state.depth.root, T::zero());
            }
            return true;
        }
        false
    }

    /// The mass is at the surface of the compliant stop of `end`; its outward speed may have either sign.
    pub fn meet(&mut self, end: End, outward: T) {
        if outward > T::zero() {
            return self.enter_stop(end, outward);
        }
        self.state.contact = Contact::Free;
        if outward < T::zero() {
            self.state.touch = Some(Touch { end, opening: Opening::Speed });
            return;
        }
        match self.leaves(end) {
            None => self.enter_stop(end, T::zero()),
            touch => self.state.touch = touch,
        }
    }

    /// The mass enters the compliant stop of `end` through its surface at `speed`.
    pub fn enter_stop(&mut self, end: End, speed: T) {
        let min_speed = self.stepper.settings.speed * T::of(MIN_TOUCH_SPEED * T::EPSILON * T::EPSILON);
        let speed = speed.larger(min_speed);
        self.state.v = end.sign::<T>() * speed;
        self.state.enter(end);
        self.state.depth = Depth { root: T::zero(), clip_changed: false };
        self.state.contact = Contact::Compressing(end);
        self.state.touch = None;
        self.stepper.work.impacts += 1;
        self.record.touch(&self.state.at, end.side(), self.state.v, true);
    }

    /// One step of contact with the stop of `end`; `left` is the time to the end of the run.
    #[inline(never)]
    pub fn contact_step(&mut self, end: End, left: T) -> Flow {
        if self.stepper.pass_segment_end(&mut self.state) {
            return None;
        }
        let stop = self.stepper.equation.compliant?;
        if self.take_quasi_static_step(end, left, stop) || self.take_impact(end, left, stop) {
            return None;
        }
        let new = || Box::new(Penetration::new(stop, self.stepper.equation.degree()));
        let mut path = self.stepper.penetration.take().unwrap_or_else(new);
        let flow = self.take_contact_step(end, left, &mut path);
        self.stepper.penetration = Some(path);
        flow
    }

    /// Takes a whole impact as one step if possible. Returns whether it was taken.
    fn take_impact(&mut self, end: End, left: T, stop: Compliant<T>) -> bool {
        let mut path = self.stepper.impact.take().unwrap_or_else(|| Box::new(Impact::new(stop)));
        let barrier = self.record.barrier;
        let found = self.stepper.choose_impact(&self.state, end, left, barrier, &mut path);
        if let Some(Separation { time, speed }) = found {
            let whole = T::of(2.0);
            let (x, v) = (self.state.x, end.sign::<T>() * speed);
            self.record_contact(&*path, (whole, whole, time), path.max_root * path.max_root, (x, v));
            self.state.at = self.stepper.clock.advance(&self.state.at, time);
            self.state.v = v;
            self.leave_stop(end);
        }
        self.stepper.impact = Some(path);
        found.is_some()
    }

    /// Takes a quasi-static step if the mass does not ring. Returns whether it was taken.
    fn take_quasi_static_step(&mut self, end: End, left: T, stop: Compliant<T>) -> bool {
        let new = || Box::new(QuasiStatic::new(stop));
        let mut path = self.stepper.quasi_static.take().unwrap_or_else(new);
        let step = self.stepper.quasi_static_step(&self.state, end, left, &mut path);
        if let (Some(step), Some(surface)) = (&step, self.stepper.equation.surface(end)) {
            let sign = end.sign::<T>();
            let &QuasiStaticStep { length, arrival, end: (root, speed), bound } = step;
            let (x, v) = (surface + sign * (root * root), sign * speed);
            self.record_contact(&*path, (length, length, length), bound, (x, v));
            self.state.at = arrival.unwrap_or_else(|| self.stepper.clock.advance(&self.state.at, length));
            (self.state.x, self.state.v) = (x, v);
            self.state.depth = Depth { root, clip_changed: false };
            self.state.touch = None;
        }
        self.stepper.quasi_static = Some(path);
        step.is_some()
    }

    fn take_contact_step(&mut self, end: End, left: T, path: &mut Penetration<T>) -> Flow {
        let Some(step) = self.stepper.choose_contact_step(&self.state, end, left, path) else {
            return Some(Outcome::NotFinite { at: self.stepper.seconds(&self.state) });
        };
        let mode = self.stepper.mode(&self.state);
        let sign = end.sign::<T>();
        let ContactStep { whole, length, end: at, duration, bound, reached, arrival } = step;
        let (mut root, mut speed) = (at.root.larger(T::zero()), at.speed);
        let surface = self.stepper.equation.surface(end)?;
        let mut x = surface + sign * (root * root);
        match reached {
            Reached::Time => {}
            Reached::Surface => (root, x) = (T::zero(), surface),
            Reached::ClipChange => speed = self.stepper.equation.compliant?.clipping_speed(),
            Reached::End(at) => {
                x = mode.end(at).0;
                root = (sign * (x - surface)).sqrt();
            }
        }
        if !(x.is_finite() && speed.is_finite()) {
            return Some(Outcome::NotFinite { at: self.stepper.seconds(&self.state) });
        }
        self.record_contact(path, (whole, length, duration), bound, (x, sign * speed));
        self.state.at = match arrival {
            Some(arrival) => arrival,
            None => self.stepper.clock.advance(&self.state.at, duration),
        };
        (self.state.x, self.state.v) = (x, sign * speed);
        self.state.depth = Depth { root, clip_changed: reached == Reached::ClipChange };
        self.state.touch = None;
        match reached {
            Reached::Time => {}
            Reached::Surface => self.leave_stop(end),
            Reached::ClipChange => {
                self.state.contact = match self.state.contact {
                    Contact::Clipped(end) => Contact::Compressing(end),
                    _ => Contact::Clipped(end),
                };
            }
            Reached::End(at) => return self.reach_within(at),
        }
        None
    }

    /// Records a step of contact along a path. `lengths`: the chosen length, the length kept, and its
    /// duration; `bound`: a bound of the displacement; `end`: the state at the end.
    fn record_contact<P: InStop<T>>(&mut self, path: &P, lengths: (T, T, T), bound: T, end: (T, T)) {
        self.steps += 1;
        let step = self.stepper.step_data(&self.state, lengths, bound, end);
        self.record.step(path, None, &step, self.state.segment);
        self.record.contact(path, &step);
    }

    /// The mass leaves the stop: the root of the depth is 0 again.
    fn leave_stop(&mut self, end: End) {
        self.record.separate(&self.state.at, end.side(), self.state.v);
        let sign = end.sign::<T>();
        // one mode inward, or more if the step has also passed a break just outside the surface
        while sign * (self.stepper.mode(&self.state).end(end).0 - self.state.x) > T::zero() {
            self.state.enter(end.other());
        }
        self.state.contact = Contact::Free;
        let outward = sign * self.state.v;
        if outward < T::zero() {
            self.state.touch = Some(Touch { end, opening: Opening::Speed });
        } else {
            self.meet(end, T::zero()); // it has come to rest exactly at the surface
        }
    }

    /// The mass has reached the end of its mode deep in a stop: a break, or the end of the known curve.
    fn reach_within(&mut self, at: End) -> Flow {
        if self.stepper.mode(&self.state).end(at).1 == EndKind::Unknown {
            return Some(Outcome::LeftTable { at: self.stepper.seconds(&self.state) });
        }
        let outward = at.sign::<T>() * self.state.v;
        if outward > T::zero() {
            self.enter_neighbour(at);
        } else {
            self.state.touch = Some(Touch { end: at, opening: Opening::Ignored });
        }
        None
    }
}
