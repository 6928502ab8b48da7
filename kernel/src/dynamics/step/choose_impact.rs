//! Choice of a whole impact as one step, and the check that no other event happens in it.

use super::impact::{DRIVE_TERMS, FORCE_TERMS, Impact, Separation};
use super::penetration::neglected;
use super::settings::RESIDUAL;
use super::stepper::Stepper;
use crate::dynamics::drive::Drive;
use crate::dynamics::equation::End;
use crate::dynamics::series::SEEDED;
use crate::dynamics::state::{Contact, MotionState};
use crate::numeric::{Collocation, Scalar};

/// Tolerance of a step below which rounding dominates.
const MIN_TOLERANCE: f64 = 1e-14;

/// Difference between the binary digits of the tolerance and the number of points.
const FEWER_POINTS: f64 = 2.0;

impl<T: Scalar, D: Drive<T>> Stepper<'_, T, D> {
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
        self.drive.seed(&self.clock, &state.at, state.segment, &mut path.series.a, &mut self.cursor);
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
