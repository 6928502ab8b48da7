//! One run: a scene as text, made into a model and run; its summary on standard output.
//!
//! `cargo run --example run`

use std::error::Error;
use std::sync::Arc;

use interwell::dynamics::{EventKind, Model, Request};
use interwell::mechanics::Mechanism;
use interwell::scene::{Document, Files};

const SCENE: &str = r#"(
    title: "Two wells at 7 mm, stops at 4 mm",
    mass_g: 15.2,
    mechanism: DoubleWell(equilibrium_mm: 7.0, barrier_mj: 0.49),
    damping: Ratio(0.023),
    stops: Rigid(travel_limit_mm: 4.0, restitution: 0.36),
    excitation: Sine(frequency_hz: 3.0, amplitude_g: 1.5),
    run: (duration_s: 10.0, settle_s: 5.0, tolerance: 1e-9),
)"#;

/// The summary of the run as text.
pub fn run() -> Result<String, Box<dyn Error>> {
    // As written. A scene that names a table or a record would find it through `Files`.
    let document = Document::from_text("example.ron", SCENE, Files::default())?;
    document.check()?;

    // As run: a force curve with its wells and barrier, then a model in SI units.
    let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files)?);
    let wells = mechanism.landscape.barrier.ok_or("one well only")?;
    let model = Model::build(&document.scene, mechanism).map_err(|faults| document.error_from(faults))?;

    // Events and the energy ledger are kept where they are asked for.
    let run = model.run(&Request { events: true, ledger: true, ..Request::default() });
    let summary = &run.summary;
    let first = run.events.iter().find(|event| event.kind == EventKind::Release).ok_or("it stays at rest")?;
    let ledger = summary.ledger.ok_or("no ledger")?;
    Ok(format!(
        "barrier         {:.3} mJ\n\
         first release   {:.6} s\n\
         regime          {}, period {}\n\
         crossings       {} in {} forcing periods\n\
         impacts         {}\n\
         RMS velocity    {:.6} m/s\n\
         lost at stops   {:.1} % of the work of the base\n",
        1e3 * wells.from_right_j,
        first.t,
        summary.regime.name(),
        summary.period.map_or("none".to_owned(), |period| period.to_string()),
        summary.crossings,
        summary.periods,
        summary.impacts,
        summary.rms_velocity.ok_or("it ended early")?,
        100.0 * ledger.impact_j / ledger.work_j,
    ))
}

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", run()?);
    Ok(())
}
