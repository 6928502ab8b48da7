//! Error against cost of one run, the error taken against the same run in some 31 digits:
//! `cargo run --release --example precision`.

use std::sync::Arc;

use anyhow::Result;
use interwell::dynamics::{EventKind, Model, Request, Run};
use interwell::mechanics::Mechanism;
use interwell::scene::Document;

/// Runs of which the fastest is reported.
const REPEATS: usize = 40;

fn main() -> Result<()> {
    println!("| run of 10 s | tolerance | error | steps | CPU, us |");
    println!("| --- | --- | --- | --- | --- |");
    measure("no stops, 1.1 g", &["stops=None", "excitation.amplitude_g=1.1"])?;
    measure("stops at 4 mm, 1.5 g", &[])
}

fn measure(name: &str, settings: &[&str]) -> Result<()> {
    let mut document = Document::load("nominal-cubic")?;
    for setting in settings {
        document.set(setting)?;
    }
    document.check()?;
    let mechanism = Mechanism::build(&document.scene.mechanism, &document.files)
        .map_err(|fault| document.error_from(vec![fault]))?;
    let model = Model::build(&document.scene, Arc::new(mechanism)).map_err(|f| document.error_from(f))?;
    let everything = Request { events: true, ..Request::default() };
    let reference = model.run_reference(&everything, 1e-27);
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
        let mut model = model.clone();
        model.tolerance = tolerance;
        let run = model.run(&everything);
        let fastest =
            (0..REPEATS).map(|_| model.run(&Request::default()).summary.cpu_s).fold(f64::INFINITY, f64::min);
        println!(
            "| {name} | {tolerance:.0e} | {:.1e} | {} | {:.0} |",
            error(&model, &run, &reference),
            run.summary.steps,
            fastest * 1e6
        );
    }
    Ok(())
}

/// The worst of: final displacement over the length scale, RMS velocity, and times of the impacts above
/// 1 cm/s in forcing periods.
fn error(model: &Model, run: &Run, reference: &Run) -> f64 {
    let displacement = (run.summary.final_x - reference.summary.final_x).abs() / model.scales.length;
    let rms = |run: &Run| run.summary.rms_velocity.unwrap_or(f64::NAN);
    let rms = (rms(run) / rms(reference) - 1.0).abs();
    let times = |run: &Run| -> Vec<f64> {
        let hard = |e: &&interwell::dynamics::Event| e.kind == EventKind::Impact && e.v_in.abs() > 1e-2;
        run.events.iter().filter(hard).map(|e| e.t).collect()
    };
    let (mine, exact) = (times(run), times(reference));
    let period = model.forcing_period.unwrap_or(1.0);
    let late = if mine.len() == exact.len() {
        mine.iter().zip(&exact).map(|(a, b)| (a - b).abs() / period).fold(0.0, f64::max)
    } else {
        f64::INFINITY
    };
    displacement.max(rms).max(late)
}
