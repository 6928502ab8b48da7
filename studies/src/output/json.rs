//! JSON of a summary, a landscape and an identification: numbers in SI with the unit in the key, `null` for
//! missing values.

use serde_json::{Value, json};

use super::manifest::{Provenance, scene_value, seed};
use crate::dynamics::{Outcome, Summary};
use crate::mechanics::{Landscape, Mechanism};
use crate::numeric::is_obeyed;
use crate::scene::{Scene, Timing};
use crate::study::{Identified, InJson, Read, SUMMARY_FIELDS, SummaryField, small_amplitude_frequency};

/// The summary of a run of `scene`, as text. Compliant stops add the keys of peak force and pressure. A run
/// that ended early adds `ended_at_s` and, if a budget ran out, `ended_after`, the number of impacts or
/// steps.
pub fn summary(summary: &Summary, scene: &Scene, origin: &Provenance) -> String {
    let entries = SUMMARY_FIELDS.iter().filter_map(|field| entry(field, summary)).collect();
    let mut object = without_negative_zeros(Value::Object(entries));
    if let Outcome::ImpactBudget { count, .. } | Outcome::StepBudget { count, .. } = summary.outcome {
        object["ended_after"] = json!(count);
    }
    let more = json!({
        "cpu_s": summary.cpu_s,
        "ledger": summary.ledger.map(|balance| ledger(summary, balance.residual_j)),
        "scene": scene_value(scene),
        "version": origin.version,
        "arguments": origin.arguments,
        "seed": seed(scene),
        "wall_s": origin.wall_s,
    });
    extend(&mut object, more);
    pretty(&object)
}

/// A field with its value; `None` if the summary has no such field.
fn entry(field: &SummaryField, summary: &Summary) -> Option<(String, Value)> {
    let InJson::Summary(is_present) = field.in_json else { return None };
    let value = match field.read {
        Read::Number(of) => json!(of(summary)),
        Read::Count(of) => json!(of(summary)),
        Read::Word(_) => json!(field.word(summary)),
        Read::Flag(of) => json!(of(summary)),
    };
    is_present(summary).then(|| (field.name.to_owned(), value))
}

fn ledger(summary: &Summary, residual_j: f64) -> Value {
    let terms = SUMMARY_FIELDS.iter().filter_map(|field| match (field.in_json, field.read) {
        (InJson::Ledger, Read::Number(of)) => Some((field.name.to_owned(), json!(of(summary)?))),
        _ => None,
    });
    without_negative_zeros(terms.chain([("residual_j".to_owned(), json!(residual_j))]).collect())
}

/// The landscape of a mechanism that carries `mass` in kg, as text.
pub fn landscape(mechanism: &Mechanism, mass: f64) -> String {
    let Landscape { equilibria, barrier, extrema, kinks, .. } = &mechanism.landscape;
    let equilibria = equilibria.iter().map(|equilibrium| {
        json!({
            "x_m": equilibrium.x,
            "stable": equilibrium.stable,
            "stiffness_left_n_per_m": equilibrium.stiffness_left,
            "stiffness_right_n_per_m": equilibrium.stiffness_right,
            "frequency_hz": small_amplitude_frequency(mass, equilibrium),
        })
    });
    let barrier = barrier.map(|barrier| {
        json!({
            "x_m": barrier.x,
            "height_j": barrier.from_left_j.min(barrier.from_right_j),
            "height_from_left_j": barrier.from_left_j,
            "height_from_right_j": barrier.from_right_j,
            "left_well_m": barrier.left_well,
            "right_well_m": barrier.right_well,
        })
    });
    let extrema = extrema.iter().map(|extremum| json!({ "x_m": extremum.x, "force_n": extremum.force }));
    let kinks = kinks.iter().map(|kink| {
        json!({
            "x_m": kink.x,
            "stiffness_left_n_per_m": kink.stiffness_left,
            "stiffness_right_n_per_m": kink.stiffness_right,
        })
    });
    let landscape = json!({
        "equilibria": equilibria.collect::<Value>(),
        "barrier": barrier,
        "force_extrema": extrema.collect::<Value>(),
        "kinks": kinks.collect::<Value>(),
        "domain_m": mechanism.curve.domain(),
    });
    pretty(&without_negative_zeros(landscape))
}

/// The result of an identification, as text: its numbers by name, each an object of value and 95 % interval.
/// `of` is the identified quantity, `timing` the sampling of the record.
pub fn identified(of: &str, found: &Identified, timing: Option<&Timing>, origin: &Provenance) -> String {
    let mut object = json!({ "of": of });
    for number in &found.summary {
        let (low, high) = number.interval;
        object[number.name] = json!({ "value": number.value, "low": low, "high": high });
    }
    if let Some(Timing { samples, step, jitter, gaps, .. }) = timing {
        let sampling = json!({ "samples": samples, "step_s": step, "jitter_s": jitter, "gaps": gaps.len() });
        extend(&mut object, sampling);
    }
    let Provenance { version, arguments, .. } = origin;
    let more = json!({ "remarks": found.remarks, "version": version, "arguments": arguments });
    extend(&mut object, more);
    pretty(&without_negative_zeros(object))
}

/// Adds the entries of another object.
pub(super) fn extend(all: &mut Value, more: Value) {
    if let (Value::Object(all), Value::Object(more)) = (all, more) {
        all.extend(more);
    }
}

/// Replaces each -0 by 0.
fn without_negative_zeros(value: Value) -> Value {
    match value {
        Value::Number(number) if number.as_f64() == Some(-0.0) && number.is_f64() => json!(0.0),
        Value::Array(values) => values.into_iter().map(without_negative_zeros).collect(),
        Value::Object(map) => {
            map.into_iter().map(|(key, value)| (key, without_negative_zeros(value))).collect()
        }
        other => other,
    }
}

/// Formats JSON. serde_json writes numbers in their shortest form, and stores those that are not finite as
/// `null`. Each character that a terminal would obey is an escape.
pub(super) fn pretty(value: &Value) -> String {
    let mut text = String::new();
    for c in format!("{value:#}\n").chars() {
        match is_obeyed(c) && c != '\n' {
            // such characters stand in strings alone, and each has four digits
            true => text += &format!("\\u{:04x}", u32::from(c)),
            false => text.push(c),
        }
    }
    text
}
