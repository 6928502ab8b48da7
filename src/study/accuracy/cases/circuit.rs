//! Cases of a linear oscillator with a circuit: stiff, strongly coupled, and limits in which it vanishes.

use std::f64::consts::TAU;

use super::HardCase;
use super::curves::{by_reference, hard_impacts};
use super::drives::{even, tones};
use crate::dynamics::{Model, Run};
use crate::numeric::Scalar;
use crate::scene::{Mechanism, Transducer};
use crate::study::accuracy::Stopped;
use crate::study::accuracy::exact::{Coupled, Oscillator, dd};
use crate::study::accuracy::measure::{Bench, STEP_ERROR, Variant, off};
use crate::study::accuracy::scenes::{Setup, coil, layer, polynomial, sine};

/// Conditioning of a linear oscillator with a circuit: only the drive adds energy.
const LINEAR: &str = "Energy in mass, spring and circuit only falls, so that an error is carried on without \
                      growth: n steps add n d to each of the three, relative to the size that the motion \
                      gives it; the phase of the drive at a time t is a product of two doubles: 2 pi f t \
                      eps.";

const MASS: f64 = 0.02;
const STIFFNESS: f64 = 50.0;
const DAMPING: f64 = 0.08;

/// 20 g on a spring of 50 N/m (7.96 Hz), damped, shaken with 1 g at 7 Hz, from 2 mm with -0.1 m/s, with a
/// circuit whose current or voltage is 0 at the start.
fn sprung(transducer: Transducer, duration: f64) -> Setup {
    let mut setup = Setup::new(polynomial(&[0.0, STIFFNESS]), (0.002, -0.1), duration)
        .damping(DAMPING)
        .drive(sine(7.0, 9.8, 0.0))
        .beside(transducer, 0.0);
    setup.scene.mass_g = MASS * 1e3;
    setup
}

/// The closed form of an oscillator with this stiffness, constant force and the circuit of its scene, from
/// the exact doubles of the scene.
pub(super) fn closed_form(setup: &Setup, model: &Model, (stiffness, force): (f64, f64)) -> Coupled {
    let (coupling, storage, loss) = match setup.scene.transducer {
        Transducer::Electromagnetic { coupling_v_s_per_m, coil_ohm, load_ohm, inductance_mh } => {
            (coupling_v_s_per_m, dd(inductance_mh) / dd(1e3), dd(coil_ohm) + dd(load_ohm))
        }
        Transducer::Piezoelectric { coupling_n_per_v, capacitance_nf, load_kohm } => {
            (coupling_n_per_v, dd(capacitance_nf) / dd(1e9), dd(1e-3) / dd(load_kohm))
        }
        Transducer::None => (0.0, dd(1.0), dd(0.0)),
    };
    let tone = model.excitation().tones.first();
    let tone =
        tone.map(|tone| (tone.amplitude, tone.frequency, tone.phase + if tone.quarter { 0.25 } else { 0.0 }));
    let (mass, damping) = (model.mass(), model.damping());
    let tone = tone.unwrap_or((0.0, 0.0, 0.0));
    Coupled { mass, damping, stiffness, force, coupling, storage, loss, tone }
}

/// Size of the electrical state that a motion of the model's scales induces: limited by its coupling and by
/// its kinetic energy, and no less than at the start.
pub(super) fn electrical_size(model: &Model, exact: &Coupled) -> f64 {
    let (coupling, decay) = exact.rates();
    let time = model.scales().time;
    let moved = coupling.to_f64().abs() * time / (1.0 + decay.to_f64() * time);
    (exact.amount().to_f64() * model.scales().speed * moved.min(1.0)).max(model.start_electrical().abs())
}

/// The largest relative error of the three states at each sample, with the error allowed at its time.
fn errors(model: &Model, run: &Run, exact: &Coupled) -> Vec<(f64, f64)> {
    let (scales, size) = (model.scales(), electrical_size(model, exact));
    let start = [model.start().0, model.start().1, model.start_electrical()].map(dd);
    let steps = run.summary.steps as f64;
    let error = |sample: &crate::dynamics::Sample| {
        let [x, v, s] = exact.state(start, dd(0.0), dd(sample.t)).map(|value| value.to_f64());
        let mechanical = off(sample.x, x, scales.length).max(off(sample.v, v, scales.speed));
        let progress = (sample.t / model.duration()).max(1.0 / steps);
        let phase = TAU * exact.tone.1 * sample.t * f64::EPSILON;
        (mechanical.max(off(sample.electrical, s, size)), steps * STEP_ERROR * progress + phase)
    };
    run.samples.iter().map(error).collect()
}

/// A variant compared with the closed form of a linear oscillator with a circuit.
fn against(bench: &Bench, name: &'static str, setup: &Setup) -> Result<(Variant, Run), Stopped> {
    let model = setup.model()?;
    let run = bench.run(&model, &even(model.duration(), 41))?;
    let errors = errors(&model, &run, &closed_form(setup, &model, (STIFFNESS, 0.0)));
    let ledger = run.summary.ledger.map_or(f64::NAN, |ledger| ledger.energy_residual);
    let steps = run.summary.steps as f64;
    let variant = Variant::of(name, &run).worst("state at 41 samples", errors).number(
        "energy balance",
        ledger,
        steps * STEP_ERROR,
    );
    Ok((variant, run))
}

pub(super) const STIFF: HardCase = HardCase {
    name: "stiff-circuit",
    problem: "A circuit 1e4 to 1e5 times as fast as an oscillator of 7.96 Hz, shaken at 7 Hz: a coil of 100 \
              ohm with 0.1 mH (1 us), a piezoelectric layer of 1 nF with 1 kohm (1 us), for 0.2 s.",
    answer: "The exponential of the matrix of mass, circuit and drive.",
    conditioning: LINEAR,
    find: |bench| {
        let stiff = [
            ("coil 10 us", coil(5.0, 100.0, 1e-3)),
            ("coil 1 us", coil(5.0, 100.0, 1e-4)),
            ("layer 1 us", layer(1e-3, 1e-9, 1e3)),
        ];
        let variants = stiff.map(|(name, transducer)| Ok(against(bench, name, &sprung(transducer, 0.2))?.0));
        variants.into_iter().collect()
    },
};

pub(super) const STRONG: HardCase = HardCase {
    name: "strong-coupling",
    problem: "A coupling that swings energy between mass and circuit 100 and 1000 times as fast as the \
              oscillator of 7.96 Hz swings, with little loss in the circuit, for 1 s.",
    answer: "The exponential of the matrix of mass, circuit and drive.",
    conditioning: LINEAR,
    find: |bench| {
        // K/sqrt(m S) of 5e3 and 5e4 1/s beside 50 1/s
        let strong = [
            ("coil 100 times", coil(22.36, 0.1, 1e-3)),
            ("coil 1000 times", coil(223.6, 0.1, 1e-3)),
            ("layer 100 times", layer(0.7, 1e-6, 1e6)),
        ];
        let variants = strong.map(|(name, transducer)| Ok(against(bench, name, &sprung(transducer, 1.0))?.0));
        variants.into_iter().collect()
    },
};

pub(super) const NO_INDUCTANCE: HardCase = HardCase {
    name: "no-inductance",
    problem: "A coil of 5 V s/m and 100 ohm whose inductance falls: time constants of 1 ms to 10 us, and 0, \
              beside an oscillator of 7.96 Hz shaken at 7 Hz, for 0.5 s.",
    answer: "The exponential of the matrix of mass, circuit and drive; at 0 a damping of exactly K^2/R in \
             the closed form without a circuit. The distance to that falls with the first power of the time \
             constant.",
    conditioning: LINEAR,
    find: no_inductance,
};

fn no_inductance(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let (coupling, resistance) = (5.0, 100.0);
    let limit = sprung(coil(coupling, resistance, 0.0), 0.5);
    let model = limit.model()?;
    let run = bench.run(&model, &even(model.duration(), 41))?;
    let damped = Oscillator::new(MASS, DAMPING + coupling * (coupling / resistance), STIFFNESS);
    let (scales, forcings) = (model.scales(), tones(&model));
    let pairs = run.samples.iter().map(|sample| {
        let (x, v) = damped.nearest(model.start(), 0.0, sample.t, &forcings);
        let current = model.output(sample).map_or(f64::NAN, |output| output.current);
        let exact = coupling * v / resistance;
        let size = coupling * scales.speed / resistance;
        let error = off(sample.x, x, scales.length).max(off(sample.v, v, scales.speed));
        let progress = (sample.t / model.duration()).max(1.0 / run.summary.steps as f64);
        let phase = TAU * 7.0 * sample.t * f64::EPSILON;
        let allowed = run.summary.steps as f64 * STEP_ERROR * progress + phase;
        (error.max(off(current, exact, size)), allowed)
    });
    let without = Variant::of("none", &run)
        .worst("state and current at 41 samples", pairs)
        .fact("no state of its own", !model.has_electrical_state());
    let mut variants = Vec::new();
    let mut apart = Vec::new();
    for (name, time_constant) in [("1 ms", 1e-3), ("0.1 ms", 1e-4), ("10 us", 1e-5)] {
        let setup = sprung(coil(coupling, resistance, resistance * time_constant), 0.5);
        let (variant, inductive) = against(bench, name, &setup)?;
        let distances = inductive.samples.iter().zip(&run.samples).map(|(a, b)| off(a.x, b.x, scales.length));
        apart.push(distances.fold(0.0, f64::max) / time_constant);
        variants.push(variant);
    }
    // (its next term is of the order of the time constant over the time scale)
    let alike = (apart[1] / apart[2] - 1.0).abs() < 1e-4 / scales.time;
    variants.push(without.fact("distance of the first power", alike && apart[2] > 1.0));
    Ok(variants)
}

pub(super) const OPEN_AND_SHORT: HardCase = HardCase {
    name: "open-and-short",
    problem: "The nominal cubic well between stops at 4 mm, 1.5 g at 3 Hz, e = 0.36, 1 s, from 4 mm with \
              -0.1 m/s: an open piezoelectric layer, a layer and a coil in short circuits, an open coil.",
    answer: "An open layer is a spring of K^2/C: the impacts of that scene without a transducer, by the \
             program in double-double arithmetic. A short-circuited layer and an open coil change no bit; a \
             short-circuited coil is a damping, to the bit.",
    conditioning: "Sensitivity of each impact's time to all data, by the reference.",
    find: open_and_short,
};

fn open_and_short(bench: &Bench) -> Result<Vec<Variant>, Stopped> {
    let nominal = || Setup::nominal(4.0, 0.36, sine(3.0, 14.7, 0.0), 1.0).start(4e-3, -0.1).damping(0.03);
    let (coupling, capacitance) = (0.01, 5e-6);
    let open = nominal().beside(layer(coupling, capacitance, f64::INFINITY), coupling * 4e-3 / capacitance);
    let mut spring = nominal();
    spring.scene.mechanism = Mechanism::Cubic {
        linear_n_per_m: -40.0 + coupling * coupling / capacitance,
        cubic_n_per_m3: 40.0 / 49e-6,
    };
    let mut variants = vec![by_reference(bench, "open layer", (&open, &spring), hard_impacts)?];
    let bare = bench.run(&nominal().model()?, &[])?;
    let coil_damping = 0.5 * (0.5 / 100.0);
    let damped = bench.run(&nominal().damping(0.03 + coil_damping).model()?, &[])?;
    let mut shorted = coil(0.5, 0.0, 0.0);
    if let Transducer::Electromagnetic { coil_ohm, .. } = &mut shorted {
        *coil_ohm = 100.0;
    }
    let mut apart = coil(0.5, f64::INFINITY, 1.0);
    if let Transducer::Electromagnetic { coil_ohm, .. } = &mut apart {
        *coil_ohm = 100.0;
    }
    for (name, transducer, same) in [
        ("short-circuited layer", layer(coupling, capacitance, 0.0), &bare),
        ("short-circuited coil", shorted, &damped),
        ("open coil", apart, &bare),
    ] {
        let run = bench.run(&nominal().beside(transducer, 0.0).model()?, &[])?;
        let equal = run.events == same.events && run.summary.final_x == same.summary.final_x;
        variants.push(Variant::of(name, &run).fact("the same bits", equal && run.events.len() > 10));
    }
    Ok(variants)
}
