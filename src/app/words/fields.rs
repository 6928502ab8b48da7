//! Fields of a scene in words: their names on the screen, and sentences that name them.

use crate::scene::{Control, Mechanism, Scene, field_info, without_indices};

/// The range of a slider and the step of the arrow keys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    pub low: f64,
    pub high: f64,
    /// The step of the arrow keys; on a logarithmic slider only of the number beside it.
    pub step: f64,
    /// Whether the slider is logarithmic; then `low` is above 0.
    pub ratios: bool,
}

impl Reach {
    pub const fn even(low: f64, high: f64, step: f64) -> Self {
        Self { low, high, step, ratios: false }
    }
}

pub fn mechanism_name(mechanism: &Mechanism) -> String {
    match mechanism {
        Mechanism::Flexures { .. } => "flexures".to_owned(),
        Mechanism::Cubic { .. } => "cubic".to_owned(),
        Mechanism::DoubleWell { .. } => "double well".to_owned(),
        Mechanism::Polynomial { coefficients_si } => format!("polynomial of {}", coefficients_si.len()),
        Mechanism::Pieces { pieces, .. } => format!("{} polynomials", pieces.len()),
        Mechanism::Table { path, .. } => path.clone(),
        Mechanism::Linear { .. } => "spring".to_owned(),
        Mechanism::Magnet { .. } => "magnet".to_owned(),
        Mechanism::Sum(parts) => parts.iter().map(mechanism_name).collect::<Vec<_>>().join(" + "),
    }
}

pub fn info(path: &str) -> Option<&'static Control> {
    field_info(path)?.control.as_ref()
}

/// The coefficients of a polynomial force, from the constant one.
const POWERS: [(&str, &str); 4] = [
    ("constant force", "N"),
    ("coefficient of x", "N/m"),
    ("coefficient of x²", "N/m²"),
    ("coefficient of x³", "N/m³"),
];

/// Name of a field on the screen, and its unit.
pub fn name_and_unit(path: &str) -> (String, &'static str) {
    let power = path.strip_prefix("mechanism.coefficients_si.").and_then(|power| power.parse::<usize>().ok());
    if let Some(power) = power {
        let (name, unit) = POWERS.get(power).copied().unwrap_or(("", ""));
        let name = if name.is_empty() { format!("coefficient of x to the {power}") } else { name.to_owned() };
        return (name, unit);
    }
    let number = field_info(path).and_then(|field| Some((field.name?, field.unit())));
    let file = || match without_indices(path).as_str() {
        "mechanism.path" => Some(("table of the force", "")),
        "excitation.path" => Some(("record", "")),
        _ => None,
    };
    let Some((name, unit)) = number.or_else(file) else { return (path.to_owned(), "") };
    let part = path.split('.').find_map(|part| part.parse::<usize>().ok());
    (part.map_or_else(|| name.to_owned(), |index| format!("{name} of part {}", index + 1)), unit)
}

/// A sentence about a scene, with the paths of fields replaced by their names on the screen.
pub fn in_words(text: &str, scene: &Scene) -> String {
    let mut paths = crate::scene::all_fields(scene);
    // longer paths first: one path may be the beginning of another
    paths.sort_by_key(|path| std::cmp::Reverse(path.len()));
    let mut text = text.to_owned();
    for path in paths.iter().filter(|path| path.contains('.') || *path == "mass_g") {
        if text.contains(path.as_str()) {
            text = text.replace(path.as_str(), &name_and_unit(path).0);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_a_name_of_its_own() {
        let parts =
            ["poisson", "initial_bow", "yield", "coefficients", "app.", "count", "stops.", "tolerance"];
        for preset in crate::scene::PRESETS {
            let scene = crate::scene::Document::load(preset.name).unwrap().scene;
            for path in crate::scene::numeric_fields(&scene) {
                let may_be_unnamed = parts.iter().any(|part| path.contains(part));
                assert!(name_and_unit(&path).0 != path || may_be_unnamed, "{}: {path}", preset.name);
            }
        }
        assert_eq!(name_and_unit("excitation.1.amplitude_g"), ("amplitude of part 2".to_owned(), "g"));
        let scene = crate::scene::Document::load("random-shaking").unwrap().scene;
        let text = "excitation.high_hz = 1: must be above excitation.low_hz = 2";
        assert_eq!(in_words(text, &scene), "highest = 1: must be above lowest = 2");
    }
}
