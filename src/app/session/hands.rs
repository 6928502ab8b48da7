//! Numbers of the scene as hands change them: by drags, presses of keys, or typed.

use crate::dynamics::STANDARD_GRAVITY;
use crate::scene::{Excitation, FieldPath, Scene, Stops, check};

use super::{PRESSES, Session};
use crate::app::fields::{in_words, name_and_unit};

impl Session {
    /// The number at a path; that of the stops is, while they are off, of those that come.
    pub fn number(&self, path: &str) -> Option<f64> {
        FieldPath::new(path).get(&self.with_stops_for(path))
    }

    /// Changes the number at a path as part of a gesture; a number of the stops switches them on. Whether the scene
    /// changed, or why it stays as it was.
    pub fn set_number(&mut self, path: &str, value: f64) -> Result<bool, String> {
        let mut wanted = self.with_stops_for(path);
        if !FieldPath::new(path).set(&mut wanted, value) {
            return Ok(false);
        }
        if path == "run.duration_s" {
            // a window that would begin after the end begins in the middle
            wanted.run.settle_s = wanted.run.settle_s.filter(|settle| *settle < value);
        }
        let section = |path: &str| path.split('.').next().map(str::to_owned);
        let own = |field: &str| section(field) == section(path);
        let fault = check(&wanted).faults.into_iter().find(|fault| own(&fault.field));
        if let (Some(fault), None) = (fault, self.fault()) {
            let problem = in_words(&fault.problem, &wanted);
            return Err(match fault.field == path {
                true => problem,
                false => format!("{} {problem}", name_and_unit(&fault.field).0),
            });
        }
        if wanted.mechanism == self.scene().mechanism {
            return Ok(self.edit(|scene| *scene = wanted));
        }
        let changed = self.edit_mechanism(|mechanism| *mechanism = wanted.mechanism);
        match self.refused().filter(|_| !changed) {
            Some(why) => Err(why.to_owned()),
            None => Ok(changed),
        }
    }

    fn with_stops_for(&self, path: &str) -> Scene {
        let mut scene = self.scene().clone();
        if scene.stops == Stops::None && path.starts_with("stops.") {
            scene.stops = self.remembered_stops();
        }
        scene
    }

    /// A key is pressed on a field at the time `now` in s: presses on one field within a second are one gesture.
    pub fn press(&mut self, field: &'static str, now: f64) {
        if self.presses.is_none_or(|(own, last)| own != field || now - last > PRESSES) {
            self.end_gesture();
        }
        self.presses = Some((field, now));
    }

    /// Ends presses that something else follows.
    pub fn end_presses(&mut self) {
        if self.presses.is_some() {
            self.end_gesture();
        }
    }

    /// Ends presses that no other one has followed for a second. How long in s others are waited for from `now` on.
    pub fn follow_presses(&mut self, now: f64) -> Option<f64> {
        let (_, last) = self.presses?;
        let left = last + PRESSES - now;
        if left <= 0.0 {
            self.end_gesture();
        }
        (left > 0.0).then_some(left)
    }

    /// A sine that suits the scales of the mechanism; for the prototype 3 Hz and 0.5 g.
    pub fn suiting_sine(&self) -> Excitation {
        let scales = &self.model().scales();
        let digit = |value: f64, otherwise: f64| match value > 0.0 && value.is_finite() {
            true => format!("{value:.0e}").parse().unwrap_or(otherwise),
            false => otherwise,
        };
        let frequency_hz = digit(0.2 / (std::f64::consts::TAU * scales.time), 3.0);
        let amplitude_g = digit(0.075 * scales.length / scales.time.powi(2) / STANDARD_GRAVITY, 0.5);
        Excitation::Sine { frequency_hz, amplitude_g, phase_deg: 0.0 }
    }
}
