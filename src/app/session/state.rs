//! State of the open scene, and what can be read from it.

use std::sync::Arc;

use crate::app::task::{Background, Wake};
use crate::dynamics::{Model, Outcome, Summary};
use crate::mechanics::Mechanism;
use crate::scene::{self, Excitation, Scene, Stops};
use crate::study::Thresholds;

use super::accuracy::Accuracy;
use super::ask::LiveRun;
use super::best::BestStops;
use super::editor::Editor;
use super::explore::Explore;
use super::map::Mapping;
use super::measured::MeasuredData;
use super::pins::Pins;
use super::player::Player;

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
    pub(super) fn of(model: &Model) -> Self {
        let well_mm = model.mechanism().landscape.right_stable().map(|well| well.x.abs() * 1e3);
        Self { length: model.scales().length, time: model.scales().time, well_mm }
    }
}

/// A side of the card Before / now.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    pub scene: Scene,
    /// What it settles to, once that is known.
    pub settled: Option<Summary>,
    /// How much shaking it takes, once that is known.
    pub thresholds: Option<Thresholds>,
}

pub struct Session {
    /// The scene with its undo stack.
    pub editor: Editor,
    /// The model that moves: that of the scene, or of the last scene that could be run.
    pub(super) model: Arc<Model>,
    /// Why the scene as it stands cannot be run.
    pub(super) fault: Option<String>,
    pub player: Player,
    /// What the motion settles to.
    pub(super) settled: Background<LiveRun, Summary>,
    /// How much shaking it takes: the same for all amplitudes, so that the question is a scene without one.
    pub(super) thresholds: Background<Scene, Thresholds>,
    /// The travel limit in mm with which a scene would cross, where there is one; searched for on request.
    pub(super) stops_that_cross: Background<Scene, Option<f64>>,
    pub accuracy: Accuracy,
    pub map: Mapping,
    /// What the views of the layout Explore show.
    pub explore: Explore,
    /// The motions that are pinned beside it.
    pub pins: Pins,
    /// The measured data that lie over it.
    pub measured: MeasuredData,
    pub(super) before: Option<Card>,
    /// The scene that the model was built from.
    pub(super) built: Scene,
    pub(super) mechanism: Arc<Mechanism>,
    /// What the mechanism was built from: a table is fitted once, not for every move of a slider.
    pub(super) mechanism_of: scene::Mechanism,
    /// Whether the mechanism was solved coarsely, during a gesture.
    pub(super) is_coarse: bool,
    /// Why the last change of the mechanism by hand was not made.
    pub(super) refused: Option<String>,
    /// Live time in s of the last change.
    pub(super) changed_at: f64,
    /// Whether the last change moved the mass by hand.
    pub(super) by_hand: bool,
    /// Whether the last change carried the mass to a stop.
    pub(super) carried: bool,
    /// The scales that the sliders keep while the scene is open.
    pub(super) opened: OpenedScales,
    /// Whether something was changed on the way, so that the motion is not the run of the scene from its
    /// start.
    pub(super) continued: bool,
    /// The stops that are set when they are switched on.
    pub(super) remembered_stops: Stops,
    /// The field whose presses of arrow keys are one gesture, and the time in s of the last press.
    pub(super) presses: Option<(String, f64)>,
    /// Whether it is not said what it would take to cross, because that is the answer of a lesson.
    pub keeps_remedy: bool,
    pub best: BestStops,
    pub(super) wake: Wake,
}

impl Session {
    /// The scene as it stands.
    pub fn scene(&self) -> &Scene {
        self.editor.scene()
    }

    /// The model that moves.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The model of the motion that is shown, which in the past may have been another one.
    pub fn shown(&self) -> &Model {
        if self.player.is_past() { self.player.shown_model() } else { &self.model }
    }

    /// Why the scene as it stands cannot be run; the motion is that of the last scene that could.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Wakes the window when something has come from the background.
    pub fn wake(&self) -> &Wake {
        &self.wake
    }

    /// Whether the last change moved the mass by hand.
    pub fn is_by_hand(&self) -> bool {
        self.by_hand
    }

    /// The scales of the scene as it was opened.
    pub fn opened(&self) -> OpenedScales {
        self.opened
    }

    /// Whether what the motion settles to crosses the barrier; none while that is not known.
    pub fn crosses(&self) -> Option<bool> {
        let summary = self.settled.answer()?;
        (self.fault.is_none() && summary.outcome == Outcome::Done).then_some(summary.crossings > 0)
    }

    /// What the present scene settles to, once that is known.
    pub fn settled_now(&self) -> Option<&Summary> {
        self.settled.answer().filter(|_| self.fault.is_none())
    }

    /// What the motion settles to, or while that is not known what it settled to before the last change.
    pub fn settled(&self) -> Option<&Summary> {
        self.settled.newest().map(|(summary, _)| summary)
    }

    /// The scene as it stands, for the card.
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

    /// The time in s at which the run that is watched ends: as long after the last change as the scene says,
    /// or after the start where the shaking is a function of the time since then.
    pub fn end_of_run(&self) -> f64 {
        let begins_here = self.player.watch().from_here().is_some();
        self.model.duration() + if begins_here { self.changed_at } else { 0.0 }
    }

    /// Whether something was changed on the way, so that the motion is not the run of the scene from its
    /// start.
    pub fn is_continued(&self) -> bool {
        self.continued
    }

    /// Live time in s of the last change: of the scene, or of the mass by hand.
    pub fn changed_at(&self) -> f64 {
        self.changed_at
    }

    /// Amplitude of the shaking in g, where it is a sine.
    pub fn amplitude_g(&self) -> Option<f64> {
        match self.scene().excitation {
            Excitation::Sine { amplitude_g, .. } => Some(amplitude_g),
            _ => None,
        }
    }
}
