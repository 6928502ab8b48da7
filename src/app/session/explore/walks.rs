//! Walks over a field of the open scene, up and down: each run continues from the end of the one before.

use std::sync::Arc;

use crate::app::session::Session;
use crate::app::session::map::ground;
use crate::app::task::pool;
use crate::mechanics::Mechanism;
use crate::scene::{Axis, FieldPath, Files, Scene, SweepAxis};
use crate::study::{Family, Task, Visit, up_and_down};

use super::Explored;

/// Stride of the coarse walks, which come first.
const COARSE: usize = 5;

/// The quantity that is drawn for each run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WalkQuantity {
    /// Displacements once a forcing period.
    #[default]
    Strobes,
    RmsVelocity,
    /// Mean power into the load of a transducer.
    LoadPower,
}

/// A scene, apart from its value of the field, and the axis over the field.
#[derive(Debug, Clone, PartialEq)]
pub struct WalkQuestion {
    /// The scene, from rest, with the first value of the axis.
    pub scene: Scene,
    /// The field and its values.
    pub axis: SweepAxis,
}

#[derive(Default)]
pub struct Walks {
    /// The axis that the user has chosen; `None` for an axis around the present value.
    pub chosen: Option<SweepAxis>,
    pub quantity: WalkQuantity,
    /// The runs as they come, each with the stride of its walk; the coarse walks come first.
    pub found: Explored<WalkQuestion, (usize, Visit)>,
    /// Why there are no walks.
    pub problem: Option<String>,
}

impl Session {
    /// The axis of the walks: the chosen one if the scene has its field, else one over the amplitude of the
    /// shaking, else over the first field that a map could have. Returns `None` if there is no such field.
    pub fn walk_axis(&self) -> Option<SweepAxis> {
        let has = |axis: &&SweepAxis| {
            let ground = ground(self.scene(), self.remembered_stops(), std::slice::from_ref(axis));
            FieldPath::new(&axis.field).get(&ground).is_some()
        };
        if let Some(chosen) = self.explore.walks.chosen.as_ref().filter(has) {
            return Some(chosen.clone());
        }
        let known = self.map_fields();
        let path = known.iter().find(|path| path.ends_with("amplitude_g")).or(known.first())?;
        Some(self.map_axis(path))
    }

    /// Asks for the walks of the present scene; to be called in every frame that shows them.
    pub fn want_walks(&mut self) {
        let still = self.stands_still();
        let Some(axis) = self.walk_axis() else {
            self.explore.walks.problem = Some("This scene has no field to walk over.".to_owned());
            return;
        };
        let mut scene = ground(self.scene(), self.remembered_stops(), std::slice::from_ref(&axis));
        let values = match Axis::from_scene(&axis, &scene) {
            Ok(axis) => axis.values,
            Err((part, problem)) => {
                self.explore.walks.problem = Some(format!("{part}: {problem}"));
                return;
            }
        };
        if !self.model().repeats() {
            let problem = "Each run goes on from the state of the one before at the drive's phase 0: that \
                           needs shaking that repeats, such as a sine.";
            self.explore.walks.problem = Some(problem.to_owned());
            return;
        }
        self.explore.walks.problem = None;
        let present = scene.clone();
        if !FieldPath::new(&axis.field).set(&mut scene, axis.from) {
            return;
        }
        let question = WalkQuestion { scene, axis };
        let (mechanism, files) = (Arc::clone(&self.mechanism), self.editor.document().files.clone());
        let wake = Arc::clone(&self.wake);
        self.explore.walks.found.want(&question, still, &wake, move |question, cancel, each| {
            walk(question, (&present, mechanism, &files), &values, &Task { tick: &|| (), cancel }, each);
        });
    }

    /// Sets the field of the walks to a value, as part of a gesture.
    pub fn drag_along_walk(&mut self, value: f64) {
        let Some(axis) = self.walk_axis() else { return };
        let value = ((value / axis.step).round() * axis.step).clamp(axis.from, axis.to);
        // a value that is refused is reported where the scene is checked
        let _ = self.set_number(&axis.field, crate::app::words::numbers::decimal(value));
    }
}

/// The coarse walks, then those over all values.
fn walk(
    question: &WalkQuestion,
    (scene, mechanism, files): (&Scene, Arc<Mechanism>, &Files),
    values: &[f64],
    task: &Task,
    each: &(dyn Fn((usize, Visit)) + Sync),
) {
    let Some(pool) = pool() else { return };
    let family = Family::new(scene, files, &mechanism, &question.axis.field);
    for stride in [COARSE, 1] {
        let values: Vec<f64> = values.iter().step_by(stride).copied().collect();
        if !up_and_down(&family, &values, &pool, task, &|visit| each((stride, visit))) {
            return;
        }
    }
}
