//! Description of a model in words, for `check`.

use super::excitation::NoisePart;
use super::scales::Scales;
use super::{Model, StopAt};
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
        let [x, v, end, settle] = [self.start.0 * 1e3, self.start.1, self.duration, self.settle].map(short);
        lines.push(format!("start at x = {x} mm, v = {v} m/s; runs {end} s, settled after {settle} s"));
        let Self { tolerance, scales: Scales { length, speed, time, .. }, .. } = self;
        let [length, speed, time] = [length * 1e3, *speed, *time].map(short);
        lines.push(format!("tolerance {tolerance:e}, relative to {length} mm, {speed} m/s and {time} s"));
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
            let frequency = match tone.rate {
                Some(rate) => format!("{} rad/s", short(rate)),
                None => format!("{} Hz", short(tone.frequency)),
            };
            lines.push(format!("base acceleration: sine of {frequency}, amplitude {size}"));
        }
        for noise in &drive.noises {
            let [rms, low, high] = [noise.rms, noise.low, noise.high].map(short);
            let band = format!("{rms} m/s^2 rms from {low} to {high} Hz");
            let NoisePart { lines: sines, seed, .. } = noise;
            lines.push(format!("base acceleration: noise of {band}, {sines} sines, seed {seed}"));
        }
        for chirp in &drive.chirps {
            let [from, to, over, size] = [chirp.from, chirp.to, chirp.over, chirp.amplitude.abs()].map(short);
            let sweep = format!("chirp from {from} to {to} Hz over {over} s");
            lines.push(format!("base acceleration: {sweep}, amplitude {size} m/s^2"));
        }
        for record in &drive.records {
            let [end, peak] = [record.times.last().copied().unwrap_or(0.0), record.peak()].map(short);
            let samples = record.times.len();
            lines.push(format!(
                "base acceleration: record of {samples} samples up to {end} s, peak {peak} m/s^2"
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

/// Impact speeds in m/s at which a compliant stop is described: a slow and a fast one of the prototype.
const SPEEDS: [f64; 2] = [0.1, 0.5];

/// Steps of the integrator per period of the contact's oscillation, measured on the prototype at the default
/// tolerance, for a mass that rests on a compliant stop and follows the drive.
const QUIET_STEPS_PER_PERIOD: f64 = 1.5;

/// The same for an oscillation without loss that reaches the surface.
const RINGING_STEPS_PER_PERIOD: f64 = 36.0;

/// Description of a compliant stop, of an impact on it, and of the cost of a rest on it.
fn compliant(model: &Model, stop: &Hertz, [left, right]: [f64; 2]) -> Vec<String> {
    let [low, high, k, a] = [left * 1e3, right * 1e3, stop.stiffness, stop.loss].map(short);
    let mut lines = vec![format!(
        "compliant stops at {low} and {high} mm: contact by Hertz, k = {k} N/m^1.5, loss by Hunt and \
         Crossley, a = {a} s/m"
    )];
    for speed in SPEEDS {
        let force = stop.peak_force(model.mass, speed);
        let pressure = stop.pressure(force).map(|pressure| format!(", {} GPa", short(pressure / 1e9)));
        let pressure = pressure.unwrap_or_default();
        let (time, depth) = (stop.contact_time(model.mass, speed), stop.depth(model.mass, speed));
        let [ms, e, um, n] = [time * 1e3, stop.restitution(speed), depth * 1e6, force].map(short);
        lines.push(format!(
            "an impact at {speed} m/s on one: {ms} ms of contact, restitution {e}, {um} um deep, \
             {n} N{pressure}"
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
        let (quiet, ringing) = (steps(QUIET_STEPS_PER_PERIOD), steps(RINGING_STEPS_PER_PERIOD));
        let [hz, um, quiet, ringing] = [frequency, depth * 1e6, quiet, ringing].map(short);
        lines.push(format!(
            "a mass that rests on one oscillates at {hz} Hz about a depth of {um} um, and this is \
             integrated: a second takes about {quiet} steps while it is quiet and up to {ringing} while it \
             rings"
        ));
    }
    lines
}
