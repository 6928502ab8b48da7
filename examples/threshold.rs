//! The least amplitude that frees the mass from its stop, over travel limits.
//!
//! `cargo run --release --example threshold`

use interwell::questions::Onset;
use interwell::{Error, Progress, Simulation, Threshold};

/// Travel limits in mm and amplitudes in g.
pub fn released(travel_limits_mm: &[f64]) -> Result<Vec<(f64, f64)>, Error> {
    let simulation = Simulation::preset("nominal-cubic")?;
    let question = Threshold {
        of: Onset::Release,
        resolution: Some(1e-9),
        ..Threshold::over_values("stops.travel_limit_mm", travel_limits_mm)
    };
    let table = question.run(&simulation, &Progress::none())?;
    let values = table.numbers("value").unwrap_or_default();
    Ok(travel_limits_mm.iter().copied().zip(values.iter().copied()).collect())
}

fn main() -> Result<(), Error> {
    for (travel_limit_mm, amplitude_g) in released(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])? {
        println!("{travel_limit_mm} mm: {amplitude_g:.9} g");
    }
    Ok(())
}
