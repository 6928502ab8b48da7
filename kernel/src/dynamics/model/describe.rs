//! Description of a model in words, for `check`.

use crate::dynamics::model::{Model, StopAt};
use crate::mechanics::Hertz;
use crate::numeric::{number_text, short};

impl Model {
    /// The model in words: a line for each part that is modelled, then the parts left out. The force curve
    /// and the meaning of a damping ratio are described elsewhere.
    pub fn describe(&self) -> Vec<String> {
        let mut lines = vec![format!("proof mass {} g", short(self.mass * 1e3))];
        let mut absent = Vec::new();
        if self.damping > 0.0 {
            lines.push(format!("viscous damping, c = {} N s/m", short(self.damping)));
        } else {
            absent.push("damping");
        }
        match (&self.compliant, self.sides()) {
            (_, (None, None)) => absent.push("stops"),
            (Some(hertz), (Some(left), Some(right))) => {
                lines.extend(compliant(self, hertz, [left.x, right.x]));
            }
            (_, (left, right)) => {
                let [left, right] = [("left", left), ("right", right)].map(|(side, stop)| match stop {
                    Some(StopAt { x, restitution }) => {
                        let restitution = number_text(restitution);
                        format!("{side} at {} mm with restitution {restitution}", short(x * 1e3))
                    }
                    None => format!("{side} open"),
                });
                lines.push(format!("rigid stops: {left}; {right}"));
            }
        }
        let excitation = self.describe_excitation();
        if excitation.is_empty() {
            absent.push("excitation");
        }
        lines.extend(excitation);
        match &self.transducer {
            Some(transducer) => {
                lines.push(transducer.describe());
                lines.extend(self.fast_circuit());
            }
            None => absent.push("transducer"),
        }
        lines.push(format!(
            "start at x = {} mm, v = {} m/s; runs {} s, settled after {} s",
            short(self.start.0 * 1e3),
            short(self.start.1),
            short(self.duration),
            short(self.settle)
        ));
        lines.push(format!(
            "tolerance {:e}, relative to {} mm, {} m/s and {} s",
            self.tolerance,
            short(self.scales.length * 1e3),
            short(self.scales.speed),
            short(self.scales.time)
        ));
        if !absent.is_empty() {
            lines.push(format!("left out: {}", absent.join(", ")));
        }
        lines
    }

    /// The constant acceleration, the tones, noises, chirps and records of the base, each in a line.
    fn describe_excitation(&self) -> Vec<String> {
        let drive = &self.excitation;
        let mut lines = Vec::new();
        if drive.constant != 0.0 {
            lines.push(format!("constant base acceleration of {} m/s^2", short(drive.constant)));
        }
        for tone in drive.tones.iter().filter(|t| !t.noise) {
            let size = match tone.ramp {
                Some((from, over)) => {
                    format!("{} to {} m/s^2 over {} s", short(from), short(tone.amplitude), short(over))
                }
                None => format!("{} m/s^2", short(tone.amplitude.abs())),
            };
            lines.push(format!("base acceleration: sine of {} Hz, amplitude {size}", short(tone.frequency)));
        }
        for noise in &drive.noises {
            lines.push(format!(
                "base acceleration: noise of {} m/s^2 rms from {} to {} Hz, {} sines, seed {}",
                short(noise.rms),
                short(noise.low),
                short(noise.high),
                noise.lines,
                noise.seed
            ));
        }
        for chirp in &drive.chirps {
            lines.push(format!(
                "base acceleration: chirp from {} to {} Hz over {} s, amplitude {} m/s^2",
                short(chirp.from),
                short(chirp.to),
                short(chirp.over),
                short(chirp.amplitude.abs())
            ));
        }
        for record in &drive.records {
            lines.push(format!(
                "base acceleration: record of {} samples up to {} s, peak {} m/s^2",
                record.times.len(),
                short(record.times.last().copied().unwrap_or(0.0)),
                short(record.peak())
            ));
        }
        if drive.fastest().is_some() && drive.tones.iter().filter(|t| !t.noise).count() > 1 {
            lines.push(match self.forcing_period {
                Some(period) => format!("the excitation repeats after {} s", short(period)),
                None => "the excitation has no common period within reach".into(),
            });
        }
        lines
    }
}

/// Impact speeds in m/s at which a compliant stop is described: a gentle one and a hard one of the prototype.
const SPEEDS: [f64; 2] = [0.1, 0.5];

/// Steps of the integrator in a period of the oscillation on a compliant stop, measured on the prototype at
/// the default tolerance: in a quiet rest, whose depth follows the drive, and in an oscillation without loss
/// that reaches the surface.
const STEPS_PER_PERIOD: (f64, f64) = (1.5, 36.0);

/// Description of a compliant stop, of an impact on it, and of the cost of a rest on it.
fn compliant(model: &Model, stop: &Hertz, [left, right]: [f64; 2]) -> Vec<String> {
    let mut lines = vec![format!(
        "compliant stops at {} and {} mm: contact by Hertz, k = {} N/m^1.5, loss by Hunt and Crossley, \
         a = {} s/m",
        short(left * 1e3),
        short(right * 1e3),
        short(stop.stiffness),
        short(stop.loss)
    )];
    for speed in SPEEDS {
        let force = stop.peak_force(model.mass, speed);
        let pressure = stop.pressure(force).map(|pressure| format!(", {} GPa", short(pressure / 1e9)));
        lines.push(format!(
            "an impact at {speed} m/s on one: {} ms of contact, restitution {}, {} um deep, {} N{}",
            short(stop.contact_time(model.mass, speed) * 1e3),
            short(stop.restitution(speed)),
            short(stop.depth(model.mass, speed) * 1e6),
            short(force),
            pressure.unwrap_or_default()
        ));
    }
    if let Some(material) = stop.material {
        lines.push(format!(
            "the contact yields from {} GPa on, 1.6 times the yield strength; that is not modelled",
            short(material.yield_pressure() / 1e9)
        ));
    }
    // Pressed by the mechanism alone, at the right-hand stop.
    let pressed = -model.mechanism.curve.force(right);
    if pressed > 0.0 {
        let depth = stop.static_depth(pressed);
        let stiffness = 1.5 * stop.stiffness * depth.sqrt();
        let frequency = (stiffness / model.mass).sqrt() / std::f64::consts::TAU;
        let steps = |of_a_period: f64| match frequency * of_a_period {
            many if many >= 1.0 => many.round(),
            few => few,
        };
        lines.push(format!(
            "resting on one is an oscillation of {} Hz about a depth of {} um, and it is followed: each \
             second of it takes some {} steps where it is quiet and up to {} where it trembles",
            short(frequency),
            short(depth * 1e6),
            short(steps(STEPS_PER_PERIOD.0)),
            short(steps(STEPS_PER_PERIOD.1))
        ));
    }
    lines
}
