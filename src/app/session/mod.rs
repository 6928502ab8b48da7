//! The open scene, with its model, its motion and the results of background computations.
//!
//! Everything here works without a window; the views read it and change it through its methods.

pub mod accuracy;
mod ask;
#[cfg(any(test, target_arch = "wasm32"))]
pub mod asked;
pub mod best;
mod build;
mod edit;
pub mod editor;
pub mod explore;
pub mod lesson;
pub mod map;
pub mod measured;
pub mod player;
pub mod prepared;
pub mod reference;
pub mod sliders;

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Background, Wake};
use crate::app::words::status::{self, DrivenMotion, Sentence};
use crate::dynamics::{Model, Outcome, Summary};
use crate::mechanics::{FLEXURE_TOLERANCE, Mechanism};
use crate::questions::Error;
use crate::scene::{self, Scene, Stops};
use interwell_studies::study::{self, SummaryField, Thresholds};

use accuracy::{Accuracy, LiveRun};
use ask::{StopsQuestion, ThresholdsQuestion};
use best::BestStops;
use build::{fault_message, first_stops, solve};
use editor::Editor;
use explore::Explore;
use map::{LOAD_POWER, Mapping};
use measured::MeasuredData;
use player::{Player, opening_speed};
use prepared::{Prepared, SceneWithFiles, SharedModel};
use reference::Reference;

/// Time after which the user is offered to stop a background computation.
pub const OFFER_TO_STOP: Duration = Duration::from_secs(2);

/// Least time for which an ended motion has to continue, as a share of the characteristic time.
const LEAST_CONTINUATION: f64 = 0.02;

/// Least displacement of the mass by a change that is reported, as a share of the length scale.
const REPORTED_MOVE: f64 = 0.02;

/// A column of the view Compare.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    pub scene: Arc<Scene>,
    /// What it settles to; `None` until it is known.
    pub settled: Option<Summary>,
    /// Its thresholds; `None` until they are known.
    pub thresholds: Option<Thresholds>,
    /// Live time in s at which its motion ended.
    pub ended: Option<f64>,
}

pub struct Session {
    pub editor: Editor,
    /// The model of the motion: that of the scene, or of its last version that could be run.
    pub(in crate::app) model: SharedModel,
    /// Why the present scene cannot be run.
    fault: Option<String>,
    pub player: Player,
    settled: Background<LiveRun, Summary>,
    /// The thresholds of the scene, whatever the amplitude of its shaking.
    thresholds: Background<ThresholdsQuestion, Thresholds>,
    /// The travel limit in mm with which the mass would cross the barrier; computed only on request.
    stops_that_cross: Background<StopsQuestion, Option<f64>>,
    pub accuracy: Accuracy,
    pub map: Mapping,
    pub explore: Explore,
    pub reference: Reference,
    pub measured: MeasuredData,
    /// The scene that the model was built from.
    built: Arc<Scene>,
    mechanism: Arc<Mechanism>,
    /// What the mechanism was built from, so that a table is fitted once and not at every move of a slider.
    mechanism_of: scene::Mechanism,
    /// The tolerance with which the mechanism was solved: coarse during a gesture.
    tolerance: f64,
    /// Live time in s of the last change: of the scene, or of the mass by hand.
    pub changed_at: f64,
    /// Whether the last change was a move of the mass by hand.
    pub by_hand: bool,
    /// The state of the mass when a hand took it.
    held_from: Option<(f64, f64)>,
    /// Whether the last change moved the mass to a stop.
    moved_to_stop: bool,
    /// The model of the scene as it was opened, whose scales set the ranges of the sliders, so that no slider
    /// jumps while another one is moved.
    opened: SharedModel,
    /// Whether the motion was changed after its start, so that it is no run of the scene from its start.
    pub is_continued: bool,
    /// The stops that the scene gets when they are switched on.
    pub(in crate::app) remembered_stops: Stops,
    /// The field of the current series of arrow key presses, and the time in s of the last press.
    presses: Option<(String, f64)>,
    /// Whether to withhold what it would take to cross the barrier, as the answer of a lesson.
    pub keeps_remedy: bool,
    /// Whether it is that of a lesson, where no answer is given away or contradicted: no best stops are
    /// searched for, and Up and down has no coarse steps.
    pub is_lesson: bool,
    pub best: BestStops,
    pub wake: Wake,
}

impl Session {
    /// A session on a scene; `wake` is called from other threads when a result has come.
    pub fn new(editor: Editor, wake: Wake) -> Result<Self, Error> {
        let document = editor.document();
        let (mechanism, model) = solve(document, FLEXURE_TOLERANCE)?;
        let scene = Arc::clone(editor.shared());
        let of = SceneWithFiles::of(document, Arc::clone(&scene));
        let prepared = Prepared { of, mechanism: Arc::clone(&mechanism), tolerance: FLEXURE_TOLERANCE };
        let model = SharedModel::new(model, prepared);
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
            reference: Reference::new(Arc::clone(&scene), model.clone(), false),
            measured: MeasuredData::default(),
            mechanism_of: scene.mechanism.clone(),
            tolerance: FLEXURE_TOLERANCE,
            mechanism,
            changed_at: 0.0,
            by_hand: false,
            held_from: None,
            moved_to_stop: false,
            opened: model.clone(),
            is_continued: false,
            remembered_stops: first_stops(&scene, &model),
            model,
            presses: None,
            keeps_remedy: false,
            is_lesson: false,
            best: BestStops::default(),
            built: scene,
            wake,
        };
        session.map.trail.note(&session.built);
        session.map.quantity = SummaryField::find(LOAD_POWER).filter(|_| session.model.has_transducer());
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
        self.explore.walks.found.poll();
        self.explore.basins.poll();
        self.explore.spectra.found.poll();
        self.reference.poll();
        self.note_thresholds();
        self.measured.poll();
        self.apply();
        let is_refuted = self.sentence_facts().is_some_and(|facts| facts.is_refuted());
        if is_refuted && !self.player.is_held() && self.player.watch().from_here().is_some() {
            self.ask_settled();
        }
        self.follow_accuracy();
    }

    /// Stops what no view has asked for in this frame; to be called once a frame.
    pub fn end_frame(&mut self) {
        self.map.cells.end_frame();
        self.measured.found.end_frame();
        self.explore.walks.found.end_frame();
        self.explore.basins.end_frame();
        self.explore.spectra.found.end_frame();
        self.accuracy.tolerances.end_frame();
        self.accuracy.stepped.end_frame();
        self.player.end_frame();
    }

    pub fn restart(&mut self) {
        self.player.restart(&self.model);
        self.reference.restart(self.built == self.reference.scene, &self.wake);
        (self.changed_at, self.is_continued, self.by_hand, self.moved_to_stop) = (0.0, false, false, false);
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

    /// Holds the mass at `x` in m.
    pub fn hold(&mut self, x: f64) {
        self.leave_reference();
        if !self.player.is_held() {
            self.player.to_present();
            self.held_from = Some(self.state_of_mass());
        }
        self.player.hold(x);
    }

    /// Places the mass at `x` in m with velocity `v` in m/s; the motion goes on from there.
    pub fn place(&mut self, x: f64, v: f64) {
        self.leave_reference();
        self.held_from = Some(self.state_of_mass());
        self.player.place(x, v);
        self.moved_by_hand();
    }

    /// Displacement in m and velocity in m/s of the mass, at the time that is shown.
    fn state_of_mass(&self) -> (f64, f64) {
        let state = self.player.state();
        (state.x, state.v)
    }

    /// Notes that the mass has been moved by hand, as one undo step.
    pub fn moved_by_hand(&mut self) {
        if let Some(from) = self.held_from.take() {
            self.editor.moved(from, self.state_of_mass());
        }
        self.note_move();
    }

    /// Asks again what the motion settles to after the mass was moved.
    fn note_move(&mut self) {
        (self.changed_at, self.is_continued, self.by_hand) = (self.player.watch().time(), true, true);
        self.moved_to_stop = false;
        self.ask_settled();
    }

    /// Applies the edited scene to the motion, if it has changed.
    fn apply(&mut self) {
        if *self.editor.shared() == self.built {
            return;
        }
        self.built = Arc::clone(self.editor.shared());
        match self.build() {
            Ok(model) => {
                self.fault = None;
                self.model = SharedModel::new(model, self.prepared(Arc::clone(&self.built)));
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
        self.leave_reference();
        self.player.change(&self.model);
        let lasts = |from: Model| study::lasts(&from, LEAST_CONTINUATION * from.characteristic_time());
        if ended && !self.player.watch().from_here().is_some_and(lasts) {
            return self.restart();
        }
        let now = self.player.watch().now().x;
        let (left, right) = self.model.stop_positions();
        let is_far = (now - before).abs() > REPORTED_MOVE * self.model.scales().length;
        self.moved_to_stop = is_far && [left, right].contains(&Some(now));
        (self.changed_at, self.is_continued, self.by_hand) = (self.player.watch().time(), true, false);
        self.ask_settled();
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

    fn build(&mut self) -> Result<Model, Error> {
        let document = &*self.editor.runnable();
        document.check()?;
        if document.scene.mechanism != self.mechanism_of {
            self.mechanism = build::mechanism(document, FLEXURE_TOLERANCE)?;
            self.tolerance = FLEXURE_TOLERANCE;
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
        self.accuracy.trust.wait(timeout);
        self.accuracy.tolerances.wait(timeout);
        self.accuracy.stepped.wait(timeout);
    }

    pub fn scene(&self) -> &Scene {
        self.editor.scene()
    }

    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The model at the time that is shown, which may be in the past.
    pub fn shown(&self) -> &Arc<Model> {
        let player = &self.player;
        if player.is_past() { player.watch().model_at(player.time()) } else { &self.model.model.0 }
    }

    /// Why the present scene cannot be run; the motion is then that of its last version that could.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Whether the settled motion crosses the barrier; `None` until it is known.
    pub fn crosses(&self) -> Option<bool> {
        let summary = self.settled_now()?;
        (summary.outcome == Outcome::Done).then_some(summary.crossings > 0)
    }

    /// What the present scene settles to; `None` until it is known.
    pub fn settled_now(&self) -> Option<&Summary> {
        self.settled.answer().filter(|_| self.fault.is_none())
    }

    /// What the motion settles to, or that of an earlier scene until the new answer has come.
    pub fn settled(&self) -> Option<&Summary> {
        self.settled.newest()
    }

    pub fn now_card(&self) -> Card {
        Card {
            scene: Arc::clone(self.editor.shared()),
            settled: self.settled.answer().copied(),
            thresholds: self.thresholds.answer().copied().filter(|_| !self.keeps_remedy),
            ended: None,
        }
    }

    /// The live time in s at which the run ends: the scene's run length after the last change, or after the
    /// start if the excitation is a function of the time since then.
    pub fn end_of_run(&self) -> f64 {
        let begins_here = self.player.watch().from_here().is_some();
        self.model.duration() + if begins_here { self.changed_at } else { 0.0 }
    }

    /// Amplitude of the excitation in g, if it is harmonic.
    pub fn amplitude_g(&self) -> Option<f64> {
        Some(self.scene().harmonic()?.amplitude_g())
    }

    /// Takes over the ranges of the sliders of another session, as for another step of a lesson.
    pub fn keep_ranges_of(&mut self, other: &Self) {
        self.opened = other.opened.clone();
    }

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
        match self.sentence_facts() {
            Some(facts) if self.keeps_remedy => Sentence { remedy: String::new(), ..status::driven(&facts) },
            Some(facts) => status::driven(&facts),
            None if self.settled.is_running() => Sentence::waiting(),
            None => Sentence::stopped(),
        }
    }

    /// The facts for the sentence about a driven motion; `None` until it is known what the motion settles to.
    fn sentence_facts(&self) -> Option<DrivenMotion<'_>> {
        let (run, summary) = (self.settled.question()?, self.settled.answer()?);
        Some(DrivenMotion {
            scene: self.scene(),
            model: &self.model,
            summary,
            thresholds: self.thresholds.answer(),
            origin: run.from,
            now: self.player.watch().time(),
            x: self.player.watch().now().x,
            events: self.player.watch().events(),
            trusted_to: self.accuracy.trusted_to(),
        })
    }
}
