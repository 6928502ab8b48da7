//! The session's pins of its motion.

use std::sync::Arc;

use crate::app::session::Session;
use crate::app::session::build::{CannotRun, fault_message};
use crate::app::session::editor::keep_start_inside;
use crate::app::task::Latest;
use crate::dynamics::Model;
use crate::scene::{Scene, Start, Stops};
use crate::study::Watch;

use super::{LETTERS, Pin, PinKind};

/// Distance in mm of the twin's start from that of the mass.
const TWIN_OFFSET_MM: f64 = 1e-3;

impl Session {
    /// Pins a motion beside the present one. Returns the letter of the pin; the error says why there is none.
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
                let off = scene.stops == Stops::None;
                scene.stops = if off { self.remembered_stops() } else { Stops::None };
                keep_start_inside(&mut scene);
            }
            PinKind::Twin => scene.start = self.twin_start(),
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
        let mut pin = Pin { letter, kind, scene, model, watch, since, known, settled: Latest::default() };
        if known.is_none() {
            pin.ask(&self.wake);
        }
        self.pins.all.push(pin);
        Ok(letter)
    }

    /// Replaces the scene by that of a pin, as one undo step; the motion goes on from its present state.
    /// Returns whether the scene changed.
    pub fn take_back(&mut self, letter: char) -> bool {
        let Some(scene) = self.pins.get(letter).map(|pin| pin.scene().clone()) else { return false };
        self.edit_once(|edited| *edited = scene)
    }

    /// Continues the pinned motions to the live time of the motion, in phase with its drive; to be called
    /// after the motion has been advanced.
    pub fn follow_pins(&mut self) {
        let watch = self.player.watch();
        for pin in &mut self.pins.all {
            pin.watch.keep_ledgers(watch.keeps_ledgers());
            pin.follow(watch.time());
        }
    }

    /// A start a micrometre beside that of the scene, on a side without a stop in the way.
    fn twin_start(&self) -> Start {
        let start = Watch::new(&self.model).now();
        let (_, right) = self.model.stop_positions();
        let room = right.is_none_or(|stop| (stop - start.x) * 1e3 > TWIN_OFFSET_MM);
        let offset = if room { TWIN_OFFSET_MM } else { -TWIN_OFFSET_MM };
        Start::At { x_mm: start.x * 1e3 + offset, v_m_per_s: start.v, electrical: start.electrical }
    }

    /// The model of a scene with the mechanism of the open one, or why there is none.
    fn model_of(&self, scene: &Scene) -> Result<Model, String> {
        let mut document = self.editor.runnable();
        // the sweep axes do not matter for a motion
        document.scene = Scene { sweep: Vec::new(), ..scene.clone() };
        let built = || -> Result<Model, CannotRun> {
            document.check()?;
            let model = Model::build(&document.scene, Arc::clone(&self.mechanism));
            Ok(model.map_err(|faults| document.error_from(faults))?)
        };
        built().map_err(|error| fault_message(&error, scene))
    }
}
