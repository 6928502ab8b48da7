//! Axes of a sweep: their values, and the names of their columns.

use std::collections::HashSet;

use super::clip::clip;
use super::data::{Scene, SweepAxis};
use super::fields::{Field, FieldPath, numeric_fields};
use super::ranges::{Spec, number_text};
use super::steps::EvenSteps;
use crate::numeric::Decimal;

/// The most values that one axis may have. A map is refused by its number of cells, long before; this
/// keeps the list of values itself within 80 MB.
pub const LARGEST_AXIS: usize = 10_000_000;

/// The most axes that a sweep may have.
pub const MOST_AXES: usize = 10;

/// One axis of a sweep, written out: a numeric field and the values that it takes, in its own unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Dotted path of the field.
    pub field: String,
    /// The values, each within the field's range; at least one.
    pub values: Vec<f64>,
    /// First value, last value and step that they were written out from, where they were.
    steps: Option<[f64; 3]>,
    path: FieldPath,
}

impl Axis {
    /// Reads `FIELD=FROM:TO:STEP` or `FIELD=a,b,c` for a scene. Values are decimal-exact (see
    /// `steps`); the error is a sentence without the argument, which the caller knows.
    pub fn parse(argument: &str, scene: &Scene) -> Result<Self, String> {
        let Some((field, values)) = argument.split_once('=') else {
            return Err(
                "write FIELD=FROM:TO:STEP or FIELD=a,b,c, such as stops.travel_limit_mm=1:4:0.5".into()
            );
        };
        let (field, values) = (field.trim(), values.trim());
        let spec = numeric(scene, field)?;
        let read = |text: &str| {
            let text = text.trim();
            let finite = Decimal::parse(text).filter(|own| own.value().is_finite());
            let endless = if spec.range.high == f64::INFINITY { "; inf stands in a list alone" } else { "" };
            finite.ok_or_else(|| {
                let text = clip(text);
                format!("`{text}` is not a finite decimal number; {}{endless}", spec.remedy)
            })
        };
        let mut steps = None;
        let values = if values.contains(':') {
            let parts: Vec<&str> = values.split(':').collect();
            let [from, to, step] = parts[..] else {
                return Err(format!("`{}` is not FROM:TO:STEP, such as 0:2:0.02", clip(values)));
            };
            let parts = [read(from)?, read(to)?, read(step)?];
            steps = Some(parts.map(Decimal::value));
            write_out(EvenSteps::new(parts[0], parts[1], parts[2])?)?
        } else {
            // (infinity is a value where the field takes it: an open circuit)
            let endless = |text: &str| text.trim() == "inf" && spec.range.high == f64::INFINITY;
            let listed = values.split(',').map(|text| match endless(text) {
                true => Ok(f64::INFINITY),
                false => Ok(read(text)?.value()),
            });
            listed.collect::<Result<Vec<f64>, String>>()?
        };
        Self { field: field.to_owned(), values, steps, path: FieldPath::new(field) }.within(spec)
    }

    /// Writes out an axis of a scene's own `sweep`, through the shortest decimals of its numbers. The
    /// error is the part of the axis at fault (`field`, `from`, `to`, `step` or `values`) and a sentence.
    pub fn from_scene(axis: &SweepAxis, scene: &Scene) -> Result<Self, (&'static str, String)> {
        let spec = numeric(scene, &axis.field).map_err(|problem| ("field", problem))?;
        let own = |values, steps| Self {
            field: axis.field.clone(),
            values,
            steps,
            path: FieldPath::new(&axis.field),
        };
        if !axis.values.is_empty() {
            if axis.values.len() > LARGEST_AXIS {
                return Err(("values", too_long(axis.values.len())));
            }
            return own(axis.values.clone(), None).within(spec).map_err(|problem| ("values", problem));
        }
        let read = |part, value| {
            let problem = || (part, format!("{} is not a finite number", number_text(value)));
            Decimal::shortest(value).ok_or_else(problem)
        };
        let parts = (read("from", axis.from)?, read("to", axis.to)?, read("step", axis.step)?);
        let below = axis.to < axis.from;
        let part = if axis.step > 0.0 && below { "to" } else { "step" };
        let grid = EvenSteps::new(parts.0, parts.1, parts.2).map_err(|problem| (part, problem.to_owned()))?;
        let values = write_out(grid).map_err(|problem| ("step", problem))?;
        let part = if spec.range.contains(axis.from) { "to" } else { "from" };
        own(values, Some([axis.from, axis.to, axis.step])).within(spec).map_err(|problem| (part, problem))
    }

    /// The axis as a scene's own `sweep` has it: [`from_scene`](Self::from_scene) gives the same values
    /// again, to the bit.
    pub fn to_scene(&self, scene: &Scene) -> SweepAxis {
        let even = self.steps.map(|[from, to, step]| SweepAxis {
            field: self.field.clone(),
            from,
            to,
            step,
            values: Vec::new(),
        });
        // More digits than a double has may stand in an argument.
        let same =
            |axis: &SweepAxis| Self::from_scene(axis, scene).is_ok_and(|own| own.values == self.values);
        even.filter(same).unwrap_or_else(|| SweepAxis {
            field: self.field.clone(),
            values: self.values.clone(),
            ..SweepAxis::default()
        })
    }

    /// Puts the axis's value number `index` into a scene that has the field; out of range, nothing
    /// happens. Allocates nothing.
    pub fn apply(&self, scene: &mut Scene, index: usize) {
        if let Some(value) = self.values.get(index) {
            let known = self.path.set(scene, *value);
            debug_assert!(known, "an axis belongs to a scene that has its field");
        }
    }

    fn within(self, spec: &Spec) -> Result<Self, String> {
        match self.values.iter().find(|value| !spec.range.contains(**value)) {
            None => Ok(self),
            Some(value) => Err(format!(
                "{} takes {}, not {}; {}",
                self.field,
                spec.range,
                number_text(*value),
                spec.remedy
            )),
        }
    }
}

/// What is known of a numeric field, or the sentence that lists those that there are.
fn numeric(scene: &Scene, field: &str) -> Result<&'static Spec, String> {
    let found = FieldPath::new(field).follow(&mut scene.clone(), |found| match found {
        Field::Number(spec, _) => Some(spec),
        _ => None,
    });
    match found.flatten() {
        Some(spec) if !field.starts_with("sweep.") => Ok(spec),
        _ => Err(unknown("numeric field", field, &numeric_fields(scene))),
    }
}

/// The sentence for a path that does not exist.
pub(super) fn unknown(kind: &str, field: &str, known: &[String]) -> String {
    const SHOWN: usize = 60;
    let more = known.len().saturating_sub(SHOWN);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let known = known.iter().take(SHOWN).map(String::as_str).collect::<Vec<_>>().join(", ");
    format!("the scene has no {kind} `{}`; it has: {known}{more}", clip(field))
}

fn write_out(grid: EvenSteps) -> Result<Vec<f64>, String> {
    match usize::try_from(grid.count()) {
        Ok(count) if count <= LARGEST_AXIS => Ok((0..count as u128).map(|i| grid.at(i).value()).collect()),
        _ => Err(too_long(grid.count())),
    }
}

fn too_long(count: impl std::fmt::Display) -> String {
    format!("{count} values are more than an axis may have ({LARGEST_AXIS}); give a larger step")
}

/// Column names for swept fields: of each path the shortest ending that no other one shares and that
/// holds a name (`travel_limit_mm`; for two amplitudes `0.amplitude_g` and `1.amplitude_g`; for one
/// coefficient `coefficients_si.2`, because `2` would say nothing).
pub fn column_names<S: AsRef<str>>(fields: &[S]) -> Vec<String> {
    let ending = |field: &str, parts: usize| -> String {
        let all: Vec<&str> = field.split('.').collect();
        all[all.len().saturating_sub(parts)..].join(".")
    };
    let named = |text: &str| text.split('.').any(|part| part.parse::<usize>().is_err());
    let column = |field: &S| {
        let field = field.as_ref();
        let most = field.split('.').count();
        let unique = |parts: &usize| {
            let own = ending(field, *parts);
            let same = fields.iter().filter(|other| ending(other.as_ref(), *parts) == own).count();
            named(&own) && same == 1
        };
        (1..=most).find(unique).map_or_else(|| field.to_owned(), |parts| ending(field, parts))
    };
    fields.iter().map(column).collect()
}

/// The first field that stands on two axes.
pub(super) fn repeated<'a>(fields: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let mut seen = HashSet::new();
    fields.into_iter().find(|field| !seen.insert(*field))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_short_as_they_can_be() {
        let names = |fields: &[&str]| column_names(fields).join(" ");
        assert_eq!(
            names(&["stops.travel_limit_mm", "excitation.amplitude_g"]),
            "travel_limit_mm amplitude_g"
        );
        assert_eq!(
            names(&["excitation.0.amplitude_g", "excitation.1.amplitude_g"]),
            "0.amplitude_g 1.amplitude_g"
        );
        assert_eq!(names(&["mechanism.tolerance", "run.tolerance"]), "mechanism.tolerance run.tolerance");
        assert_eq!(names(&["mechanism.coefficients_si.2"]), "coefficients_si.2");
        assert_eq!(
            names(&["excitation.0.amplitude_g", "excitation.1.0.amplitude_g"]),
            "excitation.0.amplitude_g 1.0.amplitude_g"
        );
    }

    #[test]
    fn a_field_on_two_axes_is_noticed() {
        assert_eq!(repeated(["a", "b", "a"]), Some("a"));
        assert_eq!(repeated(["a", "b"]), None);
    }
}
