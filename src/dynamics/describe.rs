//! What does a scene model, and what does it leave out? In words, for `check`.

use super::model::{Model, StopAt};

/// A line for each thing that is modelled, then what is left out.
pub(crate) fn describe(model: &Model) -> Vec<String> {
    let mut lines = Vec::new();
    let mut absent = Vec::new();
    let curve = &model.mechanism.curve;
    lines.push(format!(
        "proof mass {:.6} kg on a force curve of {}",
        model.mass,
        pieces(curve.pieces().len())
    ));
    if model.damping > 0.0 {
        lines.push(format!("viscous damping, c = {:.6} N s/m", model.damping));
    } else {
        absent.push("damping");
    }
    match &model.stops {
        Some(pair) => {
            let stop = |name: &str, at: Option<StopAt>| match at {
                Some(s) => format!("{name} at {:.6} mm with restitution {}", s.x * 1e3, s.restitution),
                None => format!("none on the {name}"),
            };
            lines.push(format!("rigid stops: {}; {}", stop("left", pair.left), stop("right", pair.right)));
        }
        None => absent.push("stops"),
    }
    let drive = &model.drive;
    if drive.constant != 0.0 {
        lines.push(format!("constant base acceleration {:.6} m/s^2", drive.constant));
    }
    for tone in &drive.tones {
        let size = match tone.ramp {
            Some((from, over)) => format!("amplitude {from:.6} to {:.6} m/s^2 over {over} s", tone.amplitude),
            None => format!("amplitude {:.6} m/s^2", tone.amplitude.abs()),
        };
        lines.push(format!("sine of {} Hz, {size}", tone.frequency));
    }
    if drive.tones.len() > 1 {
        lines.push(match model.forcing_period {
            Some(period) => format!("the drive repeats after {period:.9} s"),
            None => "the drive has no common period within reach".into(),
        });
    }
    if drive.constant == 0.0 && drive.tones.is_empty() {
        absent.push("excitation");
    }
    absent.push("transducer");
    lines.push(format!(
        "start at x = {:.6} mm, v = {:.6} m/s; {} s, settled after {} s",
        model.start.0 * 1e3,
        model.start.1,
        model.duration,
        model.settle
    ));
    lines.push(format!(
        "tolerance {:e} relative to {:.4e} m, {:.4e} m/s, {:.4e} s",
        model.tolerance, model.scales.length, model.scales.speed, model.scales.time
    ));
    lines.push(format!("left out: {}", absent.join(", ")));
    lines
}

fn pieces(count: usize) -> String {
    if count == 1 { "one polynomial".into() } else { format!("{count} polynomial pieces") }
}
