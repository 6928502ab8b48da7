//! Balls under a constant force.

use super::HardCase;
use crate::dynamics::{EventKind, Outcome, Run};
use crate::numeric::Scalar;
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::{dd, first_hit, impact_time, rest_time};
use crate::study::accuracy::measure::{Bench, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, left_stop, polynomial};

pub(super) const BOUNCING_BALL: HardCase = HardCase {
    name: "bouncing-ball",
    problem: "1 kg dropped from 1 m under 9.81 N on a stop with e = 0, 0.36, 0.9, 0.99, 0.999.",
    answer: "First hit t1 = sqrt(2/g), the i-th at t1 (1 + 2 (e + .. + e^(i-1))) with the speed e^(i-1) \
             sqrt(2 g), rest at t1 (1 + e)/(1 - e), the chatter's sum.",
    conditioning: "Each rebound and each flight adds d: the i-th speed has i d. A flight's error is that of \
                   its speed, so the sum of flights has sum i e^i/sum e^i d, at most d min(i, 1/(1 - e)), \
                   and one d of its own.",
    find: bouncing_ball,
};

const RESTITUTIONS: [(&str, f64); 5] =
    [("e = 0", 0.0), ("e = 0.36", 0.36), ("e = 0.9", 0.9), ("e = 0.99", 0.99), ("e = 0.999", 0.999)];

/// Times of the events of one kind.
pub(super) fn times(run: &Run, kind: EventKind) -> Vec<f64> {
    run.events.iter().filter(|event| event.kind == kind).map(|event| event.t).collect()
}

fn bouncing_ball(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let first = first_hit(1.0, 9.81);
    let speed = (2.0 * 9.81_f64).sqrt();
    let mut variants = Vec::new();
    for (name, e) in RESTITUTIONS {
        let rest = rest_time(first, e).to_f64();
        let setup = Setup::new(polynomial(&[9.81]), (0.0, 0.0), 1.1 * rest).stops(left_stop(1000.0, e));
        let run = bench.run(&setup.model()?, &[])?;
        let reach = 1.0 / (1.0 - e);
        let impacts = run.events.iter().filter(|event| event.kind == EventKind::Impact);
        let (mut late, mut slow) = (Vec::new(), Vec::new());
        // the closed form is summed incrementally: impact_time for each impact would be quadratic
        let mut power = dd(1.0);
        let mut sum = dd(0.0);
        for (i, impact) in impacts.enumerate() {
            let count = i as f64 + 1.0;
            let exact = first * (dd(1.0) + sum + sum);
            late.push((off(impact.t, exact.to_f64(), exact.to_f64()), STEP_ERROR * (1.0 + count.min(reach))));
            let exact = speed * power.to_f64();
            slow.push((off(impact.v_in.abs(), exact, exact), STEP_ERROR * (1.0 + count)));
            power = power * dd(e);
            sum += power;
        }
        let rests = times(&run, EventKind::Rest);
        let error = rests.first().map_or(f64::NAN, |t| off(*t, rest, rest));
        let tenth = times(&run, EventKind::Impact).get(9).copied();
        let tenth = tenth.map(|t| off(t, impact_time(first, e, 10).to_f64(), t));
        variants.push(
            Variant::of(name, &run)
                .worst("impact times", late)
                .worst("impact speeds", slow)
                .number("time of rest", error, STEP_ERROR * (1.0 + reach))
                .fact("one rest on the stop", rests.len() == 1 && run.summary.final_x == -1.0)
                .fact("tenth impact by its own sum", tenth.is_none_or(|error| error <= STEP_ERROR * 11.0)),
        );
    }
    Ok(variants)
}

pub(super) const BUDGET: HardCase = HardCase {
    name: "elastic-press",
    problem: "e = 1, pressed on a stop with damping: 1 kg, 1 N, c = 1 N s/m, thrown up with 1e-5 m/s. The \
              impacts die only as exp(-g t/3), g = c/m, and never end: the run ends by its budget of \
              impacts.",
    answer: "With z = g v/a a flight takes z to t - z, (1 + z)(1 - exp(-t)) = t, so 1/z grows by 2/3 + 4 \
             z^2/135 + O(z^3) in each: after N impacts v = v0/(1 + (2/3) N z0).",
    conditioning: "The neglected terms are at most N 4 z0^2/135 of a sum of 2 N/3 or more: 2 z0^2/45 \
                   relatively. Each flight adds d to the speed, N d.",
    find: budget,
};

fn budget(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let v0: f64 = 1e-5;
    let setup = Setup::new(polynomial(&[1.0]), (-1.0, v0), 1e6).stops(left_stop(1000.0, 1.0)).damping(1.0);
    let run = bench.run_bare(&setup.model()?)?;
    let summary = &run.summary;
    let impacts = match summary.outcome {
        Outcome::ImpactBudget { count, .. } => count,
        _ => 0,
    };
    let n = impacts as f64;
    let exact = v0 / (1.0 + 2.0 / 3.0 * n * v0);
    // a = g = 1, so that z0 = v0
    let allowed = v0 * v0 * 2.0 / 45.0 + n * STEP_ERROR;
    Ok(vec![
        Variant::of("2e6 impacts", &run)
            .number("speed at the end", off(summary.final_v.abs(), exact, exact), allowed)
            .fact("ends by its budget", impacts >= 2_000_000),
    ])
}
