//! The open scene, with its model, its motion and the results of background computations.
//!
//! Everything here works without a window; the views read it and change it through its methods.

pub mod accuracy;
mod ask;
pub mod best;
mod build;
mod edit;
pub mod editor;
pub mod explore;
pub mod lesson;
pub mod map;
pub mod measured;
pub mod pins;
pub mod player;
pub mod sliders;
mod state;

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Background, Wake};
use crate::dynamics::Model;
use crate::mechanics::FLEXURE_TOLERANCE;
use crate::study;

use accuracy::Accuracy;
use best::BestStops;
pub use build::CannotRun;
use build::{fault_message, first_stops, solve};
use editor::Editor;
use explore::Explore;
use map::Mapping;
use measured::MeasuredData;
use pins::Pins;
use player::{Player, opening_speed};
pub use state::{Card, OpenedScales, Session};

/// Time after which the user is offered to stop a background computation.
pub const OFFER_TO_STOP: Duration = Duration::from_secs(2);

/// Least time for which an ended motion has to continue, as a share of the characteristic time.
const LEAST_CONTINUATION: f64 = 0.02;

/// Least displacement of the mass by a change that is reported, as a share of the length scale.
const REPORTED_MOVE: f64 = 0.02;

impl Session {
    /// A session on a scene; `wake` is called from other threads when a result has come.
    pub fn new(editor: Editor, wake: Wake) -> Result<Self, CannotRun> {
        let document = editor.document();
        let (mechanism, model) = solve(document, FLEXURE_TOLERANCE)?;
        let scene = editor.scene().clone();
        let mut session = Self {
            editor,
            fault: None,
            player: Player::new(&model, opening_speed(&scene, &model)),
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
            mechanism,
            changed_at: 0.0,
            by_hand: false,
            moved_to_stop: false,
            opened: OpenedScales::of(&model),
            continued: false,
            remembered_stops: first_stops(&scene, &model),
            model: Arc::new(model),
            presses: None,
            keeps_remedy: false,
            best: BestStops::default(),
            built: scene,
            wake,
        };
        session.map.trail.note(&session.built);
        session.ask_settled();
        session.ask_thresholds();
        Ok(session)
    }

    /// Receives background results and applies edits; to be called once a frame.
    pub fn poll(&mut self) {
        self.settled.poll();
        self.thresholds.poll();
        self.stops_that_cross.poll();
        self.map.take();
        self.explore.poll();
        self.pins.poll();
        self.measured.poll();
        self.apply();
        self.follow_accuracy();
    }

    /// Stops what no view has asked for in this frame; to be called once a frame.
    pub fn end_frame(&mut self) {
        self.map.end_frame();
        self.measured.found.end_frame();
        self.explore.end_frame();
        self.accuracy.end_frame();
        self.player.end_frame();
    }

    pub fn restart(&mut self) {
        self.player.restart(&self.model);
        self.pins.restart(&self.wake);
        (self.changed_at, self.continued, self.by_hand) = (0.0, false, false);
        self.moved_to_stop = false;
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

    /// Notes that the mass has been moved by hand, and asks again what the motion settles to.
    pub fn moved_by_hand(&mut self) {
        (self.changed_at, self.continued, self.by_hand) = (self.player.watch().time(), true, true);
        self.moved_to_stop = false;
        self.ask_settled();
    }

    /// Applies the edited scene to the motion, if it has changed.
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
                self.continue_motion();
            }
            Err(error) => {
                self.fault = Some(fault_message(&error, &self.built));
                self.settled.clear();
                self.accuracy.begin(None);
            }
        }
        self.forget_ways();
    }

    /// Continues the motion with the new model; a motion that has ended and cannot continue is restarted.
    fn continue_motion(&mut self) {
        let (ended, before) = (self.player.ended().is_some(), self.player.watch().now().x);
        self.player.change(&self.model);
        if ended && !self.can_continue() {
            return self.restart();
        }
        let now = self.player.watch().now().x;
        let (left, right) = self.model.stop_positions();
        let is_far = (now - before).abs() > REPORTED_MOVE * self.model.scales().length;
        self.moved_to_stop = is_far && [left, right].contains(&Some(now));
        (self.changed_at, self.continued, self.by_hand) = (self.player.watch().time(), true, false);
        self.ask_settled();
    }

    /// Whether the motion continues from its present state for at least a short time.
    fn can_continue(&self) -> bool {
        let Some(model) = self.player.watch().from_here() else { return false };
        study::lasts(&model, LEAST_CONTINUATION * model.characteristic_time())
    }

    /// Whether the last change moved the mass to a stop, and the motion since then is short.
    pub fn was_set_on_stop(&self) -> bool {
        let elapsed = self.player.watch().time() - self.changed_at;
        self.moved_to_stop && (self.settling().is_some() || elapsed < self.model.characteristic_time())
    }

    /// Progress after a change towards the settled motion: the elapsed and the whole time in s.
    pub fn settling(&self) -> Option<(f64, f64)> {
        let moves = self.model.is_shaken() && self.player.ended().is_none();
        let facts = self.sentence_facts().filter(|_| moves && self.changed_at > 0.0)?;
        let (elapsed, whole) = (facts.now - facts.origin, facts.seen_from() - facts.origin);
        (elapsed < whole).then_some((elapsed, whole))
    }

    fn build(&mut self) -> Result<Model, CannotRun> {
        let document = &self.editor.runnable();
        document.check()?;
        if document.scene.mechanism != self.mechanism_of {
            self.mechanism = build::mechanism(document, FLEXURE_TOLERANCE)?;
            self.mechanism_of = document.scene.mechanism.clone();
        }
        build::model(document, &self.mechanism)
    }

    /// Waits at most `timeout` until it is known what the motion settles to.
    pub fn wait_settled(&mut self, timeout: Duration) {
        self.apply();
        self.settled.wait(timeout);
    }

    /// Waits for the background computations about the scene, at most `timeout` for each.
    pub fn wait(&mut self, timeout: Duration) {
        self.wait_settled(timeout);
        self.thresholds.wait(timeout);
        self.stops_that_cross.wait(timeout);
        self.follow_accuracy();
        self.accuracy.wait(timeout);
    }
}
