//! State of the open scene, and the methods that read it.

use std::sync::Arc;

use crate::app::task::{Background, Wake};
use crate::app::words::status::{self, DrivenMotion, Sentence};
use crate::dynamics::{Model, Outcome, Summary};
use crate::mechanics::Mechanism;
use crate::scene::{self, Excitation, Scene, Stops};
use crate::study::Thresholds;

use super::accuracy::{Accuracy, LiveRun};
use super::best::BestStops;
use super::editor::Editor;
use super::explore::Explore;
use super::map::Mapping;
use super::measured::MeasuredData;
use super::pins::Pins;
use super::player::Player;

/// Scales that set the ranges of the sliders: those of the scene as it was opened, so that no slider jumps
/// while another one is moved.
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
    pub(super) fn of(model: &Model) -> Self {
        let well_mm = model.mechanism().landscape.right_stable().map(|well| well.x.abs() * 1e3);
        Self { length: model.scales().length, time: model.scales().time, well_mm }
    }
}

/// A side of the card Before / now.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    pub scene: Scene,
    /// What it settles to; `None` until it is known.
    pub settled: Option<Summary>,
    /// Its thresholds; `None` until they are known.
    pub thresholds: Option<Thresholds>,
}

pub struct Session {
    pub editor: Editor,
    /// The model that moves: that of the scene, or of its last version that could be run.
    pub(super) model: Arc<Model>,
    /// Why the present scene cannot be run.
    pub(super) fault: Option<String>,
    pub player: Player,
    pub(super) settled: Background<LiveRun, Summary>,
    /// The thresholds of the scene, whatever the amplitude of its shaking.
    pub(super) thresholds: Background<Scene, Thresholds>,
    /// The travel limit in mm with which the mass would cross the barrier; computed only on request.
    pub(super) stops_that_cross: Background<Scene, Option<f64>>,
    pub accuracy: Accuracy,
    pub map: Mapping,
    pub explore: Explore,
    pub pins: Pins,
    pub measured: MeasuredData,
    pub(super) before: Option<Card>,
    /// The scene that the model was built from.
    pub(super) built: Scene,
    pub(super) mechanism: Arc<Mechanism>,
    /// What the mechanism was built from, so that a table is fitted once and not at every move of a slider.
    pub(super) mechanism_of: scene::Mechanism,
    /// Whether the mechanism was solved with the coarse tolerance of a gesture.
    pub(super) is_coarse: bool,
    /// Why the last change of the mechanism was refused.
    pub(super) refused: Option<String>,
    /// Live time in s of the last change.
    pub(super) changed_at: f64,
    /// Whether the last change was a move of the mass by hand.
    pub by_hand: bool,
    /// Whether the last change moved the mass to a stop.
    pub(super) moved_to_stop: bool,
    /// The scales of the scene as it was opened.
    pub(super) opened: OpenedScales,
    /// Whether the motion was changed after its start, so that it is no run of the scene from its start.
    pub(super) continued: bool,
    /// The stops that the scene gets when they are switched on.
    pub(super) remembered_stops: Stops,
    /// The field of the current series of arrow key presses, and the time in s of the last press.
    pub(super) presses: Option<(String, f64)>,
    /// Whether to withhold what it would take to cross the barrier, as the answer of a lesson.
    pub keeps_remedy: bool,
    pub best: BestStops,
    pub(super) wake: Wake,
}

impl Session {
    pub fn scene(&self) -> &Scene {
        self.editor.scene()
    }

    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The model at the time that is shown, which may be in the past.
    pub fn shown(&self) -> &Model {
        let player = &self.player;
        if player.is_past() { player.watch().model_at(player.time()) } else { &self.model }
    }

    /// Why the present scene cannot be run; the motion is then that of its last version that could.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    pub fn wake(&self) -> &Wake {
        &self.wake
    }

    /// Whether the settled motion crosses the barrier; `None` until it is known.
    pub fn crosses(&self) -> Option<bool> {
        let summary = self.settled.answer()?;
        (self.fault.is_none() && summary.outcome == Outcome::Done).then_some(summary.crossings > 0)
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
            scene: self.scene().clone(),
            settled: self.settled.answer().copied(),
            thresholds: self.thresholds.answer().copied().filter(|_| !self.keeps_remedy),
        }
    }

    /// The scene before the last gesture, for the card.
    pub fn before_card(&self) -> Option<&Card> {
        self.before.as_ref()
    }

    /// The live time in s at which the run ends: the scene's run length after the last change, or after the
    /// start if the excitation is a function of the time since then.
    pub fn end_of_run(&self) -> f64 {
        let begins_here = self.player.watch().from_here().is_some();
        self.model.duration() + if begins_here { self.changed_at } else { 0.0 }
    }

    pub fn is_continued(&self) -> bool {
        self.continued
    }

    /// Live time in s of the last change: of the scene, or of the mass by hand.
    pub fn changed_at(&self) -> f64 {
        self.changed_at
    }

    /// Amplitude of the excitation in g, if it is a sine.
    pub fn amplitude_g(&self) -> Option<f64> {
        match self.scene().excitation {
            Excitation::Sine { amplitude_g, .. } => Some(amplitude_g),
            _ => None,
        }
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
    pub(super) fn sentence_facts(&self) -> Option<DrivenMotion<'_>> {
        let (run, summary) = (self.settled.question()?, self.settled.answer()?);
        Some(DrivenMotion {
            scene: self.scene(),
            model: &self.model,
            summary,
            thresholds: self.thresholds.answer(),
            origin: run.from,
            now: self.player.watch().time(),
        })
    }
}
