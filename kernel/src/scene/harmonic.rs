//! Drives of one frequency as accelerations of the base.

use super::data::{Excitation, Scene};
use super::unit::{STANDARD_GRAVITY, unit_ending};
use crate::numeric::short;

/// A field that scales the drive of a scene, or one of the drives that it sums.
#[derive(Debug, Clone, PartialEq)]
pub struct Amplitude {
    /// Path of the field.
    pub path: String,
    /// As in [`Harmonic`].
    acceleration_of_one: [f64; 2],
}

impl Amplitude {
    /// The value of the field for this acceleration of the base in m/s^2, of a noise its root mean square.
    pub fn of(&self, acceleration: f64) -> f64 {
        acceleration * self.acceleration_of_one[1] / self.acceleration_of_one[0]
    }
}

/// A drive of one frequency, as the base acceleration with the same motion, `acceleration`
/// sin(2 pi `frequency_hz` t + `phase_deg` + 90 degrees times `quarters`): a force F(t) on the mass m moves
/// it as the base acceleration -F(t)/m does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Frequency in Hz.
    pub frequency_hz: f64,
    /// Amplitude of the base acceleration in m/s^2, of any sign.
    pub acceleration: f64,
    /// Phase in degrees as the scene has it.
    pub phase_deg: f64,
    /// Quarter turns from that phase to the phase of a sine of the base acceleration: 0, 1 or 3.
    pub quarters: i64,
    /// Angular frequency in rad/s, where the scene gives that in place of a frequency in Hz.
    pub rate: Option<f64>,
    amplitude: f64,
    path: &'static str,
    /// Base acceleration in m/s^2 of an amplitude of 1 in the unit of the field, as a numerator and a
    /// denominator.
    acceleration_of_one: [f64; 2],
}

impl Excitation {
    /// This drive as an acceleration of the base, for a proof mass in kg; `None` unless it has one frequency
    /// and one amplitude. A sum gives `None`.
    pub fn harmonic(&self, mass: f64) -> Option<Harmonic> {
        let (amplitude, frequency, phase_deg, quarters, path, of_one) = match *self {
            Self::Sine { frequency_hz, amplitude_g, phase_deg } => {
                let of_one = [STANDARD_GRAVITY, 1.0];
                (amplitude_g, Ok(frequency_hz), phase_deg, 0, "excitation.amplitude_g", of_one)
            }
            Self::Cosine { amplitude_m_per_s2, frequency_rad_per_s, phase_deg } => {
                let path = "excitation.amplitude_m_per_s2";
                (amplitude_m_per_s2, Err(frequency_rad_per_s), phase_deg, 1, path, [1.0, 1.0])
            }
            // -cos is the sine three quarters of a turn later
            Self::Force { amplitude_n, frequency_rad_per_s, phase_deg } => {
                (amplitude_n, Err(frequency_rad_per_s), phase_deg, 3, "excitation.amplitude_n", [1.0, mass])
            }
            _ => return None,
        };
        Some(Harmonic {
            frequency_hz: frequency.unwrap_or_else(|rate| rate / std::f64::consts::TAU),
            acceleration: amplitude * of_one[0] / of_one[1],
            phase_deg,
            quarters,
            rate: frequency.err(),
            amplitude,
            path,
            acceleration_of_one: of_one,
        })
    }

    /// The fields that scale this drive at `path`, or those that it sums, for a proof mass in kg. A constant
    /// acceleration has one only where it is the whole drive: in a sum it is what the others shake about.
    fn amplitudes(&self, path: &str, mass: f64) -> Vec<Amplitude> {
        let (name, acceleration_of_one) = match self {
            Self::Sum(all) => {
                let one = |(i, one): (usize, &Self)| match one {
                    Self::Constant { .. } => Vec::new(),
                    one => one.amplitudes(&format!("{path}.{i}"), mass),
                };
                return all.iter().enumerate().flat_map(one).collect();
            }
            Self::None | Self::Recorded { .. } => return Vec::new(),
            Self::Constant { .. } => ("accel_g", [STANDARD_GRAVITY, 1.0]),
            Self::Sine { .. } | Self::Chirp { .. } => ("amplitude_g", [STANDARD_GRAVITY, 1.0]),
            Self::AmplitudeRamp { .. } => ("to_g", [STANDARD_GRAVITY, 1.0]),
            Self::Noise { .. } => ("rms_g", [STANDARD_GRAVITY, 1.0]),
            Self::Cosine { .. } => ("amplitude_m_per_s2", [1.0, 1.0]),
            Self::Force { .. } => ("amplitude_n", [1.0, mass]),
        };
        vec![Amplitude { path: format!("{path}.{name}"), acceleration_of_one }]
    }

    /// The amplitude of a drive of one frequency, in the unit of its field.
    pub fn amplitude_mut(&mut self) -> Option<&mut f64> {
        match self {
            Self::Sine { amplitude_g: amplitude, .. }
            | Self::Cosine { amplitude_m_per_s2: amplitude, .. }
            | Self::Force { amplitude_n: amplitude, .. } => Some(amplitude),
            _ => None,
        }
    }
}

impl Scene {
    /// The drive as an acceleration of the base, if it has one frequency and one amplitude.
    pub fn harmonic(&self) -> Option<Harmonic> {
        self.excitation.harmonic(self.mass_g / 1e3)
    }

    /// The fields that scale the drive, or the drives that it sums: none of a record, several of most sums.
    pub fn amplitudes(&self) -> Vec<Amplitude> {
        self.excitation.amplitudes("excitation", self.mass_g / 1e3)
    }
}

impl Harmonic {
    /// Amplitude in the unit of its field.
    pub fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// Path of the field of the amplitude.
    pub fn amplitude_path(&self) -> &'static str {
        self.path
    }

    /// The frequency in the unit of its field, such as `3 Hz` or `1 rad/s`.
    pub fn frequency_in_words(&self) -> String {
        match self.rate {
            Some(rate) => format!("{} rad/s", short(rate)),
            None => format!("{} Hz", short(self.frequency_hz)),
        }
    }

    /// Path of the field of the frequency.
    pub fn frequency_path(&self) -> &'static str {
        match self.rate {
            Some(_) => "excitation.frequency_rad_per_s",
            None => "excitation.frequency_hz",
        }
    }

    /// Unit of the amplitude, as a person writes it.
    pub fn unit(&self) -> &'static str {
        unit_ending(self.path).map_or("", |(_, unit)| unit)
    }

    /// The amplitude, in the unit of its field, with which the base has this acceleration in m/s^2.
    pub fn amplitude_of(&self, acceleration: f64) -> f64 {
        acceleration * self.acceleration_of_one[1] / self.acceleration_of_one[0]
    }

    /// Amplitude in g: of a [`Sine`](Excitation::Sine) as the scene has it.
    pub fn amplitude_g(&self) -> f64 {
        match self.rate {
            Some(_) => self.acceleration / STANDARD_GRAVITY,
            None => self.amplitude,
        }
    }

    /// The phase of a sine of the base acceleration: whole quarter turns, 0 to 3, and the rest in turns, at
    /// least 0 and below a quarter. Exact, since the remainder and the multiple of 90 degrees are.
    pub fn turns(&self) -> (i64, f64) {
        let reduced = self.phase_deg.rem_euclid(360.0);
        let quarters = (reduced / 90.0).floor();
        ((quarters as i64 + self.quarters) & 3, (reduced - 90.0 * quarters) / 360.0)
    }

    /// A [`Sine`](Excitation::Sine) with the same motion of this mass, to rounding; a sine as it is.
    pub fn sine(&self) -> Excitation {
        let (quarters, rest) = self.turns();
        let phase_deg = match self.rate {
            Some(_) => 90.0 * quarters as f64 + 360.0 * rest,
            None => self.phase_deg,
        };
        Excitation::Sine { frequency_hz: self.frequency_hz, amplitude_g: self.amplitude_g(), phase_deg }
    }
}
