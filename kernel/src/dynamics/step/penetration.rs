//! Series of the motion in contact with a compliant stop.
//!
//! Depth d in the stop and inward speed w obey d' = w and w' = A - k d^1.5 (1 + a w), where A is the
//! acceleration by everything but the stop. d^1.5 has no power series in time at touch and at separation, so
//! a series in time loses its order there. With the root u of the depth, d = u^2, and a parameter s with dt =
//! u ds, the same motion is
//!
//! ```text
//! du/ds = w/2,    dw/ds = u (A - k u^3 (1 + a w)),    dt/ds = u,
//! ```
//!
//! with polynomials throughout. u rises from 0 with the finite slope w/2 and passes through 0 at the
//! separation like any smooth function: near touch s is 2 sqrt(t/w), proportional to the root of the time
//! since touch, and the whole contact is as smooth as free flight, at any order and without grading of steps.
//! (The change of time is Sundman's of 1912, that of the coordinate Levi-Civita's of 1920, made for
//! collisions of bodies.) The only singularity is a touch without speed, u = w = 0, from which s never
//! increases: see `MIN_TOUCH_SPEED` in `compliant`.
//!
//! The base's acceleration is known as a series in time and is composed with t(s). A contact lasts a fraction
//! of a millisecond, so a few terms of a slow drive are sufficient; a fast one needs them all.

use crate::dynamics::drive::Drive;
use crate::dynamics::equation::Compliant;
use crate::dynamics::equation::force::PieceForce;
use crate::dynamics::series::{MAX_ORDER, ROOM, SEEDED, Series, convolve, each_order, polynomial, square};
use crate::numeric::{Scalar, fast_exp2, fast_log2};

/// One step of contact, in the parameter s, and the workspace.
#[derive(Debug, Clone)]
pub(crate) struct Penetration<T: Copy> {
    /// Displacement from the piece's origin over s, and the base's acceleration over *time*.
    pub inner: Series<T>,
    pub root: [T; ROOM],
    pub speed: [T; ROOM],
    /// Time since the step's start.
    pub(super) time: [T; ROOM],
    pub(super) depth: [T; ROOM],
    square: [T; ROOM],
    /// Outward acceleration by everything but stop and damping.
    outward: [T; ROOM],
    /// The terms of the force beyond the first ones, over the square of the depth.
    beyond: [T; ROOM],
    time_square: [T; ROOM],
    pub(super) base: [T; ROOM],
    /// Its nested form in powers of the time, from the second level on.
    nested: [[T; ROOM]; ROOM],
    /// Terms of the base's acceleration over time and of the force over depth that are composed.
    pub(super) terms: Terms,
    /// Terms of the base's acceleration that are known.
    pub(super) known_drive: usize,
    /// The force's coefficients about the surface.
    about: Vec<T>,
    /// The mode of that force.
    about_mode: Option<usize>,
    inverse: [T; ROOM],
    pub(super) order: usize,
    pub(super) stop: Compliant<T>,
    /// -1 for the left stop, 1 for the right one.
    pub(super) sign: T,
    /// Displacement of the untouched stop from the piece's origin.
    pub(super) surface: T,
    /// Whether the contact is clipped: the stop would have to pull.
    pub(super) clipped: bool,
}

/// Number of terms of the drive over time and of the force over depth that are used in a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Terms {
    /// Three of each.
    Few,
    /// Four of the drive, five of the force.
    More,
    /// This many of the drive, and the whole force.
    All(usize),
}

impl Terms {
    pub fn of_drive(self) -> usize {
        match self {
            Self::Few => 3,
            Self::More => SEEDED,
            Self::All(levels) => levels,
        }
    }
}

struct Constants<T> {
    force: [T; 5],
    stiffness: T,
    loss: T,
    damping: T,
}

impl<T: Scalar> Penetration<T> {
    /// With room for forces of up to this degree.
    pub fn new(stop: Compliant<T>, degree: usize) -> Self {
        let zeros = [T::zero(); ROOM];
        let inverse = std::array::from_fn(|k| T::of(1.0) / T::of((k.max(1)) as f64));
        Self {
            inner: Series::new(degree),
            root: zeros,
            speed: zeros,
            time: zeros,
            depth: zeros,
            square: zeros,
            outward: zeros,
            beyond: zeros,
            time_square: zeros,
            base: zeros,
            nested: [zeros; ROOM],
            terms: Terms::Few,
            known_drive: 0,
            about: Vec::new(),
            about_mode: None,
            inverse,
            order: 0,
            stop,
            sign: T::of(1.0),
            surface: T::zero(),
            clipped: false,
        }
    }

    /// The base's acceleration over time, for the drive to seed.
    pub fn seeded(&mut self) -> &mut [T; ROOM] {
        self.known_drive = SEEDED;
        &mut self.inner.a
    }

    /// Extends the base's acceleration over time to `levels` terms.
    pub fn extend_drive<D: Drive<T>>(&mut self, levels: usize, drive: &D, cursor: &mut D::Cursor) {
        while self.known_drive < levels {
            self.inner.extend_drive(self.known_drive, drive, cursor);
            self.known_drive += 1;
        }
    }

    /// Expands the motion to `order` in s, with `terms` of the base's acceleration over time (no more than
    /// are known) and of the force over depth; `mode` is the number of the force's mode. The first
    /// coefficients of root and speed, and all that describes the stop, must be set.
    pub fn expand(
        &mut self,
        (order, terms): (usize, Terms),
        (force, mode): (&PieceForce<T>, usize),
        damping: T,
    ) {
        let order = order.min(MAX_ORDER);
        (self.order, self.terms) = (order, terms);
        if self.about_mode != Some(mode) {
            force.about(self.surface, &mut self.about);
            self.about.resize(self.about.len().max(5), T::zero());
            self.about_mode = Some(mode);
        }
        self.time[0] = T::zero();
        self.depth[0] = self.root[0] * self.root[0];
        let [f0, f1, f2, f3, f4] = [0, 1, 2, 3, 4].map(|k| self.about[k]);
        let sign = self.sign;
        let stiffness = if self.clipped { T::zero() } else { self.stop.stiffness };
        let constants = Constants {
            // As outward forces over depth; the odd coefficients keep their sign.
            force: [sign * f0, f1, sign * f2, f3, sign * f4],
            stiffness,
            loss: stiffness * self.stop.loss,
            damping,
        };
        match terms {
            Terms::Few => each_order::<T, true, 0>(
                0..order,
                #[inline(always)]
                |k| self.extend::<false>(k, &constants, None),
            ),
            Terms::More => each_order::<T, true, 0>(
                0..order,
                #[inline(always)]
                |k| self.extend::<true>(k, &constants, None),
            ),
            Terms::All(_) => (0..order).for_each(|k| self.extend::<true>(k, &constants, Some(force))),
        }
        self.inner.y[order] = sign * self.depth[order];
        self.inner.known = order + 1;
    }

    /// Adds the coefficients `k + 1`, with `MORE` terms of force and drive, or with all terms of the force.
    #[inline(always)]
    fn extend<const MORE: bool>(&mut self, k: usize, constants: &Constants<T>, all: Option<&PieceForce<T>>) {
        let displacement = self.sign * self.depth[k];
        self.inner.y[k] = if k == 0 { self.surface + displacement } else { displacement };
        self.square[k] = square(&self.depth, k);
        let mut outward = match all {
            Some(force) => {
                let Terms::All(levels) = self.terms else { return };
                self.compose_all(k, levels - 1);
                self.sign * self.inner.force_coefficient(force, k)
            }
            None => {
                self.compose::<MORE>(k);
                let [f0, f1, f2, f3, f4] = constants.force;
                let mut sum = f1 * self.depth[k] + f2 * self.square[k];
                if MORE {
                    self.beyond[k] = f3 * self.depth[k] + f4 * self.square[k];
                    sum += convolve(&self.square, &self.beyond, k);
                }
                if k == 0 { sum + f0 } else { sum }
            }
        };
        outward += self.sign * self.base[k];
        self.outward[k] = outward;
        let next = self.inverse[k + 1];
        self.root[k + 1] = self.speed[k] * T::of(0.5) * next;
        self.time[k + 1] = self.root[k] * next;
        self.depth[k + 1] = square(&self.root, k + 1);
        let change = (convolve(&self.root, &self.outward, k)
            + constants.damping * T::whole(k + 1) * self.depth[k + 1])
            + (constants.stiffness * self.square[k]
                + constants.loss * convolve(&self.square, &self.speed, k));
        self.speed[k + 1] = -change * next;
    }

    /// Coefficient `k` of the base's acceleration over s: a polynomial of the time.
    #[inline(always)]
    fn compose<const MORE: bool>(&mut self, k: usize) {
        let a = &self.inner.a;
        self.time_square[k] = square(&self.time, k);
        let sum = a[1] * self.time[k] + a[2] * self.time_square[k];
        let sum = if MORE { sum + a[3] * convolve(&self.time, &self.time_square, k) } else { sum };
        self.base[k] = if k == 0 { a[0] + sum } else { sum };
    }

    /// The same with all terms up to the power `top`: a nested form, the innermost level first.
    fn compose_all(&mut self, k: usize, top: usize) {
        let a = &self.inner.a;
        let constant = |level: usize| if k == 0 { a[level] } else { T::zero() };
        if top == 0 {
            self.base[k] = constant(0);
            return;
        }
        for level in (0..top).rev() {
            let product = if level + 1 == top {
                a[top] * self.time[k]
            } else {
                convolve(&self.time, &self.nested[level + 1], k)
            };
            self.nested[level][k] = product + constant(level);
        }
        self.base[k] = self.nested[0][k];
    }

    /// The longest step in s whose first neglected term in the speed stays below `tolerance` times the
    /// scene's speed; computed from several of the last coefficients, as in free flight.
    pub fn natural_step(&self, speed_log2: f64, tolerance_log2: f64, cap: f64) -> f64 {
        let first = self.order.saturating_sub(3).max(1);
        let mut radius = f64::INFINITY;
        for (k, c) in (first..).zip(&self.speed[first..=self.order]) {
            let size = c.magnitude();
            if size > 1e-300 {
                radius = radius.min((speed_log2 - fast_log2(size)) / k as f64);
            } else if !size.is_finite() {
                return f64::NAN;
            }
        }
        let log2 = radius + tolerance_log2 / self.order as f64;
        if log2 < 1000.0 { fast_exp2(log2).min(cap) } else { cap }
    }

    /// Speed that the neglected terms of drive and force would cause in this time, up to this depth.
    pub fn neglected<D: Drive<T>>(&mut self, drive: &D, cursor: &mut D::Cursor, whole: (T, T)) -> T {
        let levels = self.terms.of_drive();
        let all_used = drive.zero_from().is_some_and(|zero| levels >= zero);
        if !all_used {
            self.extend_drive(levels + 2, drive, cursor);
        }
        let first = if self.terms == Terms::Few { 3 } else { 5 };
        let base = if all_used { &[][..] } else { &self.inner.a[levels..] };
        neglected((base, levels), (&self.about, first), whole)
    }

    pub(super) fn at(&self, c: &[T; ROOM], s: T) -> T {
        polynomial::value(&c[..=self.order], s)
    }

    pub fn root_at(&self, s: T) -> T {
        self.at(&self.root, s)
    }

    pub fn speed_at(&self, s: T) -> T {
        self.at(&self.speed, s)
    }

    /// The coefficients of `c`, each times its power of `h`.
    pub(super) fn powers(&self, c: &[T; ROOM], h: T) -> [T; ROOM] {
        polynomial::scaled(&c[..=self.order], h)
    }
}

/// Speed that neglected terms would cause over `time`, up to the depth `deepest`: the first two of the
/// drive's terms `base` over time, of orders from `levels` on, and all terms of the force over depth from
/// `first` on.
pub(super) fn neglected<T: Scalar>(
    (base, levels): (&[T], usize),
    (about, first): (&[T], usize),
    (time, deepest): (T, T),
) -> T {
    let mut made = T::zero();
    let mut power = (0..levels).fold(T::of(1.0), |power, _| power * time);
    for (k, a) in (levels..levels + 2).zip(base) {
        power = power * time;
        made = made.larger(a.abs() * power / T::of((k + 1) as f64));
    }
    if first < about.len() {
        let rest = about[first..].iter().rev().fold(T::zero(), |sum, c| sum * deepest + c.abs());
        made += rest * (0..first).fold(time, |power, _| power * deepest);
    }
    made
}
