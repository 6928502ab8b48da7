//! Choice of the two axes of a map, and of their ranges.

use crate::app::words::numbers::{below, decimal, round_up};
use crate::scene::{Excitation, FieldPath, Scene, Start, Stops, SweepAxis, field_info, numeric_fields};
use interwell_studies::study::{label_and_unit, with_unit};

/// Ends and step of the travel limit in mm on the prototype's map, for scenes of its size.
const LIMITS_MM: (f64, f64, f64) = (0.5, 7.0, 0.125);
/// Ends and step of the amplitude in g on the same map.
const AMPLITUDES_G: (f64, f64, f64) = (0.0, 2.0, 0.02);

/// Number of steps of an axis whose range is derived from the present value.
const STEPS: f64 = 40.0;

/// Where the runs of a map start: at rest, or where the scene does if nothing shakes it.
pub fn start(scene: &Scene) -> Start {
    if scene.excitation == Excitation::None { scene.start } else { Start::Rest }
}

/// The scene that a map is made of, which has the fields of the axes: from rest, or from its start where
/// nothing shakes it, and with the stops `when_on` if it has none and an axis is over a field of the stops.
pub fn ground(scene: &Scene, when_on: Stops, axes: &[SweepAxis]) -> Scene {
    let mut ground = Scene {
        start: start(scene),
        title: String::new(),
        notes: String::new(),
        sweep: Vec::new(),
        app: None,
        ..scene.clone()
    };
    if ground.stops == Stops::None && axes.iter().any(|axis| axis.field.starts_with("stops.")) {
        ground.stops = when_on;
    }
    ground
}

/// The fields of a scene that can be an axis, in the order in which they are offered.
pub fn fields(scene: &Scene, when_on: Stops) -> Vec<String> {
    let mut scene = scene.clone();
    if scene.stops == Stops::None {
        scene.stops = when_on;
    }
    let mut known: Vec<(u8, String)> = numeric_fields(&scene)
        .into_iter()
        .filter(|path| FieldPath::new(path).get(&scene).is_some())
        .filter_map(|path| Some((field_info(&path)?.axis?, path)))
        .collect();
    known.sort_by_key(|(place, _)| *place);
    known.into_iter().map(|(_, path)| path).collect()
}

/// The axes of a scene's map: its two sweep axes if both have even steps, else travel limit and amplitude,
/// else the first two fields of the scene that can be axes.
pub fn default_axes(scene: &Scene, when_on: Stops, well_mm: Option<f64>) -> Option<[SweepAxis; 2]> {
    let (known, with_stops) = (fields(scene, when_on), ground(scene, when_on, &scene.sweep));
    let has_field = |axis: &SweepAxis| FieldPath::new(&axis.field).get(&with_stops).is_some();
    if let [a, b] = scene.sweep.as_slice()
        && [a, b].into_iter().all(|axis| axis.values.is_empty() && has_field(axis))
    {
        return Some([a.clone(), b.clone()]);
    }
    let first = known.iter().find(|path| path.ends_with("travel_limit_mm"));
    let second = known.iter().find(|path| is_amplitude(path) || path.ends_with("rms_g"));
    let rest = || known.iter().filter(|path| Some(*path) != first && Some(*path) != second);
    let a = first.or_else(|| rest().next())?;
    let b = second.or_else(|| rest().find(|path| *path != a))?;
    Some([a, b].map(|path| axis(path, scene, when_on, well_mm)))
}

/// Whether a field is the amplitude of a drive.
pub fn is_amplitude(path: &str) -> bool {
    path.rsplit('.').next().is_some_and(|name| name.starts_with("amplitude_"))
}

/// An axis over a field, around its present value; `well_mm` is the position of the right-hand well.
pub fn axis(path: &str, scene: &Scene, when_on: Stops, well_mm: Option<f64>) -> SweepAxis {
    let with_stops = ground(scene, when_on, &[SweepAxis { field: path.to_owned(), ..SweepAxis::default() }]);
    // the load of an open circuit is infinite
    let signed = FieldPath::new(path).get(&with_stops).filter(|value| value.is_finite()).unwrap_or(1.0);
    let present = signed.abs();
    let name = path.rsplit('.').next().unwrap_or(path);
    let up_to = |greatest: f64| {
        let to = round_up(greatest);
        let step = decimal(to / STEPS);
        (decimal(4.0 * step), to, step)
    };
    let from_zero = |greatest: f64, steps: f64| {
        let to = round_up(greatest);
        (0.0, to, decimal(to / steps))
    };
    let (from, to, step) = match name {
        "travel_limit_mm" | "left_mm" | "right_mm" => match well_mm.filter(|mm| *mm > 0.0) {
            Some(mm) if (6.0..=7.2).contains(&mm) => LIMITS_MM,
            Some(mm) => up_to(mm),
            None => up_to(2.0 * present),
        },
        "amplitude_g" | "rms_g" if present == 0.0 || (0.3..=AMPLITUDES_G.1).contains(&present) => {
            AMPLITUDES_G
        }
        name if (name == "rms_g" || name.starts_with("amplitude_")) && present > 0.0 => {
            from_zero(2.0 * present, 100.0)
        }
        "xi" => from_zero((2.0 * present).max(0.1), STEPS),
        name if name.starts_with("restitution") => (0.0, 1.0, 1.0 / STEPS),
        "seed" => (1.0, STEPS, 1.0),
        _ if signed < 0.0 => {
            let (from, to, step) = up_to(2.0 * present);
            (-to, -from, step)
        }
        _ => up_to(if present > 0.0 { 2.0 * present } else { 1.0 }),
    };
    // every value leaves the mass room beside the other stop
    let other = match (name, with_stops.stops) {
        ("left_mm", Stops::Uneven { right_mm, .. }) => right_mm,
        ("right_mm", Stops::Uneven { left_mm, .. }) => left_mm,
        _ => None,
    };
    let least = other.map_or(f64::NEG_INFINITY, |mm| -mm);
    let shift = if least >= from { (((least - from) / step).floor() + 1.0) * step } else { 0.0 };
    let (from, to) = (decimal(from + shift), decimal(to + shift));
    SweepAxis { field: path.to_owned(), from, to, step, values: Vec::new() }
}

/// The part of an axis between two of its values, with about as many steps as the axis and a round step.
pub fn part(axis: &SweepAxis, from: f64, to: f64) -> SweepAxis {
    let (from, to) = (from.min(to).max(axis.from), from.max(to).min(axis.to));
    let cells = ((axis.to - axis.from) / axis.step).max(1.0);
    let width = (to - from).max(1e-3 * (axis.to - axis.from));
    let step = below(width / cells).min(axis.step);
    let on_step = |value: f64| decimal((value / step).round() * step);
    // at least one step long, and never below the begin of the axis
    let from = on_step(from).max(axis.from);
    SweepAxis {
        field: axis.field.clone(),
        from,
        to: on_step(to).min(axis.to).max(decimal(from + step)),
        step,
        ..SweepAxis::default()
    }
}

/// The label of an axis, such as `travel limit (mm)`. `column` is the name of the field in a table.
pub fn label(column: &str) -> String {
    let (name, unit) = label_and_unit(column);
    with_unit(name, unit)
}

pub fn over(axis: &SweepAxis) -> String {
    format!("{}={}:{}:{}", axis.field, axis.from, axis.to, axis.step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Document;

    const ON: Stops = Stops::Rigid { travel_limit_mm: 1.5, restitution: 0.36 };

    fn defaults(preset: &str) -> Option<String> {
        let scene = Document::load(preset).unwrap().scene;
        let axes = default_axes(&scene, ON, Some(6.9))?;
        Some(axes.map(|axis| over(&axis)).join(" "))
    }

    #[test]
    fn the_scenes_own_axes_come_first() {
        let paper = "stops.travel_limit_mm=0.5:7:0.25 excitation.amplitude_g=0:2:0.02";
        assert_eq!(defaults("paper").as_deref(), Some(paper));
        let prototype = "stops.travel_limit_mm=0.5:7:0.125 excitation.amplitude_g=0:2:0.02";
        assert_eq!(defaults("first-look").as_deref(), Some(prototype));
        assert!(defaults("random-shaking").is_some_and(|axes| axes.contains("rms_g")));
    }

    #[test]
    fn a_part_of_an_axis_has_as_many_cells() {
        let axis =
            SweepAxis { field: "a".to_owned(), from: 0.5, to: 7.0, step: 0.125, ..SweepAxis::default() };
        let enlarged = part(&axis, 2.51, 1.23);
        assert_eq!((enlarged.from, enlarged.to, enlarged.step), (1.24, 2.5, 0.02));
        let tiny = part(&axis, 6.9999, 6.9999);
        assert!(tiny.step > 0.0 && tiny.to > tiny.from);
    }

    #[test]
    fn runs_start_at_rest_where_the_mass_is_shaken() {
        let scene = |name: &str| Document::load(name).unwrap().scene;
        let (shaken, falling) = (scene("paper"), scene("bouncing-ball"));
        assert_eq!(ground(&Scene { start: falling.start, ..shaken }, ON, &[]).start, Start::Rest);
        assert!(falling.start != Start::Rest && ground(&falling, ON, &[]).start == falling.start);
    }

    #[test]
    fn every_axis_that_is_offered_can_be_swept() {
        for preset in crate::scene::PRESETS {
            let document = Document::load(preset.name).unwrap();
            let known = fields(&document.scene, ON);
            assert!(!known.is_empty(), "{}", preset.name);
            for path in known {
                let axis = axis(&path, &document.scene, ON, Some(6.9));
                let scene = ground(&document.scene, ON, std::slice::from_ref(&axis));
                let read = crate::scene::Axis::from_scene(&axis, &scene);
                let values = read.as_ref().map_or(0, |axis| axis.values.len());
                assert!((20..=101).contains(&values), "{}: {} {values}", preset.name, over(&axis));
                // written as an argument it is the same
                assert_eq!(crate::scene::Axis::parse(&over(&axis), &scene).ok(), read.ok());
            }
        }
    }
}
