//! One step of all lanes. It must stay equal to the bit with the two event-free steps of a single motion, see
//! `run/event_free.rs`.

use super::Columns;
use super::landing::Arrivals;
use crate::dynamics::drive::tone::Harmonic;
use crate::dynamics::lanes::trial::Trial;
use crate::dynamics::record::event_free::MARGIN;
use crate::dynamics::series::{Series, natural_steps, polynomial};
use crate::dynamics::step::chord::{CLEARANCE, Chord};
use crate::numeric::{GaussLegendre, Lanes, Number};

impl<const W: usize> Columns<W> {
    /// Computes one step in all lanes, and takes it in the lanes where it is event-free, up to a break if it
    /// meets one.
    #[inline(always)]
    pub fn step(
        &mut self,
        series: &mut Series<Lanes<W>>,
        rule: &GaussLegendre<Lanes<W>>,
        order: usize,
        tolerance_log2: f64,
        trial: &mut Trial<W>,
    ) {
        let swing = Harmonic { curvature: self.curvature };
        swing.seed(self.amplitude * self.value, self.amplitude * self.slope, &mut series.a);
        series.begin(self.x - self.origin, self.v);
        series.extend_to(order, &self.force, self.damping, &swing, &mut ());
        let y = &series.y[..=order];
        let length = natural_steps(order, |k| y[k].0, &self.speed_log2, tolerance_log2, &self.longest);
        let length = Lanes(length);
        let at = self.at.advance(&length, &self.period);
        let end = series.state(length);
        let unit = self.drive_at(&at);
        let base = self.amplitude * unit.0;
        let sum = (end.acceleration + self.damping * end.v) + base;
        let residual = (self.force.at(end.y) + sum).abs() * length;

        let (mut candidate, mut left) = ([false; W], length);
        for (lane, candidate) in candidate.iter_mut().enumerate() {
            let (length, period) = (length.0[lane], self.period.0[lane]);
            let cycles = self.border.cycle.0[lane] - self.at.cycle.0[lane];
            let to_border = cycles * period + (self.border.phase.0[lane] - self.at.phase.0[lane]);
            left.0[lane] = to_border - MARGIN * period;
            trial.holds[lane] = (residual.0[lane] <= self.allowed.0[lane]) & (length > 0.0);
            let early = (length < left.0[lane]) & (at.phase.0[lane] < period);
            let finite = end.v.0[lane].abs() < f64::INFINITY;
            *candidate = self.active[lane] & trial.holds[lane] & early & finite;
        }
        let (x, acceleration) = (end.y + self.origin, end.acceleration);
        let mut to = Arrivals { length, x, v: end.v, acceleration, at, unit };
        let landed = self.land(&candidate, y, &end.bound, &mut to);

        let mut squared = Lanes([0.0; W]);
        let deviations = polynomial::chord_deviations(y, to.length);
        if self.inside.contains(&true) {
            squared = polynomial::integrals::<_, false>(y, &[], rule, squared, to.length).0;
        }
        let (start, square) = (y[0] + self.origin, to.length * to.length);
        let (slopes, curvatures) = ((self.v * to.length, to.v * to.length), to.acceleration * square);
        let curvatures = ((y[2] + y[2]) * square, curvatures);
        let (mut event_free, mut turning, mut crosses) = ([false; W], [false; W], [false; W]);
        let (mut clear, mut unsure) = (([false; W], [false; W]), false);
        let (mut low, mut high) = (start, start);
        for lane in 0..W {
            let bound = end.bound.0[lane];
            let chord = Chord {
                start: start.0[lane],
                end: to.x.0[lane],
                bound,
                deviations: (deviations.0.0[lane], deviations.1.0[lane], deviations.2.0[lane]),
                slopes: (slopes.0.0[lane], slopes.1.0[lane]),
                curvatures: (curvatures.0.0[lane], curvatures.1.0[lane]),
                limits: (self.low_end.0[lane], self.high_end.0[lane]),
            };
            let (limits, touch, monotone) = (chord.limits, self.touch.0[lane], chord.is_monotone());
            let (clear_low, clear_high) = chord.is_clear();
            let clear_low = clear_low | (self.x.0[lane] - limits.0 > bound);
            let clear_high = clear_high | (limits.1 - self.x.0[lane] > bound);
            // leaving a surface: the speed leads further away than all other terms can lead back
            let leaves = 2.0 * self.v.0[lane].abs() * to.length.0[lane] > bound * CLEARANCE;
            let clear_low = clear_low | (leaves & (touch < 0.0));
            let clear_high = clear_high | (leaves & (touch > 0.0));
            let between = chord.stays_between((touch < 0.0, touch > 0.0));
            let (clear_low, clear_high) = (clear_low | between.0, clear_high | between.1);
            clear.0[lane] = clear_low | landed[lane];
            clear.1[lane] = clear_high | landed[lane];
            let (lane_low, lane_high, turns) = chord.extremes((self.low.0[lane], self.high.0[lane]));
            (low.0[lane], high.0[lane]) = (lane_low, lane_high);

            // Without a barrier every comparison with it is false, since it is NaN.
            let (barrier, side, inside) = (self.barrier.0[lane], self.side.0[lane], self.inside[lane]);
            let (from, beyond) = ((chord.start - barrier) * side, (chord.end - barrier) * side);
            let near = (chord.start - barrier).abs() <= bound;
            let (onto, passed) = (beyond == 0.0, beyond < 0.0);
            // outside the window only the number of crossings counts
            let countable = !inside & (to.length.0[lane] + to.length.0[lane] < left.0[lane]) & !landed[lane];
            let clear_of_barrier =
                !(near | passed | onto) | (monotone & (from > 0.0) & !onto & (!passed | countable));
            event_free[lane] = candidate[lane] & clear_of_barrier;
            turning[lane] = turns & inside;
            crosses[lane] = passed;
            unsure |= event_free[lane] & (turning[lane] | !(clear.0[lane] & clear.1[lane]));
        }
        if unsure {
            self.look_closer(y, &to, (&end.bound, &deviations.0), (&low, &high), &mut clear, &mut turning);
        }
        for lane in 0..W {
            event_free[lane] &= clear.0[lane] & clear.1[lane];
            turning[lane] &= event_free[lane];
        }
        if turning.contains(&true) {
            let turned = self.turn(&turning, y, &to, (slopes, curvatures, deviations), (&mut low, &mut high));
            for lane in 0..W {
                event_free[lane] &= !turning[lane] | turned[lane];
            }
        }
        for lane in 0..W {
            let (taken, inside, length) = (event_free[lane], self.inside[lane], to.length.0[lane]);
            trial.taken[lane] = taken;
            trial.stopped[lane] = !taken & self.active[lane];
            trial.passed[lane] = taken & landed[lane];
            trial.measured[lane] = inside & !landed[lane];

            let measured = taken & inside;
            let (squared, covered) =
                (self.squared.with(lane, squared.0[lane]), self.covered.with(lane, length));
            let set = |place: &mut f64, value: f64, which: bool| *place = if which { value } else { *place };
            set(&mut self.low.0[lane], low.0[lane], measured);
            set(&mut self.high.0[lane], high.0[lane], measured);
            set(&mut self.squared.sum.0[lane], squared.0, measured);
            set(&mut self.squared.carry.0[lane], squared.1, measured);
            set(&mut self.covered.sum.0[lane], covered.0, measured);
            set(&mut self.covered.carry.0[lane], covered.1, measured);
            let crosses = taken & crosses[lane];
            let side = self.side.0[lane];
            set(&mut self.side.0[lane], -side, crosses);
            self.crossings.0[lane] += if crosses { 1.0 } else { 0.0 };
            self.steps.0[lane] += if taken { 1.0 } else { 0.0 };
            self.passages.0[lane] += if trial.passed[lane] { 1.0 } else { 0.0 };
            set(&mut self.touch.0[lane], 0.0, taken);
            set(&mut self.x.0[lane], to.x.0[lane], taken);
            set(&mut self.v.0[lane], to.v.0[lane], taken);
            set(&mut self.at.cycle.0[lane], to.at.cycle.0[lane], taken);
            set(&mut self.at.phase.0[lane], to.at.phase.0[lane], taken);
            set(&mut self.value.0[lane], to.unit.0.0[lane], taken);
            set(&mut self.slope.0[lane], to.unit.1.0[lane], taken);
        }
        (trial.length, trial.end, trial.at, trial.unit, trial.squared) = (length, end, at, unit, squared);
    }
}
