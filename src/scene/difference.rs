//! Which `--set` arguments turn one scene into another?

use super::data::Scene;
use super::fields::{FieldPath, numeric_fields};
use super::text::options;

/// What a run, a curve or a map of `to` needs set on `from`, as `FIELD=VALUE`: numbers one by one where only they differ,
/// whole values where the choice does. Title, notes, sweep and hints for the window do not act on a run and are left out.
pub fn assignments(from: &Scene, to: &Scene) -> Vec<String> {
    let mut numbers = from.clone();
    let mut found: Vec<(String, String)> = Vec::new();
    for path in numeric_fields(to) {
        let own = FieldPath::new(&path);
        if let (Some(before), Some(after)) = (own.get(from), own.get(to))
            && before != after
            && own.set(&mut numbers, after)
        {
            found.push((path, format!("{after}")));
        }
    }
    let mut whole = |name: &str, equal: bool, value: Result<String, ron::Error>| {
        if let (false, Ok(value)) = (equal, value) {
            found.retain(|(path, _)| path.split('.').next() != Some(name));
            found.push((name.to_owned(), value));
        }
    };
    let mechanism = options().to_string(&to.mechanism);
    whole("mechanism", numbers.mechanism == to.mechanism, mechanism);
    whole("damping", numbers.damping == to.damping, options().to_string(&to.damping));
    whole("stops", numbers.stops == to.stops, options().to_string(&to.stops));
    whole("excitation", numbers.excitation == to.excitation, options().to_string(&to.excitation));
    whole("start", numbers.start == to.start, options().to_string(&to.start));
    whole("run", numbers.run == to.run, options().to_string(&to.run));
    found.into_iter().map(|(path, value)| format!("{path}={value}")).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Document, PRESETS};
    use super::*;

    #[test]
    fn set_on_one_scene_they_make_the_other() {
        let acts = |scene: &Scene| Scene {
            title: String::new(),
            notes: String::new(),
            sweep: Vec::new(),
            app: None,
            ..scene.clone()
        };
        for from in PRESETS {
            for to in PRESETS {
                let (mut from, to) = (Document::load(from.name).unwrap(), Document::load(to.name).unwrap());
                for argument in assignments(&from.scene, &to.scene) {
                    from.set(&argument).unwrap();
                }
                assert_eq!(acts(&from.scene), acts(&to.scene));
            }
        }
    }

    #[test]
    fn a_moved_slider_is_one_number() {
        let from = Document::load("first-look").unwrap().scene;
        let mut to = Document::load("first-look").unwrap();
        to.set("excitation.amplitude_g=1.3").unwrap();
        assert_eq!(assignments(&from, &to.scene), ["excitation.amplitude_g=1.3"]);
        to.set("stops=Rigid(travel_limit_mm: 1.5, restitution: 0.36)").unwrap();
        let own = assignments(&from, &to.scene);
        assert_eq!(
            own,
            ["excitation.amplitude_g=1.3", "stops=Rigid(travel_limit_mm:1.5,restitution:0.36)"],
            "{own:?}"
        );
        assert!(assignments(&from, &from).is_empty());
    }
}
