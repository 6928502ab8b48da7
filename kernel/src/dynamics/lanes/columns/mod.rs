//! Columns of a batch: the state of all lanes, its exchange with single motions, and one step of all lanes.

mod landing;
mod step;

use super::trial::{Clocks, CompensatedSums};
use crate::dynamics::drive::tone::Sine;
use crate::dynamics::equation::force::PieceForce;
use crate::dynamics::equation::{End, EndKind, Mode};
use crate::dynamics::motion::Motion;
use crate::dynamics::state::{Opening, Touch};
use crate::dynamics::step::work::ARRIVAL;
use crate::numeric::Lanes;

pub(super) type LaneMotion<'a> = Motion<'a, f64, Sine<f64>>;

/// The lanes, in columns.
pub(crate) struct Columns<const W: usize> {
    pub active: [bool; W],
    /// Steps taken since a lane was loaded.
    steps: Lanes<W>,
    /// Breaks passed since then.
    passages: Lanes<W>,
    /// Crossings of the barrier since then.
    crossings: Lanes<W>,
    // constant while a lane is in one mode of one run
    /// The number of the run, once one has been loaded, and its mode.
    run: [Option<usize>; W],
    mode: [usize; W],
    force: PieceForce<Lanes<W>>,
    origin: Lanes<W>,
    low_end: Lanes<W>,
    high_end: Lanes<W>,
    /// The same for an end that is a break; otherwise infinite.
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
    /// The barrier whose crossings are counted; NaN without one.
    barrier: Lanes<W>,
    side: Lanes<W>,
    border: Clocks<W>,
    /// Whether each step is logged, in case the motion recurs.
    pub logged: [bool; W],
    /// Whether the time up to `border` lies in the settled window.
    pub inside: [bool; W],
    // what changes with each step
    /// -1 or 1 if the mass is leaving the low or the high end of the mode with speed; else 0.
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
    /// For forces of the same degree as `force`.
    pub fn new(force: &PieceForce<f64>) -> Self {
        let zero = Lanes([0.0; W]);
        let clocks = Clocks { cycle: zero, phase: zero };
        let sums = CompensatedSums { sum: zero, carry: zero };
        Self {
            active: [false; W],
            steps: zero,
            passages: zero,
            crossings: zero,
            run: [None; W],
            mode: [0; W],
            force: PieceForce { coefficients: vec![zero; force.coefficients.len()] },
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

    pub fn accepts(&self, force: &PieceForce<f64>) -> bool {
        self.force.degree() == force.degree()
    }

    /// Loads a motion, whose force has the lanes' degree, into a lane; `index` is the number of its run.
    pub fn load(&mut self, lane: usize, index: usize, motion: &LaneMotion) {
        let record = motion.record.begin_event_free(&motion.state.at, &motion.stepper.end);
        if (self.run[lane], self.mode[lane]) != (Some(index), motion.state.mode) {
            self.load_mode(lane, motion.state.mode, motion.stepper.mode(&motion.state));
            self.run[lane] = Some(index);
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
            self.period.0[lane] = motion.stepper.clock.period;
        }
        self.barrier.0[lane] = record.barrier.unwrap_or(f64::NAN);
        self.side.0[lane] = f64::from(record.side);
        self.border.set(lane, &record.border);
        self.logged[lane] = motion.log.is_some();
        self.inside[lane] = record.inside;
        (self.low.0[lane], self.high.0[lane]) = (record.low, record.high);
        self.squared.set(lane, &record.squared);
        self.covered.set(lane, &record.covered);
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

    /// Loads a mode, whose force has the lanes' degree, into a lane; `index` is its number in the equation.
    fn load_mode(&mut self, lane: usize, index: usize, mode: &Mode<f64>) {
        self.mode[lane] = index;
        for (column, coefficient) in self.force.coefficients.iter_mut().zip(&mode.force.coefficients) {
            column.0[lane] = *coefficient;
        }
        let at_break = |end: End| match mode.end(end) {
            (level, EndKind::Break) => level,
            _ => end.sign::<f64>() * f64::INFINITY,
        };
        self.origin.0[lane] = mode.origin;
        (self.low_end.0[lane], self.high_end.0[lane]) = (mode.low, mode.high);
        (self.low_break.0[lane], self.high_break.0[lane]) = (at_break(End::Low), at_break(End::High));
    }

    /// The end at which a lane that stands on a break leaves its mode.
    pub fn exit(&self, lane: usize) -> End {
        if self.v.0[lane] > 0.0 { End::High } else { End::Low }
    }

    /// Moves a lane that stands on a break into the next mode; returns false if the force has another degree.
    pub fn enter_neighbour(&mut self, lane: usize, modes: &[Mode<f64>]) -> bool {
        let exit = self.exit(lane);
        let index = match exit {
            End::Low => self.mode[lane] - 1,
            End::High => self.mode[lane] + 1,
        };
        if !self.accepts(&modes[index].force) {
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
        motion.state.mode = self.mode[lane];
        let touched = |end: End| Touch { end, opening: Opening::Speed };
        let ends = [End::Low, End::High].into_iter();
        motion.state.touch = ends.map(touched).find(|touch| touch.end.sign::<f64>() == self.touch.0[lane]);
        motion.record.end_event_free(
            (self.low.0[lane], self.high.0[lane]),
            self.squared.get(lane),
            self.covered.get(lane),
            self.side.0[lane] as i8,
            self.crossings.0[lane] as u64,
        );
    }
}
