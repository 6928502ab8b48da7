//! Background questions about the open scene: settled motion, thresholds, accuracy.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::app::task::{Each, Question, Uncompared, progress};
use crate::app::words::status;
use crate::mechanics::Mechanism;
use crate::questions::{stops_that_cross, thresholds};
use crate::scene::{Scene, Start};
use interwell_studies::study::{Thresholds, can_cross};

use super::Session;
use super::accuracy::{LiveRun, StepQuestion, TolerancesQuestion};
use super::prepared::{Prepared, SceneWithFiles};

/// Number of thresholds that are kept.
const KEPT: usize = 64;

/// Thresholds that were found, with their scene and its mechanism.
type Earlier = (Arc<Scene>, Arc<Mechanism>, Thresholds);

/// Thresholds of earlier scenes, oldest first: a scene that comes back by an undo or in a lesson needs no
/// search.
fn earlier() -> MutexGuard<'static, Vec<Earlier>> {
    static FOUND: Mutex<Vec<Earlier>> = Mutex::new(Vec::new());
    FOUND.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The thresholds of an unshaken scene, from [`earlier`] or searched.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ThresholdsQuestion(pub Prepared);

impl Question for ThresholdsQuestion {
    const NAME: &'static str = "thresholds";
    type Part = Thresholds;

    fn answer(&self, cancel: &AtomicBool, _: Each<Thresholds>) -> Option<Thresholds> {
        let Prepared { of: SceneWithFiles { scene, .. }, mechanism, .. } = &self.0;
        let known = earlier().iter().find(|kept| kept.0 == *scene && kept.1 == *mechanism).map(|kept| kept.2);
        known.or_else(|| {
            let thresholds = thresholds(scene, mechanism, &progress(cancel))?;
            let mut all = earlier();
            if all.len() == KEPT {
                all.remove(0);
            }
            all.push((Arc::clone(scene), Arc::clone(mechanism), thresholds));
            Some(thresholds)
        })
    }
}

/// The travel limit with which the mass of a scene would cross the barrier.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StopsQuestion {
    pub of: Prepared,
    /// The restitution of all stops.
    pub restitution: Uncompared<f64>,
}

impl Question for StopsQuestion {
    const NAME: &'static str = "stops that cross";
    type Part = Option<f64>;

    fn answer(&self, cancel: &AtomicBool, _: Each<Option<f64>>) -> Option<Option<f64>> {
        let Self { of, restitution } = self;
        stops_that_cross(&of.of, &of.mechanism, restitution.0, &progress(cancel)).ok()
    }
}

impl Session {
    /// A scene with the mechanism of the open one.
    pub(super) fn prepared(&self, scene: impl Into<Arc<Scene>>) -> Prepared {
        let (of, mechanism) = (self.with_files(scene), Arc::clone(&self.mechanism));
        Prepared { of, mechanism, tolerance: self.tolerance }
    }

    /// A scene with the files of the open one.
    pub(super) fn with_files(&self, scene: impl Into<Arc<Scene>>) -> SceneWithFiles {
        SceneWithFiles::of(self.editor.document(), scene)
    }

    pub(super) fn ask_settled(&mut self) {
        let (now, from_here) = (self.player.watch().time(), self.player.watch().from_here());
        // a ramp that was changed under way cannot be run again from there, so its error is unknown
        let is_known = now == 0.0 || from_here.is_some();
        let from = if from_here.is_some() { now } else { 0.0 };
        let run = LiveRun { model: self.model.or(from_here), from };
        self.accuracy.begin(is_known.then(|| run.clone()));
        self.settled.ask(run, &self.wake);
    }

    pub(super) fn ask_thresholds(&mut self) {
        if self.can_search() {
            let question = ThresholdsQuestion(self.prepared(unshaken(&self.built)));
            self.thresholds.want(question, true, &self.wake);
        }
    }

    /// Drops the answers about what it would take to cross. The thresholds stay if only the amplitude was
    /// changed.
    pub(super) fn forget_ways(&mut self) {
        let is_other = |asked: &ThresholdsQuestion| *asked.0.of.scene != unshaken(&self.built);
        if self.fault.is_some() || self.thresholds.question().is_none_or(is_other) {
            self.thresholds.clear();
        }
        self.stops_that_cross.clear();
    }

    /// What it would take to cross the barrier, in words; the first call starts the search.
    pub fn ways(&mut self) -> String {
        if self.keeps_remedy {
            return "What it would take is for you to find out.".to_owned();
        }
        if !self.can_search() {
            return "What it would take is searched for where a sine shakes a mass with two wells."
                .to_owned();
        }
        let known = [&self.built.stops, &self.remembered_stops];
        let restitution = known.into_iter().find_map(|stops| stops.restitutions()[1]).unwrap_or(1.0);
        let (of, restitution) = (self.prepared(Arc::clone(&self.built)), Uncompared(restitution));
        let question = StopsQuestion { of, restitution };
        self.stops_that_cross.want(question, !self.editor.in_gesture(), &self.wake);
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

    /// Starts to compute the error of the motion once the scene stands still and its settled motion is known.
    pub(super) fn follow_accuracy(&mut self) {
        self.accuracy.trust.poll();
        self.accuracy.tolerances.poll();
        self.accuracy.stepped.poll();
        if self.stands_still() && self.settled.answer().is_some() {
            self.accuracy.follow(self.player.watch().time(), &self.wake);
        }
    }

    /// How long the longest background computation about the scene has been running; `None` if none is.
    pub fn working(&self) -> Option<Duration> {
        let times = [
            self.settled.running_for(),
            self.thresholds.running_for(),
            self.stops_that_cross.running_for(),
            self.accuracy.working(),
            self.reference.working(),
        ];
        times.into_iter().flatten().max()
    }

    /// Stops the background computations about the scene; the next change starts them again.
    pub fn stop_working(&mut self) {
        self.settled.pause();
        self.thresholds.pause();
        self.stops_that_cross.pause();
        self.accuracy.stop();
        self.reference.stop_working();
    }

    /// Asks for the cost of digits and steps in the scene; to be called by a view in every frame. While the
    /// scene is being changed the answers for an earlier one stay.
    pub fn want_accuracy(&mut self) {
        let (model, still, accuracy) = (self.model.clone(), self.stands_still(), &mut self.accuracy);
        accuracy.tolerances.want(TolerancesQuestion(model.clone()), still, &self.wake);
        let question = StepQuestion { model, scheme: accuracy.scheme, step: accuracy.step };
        accuracy.stepped.want(question, still, &self.wake);
    }

    /// Whether the scene can be run and the user is changing neither it nor its motion.
    pub(super) fn stands_still(&self) -> bool {
        !self.editor.in_gesture() && !self.player.is_held() && self.fault.is_none()
    }

    /// How accurate the motion is, in a few words and in full. `None` while the mass is held, after the end
    /// of the run, and while the accuracy is unknown.
    pub fn trust(&self) -> Option<(String, String)> {
        let moves = self.fault.is_none() && !self.player.is_held() && self.player.ended().is_none();
        self.accuracy.descriptions().filter(|_| moves)
    }

    pub(super) fn can_search(&self) -> bool {
        self.fault.is_none() && self.built.harmonic().is_some() && can_cross(&self.built, &self.mechanism)
    }
}

/// A scene from rest with a sine of 0 g in place of a harmonic drive: scenes that differ only in amplitude
/// and start have the same thresholds in g.
pub(super) fn unshaken(scene: &Scene) -> Scene {
    let mut scene = Scene { start: Start::Rest, ..scene.clone() };
    if let Some(drive) = scene.harmonic() {
        scene.excitation = drive.sine();
        scene.excitation.amplitude_mut().into_iter().for_each(|amplitude| *amplitude = 0.0);
    }
    scene
}
