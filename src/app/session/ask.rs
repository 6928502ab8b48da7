//! Background questions about the open scene: settled motion, thresholds, accuracy.

use std::sync::Arc;
use std::time::Duration;

use crate::app::words::status;
use crate::scene::Excitation;
use crate::study;

use super::Session;

impl Session {
    pub(super) fn ask_settled(&mut self) {
        let (now, from_here) = (self.player.watch().time(), self.player.watch().from_here());
        // a ramp that was changed on its way is no run of its own: nothing is known of its error
        let is_known = now == 0.0 || from_here.is_some();
        self.asked_from = if from_here.is_some() { now } else { 0.0 };
        let model = Arc::new(from_here.unwrap_or_else(|| (*self.model).clone()));
        self.accuracy.begin(is_known.then(|| (Arc::clone(&model), now)));
        self.settled.ask(&self.wake, move |cancel| study::settled(&model, cancel));
    }

    pub(super) fn ask_thresholds(&mut self) {
        if self.thresholds.is_running() || self.thresholds.current().is_some() || !self.is_searched() {
            return;
        }
        let (scene, mechanism) = (self.built.clone(), Arc::clone(&self.mechanism));
        self.thresholds.ask(&self.wake, move |cancel| {
            study::thresholds(&scene, &mechanism, &study::Task { tick: &|| (), cancel })
        });
    }

    /// What it would take to cross, in words: asked for, it is searched for.
    pub fn ways(&mut self) -> String {
        if self.keeps_remedy {
            return "What it would take is for you to find out.".to_owned();
        }
        if !self.is_searched() {
            return "What it would take is searched for where a sine shakes a mass with two wells."
                .to_owned();
        }
        if self.stops_that_cross.current().is_none()
            && !self.stops_that_cross.is_running()
            && !self.editor.in_gesture()
        {
            let (scene, mechanism) = (self.built.clone(), Arc::clone(&self.mechanism));
            let own =
                [&scene.stops, &self.remembered_stops].into_iter().find_map(|stops| stops.restitutions()[1]);
            let restitution = own.unwrap_or(1.0);
            self.stops_that_cross.ask(&self.wake, move |cancel| {
                let task = study::Task { tick: &|| (), cancel };
                study::stops_that_cross(&scene, &mechanism, restitution, &task)
            });
        }
        match (self.settled.current(), self.thresholds.current(), self.stops_that_cross.current()) {
            (Some(settled), Some(thresholds), Some(stops)) => {
                status::ways(self.scene(), settled, thresholds, *stops)
            }
            _ if self.working().is_none() => {
                "The search was stopped: the next change begins it again.".to_owned()
            }
            _ => "Looking for what it would take.".to_owned(),
        }
    }

    /// Has the error of the motion worked out once the scene stands still and it is known what it settles to.
    pub(super) fn follow_accuracy(&mut self) {
        self.accuracy.poll();
        if self.stands_still() && self.settled.current().is_some() {
            self.accuracy.follow(self.player.watch().time(), &self.wake);
        }
    }

    /// For how long the background has worked on what is said of the scene; none where it does not.
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

    /// Stops it; the next change asks again.
    pub fn stop_working(&mut self) {
        self.settled.stop();
        self.thresholds.stop();
        self.stops_that_cross.stop();
        self.accuracy.stop();
        self.pins.stop_working();
    }

    /// Asks, for a view, what digits and steps cost in the scene; to be asked anew in every frame.
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
        let own = self.fault.is_none() && !self.player.is_held() && self.player.ended().is_none();
        self.accuracy.words().filter(|_| own)
    }

    /// Whether what it would take is searched for.
    fn is_searched(&self) -> bool {
        self.fault.is_none()
            && matches!(self.built.excitation, Excitation::Sine { .. })
            && self.mechanism.landscape.barrier.is_some()
    }
}
