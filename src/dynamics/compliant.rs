//! How does the mass touch a compliant stop, press it in and separate from it?
//!
//! Contact is a phase of the motion like flight: steps of a series (`penetration`), with the base shaking on and every
//! event a root of the step's polynomials. It begins where free flight reaches the surface and ends where the root of the
//! depth is 0 again; in between nothing of it is searched for in free flight, whose steps stay as long as ever.
//!
//! Resting on such a stop is an oscillation of some kilohertz about a depth of a tenth of a micrometre, and it is
//! followed: on the prototype's stops at tolerance 1e-9 some 36 steps a period where it reaches up to the surface, and one
//! or two where it has died out, since an explicit method cannot step over a stiffness that no longer shows. One impact
//! takes 12 to 18 steps from tolerance 1e-3 to 1e-14.

use super::contact::side;
use super::drive::Drive;
use super::equation::{End, EndKind};
use super::motion::{BY_SPEED, Contact, Depth, Flow, HELD, MOST_HALVINGS, Motion, Touch};
use super::path::Path;
use super::path::StepView;
use super::penetration::{Entry, FEWEST_LEVELS, Penetration};
use super::prepare::base_at;
use super::result::Outcome;
use super::series::{MAX_ORDER, fast_log2};
use super::settings::{RESIDUAL, ROUNDINGS};
use crate::numeric::{PolynomialRoots, Scalar};

/// Speed of a touch without speed, in roundings of a rounding of the speed scale. The parameter of a contact begins with a
/// speed; a mass that is pressed onto the surface at rest gets one so small that it is nowhere seen: it grows with the
/// press by some e-foldings, which are one step or two.
const NUDGE: f64 = 1.0;

/// The least speed that the tolerance in contact is relative to, as a share of the scene's. It is relative to the speed that
/// the energy in the contact makes, up to the scene's own: a mass that trembles on its stop moves at some thousandth of
/// that, and errors of the scene's size would be all that is seen of it. Far below, they are not seen at all.
const LEAST_SPEED: f64 = 1e-4;

/// The tolerance of a step in contact relative to that of free flight. A contact takes a dozen steps, which all err to one
/// side, and an elastic mass makes thousands of contacts: its energy then drifts by thousandths of the tolerance in each.
/// It costs one step in ten.
const CONTACT_SHARE: f64 = 0.03;

/// What the order of a contact's series is above that of free flight, for that.
const CONTACT_ORDERS: usize = 2;

/// Where a step of contact ends.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Reached {
    /// Where it was chosen to, or at the end of the run or the drive's segment.
    Time,
    Surface,
    Turn,
    End(End),
}

/// A step of contact that has been chosen.
struct Step<T> {
    /// As chosen, and as kept, in the parameter.
    whole: T,
    length: T,
    duration: T,
    reached: Reached,
    arrival: Option<super::clock::Instant<T>>,
}

impl<T: Scalar, D: Drive<T>, const LEDGER: bool> Motion<'_, T, D, LEDGER> {
    /// Whether the run begins with the mass beyond the surface of a stop, where it then is.
    pub(super) fn start_pressed_in(&mut self) -> bool {
        for end in [End::Low, End::High] {
            let (sign, level) = (end.sign::<T>(), self.level(end));
            let Some(depth) = level.map(|level| sign * (self.x - level)).filter(|d| *d > T::zero()) else {
                continue;
            };
            self.depth = Depth { root: depth.sqrt(), turned: false };
            self.record.touch(&self.at, side(end), self.v, false);
            if self.contact == Contact::Free {
                let loss = self.equation.compliant.map_or(T::zero(), |stop| stop.loss);
                let pulls = T::of(1.0) + loss * (sign * self.v) < T::zero();
                self.contact = if pulls { Contact::Trailed(end) } else { Contact::Pressing(end) };
            }
            return true;
        }
        false
    }

    /// Displacement of the surface of the compliant stop of `end`.
    fn level(&self, end: End) -> Option<T> {
        let surface = |arena: &&super::equation::Arena<T>| {
            // The arena outside it: the surface is its end on that side.
            arena.end(end).1 == EndKind::Compliant && (arena.end(end).0 < T::zero()) == (end == End::Low)
        };
        self.equation.arenas.iter().find(surface).map(|arena| arena.end(end).0)
    }

    /// The mass is at the surface of the compliant stop of `end`, with this outward speed, 0 or of either sign.
    pub(super) fn meet(&mut self, end: End, outward: T) {
        if outward > T::zero() {
            return self.enter_stop(end, outward);
        }
        self.contact = Contact::Free;
        if outward < T::zero() {
            self.touch = Some(Touch { end, order: BY_SPEED });
            return;
        }
        match self.leaves(end) {
            None => self.enter_stop(end, T::zero()),
            touch => self.touch = touch,
        }
    }

    /// The mass passes the surface of the compliant stop of `end` inward of the stop, at `speed`.
    pub(super) fn enter_stop(&mut self, end: End, speed: T) {
        let least = self.settings.speed * T::of(NUDGE * T::EPSILON * T::EPSILON);
        let speed = speed.larger(least);
        self.v = end.sign::<T>() * speed;
        match end {
            End::Low => self.arena -= 1,
            End::High => self.arena += 1,
        }
        self.depth = Depth { root: T::zero(), turned: false };
        self.contact = Contact::Pressing(end);
        self.touch = None;
        self.work.add_impacts(1);
        self.record.touch(&self.at, side(end), self.v, true);
    }

    /// One step of contact with the stop of `end`; `left` is the time to the end of the run.
    #[inline(never)]
    pub(super) fn press_in(&mut self, end: End, left: T) -> Flow {
        if self.pass_segment_end() {
            return None;
        }
        let stop = self.equation.compliant?;
        let new = || Box::new(Penetration::new(stop, self.equation.most_products()));
        let mut path = self.penetration.take().unwrap_or_else(new);
        let flow = self.press_along(end, left, &mut path);
        self.penetration = Some(path);
        flow
    }

    fn press_along(&mut self, end: End, left: T, path: &mut Penetration<T>) -> Flow {
        let Some(step) = self.choose_contact_step(end, left, path) else {
            return Some(Outcome::NotFinite { at: self.clock.seconds(&self.at) });
        };
        let arena = &self.equation.arenas[self.arena];
        let sign = end.sign::<T>();
        let Step { whole, length, duration, reached, arrival } = step;
        let mut root = path.root_at(length).larger(T::zero());
        let mut speed = path.speed_at(length);
        let surface = self.level(end)?;
        let mut x = surface + sign * (root * root);
        match reached {
            Reached::Time => {}
            Reached::Surface => (root, x) = (T::zero(), surface),
            Reached::Turn => speed = T::of(-1.0) / self.equation.compliant?.loss,
            Reached::End(at) => {
                x = arena.end(at).0;
                root = (sign * (x - surface)).sqrt();
            }
        }
        if !(x.is_finite() && speed.is_finite()) {
            return Some(Outcome::NotFinite { at: self.clock.seconds(&self.at) });
        }
        self.steps += 1;
        let displacement = path.scaled(whole);
        let bound = displacement[1..path.known()].iter().fold(T::zero(), |sum, c| sum + c.abs());
        let view = StepView {
            path: &*path,
            origin: arena.origin,
            at: self.at,
            whole,
            length,
            duration,
            bound,
            limits: (arena.low, arena.high),
            x,
            v: sign * speed,
        };
        let (drive, clock, segment, unit) = (self.drive, self.clock, self.segment, self.equation.unit);
        self.record.step(&view, |at| base_at(drive, &clock, segment, at, unit));
        self.record.contact(&view);
        self.at = match arrival {
            Some(arrival) => arrival,
            None => self.clock.advance(&self.at, duration),
        };
        (self.x, self.v) = (x, sign * speed);
        self.depth = Depth { root, turned: reached == Reached::Turn };
        self.touch = None;
        match reached {
            Reached::Time => {}
            Reached::Surface => self.leave_stop(end),
            Reached::Turn => {
                self.contact = match self.contact {
                    Contact::Trailed(end) => Contact::Pressing(end),
                    _ => Contact::Trailed(end),
                };
            }
            Reached::End(at) => return self.reach_within(at),
        }
        None
    }

    /// The root of the depth is 0 again.
    fn leave_stop(&mut self, end: End) {
        self.record.separate(&self.at, side(end), self.v);
        match end {
            End::Low => self.arena += 1,
            End::High => self.arena -= 1,
        }
        self.contact = Contact::Free;
        let outward = end.sign::<T>() * self.v;
        if outward < T::zero() {
            self.touch = Some(Touch { end, order: BY_SPEED });
        } else {
            self.meet(end, T::zero()); // it has come to rest right at the surface
        }
    }

    /// The mass has reached the end of its arena deep in a stop: a break, or the end of the known curve.
    fn reach_within(&mut self, at: End) -> Flow {
        if self.equation.arenas[self.arena].end(at).1 == EndKind::Unknown {
            return Some(Outcome::LeftTable { at: self.clock.seconds(&self.at) });
        }
        let outward = at.sign::<T>() * self.v;
        if outward > T::zero() {
            self.enter_neighbour(at);
        } else {
            self.touch = Some(Touch { end: at, order: HELD });
        }
        None
    }

    /// Expands the contact and chooses how far it holds. None where the coefficients are not finite.
    fn choose_contact_step(&mut self, end: End, left: T, path: &mut Penetration<T>) -> Option<Step<T>> {
        let arena = &self.equation.arenas[self.arena];
        let damping = self.equation.damping;
        let order = (self.settings.order + CONTACT_ORDERS).min(MAX_ORDER);
        let sign = end.sign::<T>();
        let entry = Entry {
            root: self.depth.root,
            speed: sign * self.v,
            sign,
            surface: self.level(end)? - arena.origin,
            trails: matches!(self.contact, Contact::Trailed(_)),
        };
        self.drive.seed(&self.clock, &self.at, self.segment, path.seeded(), &mut self.roll);
        self.evaluations += 1;
        self.work.add(self.costs.contact);
        let mut levels = FEWEST_LEVELS.min(D::ZERO_FROM);
        path.expand(&entry, order, levels, &arena.force, damping);
        // As far as the speed of the step's start would bring it in the longest time.
        let (u, w) = (entry.root.to_f64(), entry.speed.abs().to_f64());
        let longest = self.settings.longest;
        let cap = 2.0 * longest / (u + (u * u + w * longest).sqrt());
        let stored = self.equation.compliant?.stored(entry.root);
        let energetic = (entry.speed * entry.speed + stored + stored).sqrt();
        let speed = self.settings.speed.smaller(energetic.larger(self.settings.speed * T::of(LEAST_SPEED)));
        let tolerance = self.settings.tolerance * CONTACT_SHARE;
        let settings = (fast_log2(speed.to_f64()), self.settings.tolerance_log2 + CONTACT_SHARE.log2());
        let mut whole = T::of(path.natural_step(settings.0, settings.1, cap));
        let border = self.drive.segment_end(self.segment);
        let allowed = T::of(RESIDUAL * order as f64 * tolerance) * speed;
        for _ in 0..MOST_HALVINGS {
            if !(whole > T::zero()) {
                return None;
            }
            let (share, mut reached) = self.first_event(whole, path);
            let mut length = share * whole;
            let mut duration = path.time(length);
            if levels < D::ZERO_FROM && levels < order {
                let neglected = path.neglected_drive(self.drive, &mut self.roll, duration);
                if neglected > T::of(tolerance) * speed {
                    // A drive as fast as the contact: all its terms.
                    self.work.add(self.costs.contact);
                    levels = order;
                    path.extend_drive(levels, self.drive, &mut self.roll);
                    path.expand(&entry, order, levels, &arena.force, damping);
                    whole = T::of(path.natural_step(settings.0, settings.1, cap));
                    continue;
                }
            }
            let mut arrival = None;
            let mut until = |time: T, at| {
                if time <= duration {
                    (length, duration) = (path.parameter(time, length), time);
                    (reached, arrival) = (Reached::Time, Some(at));
                }
            };
            until(left, self.end);
            if let Some(border) = border {
                until(self.clock.between(&self.at, &border), border);
            }
            let residual = path.residual(length, &arena.force, damping);
            let rounding = residual.size * T::of(T::EPSILON * ROUNDINGS);
            if residual.error.abs() * length <= allowed || residual.error.abs() <= rounding {
                return Some(Step { whole, length, duration, reached, arrival });
            }
            self.work.add(self.costs.check);
            whole = length * T::of(0.5);
        }
        None
    }

    /// The first event within a step of `whole`, as a share of it.
    fn first_event(&self, whole: T, path: &Penetration<T>) -> (T, Reached) {
        let mut first = (T::of(1.0), Reached::Time);
        let mut earlier = |share: Option<T>, reached: Reached| {
            if let Some(share) = share.filter(|share| *share <= first.0) {
                first = (share, reached);
            }
        };
        earlier(path.separation(whole), Reached::Surface);
        earlier(path.turn(whole, self.depth.turned), Reached::Turn);
        let arena = &self.equation.arenas[self.arena];
        let n = path.known();
        for at in [End::Low, End::High] {
            let (level, kind) = arena.end(at);
            let touch = self.touch.filter(|touch| touch.end == at);
            if kind == EndKind::Compliant || touch.is_some_and(|touch| touch.order == HELD) {
                continue;
            }
            let mut g = path.scaled(whole);
            for c in &mut g[1..n] {
                *c = -(at.sign::<T>() * *c);
            }
            g[0] = at.sign::<T>() * (level - self.x);
            let mut from = usize::from(touch.is_some());
            while from + 1 < n && g[from] == T::zero() {
                from += 1;
            }
            let g = &g[from..n];
            let share = if g[0] > T::zero() { PolynomialRoots::new(g).first() } else { Some(T::zero()) };
            earlier(share, Reached::End(at));
        }
        first
    }
}
