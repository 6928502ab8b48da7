//! Conversion from natural numbers to the units of a scene.
//!
//! Scenes are drawn with a mass, a length and a time of about 1, where a thing that is small or fast can be
//! told from one that is not, and then measured in units: the program must do the same in all of them.

use std::sync::Arc;

use interwell::dynamics::STANDARD_GRAVITY;
use interwell::scene::{Damping, Excitation, ForcePiece, Mechanism, Record, Start, Stops};

/// A mass in kg, a length in m and a time in s.
#[derive(Debug, Clone, Copy)]
pub struct Units {
    pub mass: f64,
    pub length: f64,
    pub time: f64,
}

/// Those of the prototype: its mass, the distance of its wells, and the time in which it falls into them.
pub const PROTOTYPE: Units = Units { mass: 15.2e-3, length: 7e-3, time: 0.015 };

impl Units {
    fn millimetres(self, x: f64) -> f64 {
        x * self.length * 1e3
    }

    fn gravities(self, a: f64) -> f64 {
        a * self.length / (self.time * self.time) / STANDARD_GRAVITY
    }

    fn force(self) -> f64 {
        self.mass * self.length / (self.time * self.time)
    }

    pub fn mass_g(self) -> f64 {
        self.mass * 1e3
    }

    pub fn seconds(self, t: f64) -> f64 {
        t * self.time
    }

    /// A mechanism whose numbers are natural.
    pub fn mechanism(self, natural: &Mechanism) -> Mechanism {
        let (force, length) = (self.force(), self.length);
        match natural {
            Mechanism::Cubic { linear_n_per_m, cubic_n_per_m3 } => Mechanism::Cubic {
                linear_n_per_m: linear_n_per_m * force / length,
                cubic_n_per_m3: cubic_n_per_m3 * force / length.powi(3),
            },
            Mechanism::DoubleWell { equilibrium_mm, barrier_mj } => Mechanism::DoubleWell {
                equilibrium_mm: equilibrium_mm * length,
                barrier_mj: barrier_mj * force * length,
            },
            Mechanism::Polynomial { coefficients_si } => Mechanism::Polynomial {
                coefficients_si: (0..)
                    .zip(coefficients_si)
                    .map(|(i, c)| c * force / length.powi(i))
                    .collect(),
            },
            Mechanism::Pieces { ends_m, pieces, error_n } => Mechanism::Pieces {
                ends_m: ends_m.iter().map(|x| x * length).collect(),
                pieces: pieces.iter().map(|piece| self.piece(piece)).collect(),
                error_n: error_n * force,
            },
            Mechanism::Linear { n_per_m } => Mechanism::Linear { n_per_m: n_per_m * force / length },
            Mechanism::Magnet { strength_n_mm4, gap_mm, moments } => Mechanism::Magnet {
                strength_n_mm4: strength_n_mm4 * force * length.powi(4),
                gap_mm: gap_mm * length,
                moments: *moments,
            },
            Mechanism::Sum(parts) => Mechanism::Sum(parts.iter().map(|part| self.mechanism(part)).collect()),
            Mechanism::Table { .. } | Mechanism::Flexures { .. } => natural.clone(),
        }
    }

    fn piece(self, natural: &ForcePiece) -> ForcePiece {
        let (force, length) = (self.force(), self.length);
        let coefficients = (0..).zip(&natural.coefficients_si).map(|(i, c)| c * force / length.powi(i));
        ForcePiece { origin_m: natural.origin_m * length, coefficients_si: coefficients.collect() }
    }

    /// Stops whose distances are natural numbers in place of mm, the stiffness and the loss of compliant ones
    /// too.
    pub fn stops(self, natural: Stops) -> Stops {
        let mm = |x: Option<f64>| x.map(|x| self.millimetres(x));
        match natural {
            Stops::None => Stops::None,
            Stops::Rigid { travel_limit_mm, restitution } => {
                Stops::Rigid { travel_limit_mm: self.millimetres(travel_limit_mm), restitution }
            }
            Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right } => Stops::Uneven {
                left_mm: mm(left_mm),
                right_mm: mm(right_mm),
                restitution_left,
                restitution_right,
            },
            Stops::Hertz {
                travel_limit_mm,
                stiffness_n_per_m1_5,
                loss_s_per_m,
                radius_mm,
                young_gpa,
                poisson,
                yield_gpa,
            } => Stops::Hertz {
                travel_limit_mm: self.millimetres(travel_limit_mm),
                stiffness_n_per_m1_5: stiffness_n_per_m1_5.map(|k| k * self.force() / self.length.powf(1.5)),
                loss_s_per_m: loss_s_per_m * self.time / self.length,
                radius_mm: mm(radius_mm),
                young_gpa,
                poisson,
                yield_gpa,
            },
        }
    }

    /// A damping whose coefficient is natural.
    pub fn damping(self, natural: Damping) -> Damping {
        match natural {
            Damping::Coefficient { c_n_s_per_m } => {
                Damping::Coefficient { c_n_s_per_m: c_n_s_per_m * self.mass / self.time }
            }
            other => other,
        }
    }

    /// A start whose displacement and velocity are natural.
    pub fn start(self, (x, v): (f64, f64)) -> Start {
        Start::At { x_mm: self.millimetres(x), v_m_per_s: v * self.length / self.time, electrical: 0.0 }
    }

    /// An excitation whose amplitudes, frequencies and times are natural.
    pub fn excitation(self, natural: &Excitation) -> Excitation {
        let hz = |f: f64| f / self.time;
        match natural {
            Excitation::None => Excitation::None,
            Excitation::Constant { accel_g } => Excitation::Constant { accel_g: self.gravities(*accel_g) },
            Excitation::Sine { frequency_hz, amplitude_g, phase_deg } => Excitation::Sine {
                frequency_hz: hz(*frequency_hz),
                amplitude_g: self.gravities(*amplitude_g),
                phase_deg: *phase_deg,
            },
            Excitation::Cosine { amplitude_m_per_s2, frequency_rad_per_s, phase_deg } => Excitation::Cosine {
                amplitude_m_per_s2: amplitude_m_per_s2 * self.length / (self.time * self.time),
                frequency_rad_per_s: hz(*frequency_rad_per_s),
                phase_deg: *phase_deg,
            },
            Excitation::Force { amplitude_n, frequency_rad_per_s, phase_deg } => Excitation::Force {
                amplitude_n: amplitude_n * self.force(),
                frequency_rad_per_s: hz(*frequency_rad_per_s),
                phase_deg: *phase_deg,
            },
            Excitation::AmplitudeRamp { frequency_hz, from_g, to_g, over_s } => Excitation::AmplitudeRamp {
                frequency_hz: hz(*frequency_hz),
                from_g: self.gravities(*from_g),
                to_g: self.gravities(*to_g),
                over_s: self.seconds(*over_s),
            },
            Excitation::Chirp { from_hz, to_hz, over_s, amplitude_g } => Excitation::Chirp {
                from_hz: hz(*from_hz),
                to_hz: hz(*to_hz),
                over_s: self.seconds(*over_s),
                amplitude_g: self.gravities(*amplitude_g),
            },
            Excitation::Noise { rms_g, low_hz, high_hz, seed, lines } => Excitation::Noise {
                rms_g: self.gravities(*rms_g),
                low_hz: hz(*low_hz),
                high_hz: hz(*high_hz),
                seed: *seed,
                lines: *lines,
            },
            Excitation::Recorded { path, record } => Excitation::Recorded {
                path: path.clone(),
                record: record.as_ref().map(|original| {
                    let times = original.times.iter().map(|t| self.seconds(*t)).collect();
                    let accelerations = original.accelerations.iter();
                    let accelerations = accelerations.map(|a| self.gravities(*a) * STANDARD_GRAVITY);
                    Arc::new(Record::new(times, accelerations.collect()))
                }),
            },
            Excitation::Sum(parts) => {
                Excitation::Sum(parts.iter().map(|part| self.excitation(part)).collect())
            }
        }
    }
}
