//! Reading of a step of contact: position, integrals, dissipation, largest force.

use super::path::{InStop, Path};
use super::penetration::Penetration;
use crate::dynamics::result::Phase;
use crate::dynamics::series::{ROOM, convolve};
use crate::numeric::{GaussLegendre, PolynomialRoots, Scalar};

impl<T: Scalar> InStop<T> for Penetration<T> {
    /// By its loss, or, where it is clipped, what it had stored.
    fn loss(&self, rule: &GaussLegendre<T>, from: T, to: T) -> T {
        if self.clipped {
            return self.stop.stored(self.root_at(from)) - self.stop.stored(self.root_at(to));
        }
        let length = to - from;
        let mut sum = T::zero();
        for (node, weight) in rule.nodes().iter().zip(rule.weights()) {
            let s = from + length * *node;
            let (u, w) = (self.root_at(s), self.speed_at(s));
            let square = u * u;
            sum += square * square * (w * w) * *weight;
        }
        self.stop.stiffness * self.stop.loss * (sum * length)
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
        let value = |s: T| scaled[..n].iter().rev().fold(T::zero(), |sum, c| sum * s + *c);
        let mut peak = value(T::zero()).larger(value(until));
        let mut slope = [T::zero(); ROOM];
        for k in 1..n {
            slope[k - 1] = scaled[k] * T::of(k as f64);
        }
        // The force of a touch-down rises like the cube of the parameter; its first slope that is not 0
        // decides.
        let first = slope[..n - 1].iter().position(|c| *c != T::zero());
        if let Some(first) = first {
            let slope = &mut slope[first..n - 1];
            if slope[0] < T::zero() {
                slope.iter_mut().for_each(|c| *c = -*c);
            }
            PolynomialRoots::new(slope).each_sign_change(|s| {
                if s < until {
                    peak = peak.larger(value(s));
                }
                s < until
            });
        }
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
    /// Time grows along a step of contact, but ceases to at its ends, where it can be inverted to half the
    /// digits; the mass moves as little there.
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
        for (node, weight) in rule.nodes().iter().zip(rule.weights()) {
            let s = from + length * *node;
            let (u, w) = (self.root_at(s), self.speed_at(s));
            let travelled = u * w * *weight;
            squared += travelled * w;
            if WORK {
                let base = self.base[..self.order].iter().rev().fold(T::zero(), |sum, c| sum * s + *c);
                power += travelled * (self.sign * base);
            }
        }
        (squared * length, power * length)
    }
    fn moment(&self, rule: &GaussLegendre<T>, from: T, to: T) -> T {
        let length = to - from;
        let parts = rule.nodes().iter().zip(rule.weights());
        let moment = parts.fold(T::zero(), |sum, (node, weight)| {
            let s = from + length * *node;
            sum + self.position(s) * self.root_at(s) * *weight
        });
        moment * length
    }
}
