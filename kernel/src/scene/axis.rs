//! Axes of a sweep: their values and column names.
//!
//! Even steps are counted in whole units of the last decimal of their three numbers, in 128-bit integers, and
//! every value is the double nearest to its decimal: 0.58 is 0.58, whereas repeated addition of 0.02 would
//! give 0.5800000000000001. Arithmetic counts as the shortest decimal of its value.

use std::collections::HashSet;

use super::arithmetic::{evaluate, is_arithmetic};
use super::data::{Scene, SweepAxis};
use super::error::clip;
use super::field_table::FieldInfo;
use super::fields::{FieldPath, info_of, numeric_fields};
use super::names::nearest;
use crate::numeric::{Decimal, number_text};

/// Largest number of values of one axis, which limits the list of values to 80 MB. The number of cells of a
/// map is limited more tightly.
pub const MAX_AXIS_VALUES: usize = 10_000_000;

/// Largest number of axes of a sweep.
pub const MAX_AXES: usize = 10;

/// One axis of a sweep with all its values: a numeric field and the values that it takes, in its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Dotted path of the field.
    pub field: String,
    /// The values, each within the field's range; at least one.
    pub values: Vec<f64>,
    /// First value, last value and step, if the axis was given by them.
    steps: Option<[f64; 3]>,
    path: FieldPath,
}

impl Axis {
    /// Parses `FIELD=FROM:TO:STEP` or `FIELD=a,b,c` for a scene. Values are exact decimals or arithmetic; the
    /// error is a sentence without the argument, which the caller knows.
    pub fn parse(argument: &str, scene: &Scene) -> Result<Self, String> {
        let Some((field, values)) = argument.split_once('=') else {
            return Err(
                "write FIELD=FROM:TO:STEP or FIELD=a,b,c, such as stops.travel_limit_mm=1:4:0.5".into()
            );
        };
        let (field, values) = (field.trim(), values.trim());
        let spec = numeric(scene, field)?;
        let mut is_exact = true;
        let mut read = |text: &str| {
            let text = text.trim();
            if is_arithmetic(text) {
                is_exact = false;
                let wrong = |what: &str| format!("`{}`: {what}; {}", clip(text), spec.remedy);
                let value = evaluate(text).map_err(|problem| wrong(&problem.what))?;
                return Decimal::shortest(value).ok_or_else(|| wrong("no finite number"));
            }
            let finite = Decimal::parse(text).filter(|decimal| decimal.value().is_finite());
            let hint = if spec.range.high == f64::INFINITY { "; inf stands in a list alone" } else { "" };
            finite.ok_or_else(|| {
                let text = clip(text);
                format!("`{text}` is not a finite decimal number; {}{hint}", spec.remedy)
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
            if is_exact { even_steps(parts)? } else { rounded_steps(parts)? }
        } else {
            // infinity is valid for some fields, as for an open circuit
            let is_infinite = |text: &str| text.trim() == "inf" && spec.range.high == f64::INFINITY;
            let listed = values.split(',').map(|text| match is_infinite(text) {
                true => Ok(f64::INFINITY),
                false => Ok(read(text)?.value()),
            });
            listed.collect::<Result<Vec<f64>, String>>()?
        };
        Self::within(field, values, steps, spec)
    }

    /// An axis with these values of a numeric field of `scene`. The error is a sentence.
    pub fn listed(field: &str, values: Vec<f64>, scene: &Scene) -> Result<Self, String> {
        let spec = numeric(scene, field)?;
        match values.len() {
            0 => Err("has no values; give at least one".to_owned()),
            count if count > MAX_AXIS_VALUES => Err(too_long(count)),
            _ => Self::within(field, values, None, spec),
        }
    }

    /// Expands an axis of a scene's `sweep`, using the shortest decimals of its numbers. The error is the
    /// part of the axis at fault (`field`, `from`, `to`, `step` or `values`) and a sentence.
    pub fn from_scene(axis: &SweepAxis, scene: &Scene) -> Result<Self, (&'static str, String)> {
        let spec = numeric(scene, &axis.field).map_err(|problem| ("field", problem))?;
        let within = |values, steps| Self::within(&axis.field, values, steps, spec);
        if !axis.values.is_empty() {
            if axis.values.len() > MAX_AXIS_VALUES {
                return Err(("values", too_long(axis.values.len())));
            }
            return within(axis.values.clone(), None).map_err(|problem| ("values", problem));
        }
        let read = |part, value| {
            let problem = || (part, format!("{} is not a finite number", number_text(value)));
            Decimal::shortest(value).ok_or_else(problem)
        };
        let parts = [read("from", axis.from)?, read("to", axis.to)?, read("step", axis.step)?];
        let part = if axis.step > 0.0 && axis.to < axis.from { "to" } else { "step" };
        let values = rounded_steps(parts).map_err(|problem| (part, problem))?;
        let part = if spec.range.contains(axis.from) { "to" } else { "from" };
        within(values, Some([axis.from, axis.to, axis.step])).map_err(|problem| (part, problem))
    }

    /// The axis for a scene's `sweep`: [`from_scene`](Self::from_scene) gives exactly the same values again.
    pub fn to_scene(&self, scene: &Scene) -> SweepAxis {
        let (field, values) = (self.field.clone(), Vec::new());
        let even = self.steps.map(|[from, to, step]| SweepAxis { field, from, to, step, values });
        // An argument may have more digits than a double, so the steps may not reproduce the values.
        let same =
            |axis: &SweepAxis| Self::from_scene(axis, scene).is_ok_and(|read| read.values == self.values);
        even.filter(same).unwrap_or_else(|| SweepAxis {
            field: self.field.clone(),
            values: self.values.clone(),
            ..SweepAxis::default()
        })
    }

    /// Sets the field of a scene to value `index` of the axis; does nothing if `index` is out of range. This
    /// does not allocate.
    pub fn apply(&self, scene: &mut Scene, index: usize) {
        if let Some(value) = self.values.get(index) {
            let known = self.path.set(scene, *value);
            debug_assert!(known, "an axis belongs to a scene that has its field");
        }
    }

    /// An axis of a field whose values are within its range.
    fn within(
        field: &str,
        values: Vec<f64>,
        steps: Option<[f64; 3]>,
        spec: &FieldInfo,
    ) -> Result<Self, String> {
        match values.iter().find(|value| !spec.range.contains(**value)) {
            None => Ok(Self { field: field.to_owned(), values, steps, path: FieldPath::new(field) }),
            Some(value) => {
                let value = number_text(*value);
                Err(format!("{field} takes {}, not {value}; {}", spec.range, spec.remedy))
            }
        }
    }
}

/// The specification of a numeric field, or a sentence that lists the numeric fields of the scene.
fn numeric(scene: &Scene, field: &str) -> Result<&'static FieldInfo, String> {
    match info_of(scene, field) {
        Some(spec) if !field.starts_with("sweep.") => Ok(spec),
        _ => Err(unknown("numeric field", field, &numeric_fields(scene))),
    }
}

pub(super) fn unknown(kind: &str, field: &str, known: &[String]) -> String {
    const MAX_SHOWN: usize = 60;
    let more = known.len().saturating_sub(MAX_SHOWN);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let list = known.iter().take(MAX_SHOWN).map(String::as_str).collect::<Vec<_>>().join(", ");
    // hints for the window repeat names of the scene's fields
    let hint = nearest(field, known.iter().map(String::as_str).filter(|name| !name.starts_with("app.")));
    let hint = hint.map_or_else(|| " it".to_owned(), |name| format!(" did you mean `{name}`? It"));
    format!("the scene has no {kind} `{}`;{hint} has: {list}{more}", clip(field))
}

/// The values from the first decimal up to the second in steps of the third; the second is included if a step
/// reaches it.
fn even_steps(parts: [Decimal; 3]) -> Result<Vec<f64>, String> {
    let exponents = parts.iter().filter(|part| part.digits != 0).map(|part| part.exponent);
    let exponent = exponents.min().unwrap_or(0);
    if parts[2].digits == 0 {
        return Err("a step of 0 never arrives; give a step above 0".to_owned());
    }
    if parts[2].digits < 0 {
        let problem =
            "the step is negative; an axis goes upwards: give the smaller end first and a step above 0";
        return Err(problem.to_owned());
    }
    let [Some(from), Some(to), Some(step)] = parts.map(|part| part.in_units(exponent)) else {
        return Err("the ends and the step differ by more than 36 digits".to_owned());
    };
    let span = to.checked_sub(from).ok_or("the ends differ by more than 36 digits")?;
    if span < 0 {
        return Err("the end lies below the beginning; give the smaller end first".to_owned());
    }
    let count = (span / step) as u128 + 1;
    let value = |i: usize| Decimal { digits: from + step * i as i128, exponent }.trimmed().value();
    match usize::try_from(count) {
        Ok(count) if count <= MAX_AXIS_VALUES => Ok((0..count).map(value).collect()),
        _ => Err(too_long(count)),
    }
}

/// The steps between three doubles, given by their shortest decimals. Where a step misses the last value by
/// no more than the rounding of the three, as pi/8 misses 2 pi, it reaches it.
fn rounded_steps(parts: [Decimal; 3]) -> Result<Vec<f64>, String> {
    let values = even_steps(parts)?;
    let [from, to, step] = parts.map(Decimal::value);
    let count = ((to - from) / step).round();
    let missed = (to - from) - count * step;
    let rounding = 4.0 * f64::EPSILON * (from.abs() + to.abs());
    let is_near = missed.abs() <= rounding && rounding < 1e-3 * step;
    if !is_near || count + 1.0 > MAX_AXIS_VALUES as f64 || values.last() == Some(&to) {
        return Ok(values);
    }
    let share = |i: usize| if i == count as usize { to } else { from + (to - from) * i as f64 / count };
    Ok((0..=count as usize).map(share).collect())
}

fn too_long(count: impl std::fmt::Display) -> String {
    format!("{count} values are more than an axis may have ({MAX_AXIS_VALUES}); give a larger step")
}

/// Column names for swept fields: the shortest ending of each path that no other path shares and that
/// contains a name (`travel_limit_mm`; for two amplitudes `0.amplitude_g` and `1.amplitude_g`; for one
/// coefficient `coefficients_si.2`, because `2` alone is not a name).
#[doc(hidden)]
pub fn column_names<S: AsRef<str>>(fields: &[S]) -> Vec<String> {
    let ending = |field: &str, parts: usize| -> String {
        let all: Vec<&str> = field.split('.').collect();
        all[all.len().saturating_sub(parts)..].join(".")
    };
    let named = |text: &str| text.split('.').any(|part| part.parse::<usize>().is_err());
    let column = |field: &S| {
        let field = field.as_ref();
        let part_count = field.split('.').count();
        let unique = |parts: &usize| {
            let short = ending(field, *parts);
            let same = fields.iter().filter(|other| ending(other.as_ref(), *parts) == short).count();
            named(&short) && same == 1
        };
        (1..=part_count).find(unique).map_or_else(|| field.to_owned(), |parts| ending(field, parts))
    };
    fields.iter().map(column).collect()
}

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

    fn grid(from: &str, to: &str, step: &str) -> Result<Vec<f64>, String> {
        even_steps([from, to, step].map(|text| Decimal::parse(text).unwrap()))
    }

    #[test]
    fn the_end_is_included_where_a_step_reaches_it() {
        assert_eq!(grid("0", "1", "0.25").unwrap(), [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(grid("0", "1", "0.3").unwrap(), [0.0, 0.3, 0.6, 0.9]);
        assert_eq!(grid("-0.1", "0.1", "1e-1").unwrap(), [-0.1, 0.0, 0.1]);
        assert_eq!(grid("3", "3", "1").unwrap(), [3.0]);
        assert_eq!(grid("0.5", "8", "0.1875").unwrap().len(), 41);
        assert!(grid("0", "-1", "1").is_err());
        assert!(grid("0", "1", "0").is_err());
        assert!(grid("1", "0", "-1").is_err());
        assert!(grid("1e200", "1e201", "1e-3").is_err());
        assert_eq!(grid("1e200", "3e200", "1e200").unwrap(), [1e200, 2e200, 3e200]);
    }
}
