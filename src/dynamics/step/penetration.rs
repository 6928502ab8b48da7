//! Series of the motion in contact with a compliant stop.
//!
//! Depth d in the stop and inward speed w obey d' = w and w' = A - k d^1.5 (1 + a w), A what everything but
//! the stop does. d^1.5 has no power series in time at touch-down and at separation, so a series in time
//! loses its order there. With the root u of the depth, d = u^2, and a parameter s with dt = u ds, the same
//! motion is
//!
//! ```text
//! du/ds = w/2,    dw/ds = u (A - k u^3 (1 + a w)),    dt/ds = u,
//! ```
//!
//! polynomial throughout. u rises from 0 with the finite slope w/2 and, at the separation, passes through 0
//! as any smooth function does: near touch-down s is 2 sqrt(t/w), the root of the time since touch, and the
//! whole contact is as smooth as free flight, at any order and with no grading of steps. (The change of time
//! is Sundman's of 1912, that of the coordinate Levi-Civita's of 1920, made for collisions of bodies.) Its
//! one singular place is a touch without speed, u = w = 0, where s never begins: see `NUDGE` in `compliant`.
//!
//! The base's acceleration is known as a series in time and is composed with t(s). A contact lasts a fraction
//! of a millisecond, so that a few terms of a slow drive are all there is of it; a fast one takes them all.

use crate::dynamics::drive::Drive;
use crate::dynamics::equation::Compliant;
use crate::dynamics::equation::force::PieceForce;
use crate::dynamics::series::{MAX_ORDER, ROOM, SEEDED, Series, convolve};
use crate::numeric::{PolynomialRoots, Scalar, fast_exp2, fast_log2};

/// Everything about one step of contact, in the parameter s, and the workspace.
#[derive(Debug, Clone)]
pub(crate) struct Penetration<T> {
    /// Displacement from the piece's origin over s, and the base's acceleration over *time*.
    pub inner: Series<T>,
    /// Root of the depth.
    pub root: [T; ROOM],
    /// Speed into the stop.
    pub speed: [T; ROOM],
    /// Time since the step's start.
    pub(super) time: [T; ROOM],
    /// Force of the stop over stiffness: u^3 (1 + a w); 0 where the contact is clipped.
    pub(super) push: [T; ROOM],
    pub(super) depth: [T; ROOM],
    pub(super) cube: [T; ROOM],
    pub(super) acceleration: [T; ROOM],
    /// The base's acceleration.
    pub(super) base: [T; ROOM],
    /// Its nested form in powers of the time, from the second level on.
    pub(super) nested: [[T; ROOM]; ROOM],
    /// Terms of the base's acceleration over time that are composed.
    pub(super) levels: usize,
    /// Terms of it that are known.
    pub(super) known_drive: usize,
    pub(super) order: usize,
    pub(super) stop: Compliant<T>,
    /// -1 for the left stop, 1 for the right one.
    pub(super) sign: T,
    /// Displacement of the untouched stop from the piece's origin.
    pub(super) surface: T,
    /// The contact is clipped: the stop would have to pull.
    pub(super) clipped: bool,
}

/// Where a step of contact begins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Start<T> {
    pub root: T,
    pub speed: T,
    pub sign: T,
    pub surface: T,
    pub clipped: bool,
}

/// The equation of motion at one instant of contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Residual<T> {
    /// dw/ds by the polynomial less what the equation says.
    pub error: T,
    /// Sum of the magnitudes of its terms.
    pub size: T,
}

impl<T: Scalar> Penetration<T> {
    /// With room for forces that take up to `products` products of series beyond the first.
    pub fn new(stop: Compliant<T>, products: usize) -> Self {
        let zeros = [T::zero(); ROOM];
        Self {
            inner: Series::new(products),
            root: zeros,
            speed: zeros,
            time: zeros,
            push: zeros,
            depth: zeros,
            cube: zeros,
            acceleration: zeros,
            base: zeros,
            nested: [zeros; ROOM],
            levels: 0,
            known_drive: 0,
            order: 0,
            stop,
            sign: T::of(1.0),
            surface: T::zero(),
            clipped: false,
        }
    }

    /// The base's acceleration over time as the drive seeds it.
    pub fn seeded(&mut self) -> &mut [T; ROOM] {
        self.known_drive = SEEDED;
        &mut self.inner.a
    }

    /// Makes `levels` terms of the base's acceleration over time known.
    pub fn extend_drive<D: Drive<T>>(&mut self, levels: usize, drive: &D, cursor: &mut D::Cursor) {
        while self.known_drive < levels {
            self.inner.extend_drive(self.known_drive, drive, cursor);
            self.known_drive += 1;
        }
    }

    /// Expands the motion from `start` to `order` in s, with `levels` terms of the base's acceleration over
    /// time (at least one, and no more than are known).
    pub fn expand(
        &mut self,
        start: &Start<T>,
        order: usize,
        levels: usize,
        force: &PieceForce<T>,
        damping: T,
    ) {
        let order = order.min(MAX_ORDER);
        (self.order, self.levels, self.clipped) = (order, levels, start.clipped);
        (self.sign, self.surface) = (start.sign, start.surface);
        self.root[0] = start.root;
        self.speed[0] = start.speed;
        self.time[0] = T::zero();
        for k in 0..=order {
            self.depth[k] = convolve(&self.root, &self.root, k);
            let displacement = self.sign * self.depth[k];
            self.inner.y[k] = if k == 0 { self.surface + displacement } else { displacement };
            if start.clipped {
                self.push[k] = T::zero();
            } else {
                self.cube[k] = convolve(&self.root, &self.depth, k);
                self.push[k] = self.cube[k] + self.stop.loss * convolve(&self.cube, &self.speed, k);
            }
            if k == order {
                break;
            }
            self.compose(k);
            let others = self.sign * (self.inner.force_coefficient(force, k) + self.base[k]);
            let pushed = self.stop.stiffness * self.push[k];
            self.acceleration[k] = -(damping * self.speed[k] + others + pushed);
            let share = T::of(1.0) / T::of((k + 1) as f64);
            self.root[k + 1] = self.speed[k] * T::of(0.5) * share;
            self.time[k + 1] = self.root[k] * share;
            self.speed[k + 1] = convolve(&self.root, &self.acceleration, k) * share;
        }
        self.inner.known = order + 1;
    }

    /// Coefficient `k` of the base's acceleration over s: a nested form in the time, the innermost level
    /// first.
    fn compose(&mut self, k: usize) {
        let a = &self.inner.a;
        let constant = |level: usize| if k == 0 { a[level] } else { T::zero() };
        let top = self.levels - 1;
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
    /// scene's speed; from several of the last coefficients, as in free flight.
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

    /// Speed that the first terms of the drive that are not composed would make over `time`.
    pub fn neglected_drive<D: Drive<T>>(&mut self, drive: &D, cursor: &mut D::Cursor, time: T) -> T {
        let mut made = T::zero();
        let mut power = T::of(1.0);
        for _ in 0..self.levels {
            power = power * time;
        }
        self.extend_drive(self.levels + 2, drive, cursor);
        for k in self.levels..self.levels + 2 {
            power = power * time;
            made = made.larger(self.inner.a[k].abs() * power / T::of((k + 1) as f64));
        }
        made
    }

    pub(super) fn at(&self, c: &[T; ROOM], s: T) -> T {
        c[..=self.order].iter().rev().fold(T::zero(), |sum, c| sum * s + *c)
    }

    /// Root of the depth at `s`.
    pub fn root_at(&self, s: T) -> T {
        self.at(&self.root, s)
    }

    /// Speed into the stop at `s`.
    pub fn speed_at(&self, s: T) -> T {
        self.at(&self.speed, s)
    }

    /// The coefficients of `c`, each times its power of `h`.
    pub(super) fn powers(&self, c: &[T; ROOM], h: T) -> [T; ROOM] {
        let mut scaled = [T::zero(); ROOM];
        let mut power = T::of(1.0);
        for (slot, c) in scaled.iter_mut().zip(&c[..=self.order]) {
            *slot = *c * power;
            power = power * h;
        }
        scaled
    }

    /// The share of a step of `h` at which the mass separates from the stop.
    pub fn separation(&self, h: T) -> Option<T> {
        let g = self.powers(&self.root, h);
        let n = self.order + 1;
        // At touch-down the root is 0 and rises: that 0 is divided out.
        let from = usize::from(g[0] == T::zero());
        if g[from] > T::zero() { PolynomialRoots::new(&g[from..n]).first() } else { Some(T::zero()) }
    }

    /// The share of a step of `h` at which the contact becomes clipped or ceases to be: 1 + a w changes its
    /// sign. `passed`: it is 0 by definition at the step's start.
    pub fn clip_change(&self, h: T, passed: bool) -> Option<T> {
        if !(self.stop.loss > T::zero()) {
            return None;
        }
        let n = self.order + 1;
        let mut g = self.powers(&self.speed, h);
        for c in &mut g[..n] {
            *c = *c * self.stop.loss;
            if self.clipped {
                *c = -*c;
            }
        }
        g[0] += if self.clipped { T::of(-1.0) } else { T::of(1.0) };
        let from = usize::from(passed);
        // On the wrong side it is there by rounding: the change was a mere touch, and the contact goes on as
        // it was.
        if g[from] > T::zero() { PolynomialRoots::new(&g[from..n]).first() } else { None }
    }

    /// How the polynomials satisfy the equation of motion at `s`.
    pub fn residual(&self, s: T, force: &PieceForce<T>, damping: T) -> Residual<T> {
        let (u, w, time) = (self.root_at(s), self.speed_at(s), self.at(&self.time, s));
        let mut slope = T::zero();
        for k in (1..=self.order).rev() {
            slope = slope * s + self.speed[k] * T::of(k as f64);
        }
        let base = self.inner.a[..self.levels].iter().rev().fold(T::zero(), |sum, c| sum * time + *c);
        let (f, _, rounding) = force.value(self.surface + self.sign * (u * u));
        let pushed = if self.clipped { T::zero() } else { self.stop.force(u, w) };
        let acceleration = -(damping * w + self.sign * (f + base) + pushed);
        let terms = (damping * w).abs() + f.abs() + base.abs() + pushed.abs();
        let size = slope.abs() + u.abs() * terms;
        Residual { error: slope - u * acceleration, size: size + u.abs() * rounding / T::of(T::EPSILON) }
    }
}

/// Fewest terms of the drive that are composed: those that are there from the start.
pub(crate) const FEWEST_LEVELS: usize = SEEDED;
