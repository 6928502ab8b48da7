//! The reference, with which the present motion is compared: the scene as it was opened, or as it was pinned.

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Background, Wake};
use crate::dynamics::Summary;
use crate::scene::Scene;
use crate::system::clock::WallClock;
use interwell_studies::study::{Thresholds, Watch};

use super::accuracy::LiveRun;
use super::ask::unshaken;
use super::prepared::SharedModel;
use super::{Card, Session};

/// Computing time that one frame spends to bring the motion of the reference up to the present.
const FRAME_SHARE: Duration = Duration::from_millis(4);
/// Motion between two checks of that time, in multiples of the characteristic time.
const CHECK_INTERVAL: f64 = 2.0;

/// Difference of two states of one scene, as a share of its scales of length and speed, below which they are
/// one motion again.
const EQUAL: f64 = 1e-9;

pub struct Reference {
    pub scene: Arc<Scene>,
    model: SharedModel,
    /// Whether it was pinned; else it is the scene as it was opened.
    pub is_pinned: bool,
    /// Its motion, while that is not the present one.
    apart: Option<Apart>,
    /// What it settles to, if that was known when the present motion left it.
    known: Option<Summary>,
    /// The answer what it settles to, if that was not known then.
    settled: Background<LiveRun, Summary>,
    /// Its thresholds, if they were searched for the open scene.
    thresholds: Option<Thresholds>,
}

/// The motion of the reference, which continues at the live time and drive phase of the present one.
pub struct Apart {
    pub watch: Watch,
    /// Live time in s from which on it is computed separately.
    pub since: f64,
}

impl Apart {
    fn is_behind(&self, t: f64) -> bool {
        self.watch.time() < t && self.watch.ended().is_none()
    }

    /// Continues to the live time `to` in s, or as far as a frame's share of computing time allows.
    fn follow(&mut self, to: f64, stretch: f64) {
        let begun = WallClock::start();
        while self.is_behind(to) {
            let before = self.watch.time();
            self.watch.advance((before + stretch).min(to));
            if self.watch.time() <= before || begun.elapsed() >= FRAME_SHARE {
                break;
            }
        }
    }
}

impl Reference {
    pub(super) fn new(scene: Arc<Scene>, model: SharedModel, is_pinned: bool) -> Self {
        let (apart, known, settled, thresholds) = (None, None, Background::default(), None);
        Self { scene, model, is_pinned, apart, known, settled, thresholds }
    }

    /// Its motion, if that is not the present one.
    pub fn apart(&self) -> Option<&Apart> {
        self.apart.as_ref()
    }

    pub fn is_behind(&self, t: f64) -> bool {
        self.apart.as_ref().is_some_and(|apart| apart.is_behind(t))
    }

    fn set_apart(&mut self, apart: Apart, known: Option<Summary>, wake: &Wake) {
        self.known = known;
        if known.is_none() {
            let run = LiveRun { model: self.model.or(apart.watch.from_here()), from: apart.watch.time() };
            self.settled.ask(run, wake);
        }
        self.apart = Some(apart);
    }

    pub(super) fn poll(&mut self) {
        self.settled.poll();
    }

    /// Begins again from the start; `is_present` if the present motion does so with the same scene.
    pub(super) fn restart(&mut self, is_present: bool, wake: &Wake) {
        self.apart = None;
        if !is_present {
            self.set_apart(Apart { watch: Watch::new(&self.model), since: 0.0 }, None, wake);
        }
    }

    pub(super) fn working(&self) -> Option<Duration> {
        self.settled.running_for()
    }

    pub(super) fn stop_working(&mut self) {
        self.settled.pause();
    }
}

impl Session {
    /// Makes the present scene and motion the reference; the error says why they cannot be.
    pub fn pin(&mut self) -> Result<(), String> {
        self.end_gesture();
        self.apply();
        if let Some(fault) = self.fault() {
            return Err(format!("No motion of this scene can be pinned: {fault}"));
        }
        self.reference = Reference::new(Arc::clone(self.editor.shared()), self.model.clone(), true);
        Ok(())
    }

    /// Replaces the scene by that of the reference, as one undo step. Returns whether the scene changed.
    pub fn take_back(&mut self) -> bool {
        let scene = Scene::clone(&self.reference.scene);
        self.edit_once(|edited| *edited = scene)
    }

    /// Has the motion of the reference go on by itself; to be called before the present one is changed.
    pub(super) fn leave_reference(&mut self) {
        if self.reference.apart.is_none() {
            let watch = self.player.watch().clone();
            let (since, known) = (watch.time(), self.settled.answer().copied());
            self.reference.set_apart(Apart { watch, since }, known, &self.wake);
        }
    }

    /// Continues the motion of the reference to the live time; to be called after the present one has been
    /// advanced.
    pub fn follow_reference(&mut self) {
        let Some(apart) = &mut self.reference.apart else { return };
        let (watch, model) = (self.player.watch(), &self.reference.model);
        apart.watch.keep_ledgers(watch.keeps_ledgers());
        apart.follow(watch.time(), CHECK_INTERVAL * model.characteristic_time());
        let ((now, other), scales) = ((watch.now(), apart.watch.now()), model.scales());
        let is_met = now.t == other.t
            && (now.x - other.x).abs() <= EQUAL * scales.length
            && (now.v - other.v).abs() <= EQUAL * scales.speed
            && now.electrical == other.electrical;
        if is_met && !self.player.is_held() && *self.editor.shared() == self.reference.scene {
            self.reference.apart = None;
        }
    }

    /// The reference and what it settles to, if its scene or its motion is not the present one.
    pub fn reference_card(&self) -> Option<Card> {
        let reference = &self.reference;
        let apart = reference.apart.as_ref()?;
        Some(Card {
            scene: Arc::clone(&reference.scene),
            settled: reference.known.or(reference.settled.answer().copied()),
            thresholds: reference.thresholds.filter(|_| !self.keeps_remedy),
            ended: apart.watch.ended().and_then(|outcome| outcome.ended_at()),
        })
    }

    /// Copies the thresholds of the open scene to the reference, if its scene has the same ones.
    pub(super) fn note_thresholds(&mut self) {
        if let (None, Some(asked), Some(found)) =
            (self.reference.thresholds, self.thresholds.question(), self.thresholds.answer())
        {
            let is_same = unshaken(&self.reference.scene) == *asked.0.of;
            self.reference.thresholds = is_same.then_some(*found);
        }
    }
}
