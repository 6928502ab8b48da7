//! Characteristic times, accelerations and signal ranges of a model, which set the scales of plots.

use std::f64::consts::TAU;

use super::Model;
use super::excitation::TonePart;

/// Range of an axis of base acceleration without an excitation, in m/s^2.
const RANGE_WITHOUT_EXCITATION: f64 = super::excitation::STANDARD_GRAVITY;

/// Range of a noise, as a multiple of its root mean square; larger values are rare.
const NOISE_ROOM: f64 = 2.5;

impl Model {
    /// Characteristic time of the motion in s: the forcing period; if there is none, the period of the
    /// excitation's middle frequency; without an excitation the [`natural_time`](Self::natural_time).
    pub fn characteristic_time(&self) -> f64 {
        self.forcing_period.or_else(|| self.excitation_time()).unwrap_or_else(|| self.natural_time())
    }

    /// Characteristic period in s of an excitation without a forcing period: of the middle of a noise's band,
    /// of the fast end of a chirp, of the mean crossings of a record.
    fn excitation_time(&self) -> Option<f64> {
        let drive = &self.excitation;
        let noises = drive.noises.iter().map(|noise| 2.0 / (noise.low + noise.high));
        let chirps = drive.chirps.iter().map(|chirp| 1.0 / chirp.from.max(chirp.to));
        let records =
            drive.records.iter().map(|record| 2.0 * crossing_interval(&record.times, &record.accelerations));
        let all = noises.chain(chirps).chain(records);
        all.filter(|time| time.is_finite() && *time > 0.0).reduce(f64::min)
    }

    /// Characteristic time of the mechanism in s: the period of small oscillations in the stiffest well;
    /// without a stiffness, twice the time of flight to a stop; without both, the scene's time scale.
    pub fn natural_time(&self) -> f64 {
        let landscape = &self.mechanism.landscape;
        let wells = landscape.equilibria.iter().filter(|equilibrium| equilibrium.stable);
        let stiffness = wells.map(|well| landscape.inner_stiffness(well)).fold(0.0, f64::max);
        let small = TAU * (self.mass / stiffness).sqrt();
        let usable = |time: &f64| time.is_finite() && *time > 0.0;
        Some(small)
            .filter(usable)
            .or_else(|| self.flight().map(|flight| 2.0 * flight).filter(usable))
            .unwrap_or(TAU * self.scales.time)
    }

    /// Time of flight in s from the start to a stop under the constant acceleration of the start.
    fn flight(&self) -> Option<f64> {
        let (x, v) = self.start;
        let a = -self.mechanism.curve.force(x) / self.mass;
        let to = |stop: f64| {
            let (d, root) = (stop - x, v * v + 2.0 * a * (stop - x));
            // the roots of a t^2/2 + v t - d, without cancellation
            let q = v + v.signum() * root.sqrt();
            [q / -a, 2.0 * d / q].into_iter().filter(|t| *t > 0.0 && t.is_finite()).reduce(f64::min)
        };
        let (left, right) = self.stop_positions();
        [left, right].into_iter().flatten().filter_map(to).reduce(f64::min)
    }

    /// A bound of the base acceleration in m/s^2, as for an axis: the largest magnitudes of all parts of the
    /// drive together, of noise 2.5 times its RMS, which it seldom exceeds; without a drive 1 g.
    pub fn largest_base_acceleration(&self) -> f64 {
        let drive = &self.excitation;
        let tones = drive.tones.iter().filter(|tone| !tone.noise);
        let tones = tones.map(TonePart::largest);
        let noises = drive.noises.iter().map(|noise| NOISE_ROOM * noise.rms);
        let chirps = drive.chirps.iter().map(|chirp| chirp.amplitude.abs());
        let records = drive.records.iter().map(|record| record.peak());
        let parts: Vec<f64> = tones.chain(noises).chain(chirps).chain(records).collect();
        if parts.is_empty() && drive.constant == 0.0 {
            return RANGE_WITHOUT_EXCITATION;
        }
        drive.constant.abs() + parts.iter().sum::<f64>()
    }

    /// The base acceleration of the largest magnitude in m/s^2, with the sign of the drive's constant part if
    /// there is one; without a drive 0. A bound as above.
    pub fn extreme_base_acceleration(&self) -> f64 {
        if self.is_shaken() {
            self.largest_base_acceleration().copysign(self.excitation.constant)
        } else {
            0.0
        }
    }

    /// Amplitude in m/s^2 and angular frequency in 1/s of the drive, if it is a single sine and nothing else.
    pub fn single_sine(&self) -> Option<(f64, f64)> {
        let drive = &self.excitation;
        let alone = drive.constant == 0.0 && drive.has_only_tones();
        match drive.tones.as_slice() {
            [tone] if alone && tone.ramp.is_none() && !tone.noise => {
                Some((tone.amplitude.abs(), TAU * tone.frequency))
            }
            _ => None,
        }
    }

    /// Acceleration of the mass in m/s^2 relative to the base while it touches no stop, by the equation of
    /// motion m a = -F(x) - c v - m a_b, at a displacement in m, a velocity in m/s and an acceleration of the
    /// base in m/s^2.
    pub fn acceleration(&self, x: f64, v: f64, base_accel: f64) -> f64 {
        -(self.mechanism.curve.force(x) + self.total_damping() * v) / self.mass - base_accel
    }
}

/// Mean time between two crossings of a signal through its mean.
fn crossing_interval(times: &[f64], values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let passages = values.windows(2).filter(|pair| (pair[0] > mean) != (pair[1] > mean)).count();
    let length = times.last().copied().unwrap_or(0.0) - times.first().copied().unwrap_or(0.0);
    length / passages as f64
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::mechanics::Mechanism;
    use crate::scene::Document;

    fn model(preset: &str, changes: &[&str]) -> Model {
        let mut document = Document::load(preset).unwrap();
        for change in changes {
            document.set(change).unwrap();
        }
        let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
        Model::build(&document.scene, Arc::new(mechanism)).unwrap()
    }

    fn near(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-9 * b.abs(), "{a} {b}");
    }

    #[test]
    fn characteristic_times_are_those_of_excitation_or_mechanism() {
        near(model("paper", &[]).characteristic_time(), 1.0 / 3.0);
        // 2 pi sqrt(m/k), k = 40 N/m
        let unshaken = model("monostable", &["excitation=None"]);
        near(unshaken.characteristic_time(), TAU * (15.2e-3_f64 / 40.0).sqrt());
        // down and up again: twice sqrt(2 h/g)
        near(model("bouncing-ball", &[]).characteristic_time(), 2.0 * (2.0_f64 / 9.81).sqrt());
        // 10 mm at 50 mm/s, and back
        near(model("elastic-box", &[]).characteristic_time(), 0.4);
        // noise from 1 to 6 Hz
        near(model("random-shaking", &[]).characteristic_time(), 1.0 / 3.5);
        let wave: Vec<f64> = (0..1000).map(|i| (0.05 * f64::from(i)).sin()).collect();
        let times: Vec<f64> = (0..1000).map(f64::from).collect();
        assert!((crossing_interval(&times, &wave) / (20.0 * std::f64::consts::PI) - 1.0).abs() < 0.1);
        let walking = model("walking", &[]).characteristic_time();
        assert!((0.05..1.0).contains(&walking), "{walking}");
        let nothing = model("elastic-box", &["stops=None", "start=At(x_mm: 0, v_m_per_s: 0)"]);
        assert!(nothing.characteristic_time().is_finite() && nothing.characteristic_time() > 0.0);
    }

    #[test]
    fn the_largest_base_acceleration_is_the_sum_of_its_parts() {
        let g = super::super::excitation::STANDARD_GRAVITY;
        near(model("paper", &["excitation.amplitude_g=1.25"]).largest_base_acceleration(), 1.25 * g);
        near(model("paper", &["excitation=None"]).largest_base_acceleration(), g);
        assert_eq!(model("paper", &["excitation.amplitude_g=0"]).largest_base_acceleration(), 0.0);
        let (amplitude, rate) = model("paper", &["excitation.amplitude_g=-0.5"]).single_sine().unwrap();
        near(amplitude, 0.5 * g);
        near(rate, 3.0 * TAU);
        assert!(model("random-shaking", &[]).single_sine().is_none());
    }

    #[test]
    fn the_acceleration_is_that_of_the_equation_of_motion() {
        let duffing = model("duffing", &[]);
        // x'' = x - x^3 - 0.3 x' - a_b
        near(duffing.acceleration(0.5, 0.2, 0.1), 0.5 - 0.125 - 0.06 - 0.1);
    }
}
