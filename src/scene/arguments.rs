//! `--set` arguments that turn one scene into another.

use serde::Serialize;

use super::data::Scene;
use super::fields::{FieldPath, numeric_fields};
use super::text;

/// `FIELD=VALUE` for each field in which `to` differs from `from`, as `--set` takes them: single numbers
/// if both scenes have the same fields, otherwise whole parts. Title, notes, sweep and hints for the
/// window are ignored.
pub fn arguments(from: &Scene, to: &Scene) -> Vec<String> {
    let mut all = Vec::new();
    let mut part = |name: &str, equal: bool, whole: String| {
        if equal {
            return;
        }
        match numbers(from, to, name) {
            Some(numbers) => all.extend(numbers),
            None => all.push(format!("{name}={whole}")),
        }
    };
    part("mass_g", from.mass_g == to.mass_g, String::new());
    part("mechanism", from.mechanism == to.mechanism, ron(&to.mechanism));
    part("damping", from.damping == to.damping, ron(&to.damping));
    part("stops", from.stops == to.stops, ron(&to.stops));
    part("excitation", from.excitation == to.excitation, ron(&to.excitation));
    part("transducer", from.transducer == to.transducer, ron(&to.transducer));
    part("start", from.start == to.start, ron(&to.start));
    part("run", from.run == to.run, ron(&to.run));
    all
}

/// The numbers inside one part that differ; `None` if the part differs in anything else.
fn numbers(from: &Scene, to: &Scene, part: &str) -> Option<Vec<String>> {
    let inside = |path: &String| path.strip_prefix(part).is_some_and(|r| r.is_empty() || r.starts_with('.'));
    let mut changed = from.clone();
    let mut found = Vec::new();
    for path in numeric_fields(to).into_iter().filter(inside) {
        let field = FieldPath::new(&path);
        let (old, new) = (field.get(from), field.get(to));
        if let Some(new) = new.filter(|_| old != new) {
            if !field.set(&mut changed, new) {
                return None;
            }
            found.push(format!("{path}={new}"));
        }
    }
    let same = match part {
        "mass_g" => true,
        "mechanism" => changed.mechanism == to.mechanism,
        "damping" => changed.damping == to.damping,
        "stops" => changed.stops == to.stops,
        "excitation" => changed.excitation == to.excitation,
        "transducer" => changed.transducer == to.transducer,
        "start" => changed.start == to.start,
        "run" => changed.run == to.run,
        _ => false,
    };
    same.then_some(found)
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
