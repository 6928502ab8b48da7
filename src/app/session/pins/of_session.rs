//! Pins of the open scene's motion.

use std::sync::Arc;

use crate::app::session::Session;
use crate::app::session::build::{CannotRun, why};
use crate::app::session::editor::keep_start_inside;
use crate::app::task::Latest;
use crate::dynamics::Model;
use crate::scene::{Scene, Start, Stops};
use crate::study::Watch;

use super::{LETTERS, Pin, PinKind};

/// How far in mm a twin begins beside the mass.
const BESIDE_MM: f64 = 1e-3;

impl Session {
    /// Pins a motion beside the present one. What the pin is called, or why there is none.
    pub fn pin(&mut self, kind: PinKind) -> Result<char, String> {
        let Some(letter) = self.pins.free_letter() else {
            return Err(format!("{} motions are pinned already: unpin one first", LETTERS.len()));
        };
        self.end_gesture();
        self.apply();
        if let Some(fault) = self.fault() {
            return Err(format!("No motion of this scene can be pinned: {fault}"));
        }
        let mut scene = self.scene().clone();
        match kind {
            PinKind::Motion => {}
            PinKind::OtherStops => {
                let none = scene.stops == Stops::None;
                scene.stops = if none { self.remembered_stops() } else { Stops::None };
                keep_start_inside(&mut scene);
            }
            PinKind::Twin => scene.start = self.start_beside(),
        }
        let model = match kind {
            PinKind::Motion => Arc::clone(&self.model),
            PinKind::OtherStops | PinKind::Twin => Arc::new(self.model_of(&scene)?),
        };
        if kind == PinKind::Twin {
            self.restart();
        }
        let mut watch = match kind {
            PinKind::Twin => Watch::new(&model),
            PinKind::Motion | PinKind::OtherStops => self.player.watch().clone(),
        };
        if kind == PinKind::OtherStops {
            watch.change(&model);
        }
        let known = self.settled.current().copied().filter(|_| kind == PinKind::Motion);
        let since = watch.time();
        let mut pin = Pin { letter, kind, scene, model, watch, since, known, asked: Latest::default() };
        if known.is_none() {
            pin.ask(&self.wake);
        }
        self.pins.all.push(pin);
        Ok(letter)
    }

    /// Has the scene be that of a pin, in one step that can be undone; the motion goes on from its present
    /// state. Whether the scene changed.
    pub fn take_back(&mut self, letter: char) -> bool {
        let Some(scene) = self.pins.get(letter).map(|pin| pin.scene().clone()) else { return false };
        self.edit_once(|own| *own = scene)
    }

    /// Lets the pinned motions go on to where the motion is, in step with its drive; to be called after time
    /// went on.
    pub fn follow_pins(&mut self) {
        let watch = self.player.watch();
        for pin in &mut self.pins.all {
            pin.watch.keep_ledgers(watch.keeps_ledgers());
            pin.follow(watch.time());
        }
    }

    /// A start a micrometre beside that of the scene, on the side that no stop takes.
    fn start_beside(&self) -> Start {
        let start = Watch::new(&self.model).now();
        let (_, right) = self.model.stop_positions();
        let room = right.is_none_or(|stop| (stop - start.x) * 1e3 > BESIDE_MM);
        let aside = if room { BESIDE_MM } else { -BESIDE_MM };
        Start::At { x_mm: start.x * 1e3 + aside, v_m_per_s: start.v, electrical: start.electrical }
    }

    /// The model of a scene with the mechanism of the open one, or why there is none.
    fn model_of(&self, scene: &Scene) -> Result<Model, String> {
        let mut document = self.editor.runnable();
        // what is swept has no part in a motion
        document.scene = Scene { sweep: Vec::new(), ..scene.clone() };
        let built = || -> Result<Model, CannotRun> {
            document.check()?;
            let model = Model::build(&document.scene, Arc::clone(&self.mechanism));
            Ok(model.map_err(|faults| document.error_from(faults))?)
        };
        built().map_err(|error| why(&error, scene))
    }
}
