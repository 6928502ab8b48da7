//! Scenes of a lesson, step by step.

use std::path::Path;

use super::{Lesson, Step};
use crate::scene::document::Document;
use crate::scene::error::Fault;
use crate::scene::presets::PRESETS;

/// The scenes of a step.
#[derive(Debug, Clone)]
pub(super) struct Stage {
    /// As it begins.
    pub begin: Document,
    /// As its answer or its solution has it; for a step that only tells something as it begins.
    pub end: Document,
}

/// The scenes of all steps; what is wrong with them goes to `wrong`.
pub(super) fn stages(lesson: &Lesson, folder: Option<&Path>, wrong: &mut Vec<Fault>) -> Vec<Stage> {
    let preset = PRESETS.iter().any(|preset| preset.name == lesson.scene);
    let spec = match folder.filter(|_| !preset) {
        Some(folder) => folder.join(&lesson.scene).to_string_lossy().into_owned(),
        None => lesson.scene.clone(),
    };
    let mut own = match Document::load(&spec) {
        Ok(document) => document,
        Err(error) => {
            wrong.push(Fault {
                field: "scene".into(),
                value: lesson.scene.clone(),
                problem: error.to_string().lines().next().unwrap_or_default().to_owned(),
            });
            return Vec::new();
        }
    };
    let mut changed = |document: &mut Document, changes: &[(String, String)], at: &str| {
        for (index, (field, value)) in changes.iter().enumerate() {
            if let Err(error) = document.assign(field, value, &format!("{field}={value}")) {
                let (value, problem) = (format!("{field}={value}"), error.problem);
                wrong.push(Fault { field: format!("{at}.{index}"), value, problem });
            }
        }
        if let Err(error) = document.check() {
            let problem = error.to_string().lines().next().unwrap_or_default().to_owned();
            wrong.push(Fault { field: at.to_owned(), value: String::new(), problem });
        }
    };
    changed(&mut own, &lesson.set, "set");
    let mut stages = Vec::with_capacity(lesson.steps.len());
    for (index, step) in lesson.steps.iter().enumerate() {
        let at = |part: &str| format!("steps.{index}.{part}");
        let stage = match step {
            Step::Say(_) | Step::Explain(_) => Stage { begin: own.clone(), end: own.clone() },
            Step::Predict { set, .. } => {
                let begin = own.clone();
                changed(&mut own, set, &at("set"));
                Stage { begin, end: own.clone() }
            }
            Step::Do { set, solution, .. } => {
                changed(&mut own, set, &at("set"));
                let mut end = own.clone();
                changed(&mut end, solution, &at("solution"));
                Stage { begin: own.clone(), end }
            }
        };
        stages.push(stage);
    }
    stages
}
