//! A study of one's own: the least amplitude that frees the mass from the stop that it rests on, over travel
//! limits.
//!
//! The mass is pressed on the stop at D by the force of the mechanism, -F(D). A sine lifts it off once its
//! amplitude passes -F(D)/m. This finds the amplitude by bisection over whole runs, and compares it with that
//! closed form.
//!
//! `cargo run --example least_amplitude`

use std::error::Error;
use std::sync::Arc;

use interwell::dynamics::{EventKind, Model, Request, STANDARD_GRAVITY};
use interwell::mechanics::Mechanism;
use interwell::scene::{Document, Excitation, Scene, Stops};

/// A travel limit in mm, the least amplitude that was found, and that of the closed form, both in g.
pub type Row = (f64, f64, f64);

/// Whether a mass that starts at rest leaves its stop within a forcing period.
fn is_released(scene: &Scene, mechanism: &Arc<Mechanism>) -> Result<bool, Box<dyn Error>> {
    let model = Model::build(scene, Arc::clone(mechanism)).map_err(|faults| format!("{faults:?}"))?;
    let run = model.run(&Request { events: true, ..Request::default() });
    Ok(run.events.iter().any(|event| event.kind == EventKind::Release))
}

/// A row for each travel limit.
pub fn run(travel_limits_mm: &[f64]) -> Result<Vec<Row>, Box<dyn Error>> {
    let document = Document::load("nominal-cubic")?;
    let mechanism = Arc::new(Mechanism::build(&document.scene.mechanism, &document.files)?);
    let mut scene = document.scene;
    (scene.run.duration_s, scene.run.settle_s) = (1.0 / 3.0, None);
    let mut rows = Vec::new();
    for &travel_limit_mm in travel_limits_mm {
        scene.stops = Stops::Rigid { travel_limit_mm, restitution: 0.36 };
        let (mut low, mut high) = (0.0, 10.0);
        while high - low > 1e-9 {
            let amplitude_g = 0.5 * (low + high);
            scene.excitation = Excitation::Sine { frequency_hz: 3.0, amplitude_g, phase_deg: 0.0 };
            if is_released(&scene, &mechanism)? { high = amplitude_g } else { low = amplitude_g }
        }
        let force = mechanism.curve.force(1e-3 * travel_limit_mm);
        rows.push((travel_limit_mm, high, -force / (1e-3 * scene.mass_g) / STANDARD_GRAVITY));
    }
    Ok(rows)
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("travel limit, mm   found, g       closed form, g");
    for (travel_limit_mm, found, closed_form) in run(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])? {
        println!("{travel_limit_mm:16}   {found:.9}    {closed_form:.9}");
    }
    Ok(())
}
