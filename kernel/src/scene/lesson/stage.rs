//! Scenes of the steps of a lesson.

use std::path::Path;

use super::{Lesson, Step};
use crate::scene::document::Document;
use crate::scene::error::{Fault, SceneError};
use crate::scene::presets::PRESETS;

/// The scenes of a step.
#[derive(Debug, Clone)]
pub(super) struct Stage {
    /// At the beginning of the step.
    pub begin: Document,
    /// For the answer or the solution; at the beginning for a step without them.
    pub end: Document,
}

/// The scenes of all steps; their faults are added to `found`.
pub(super) fn stages(lesson: &Lesson, folder: Option<&Path>, found: &mut Vec<Fault>) -> Vec<Stage> {
    let preset = PRESETS.iter().any(|preset| preset.name == lesson.scene);
    let spec = match folder.filter(|_| !preset) {
        Some(folder) => folder.join(&lesson.scene).to_string_lossy().into_owned(),
        None => lesson.scene.clone(),
    };
    let first_line = |error: &SceneError| error.to_string().lines().next().unwrap_or_default().to_owned();
    let mut current = match Document::load(&spec) {
        Ok(document) => document,
        Err(error) => {
            found.push(Fault::new("scene", &lesson.scene, first_line(&error)));
            return Vec::new();
        }
    };
    let mut change = |document: &mut Document, changes: &[(String, String)], at: &str| {
        for (index, (field, value)) in changes.iter().enumerate() {
            if let Err(error) = document.assign(field, value, &format!("{field}={value}")) {
                found.push(Fault::new(format!("{at}.{index}"), format!("{field}={value}"), error.problem));
            }
        }
        if let Err(error) = document.check() {
            found.push(Fault::new(at, "", first_line(&error)));
        }
    };
    change(&mut current, &lesson.set, "set");
    let mut stages = Vec::with_capacity(lesson.steps.len());
    for (index, step) in lesson.steps.iter().enumerate() {
        let at = |part: &str| format!("steps.{index}.{part}");
        let stage = match step {
            Step::Say(_) | Step::Explain(_) => Stage { begin: current.clone(), end: current.clone() },
            Step::Predict { set, .. } => {
                let begin = current.clone();
                change(&mut current, set, &at("set"));
                Stage { begin, end: current.clone() }
            }
            Step::Do { set, solution, .. } => {
                change(&mut current, set, &at("set"));
                let mut end = current.clone();
                change(&mut end, solution, &at("solution"));
                Stage { begin: current.clone(), end }
            }
        };
        stages.push(stage);
    }
    stages
}
