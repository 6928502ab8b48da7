//! State of the open scene, and what can be read of it.

use std::sync::Arc;

use crate::app::task::{Latest, Wake};
use crate::dynamics::{Model, Outcome, Summary};
use crate::mechanics::Mechanism;
use crate::scene::{self, Excitation, Scene, Stops};
use crate::study::Thresholds;

use super::accuracy::Accuracy;
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
    /// The scene and the way back.
    pub editor: Editor,
    /// The model that moves: of the scene, or of the last one that could be run.
    pub(super) model: Arc<Model>,
    /// Why the scene as it stands cannot be run.
    pub(super) fault: Option<String>,
    pub player: Player,
    pub(super) settled: Latest<Summary>,
    pub(super) thresholds: Latest<Thresholds>,
    /// The travel limit in mm with which it would cross; searched for only when somebody asks.
    pub(super) stops_that_cross: Latest<Option<f64>>,
    pub accuracy: Accuracy,
    pub map: Mapping,
    /// What the views of the layout Explore show.
    pub explore: Explore,
    /// The motions that go on beside it.
    pub pins: Pins,
    /// The measured data that lie over it.
    pub measured: MeasuredData,
    pub(super) before: Option<Card>,
    /// The scene that the model was built from.
    pub(super) built: Scene,
    pub(super) mechanism: Arc<Mechanism>,
    /// What the mechanism was built from: a table is fitted once, not for every move of a slider.
    pub(super) mechanism_of: scene::Mechanism,
    /// Whether the mechanism was solved in a hurry, in the midst of a gesture.
    pub(super) hurried: bool,
    /// What a hand asked of the mechanism and did not get, and why.
    pub(super) refused: Option<String>,
    /// Live time in s of the last change.
    pub(super) changed_at: f64,
    /// Whether that was a hand on the mass.
    pub(super) by_hand: bool,
    /// Whether the last change carried the mass to a stop.
    pub(super) carried: bool,
    /// The scales that the sliders keep while the scene is open.
    pub(super) opened: OpenedScales,
    /// Live time in s at which the run begins that is asked what the motion settles to.
    pub(super) asked_from: f64,
    /// The motion is no longer the run of the scene from its start: something was changed on its way.
    pub(super) continued: bool,
    /// The stops that come back when they are switched on.
    pub(super) remembered_stops: Stops,
    /// The field whose presses of arrow keys are one gesture, and the time in s of the last one.
    pub(super) presses: Option<(String, f64)>,
    /// What it would take to cross is not to be said: it is the answer of a lesson.
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

    /// Whether the last change was a hand on the mass.
    pub fn is_by_hand(&self) -> bool {
        self.by_hand
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

    /// What the present scene settles to, once that is known.
    pub fn settled_now(&self) -> Option<&Summary> {
        self.settled.current().filter(|_| self.fault.is_none())
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
            thresholds: self.thresholds.current().copied().filter(|_| !self.keeps_remedy),
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

    /// Amplitude of the shaking in g, where it is a sine.
    pub fn amplitude_g(&self) -> Option<f64> {
        match self.scene().excitation {
            Excitation::Sine { amplitude_g, .. } => Some(amplitude_g),
            _ => None,
        }
    }
}
