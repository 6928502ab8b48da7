//! Pinned motions: each continues with its own scene, at the same live time and drive phase as the session's.

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Background, Identity, Wake};
use crate::dynamics::{Model, Outcome, Sample, Summary};
use crate::scene::Scene;
use crate::study::{self, Watch};
use crate::system::clock::WallClock;

/// Names of the pinned motions; as many can be pinned at a time.
pub(super) const LETTERS: [char; 3] = ['A', 'B', 'C'];

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
    pub(super) letter: char,
    pub(super) kind: PinKind,
    pub(super) scene: Scene,
    pub(super) model: Arc<Model>,
    pub(super) watch: Watch,
    /// Live time in s from which on it is computed separately.
    pub(super) since: f64,
    /// What it settles to, if that was known when it was pinned.
    pub(super) known: Option<Summary>,
    /// What it settles to, if it had to be asked.
    pub(super) settled: Background<Identity<Model>, Summary>,
}

impl Pin {
    /// Its name.
    pub fn letter(&self) -> char {
        self.letter
    }

    /// The index of its name, from 0.
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

    /// Live time in s from which on it is computed separately.
    pub fn since(&self) -> f64 {
        self.since
    }

    /// Its state at a live time in s; after its end, its last state.
    pub fn state_at(&self, t: f64) -> Sample {
        self.watch.state_at(t)
    }

    /// How it ended; `None` if it goes on.
    pub fn ended(&self) -> Option<Outcome> {
        self.watch.ended()
    }

    /// What it settles to; `None` until it is known.
    pub fn settled(&self) -> Option<&Summary> {
        self.known.as_ref().or(self.settled.answer())
    }

    pub(super) fn ask(&mut self, wake: &Wake) {
        let model = self.watch.from_here().unwrap_or_else(|| (*self.model).clone());
        self.known = None;
        let model = Identity(Arc::new(model));
        self.settled.ask(model, wake, |model, cancel, _| study::settled(model, cancel));
    }

    fn is_behind(&self, t: f64) -> bool {
        self.watch.time() < t && self.ended().is_none()
    }

    /// Continues to the live time `to` in s, or as far as a frame's share of computing time allows.
    pub(super) fn follow(&mut self, to: f64) {
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
    pub(super) all: Vec<Pin>,
}

impl Pins {
    /// All pins, in the order in which they were pinned.
    pub fn all(&self) -> &[Pin] {
        &self.all
    }

    /// The pin with this letter.
    pub fn get(&self, letter: char) -> Option<&Pin> {
        self.all.iter().find(|pin| pin.letter == letter)
    }

    /// Whether no more motions can be pinned.
    pub fn is_full(&self) -> bool {
        self.free_letter().is_none()
    }

    /// Whether a pin has not reached the live time `t` in s yet.
    pub fn are_behind(&self, t: f64) -> bool {
        self.all.iter().any(|pin| pin.is_behind(t))
    }

    pub fn unpin(&mut self, letter: char) {
        self.all.retain(|pin| pin.letter != letter);
    }

    pub(super) fn free_letter(&self) -> Option<char> {
        LETTERS.into_iter().find(|letter| self.get(*letter).is_none())
    }

    /// Receives background results.
    pub(super) fn poll(&mut self) {
        for pin in &mut self.all {
            pin.settled.poll();
        }
    }

    /// Restarts all pins, each from its own start.
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

    /// Stops the computations of what the pins settle to.
    pub(super) fn stop_working(&mut self) {
        self.all.iter_mut().for_each(|pin| pin.settled.pause());
    }
}
