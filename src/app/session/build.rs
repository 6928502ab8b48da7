//! Construction of the model of a scene, and the reasons why it fails.

use std::sync::Arc;

use crate::app::words::fields::{in_words, name_and_unit};
use crate::dynamics::Model;
use crate::mechanics::{BuildError, FlexureError, Mechanism};
use crate::scene::{Document, Excitation, Fault, Scene, SceneError};

/// Why a scene cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum CannotRun {
    #[error(transparent)]
    Wrong(#[from] SceneError),
    /// The scene is valid, but its flexures could not be solved.
    #[error(transparent)]
    Unsolved(#[from] FlexureError),
}

pub(super) fn build_error(document: &Document, error: BuildError) -> CannotRun {
    match error {
        BuildError::Wrong(fault) => document.error_from(vec![fault]).into(),
        BuildError::Unsolved(error) => error.into(),
    }
}

/// Builds the mechanism and the model of a scene.
pub(super) fn solve(document: &Document, tolerance: f64) -> Result<(Arc<Mechanism>, Model), CannotRun> {
    document.check()?;
    let scene = &document.scene;
    let mechanism = Mechanism::build_with(&scene.mechanism, &document.files, tolerance)
        .map_err(|error| build_error(document, error))?;
    let mechanism = Arc::new(mechanism);
    let model = Model::build(scene, Arc::clone(&mechanism)).map_err(|faults| document.error_from(faults))?;
    Ok((mechanism, model))
}

/// The first fault, with the field names of the screen and without the position in the file, which is of no
/// use at a slider.
pub(super) fn fault_message(error: &CannotRun, scene: &Scene) -> String {
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

/// Whether two scenes differ in the amplitude of a sine at most, so that their thresholds are the same.
pub(super) fn differ_in_amplitude_alone(a: &Scene, b: &Scene) -> bool {
    let mut changed = a.clone();
    match (&mut changed.excitation, &b.excitation) {
        (Excitation::Sine { amplitude_g: other, .. }, Excitation::Sine { amplitude_g, .. }) => {
            *other = *amplitude_g
        }
        _ => return false,
    }
    changed == *b
}
