//! The scene walked up and down over a field, each run going on from where the one before was.

use std::sync::Arc;

use crate::app::session::Session;
use crate::app::session::map::ground;
use crate::app::task::{Background, pool};
use crate::scene::{Axis, FieldPath, Scene, SweepAxis};
use crate::study::{Family, Task, Visit, up_and_down};

/// Stride of the values that are walked over first.
const COARSE: usize = 5;

/// What is drawn of each run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WalkQuantity {
    /// Displacements once a forcing period.
    #[default]
    Strobes,
    RmsVelocity,
    /// Mean power into the load of a transducer.
    LoadPower,
}

/// A scene without its value of the field, and the axis over it.
#[derive(Debug, Clone, PartialEq)]
pub struct WalkQuestion {
    /// The scene, from rest, with the first value of the axis.
    pub scene: Scene,
    /// The field and its values.
    pub axis: SweepAxis,
}

#[derive(Default)]
pub struct Walks {
    /// The axis that was chosen; none for one around the place of the scene.
    pub chosen: Option<SweepAxis>,
    pub quantity: WalkQuantity,
    /// The runs as they come, with the stride of their values: coarse ones first.
    pub found: Background<WalkQuestion, (usize, Visit)>,
    /// Why there are none.
    pub problem: Option<String>,
}

impl Session {
    /// The axis of the walks: the chosen one where the scene has its field, else the amplitude of the
    /// shaking, else the first field that a map could go over. None where there is none.
    pub fn walk_axis(&self) -> Option<SweepAxis> {
        let has = |axis: &&SweepAxis| {
            let ground = ground(self.scene(), self.remembered_stops(), std::slice::from_ref(axis));
            FieldPath::new(&axis.field).get(&ground).is_some()
        };
        if let Some(chosen) = self.explore.walks.chosen.as_ref().filter(has) {
            return Some(chosen.clone());
        }
        let known = self.map_fields();
        let field = known.iter().find(|path| path.ends_with("amplitude_g")).or(known.first())?;
        Some(self.map_axis(field))
    }

    /// Asks for the walks of the scene as it stands, in a frame that shows them.
    pub fn want_walks(&mut self) {
        let asked = self.walk_question();
        self.explore.walks.problem = asked.as_ref().err().cloned();
        let Ok((question, values)) = asked else { return };
        // the field may be a part of the mechanism, which is given as it was built
        let scene = Scene { mechanism: self.mechanism_of.clone(), ..question.scene.clone() };
        let (mechanism, files) = (Arc::clone(&self.mechanism), self.editor.document().files.clone());
        let still = self.stands_still();
        self.explore.walks.found.want(question, still, &self.wake, move |question, cancel, each| {
            let (pool, task) = (pool()?, Task { tick: &|| (), cancel });
            let family = Family::new(&scene, &files, &mechanism, &question.axis.field);
            for stride in [COARSE, 1] {
                let values: Vec<f64> = values.iter().step_by(stride).copied().collect();
                if !up_and_down(&family, &values, &pool, &task, &|visit| each((stride, visit))) {
                    break;
                }
            }
            None
        });
    }

    /// What the walks of the scene as it stands are, and their values; or why there are none.
    fn walk_question(&self) -> Result<(WalkQuestion, Vec<f64>), String> {
        let no_field = || "This scene has no field to walk over.".to_owned();
        let axis = self.walk_axis().ok_or_else(no_field)?;
        let mut scene = ground(self.scene(), self.remembered_stops(), std::slice::from_ref(&axis));
        let read = Axis::from_scene(&axis, &scene);
        let values = read.map_err(|(part, problem)| format!("{part}: {problem}"))?.values;
        if !self.model().repeats() {
            let problem = "Each run goes on from the state of the one before at the drive's phase 0: that \
                           needs shaking that repeats, such as a sine.";
            return Err(problem.to_owned());
        }
        if !FieldPath::new(&axis.field).set(&mut scene, axis.from) {
            return Err(no_field());
        }
        Ok((WalkQuestion { scene, axis }, values))
    }

    /// Sets the field of the walks to a value, as part of a gesture.
    pub fn drag_along_walk(&mut self, value: f64) {
        let Some(axis) = self.walk_axis() else { return };
        let value = ((value / axis.step).round() * axis.step).clamp(axis.from, axis.to);
        // where the value is refused, the fault of the scene says why
        let _ = self.set_number(&axis.field, crate::app::words::numbers::decimal(value));
    }
}
