//! The open scene with its model, its motion and what is known of it.
//!
//! Everything here works without a window; the views look at it and change it through its methods.

pub mod accuracy;
mod ask;
mod build;
mod companions;
mod edit;
pub mod editor;
pub mod map;
pub mod player;
mod sentence;
mod sliders;
mod stops;

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Latest, Wake};
use crate::dynamics::{Model, Outcome, Summary};
use crate::mechanics::Mechanism;
use crate::scene::{self, Excitation, Scene, Stops};
use crate::study::{self, Thresholds};

use accuracy::Accuracy;
pub use build::CannotRun;
use build::{differ_in_amplitude_alone, unbuilt, why};
use editor::Editor;
use map::Mapping;
use player::{Player, fitting_speed};
use stops::first_stops;

/// For how long the background works before it is offered to stop it.
pub const OFFER_TO_STOP: Duration = Duration::from_secs(2);

/// Share of a period for which a motion has to go on to be worth going on with.
const MOMENT: f64 = 0.02;

/// Share of the length scale by which a change has to carry the mass to be worth a word.
const CARRIED: f64 = 0.02;

/// Scales of a scene that set how far its sliders go: those of the scene as it was opened, so that no slider
/// jumps while another one is moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenedScales {
    /// Length in m.
    pub length: f64,
    /// Time in s.
    pub time: f64,
    /// Distance of the right-hand well from the middle in mm.
    pub well_mm: Option<f64>,
}

impl OpenedScales {
    fn of(model: &Model) -> Self {
        let well_mm = model.mechanism().landscape.right_stable().map(|well| well.x.abs() * 1e3);
        Self { length: model.scales().length, time: model.scales().time, well_mm }
    }
}

/// A side of the card Before / now.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    /// The scene.
    pub scene: Scene,
    /// What it settles to, once that is known.
    pub settled: Option<Summary>,
    /// How much shaking it takes, once that is known.
    pub thresholds: Option<Thresholds>,
}

/// An open scene.
pub struct Session {
    /// The scene and the way back.
    pub editor: Editor,
    /// The model that moves: of the scene, or of the last one that could be run.
    model: Arc<Model>,
    /// Why the scene as it stands cannot be run.
    fault: Option<String>,
    /// The motion.
    pub player: Player,
    settled: Latest<Summary>,
    thresholds: Latest<Thresholds>,
    /// The travel limit in mm with which it would cross; searched for only when somebody asks.
    stops_that_cross: Latest<Option<f64>>,
    /// How accurate the motion is.
    pub accuracy: Accuracy,
    /// The map of the scene.
    pub map: Mapping,
    before: Option<Card>,
    /// The scene that the model was built from.
    built: Scene,
    mechanism: Arc<Mechanism>,
    /// What the mechanism was built from: a table is fitted once, not for every move of a slider.
    mechanism_of: scene::Mechanism,
    /// Whether the mechanism was solved in a hurry, in the midst of a gesture.
    hurried: bool,
    /// What a hand asked of the mechanism and did not get, and why.
    refused: Option<String>,
    /// Live time in s of the last change.
    changed_at: f64,
    /// Whether that was a hand on the mass.
    by_hand: bool,
    /// Whether the last change carried the mass to a stop.
    carried: bool,
    /// The scales that the sliders keep while the scene is open.
    opened: OpenedScales,
    /// Live time in s at which the run begins that is asked what the motion settles to.
    asked_from: f64,
    /// The motion is no longer the run of the scene from its start: something was changed on its way.
    continued: bool,
    /// The stops that come back when they are switched on.
    remembered_stops: Stops,
    /// The field whose presses of arrow keys are one gesture, and the time in s of the last one.
    presses: Option<(&'static str, f64)>,
    wake: Wake,
}

impl Session {
    /// A session on a scene; `wake` is called from other threads when something has come.
    pub fn new(editor: Editor, wake: Wake) -> Result<Self, CannotRun> {
        let document = editor.document();
        document.check()?;
        let scene = editor.scene().clone();
        let mechanism =
            Mechanism::build(&scene.mechanism, &document.files).map_err(|error| unbuilt(document, error))?;
        let mechanism = Arc::new(mechanism);
        let model =
            Model::build(&scene, Arc::clone(&mechanism)).map_err(|faults| document.error_from(faults))?;
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
            settled: Latest::default(),
            thresholds: Latest::default(),
            stops_that_cross: Latest::default(),
            accuracy: Accuracy::default(),
            map: Mapping::default(),
            before: None,
            mechanism_of: scene.mechanism.clone(),
            hurried: false,
            refused: None,
            built: scene,
            mechanism,
            changed_at: 0.0,
            by_hand: false,
            carried: false,
            opened,
            asked_from: 0.0,
            continued: false,
            remembered_stops,
            presses: None,
            wake,
        };
        session.ask_settled();
        session.ask_thresholds();
        Ok(session)
    }

    /// The scene as it stands.
    pub fn scene(&self) -> &Scene {
        self.editor.scene()
    }

    /// The model that moves.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The model of what is shown: the one that held then, where the past is looked at.
    pub fn shown(&self) -> &Model {
        if self.player.is_past() { self.player.shown_model() } else { &self.model }
    }

    /// Why the scene as it stands cannot be run; the motion is that of the last one that could.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Calls back when something that was asked for has come.
    pub fn wake(&self) -> &Wake {
        &self.wake
    }

    /// Takes in what has been computed meanwhile, and what was edited. To be called once a frame.
    pub fn poll(&mut self) {
        self.settled.poll();
        self.thresholds.poll();
        self.stops_that_cross.poll();
        self.map.take();
        self.apply();
        self.follow_accuracy();
    }

    /// The scene and the time as they were opened, playing.
    pub fn back_to_start(&mut self) {
        self.travel(Editor::back_to_start);
        self.before = None;
        self.remembered_stops = first_stops(self.scene(), &self.model);
        self.restart();
        let hinted = self.scene().app.as_ref().and_then(|hints| hints.speed);
        self.player.speed = hinted.unwrap_or_else(|| fitting_speed(self.model.characteristic_time()));
        self.player.set_playing(true);
    }

    /// The motion from its start again.
    pub fn restart(&mut self) {
        self.player.restart(&self.model);
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

    /// The mass has been moved by hand: what it settles to is asked anew.
    pub fn moved_by_hand(&mut self) {
        (self.changed_at, self.continued, self.by_hand) = (self.player.watch().time(), true, true);
        self.carried = false;
        self.ask_settled();
    }

    /// Whether the last change was a hand on the mass.
    pub fn is_by_hand(&self) -> bool {
        self.by_hand
    }

    /// Lets the mass go on as the scene now says, where that has changed.
    fn apply(&mut self) {
        if *self.editor.scene() == self.built {
            return;
        }
        let before = std::mem::replace(&mut self.built, self.editor.scene().clone());
        match self.build() {
            Ok(model) => {
                self.fault = None;
                self.model = Arc::new(model);
                self.go_on();
                if !differ_in_amplitude_alone(&before, &self.built) {
                    self.thresholds.clear();
                }
                self.stops_that_cross.clear();
            }
            Err(error) => {
                self.fault = Some(why(&error, self.editor.scene()));
                self.settled.clear();
                self.accuracy.begin(None);
                self.thresholds.clear();
                self.stops_that_cross.clear();
            }
        }
    }

    /// Lets the motion go on from its present state by the model; one that has ended, and could not go on
    /// from there, begins again.
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

    /// Whether the motion goes on for a moment at least from its present state.
    fn can_go_on(&self) -> bool {
        let Some(model) = self.player.watch().from_here() else { return false };
        study::lasts(&model, MOMENT * model.characteristic_time())
    }

    /// Whether the last change carried the mass to a stop, and it has not moved on for long.
    pub fn was_set_on_stop(&self) -> bool {
        let gone = self.player.watch().time() - self.changed_at;
        self.carried && (self.settling().is_some() || gone < self.model.characteristic_time())
    }

    /// The scales of the scene as it was opened.
    pub fn opened(&self) -> OpenedScales {
        self.opened
    }

    /// Whether what the motion settles to crosses the barrier; none while that is not known.
    pub fn crosses(&self) -> Option<bool> {
        let summary = self.settled.current()?;
        (self.fault.is_none() && summary.outcome == Outcome::Done).then_some(summary.crossings > 0)
    }

    /// What the motion settles to; of an earlier scene while the answer is still to come.
    pub fn settled(&self) -> Option<&Summary> {
        self.settled.newest()
    }

    /// The scene as it stands, for the card.
    pub fn now_card(&self) -> Card {
        Card {
            scene: self.scene().clone(),
            settled: self.settled.current().copied(),
            thresholds: self.thresholds.current().copied(),
        }
    }

    /// The scene before the last gesture, for the card.
    pub fn before_card(&self) -> Option<&Card> {
        self.before.as_ref()
    }

    /// The time in s at which the run that is watched ends: as long after the last change as the scene says,
    /// or after the start where the shaking is a function of the time since then.
    pub fn end_of_run(&self) -> f64 {
        let begins_here = self.player.watch().from_here().is_some();
        self.model.duration() + if begins_here { self.changed_at } else { 0.0 }
    }

    /// Whether something was changed on the motion's way, so that it is no run of the scene from its start.
    pub fn is_continued(&self) -> bool {
        self.continued
    }

    /// Live time in s of the last change: of the scene, or of the mass by hand.
    pub fn changed_at(&self) -> f64 {
        self.changed_at
    }

    /// How far the motion has come, after a change, towards what the sentence tells of: seconds gone, and of
    /// how many.
    pub fn settling(&self) -> Option<(f64, f64)> {
        let goes = self.model.is_shaken() && self.player.ended().is_none();
        let told = self.told().filter(|_| goes && self.changed_at > 0.0)?;
        let (gone, of) = (told.now - told.origin, told.seen_from() - told.origin);
        (gone < of).then_some((gone, of))
    }

    /// Amplitude of the shaking in g, where it is a sine.
    pub fn amplitude_g(&self) -> Option<f64> {
        match self.scene().excitation {
            Excitation::Sine { amplitude_g, .. } => Some(amplitude_g),
            _ => None,
        }
    }
}
