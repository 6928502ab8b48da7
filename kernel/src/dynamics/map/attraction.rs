//! Whether a periodic orbit attracts a motion that repeats.
//!
//! States that come back do not show it: a motion that passes the place at which a fold has just destroyed an
//! orbit hardly moves there, and one that leaves an unstable orbit stays near it for long. So the orbit is
//! looked for by Newton's method from a state of the motion. It attracts the motion if it exists there, if
//! its multipliers lie inside the unit circle by more than the errors of the integration can change, and if
//! those of the motion itself do. If it just misses the barrier that the motion still crosses, or the other
//! way round, the motion is not there yet.

use super::StroboscopicMap;
use super::jacobian::{Jacobian, Multiplier};
use crate::dynamics::record::repeats::STATE_MATCH;
use crate::dynamics::result::{MapState, Outcome, Side};

/// Largest number of steps of Newton's method. It takes two or three from a motion that repeats, and more
/// just beside a fold.
const MAX_STEPS: usize = 12;

/// Distance from the motion, in [`STATE_MATCH`], beyond which the method is not followed.
const MAX_DISTANCE: f64 = 100.0;

/// Ratio of a step to the one before it above which the method does not converge.
const DIVERGING: f64 = 2.0;

/// Step of Newton's method, as a share of [`STATE_MATCH`], at which the orbit is found.
const FOUND: f64 = 1e-3;

/// Error of a forcing period of the motion in tolerances, as a share of the scales: the largest of 120 runs
/// of a double well at tolerances from 1e-3 to 1e-9; nine of ten made less than 0.08.
const ERRORS: f64 = 0.5;

/// Multiple of a distance beyond which two states are apart for certain.
const APART: f64 = 10.0;

/// Multiple of the tolerance at which a motion must rest as well, and the largest tolerance.
const COARSER: f64 = 10.0;
const COARSEST: f64 = 1e-3;

/// Multiples of the period after which a motion comes back nearly, tried in turn as that of its orbit.
const BRANCHED: [u32; 3] = [1, 2, 3];

/// Magnitude of a multiplier left of the imaginary axis from which on two laps are looked at: the motion is
/// then on one side of the orbit and on the other in turn.
const ALTERNATING: f64 = 0.9;

/// The motion over a lap: its states once a forcing period, the last one at the end, with the derivatives of
/// the end by the beginning.
struct Lap {
    states: Vec<MapState>,
    jacobian: Jacobian,
    determinant: f64,
    rested: bool,
    crosses: bool,
}

/// A periodic orbit beside a motion that repeats.
enum Orbit {
    /// It attracts the motion; the period in forcing periods.
    Attracts(u32),
    /// It does not, so that one of several times its period may.
    Repels,
}

/// A motion that repeats, as its record has it.
#[derive(Debug, Clone, Copy)]
pub(in crate::dynamics) struct Repetition {
    /// Its last stroboscopic state.
    pub state: MapState,
    /// The forcing periods after which it comes back.
    pub periods: u32,
    /// Largest period that its window holds twice.
    pub longest: u32,
    /// An instant at which it rests on a rigid stop, if it does, in cycles of the clock and a fraction of
    /// one, and the side of the stop. What follows its release depends on the drive alone.
    pub rested: Option<((i64, f64), Side)>,
    /// Whether it crosses the barrier; `None` without one.
    pub crosses: Option<bool>,
}

impl Lap {
    /// The magnitude of the largest multiplier and its real part; smallest distance of a multiplier from 1.
    fn multipliers(&self) -> (f64, f64, f64) {
        let all = match self.rested && self.jacobian.size() == 3 {
            // after the release only the circuit's state depends on the state before the rest
            true => vec![Multiplier { re: self.jacobian.trace(), im: 0.0 }],
            false => self.jacobian.multipliers(self.determinant),
        };
        let from_1 = |one: &Multiplier| Multiplier { re: one.re - 1.0, ..*one }.magnitude();
        let nearest = all.iter().map(from_1).fold(f64::INFINITY, f64::min);
        (all[0].magnitude(), all[0].re, nearest)
    }
}

impl StroboscopicMap<'_> {
    /// The period in forcing periods of the orbit that attracts a motion that repeats; `None` if none does.
    /// It is the number after which the motion comes back, a divisor, or twice or three times as many, if the
    /// orbit has just branched off. A motion that rests needs no orbit if it rests at ten times the tolerance
    /// too.
    pub(in crate::dynamics) fn attractor(&self, motion: &Repetition) -> Option<u32> {
        let Repetition { periods, longest, rested, .. } = *motion;
        if rested.is_some_and(|rest| self.rests_for_certain(rest, motion)) {
            return Some(periods);
        }
        for periods in BRANCHED.iter().map(|times| times * periods).take_while(|periods| *periods <= longest)
        {
            match self.beside(motion, periods)? {
                Orbit::Attracts(period) => return Some(period),
                Orbit::Repels => {}
            }
        }
        None
    }

    /// The orbit beside the motion, with this number of forcing periods or a divisor as its period; `None` if
    /// there is none.
    fn beside(&self, &Repetition { state, crosses, .. }: &Repetition, periods: u32) -> Option<Orbit> {
        let (mut at, mut first, mut before) = (state, true, f64::INFINITY);
        for _ in 0..MAX_STEPS {
            let lap = self.lap(at, periods)?;
            let units = self.units();
            let off = self.shares(at, *lap.states.last()?);
            let is_certain = !lap.rested || self.model.has_electrical_state();
            if !is_certain {
                return None;
            }
            if first && !self.leads_inward(&lap, periods) {
                return Some(Orbit::Repels);
            }
            first = false;
            let step = lap.jacobian.in_units(units).newton_step(off)?;
            if largest(step) > DIVERGING * before {
                return None;
            }
            before = largest(step);
            if largest(step) <= FOUND * STATE_MATCH || largest(off) <= self.error(&lap) {
                let there = self.distance(state, at) <= STATE_MATCH
                    && crosses.is_none_or(|crosses| lap.crosses == crosses);
                return Some(match there && self.attracts(&lap) {
                    true => Orbit::Attracts(self.shortest(&lap, at)),
                    false => Orbit::Repels,
                });
            }
            let (x, v) = (at.x + step[0] * units[0], at.v + step[1] * units[1]);
            let depth = if self.model.compliant.is_some() { f64::INFINITY } else { 0.0 };
            let (x, v) = self.model.held_within((x, v), depth);
            at = MapState { x, v, electrical: at.electrical + step[2] * units[2] };
            if !(self.distance(state, at) <= MAX_DISTANCE * STATE_MATCH) {
                return None;
            }
        }
        None
    }

    /// Whether a motion that rests at an instant, on the stop of a side, rests there a lap later, computed at
    /// ten times the tolerance. One that does so at a much coarser one, which takes less time, does.
    fn rests_for_certain(&self, (phase, side): ((i64, f64), Side), motion: &Repetition) -> bool {
        let Some(stop) = self.model.stop(side) else { return false };
        let coarser = (COARSER * self.model.tolerance).min(COARSEST);
        let coarsest = self.model.tolerance.sqrt().clamp(coarser, COARSEST);
        let Self { length, period, cancel, .. } = *self;
        [coarsest, coarser].iter().any(|tolerance| {
            let map = StroboscopicMap::over(&self.model.with_tolerance(*tolerance), period);
            let map = StroboscopicMap { phase, length, cancel, lists_misses: false, ..map };
            let lap = map.pass((stop.x, 0.0), motion.periods);
            let rests = lap.outcome == Outcome::Done && lap.state == (stop.x, 0.0);
            rests && motion.crosses.is_none_or(|crosses| (lap.crossings() > 0) == crosses)
        })
    }

    /// The motion over a lap from a state; `None` if it ends early or has no derivatives.
    fn lap(&self, from: MapState, periods: u32) -> Option<Lap> {
        let mut jacobian = Jacobian::identity(self.model.has_electrical_state());
        let (mut states, mut determinant) = (Vec::new(), Some(1.0));
        let (mut rested, mut crosses) = (false, false);
        let mut at = from;
        for _ in 0..periods {
            let (passage, later) = self.pass_with_jacobian(at, 1);
            if passage.outcome != Outcome::Done || !later.is_finite() {
                return None;
            }
            at = MapState::from(&passage);
            states.push(at);
            jacobian = later.after(&jacobian);
            determinant = determinant.zip(passage.determinant).map(|(all, one)| all * one);
            rested |= passage.rested;
            crosses |= passage.crossings() > 0;
        }
        let determinant = determinant.unwrap_or_else(|| jacobian.determinant());
        Some(Lap { states, jacobian, determinant, rested, crosses })
    }

    /// Whether a lap from the motion leads towards the orbit: its multipliers lie inside the unit circle.
    fn leads_inward(&self, lap: &Lap, periods: u32) -> bool {
        let (largest, re, _) = lap.multipliers();
        if !(re < 0.0 && largest > ALTERNATING) {
            return largest < 1.0;
        }
        let Some(next) = lap.states.last().and_then(|state| self.lap(*state, periods)) else { return false };
        let jacobian = next.jacobian.after(&lap.jacobian);
        let determinant = next.determinant * lap.determinant;
        Lap { jacobian, determinant, ..next }.multipliers().0 < 1.0
    }

    /// Whether the orbit of this lap attracts, however the errors of the integration fall: they keep a motion
    /// away from it by no more than is near, and are too small for a fold.
    fn attracts(&self, lap: &Lap) -> bool {
        let ((largest, _, from_1), error) = (lap.multipliers(), self.error(lap));
        // Near a fold the map is y + a y^2, a about 1 in the scales. An error e destroys the orbit if its
        // multiplier is nearer to 1 than the square root of 4 a e.
        (1.0 - largest) * STATE_MATCH.max(APART * error) >= error && from_1 * from_1 >= 4.0 * error
    }

    /// The shortest period of the orbit through `at` with this lap.
    fn shortest(&self, lap: &Lap, at: MapState) -> u32 {
        let periods = lap.states.len();
        let returns = |period: &usize| {
            let near = self.distance(at, lap.states[period - 1]) <= APART * FOUND * STATE_MATCH;
            periods.is_multiple_of(*period) && near
        };
        (1..periods).find(returns).unwrap_or(periods) as u32
    }

    /// Error of a lap of the motion, as a share of the scales.
    fn error(&self, lap: &Lap) -> f64 {
        ERRORS * lap.states.len() as f64 * self.model.tolerance
    }

    /// Scales of displacement, velocity and the state of the circuit, SI.
    fn units(&self) -> [f64; 3] {
        let scales = &self.model.scales;
        [scales.length, scales.speed, self.model.electrical_scale().unwrap_or(1.0)]
    }

    /// The change from one state to another, as shares of the scales.
    fn shares(&self, from: MapState, to: MapState) -> [f64; 3] {
        let [length, speed, electrical] = self.units();
        let charged = (to.electrical - from.electrical) / electrical;
        [(to.x - from.x) / length, (to.v - from.v) / speed, charged]
    }

    fn distance(&self, from: MapState, to: MapState) -> f64 {
        largest(self.shares(from, to))
    }
}

fn largest(change: [f64; 3]) -> f64 {
    change.iter().fold(0.0, |largest, part| if part.abs() <= largest { largest } else { part.abs() })
}
