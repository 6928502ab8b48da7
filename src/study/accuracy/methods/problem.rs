//! A model as an ordinary right-hand side: acceleration from time, displacement and velocity.

use std::f64::consts::TAU;

use crate::dynamics::Model;

/// The equation of motion of a model, evaluated directly: library sines, force curve, no series.
pub(super) struct Problem<'a> {
    pub model: &'a Model,
    /// Left and right stop: position in m and restitution; at infinity if there is none.
    pub stops: [(f64, f64); 2],
    pub start: (f64, f64),
    domain: (f64, f64),
    single: Option<&'a [f64]>,
}

impl<'a> Problem<'a> {
    pub fn new(model: &'a Model) -> Self {
        let stops = model.stops();
        let at = |stop: Option<crate::dynamics::StopAt>, open: f64| {
            stop.map_or((open, 1.0), |stop| (stop.x, stop.restitution))
        };
        let curve = &model.mechanism().curve;
        Self {
            model,
            stops: [
                at(stops.and_then(|pair| pair.left), f64::NEG_INFINITY),
                at(stops.and_then(|pair| pair.right), f64::INFINITY),
            ],
            start: model.start(),
            domain: curve.domain(),
            single: match curve.pieces() {
                [piece] if piece.origin == 0.0 => Some(&piece.coefficients),
                _ => None,
            },
        }
    }

    /// Base acceleration in m/s^2 at `t` in s.
    pub fn base(&self, t: f64) -> f64 {
        let drive = &self.model.excitation();
        let mut sum = drive.constant;
        for tone in &drive.tones {
            let turns = tone.frequency * t + tone.phase;
            let amplitude = match tone.ramp {
                Some((from, over)) if t < over => from + (tone.amplitude - from) * t / over,
                _ => tone.amplitude,
            };
            let angle = TAU * turns;
            sum += amplitude * if tone.quarter { angle.cos() } else { angle.sin() };
        }
        for chirp in &drive.chirps {
            let turns = if t < chirp.over {
                chirp.from * t + (chirp.to - chirp.from) * t * t / (2.0 * chirp.over)
            } else {
                0.5 * (chirp.from + chirp.to) * chirp.over + chirp.to * (t - chirp.over)
            };
            sum += chirp.amplitude * (TAU * turns).sin();
        }
        for record in &drive.records {
            let after = record.times.partition_point(|at| *at <= t);
            if after > 0 && after < record.times.len() {
                let (t0, t1) = (record.times[after - 1], record.times[after]);
                let (a0, a1) = (record.accelerations[after - 1], record.accelerations[after]);
                sum += a0 + (a1 - a0) * (t - t0) / (t1 - t0);
            }
        }
        sum
    }

    /// Acceleration in m/s^2 at t, x, v in SI.
    pub fn acceleration(&self, t: f64, x: f64, v: f64) -> f64 {
        let force = match self.single {
            Some(coefficients) => coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c),
            // a stage may lie beyond the end of the curve, where a run ends
            None => self.model.mechanism().curve.force(x.clamp(self.domain.0, self.domain.1)),
        };
        -(force + self.model.total_damping() * v) / self.model.mass() - self.base(t)
    }

    /// Whether the run may go on from here.
    pub fn is_inside(&self, x: f64, v: f64) -> bool {
        x >= self.domain.0 && x <= self.domain.1 && v.is_finite()
    }
}
