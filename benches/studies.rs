//! Time and error of the studies: `cargo bench --bench studies`.
//!
//! A row a study. The error is against an answer that is known in closed form, named beside it; the time is
//! that of one thread.

mod shared;

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::STANDARD_GRAVITY;
use interwell::study::{
    Branch, BranchEvent, ExponentOptions, Family, Onset, Orbit, Scan, Signal, SpectrumOptions, Task, branch,
    exponents, spectrum, threshold,
};

/// Times that each study is done.
const ROUNDS: usize = 21;

fn main() {
    println!("| study | problem | error | against | CPU |");
    println!("| --- | --- | --- | --- | --- |");
    spectra();
    thresholds();
    branches();
    growth();
}

/// Does `study`, which gives its error, several times, and prints its row.
fn row(study: &str, problem: &str, against: &str, mut work: impl FnMut() -> f64) {
    let mut error = 0.0;
    let rounds = shared::rounds(ROUNDS);
    let mut times: Vec<f64> = (0..rounds).map(|_| shared::cpu(|| error = work())).collect();
    let us = shared::median(&mut times) * 1e6;
    println!("| {study} | {problem} | {error:.1e} | {against} | {us:.1} us |");
}

fn spectra() {
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    let plain =
        SpectrumOptions { signal: Signal::Displacement, taper: None, rate_hz: None, until_settled: None };
    // a linear spring whose transient has died at 10 s
    let changes =
        ["mechanism.cubic_n_per_m3=0", "damping=Coefficient(c_n_s_per_m: 0.2)", "run.tolerance=1e-13"];
    let linear = shared::preset("monostable", &changes);
    let (k, m, c, w) = (40.0, linear.mass(), linear.damping(), TAU * 3.0);
    let exact = m * STANDARD_GRAVITY / (k - m * w * w).hypot(c * w);
    row("spectrum", "linear spring, 30 periods", "its response", || {
        let own = spectrum(&linear, &plain, &task).unwrap().table;
        let amplitude = own.numbers("amplitude").unwrap();
        amplitude.iter().enumerate().fold(0.0, |worst: f64, (line, own)| {
            let exact_here = if line == 30 { exact } else { 0.0 };
            worst.max((own - exact_here).abs() / exact)
        })
    });
    let chaos = shared::preset("duffing-chaos", &[]);
    let rms = chaos.run(&interwell::dynamics::Request::default()).summary.rms_velocity.unwrap();
    row("spectrum", "`duffing-chaos`, 900 periods", "RMS velocity (no taper)", || {
        let options = SpectrumOptions {
            signal: Signal::Velocity,
            taper: Some(interwell::numeric::Taper::None),
            ..plain
        };
        let own = spectrum(&chaos, &options, &task).unwrap().table;
        let (frequency, density) = (own.numbers("frequency_hz").unwrap(), own.numbers("psd").unwrap());
        ((density.iter().sum::<f64>() * frequency[1]).sqrt() / rms - 1.0).abs()
    });
}

fn thresholds() {
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    let document = shared::changed("nominal-cubic", &["excitation.amplitude_g=0.7"]);
    let mechanism =
        interwell::mechanics::Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    let mechanism = std::sync::Arc::new(mechanism);
    let press = -mechanism.curve.force(4e-3);
    let found = |problem: &str, against: &str, scan: Scan, exact: f64| {
        row("threshold", problem, against, || {
            let asked = (&scan, Onset::Release);
            let found = threshold(&document.scene, &mechanism, &document.files, asked, &task).unwrap();
            (found.value.unwrap() / exact - 1.0).abs()
        });
    };
    let even = |from: f64, step: f64| (0..=200).map(|i| from + step * f64::from(i)).collect::<Vec<f64>>();
    let scan = Scan { field: "excitation.amplitude_g".into(), values: even(0.0, 0.01), resolution: 1e-5 };
    let exact = press / document.scene.mass_g * 1e3 / STANDARD_GRAVITY;
    found("release over the amplitude, a formula", "force over weight", scan, exact);
    // over the mass it is searched for
    let scan = Scan { field: "mass_g".into(), values: even(10.0, 0.05), resolution: 1e-9 };
    found(
        "release over the mass, 200 steps to 1e-9 g",
        "force over acceleration",
        scan,
        press / (0.7 * STANDARD_GRAVITY) * 1e3,
    );
}

fn branches() {
    let never = AtomicBool::new(false);
    let task = Task { tick: &|| (), cancel: &never };
    let over = |name: &str, (from, to): (f64, f64), of: &dyn Fn(&Branch) -> f64| {
        let document = shared::changed(name, &[]);
        let mechanism =
            interwell::mechanics::Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
        let mechanism = std::sync::Arc::new(mechanism);
        let field = "excitation.amplitude_g";
        let family = Family::new(&document.scene, &document.files, &mechanism, field);
        of(&branch(&family, field, (from, to), (0.0, Some(1)), &task).unwrap())
    };
    // the swing of the linear spring whose amplitude is the distance of the stop, 1 m
    let (w, c) = (0.7_f64, 0.2);
    let grazing = (1.0 - w * w).hypot(c * w) / STANDARD_GRAVITY;
    row("orbit --branch", "`impact-oscillator`, 166 motions past a grazing", "the grazing", || {
        over("impact-oscillator", (0.05, 0.06), &|found| {
            let at = found.events.iter().position(|own| *own == Some(BranchEvent::Grazing)).unwrap();
            (found.values[at] / grazing - 1.0).abs()
        })
    });
    row("orbit --branch", "`duffing`, 0.1 to 1 g, 195 motions", "the product of the multipliers", || {
        over("duffing", (0.1, 1.0), &|found| {
            let of = |own: &Orbit| (own.jacobian.determinant() / own.determinant() - 1.0).abs();
            found.orbits.iter().map(of).fold(0.0, f64::max)
        })
    });
}

fn growth() {
    let never = AtomicBool::new(false);
    let chaos = shared::preset("duffing-chaos", &[]);
    let options = ExponentOptions { periods: ExponentOptions::PERIODS, until_settled: None };
    row("exponents", "`duffing-chaos`, 1000 periods", "the sum of both", || {
        let found = exponents(&chaos, &options, &never).unwrap();
        (found.sum / found.exact_sum.unwrap() - 1.0).abs()
    });
}
