//! Models that differ in one field of their scene.

use std::sync::Arc;

use crate::dynamics::Model;
use crate::mechanics::Mechanism;
use crate::scene::{FieldPath, Files, Scene};

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

    /// The model where the field has this value; none where that makes no valid scene.
    pub fn model(&self, value: f64) -> Option<Model> {
        let mut scene = self.scene.clone();
        if !self.path.set(&mut scene, value) {
            return None;
        }
        let mechanism = match scene.mechanism == self.scene.mechanism {
            true => Arc::clone(self.mechanism),
            false => Arc::new(Mechanism::build(&scene.mechanism, self.files).ok()?),
        };
        Model::build(&scene, mechanism).ok()
    }
}
