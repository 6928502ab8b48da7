//! An adaptive Runge-Kutta method with located events, as general solvers offer it.
//!
//! Dormand and Prince 1980, "A family of embedded Runge-Kutta formulae", order 5(4), with the continuous
//! extension of order 4 of Hairer, Norsett and Wanner 1993 (Solving ordinary differential equations I, II.6)
//! and their step control. Contact is looked for as general solvers do, by the sign of the gap at the end of
//! a step, and its root on the continuous extension is bisected to rounding: an excursion inside a step is
//! not seen.

use super::{MethodRun, Problem, Tally, TimedState, is_cancelled};
use crate::dynamics::{Model, Request, Side};
use crate::numeric::{bisect, elementary};

/// A pressed rebound slower than this share of the scene's speed counts as a rest: a solver that does not sum
/// chatter needs such a limit.
const REST_SPEED: f64 = 1e-6;

/// Most attempted steps of one run, rejected ones included.
const MAX_STEPS: u64 = 20_000_000;

const CANCEL_STRIDE: u64 = 1 << 10;

/// Steps a forcing period in which the release from a rest is searched.
const SEARCHES: f64 = 200.0;

const NODES: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const STAGES: [&[f64]; 6] = [
    &[0.2],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Weights of the fifth order less those of the fourth.
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];
const DENSE: [f64; 7] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

type Pair = [f64; 2];

/// One step and its continuous extension.
struct Step {
    h: f64,
    end: Pair,
    /// (x', v') at the end.
    slope: Pair,
    error: f64,
    dense: [Pair; 5],
}

impl Step {
    fn take(problem: &Problem, t: f64, y: Pair, slope: Pair, h: f64, tolerance: f64) -> Self {
        let mut k = [slope; 7];
        let mut end = y;
        for (stage, (weights, node)) in STAGES.iter().zip(NODES).enumerate() {
            end = y;
            for (weight, k) in weights.iter().zip(&k) {
                end[0] += h * weight * k[0];
                end[1] += h * weight * k[1];
            }
            k[stage + 1] = [end[1], problem.acceleration(t + node * h, end[0], end[1])];
        }
        let scales = problem.model.scales();
        let combine = |weights: &[f64; 7], i: usize| -> f64 {
            weights.iter().zip(&k).map(|(weight, k)| weight * k[i]).sum::<f64>() * h
        };
        let error = elementary::hypot(combine(&ERROR, 0) / scales.length, combine(&ERROR, 1) / scales.speed);
        let mut dense = [[0.0; 2]; 5];
        for i in 0..2 {
            let rise = end[i] - y[i];
            let bow = h * k[0][i] - rise;
            dense[0][i] = y[i];
            dense[1][i] = rise;
            dense[2][i] = bow;
            dense[3][i] = rise - h * k[6][i] - bow;
            dense[4][i] = combine(&DENSE, i);
        }
        Self { h, end, slope: k[6], error: error * std::f64::consts::FRAC_1_SQRT_2 / tolerance, dense }
    }

    fn at(&self, s: f64) -> Pair {
        let r = 1.0 - s;
        let [a, b, c, d, e] = &self.dense;
        [0, 1].map(|i| a[i] + s * (b[i] + r * (c[i] + s * (d[i] + r * e[i]))))
    }

    /// The integral of v^2 over the first `share` of the step, by Gauss's rule of four points.
    fn squares(&self, share: f64) -> f64 {
        const POINTS: [(f64, f64); 2] = [
            (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
            (0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
        ];
        let at = |point: f64| self.at(0.5 * share * (1.0 + point))[1].powi(2);
        let sum: f64 = POINTS.iter().map(|(point, weight)| weight * (at(*point) + at(-point))).sum();
        0.5 * share * self.h * sum
    }

    /// The share of the step at which the gap to a stop closes; `None` if it is open at the end. With
    /// `begins_on` the step begins on that stop, and the gap opens first.
    fn contact(&self, stop: f64, sign: f64, begins_on: bool) -> Option<f64> {
        let gap = |s: f64| sign * (stop - self.at(s)[0]);
        if sign * (stop - self.end[0]) >= 0.0 {
            return None;
        }
        let mut low = 0.0;
        if begins_on {
            low = 0.5;
            while gap(low) <= 0.0 {
                low *= 0.5;
                if low < 1e-12 {
                    return Some(0.0);
                }
            }
        }
        // to 2^-60 of the step: a contact at its very start has no relative precision
        Some(bisect(low, 1.0, 60, |share| gap(share) > 0.0).1)
    }
}

/// Runs `model` with the local error `tolerance` allowed relative to the scene's length and speed.
///
/// A pressed rebound slower than 1e-6 of the scene's speed is a rest, its release found by a scan in 200ths
/// of the forcing period (or of the duration) and bisection. Ends early where the force curve ends, and after
/// 2e7 attempts.
pub fn dormand_prince(model: &Model, tolerance: f64, request: &Request) -> MethodRun {
    let problem = Problem::new(model);
    let mut march = March {
        problem,
        tolerance,
        tally: Tally::new(problem, request),
        now: problem.start,
        h: 1e-2 * model.scales().time,
        slope: None,
        touching: SIDES.into_iter().find(|side| problem.start.x == problem.stop(*side).0),
    };
    let mut attempts = 0_u64;
    while march.now.t < model.duration() {
        attempts += 1;
        let is_stopped =
            attempts > MAX_STEPS || (attempts.is_multiple_of(CANCEL_STRIDE) && is_cancelled(request));
        if is_stopped || !(march.rest() || march.step()) {
            break;
        }
    }
    march.tally.finish(march.now)
}

const SIDES: [Side; 2] = [Side::Left, Side::Right];

/// The sign of a displacement towards a stop.
fn sign(side: Side) -> f64 {
    if side == Side::Left { -1.0 } else { 1.0 }
}

struct March<'a> {
    problem: Problem<'a>,
    tolerance: f64,
    tally: Tally<'a>,
    now: TimedState,
    /// Length of the next step in s.
    h: f64,
    /// (x', v') at `now`, where it is known.
    slope: Option<Pair>,
    touching: Option<Side>,
}

impl March<'_> {
    /// Whether the mass is at a stop, nearly at rest, and pressed; then it rests until the release.
    fn rest(&mut self) -> bool {
        let (problem, model, now) = (self.problem, self.problem.model, self.now);
        let is_slow = |side: &Side| now.v * sign(*side) > -REST_SPEED * model.scales().speed;
        let Some(side) = self.touching.filter(is_slow) else { return false };
        let press = |t: f64| sign(side) * problem.acceleration(t, now.x, 0.0);
        self.tally.run.statistics.evaluations += 1;
        if !(press(now.t) > 0.0) {
            return false;
        }
        let end = model.duration();
        let release = release(press, now.t, end, model.forcing_period().unwrap_or(end) / SEARCHES);
        let rested = TimedState { v: 0.0, ..now };
        self.now = TimedState { t: release, ..rested };
        self.tally.step(rested, self.now, 0.0);
        self.slope = None;
        self.h = 1e-2 * model.scales().time;
        true
    }

    /// Attempts a step, up to its first contact. Returns whether the run continues.
    fn step(&mut self) -> bool {
        let (problem, now, end) = (self.problem, self.now, self.problem.model.duration());
        let start = self.slope.unwrap_or_else(|| {
            self.tally.run.statistics.evaluations += 1;
            [now.v, problem.acceleration(now.t, now.x, now.v)]
        });
        self.slope = Some(start);
        let last = now.t + self.h >= end;
        let length = if last { end - now.t } else { self.h };
        let step = Step::take(&problem, now.t, [now.x, now.v], start, length, self.tolerance);
        self.tally.run.statistics.evaluations += 6;
        let factor = if step.error > 0.0 { 0.9 * elementary::powf(step.error, -0.2) } else { 5.0 };
        if !(step.error <= 1.0) {
            self.h = length * if factor.is_finite() { factor.clamp(0.2, 1.0) } else { 0.2 };
            return now.t + self.h > now.t;
        }
        let contact = |side: Side| {
            let share = step.contact(problem.stop(side).0, sign(side), self.touching == Some(side))?;
            Some((share, side))
        };
        let contacts = SIDES.into_iter().filter(|side| problem.stop(*side).0.is_finite()).filter_map(contact);
        let next = match contacts.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((share, side)) => self.bounce(&step, share, side),
            None => {
                let t = if last { end } else { now.t + length };
                let next = TimedState { t, x: step.end[0], v: step.end[1] };
                self.tally.step(now, next, step.squares(1.0));
                self.touching = None;
                self.slope = Some(step.slope);
                self.h = length * factor.clamp(0.2, 5.0);
                next
            }
        };
        let is_inside = problem.is_inside(next.x, next.v);
        if is_inside {
            self.now = next;
        }
        is_inside
    }

    /// The state after the impact at a share of the step.
    fn bounce(&mut self, step: &Step, share: f64, side: Side) -> TimedState {
        let (problem, now) = (self.problem, self.now);
        let (place, restitution) = problem.stop(side);
        let v_in = step.at(share)[1];
        let next = TimedState { t: now.t + share * step.h, x: place, v: -restitution * v_in };
        self.tally.step(now, TimedState { v: v_in, ..next }, step.squares(share));
        if v_in * sign(side) > 0.0 {
            self.tally.impact(next.t, side, v_in, next.v);
        }
        self.touching = Some(side);
        self.slope = None;
        // the next step is at most the next flight under a constant press
        let press = sign(side) * problem.acceleration(next.t, place, next.v);
        self.tally.run.statistics.evaluations += 1;
        if press > 0.0 {
            self.h = self.h.min((2.0 * next.v.abs() / press).max(1e-9 * problem.model.scales().time));
        }
        next
    }
}

/// The time at which the press, positive at `from`, falls to 0; `end` if it stays positive.
fn release(press: impl Fn(f64) -> f64, from: f64, end: f64, stride: f64) -> f64 {
    let mut low = from;
    while low < end {
        let high = (low + stride).min(end);
        if press(high) <= 0.0 {
            return bisect(low, high, u32::MAX, |t| press(t) > 0.0).1;
        }
        low = high;
    }
    end
}
