//! Long runs: a million impacts, and chaos.

use super::HardCase;
use crate::dynamics::{EventKind, Model, Run};
use crate::numeric::Scalar;
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::dd;
use crate::study::accuracy::measure::{Bench, SMALL_CHANGE, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, polynomial, rigid};

pub(super) const ELASTIC_BOX: HardCase = HardCase {
    name: "elastic-box",
    problem: "A free mass between perfect stops at +-10 mm with 0.05 m/s: 1e6 impacts.",
    answer: "The i-th impact, from 0, at (2 i + 1) D/v; the speed never changes.",
    conditioning: "All flights are one division D/v, so all have the same relative error, at most d; the \
                   clock is as fine late as early and adds half a spacing of its own: d + eps. The speed is \
                   never computed anew: it must be equal bit for bit.",
    find: elastic_box,
};

fn elastic_box(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let setup = Setup::new(polynomial(&[0.0]), (0.0, 0.05), 400_000.1).stops(rigid(10.0, 1.0));
    let model = setup.model()?;
    let run = bench.run(&model, &[])?;
    let distance = 10.0 / 1e3;
    let impacts = run.events.iter().filter(|event| event.kind == EventKind::Impact);
    let late = impacts.clone().enumerate().map(|(i, impact)| {
        let exact = (dd(2.0 * i as f64 + 1.0) * dd(distance) / dd(0.05)).to_f64();
        (off(impact.t, exact, exact), STEP_ERROR + f64::EPSILON)
    });
    let kept = impacts.clone().all(|impact| impact.v_in.abs() == 0.05 && impact.v_out == -impact.v_in);
    Ok(vec![
        Variant::of("1e6 impacts", &run)
            .worst("impact times", late)
            .fact("speed kept bit for bit", kept)
            .fact("none lost", run.summary.total_impacts == 1_000_000),
    ])
}

pub(super) const CHAOS: HardCase = HardCase {
    name: "chaos",
    problem: "The forced double well in chaos (preset duffing-chaos): 5 to 30 periods in digits, 1000 in \
              averages.",
    answer: "The state by the program in double-double arithmetic. Exactly, for any length: the base's work \
             is what damping takes plus what is stored. RMS velocity from two starts, 900 periods each.",
    conditioning: "The state's sensitivity to its data, by the reference: it grows as exp(lambda t). For \
                   averages none is needed: a bounded motion's balance closes to n d of the energy moved, \
                   and two estimates of a mean agree to 4 standard errors, taken from 30 batches of 30 \
                   periods each.",
    find: chaos,
};

fn chaos(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let preset = |changes: &[&str]| Setup::preset("duffing-chaos", changes);
    let mut variants = Vec::new();
    let period = 5.235987755982988;
    for (name, periods) in [("5 periods", 5.0), ("15 periods", 15.0), ("30 periods", 30.0)] {
        let duration = format!("run.duration_s={:?}", periods * period);
        let setup = preset(&[&duration, "run.settle_s=0"])?;
        let model = setup.model()?;
        let state = |run: &Run| vec![run.summary.final_x, run.summary.final_v];
        let run = bench.run(&model, &[])?;
        let exact = state(&bench.reference(&model, &[])?);
        let allowed = Bench::allowed(
            &model,
            run.summary.steps,
            &bench.sensitivity_by(SMALL_CHANGE, &setup, &[], state)?,
        );
        let (found, scales) = (state(&run), [model.scales().length, model.scales().speed]);
        let pairs = (0..2).map(|i| (off(found[i], exact[i], scales[i]), allowed[i] / scales[i]));
        variants.push(Variant::of(name, &run).worst("final state", pairs));
    }
    let (one, batches) = averages(bench, &preset(&[])?.model()?)?;
    let (_, other) = averages(bench, &preset(&["start.x_mm=900"])?.model()?)?;
    let (a, b) = (mean(&batches), mean(&other));
    let error = (spread(&batches).powi(2) + spread(&other).powi(2)).sqrt();
    let ledger = one.summary.ledger.map_or(f64::NAN, |ledger| ledger.energy_residual);
    variants.push(
        Variant::of("averages", &one).number("mean square velocity", off(a, b, a), 4.0 * error / a).number(
            "energy balance",
            ledger,
            one.summary.steps as f64 * STEP_ERROR,
        ),
    );
    Ok(variants)
}

/// A run, and the mean square velocity over each of 30 batches of 30 periods, from 64 samples a period.
fn averages(bench: &Bench, model: &Model) -> Result<(Run, Vec<f64>), Stopped> {
    const BATCHES: usize = 30;
    const PER_BATCH: usize = 30 * 64;
    let step = (model.duration() - model.settle()) / (BATCHES * PER_BATCH) as f64;
    let times: Vec<f64> =
        (0..BATCHES * PER_BATCH).map(|i| model.settle() + (i as f64 + 0.5) * step).collect();
    let run = bench.run(model, &times)?;
    let batches = run
        .samples
        .chunks(PER_BATCH)
        .map(|batch| batch.iter().map(|sample| sample.v * sample.v).sum::<f64>() / batch.len() as f64)
        .collect();
    Ok((run, batches))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Standard error of the mean.
fn spread(values: &[f64]) -> f64 {
    let (middle, n) = (mean(values), values.len() as f64);
    (values.iter().map(|value| (value - middle).powi(2)).sum::<f64>() / (n * (n - 1.0))).sqrt()
}
