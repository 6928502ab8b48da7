//! Fixed steps with clamp and bounce.

use super::{MethodRun, Problem, Scheme, Tally, TimedState, is_cancelled};
use crate::dynamics::{Model, Request, Side};

const CANCEL_STRIDE: u64 = 1 << 14;

/// Largest number of steps of a run: some seconds.
const MAX_STEPS: f64 = 1e8;

/// Runs `model` by `scheme` in even steps of at most `step` in s; the last one ends at the duration.
///
/// The model's tolerance has no effect. A step that ends beyond a stop is put onto it and its velocity is
/// multiplied by -e; there is no rest: a pressed mass hops for ever. Statistics and path are those of the
/// steps, as the user of such a method sees them; an impact has the time at the end of its step. A step that
/// is not above 0, or makes more than 1e8 of them, is taken as the shortest allowed. Ends early where the
/// force curve ends.
pub fn fixed_step(model: &Model, scheme: Scheme, step: f64, request: &Request) -> MethodRun {
    let problem = Problem::new(model);
    let wanted = (model.duration() / step).ceil();
    let count = if wanted >= 1.0 { wanted.min(MAX_STEPS) } else { MAX_STEPS } as u64;
    let h = model.duration() / count as f64;
    let mut tally = Tally::new(problem, request);
    let mut now = problem.start;
    let mut last_acceleration = problem.acceleration(0.0, now.x, now.v);
    tally.run.statistics.evaluations = 1;
    for i in 1..=count {
        if i % CANCEL_STRIDE == 0 && is_cancelled(request) {
            break;
        }
        let t = if i == count { model.duration() } else { h * i as f64 };
        let evaluations = &mut tally.run.statistics.evaluations;
        let mut next = match scheme {
            Scheme::SemiImplicitEuler => {
                *evaluations += 1;
                let v = now.v + h * problem.acceleration(now.t, now.x, now.v);
                TimedState { t, x: now.x + h * v, v }
            }
            Scheme::VelocityVerlet => {
                *evaluations += 1;
                let x = now.x + h * (now.v + 0.5 * h * last_acceleration);
                let new = problem.acceleration(t, x, now.v + h * last_acceleration);
                let v = now.v + 0.5 * h * (last_acceleration + new);
                last_acceleration = new;
                TimedState { t, x, v }
            }
            Scheme::RungeKutta4 => {
                *evaluations += 4;
                runge_kutta(&problem, now, h, t)
            }
        };
        let mut bounced = None;
        for (side, (stop, restitution)) in [Side::Left, Side::Right].into_iter().zip(problem.stops) {
            let beyond = if side == Side::Left { next.x < stop } else { next.x > stop };
            if beyond {
                next.x = stop;
                let outward = if side == Side::Left { next.v < 0.0 } else { next.v > 0.0 };
                if outward {
                    let v_in = next.v;
                    next.v = -restitution * v_in;
                    bounced = Some((side, v_in, next.v));
                }
                if scheme == Scheme::VelocityVerlet {
                    last_acceleration = problem.acceleration(t, next.x, next.v);
                    *evaluations += 1;
                }
            }
        }
        if !problem.is_inside(next.x, next.v) {
            break;
        }
        tally.step(now, next, 0.5 * h * (now.v * now.v + next.v * next.v));
        if let Some((side, v_in, v_out)) = bounced {
            tally.impact(t, side, v_in, v_out);
        }
        now = next;
    }
    tally.finish(now)
}

fn runge_kutta(problem: &Problem, TimedState { t, x, v }: TimedState, h: f64, end: f64) -> TimedState {
    let half = 0.5 * h;
    let a1 = problem.acceleration(t, x, v);
    let (x2, v2) = (x + half * v, v + half * a1);
    let a2 = problem.acceleration(t + half, x2, v2);
    let (x3, v3) = (x + half * v2, v + half * a2);
    let a3 = problem.acceleration(t + half, x3, v3);
    let (x4, v4) = (x + h * v3, v + h * a3);
    let a4 = problem.acceleration(end, x4, v4);
    TimedState {
        t: end,
        x: x + h / 6.0 * (v + 2.0 * (v2 + v3) + v4),
        v: v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4),
    }
}
