//! Columns of a batch: what the lanes hold, and one event-free step of all of them.
//!
//! The event-free step is written three times: here, as the general step of a motion alone (`step/choose.rs`
//! with `run/flight.rs`), and as its fast path (`run/event_free.rs`). The three do the same arithmetic and
//! must stay equal to the bit.

use crate::dynamics::clock::Instant;
use crate::dynamics::drive::tone::{Harmonic, Sine};
use crate::dynamics::equation::force::PieceForce;
use crate::dynamics::motion::Motion;
use crate::dynamics::record::event_free::MARGIN;
use crate::dynamics::series::{Endpoint, Series, natural_steps, polynomial};
use crate::dynamics::step::chord::{CLEARANCE, Chord};
use crate::numeric::{CompensatedSum, GaussLegendre, Lanes, Number, Scalar};

/// One motion under a sine, without a ledger.
pub(super) type LaneMotion<'a> = Motion<'a, f64, Sine<f64>, false>;

/// The lanes, in columns.
pub(crate) struct Columns<const W: usize> {
    /// Which lanes are active.
    pub active: [bool; W],
    /// Steps taken and crossings of the barrier since a lane was loaded.
    steps: Lanes<W>,
    crossings: Lanes<W>,
    // constant while a lane is in one mode of one run
    /// Which run and which mode that is.
    of: [(usize, usize); W],
    force: PieceForce<Lanes<W>>,
    origin: Lanes<W>,
    low_end: Lanes<W>,
    high_end: Lanes<W>,
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

/// Instants; the cycles are whole numbers below 2^53.
#[derive(Clone, Copy)]
struct Clocks<const W: usize> {
    cycle: Lanes<W>,
    phase: Lanes<W>,
}

impl<const W: usize> Clocks<W> {
    fn set(&mut self, lane: usize, at: &Instant<f64>) {
        (self.cycle.0[lane], self.phase.0[lane]) = (at.cycle as f64, at.phase);
    }

    fn get(&self, lane: usize) -> Instant<f64> {
        Instant { cycle: self.cycle.0[lane] as i64, phase: self.phase.0[lane] }
    }

    /// As [`Clock::advance`](crate::dynamics::clock::Clock::advance) by up to a cycle; of more the phase lies
    /// beyond the cycle.
    #[inline(always)]
    fn advance(&self, by: &Lanes<W>, period: &Lanes<W>) -> Self {
        let mut later = *self;
        for lane in 0..W {
            let (period, phase) = (period.0[lane], self.phase.0[lane] + by.0[lane]);
            let whole = if phase >= period { 1.0 } else { 0.0 };
            later.phase.0[lane] = phase - whole * period;
            later.cycle.0[lane] = self.cycle.0[lane] + whole;
        }
        later
    }
}

/// Sums with compensation.
#[derive(Clone, Copy)]
struct CompensatedSums<const W: usize> {
    sum: Lanes<W>,
    carry: Lanes<W>,
}

impl<const W: usize> CompensatedSums<W> {
    fn set(&mut self, lane: usize, sum: &CompensatedSum<f64>) {
        (self.sum.0[lane], self.carry.0[lane]) = sum.parts();
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> CompensatedSum<f64> {
        CompensatedSum::of_parts(self.sum.0[lane], self.carry.0[lane])
    }

    /// What a sum becomes with one more term.
    #[inline(always)]
    fn with(&self, lane: usize, term: f64) -> (f64, f64) {
        let mut own = self.get(lane);
        own.add(term);
        own.parts()
    }
}

/// A step computed in all lanes.
pub(crate) struct Trial<const W: usize> {
    /// Active lanes that did not take it, since an event is possible on it.
    pub stopped: [bool; W],
    /// Those that took it.
    pub taken: [bool; W],
    /// Whether the polynomial satisfies the equation at the step's end.
    pub holds: [bool; W],
    pub length: Lanes<W>,
    end: Endpoint<Lanes<W>>,
    at: Clocks<W>,
    value: Lanes<W>,
    slope: Lanes<W>,
    /// Integral of the squared velocity, where any lane is in the settled window.
    pub squared: Lanes<W>,
}

impl<const W: usize> Trial<W> {
    /// Where the polynomial of a lane leads.
    pub fn end(&self, lane: usize) -> Endpoint<f64> {
        let Endpoint { y, v, acceleration, bound } = &self.end;
        Endpoint { y: y.0[lane], v: v.0[lane], acceleration: acceleration.0[lane], bound: bound.0[lane] }
    }

    /// When the step of a lane ends, and the drive and its time derivative there.
    pub fn drive_at_end(&self, lane: usize) -> (Instant<f64>, (f64, f64)) {
        (self.at.get(lane), (self.value.0[lane], self.slope.0[lane]))
    }
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
            crossings: zero,
            of: [(usize::MAX, 0); W],
            force: PieceForce::new(vec![zero; force.coefficients().len()]),
            origin: zero,
            low_end: zero,
            high_end: zero,
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
        let mode = motion.stepper.mode(&motion.state);
        let chord = motion.record.begin_event_free(&motion.state.at, &motion.stepper.end);
        if self.of[lane] != (index, motion.state.mode) {
            self.of[lane] = (index, motion.state.mode);
            for (degree, own) in mode.force.coefficients().iter().enumerate() {
                self.force.coefficient_mut(degree).0[lane] = *own;
            }
            let (tone, settings) = (&motion.stepper.drive.tone, &motion.stepper.settings);
            self.origin.0[lane] = mode.origin;
            (self.low_end.0[lane], self.high_end.0[lane]) = (mode.low, mode.high);
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
        self.crossings.0[lane] = 0.0;
        self.active[lane] = true;
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
        motion.stepper.work.add(steps * motion.stepper.costs.step);
        motion.stepper.evaluations += steps;
        (motion.state.x, motion.state.v) = (self.x.0[lane], self.v.0[lane]);
        motion.state.at = self.at.get(lane);
        motion.stepper.cursor = Some((motion.state.at, (self.value.0[lane], self.slope.0[lane])));
        motion.state.turned_back = false;
        motion.state.touch = None;
        motion.record.end_event_free(
            (self.low.0[lane], self.high.0[lane]),
            self.squared.get(lane),
            self.covered.get(lane),
        );
        motion.record.end_event_free_crossings(self.side.0[lane] as i8, self.crossings.0[lane] as u64);
    }

    /// Computes one step in all lanes and takes it where it is event-free.
    #[inline(always)]
    pub fn step(
        &mut self,
        series: &mut Series<Lanes<W>>,
        rule: &GaussLegendre<Lanes<W>>,
        order: usize,
        tolerance_log2: f64,
    ) -> Trial<W> {
        let swing = Harmonic { curvature: self.curvature };
        swing.seed(self.amplitude * self.value, self.amplitude * self.slope, &mut series.a);
        series.begin(self.x - self.origin, self.v);
        series.extend_to(order, &self.force, self.damping, &swing, &mut ());
        let y = &series.y;
        let length = natural_steps(order, |k| y[k].0, &self.speed_log2, tolerance_log2, &self.longest);
        let length = Lanes(length);
        let at = self.at.advance(&length, &self.period);
        let end = series.state(length);

        let (mut value, mut slope) = (length, length);
        for lane in 0..W {
            let turns = at.phase.0[lane] * self.frequency.0[lane] + self.turn.0[lane];
            let (s, c) = f64::sin_cos_turns(turns);
            let omega = f64::tau() * self.frequency.0[lane];
            value.0[lane] = if self.quarter[lane] { c } else { s };
            slope.0[lane] = if self.quarter[lane] { -(s * omega) } else { c * omega };
        }
        let base = self.amplitude * value;
        let sum = (end.acceleration + self.damping * end.v) + base;
        let residual = (self.force.at(end.y) + sum).abs() * length;

        let mut squared = Lanes([0.0; W]);
        let deviations = polynomial::chord_deviations(&series.y[..=order], length);
        if self.inside.contains(&true) {
            squared = polynomial::integrals::<_, false>(&series.y[..=order], &[], rule, squared, length).0;
        }
        let start = series.y[0] + self.origin;
        let x = end.y + self.origin;
        let (mut holds, mut stopped, mut took) = ([false; W], [false; W], [false; W]);
        for lane in 0..W {
            let (length, period) = (length.0[lane], self.period.0[lane]);
            let cycles = self.border.cycle.0[lane] - self.at.cycle.0[lane];
            let to_border = cycles * period + (self.border.phase.0[lane] - self.at.phase.0[lane]);
            let left = to_border - MARGIN * period;
            let held = (residual.0[lane] <= self.allowed.0[lane]) & (length > 0.0);

            let (bound, limits) = (end.bound.0[lane], (self.low_end.0[lane], self.high_end.0[lane]));
            let ways = (self.v.0[lane] * length, end.v.0[lane] * length);
            let deviations = (deviations.0.0[lane], deviations.1.0[lane]);
            let chord = Chord { start: start.0[lane], end: x.0[lane], bound, deviations, ways, limits };
            let (clear_low, clear_high) = chord.is_clear();
            let clear_low = clear_low | (self.x.0[lane] - limits.0 > bound);
            let clear_high = clear_high | (limits.1 - self.x.0[lane] > bound);
            // from a surface: its own speed leads further away than all the rest can lead back
            let leaves = 2.0 * self.v.0[lane].abs() * length > bound * CLEARANCE;
            let clear_low = clear_low | (leaves & (self.touch.0[lane] < 0.0));
            let clear_high = clear_high | (leaves & (self.touch.0[lane] > 0.0));
            let clear = clear_low & clear_high;
            let (low, high, turns) = chord.extremes((self.low.0[lane], self.high.0[lane]));

            // Without a barrier every comparison with it is false, since it is NaN.
            let (barrier, side, inside) = (self.barrier.0[lane], self.side.0[lane], self.inside[lane]);
            let (from, to) = ((chord.start - barrier) * side, (chord.end - barrier) * side);
            let (near, onto, passed) = ((chord.start - barrier).abs() <= bound, to == 0.0, to < 0.0);
            let monotone = chord.is_monotone();
            // outside the window only their number counts
            let countable = !inside & (length + length < left);
            let clear_of_barrier =
                !(near | passed | onto) | (monotone & (from > 0.0) & !onto & (!passed | countable));

            let event_free = clear & held & clear_of_barrier & !(turns & inside) & (length < left);
            let event_free = event_free & (at.phase.0[lane] < period) & (end.v.0[lane].abs() < f64::INFINITY);
            let taken = event_free & self.active[lane];
            holds[lane] = held;
            took[lane] = taken;
            stopped[lane] = !event_free & self.active[lane];

            let measured = taken & inside;
            let (squared, covered) =
                (self.squared.with(lane, squared.0[lane]), self.covered.with(lane, length));
            let set = |place: &mut f64, value: f64, which: bool| *place = if which { value } else { *place };
            set(&mut self.low.0[lane], low, measured);
            set(&mut self.high.0[lane], high, measured);
            set(&mut self.squared.sum.0[lane], squared.0, measured);
            set(&mut self.squared.carry.0[lane], squared.1, measured);
            set(&mut self.covered.sum.0[lane], covered.0, measured);
            set(&mut self.covered.carry.0[lane], covered.1, measured);
            let crosses = taken & passed;
            set(&mut self.side.0[lane], -side, crosses);
            self.crossings.0[lane] += if crosses { 1.0 } else { 0.0 };
            self.steps.0[lane] += if taken { 1.0 } else { 0.0 };
            set(&mut self.touch.0[lane], 0.0, taken);
            set(&mut self.x.0[lane], chord.end, taken);
            set(&mut self.v.0[lane], end.v.0[lane], taken);
            set(&mut self.at.cycle.0[lane], at.cycle.0[lane], taken);
            set(&mut self.at.phase.0[lane], at.phase.0[lane], taken);
            set(&mut self.value.0[lane], value.0[lane], taken);
            set(&mut self.slope.0[lane], slope.0[lane], taken);
        }
        Trial { stopped, taken: took, holds, length, end, at, value, slope, squared }
    }
}
