//! Models that differ in one field of their scene.

use std::sync::Arc;

use crate::dynamics::Model;
use crate::mechanics::{BuildError, Mechanism};
use crate::scene::{Fault, FieldPath, Files, Scene};

/// A scene, the field that changes, and the mechanism of the scene as it is.
#[derive(Debug)]
pub struct Family<'a> {
    scene: &'a Scene,
    files: &'a Files,
    mechanism: &'a Arc<Mechanism>,
    path: FieldPath,
}

impl<'a> Family<'a> {
    /// Of a scene with its mechanism, built from `files`, over the numeric field called `field`.
    pub fn new(scene: &'a Scene, files: &'a Files, mechanism: &'a Arc<Mechanism>, field: &str) -> Self {
        Self { scene, files, mechanism, path: FieldPath::new(field) }
    }

    /// The model where the field has this value, or why there is none.
    pub fn model(&self, value: f64) -> Result<Model, NoModel> {
        let mut scene = self.scene.clone();
        if !self.path.set(&mut scene, value) {
            return Err(NoModel::NoField);
        }
        let mechanism = match scene.mechanism == self.scene.mechanism {
            true => Arc::clone(self.mechanism),
            false => match Mechanism::build(&scene.mechanism, self.files) {
                Ok(mechanism) => Arc::new(mechanism),
                Err(BuildError::Wrong(fault)) => return Err(NoModel::Faults(vec![fault])),
                Err(BuildError::Unsolved(_)) => return Err(NoModel::Unsolved),
            },
        };
        Model::build(&scene, mechanism).map_err(NoModel::Faults)
    }
}

/// Why a value of a field makes no model.
#[derive(Debug, Clone, PartialEq)]
pub enum NoModel {
    /// The scene does not have the field.
    NoField,
    /// The scene has faults.
    Faults(Vec<Fault>),
    /// Its mechanism is valid but not solved.
    Unsolved,
}
