//! Tables of a built-in scene as CSV, by which a web page and a desktop are compared to the bit.

use crate::interwell::output::csv;
use crate::interwell::questions::{Curve, Error, Progress, Sampling, Simulation, Sweep, Table, Threshold};

/// Number of cells of the sweep.
const CELLS: usize = 13;

/// Number of samples of the run.
const SAMPLES: f64 = 500.0;

/// Samples and events of the run, the force curve, a sweep over the amplitude and the threshold of a built-in
/// scene; of a question that does not apply to the scene, the reason.
pub fn tables(preset: &str) -> Result<String, Error> {
    let (simulation, progress) = (Simulation::preset(preset)?, Progress::none().threads(1));
    let recorded =
        simulation.record(&Sampling::Every(simulation.scene().run.duration_s / SAMPLES), None, &progress)?;
    let sweep = match simulation.scene().harmonic() {
        Some(drive) => Sweep::over(drive.amplitude_path(), 0.1..=1.5, CELLS),
        None => Sweep::over("mass_g", 5.0..=25.0, CELLS),
    };
    let sweep = Sweep { columns: vec!["all".to_owned()], ..sweep };
    let answers = [
        ("samples", Ok(recorded.samples)),
        ("events", Ok(recorded.events)),
        ("curve", Curve::default().run(&simulation)),
        ("sweep", sweep.run(&simulation, &progress)),
        ("threshold", Threshold::default().run(&simulation, &progress)),
    ];
    Ok(answers.map(|(name, answer)| format!("{preset} {name}\n{}", text(answer))).concat())
}

/// The sweep that a built-in scene names, on one processor.
pub fn map(preset: &str) -> Result<String, Error> {
    let table = Sweep::default().run(&Simulation::preset(preset)?, &Progress::none().threads(1))?;
    Ok(csv(&table))
}

fn text(answer: Result<Table, Error>) -> String {
    match answer {
        Ok(table) => csv(&table),
        Err(error) => format!("{error}\n"),
    }
}
