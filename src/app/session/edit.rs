//! Changes of the scene: gestures, undo, and single numbers by drags, key presses or typing.

use std::sync::Arc;

use crate::app::words::fields::{in_words, name_and_unit};
use crate::app::words::numbers::rounded;
use crate::dynamics::STANDARD_GRAVITY;
use crate::mechanics::FLEXURE_TOLERANCE;
use crate::scene::{Excitation, FieldPath, Mechanism, Scene, Stops, check};

use super::Session;
use super::build::{fault_message, first_stops, solve};
use super::editor::{Editor, Moment, Placed};
use super::player::opening_speed;
use super::prepared::SharedModel;

/// Error of the force of flexures during a gesture: the curve is solved within a frame, and its error is too
/// small to see. At the end of the gesture the flexures are solved with [`FLEXURE_TOLERANCE`].
const GESTURE_TOLERANCE: f64 = 1e-6;

/// Longest time in s between two presses of an arrow key that belong to one gesture.
const PRESS_GAP: f64 = 1.0;

impl Session {
    /// Changes the scene as part of a gesture; see [`Editor::edit`].
    pub fn edit(&mut self, change: impl FnOnce(&mut Scene)) -> bool {
        if !self.editor.in_gesture() {
            self.editor.at(self.moment());
        }
        self.editor.edit(change)
    }

    fn moment(&self) -> Moment {
        let now = self.player.watch().now();
        (now.t, (now.x, now.v))
    }

    /// Changes the mechanism as part of a gesture, if the changed one can be solved and run. Returns whether
    /// it changed, or why the change was refused.
    pub fn edit_mechanism(&mut self, change: impl FnOnce(&mut Mechanism)) -> Result<bool, String> {
        let mut document = self.editor.runnable().into_owned();
        change(&mut document.scene.mechanism);
        if document.scene.mechanism == self.scene().mechanism {
            return Ok(false);
        }
        let solved = solve(&document, GESTURE_TOLERANCE);
        let (mechanism, _) = solved.map_err(|error| fault_message(&error, &document.scene))?;
        let wanted = document.scene.mechanism;
        (self.mechanism, self.mechanism_of) = (mechanism, wanted.clone());
        self.tolerance = GESTURE_TOLERANCE;
        Ok(self.edit(|scene| scene.mechanism = wanted))
    }

    pub fn end_gesture(&mut self) {
        self.presses = None;
        if self.editor.in_gesture() {
            self.apply();
            self.editor.end_gesture();
            self.solve_fully();
            self.ask_thresholds();
        }
    }

    /// Solves a coarsely solved mechanism with the full tolerance; if that fails, the coarse solution stays.
    fn solve_fully(&mut self) {
        if self.tolerance != GESTURE_TOLERANCE {
            return;
        }
        let Ok((mechanism, model)) = solve(&self.editor.runnable(), FLEXURE_TOLERANCE) else { return };
        (self.mechanism, self.tolerance) = (mechanism, FLEXURE_TOLERANCE);
        self.model = SharedModel::new(model, self.prepared(Arc::clone(&self.built)));
        self.player.change(&self.model);
        self.is_continued = true;
        self.ask_settled();
    }

    pub fn edit_once(&mut self, change: impl FnOnce(&mut Scene)) -> bool {
        self.end_gesture();
        let changed = self.edit(change);
        self.end_gesture();
        changed
    }

    pub fn undo(&mut self) -> bool {
        self.move_in_history(Editor::undo)
    }

    pub fn redo(&mut self) -> bool {
        self.move_in_history(Editor::redo)
    }

    /// Goes to the scene of the history that has this link, if there is one.
    #[cfg(any(test, target_arch = "wasm32"))]
    pub fn go_to(&mut self, link: &str) -> bool {
        self.move_in_history(|editor| editor.go_to(link))
    }

    fn move_in_history(&mut self, step: impl FnOnce(&mut Editor) -> bool) -> bool {
        self.end_gesture();
        let (start, now) = (self.scene().start, self.moment());
        self.editor.at(now);
        let moved = step(&mut self.editor);
        match self.editor.take_placed() {
            Some(Placed::Mass((x, v))) => {
                self.leave_reference();
                self.player.place(x, v);
                self.note_move();
            }
            placed if moved => {
                self.apply();
                self.ask_thresholds();
                match placed {
                    _ if self.scene().start != start => self.restart(),
                    // a paused mass goes back to where the change found it
                    Some(Placed::Motion((t, mass))) if t == now.0 && mass != self.moment().1 => {
                        self.player.place(mass.0, mass.1);
                        self.note_move();
                    }
                    _ => {}
                }
            }
            _ => {}
        }
        moved
    }

    /// The number at a path. While the stops are off, their numbers are those of the remembered stops.
    pub fn number(&self, path: &str) -> Option<f64> {
        FieldPath::new(path).get(&self.with_stops_for(path))
    }

    /// Changes the number at a path as part of a gesture; a number of the stops switches them on. Returns
    /// whether the scene changed, or why the number was refused.
    pub fn set_number(&mut self, path: &str, value: f64) -> Result<bool, String> {
        let mut wanted = self.with_stops_for(path);
        if !FieldPath::new(path).set(&mut wanted, value) {
            return Ok(false);
        }
        if path == "run.duration_s" {
            // a settled window that would begin after the end begins in the middle of the run
            wanted.run.settle_s = wanted.run.settle_s.filter(|settle| *settle < value);
        }
        let section = |path: &str| path.split('.').next().map(str::to_owned);
        let same_section = |field: &str| section(field) == section(path);
        let fault = check(&wanted).faults.into_iter().find(|fault| same_section(&fault.field));
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
        self.edit_mechanism(|mechanism| *mechanism = wanted.mechanism)
    }

    fn with_stops_for(&self, path: &str) -> Scene {
        let mut scene = self.scene().clone();
        if scene.stops == Stops::None && path.starts_with("stops.") {
            scene.stops = self.remembered_stops;
        }
        scene
    }

    /// Notes a key press on a field at `now` in s; presses within a second on one field are one gesture.
    pub fn press(&mut self, field: &str, now: f64) {
        if self.presses.as_ref().is_none_or(|(pressed, last)| pressed != field || now - last > PRESS_GAP) {
            self.end_gesture();
        }
        self.presses = Some((field.to_owned(), now));
    }

    /// Ends a series of key presses because another action follows.
    pub fn end_presses(&mut self) {
        if self.presses.is_some() {
            self.end_gesture();
        }
    }

    /// Ends a series of key presses after a second without one. Returns the time in s left for another one.
    pub fn follow_presses(&mut self, now: f64) -> Option<f64> {
        let left = self.presses.as_ref()?.1 + PRESS_GAP - now;
        if left <= 0.0 {
            self.end_gesture();
        }
        (left > 0.0).then_some(left)
    }

    /// A sine that suits the scales of the mechanism: 3 Hz and 0.5 g for the prototype.
    pub fn suiting_sine(&self) -> Excitation {
        let scales = &self.model().scales();
        let one_digit = |value: f64, otherwise: f64| {
            if value > 0.0 && value.is_finite() { rounded(value, 1) } else { otherwise }
        };
        let frequency_hz = one_digit(0.2 / (std::f64::consts::TAU * scales.time), 3.0);
        let amplitude_g = one_digit(0.075 * scales.length / scales.time.powi(2) / STANDARD_GRAVITY, 0.5);
        Excitation::Sine { frequency_hz, amplitude_g, phase_deg: 0.0 }
    }

    /// Switches the stops on or off; stops that are switched off are remembered.
    pub fn switch_stops(&mut self, on: bool) {
        let stops = if on { self.remembered_stops } else { Stops::None };
        if !on && self.scene().stops != Stops::None {
            self.remembered_stops = self.scene().stops;
        }
        self.edit_once(|scene| scene.stops = stops);
    }

    /// Goes back to the scene as it was opened or last saved, and plays it from its start.
    pub fn back_to_start(&mut self) {
        self.move_in_history(Editor::back_to_start);
        self.remembered_stops = first_stops(self.scene(), &self.model);
        self.restart();
        self.player.speed = opening_speed(self.scene(), &self.model);
        self.player.set_playing(true);
    }
}
