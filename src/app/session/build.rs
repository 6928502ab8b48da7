//! Conversion of a scene into a model, and the reasons why it fails.

use std::sync::Arc;

use crate::app::words::fields::{in_words, name_and_unit};
use crate::dynamics::Model;
use crate::mechanics::{BuildError, FlexureError, Mechanism};
use crate::scene::{Document, Fault, Scene, SceneError};

/// Why a scene cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum CannotRun {
    #[error(transparent)]
    Wrong(#[from] SceneError),
    /// It has no fault, but its flexures were not solved.
    #[error(transparent)]
    Unsolved(#[from] FlexureError),
}

pub(super) fn unbuilt(document: &Document, error: BuildError) -> CannotRun {
    match error {
        BuildError::Wrong(fault) => document.error_from(vec![fault]).into(),
        BuildError::Unsolved(error) => error.into(),
    }
}

/// The mechanism of a scene, and the model of the scene with it.
pub(super) fn solved(document: &Document, tolerance: f64) -> Result<(Arc<Mechanism>, Model), CannotRun> {
    document.check()?;
    let scene = &document.scene;
    let mechanism = Mechanism::build_with(&scene.mechanism, &document.files, tolerance)
        .map_err(|error| unbuilt(document, error))?;
    let mechanism = Arc::new(mechanism);
    let model = Model::build(scene, Arc::clone(&mechanism)).map_err(|faults| document.error_from(faults))?;
    Ok((mechanism, model))
}

/// The first thing that is wrong, with the names on the screen and without the place in a file, which does not
/// help at a slider.
pub(super) fn why(error: &CannotRun, scene: &Scene) -> String {
    match error {
        CannotRun::Wrong(SceneError::Faults { faults, .. }) => faults.first().map_or_else(
            || error.to_string(),
            |placed| {
                let Fault { field, value, problem } = &placed.fault;
                let (name, unit) = name_and_unit(field);
                let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
                in_words(&format!("{name} = {value}{unit}: {problem}"), scene)
            },
        ),
        _ => error.to_string(),
    }
}
