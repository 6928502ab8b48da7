//! A map with progress, which Enter stops: a row of CSV for each travel limit and amplitude.
//!
//! `cargo run --release --example sweep`

use std::sync::atomic::{AtomicBool, Ordering};

use interwell::{Error, Progress, Simulation, Sweep, output};

/// The map as CSV.
pub fn map(progress: &Progress) -> Result<String, Error> {
    let simulation = Simulation::preset("nominal-cubic")?.with("run.tolerance", 1e-6)?;
    let sweep = Sweep::over("stops.travel_limit_mm", 2.0..=6.0, 5);
    let sweep = sweep.and("excitation.amplitude_g", 0.5..=1.5, 3);
    Ok(output::csv(&sweep.run(&simulation, progress)?))
}

fn main() -> Result<(), Error> {
    static STOP: AtomicBool = AtomicBool::new(false);
    let has_line = || std::io::stdin().read_line(&mut String::new()).is_ok_and(|bytes| bytes > 0);
    std::thread::spawn(move || STOP.store(has_line(), Ordering::Relaxed));
    let shown = |done: u64, all: Option<u64>| eprint!("\r{done} of {} cells", all.unwrap_or(0));
    print!("{}", map(&Progress::none().reporting_to(&shown).stopped_by(&STOP))?);
    Ok(())
}
