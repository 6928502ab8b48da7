//! A force of the program's own: a cosine between two wells, in place of the mechanism of a scene.
//!
//! `cargo run --example force`

use std::f64::consts::PI;

use interwell::Simulation;
use interwell::dynamics::Request;
use interwell::mechanics::ForceCurve;
use interwell::questions::Error;

/// Wells at -7 and 7 mm, a barrier of 0.5 mJ.
fn force(x: f64) -> f64 {
    0.5 * 0.5e-3 * (PI / 7e-3) * -(PI * x / 7e-3).sin()
}

/// The largest error of the curve in N, and the RMS velocity in m/s.
pub fn run() -> Result<(f64, f64), Error> {
    let curve = ForceCurve::from_fn(force, (-13e-3, 13e-3), 1e-9, &[])?;
    let error = curve.fit().map_or(0.0, |fit| fit.worst_n);
    let simulation = Simulation::preset("nominal-cubic")?.with_force(&curve)?;
    let summary = simulation.run(&Request::default()).summary;
    Ok((error, summary.rms_velocity.unwrap_or(f64::NAN)))
}

fn main() -> Result<(), Error> {
    let (error, speed) = run()?;
    println!("the curve is off by at most {error:.1e} N; RMS velocity {speed:.6} m/s");
    Ok(())
}
