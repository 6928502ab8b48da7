//! Pinned motions: each follows another scene, at the same live time and with the drive in step.

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Background, Wake};
use crate::dynamics::{Model, Outcome, Sample, Summary};
use crate::scene::{Scene, Start, Stops};
use crate::study::{self, Watch};
use crate::system::clock::WallClock;

use super::Session;
use super::build::{CannotRun, why};
use super::editor::keep_start_inside;

/// Names of the pinned motions; there are no more of them at a time.
const LETTERS: [char; 3] = ['A', 'B', 'C'];

/// Time on the screen that one frame takes to bring a pinned motion up to the present.
const SHARE: Duration = Duration::from_millis(4);

/// Stretch of the motion between two looks at the clock, in multiples of its characteristic time.
const STRETCH: f64 = 2.0;

/// Distance in mm from the mass at which a twin begins.
const BESIDE_MM: f64 = 1e-3;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PinKind {
    Motion,
    /// The motion from here on with its stops switched the other way.
    OtherStops,
    /// The motion from its start, and that of a mass which begins a micrometre beside it.
    Twin,
}

pub struct Pin {
    letter: char,
    kind: PinKind,
    scene: Scene,
    model: Arc<Model>,
    watch: Watch,
    /// Live time in s from which on it is a motion by itself.
    since: f64,
    /// What it settles to from there.
    settled: Background<(), Summary>,
}

impl Pin {
    /// What it is called.
    pub fn letter(&self) -> char {
        self.letter
    }

    /// Number of its letter, from 0.
    pub fn place(&self) -> usize {
        LETTERS.iter().position(|letter| *letter == self.letter).unwrap_or(0)
    }

    pub fn kind(&self) -> PinKind {
        self.kind
    }

    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    pub fn watch(&self) -> &Watch {
        &self.watch
    }

    /// Live time in s from which on it is a motion by itself.
    pub fn since(&self) -> f64 {
        self.since
    }

    /// Its state at a live time in s; where it has ended before that, the last one.
    pub fn state_at(&self, t: f64) -> Sample {
        self.watch.state_at(t)
    }

    /// How it ended, where it did.
    pub fn ended(&self) -> Option<Outcome> {
        self.watch.ended()
    }

    /// What it settles to, once that is known.
    pub fn settled(&self) -> Option<&Summary> {
        self.settled.answer()
    }

    fn ask_settled(&mut self, wake: &Wake) {
        let model = self.watch.from_here().unwrap_or_else(|| (*self.model).clone());
        self.settled.ask((), wake, move |(), cancel, _| study::settled(&model, cancel));
    }

    fn is_behind(&self, t: f64) -> bool {
        self.watch.time() < t && self.ended().is_none()
    }

    /// Goes on to the live time `to` in s, or as far as a frame's share of time allows.
    fn follow(&mut self, to: f64) {
        let begun = WallClock::start();
        let stretch = STRETCH * self.model.characteristic_time();
        while self.is_behind(to) {
            let before = self.watch.time();
            self.watch.advance((before + stretch).min(to));
            if self.watch.time() <= before || begun.elapsed() >= SHARE {
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
    /// All of them, in the order in which they were pinned.
    pub fn all(&self) -> &[Pin] {
        &self.all
    }

    /// The one with this letter.
    pub fn get(&self, letter: char) -> Option<&Pin> {
        self.all.iter().find(|pin| pin.letter == letter)
    }

    /// Whether there is no room for another one.
    pub fn is_full(&self) -> bool {
        self.free_letter().is_none()
    }

    /// Whether one of them has not come up to the live time `t` in s.
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

    /// Begins all of them again, each from its start.
    pub(super) fn restart(&mut self, wake: &Wake) {
        for pin in &mut self.all {
            (pin.watch, pin.since) = (Watch::new(&pin.model), 0.0);
            pin.ask_settled(wake);
        }
    }

    /// The longest time for which it has been worked out what one of them settles to.
    pub(super) fn working(&self) -> Option<Duration> {
        self.all.iter().filter_map(|pin| pin.settled.running_for()).max()
    }

    /// Stops that.
    pub(super) fn stop_working(&mut self) {
        self.all.iter_mut().for_each(|pin| pin.settled.stop());
    }
}

impl Session {
    /// Pins a motion beside the present one. The letter of the pin, or why there is none.
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
        let known = self.settled.answer().filter(|_| kind == PinKind::Motion);
        let (since, settled) = (watch.time(), Background::default());
        let mut pin = Pin { letter, kind, scene, model, watch, since, settled };
        match known {
            Some(summary) => pin.settled.set((), vec![*summary]),
            None => pin.ask_settled(&self.wake),
        }
        self.pins.all.push(pin);
        Ok(letter)
    }

    /// Replaces the scene by that of a pin, in one step that can be undone; the motion goes on from its
    /// present state. Whether the scene changed.
    pub fn take_back(&mut self, letter: char) -> bool {
        let Some(pinned) = self.pins.get(letter).map(|pin| pin.scene().clone()) else { return false };
        self.edit_once(|scene| *scene = pinned)
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

    /// A start a micrometre beside that of the scene, on the side without a stop in the way.
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
        // the sweep has no part in a motion
        document.scene = Scene { sweep: Vec::new(), ..scene.clone() };
        let built = || -> Result<Model, CannotRun> {
            document.check()?;
            let model = Model::build(&document.scene, Arc::clone(&self.mechanism));
            Ok(model.map_err(|faults| document.error_from(faults))?)
        };
        built().map_err(|error| why(&error, scene))
    }
}
