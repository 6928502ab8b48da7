//! One run: a scene as text, and the summary of its motion.
//!
//! `cargo run --example run`

use interwell::dynamics::Request;
use interwell::{Error, Simulation};

const SCENE: &str = r#"(
    title: "Two wells at 7 mm, stops at 4 mm",
    mass_g: 15.2,
    mechanism: DoubleWell(equilibrium_mm: 7.0, barrier_mj: 0.49),
    damping: Ratio(0.023),
    stops: Rigid(travel_limit_mm: 4.0, restitution: 0.36),
    excitation: Sine(frequency_hz: 3.0, amplitude_g: 1.5),
    run: (duration_s: 10.0, settle_s: 5.0, tolerance: 1e-9),
)"#;

/// The summary in words.
pub fn run() -> Result<String, Error> {
    let simulation = Simulation::from_text("example.ron", SCENE)?;
    let summary = simulation.run(&Request::default()).summary;
    let speed = summary.rms_velocity.unwrap_or(f64::NAN);
    Ok(format!("{}, {} impacts, RMS velocity {speed:.6} m/s", summary.regime.name(), summary.impacts))
}

fn main() -> Result<(), Error> {
    println!("{}", run()?);
    Ok(())
}
