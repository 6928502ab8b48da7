//! What is open in the window: a scene, its model, its motion, and what is known of it.
//!
//! Everything here works without a window; the views look at it and change it through its methods.

mod ask;
mod build;
mod hands;

use std::sync::Arc;
use std::time::Duration;

use crate::dynamics::Model;
use crate::mechanics::{FLEXURE_TOLERANCE, Mechanism};
use crate::scene::{self, Excitation, Scene, Stops};
use crate::study::{Settled, Thresholds};

use super::accuracy::Accuracy;
use super::document::Editor;
use super::fields::suiting_limit;
use super::map::Mapping;
use super::player::{Player, fitting_speed};
use super::status::{self, Sentence, Told};
use super::task::{Latest, Wake};

pub use build::CannotRun;
use build::{solved, unbuilt, why};

/// Error of the force of flexures while a hand still changes them: the curve is there within a frame, and what it is
/// off by is not seen. At the end of the gesture they are solved as every study solves them.
const HANDLED_TOLERANCE: f64 = 1e-6;

/// The share of speed that stops keep where a scene does not say which stops come.
const RESTITUTION: f64 = 0.36;

/// For how long the background works before it is offered to stop it.
pub const OFFER_TO_STOP: Duration = Duration::from_secs(2);

/// Time in s within which another press of an arrow key belongs to the same gesture.
const PRESSES: f64 = 1.0;

/// A side of the card Before / now.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    /// The scene.
    pub scene: Scene,
    /// What it settles to, once that is known.
    pub settled: Option<Settled>,
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
    settled: Latest<Settled>,
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

    /// Changes the scene as part of a gesture; see [`Editor::edit`].
    pub fn edit(&mut self, change: impl FnOnce(&mut Scene)) -> bool {
        let now = (!self.editor.in_gesture()).then(|| self.now_card());
        let changed = self.editor.edit(change);
        if let (true, Some(now)) = (changed, now) {
            self.before = Some(now);
        }
        changed
    }

    /// Changes the mechanism as part of a gesture, if the changed one can be solved and run; if not, everything stays
    /// as it is and [`refused`](Self::refused) says why. Whether it changed.
    pub fn edit_mechanism(&mut self, change: impl FnOnce(&mut scene::Mechanism)) -> bool {
        let mut document = self.editor.runnable();
        change(&mut document.scene.mechanism);
        if document.scene.mechanism == self.scene().mechanism {
            return false;
        }
        let wanted = document.scene.mechanism.clone();
        match solved(&document, HANDLED_TOLERANCE) {
            Ok(mechanism) => {
                (self.mechanism, self.mechanism_of, self.hurried) = (mechanism, wanted.clone(), true);
                self.refused = None;
                self.edit(|scene| scene.mechanism = wanted)
            }
            Err(error) => {
                self.refused = Some(why(&error, &document.scene));
                false
            }
        }
    }

    /// Why the last change that a hand wanted of the mechanism was not made.
    pub fn refused(&self) -> Option<&str> {
        self.refused.as_deref()
    }

    /// Ends the gesture.
    pub fn end_gesture(&mut self) {
        self.presses = None;
        if self.editor.in_gesture() {
            self.apply();
            self.editor.end_gesture();
            self.solve_in_earnest();
            self.ask_thresholds();
        }
    }

    /// Solves a mechanism anew that was solved in a hurry; where that fails, the hurried one stays.
    fn solve_in_earnest(&mut self) {
        if !std::mem::take(&mut self.hurried) {
            return;
        }
        let Ok(mechanism) = solved(&self.editor.runnable(), FLEXURE_TOLERANCE) else { return };
        self.mechanism = mechanism;
        if let Ok(model) = Model::build(self.scene(), Arc::clone(&self.mechanism)) {
            self.model = Arc::new(model);
            self.player.change(&self.model);
            self.continued = true;
            self.ask_settled();
        }
    }

    /// Changes the scene by one gesture of its own.
    pub fn edit_once(&mut self, change: impl FnOnce(&mut Scene)) -> bool {
        self.end_gesture();
        let changed = self.edit(change);
        self.end_gesture();
        changed
    }

    /// A step back. Whether there was one.
    pub fn undo(&mut self) -> bool {
        self.travel(Editor::undo)
    }

    /// A step forward again. Whether there was one.
    pub fn redo(&mut self) -> bool {
        self.travel(Editor::redo)
    }

    fn travel(&mut self, step: impl FnOnce(&mut Editor) -> bool) -> bool {
        self.end_gesture();
        self.refused = None;
        let now = self.now_card();
        let moved = step(&mut self.editor);
        if moved {
            self.before = Some(now);
            self.apply();
            self.ask_thresholds();
        }
        moved
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
        self.ask_settled();
    }

    /// The mass has been moved by hand: what it settles to is asked anew.
    pub fn moved_by_hand(&mut self) {
        (self.changed_at, self.continued, self.by_hand) = (self.player.watch().time(), true, true);
        self.ask_settled();
    }

    /// Whether the last change was a hand on the mass.
    pub fn is_by_hand(&self) -> bool {
        self.by_hand
    }

    /// Switches the stops; the ones that were there are remembered.
    pub fn switch_stops(&mut self, on: bool) -> bool {
        let stops = if on { self.remembered_stops } else { Stops::None };
        if !on && self.scene().stops != Stops::None {
            self.remembered_stops = self.scene().stops;
        }
        self.edit_once(|scene| scene.stops = stops)
    }

    /// The stops that come when they are switched on.
    pub fn remembered_stops(&self) -> Stops {
        self.remembered_stops
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
                self.player.change(&self.model);
                (self.changed_at, self.continued, self.by_hand) = (self.player.watch().time(), true, false);
                if !differ_in_amplitude_alone(&before, &self.built) {
                    self.thresholds.clear();
                }
                self.stops_that_cross.clear();
                self.ask_settled();
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

    fn build(&mut self) -> Result<Model, CannotRun> {
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

    /// What the motion settles to; of an earlier scene while the answer is still to come.
    pub fn settled(&self) -> Option<&Settled> {
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

    /// How far the motion has come, after a change, towards what the sentence tells of: seconds gone, and of how many.
    pub fn settling(&self) -> Option<(f64, f64)> {
        let told = self.told().filter(|_| self.model.is_shaken() && self.changed_at > 0.0)?;
        let (gone, of) = (told.now - told.origin, told.seen_from() - told.origin);
        (gone < of).then_some((gone, of))
    }

    /// What the status line says.
    pub fn sentence(&self) -> Sentence {
        if let Some(fault) = &self.fault {
            return Sentence::fault(fault);
        }
        let state = self.player.state();
        if self.player.is_held() {
            return status::held(&self.model, &state);
        }
        if let Some(outcome) = self.player.ended() {
            return status::ended(&self.model, outcome);
        }
        if !self.model.is_shaken() {
            return status::unshaken(&self.model, &state);
        }
        match self.told() {
            Some(told) => status::driven(&told),
            None if self.settled.is_running() => Sentence::waiting(),
            None => stopped(),
        }
    }

    /// What the sentence tells of, once it is known.
    fn told(&self) -> Option<Told<'_>> {
        let settled = self.settled.current()?;
        Some(Told {
            scene: self.scene(),
            model: &self.model,
            summary: &settled.summary,
            thresholds: self.thresholds.current(),
            origin: self.asked_from,
            now: self.player.watch().time(),
        })
    }

    /// Amplitude of the shaking in g, where it is a sine.
    pub fn amplitude_g(&self) -> Option<f64> {
        match self.scene().excitation {
            Excitation::Sine { amplitude_g, .. } => Some(amplitude_g),
            _ => None,
        }
    }
}

/// Whether all thresholds of one scene are those of the other.
fn differ_in_amplitude_alone(a: &Scene, b: &Scene) -> bool {
    let mut other = a.clone();
    match (&mut other.excitation, &b.excitation) {
        (Excitation::Sine { amplitude_g: own, .. }, Excitation::Sine { amplitude_g, .. }) => {
            *own = *amplitude_g
        }
        _ => return false,
    }
    other == *b
}

/// While it is not known what the motion settles to, because a person has stopped that.
fn stopped() -> Sentence {
    let text = "Stopped before it was known what this settles to: a shorter run length is known sooner.";
    Sentence { kind: status::Kind::Other, text: text.to_owned(), remedy: String::new() }
}

/// The stops that come when they are switched on, before a hand has moved any.
fn first_stops(scene: &Scene, model: &Model) -> Stops {
    let hinted = || scene.app.as_ref().and_then(|hints| hints.stops_when_on);
    let suiting = || {
        let well = model.mechanism().landscape.right_stable().map(|well| well.x.abs() * 1e3);
        Stops::Rigid { travel_limit_mm: suiting_limit(well), restitution: RESTITUTION }
    };
    match scene.stops {
        Stops::None => hinted().unwrap_or_else(suiting),
        stops => stops,
    }
}

/// The stops of a scene in mm, left and right; none where a side is open.
pub fn stop_distances(scene: &Scene) -> (Option<f64>, Option<f64>) {
    match scene.stops {
        scene::Stops::None => (None, None),
        scene::Stops::Rigid { travel_limit_mm, .. } | scene::Stops::Hertz { travel_limit_mm, .. } => {
            (Some(-travel_limit_mm), Some(travel_limit_mm))
        }
        scene::Stops::Uneven { left_mm, right_mm, .. } => (left_mm.map(|mm| -mm), right_mm),
    }
}
