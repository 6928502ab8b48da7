//! Evaluation of a step of contact: bounds, events, residual, position, integrals, loss, largest force.

use super::path::{InStop, Path};
use super::penetration::Penetration;
use crate::dynamics::equation::force::PieceForce;
use crate::dynamics::result::Phase;
use crate::dynamics::series::polynomial::{self, at_four_times};
use crate::dynamics::series::{ROOM, convolve};
use crate::numeric::{GaussLegendre, PolynomialRoots, Scalar};

#[derive(Debug, Clone, Copy)]
pub(crate) struct Changes<T> {
    pub root: T,
    pub speed: T,
    pub depth: T,
}

/// The state at a point of a step: root of the depth, inward speed and its slope, time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactState<T> {
    pub root: T,
    pub speed: T,
    pub slope: T,
    pub time: T,
}

impl<T: Scalar> Penetration<T> {
    /// Bounds, over a step of length `h`, of the changes of the depth's root, of the speed and of the depth.
    pub fn changes(&self, h: T) -> Changes<T> {
        let zero = T::zero();
        let (mut root, mut speed, mut depth, mut power) = (zero, zero, zero, T::of(1.0));
        for k in 1..=self.order {
            power = power * h;
            root += self.root[k].abs() * power;
            speed += self.speed[k].abs() * power;
            depth += self.depth[k].abs() * power;
        }
        Changes { root, speed, depth }
    }

    /// The fraction of a step of length `h` at which the mass separates from the stop.
    pub fn separation(&self, h: T, changes: &Changes<T>) -> Option<T> {
        let rise = self.root[1] * h;
        // at touch the root is 0 and rises
        if self.root[0] > changes.root || self.root[0] == T::zero() && rise + rise > changes.root {
            return None;
        }
        let g = self.powers(&self.root, h);
        let n = self.order + 1;
        // A root at the start is divided out.
        let from = usize::from(g[0] == T::zero());
        if g[from] > T::zero() { PolynomialRoots::new(&g[from..n]).first() } else { Some(T::zero()) }
    }

    /// The fraction of a step of length `h` at which clipping begins or ends: 1 + a w changes its sign.
    /// `passed`: it is 0 by definition at the start of the step.
    pub fn clip_change(&self, h: T, passed: bool, changes: &Changes<T>) -> Option<T> {
        let start = T::of(1.0) + self.stop.loss * self.speed[0];
        if !(self.stop.loss > T::zero()) || start.abs() > self.stop.loss * changes.speed {
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
        // A wrong sign comes from rounding: the change was a mere touch, and the contact continues as it was.
        if g[from] > T::zero() { PolynomialRoots::new(&g[from..n]).first() } else { None }
    }

    pub fn state(&self, s: T) -> ContactState<T> {
        let zero = T::zero();
        let (mut root, mut speed, mut slope, mut time) = (zero, zero, zero, zero);
        for k in (0..=self.order).rev() {
            slope = slope * s + speed;
            speed = speed * s + self.speed[k];
            root = root * s + self.root[k];
            time = time * s + self.time[k];
        }
        ContactState { root, speed, slope, time }
    }

    /// Residual of the equation of motion in this state: dw/ds of the polynomials minus that of the equation.
    pub fn residual(&self, at: &ContactState<T>, force: &PieceForce<T>, damping: T) -> T {
        let (f, base, pushed) = self.forces(at, force.at(self.displacement(at)));
        at.slope + at.root * (damping * at.speed + self.sign * (f + base) + pushed)
    }

    pub fn residual_rounding(&self, at: &ContactState<T>, force: &PieceForce<T>, damping: T) -> T {
        let (f, _, rounding) = force.value(self.displacement(at));
        let (f, base, pushed) = self.forces(at, f);
        let terms = (damping * at.speed).abs() + f.abs() + base.abs() + pushed.abs();
        let size = at.slope.abs() + at.root.abs() * terms;
        size * T::of(T::EPSILON) + at.root.abs() * rounding
    }

    fn displacement(&self, at: &ContactState<T>) -> T {
        self.surface + self.sign * (at.root * at.root)
    }

    /// Forces over mass in a state: of the mechanism (as given), of the base (by its series) and of the stop.
    fn forces(&self, at: &ContactState<T>, force: T) -> (T, T, T) {
        let levels = self.known_drive.min(self.terms.of_drive());
        let base = polynomial::value(&self.inner.a[..levels], at.time);
        let pushed = if self.clipped { T::zero() } else { self.stop.force(at.root, at.speed) };
        (force, base, pushed)
    }
}

impl<T: Scalar> InStop<T> for Penetration<T> {
    /// The loss of the stop or, while the contact is clipped, the stored energy that is not returned.
    fn loss(&self, rule: &GaussLegendre<T>, from: T, to: T) -> T {
        if self.clipped {
            return self.stop.stored(self.root_at(from)) - self.stop.stored(self.root_at(to));
        }
        let lost = polynomial::integral(rule, from, to, |s| {
            let (u, w) = (self.root_at(s), self.speed_at(s));
            let square = u * u;
            square * square * (w * w)
        });
        self.stop.stiffness * self.stop.loss * lost
    }

    fn peak(&self, h: T, until: T, known: T) -> T {
        if self.clipped {
            return known;
        }
        let n = self.order + 1;
        let changes = self.changes(h);
        let (root, speed) = (self.root[0] + changes.root, self.speed[0].abs() + changes.speed);
        if !(self.stop.force(root, speed) > known) {
            return known;
        }
        // Force over stiffness: u^3 (1 + a w).
        let (mut cube, mut push) = ([T::zero(); ROOM], [T::zero(); ROOM]);
        for k in 0..n {
            cube[k] = convolve(&self.root, &self.depth, k);
            push[k] = cube[k] + self.stop.loss * convolve(&cube, &self.speed, k);
        }
        let scaled = self.powers(&push, h);
        let value = |s: T| polynomial::value(&scaled[..n], s);
        let mut peak = value(T::zero()).larger(value(until));
        let slope = polynomial::derivative(&scaled[..n]);
        PolynomialRoots::new(&slope[..n - 1]).each_sign_change(&mut |s| {
            if s < until {
                peak = peak.larger(value(s));
            }
            s < until
        });
        known.larger(self.stop.stiffness * peak)
    }
}

impl<T: Scalar> Path<T> for Penetration<T> {
    const IN_CONTACT: bool = true;

    fn phase(&self) -> Phase {
        if self.sign < T::zero() { Phase::LeftStop } else { Phase::RightStop }
    }
    fn known(&self) -> usize {
        self.order + 1
    }
    fn start(&self) -> T {
        self.inner.y[0]
    }
    fn scaled(&self, h: T) -> [T; ROOM] {
        self.powers(&self.inner.y, h)
    }
    fn position(&self, parameter: T) -> T {
        let u = self.root_at(parameter);
        self.surface + self.sign * (u * u)
    }
    fn velocity(&self, parameter: T) -> T {
        self.sign * self.speed_at(parameter)
    }
    fn time(&self, parameter: T) -> T {
        self.at(&self.time, parameter)
    }
    /// Time increases along a step of contact, but its slope is 0 at touch and separation, so it can be
    /// inverted there only to half the digits; the mass moves correspondingly little.
    fn parameter(&self, time: T, length: T) -> T {
        if !(time > T::zero()) {
            return T::zero();
        }
        let mut g = self.powers(&self.time, length);
        for c in &mut g[..=self.order] {
            *c = -*c;
        }
        g[0] = time;
        PolynomialRoots::new(&g[..=self.order]).first().map_or(length, |share| share * length)
    }
    fn integrals<const WORK: bool>(&self, rule: &GaussLegendre<T>, from: T, to: T) -> (T, T) {
        let length = to - from;
        let (mut squared, mut power) = (T::zero(), T::zero());
        let (nodes, weights) = (rule.nodes(), rule.weights());
        let mut add = |root: T, speed: T, base: T, weight: T| {
            let travelled = root * speed * weight;
            squared += travelled * speed;
            power += travelled * (self.sign * base);
        };
        // Four at a time, as in free flight.
        let mut groups = nodes.chunks_exact(4).zip(weights.chunks_exact(4));
        for (nodes, weights) in &mut groups {
            let time = |i: usize| from + length * nodes[i];
            let times = (time(0), time(1), time(2), time(3));
            let at = |c: &[T]| at_four_times(c.len(), |k| c[k], 0, times);
            let (u, w) = (at(&self.root[..=self.order]), at(&self.speed[..=self.order]));
            let zero = T::zero();
            let base = if WORK { at(&self.base[..self.order]) } else { (zero, zero, zero, zero) };
            add(u.0, w.0, base.0, weights[0]);
            add(u.1, w.1, base.1, weights[1]);
            add(u.2, w.2, base.2, weights[2]);
            add(u.3, w.3, base.3, weights[3]);
        }
        let done = nodes.len() / 4 * 4;
        for (node, weight) in nodes[done..].iter().zip(&weights[done..]) {
            let s = from + length * *node;
            let base = if WORK { polynomial::value(&self.base[..self.order], s) } else { T::zero() };
            add(self.root_at(s), self.speed_at(s), base, *weight);
        }
        (squared * length, power * length)
    }
    fn moment(&self, rule: &GaussLegendre<T>, from: T, to: T) -> T {
        polynomial::integral(rule, from, to, |s| self.position(s) * self.root_at(s))
    }
}
