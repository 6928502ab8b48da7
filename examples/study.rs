//! A study of one's own: how often the mass strikes its stops in a forcing period, over the amplitude, each
//! run on from a scene with one field changed.
//!
//! `cargo run --release --example study`

use interwell::dynamics::Request;
use interwell::{Error, Simulation};

/// Amplitudes in g, and impacts in a forcing period of the settled motion.
pub fn impacts(amplitudes_g: &[f64]) -> Result<Vec<(f64, f64)>, Error> {
    let simulation = Simulation::preset("nominal-cubic")?;
    let each = |amplitude_g: &f64| {
        let changed = simulation.with("excitation.amplitude_g", amplitude_g)?;
        let summary = changed.run(&Request { until_settled: Some(100.0), ..Request::default() }).summary;
        Ok((*amplitude_g, summary.impacts as f64 / summary.periods as f64))
    };
    amplitudes_g.iter().map(each).collect()
}

fn main() -> Result<(), Error> {
    for (amplitude_g, impacts) in impacts(&[0.25, 0.5, 0.75, 1.0, 1.25, 1.5])? {
        println!("{amplitude_g} g: {impacts} impacts in a forcing period");
    }
    Ok(())
}
