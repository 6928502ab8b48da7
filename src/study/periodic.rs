//! Drives that a study of one forcing period can do with.

use crate::dynamics::Model;
use crate::scene::{Fault, Scene};

/// Whether nothing in the excitation changes: there is none, or a constant acceleration alone.
pub(super) fn is_constant(model: &Model) -> bool {
    let drive = model.excitation();
    drive.tones.is_empty() && drive.chirps.is_empty() && drive.records.is_empty()
}

/// What is wrong with a scene whose excitation changes and does not repeat; `what` needs that it does.
pub(super) fn without_a_period(model: &Model, scene: &Scene, what: &str) -> Option<Fault> {
    let suits = model.repeats() || is_constant(model);
    (!suits).then(|| {
        let word = format!("{:?}", scene.excitation);
        Fault {
            field: "excitation".into(),
            value: word.split([' ', '(', '{']).next().unwrap_or_default().to_owned(),
            problem: format!(
                "has no period that repeats, which {what} needs; take a Sine, a Sum of sines whose \
                 frequencies have a common period, a Constant, or None"
            ),
        }
    })
}
