//! Pinned motions: each goes on by a scene of its own, at the same live time and with the drive in step.

mod of_session;

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Latest, Wake};
use crate::dynamics::{Model, Outcome, Sample, Summary};
use crate::scene::Scene;
use crate::study::{self, Watch};
use crate::system::clock::WallClock;

/// The most motions that are pinned at a time, and how they are called.
const LETTERS: [char; 3] = ['A', 'B', 'C'];

/// Time on the screen that one frame takes to bring a pinned motion up to the present, and the stretch of it
/// between two looks at the clock, in multiples of its characteristic time.
const SHARE: Duration = Duration::from_millis(4);
const STRETCH: f64 = 2.0;

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
    /// Live time in s from which on it is a motion of its own.
    since: f64,
    /// What it settles to, where that was known when it was pinned; else what was asked.
    known: Option<Summary>,
    asked: Latest<Summary>,
}

impl Pin {
    /// What it is called.
    pub fn letter(&self) -> char {
        self.letter
    }

    /// Which of the pins it is, from 0.
    pub fn place(&self) -> usize {
        LETTERS.iter().position(|own| *own == self.letter).unwrap_or(0)
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

    /// Live time in s from which on it is a motion of its own.
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
        self.known.as_ref().or(self.asked.current())
    }

    fn ask(&mut self, wake: &Wake) {
        let model = self.watch.from_here().unwrap_or_else(|| (*self.model).clone());
        self.known = None;
        self.asked.ask(wake, move |cancel| study::settled(&model, cancel));
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

    /// The one that is called so.
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

    /// Takes in what has been computed meanwhile.
    pub(super) fn poll(&mut self) {
        for pin in &mut self.all {
            pin.asked.poll();
        }
    }

    /// All from their own starts again.
    pub(super) fn restart(&mut self, wake: &Wake) {
        for pin in &mut self.all {
            (pin.watch, pin.since) = (Watch::new(&pin.model), 0.0);
            pin.ask(wake);
        }
    }

    /// For how long what they settle to has been worked on.
    pub(super) fn working(&self) -> Option<Duration> {
        self.all.iter().filter_map(|pin| pin.asked.running_for()).max()
    }

    /// Stops that.
    pub(super) fn stop_working(&mut self) {
        self.all.iter_mut().for_each(|pin| pin.asked.stop());
    }
}
