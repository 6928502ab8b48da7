//! Background questions about the open scene: settled motion, thresholds, accuracy.

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::Identity;
use crate::app::words::status;
use crate::dynamics::Model;
use crate::scene::{Excitation, Scene};
use crate::study::{self, Task};

use super::Session;

/// A run that follows the live motion from an instant on.
#[derive(Clone, PartialEq)]
pub(super) struct LiveRun {
    pub model: Identity<Model>,
    /// Live time in s at which it begins.
    pub from: f64,
}

impl Session {
    pub(super) fn ask_settled(&mut self) {
        let (now, from_here) = (self.player.watch().time(), self.player.watch().from_here());
        // no run follows a ramp that was changed on its way: the error of the motion is not known
        let is_followed = now == 0.0 || from_here.is_some();
        let from = if from_here.is_some() { now } else { 0.0 };
        let model = Identity(Arc::new(from_here.unwrap_or_else(|| (*self.model).clone())));
        let run = LiveRun { model, from };
        self.accuracy.begin(is_followed.then(|| run.clone()));
        self.settled.ask(run, &self.wake, |run, cancel, _| study::settled(&run.model.0, cancel));
    }

    /// Asks for the thresholds unless they have been asked for.
    pub(super) fn ask_thresholds(&mut self) {
        if !self.is_searched() {
            return;
        }
        let (scene, mechanism) = (self.built.clone(), Arc::clone(&self.mechanism));
        self.thresholds.want(unshaken(&scene), true, &self.wake, move |_, cancel, _| {
            study::thresholds(&scene, &mechanism, &Task { tick: &|| (), cancel })
        });
    }

    /// Forgets what it would take to cross where that was about another scene.
    pub(super) fn forget_ways(&mut self) {
        if self.fault.is_some() || self.thresholds.question() != Some(&unshaken(&self.built)) {
            self.thresholds.clear();
        }
        self.stops_that_cross.clear();
    }

    /// What it would take to cross, in words; a search for it is begun where it is not known.
    pub fn ways(&mut self) -> String {
        if self.keeps_remedy {
            return "What it would take is for you to find out.".to_owned();
        }
        if !self.is_searched() {
            return "What it would take is searched for where a sine shakes a mass with two wells."
                .to_owned();
        }
        let mechanism = Arc::clone(&self.mechanism);
        let restitutions = [&self.built.stops, &self.remembered_stops].map(|stops| stops.restitutions()[1]);
        let restitution = restitutions.into_iter().flatten().next().unwrap_or(1.0);
        let still = !self.editor.in_gesture();
        self.stops_that_cross.want(self.built.clone(), still, &self.wake, move |scene, cancel, _| {
            study::stops_that_cross(scene, &mechanism, restitution, &Task { tick: &|| (), cancel })
        });
        match (self.settled.answer(), self.thresholds.answer(), self.stops_that_cross.answer()) {
            (Some(settled), Some(thresholds), Some(stops)) => {
                status::ways(self.scene(), settled, thresholds, *stops)
            }
            _ if self.working().is_none() => {
                "The search was stopped: the next change begins it again.".to_owned()
            }
            _ => "Looking for what it would take.".to_owned(),
        }
    }

    /// Has the error of the motion worked out once the scene stands still and the settled motion is known.
    pub(super) fn follow_accuracy(&mut self) {
        self.accuracy.poll();
        if self.stands_still() && self.settled.answer().is_some() {
            self.accuracy.follow(self.player.watch().time(), &self.wake);
        }
    }

    /// The longest time that has been worked on a sentence about the scene; none where nothing is.
    pub fn working(&self) -> Option<Duration> {
        let all = [
            self.settled.running_for(),
            self.thresholds.running_for(),
            self.stops_that_cross.running_for(),
            self.accuracy.working(),
            self.pins.working(),
        ];
        all.into_iter().flatten().max()
    }

    /// Stops that; the next change asks again.
    pub fn stop_working(&mut self) {
        self.settled.pause();
        self.thresholds.pause();
        self.stops_that_cross.pause();
        self.accuracy.stop();
        self.pins.stop_working();
    }

    /// Asks what digits and steps cost in the scene, in a frame in which the view shows it.
    pub fn want_accuracy(&mut self) {
        self.accuracy.want(&self.model, self.stands_still(), &self.wake);
    }

    /// Whether the scene can be run and no hand is about to change it or its motion.
    pub(super) fn stands_still(&self) -> bool {
        !self.editor.in_gesture() && !self.player.is_held() && self.fault.is_none()
    }

    /// How accurate the motion is, in a few words and in full; none while nothing moves by itself, and where
    /// nothing is known.
    pub fn trust(&self) -> Option<(String, String)> {
        let moves = self.fault.is_none() && !self.player.is_held() && self.player.ended().is_none();
        self.accuracy.words().filter(|_| moves)
    }

    /// Whether what it would take is searched for.
    fn is_searched(&self) -> bool {
        self.fault.is_none()
            && matches!(self.built.excitation, Excitation::Sine { .. })
            && self.mechanism.landscape.barrier.is_some()
    }
}

/// A scene with its shaking at 0 g: scenes that differ in the amplitude alone have the same thresholds.
fn unshaken(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    if let Excitation::Sine { amplitude_g, .. } = &mut scene.excitation {
        *amplitude_g = 0.0;
    }
    scene
}
