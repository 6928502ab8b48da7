//! Walks over a field of the open scene, up and down: each run continues from the end of the one before.

use std::sync::Arc;

use crate::app::session::Session;
use crate::app::session::map::ground;
use crate::app::task::{Background, pool};
use crate::scene::{Axis, FieldPath, Scene, SweepAxis};
use crate::study::{Family, Task, Visit, up_and_down};

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
    pub axis: SweepAxis,
}

#[derive(Default)]
pub struct Walks {
    /// The axis that the user has chosen; `None` for an axis around the present value.
    pub chosen: Option<SweepAxis>,
    pub quantity: WalkQuantity,
    /// The runs as they come, each with the stride of its walk; the coarse walks come first.
    pub found: Background<WalkQuestion, (usize, Visit)>,
    pub problem: Option<String>,
}

impl Session {
    /// The axis of the walks: the chosen one if the scene has its field, else one over the amplitude of the
    /// shaking, else over the first field that a map could have. Returns `None` if there is no such field.
    pub fn walk_axis(&self) -> Option<SweepAxis> {
        let chosen = self.explore.walks.chosen.as_ref();
        if let Some(chosen) = chosen.filter(|axis| self.has_fields_of(std::slice::from_ref(axis))) {
            return Some(chosen.clone());
        }
        let known = self.map_fields();
        let path = known.iter().find(|path| path.ends_with("amplitude_g")).or(known.first())?;
        Some(self.map_axis(path))
    }

    /// Asks for the walks of the present scene; to be called in every frame that shows them.
    pub fn want_walks(&mut self) {
        let still = self.stands_still();
        let (ground, values, question) = match self.walk_question() {
            Ok(walk) => walk,
            Err(problem) => return self.explore.walks.problem = Some(problem),
        };
        self.explore.walks.problem = None;
        let (mechanism, files) = (Arc::clone(&self.mechanism), self.editor.document().files.clone());
        self.explore.walks.found.want(question, still, &self.wake, move |question, cancel, each| {
            let (pool, task) = (pool()?, Task { tick: &|| (), cancel });
            let family = Family::new(&ground, &files, &mechanism, &question.axis.field);
            for stride in [COARSE, 1] {
                let values: Vec<f64> = values.iter().step_by(stride).copied().collect();
                if !up_and_down(&family, &values, &pool, &task, &|visit| each((stride, visit))) {
                    break;
                }
            }
            None
        });
    }

    /// The scene from rest, the values of its field, and the question; or why there are no walks.
    fn walk_question(&self) -> Result<(Scene, Vec<f64>, WalkQuestion), String> {
        let axis = self.walk_axis().ok_or("This scene has no field to walk over.")?;
        let ground = ground(self.scene(), self.remembered_stops(), std::slice::from_ref(&axis));
        let values = Axis::from_scene(&axis, &ground).map(|axis| axis.values);
        let values = values.map_err(|(part, problem)| format!("{part}: {problem}"))?;
        if !self.model().repeats() {
            return Err("Each run goes on from the state of the one before at the drive's phase 0: that \
                        needs shaking that repeats, such as a sine."
                .to_owned());
        }
        let mut scene = ground.clone();
        let is_set = FieldPath::new(&axis.field).set(&mut scene, axis.from);
        debug_assert!(is_set, "the axis is over a field of the scene");
        Ok((ground, values, WalkQuestion { scene, axis }))
    }

    /// Sets the field of the walks to a value, as part of a gesture.
    pub fn drag_along_walk(&mut self, value: f64) {
        let Some(axis) = self.walk_axis() else { return };
        let value = ((value / axis.step).round() * axis.step).clamp(axis.from, axis.to);
        // a value that is refused is reported where the scene is checked
        let _ = self.set_number(&axis.field, crate::app::words::numbers::decimal(value));
    }
}
