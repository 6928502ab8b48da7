//! What does a scene model, and what does it leave out? In words, for `check`.

use super::model::{Model, StopAt};
use crate::numeric::short;

/// A line for each thing that is modelled, then what is left out. The force curve and the meaning of a
/// damping ratio are told elsewhere.
pub(crate) fn describe(model: &Model) -> Vec<String> {
    let mut lines = vec![format!("proof mass {} g", short(model.mass * 1e3))];
    let mut absent = Vec::new();
    if model.damping > 0.0 {
        lines.push(format!("viscous damping, c = {} N s/m", short(model.damping)));
    } else {
        absent.push("damping");
    }
    match &model.stops {
        Some(pair) => {
            let stop = |side: &str, at: Option<StopAt>| match at {
                Some(s) => format!("{side} at {} mm with restitution {}", short(s.x * 1e3), s.restitution),
                None => format!("{side} open"),
            };
            lines.push(format!("rigid stops: {}; {}", stop("left", pair.left), stop("right", pair.right)));
        }
        None => absent.push("stops"),
    }
    let drive = &model.drive;
    if drive.constant != 0.0 {
        lines.push(format!("constant base acceleration of {} m/s^2", short(drive.constant)));
    }
    for tone in &drive.tones {
        let size = match tone.ramp {
            Some((from, over)) => {
                format!("{} to {} m/s^2 over {over} s", short(from), short(tone.amplitude))
            }
            None => format!("{} m/s^2", short(tone.amplitude.abs())),
        };
        lines.push(format!("base acceleration: sine of {} Hz, amplitude {size}", short(tone.frequency)));
    }
    if drive.tones.len() > 1 {
        lines.push(match model.forcing_period {
            Some(period) => format!("the excitation repeats after {} s", short(period)),
            None => "the excitation has no common period within reach".into(),
        });
    }
    if drive.constant == 0.0 && drive.tones.is_empty() {
        absent.push("excitation");
    }
    absent.push("transducer");
    lines.push(format!(
        "start at x = {} mm, v = {} m/s; runs {} s, settled after {} s",
        short(model.start.0 * 1e3),
        short(model.start.1),
        short(model.duration),
        short(model.settle)
    ));
    lines.push(format!(
        "tolerance {:e}, relative to {} mm, {} m/s and {} s",
        model.tolerance,
        short(model.scales.length * 1e3),
        short(model.scales.speed),
        short(model.scales.time)
    ));
    lines.push(format!("left out: {}", absent.join(", ")));
    lines
}
