//! Cases of complete and incomplete chatter.

use super::HardCase;
use super::ball::times;
use crate::dynamics::{EventKind, Run};
use crate::numeric::Scalar;
use crate::scene::Damping;
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::{Pressed, dd};
use crate::study::accuracy::measure::{Bench, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, polynomial, right_stop, sine};

pub(super) const COMPLETE: HardCase = HardCase {
    name: "chatter-curved",
    problem: "Thrown off the stop at 4 mm of the nominal cubic well with 0.1 m/s, damped (ratio 0.05) and \
              shaken: the force changes along each flight; e = 0.36, 0.9, 0.99.",
    answer: "The time of rest by the program in double-double arithmetic, which resolves some thousands of \
             impacts more before it sums.",
    conditioning: "Sensitivity of the time of rest to mass, speed, amplitude, damping and restitution, by \
                   the reference.",
    find: complete,
};

fn complete(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let mut variants = Vec::new();
    for (name, e) in [("e = 0.36", 0.36), ("e = 0.9", 0.9), ("e = 0.99", 0.99)] {
        let mut setup = Setup::nominal(4.0, e, sine(3.0, 1.0, 30.0), 1.5).start(4e-3, -0.1);
        setup.scene.damping = Damping::Ratio(0.05);
        let model = setup.model()?;
        let rest = |run: &Run| vec![times(run, EventKind::Rest).first().copied().unwrap_or(f64::NAN)];
        let run = bench.run(&model, &[])?;
        let exact = rest(&bench.reference(&model, &[])?)[0];
        let allowed = Bench::allowed(&model, run.summary.steps, &bench.sensitivity(&setup, &[], rest)?);
        variants.push(
            Variant::of(name, &run)
                .number("time of rest", off(rest(&run)[0], exact, exact), allowed[0] / exact)
                .fact("one rest", run.summary.rests == 1),
        );
    }
    Ok(variants)
}

pub(super) const INCOMPLETE: HardCase = HardCase {
    name: "chatter-incomplete",
    problem: "Pressed with 1 m/s^2 on a stop with e = 0.9 and shaken with 1.2 m/s^2 at 1 Hz, thrown off with \
              0.02 m/s: the press changes sign before the impacts accumulate, and the mass leaves in \
              mid-chatter.",
    answer: "All impacts within the first second by the program in double-double arithmetic.",
    conditioning: "Sensitivity of each impact's time to mass, speed, amplitude and restitution, by the \
                   reference.",
    find: incomplete,
};

fn incomplete(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let setup = Setup::new(polynomial(&[-1.0]), (1.0, -0.02), 1.0)
        .stops(right_stop(1000.0, 0.9))
        .drive(sine(1.0, 1.2, 0.0));
    let model = setup.model()?;
    let impacts = |run: &Run| times(run, EventKind::Impact);
    let run = bench.run(&model, &[])?;
    let exact = impacts(&bench.reference(&model, &[])?);
    let found = impacts(&run);
    let allowed = Bench::allowed(&model, run.summary.steps, &bench.sensitivity(&setup, &[], impacts)?);
    let pairs = found
        .iter()
        .zip(&exact)
        .zip(&allowed)
        .map(|((t, exact), allowed)| (off(*t, *exact, *exact), allowed / exact));
    let leaves = Pressed { press: 1.0, amplitude: 1.2, frequency: 1.0 }.release().to_f64();
    let before = found.iter().filter(|t| **t < leaves).count();
    let rests_before = times(&run, EventKind::Rest).iter().any(|t| *t < leaves);
    Ok(vec![
        Variant::of("e = 0.9", &run)
            .worst("impact times", pairs)
            .fact("leaves in mid-chatter", before > 0 && found.len() == exact.len() && !rests_before),
    ])
}

pub(super) const ENDS_WITH_THE_PRESS: HardCase = HardCase {
    name: "chatter-at-release",
    problem: "The same with e = 0.5, thrown off so that the chatter ends as the press changes sign: of two \
              neighbouring doubles of the speed one comes to rest before, the other does not.",
    answer: "Both leave the stop at the sign change t*, as a mass at rest there would: displacement in \
             closed form, 0.3 s later.",
    conditioning: "What is left at t* of the chatter is a speed of at most the difference of the two, v0 \
                   eps, and what i rebounds add: (i + 2) d V, with V of the scene. In tau = 0.3 s it carries \
                   the mass V tau as far.",
    find: ends_with_the_press,
};

/// Time in s after the release at which both are compared.
const AFTER: f64 = 0.3;

fn ends_with_the_press(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let pressed = Pressed { press: 1.0, amplitude: 1.2, frequency: 1.0 };
    let leaves = pressed.release();
    let end = leaves.to_f64() + AFTER;
    let setup = |v: f64| {
        Setup::new(polynomial(&[-1.0]), (1.0, -v), end)
            .stops(right_stop(1000.0, 0.5))
            .drive(sine(1.0, 1.2, 0.0))
    };
    // the order of events decides, not their times, which may be equal
    let comes_to_rest = |run: &Run| {
        let first = run.events.iter().find(|event| event.kind == EventKind::Rest);
        first.is_some_and(|rest| rest.t <= leaves.to_f64())
    };
    let (mut low, mut high): (f64, f64) = (1e-4, 0.1);
    let ends = [low, high].map(|v| setup(v).model());
    let [rests, leaves_early] = ends;
    let (rests, leaves_early) = (bench.run(&rests?, &[])?, bench.run(&leaves_early?, &[])?);
    let bracketed = comes_to_rest(&rests) && !comes_to_rest(&leaves_early);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if comes_to_rest(&bench.run(&setup(middle).model()?, &[])?) { low = middle } else { high = middle }
    }
    let mut variants = Vec::new();
    for (name, v) in [("just rests", low), ("just does not", high)] {
        let model = setup(v).model()?;
        let run = bench.run(&model, &[])?;
        let (gap, _) = pressed.flight((dd(0.0), dd(0.0)), leaves, dd(end));
        let exact = (dd(1.0) - gap).to_f64();
        let scales = model.scales();
        let rebounds = times(&run, EventKind::Impact).len() as f64;
        let allowed = (rebounds + 2.0) * STEP_ERROR * (scales.speed * AFTER / scales.length)
            + run.summary.steps as f64 * STEP_ERROR;
        variants.push(
            Variant::of(name, &run)
                .number("displacement 0.3 s later", off(run.summary.final_x, exact, scales.length), allowed)
                .fact("the two are neighbours", bracketed && high.to_bits() - low.to_bits() == 1),
        );
    }
    Ok(variants)
}
