//! Choice of a step of contact with a compliant stop, and the first event within it; choice of a whole impact
//! as one step, in which there is no other event.

use super::contact_path::{Changes, ContactState};
use super::impact::{DRIVE_TERMS, FORCE_TERMS, Impact, Separation};
use super::path::Path;
use super::penetration::{Penetration, Terms, neglected};
use super::stepper::{MAX_HALVINGS, RESIDUAL, ROUNDINGS, Stepper};
use crate::dynamics::clock::Instant;
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::{End, EndKind};
use crate::dynamics::series::{MAX_ORDER, SEEDED};
use crate::dynamics::state::{Contact, MotionState, Opening};
use crate::numeric::{Collocation, PolynomialRoots, Scalar, fast_log2};

/// Minimum of the speed to which the tolerance in contact is relative, as a share of the scene's speed. The
/// tolerance is relative to the speed that corresponds to the energy in the contact, up to the scene's speed:
/// a mass that oscillates on its stop moves at about a thousandth of the scene's speed, and errors relative
/// to that would hide its motion. Much slower motions are not visible.
const MIN_SPEED_SHARE: f64 = 1e-4;

/// Tolerance of a step in contact relative to that of free flight. A contact takes a dozen steps whose errors
/// have one sign, and an elastic mass makes thousands of contacts; with this share its energy drifts by
/// thousandths of the tolerance in each contact. The share adds one step in ten.
const CONTACT_SHARE: f64 = 0.03;

/// Its logarithm to base 2.
const CONTACT_SHARE_LOG2: f64 = -5.058_893_689_053_568;

/// Orders by which the series of a contact exceeds that of free flight, because of this tolerance.
const CONTACT_ORDERS: usize = 2;

/// Tolerance above which few terms of force and drive are tried first.
const COARSE: f64 = 1e-9;
/// Share of the scene's speed above which few terms are tried first: slower motions take longer steps, in
/// which the drive changes more.
const SLOW_SHARE: f64 = 0.01;

/// Tolerance of a step below which rounding dominates a whole impact.
const MIN_TOLERANCE: f64 = 1e-14;

/// Difference between the binary digits of the tolerance and the number of points of a whole impact.
const FEWER_POINTS: f64 = 2.0;

/// The event at the end of a step of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Reached {
    /// No event: the chosen end, the end of the run or that of the drive's segment.
    Time,
    Surface,
    ClipChange,
    End(End),
}

pub(crate) struct ContactStep<T> {
    /// Length as chosen, in the parameter.
    pub whole: T,
    /// Length that is kept, in the parameter.
    pub length: T,
    pub end: ContactState<T>,
    pub duration: T,
    /// Bound of the change of the depth over the chosen length.
    pub bound: T,
    pub reached: Reached,
    pub arrival: Option<Instant<T>>,
}

impl<T: Scalar, D: Drive<T>> Stepper<'_, T, D> {
    /// Expands the contact and chooses its length. Returns `None` if the coefficients are not finite.
    pub fn choose_contact_step(
        &mut self,
        state: &MotionState<T>,
        end: End,
        left: T,
        path: &mut Penetration<T>,
    ) -> Option<ContactStep<T>> {
        let mode = self.mode(state);
        let damping = self.equation.damping;
        let order = (self.settings.order + CONTACT_ORDERS).min(MAX_ORDER);
        let sign = end.sign::<T>();
        (path.root[0], path.speed[0]) = (state.depth.root, sign * state.v);
        (path.sign, path.surface) = (sign, self.equation.surface(end)? - mode.origin);
        path.clipped = matches!(state.contact, Contact::Clipped(_));
        self.drive.seed(&state.at, state.segment, path.seeded(), &mut self.cursor);
        self.evaluations += 1;
        self.work.add(self.costs.contact);
        // The parameter that the mass would reach in the longest time at its initial speed.
        let (u, w) = (path.root[0].to_f64(), path.speed[0].abs().to_f64());
        let longest = self.settings.longest;
        let cap = 2.0 * longest / (u + (u * u + w * longest).sqrt());
        let (speed, tolerance) = self.contact_tolerance(state)?;
        let fast = speed > self.settings.speed * T::of(SLOW_SHARE);
        let few = fast && self.settings.tolerance > COARSE;
        let mut terms = if few { Terms::Few } else { Terms::More };
        let force = (&mode.force, state.mode);
        path.expand((order, terms), force, damping);
        let settings = (fast_log2(speed.to_f64()), self.settings.tolerance_log2 + CONTACT_SHARE_LOG2);
        let mut whole = T::of(path.natural_step(settings.0, settings.1, cap));
        let border = self.drive.segment_end(state.segment);
        let allowed = T::of(RESIDUAL * order as f64 * tolerance) * speed;
        for _ in 0..MAX_HALVINGS {
            if !(whole > T::zero()) {
                return None;
            }
            let changes = path.changes(whole);
            let (share, mut reached) = self.first_event(state, whole, path, &changes);
            let mut length = share * whole;
            let mut at = path.state(length);
            let mut duration = at.time;
            if !matches!(terms, Terms::All(_)) {
                let deepest = path.depth[0] + changes.depth;
                let neglected = path.neglected(self.drive, &mut self.cursor, (duration, deepest));
                if neglected > T::of(tolerance) * speed {
                    // The drive is as fast as the contact, or the stop so soft that the force changes.
                    self.work.add(self.costs.contact);
                    terms = match terms {
                        Terms::Few => Terms::More,
                        _ => Terms::All(self.drive.zero_from().map_or(order, |zero| order.min(zero))),
                    };
                    path.extend_drive(terms.of_drive(), self.drive, &mut self.cursor);
                    path.expand((order, terms), force, damping);
                    whole = T::of(path.natural_step(settings.0, settings.1, cap));
                    continue;
                }
            }
            let mut arrival = None;
            let mut until = |time: T, instant| {
                if time <= duration {
                    (length, duration) = (path.parameter(time, length), time);
                    (reached, arrival) = (Reached::Time, Some(instant));
                }
            };
            until(left, self.end);
            if let Some(border) = border {
                until(self.clock.between(&state.at, &border), border);
            }
            if arrival.is_some() {
                at = path.state(length);
            }
            let residual = path.residual(&at, &mode.force, damping).abs();
            let rounding = || path.residual_rounding(&at, &mode.force, damping) * T::of(ROUNDINGS);
            if residual * length <= allowed || residual <= rounding() {
                let bound = changes.depth;
                return Some(ContactStep { whole, length, end: at, duration, bound, reached, arrival });
            }
            self.work.add(self.costs.check);
            whole = length * T::of(0.5);
        }
        None
    }

    /// The speed to which the tolerance of a step in contact is relative, and that tolerance.
    pub(super) fn contact_tolerance(&self, state: &MotionState<T>) -> Option<(T, f64)> {
        let stored = self.equation.compliant?.stored(state.depth.root);
        let energetic = (state.v * state.v + stored + stored).sqrt();
        let min_speed = self.settings.speed * T::of(MIN_SPEED_SHARE);
        let speed = self.settings.speed.smaller(energetic.larger(min_speed));
        Some((speed, self.settings.tolerance * CONTACT_SHARE))
    }

    /// The first event within a step of length `whole`, as a fraction of it.
    fn first_event(
        &self,
        state: &MotionState<T>,
        whole: T,
        path: &Penetration<T>,
        changes: &Changes<T>,
    ) -> (T, Reached) {
        let mut first = (T::of(1.0), Reached::Time);
        let mut earlier = |share: Option<T>, reached: Reached| {
            if let Some(share) = share.filter(|share| *share <= first.0) {
                first = (share, reached);
            }
        };
        earlier(path.separation(whole, changes), Reached::Surface);
        earlier(path.clip_change(whole, state.depth.clip_changed, changes), Reached::ClipChange);
        let mode = self.mode(state);
        let n = path.known();
        for at in [End::Low, End::High] {
            let (level, kind) = mode.end(at);
            let touch = state.touch.filter(|touch| touch.end == at);
            if kind == EndKind::Compliant || touch.is_some_and(|touch| touch.opening == Opening::Ignored) {
                continue;
            }
            let gap = at.sign::<T>() * (level - state.x);
            if gap > changes.depth {
                continue;
            }
            let mut g = path.scaled(whole);
            for c in &mut g[1..n] {
                *c = -(at.sign::<T>() * *c);
            }
            g[0] = gap;
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

    /// The impact that begins with this touch of the stop of `end`, if it can be taken in one step: nothing
    /// but the stop force changes much in it, neither a break of the curve nor `barrier` is within its reach,
    /// and it ends before the run and the drive's segment do.
    pub fn choose_impact(
        &mut self,
        state: &MotionState<T>,
        end: End,
        left: T,
        barrier: Option<T>,
        path: &mut Impact<T>,
    ) -> Option<Separation<T>> {
        let (sign, speed) = (end.sign::<T>(), end.sign::<T>() * state.v);
        let touches = matches!(state.contact, Contact::Compressing(_)) && state.depth.root == T::zero();
        if !touches || self.settings.tolerance < MIN_TOLERANCE {
            return None;
        }
        let mode = self.mode(state);
        let level = self.equation.surface(end)?;
        let (scale, tolerance) = self.contact_tolerance(state)?;
        self.drive.seed(&state.at, state.segment, &mut path.series.a, &mut self.cursor);
        for k in SEEDED..DRIVE_TERMS + 2 {
            path.series.extend_drive(k, self.drive, &mut self.cursor);
        }
        self.evaluations += 1;
        self.work.add(self.costs.contact);
        (path.sign, path.surface, path.damping) = (sign, level - mode.origin, self.equation.damping);
        if path.about_mode != Some(state.mode) {
            mode.force.about(path.surface, &mut path.about);
            path.about.resize(path.about.len().max(FORCE_TERMS), T::zero());
            path.about_mode = Some(state.mode);
        }
        path.rule = Collocation::of((-self.settings.tolerance_log2 - FEWER_POINTS) as usize);
        let share = scale / speed;
        let tolerances = (T::of(tolerance) * share, T::of(RESIDUAL * self.settings.tolerance) * share);
        let found = path.solve(speed, tolerances)?;
        let depth = path.max_root * path.max_root;
        let base = (&path.series.a[DRIVE_TERMS..], DRIVE_TERMS);
        let missed = neglected(base, (&path.about, FORCE_TERMS), (found.time, depth));
        let before = |border| found.time < self.clock.between(&state.at, &border);
        let in_time = found.time < left && self.drive.segment_end(state.segment).is_none_or(before);
        let clear = |at: T| !((at - level).abs() <= depth + depth);
        let alone = barrier.is_none_or(clear) && clear(mode.end(end).0);
        (missed <= T::of(tolerance) * scale && in_time && alone).then_some(found)
    }
}
