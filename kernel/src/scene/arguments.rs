//! `--set` arguments that turn one scene into another.

use serde::Serialize;

use super::data::Scene;
use super::fields::{FieldPath, numeric_fields};
use super::text;
use super::written::covers;

/// `FIELD=VALUE` for each field in which `to` differs from `from`, as `--set` takes them: single numbers
/// if both scenes have the same fields, otherwise whole parts. Title, notes, sweep and hints for the
/// window are ignored.
#[doc(hidden)]
pub fn arguments(from: &Scene, to: &Scene) -> Vec<String> {
    [
        changes(from, to, "mass_g", |scene| &scene.mass_g),
        changes(from, to, "mechanism", |scene| &scene.mechanism),
        changes(from, to, "damping", |scene| &scene.damping),
        changes(from, to, "stops", |scene| &scene.stops),
        changes(from, to, "excitation", |scene| &scene.excitation),
        changes(from, to, "transducer", |scene| &scene.transducer),
        changes(from, to, "start", |scene| &scene.start),
        changes(from, to, "run", |scene| &scene.run),
    ]
    .concat()
}

/// The arguments for one part of a scene: its numbers that differ, or the whole part if anything else in it
/// differs.
fn changes<T: PartialEq + Serialize>(
    from: &Scene,
    to: &Scene,
    name: &str,
    part: fn(&Scene) -> &T,
) -> Vec<String> {
    let mut changed = from.clone();
    let mut numbers = Vec::new();
    for path in numeric_fields(to).into_iter().filter(|path| covers(name, path)) {
        let field = FieldPath::new(&path);
        let (old, new) = (field.get(from), field.get(to));
        if let Some(new) = new.filter(|_| old != new) {
            // a field that `from` does not have leaves the parts different
            let _ = field.set(&mut changed, new);
            numbers.push(format!("{path}={new}"));
        }
    }
    if part(&changed) == part(to) { numbers } else { vec![format!("{name}={}", ron(part(to)))] }
}

/// A value as RON on one line.
fn ron(value: &impl Serialize) -> String {
    let text = text::options().without_recursion_limit().to_string(value).unwrap_or_default();
    // RON writes the choice `None` as `r#None`, to distinguish it from an absent option
    text.strip_prefix("r#").map_or(text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Damping, Document, PRESETS, Stops};

    /// Turns every preset into every other one, and "paper" also into presets with a few changes.
    #[test]
    fn arguments_turn_one_scene_into_another() {
        for from in PRESETS {
            for to in PRESETS {
                let mut changed = Document::load(from.name).unwrap();
                let mut to = Document::load(to.name).unwrap().scene;
                if from.name == "paper" {
                    (to.stops, to.damping, to.mass_g) = (Stops::None, Damping::None, 17.25);
                }
                let arguments = arguments(&changed.scene, &to);
                for argument in &arguments {
                    changed.set(argument).unwrap();
                }
                assert!(super::arguments(&changed.scene, &to).is_empty(), "{}: {arguments:?}", from.name);
                assert_eq!(changed.scene.transducer, to.transducer, "{}: {arguments:?}", from.name);
            }
        }
        let paper = Document::load("paper").unwrap().scene;
        let mut other = paper.clone();
        other.mass_g = 16.5;
        other.damping = Damping::Ratio(0.05);
        other.stops = Stops::None;
        assert_eq!(arguments(&paper, &other), ["mass_g=16.5", "damping.xi=0.05", "stops=None"]);
    }
}
