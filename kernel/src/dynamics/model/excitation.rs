//! Excitation of a scene in SI: the sum of its parts.

use std::f64::consts::TAU;
use std::sync::Arc;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::numeric::{Ratio, elementary, greatest_common_divisor};
use crate::scene::{Excitation, Fault, Harmonic, Record};

pub use crate::scene::STANDARD_GRAVITY;

/// Longest common period of several tones, in periods of the fastest.
const LONGEST_COMMON_PERIOD: u64 = 10_000;

/// Multiple of its root mean square that a noise rarely exceeds.
const NOISE_PEAK: f64 = 3.0;

/// Whether the drive repeats.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Rhythm {
    Periodic,
    /// The drive has no period, or its amplitude changes from one period to the next.
    Changing,
    Absent,
}

/// Base acceleration in SI: the sum of a constant, tones, chirps and records.
#[doc(hidden)]
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct ExcitationParts {
    /// Constant acceleration in m/s^2.
    pub constant: f64,
    /// Sines, including the lines of each noise.
    pub tones: Vec<TonePart>,
    /// Chirps.
    pub chirps: Vec<ChirpPart>,
    /// Recorded accelerations.
    pub records: Vec<Arc<Record>>,
    /// Parameters of each noise among the tones.
    pub noises: Vec<NoisePart>,
}

/// amplitude sin(2 pi frequency t + phase). SI.
#[doc(hidden)]
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct TonePart {
    /// Amplitude in m/s^2, after the ramp if there is one; any sign.
    pub amplitude: f64,
    /// Frequency in Hz.
    pub frequency: f64,
    /// Angular frequency in rad/s, where the scene gives that in place of a frequency in Hz.
    pub rate: Option<f64>,
    /// Phase in turns without the quarter turn, 0 <= phase < 1.
    pub phase: f64,
    /// Whether the tone is a quarter turn ahead.
    pub quarter: bool,
    /// Amplitude at time 0 and length of the ramp in s.
    pub ramp: Option<(f64, f64)>,
    /// Whether the tone is one line of a noise.
    pub noise: bool,
}

impl TonePart {
    /// Magnitude in m/s^2 of the largest amplitude.
    pub(crate) fn largest(&self) -> f64 {
        self.amplitude.abs().max(self.ramp.map_or(0.0, |(from, _)| from.abs()))
    }

    fn of(drive: Harmonic) -> Self {
        let (quarters, phase) = drive.turns();
        Self {
            amplitude: if quarters >= 2 { -drive.acceleration } else { drive.acceleration },
            frequency: drive.frequency_hz,
            rate: drive.rate,
            phase,
            quarter: quarters % 2 == 1,
            ramp: None,
            noise: false,
        }
    }

    /// Frequency over that of another tone, if both are written in the same unit and the ratio of the
    /// decimals has a small enough numerator and denominator.
    pub(crate) fn ratio_to(&self, other: &Self) -> Option<Ratio> {
        match (self.rate, other.rate) {
            (Some(rate), Some(other)) => Ratio::of_decimals(rate, other),
            _ => Ratio::of_decimals(self.frequency, other.frequency),
        }
    }

    /// Amplitude in m/s^2 at a time in s.
    fn amplitude_at(&self, t: f64) -> f64 {
        match self.ramp {
            Some((from, over)) => from + (self.amplitude - from) * (t / over).min(1.0),
            None => self.amplitude,
        }
    }
}

/// amplitude sin(2 pi (from t + (to - from) t^2/(2 over))), then holding `to`. SI.
#[doc(hidden)]
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ChirpPart {
    /// Amplitude in m/s^2.
    pub amplitude: f64,
    /// Frequency in Hz at time 0.
    pub from: f64,
    /// Frequency in Hz from the chirp's end on.
    pub to: f64,
    /// Length of the chirp in s.
    pub over: f64,
}

/// Parameters of a noise. SI.
#[doc(hidden)]
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct NoisePart {
    /// Root mean square in m/s^2.
    pub rms: f64,
    /// Lower end of its band in Hz.
    pub low: f64,
    /// Upper end of its band in Hz.
    pub high: f64,
    /// Seed of its random numbers.
    pub seed: u64,
    /// Number of its lines.
    pub lines: u64,
}

impl ExcitationParts {
    /// The drive of a proof mass in kg. Fails if a record has not been read.
    pub(crate) fn new(excitation: &Excitation, mass: f64) -> Result<Self, Fault> {
        let mut parts = Self::default();
        parts.add(excitation, mass, "excitation")?;
        Ok(parts)
    }

    fn add(&mut self, excitation: &Excitation, mass: f64, path: &str) -> Result<(), Fault> {
        match excitation {
            Excitation::None => {}
            Excitation::Sine { .. } | Excitation::Cosine { .. } | Excitation::Force { .. } => {
                self.tones.extend(excitation.harmonic(mass).map(TonePart::of));
            }
            Excitation::Constant { accel_g } => self.constant += accel_g * STANDARD_GRAVITY,
            Excitation::AmplitudeRamp { frequency_hz, from_g, to_g, over_s } => self.tones.push(TonePart {
                amplitude: to_g * STANDARD_GRAVITY,
                frequency: *frequency_hz,
                rate: None,
                phase: 0.0,
                quarter: false,
                ramp: Some((from_g * STANDARD_GRAVITY, *over_s)),
                noise: false,
            }),
            Excitation::Chirp { from_hz, to_hz, over_s, amplitude_g } => self.chirps.push(ChirpPart {
                amplitude: amplitude_g * STANDARD_GRAVITY,
                from: *from_hz,
                to: *to_hz,
                over: *over_s,
            }),
            Excitation::Noise { rms_g, low_hz, high_hz, seed, lines } => {
                let rms = rms_g * STANDARD_GRAVITY;
                self.noise(NoisePart { rms, low: *low_hz, high: *high_hz, seed: *seed, lines: *lines });
            }
            Excitation::Recorded { path: file, record } => match record {
                Some(record) => self.records.push(Arc::clone(record)),
                None => {
                    let problem = "has not been read: take the scene from a document";
                    return Err(Fault::new(format!("{path}.path"), file, problem));
                }
            },
            Excitation::Sum(terms) => {
                for (i, term) in terms.iter().enumerate() {
                    self.add(term, mass, &format!("{path}.{i}"))?;
                }
            }
        }
        Ok(())
    }

    /// Sines f_k = low + (k + u_k) (high - low)/lines, each of amplitude rms sqrt(2/lines), phases and u_k
    /// uniform in \[0, 1) from ChaCha8 seeded with `seed`: for each line first u, then the phase, each from
    /// the upper 53 bits of 64. Stable across versions and machines, the same for any duration.
    fn noise(&mut self, noise: NoisePart) {
        let mut random = ChaCha8Rng::seed_from_u64(noise.seed);
        let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let lines = noise.lines as f64;
        let amplitude = noise.rms * (2.0 / lines).sqrt();
        for k in 0..noise.lines {
            let frequency = noise.low + (k as f64 + uniform()) * (noise.high - noise.low) / lines;
            let phase = uniform();
            // a line at 0 Hz would be a constant
            let frequency = frequency.max(f64::MIN_POSITIVE);
            let quarter = false;
            let line = TonePart { amplitude, frequency, rate: None, phase, quarter, ramp: None, noise: true };
            self.tones.push(line);
        }
        self.noises.push(noise);
    }

    /// Whether it has neither chirps nor records; it may have a constant.
    pub(crate) fn has_only_tones(&self) -> bool {
        self.chirps.is_empty() && self.records.is_empty()
    }

    /// Whether the acceleration is always 0.
    pub(crate) fn is_still(&self) -> bool {
        self.constant == 0.0
            && self.tones.iter().all(|t| t.largest() == 0.0)
            && self.chirps.iter().all(|c| c.amplitude == 0.0)
            && self.records.iter().all(|r| r.peak() == 0.0)
    }

    /// Acceleration in m/s^2 at a time in s since the start, without records; odd in the amplitudes.
    pub(crate) fn at(&self, t: f64) -> f64 {
        let tones = self.tones.iter().map(|tone| {
            let quarter = if tone.quarter { 0.25 } else { 0.0 };
            tone.amplitude_at(t) * elementary::sin(TAU * (tone.frequency * t + tone.phase + quarter))
        });
        let chirps = self.chirps.iter().map(|chirp| {
            let swept = t.min(chirp.over);
            let turns = chirp.from * swept + (chirp.to - chirp.from) * swept * swept / (2.0 * chirp.over);
            chirp.amplitude * elementary::sin(TAU * (turns + chirp.to * (t - swept)))
        });
        self.constant + tones.chain(chirps).sum::<f64>()
    }

    /// Whether the acceleration is constant.
    pub fn is_constant(&self) -> bool {
        Self { constant: 0.0, ..self.clone() }.is_still()
    }

    /// Whether it repeats; `common` is the result of [`common_cycles`](Self::common_cycles).
    pub(crate) fn rhythm(&self, common: Option<u64>) -> Rhythm {
        match common {
            _ if self.tones.is_empty() && self.has_only_tones() => Rhythm::Absent,
            Some(_) if self.tones.iter().all(|tone| tone.ramp.is_none()) => Rhythm::Periodic,
            _ => Rhythm::Changing,
        }
    }

    /// Magnitude of the amplitude in m/s^2 at a time in s, if the drive is one ramp.
    pub(crate) fn ramped_amplitude(&self, t: f64) -> Option<f64> {
        match self.tones.as_slice() {
            [tone] if tone.ramp.is_some() && self.constant == 0.0 && self.has_only_tones() => {
                Some(tone.amplitude_at(t).abs())
            }
            _ => None,
        }
    }

    /// Amplitude in m/s^2 and angular frequency in 1/s (0 for a constant and a record) of each part, for the
    /// scales.
    pub(crate) fn parts(&self) -> Vec<(f64, f64)> {
        let mut parts = vec![(self.constant.abs(), 0.0)];
        for tone in self.tones.iter().filter(|t| !t.noise) {
            parts.push((tone.largest(), tone.frequency * TAU));
        }
        parts.extend(self.noises.iter().map(|n| (NOISE_PEAK * n.rms, n.low * TAU)));
        parts.extend(self.chirps.iter().map(|c| (c.amplitude.abs(), c.from.min(c.to) * TAU)));
        parts.extend(self.records.iter().map(|r| (r.peak(), 0.0)));
        parts
    }

    /// The fastest tone, the first of equal ones.
    pub(crate) fn fastest_tone(&self) -> Option<&TonePart> {
        self.tones.iter().reduce(|a, b| if b.frequency > a.frequency { b } else { a })
    }

    /// Frequency of the fastest tone in Hz.
    pub fn fastest(&self) -> Option<f64> {
        Some(self.fastest_tone()?.frequency)
    }

    /// Periods of the fastest tone in the common period of all parts, if there is one of at most 10 000.
    pub(crate) fn common_cycles(&self) -> Option<u64> {
        if !self.has_only_tones() || !self.noises.is_empty() {
            return None;
        }
        let fastest = self.fastest_tone()?;
        let mut common: u64 = 1;
        for tone in &self.tones {
            let denominator = tone.ratio_to(fastest)?.denominator;
            let shared = greatest_common_divisor(common.into(), denominator.into()) as u64;
            common = (common / shared).checked_mul(denominator)?;
            if common > LONGEST_COMMON_PERIOD {
                return None;
            }
        }
        Some(common)
    }
}
