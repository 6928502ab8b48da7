//! Columns of a batch: what the lanes hold, and one event-free step of all of them.
//!
//! The event-free step is written three times: here, as the general step of a motion alone (`step/choose.rs`
//! with `run/flight.rs`), and as its fast path (`run/event_free.rs`). The three do the same arithmetic and
//! must stay equal to the bit.

mod landing;

use super::trial::{Clocks, CompensatedSums, Trial};
use crate::dynamics::drive::tone::{Harmonic, Sine};
use crate::dynamics::equation::force::PieceForce;
use crate::dynamics::equation::{End, EndKind, Mode};
use crate::dynamics::motion::Motion;
use crate::dynamics::record::event_free::MARGIN;
use crate::dynamics::series::{Series, natural_steps, polynomial};
use crate::dynamics::state::{BY_SPEED, Touch};
use crate::dynamics::step::chord::{CLEARANCE, Chord};
use crate::dynamics::step::work::ARRIVAL;
use crate::numeric::{GaussLegendre, Lanes, Number, Scalar};
use landing::Arrivals;

/// A share of the way that rounding is far below.
const ROUNDING: f64 = 1e-9;

/// One motion under a sine, without a ledger.
pub(super) type LaneMotion<'a> = Motion<'a, f64, Sine<f64>, false>;

/// The lanes, in columns.
pub(crate) struct Columns<const W: usize> {
    /// Which lanes are active.
    pub active: [bool; W],
    /// Steps taken, breaks passed and crossings of the barrier since a lane was loaded.
    steps: Lanes<W>,
    passages: Lanes<W>,
    crossings: Lanes<W>,
    // constant while a lane is in one mode of one run
    /// Which run and which mode that is.
    of: [(usize, usize); W],
    force: PieceForce<Lanes<W>>,
    origin: Lanes<W>,
    low_end: Lanes<W>,
    high_end: Lanes<W>,
    /// The same where they are breaks; else infinitely far away.
    low_break: Lanes<W>,
    high_break: Lanes<W>,
    damping: Lanes<W>,
    curvature: Lanes<W>,
    amplitude: Lanes<W>,
    frequency: Lanes<W>,
    turn: Lanes<W>,
    quarter: [bool; W],
    speed_log2: [f64; W],
    longest: [f64; W],
    allowed: Lanes<W>,
    period: Lanes<W>,
    // constant over event-free steps
    /// The barrier that crossings are counted at, NaN without one, and the side of it.
    barrier: Lanes<W>,
    side: Lanes<W>,
    border: Clocks<W>,
    /// Whether each step is logged, in case the motion recurs.
    pub logged: [bool; W],
    /// Whether the time up to there lies in the settled window.
    pub inside: [bool; W],
    // what changes with each step
    /// -1 or 1 on the low or high end of the mode, leaving it by its speed; else 0.
    touch: Lanes<W>,
    x: Lanes<W>,
    v: Lanes<W>,
    at: Clocks<W>,
    /// The drive and its time derivative per unit amplitude.
    value: Lanes<W>,
    slope: Lanes<W>,
    low: Lanes<W>,
    high: Lanes<W>,
    squared: CompensatedSums<W>,
    covered: CompensatedSums<W>,
}

impl<const W: usize> Columns<W> {
    /// For forces of the shape that this one has.
    pub fn new(force: &PieceForce<f64>) -> Self {
        let zero = Lanes([0.0; W]);
        let clocks = Clocks { cycle: zero, phase: zero };
        let sums = CompensatedSums { sum: zero, carry: zero };
        Self {
            active: [false; W],
            steps: zero,
            passages: zero,
            crossings: zero,
            of: [(usize::MAX, 0); W],
            force: PieceForce::new(vec![zero; force.coefficients().len()]),
            origin: zero,
            low_end: zero,
            high_end: zero,
            low_break: zero,
            high_break: zero,
            damping: zero,
            curvature: zero,
            amplitude: zero,
            frequency: zero,
            turn: zero,
            quarter: [false; W],
            speed_log2: [0.0; W],
            longest: [1.0; W],
            allowed: zero,
            period: Lanes([1.0; W]),
            barrier: zero,
            side: zero,
            border: clocks,
            logged: [false; W],
            inside: [false; W],
            touch: zero,
            x: zero,
            v: zero,
            at: clocks,
            value: zero,
            slope: zero,
            low: zero,
            high: zero,
            squared: sums,
            covered: sums,
        }
    }

    /// Whether a force has the shape of those of the lanes.
    pub fn takes(&self, force: &PieceForce<f64>) -> bool {
        self.force.degree() == force.degree()
    }

    /// Loads a motion, whose force has the lanes' shape, into a lane, as number `index` of the runs.
    pub fn load(&mut self, lane: usize, index: usize, motion: &LaneMotion) {
        let chord = motion.record.begin_event_free(&motion.state.at, &motion.stepper.end);
        if self.of[lane] != (index, motion.state.mode) {
            self.load_mode(lane, motion.state.mode, motion.stepper.mode(&motion.state));
            self.of[lane].0 = index;
            let (tone, settings) = (&motion.stepper.drive.tone, &motion.stepper.settings);
            self.damping.0[lane] = motion.stepper.equation.damping;
            self.curvature.0[lane] = tone.curvature();
            self.amplitude.0[lane] = tone.amplitude;
            self.frequency.0[lane] = tone.frequency;
            self.turn.0[lane] = tone.phase;
            self.quarter[lane] = tone.quarter;
            self.speed_log2[lane] = settings.speed_log2;
            self.longest[lane] = settings.longest;
            self.allowed.0[lane] = settings.residual_of_a_full_step();
            self.period.0[lane] = motion.stepper.clock.period();
        }
        self.barrier.0[lane] = chord.barrier.unwrap_or(f64::NAN);
        self.side.0[lane] = f64::from(chord.side);
        self.border.set(lane, &chord.border);
        self.logged[lane] = motion.log.is_some();
        self.inside[lane] = chord.inside;
        (self.low.0[lane], self.high.0[lane]) = (chord.low, chord.high);
        self.squared.set(lane, &chord.squared);
        self.covered.set(lane, &chord.covered);
        self.touch.0[lane] = motion.state.touch.map_or(0.0, |touch| touch.end.sign());
        (self.x.0[lane], self.v.0[lane]) = (motion.state.x, motion.state.v);
        self.at.set(lane, &motion.state.at);
        (self.value.0[lane], self.slope.0[lane]) =
            motion.stepper.drive.unit_from(&motion.state.at, &motion.stepper.cursor);
        self.steps.0[lane] = 0.0;
        self.passages.0[lane] = 0.0;
        self.crossings.0[lane] = 0.0;
        self.active[lane] = true;
    }

    /// Loads a mode, whose force has the lanes' shape, into a lane, as number `index` of its equation.
    fn load_mode(&mut self, lane: usize, index: usize, mode: &Mode<f64>) {
        self.of[lane].1 = index;
        for (degree, own) in mode.force.coefficients().iter().enumerate() {
            self.force.coefficient_mut(degree).0[lane] = *own;
        }
        let at_break = |end: End| match mode.end(end) {
            (level, EndKind::Break) => level,
            _ => end.sign::<f64>() * f64::INFINITY,
        };
        self.origin.0[lane] = mode.origin;
        (self.low_end.0[lane], self.high_end.0[lane]) = (mode.low, mode.high);
        (self.low_break.0[lane], self.high_break.0[lane]) = (at_break(End::Low), at_break(End::High));
    }

    /// The end at which a lane, which stands on a break, leaves its mode.
    pub fn exit(&self, lane: usize) -> End {
        if self.v.0[lane] > 0.0 { End::High } else { End::Low }
    }

    /// Lets a lane, which stands on a break, enter the neighbouring mode; false where the force has another
    /// shape there.
    pub fn enter_neighbour(&mut self, lane: usize, modes: &[Mode<f64>]) -> bool {
        let exit = self.exit(lane);
        let index = match exit {
            End::Low => self.of[lane].1 - 1,
            End::High => self.of[lane].1 + 1,
        };
        if !self.takes(&modes[index].force) {
            return false;
        }
        self.load_mode(lane, index, &modes[index]);
        self.touch.0[lane] = exit.other().sign();
        true
    }

    /// Copies the state of a lane to its motion, whose last step is to be logged.
    pub fn copy_state(&self, lane: usize, motion: &mut LaneMotion) {
        (motion.state.x, motion.state.v) = (self.x.0[lane], self.v.0[lane]);
        motion.state.at = self.at.get(lane);
        motion.state.turned_back = false;
        motion.state.touch = None;
        motion.record.barrier_side = self.side.0[lane] as i8;
    }

    /// Stores a lane back to its motion.
    pub fn store(&mut self, lane: usize, motion: &mut LaneMotion) {
        self.active[lane] = false;
        let steps = self.steps.0[lane] as u64;
        if steps == 0 {
            return;
        }
        motion.steps += steps;
        let passages = self.passages.0[lane] as u64;
        motion.stepper.work.add(steps * motion.stepper.costs.step + passages * ARRIVAL);
        motion.stepper.evaluations += steps;
        (motion.state.x, motion.state.v) = (self.x.0[lane], self.v.0[lane]);
        motion.state.at = self.at.get(lane);
        motion.stepper.cursor = Some((motion.state.at, (self.value.0[lane], self.slope.0[lane])));
        motion.state.turned_back = false;
        motion.state.mode = self.of[lane].1;
        let touched = |end: End| Touch { end, multiplicity: BY_SPEED };
        let ends = [End::Low, End::High].into_iter();
        motion.state.touch = ends.map(touched).find(|own| own.end.sign::<f64>() == self.touch.0[lane]);
        motion.record.end_event_free(
            (self.low.0[lane], self.high.0[lane]),
            self.squared.get(lane),
            self.covered.get(lane),
        );
        motion.record.end_event_free_crossings(self.side.0[lane] as i8, self.crossings.0[lane] as u64);
    }

    /// Computes one step in all lanes and takes it where it is event-free, up to a break where it meets one.
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

        let (mut may, mut left) = ([false; W], length);
        for lane in 0..W {
            let (length, period) = (length.0[lane], self.period.0[lane]);
            let cycles = self.border.cycle.0[lane] - self.at.cycle.0[lane];
            let to_border = cycles * period + (self.border.phase.0[lane] - self.at.phase.0[lane]);
            left.0[lane] = to_border - MARGIN * period;
            trial.holds[lane] = (residual.0[lane] <= self.allowed.0[lane]) & (length > 0.0);
            let early = (length < left.0[lane]) & (at.phase.0[lane] < period);
            let finite = end.v.0[lane].abs() < f64::INFINITY;
            may[lane] = self.active[lane] & trial.holds[lane] & early & finite;
        }
        let (x, acceleration) = (end.y + self.origin, end.acceleration);
        let mut to = Arrivals { length, x, v: end.v, acceleration, at, unit };
        let landed = self.land(&may, y, &end.bound, &mut to);

        let mut squared = Lanes([0.0; W]);
        let deviations = polynomial::chord_deviations(y, to.length);
        if self.inside.contains(&true) {
            squared = polynomial::integrals::<_, false>(y, &[], rule, squared, to.length).0;
        }
        let (start, square) = (y[0] + self.origin, to.length * to.length);
        let (ways, bends) = ((self.v * to.length, to.v * to.length), to.acceleration * square);
        let bends = ((y[2] + y[2]) * square, bends);
        let (mut fine, mut turning, mut crosses) = ([false; W], [false; W], [false; W]);
        let (mut low, mut high) = (start, start);
        for lane in 0..W {
            let bound = end.bound.0[lane];
            let chord = Chord {
                start: start.0[lane],
                end: to.x.0[lane],
                bound,
                deviations: (deviations.0.0[lane], deviations.1.0[lane], deviations.2.0[lane]),
                ways: (ways.0.0[lane], ways.1.0[lane]),
                bends: (bends.0.0[lane], bends.1.0[lane]),
                limits: (self.low_end.0[lane], self.high_end.0[lane]),
            };
            let (limits, touch, monotone) = (chord.limits, self.touch.0[lane], chord.is_monotone());
            let (clear_low, clear_high) = chord.is_clear();
            let clear_low = clear_low | (self.x.0[lane] - limits.0 > bound);
            let clear_high = clear_high | (limits.1 - self.x.0[lane] > bound);
            // from a surface: its own speed leads further away than all the rest can lead back
            let leaves = 2.0 * self.v.0[lane].abs() * to.length.0[lane] > bound * CLEARANCE;
            let clear_low = clear_low | (leaves & (touch < 0.0));
            let clear_high = clear_high | (leaves & (touch > 0.0));
            // between the ends, where the lowest or the highest place is one of them
            let margin = bound * ROUNDING;
            let above = (chord.end - limits.0 > margin) & ((chord.start > limits.0) | (touch < 0.0));
            let below = (limits.1 - chord.end > margin) & ((chord.start < limits.1) | (touch > 0.0));
            let bends = chord.bends_one_way();
            let clear_low = clear_low | (above & (monotone | (bends & (chord.bends.0 < 0.0))));
            let clear_high = clear_high | (below & (monotone | (bends & (chord.bends.0 > 0.0))));
            let clear = (clear_low & clear_high) | landed[lane];
            let (own_low, own_high, turns) = chord.extremes((self.low.0[lane], self.high.0[lane]));
            (low.0[lane], high.0[lane]) = (own_low, own_high);

            // Without a barrier every comparison with it is false, since it is NaN.
            let (barrier, side, inside) = (self.barrier.0[lane], self.side.0[lane], self.inside[lane]);
            let (from, beyond) = ((chord.start - barrier) * side, (chord.end - barrier) * side);
            let near = (chord.start - barrier).abs() <= bound;
            let (onto, passed) = (beyond == 0.0, beyond < 0.0);
            // outside the window only their number counts
            let countable = !inside & (to.length.0[lane] + to.length.0[lane] < left.0[lane]) & !landed[lane];
            let clear_of_barrier =
                !(near | passed | onto) | (monotone & (from > 0.0) & !onto & (!passed | countable));
            fine[lane] = may[lane] & clear & clear_of_barrier;
            turning[lane] = fine[lane] & turns & inside;
            crosses[lane] = passed;
        }
        if turning.contains(&true) {
            let turned = self.turn(&turning, y, &to, (ways, bends, deviations), (&mut low, &mut high));
            for lane in 0..W {
                fine[lane] = fine[lane] & (!turning[lane] | turned[lane]);
            }
        }
        for lane in 0..W {
            let (taken, inside, length) = (fine[lane], self.inside[lane], to.length.0[lane]);
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

    /// The drive and its time derivative per unit amplitude.
    #[inline(always)]
    fn drive_at(&self, at: &Clocks<W>) -> (Lanes<W>, Lanes<W>) {
        let (mut value, mut slope) = (at.phase, at.phase);
        for lane in 0..W {
            let turns = at.phase.0[lane] * self.frequency.0[lane] + self.turn.0[lane];
            let (s, c) = f64::sin_cos_turns(turns);
            let omega = f64::tau() * self.frequency.0[lane];
            value.0[lane] = if self.quarter[lane] { c } else { s };
            slope.0[lane] = if self.quarter[lane] { -(s * omega) } else { c * omega };
        }
        (value, slope)
    }
}
