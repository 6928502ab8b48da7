//! The open scene with its model, its motion and what is known about it.
//!
//! Everything here works without a window; the views look at it and change it through its methods.

pub mod accuracy;
mod ask;
pub mod best;
mod build;
mod companions;
mod edit;
pub mod editor;
pub mod explore;
pub mod lesson;
pub mod map;
pub mod measured;
pub mod pins;
pub mod player;
mod sentence;
mod sliders;
mod state;
mod stops;

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Background, Wake};
use crate::dynamics::Model;
use crate::mechanics::{FLEXURE_TOLERANCE, Mechanism};
use crate::study;

use accuracy::Accuracy;
use best::BestStops;
pub use build::CannotRun;
use build::{solved, unbuilt, why};
use editor::Editor;
use explore::Explore;
use map::Mapping;
use measured::MeasuredData;
use pins::Pins;
use player::{Player, fitting_speed};
pub use state::{Card, OpenedScales, Session};
use stops::first_stops;

/// Time that the background works before the window offers to stop it.
pub const OFFER_TO_STOP: Duration = Duration::from_secs(2);

/// Share of the characteristic time for which a motion that has ended must be able to go on; else it begins
/// again.
const MOMENT: f64 = 0.02;

/// Share of the length scale by which a change has to carry the mass to be mentioned.
const CARRIED: f64 = 0.02;

impl Session {
    /// A session on a scene; `wake` is called from other threads when something has come.
    pub fn new(editor: Editor, wake: Wake) -> Result<Self, CannotRun> {
        let document = editor.document();
        let (mechanism, model) = solved(document, FLEXURE_TOLERANCE)?;
        let scene = editor.scene().clone();
        let hints = scene.app.clone().unwrap_or_default();
        let speed = hints.speed.unwrap_or_else(|| fitting_speed(model.characteristic_time()));
        let player = Player::new(&model, speed);
        let remembered_stops = first_stops(&scene, &model);
        let opened = OpenedScales::of(&model);
        let mut session = Self {
            editor,
            model: Arc::new(model),
            fault: None,
            player,
            settled: Background::default(),
            thresholds: Background::default(),
            stops_that_cross: Background::default(),
            accuracy: Accuracy::default(),
            map: Mapping::default(),
            explore: Explore::default(),
            pins: Pins::default(),
            measured: MeasuredData::default(),
            before: None,
            mechanism_of: scene.mechanism.clone(),
            is_coarse: false,
            refused: None,
            built: scene,
            mechanism,
            changed_at: 0.0,
            by_hand: false,
            carried: false,
            opened,
            continued: false,
            remembered_stops,
            presses: None,
            keeps_remedy: false,
            best: BestStops::default(),
            wake,
        };
        session.map.trail.note(&session.built);
        session.ask_settled();
        session.ask_thresholds();
        Ok(session)
    }

    /// Takes in what has been computed meanwhile, and what was edited. To be called once a frame.
    pub fn poll(&mut self) {
        self.settled.poll();
        self.thresholds.poll();
        self.stops_that_cross.poll();
        self.map.cells.poll();
        self.explore.poll();
        self.pins.poll();
        self.measured.poll();
        self.apply();
        self.follow_accuracy();
    }

    /// Pauses what no view has wanted in this frame. To be called once a frame.
    pub fn end_frame(&mut self) {
        self.map.cells.end_frame();
        self.explore.end_frame();
        self.measured.found.end_frame();
        self.accuracy.end_frame();
        self.player.end_frame();
    }

    /// Begins the motion from its start again.
    pub fn restart(&mut self) {
        self.player.restart(&self.model);
        self.pins.restart(&self.wake);
        (self.changed_at, self.continued, self.by_hand) = (0.0, false, false);
        self.carried = false;
        self.ask_settled();
    }

    /// Plays or pauses; a motion that has ended begins again from its start.
    pub fn play_or_pause(&mut self) {
        let playing = self.player.is_playing();
        if !playing && !self.player.is_past() && self.player.ended().is_some() {
            self.restart();
        }
        self.player.set_playing(!playing);
    }

    /// To be called when the mass has been moved by hand: asks again what it settles to.
    pub fn moved_by_hand(&mut self) {
        (self.changed_at, self.continued, self.by_hand) = (self.player.watch().time(), true, true);
        self.carried = false;
        self.ask_settled();
    }

    /// Takes over the edited scene: the motion goes on by it from where it is.
    pub(super) fn apply(&mut self) {
        if *self.editor.scene() == self.built {
            return;
        }
        self.built = self.editor.scene().clone();
        match self.build() {
            Ok(model) => {
                self.fault = None;
                self.model = Arc::new(model);
                self.map.trail.note(&self.built);
                self.go_on();
            }
            Err(error) => {
                self.fault = Some(why(&error, self.editor.scene()));
                self.settled.clear();
                self.accuracy.begin(None);
            }
        }
        self.forget_ways();
    }

    /// Lets the motion go on from its present state by the model; a motion that has ended and cannot go on
    /// from there begins again.
    fn go_on(&mut self) {
        let (ended, before) = (self.player.ended().is_some(), self.player.watch().now().x);
        self.player.change(&self.model);
        if ended && !self.can_go_on() {
            return self.restart();
        }
        let now = self.player.watch().now().x;
        let (left, right) = self.model.stop_positions();
        let is_far = (now - before).abs() > CARRIED * self.model.scales().length;
        self.carried = is_far && [left, right].contains(&Some(now));
        (self.changed_at, self.continued, self.by_hand) = (self.player.watch().time(), true, false);
        self.ask_settled();
    }

    /// Whether the motion can go on from its present state for a moment at least.
    fn can_go_on(&self) -> bool {
        let Some(model) = self.player.watch().from_here() else { return false };
        study::lasts(&model, MOMENT * model.characteristic_time())
    }

    /// Whether the last change carried the mass to a stop, and it has not moved on for long.
    pub fn was_set_on_stop(&self) -> bool {
        let since = self.player.watch().time() - self.changed_at;
        self.carried && (self.settling().is_some() || since < self.model.characteristic_time())
    }

    /// How far the motion has come, after a change, towards the one that the sentence describes: seconds
    /// passed, and of how many.
    pub fn settling(&self) -> Option<(f64, f64)> {
        let moves = self.model.is_shaken() && self.player.ended().is_none();
        let facts = self.facts().filter(|_| moves && self.changed_at > 0.0)?;
        let (passed, of) = (facts.now - facts.origin, facts.seen_from() - facts.origin);
        (passed < of).then_some((passed, of))
    }

    /// The model of the scene as it stands.
    pub(super) fn build(&mut self) -> Result<Model, CannotRun> {
        let document = &self.editor.runnable();
        document.check()?;
        let scene = &document.scene;
        if scene.mechanism != self.mechanism_of {
            let built = Mechanism::build(&scene.mechanism, &document.files)
                .map_err(|error| unbuilt(document, error))?;
            self.mechanism = Arc::new(built);
            self.mechanism_of = scene.mechanism.clone();
        }
        Ok(Model::build(scene, Arc::clone(&self.mechanism)).map_err(|faults| document.error_from(faults))?)
    }

    /// Waits until it is known what the motion settles to, for `limit` at the longest.
    pub fn wait_settled(&mut self, limit: Duration) {
        self.apply();
        self.settled.wait(limit);
    }

    /// Waits for each sentence about the scene that is being worked out, for `limit` at the longest.
    pub fn wait(&mut self, limit: Duration) {
        self.wait_settled(limit);
        self.thresholds.wait(limit);
        self.stops_that_cross.wait(limit);
        self.follow_accuracy();
        self.accuracy.wait(limit);
    }
}
