//! Choice of a step of quasi-static motion: whether the mass rings, and how long the series holds.

use super::quasi_static::QuasiStatic;
use super::stepper::{RESIDUAL, Stepper};
use crate::dynamics::clock::Instant;
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::{Compliant, End, Mode};
use crate::dynamics::series::{MAX_ORDER, SEEDED, natural_steps, polynomial};
use crate::dynamics::state::{Contact, MotionState};
use crate::numeric::{Scalar, elementary, fast_log2};

/// Sweeps after which the iteration has converged at a coarse tolerance: each reduces the error to a
/// thousandth or less if the step is long enough to be useful. Each costs two orders, those of d''.
const FEW_SWEEPS: usize = 3;
/// The same at a fine tolerance.
const MORE_SWEEPS: usize = 5;

/// Tolerance of a step above which few sweeps are enough.
const COARSE: f64 = 1e-9;

/// Speed of ringing that may be neglected, in tolerances of a step.
const MAX_RINGING: f64 = 1.0;

/// Tolerance of a step below which rounding sustains the ringing.
const MIN_TOLERANCE: f64 = 1e-13;

/// Minimum length of a useful step, in radians of the ringing.
const MIN_RADIANS: f64 = 12.0;

/// Maximum number of halvings of a step before it is given up.
const MAX_HALVINGS: usize = 4;

/// Relative error that the first term of the quasi-static speed may have.
const FIRST_TERM: f64 = 2e-3;

/// The same if the stiffness of the mechanism is left out.
const FIRST_TERM_ROUGH: f64 = 0.1;

/// A quasi-static step that has been chosen.
pub(crate) struct QuasiStaticStep<T> {
    pub length: T,
    pub arrival: Option<Instant<T>>,
    /// Root of the depth and inward speed at its end.
    pub end: (T, T),
    pub bound: T,
}

/// A mass on a stop that does not ring, according to the first term of its quasi-static motion.
struct Calm<'a, T> {
    stop: Compliant<T>,
    mode: &'a Mode<T>,
    /// Displacement of the surface of the stop from the origin of the mode.
    surface: T,
    /// Angular frequency of the ringing, and the speed of ringing that may be neglected.
    ring_frequency: T,
    max_ring_speed: T,
    /// Speed and tolerance of a step of contact.
    scale: T,
    tolerance: f64,
}

impl<'a, T: Scalar, D: Drive<T>> Stepper<'a, T, D> {
    /// A step of quasi-static motion; `None` if the mass rings beyond the tolerance or the load changes too
    /// fast.
    pub fn quasi_static_step(
        &mut self,
        state: &MotionState<T>,
        end: End,
        left: T,
        path: &mut QuasiStatic<T>,
    ) -> Option<QuasiStaticStep<T>> {
        let calm = self.calm(state, end, path)?;
        let order = self.solve_quasi_static(state, &calm, path)?;
        self.fit_quasi_static(state, (end, left), &calm, order, path)
    }

    /// `None` if the mass rings: the first term of its quasi-static motion shows whether the series is worth
    /// computing.
    fn calm(&mut self, state: &MotionState<T>, end: End, path: &mut QuasiStatic<T>) -> Option<Calm<'a, T>> {
        let (root, sign) = (state.depth.root, end.sign::<T>());
        let (speed, damping, mode) = (sign * state.v, self.equation.damping, self.mode(state));
        let stop = self.equation.compliant?;
        let (scale, tolerance) = self.contact_tolerance(state)?;
        let max_ring_speed = T::of(MAX_RINGING * self.settings.tolerance) * scale;
        let compressing = matches!(state.contact, Contact::Compressing(_)) && root > T::zero();
        if !compressing || self.settings.tolerance < MIN_TOLERANCE {
            return None;
        }
        let a = &mut path.series.a;
        self.drive.seed(&state.at, state.segment, a, &mut self.cursor);
        let (jerk, snap) = (-(sign * a[1]), a[2].abs() * T::of(2.0));
        let stiffness = T::of(1.5) * stop.stiffness * root;
        if !((speed * stiffness - jerk).abs()
            <= max_ring_speed * stiffness + jerk.abs() * T::of(FIRST_TERM_ROUGH))
        {
            return None;
        }
        let surface = self.equation.surface(end)? - mode.origin;
        let (force, slope, _) = mode.force.value(surface + sign * (root * root));
        let ring_frequency_squared = stiffness + slope;
        if !(ring_frequency_squared > T::zero()) {
            return None;
        }
        let ring_frequency = ring_frequency_squared.sqrt();
        let first = jerk / ring_frequency_squared;
        if !((speed - first).abs() <= max_ring_speed + first.abs() * T::of(FIRST_TERM)) {
            return None;
        }
        let acceleration = -(sign * (force + a[0])) - damping * speed - stop.force(root, speed);
        let slow = snap / ring_frequency_squared + first * first / (root * root);
        if !(acceleration.abs() <= ring_frequency * max_ring_speed + slow + slow) {
            return None;
        }
        (path.stop, path.sign) = (stop, sign);
        Some(Calm { stop, mode, surface, ring_frequency, max_ring_speed, scale, tolerance })
    }

    /// Solves for the series of the quasi-static motion and returns its order; `None` if the mass does not
    /// follow it. Two terms show whether it does; all are needed for the step.
    fn solve_quasi_static(
        &mut self,
        state: &MotionState<T>,
        calm: &Calm<T>,
        path: &mut QuasiStatic<T>,
    ) -> Option<usize> {
        let &Calm { mode, surface, ring_frequency, max_ring_speed, .. } = calm;
        let (root, speed, damping) = (state.depth.root, path.sign * state.v, self.equation.damping);
        let sweeps = if self.settings.tolerance > COARSE { FEW_SWEEPS } else { MORE_SWEEPS };
        let order = (self.settings.order + 1).min(MAX_ORDER - 2 * sweeps);
        mode.force.about(surface, &mut path.about);
        path.about.resize(path.about.len().max(3), T::zero());
        let few = 1 + 2 * sweeps;
        for k in SEEDED..=few {
            path.series.extend_drive(k, self.drive, &mut self.cursor);
        }
        path.solve(root, (1, sweeps), surface, damping);
        let (start, start_speed) = (path.depth[0], path.depth[1]);
        let off = (speed - start_speed).abs().larger(ring_frequency * (root * root - start).abs());
        if !(off <= max_ring_speed) {
            return None;
        }
        for k in few + 1..=order + 2 * sweeps {
            path.series.extend_drive(k, self.drive, &mut self.cursor);
        }
        path.solve(root, (order, sweeps), surface, damping);
        self.evaluations += 1;
        self.work.add(self.costs.contact);
        Some(order)
    }

    /// The longest step for which the series is accurate enough, by halving; `None` if no useful step is.
    fn fit_quasi_static(
        &self,
        state: &MotionState<T>,
        (end, left): (End, T),
        calm: &Calm<T>,
        order: usize,
        path: &QuasiStatic<T>,
    ) -> Option<QuasiStaticStep<T>> {
        let &Calm { stop, mode, surface, ring_frequency, scale, tolerance, .. } = calm;
        let [natural] = natural_steps(
            order,
            |k| [path.depth[k].magnitude()],
            &[fast_log2(scale.to_f64())],
            elementary::log2(tolerance),
            &[self.settings.longest],
        );
        let mut length = T::of(natural);
        for _ in 0..MAX_HALVINGS {
            let arrival = self.arrival(state, left, &mut length);
            if !(length * ring_frequency > T::of(MIN_RADIANS)) {
                return None;
            }
            let (mut bound, mut fastest, mut power) = (T::zero(), T::zero(), T::of(1.0));
            for k in 1..=order {
                fastest += path.depth[k].abs() * T::whole(k) * power;
                power = power * length;
                bound += path.depth[k].abs() * power;
            }
            let deep = [End::Low, End::High]
                .into_iter()
                .all(|at| at == end.other() || at.sign::<T>() * (mode.end(at).0 - state.x) > bound + bound);
            let half = length * T::of(0.5);
            let mut residual = T::zero();
            for t in [T::zero(), half, length] {
                let off = path.residual(t, surface, &mode.force, self.equation.damping);
                residual = residual.larger(off.abs());
            }
            let allowed = T::of(RESIDUAL * order as f64 * tolerance) * scale;
            let clear = deep && bound < path.depth[0] && stop.loss * fastest < T::of(1.0);
            if clear && residual * length <= allowed {
                let depth = polynomial::value(&path.depth[..=order], length);
                let speed = polynomial::slope(&path.depth[..=order], length);
                return Some(QuasiStaticStep { length, arrival, end: (depth.sqrt(), speed), bound });
            }
            length = half;
        }
        None
    }
}
