//! Pinned motions: each continues with its scene, at the live time and drive phase of the session's motion.

use std::time::Duration;

use crate::app::task::{Background, Wake};
use crate::dynamics::Summary;
use crate::questions::Error;
use crate::scene::{Scene, Start, Stops};
use crate::system::clock::WallClock;
use interwell_studies::study::{Thresholds, Watch};

use super::Session;
use super::accuracy::LiveRun;
use super::ask::unshaken;
use super::build::{self, fault_message};
use super::editor::keep_start_inside;
use super::prepared::SharedModel;

/// Distance in mm of the twin's start from that of the mass.
const TWIN_OFFSET_MM: f64 = 1e-3;

/// Names of the pinned motions, one for each that can be pinned at a time.
const LETTERS: [char; 3] = ['A', 'B', 'C'];

/// What to do where no further motion can be pinned.
pub const FULL: &str = "Three motions are pinned: unpin one first, in the view Compare or by Motion, Unpin.";

/// Computing time that one frame spends to bring a pinned motion up to the present.
const FRAME_SHARE: Duration = Duration::from_millis(4);
/// Motion between two checks of that time, in multiples of the characteristic time.
const CHECK_INTERVAL: f64 = 2.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PinKind {
    Motion,
    /// The motion from here on, with the stops switched off if they are on, and on if they are off.
    OtherStops,
    /// The motion from its start, for a mass that begins a micrometre beside the session's.
    Twin,
}

pub struct Pin {
    pub letter: char,
    pub kind: PinKind,
    pub scene: Scene,
    model: SharedModel,
    pub watch: Watch,
    /// Live time in s from which on it is computed separately.
    pub since: f64,
    /// What it settles to, if that was known when it was pinned.
    known: Option<Summary>,
    /// The answer what it settles to, if that was not known when it was pinned.
    settled: Background<LiveRun, Summary>,
    /// Its thresholds, if they were searched for the open scene.
    pub thresholds: Option<Thresholds>,
}

impl Pin {
    /// The index of its name, from 0.
    pub fn place(&self) -> usize {
        LETTERS.iter().position(|letter| *letter == self.letter).unwrap_or(0)
    }

    /// What it settles to; `None` until it is known.
    pub fn settled(&self) -> Option<&Summary> {
        self.known.as_ref().or(self.settled.answer())
    }

    fn ask(&mut self, wake: &Wake) {
        self.known = None;
        let run = LiveRun { model: self.model.or(self.watch.from_here()), from: self.watch.time() };
        self.settled.ask(run, wake);
    }

    fn is_behind(&self, t: f64) -> bool {
        self.watch.time() < t && self.watch.ended().is_none()
    }

    /// Continues to the live time `to` in s, or as far as a frame's share of computing time allows.
    fn follow(&mut self, to: f64) {
        let begun = WallClock::start();
        let stretch = CHECK_INTERVAL * self.model.characteristic_time();
        while self.is_behind(to) {
            let before = self.watch.time();
            self.watch.advance((before + stretch).min(to));
            if self.watch.time() <= before || begun.elapsed() >= FRAME_SHARE {
                break;
            }
        }
    }
}

#[derive(Default)]
pub struct Pins {
    all: Vec<Pin>,
}

impl Pins {
    /// All pins, in the order in which they were pinned.
    pub fn all(&self) -> &[Pin] {
        &self.all
    }

    pub fn get(&self, letter: char) -> Option<&Pin> {
        self.all.iter().find(|pin| pin.letter == letter)
    }

    pub fn is_full(&self) -> bool {
        self.free_letter().is_none()
    }

    pub fn are_behind(&self, t: f64) -> bool {
        self.all.iter().any(|pin| pin.is_behind(t))
    }

    pub fn unpin(&mut self, letter: char) {
        self.all.retain(|pin| pin.letter != letter);
    }

    fn free_letter(&self) -> Option<char> {
        LETTERS.into_iter().find(|letter| self.get(*letter).is_none())
    }

    pub(super) fn poll(&mut self) {
        self.all.iter_mut().for_each(|pin| pin.settled.poll());
    }

    pub(super) fn restart(&mut self, wake: &Wake) {
        for pin in &mut self.all {
            (pin.watch, pin.since) = (Watch::new(&pin.model), 0.0);
            pin.ask(wake);
        }
    }

    /// How long the longest computation of what a pin settles to has been running; `None` if none is.
    pub(super) fn working(&self) -> Option<Duration> {
        self.all.iter().filter_map(|pin| pin.settled.running_for()).max()
    }

    pub(super) fn stop_working(&mut self) {
        self.all.iter_mut().for_each(|pin| pin.settled.pause());
    }
}

impl Session {
    /// Pins a motion beside the present one. Returns the letter of the pin; the error says why there is none.
    pub fn pin(&mut self, kind: PinKind) -> Result<char, String> {
        let letter = self.pins.free_letter().ok_or(FULL)?;
        self.end_gesture();
        self.apply();
        if let Some(fault) = self.fault() {
            return Err(format!("No motion of this scene can be pinned: {fault}"));
        }
        let (mut scene, mut watch) = (self.scene().clone(), self.player.watch().clone());
        let mut model = self.model.clone();
        match kind {
            PinKind::Motion => {}
            PinKind::OtherStops => {
                let off = scene.stops == Stops::None;
                scene.stops = if off { self.remembered_stops } else { Stops::None };
                keep_start_inside(&mut scene);
                model = self.model_of(&scene)?;
                watch.change(&model);
            }
            PinKind::Twin => {
                scene.start = self.twin_start();
                model = self.model_of(&scene)?;
                self.restart();
                watch = Watch::new(&model);
            }
        }
        let known = self.settled.answer().copied().filter(|_| kind == PinKind::Motion);
        let since = watch.time();
        let settled = Background::default();
        let mut pin = Pin { letter, kind, scene, model, watch, since, known, settled, thresholds: None };
        if known.is_none() {
            pin.ask(&self.wake);
        }
        self.pins.all.push(pin);
        Ok(letter)
    }

    /// Replaces the scene by that of a pin, as one undo step. Returns whether the scene changed.
    pub fn take_back(&mut self, letter: char) -> bool {
        let Some(scene) = self.pins.get(letter).map(|pin| pin.scene.clone()) else { return false };
        self.edit_once(|edited| *edited = scene)
    }

    /// Copies the thresholds of the open scene to the state before the last change and to the pins, where
    /// their scenes have the same thresholds.
    pub(super) fn note_thresholds(&mut self) {
        let (Some(asked), Some(found)) = (self.thresholds.question(), self.thresholds.answer()) else {
            return;
        };
        if let Some(before) =
            self.before.as_mut().filter(|card| card.thresholds.is_none() && !self.keeps_remedy)
        {
            before.thresholds = (unshaken(&before.scene) == *asked.0.of).then_some(*found);
        }
        for pin in self.pins.all.iter_mut().filter(|pin| pin.thresholds.is_none()) {
            pin.thresholds = (unshaken(&pin.scene) == *asked.0.of).then_some(*found);
        }
    }

    /// Continues the pinned motions to the live time; to be called after the motion has been advanced.
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
    fn model_of(&self, scene: &Scene) -> Result<SharedModel, String> {
        let mut document = self.editor.runnable();
        // the sweep axes do not matter for a motion
        document.scene = Scene { sweep: Vec::new(), ..scene.clone() };
        let checked = document.check().map_err(Error::from);
        let model = checked.and_then(|_| build::model(&document, &self.mechanism));
        let model = model.map_err(|error| fault_message(&error, scene))?;
        Ok(SharedModel::new(model, self.prepared(scene.clone())))
    }
}
