//! Plan of a sweep: everything that determines the bytes of its rows.

use serde_json::{Map, Value, json};

use crate::numeric::{one_line, push_number};
use crate::scene::{Axis, Document, PROGRAM};
use crate::study::Sweep;
use crate::system::checksum::checksum;

/// Largest number of differences that are listed.
const MAX_LISTED: usize = 4;

/// The plan of `sweep`, whose rows have these `columns` after those of its fields, for this `version` of the
/// program. Two sweeps with equal plans have the same rows, byte for byte. `document` is that of the sweep
/// and must hold its files, whose checksums are part of the plan.
#[doc(hidden)]
pub fn plan(document: &Document, sweep: &Sweep, columns: &[String], version: &str) -> Value {
    let mut scene = document.scene.clone();
    // the scene's own value of a swept field is never run, so it is not part of the plan
    sweep.grid().apply(0, &mut scene);
    let mut scene = serde_json::to_value(&scene).unwrap_or(Value::Null);
    if let Value::Object(scene) = &mut scene {
        ["title", "notes", "sweep", "app"].iter().for_each(|key| drop(scene.remove(*key)));
    }
    let files =
        document.files.cached.iter().map(|(path, text)| (path.clone(), json!(checksum(text.as_bytes()))));
    let grid: Vec<String> = sweep.grid().axes().iter().map(axis).collect();
    let draws = &sweep.options().draws;
    let mut plan = json!({
        "program": PROGRAM,
        "version": version,
        "grid": grid,
        "columns": columns,
        "until_settled": sweep.options().until_settled,
        "carry": sweep.options().carry.map(|carry| carry.name()),
        "scene": scene,
        "files": files.collect::<Map<_, _>>(),
    });
    if !draws.is_empty() {
        plan["uncertain"] = json!(draws.with_defaults());
    }
    plan
}

/// An axis in one line, with the checksum of its values.
fn axis(axis: &Axis) -> String {
    let bits: Vec<u8> = axis.values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let mut text = format!("{}, {} values from ", axis.field, axis.values.len());
    push_number(&mut text, axis.values.first().copied().unwrap_or(f64::NAN));
    text += " to ";
    push_number(&mut text, axis.values.last().copied().unwrap_or(f64::NAN));
    text + &format!(" ({})", &checksum(&bits)[..12])
}

/// The differences of two plans in words, called `there` and `here`; empty if the plans are equal.
#[doc(hidden)]
pub fn plan_differences(there: &Value, here: &Value) -> String {
    let mut found = Vec::new();
    differences("", there, here, &mut found);
    let more = found.len().saturating_sub(MAX_LISTED);
    found.truncate(MAX_LISTED);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    found.join("; ") + &more
}

fn differences(path: &str, there: &Value, here: &Value, found: &mut Vec<String>) {
    let inner = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match (there, here) {
        _ if there == here => {}
        (Value::Object(a), Value::Object(b)) => {
            let keys = a.keys().chain(b.keys().filter(|key| !a.contains_key(*key)));
            for key in keys {
                let of = |map: &Map<String, Value>| map.get(key).cloned().unwrap_or(Value::Null);
                differences(&inner(key), &of(a), &of(b), found);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                differences(&inner(&i.to_string()), a, b, found);
            }
        }
        _ => found.push(format!("{path} is {} there and {} here", short(there), short(here))),
    }
}

/// A value as text, truncated if it is long.
fn short(value: &Value) -> String {
    const MAX_LENGTH: usize = 100;
    let text = match value {
        Value::Null => "none".to_owned(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    match text.char_indices().nth(MAX_LENGTH) {
        Some((end, _)) => one_line(&text[..end]) + "..",
        None => one_line(&text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_named_by_their_place() {
        let a = json!({"version": "1", "scene": {"mass_g": 1, "stops": {"at": 1, "e": 0.3}}, "list": [1, 2]});
        assert_eq!(plan_differences(&a, &a), "");
        let b = json!({"version": "1", "scene": {"mass_g": 1, "stops": {"at": 1, "e": 0.4}}, "list": [1, 3]});
        let expected = "scene.stops.e is 0.3 there and 0.4 here; list.1 is 2 there and 3 here";
        assert_eq!(plan_differences(&a, &b), expected);
        let c = json!({"version": "2", "scene": {"mass_g": 1, "stops": null}, "list": [1], "new": "x"});
        let expected = "version is 1 there and 2 here; scene.stops is {\"at\":1,\"e\":0.3} there and none \
            here; list is [1,2] there and [1] here; new is none there and x here";
        assert_eq!(plan_differences(&a, &c), expected);
    }
}
