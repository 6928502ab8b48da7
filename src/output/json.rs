//! How are a summary and a landscape written as JSON? One flat object each, numbers in SI with the
//! unit in the key, `null` for what is missing.

use serde_json::{Value, json};

use super::manifest::{Origin, seed};
use crate::dynamics::{Ledger, Outcome, Summary};
use crate::mechanics::{Landscape, Mechanism};
use crate::scene::Scene;
use crate::study::small_amplitude_frequency;

/// The summary of a run of `scene`, as text. Compliant stops add two keys, their peak force and pressure. A run that ended early has two keys more, `ended_at_s`
/// and, where a budget ran out, `ended_after`, the impacts or steps made.
pub fn summary(summary: &Summary, scene: &Scene, origin: &Origin) -> String {
    // Before the settled window began there is nothing to count in it.
    let settled = summary.rms_velocity.is_some();
    let count = |n: u64| settled.then_some(n);
    let mut object = json!({
        "final_x_m": summary.final_x,
        "final_v_m_per_s": summary.final_v,
        "rms_velocity_m_per_s": summary.rms_velocity,
        "regime": settled.then(|| summary.regime.name()),
        "crossings": count(summary.crossings),
        "impacts": count(summary.impacts),
        "releases": count(summary.releases),
        "max_abs_x_m": summary.max_abs_x,
        "travel_m": summary.travel,
        "impact_share": summary.impact_share,
        "rested_share": summary.rested_share,
        "total_crossings": summary.total_crossings,
        "total_impacts": summary.total_impacts,
        "chatter_sums": summary.chatter_sums,
        "rests": summary.rests,
        "period": summary.period,
        "outcome": summary.outcome.name(),
    });
    let mut add = |key: &str, value: Value| {
        if let Value::Object(map) = &mut object {
            map.insert(key.to_owned(), value);
        }
    };
    if let Some(at) = summary.outcome.ended_at() {
        add("ended_at_s", json!(at));
    }
    if let Outcome::ImpactBudget { count, .. } | Outcome::StepBudget { count, .. } = summary.outcome {
        add("ended_after", json!(count));
    }
    if let Some(force) = summary.peak_contact_force {
        add("peak_contact_force_n", json!(force));
        add("peak_contact_pressure_pa", json!(summary.peak_contact_pressure));
    }
    add("steps", json!(summary.steps));
    add("evaluations", json!(summary.evaluations));
    add("cpu_s", json!(summary.cpu_s));
    add("ledger", summary.ledger.as_ref().map_or(Value::Null, ledger));
    add("energy_residual", json!(summary.ledger.map(|ledger| ledger.energy_residual)));
    add("scene", serde_json::to_value(scene).unwrap_or(Value::Null));
    add("version", json!(origin.version));
    add("arguments", json!(origin.arguments));
    add("seed", seed(scene));
    add("wall_s", json!(origin.wall_s));
    pretty(&object)
}

fn ledger(ledger: &Ledger) -> Value {
    json!({
        "work_j": ledger.work_j,
        "damping_j": ledger.damping_j,
        "impact_j": ledger.impact_j,
        "stored_j": ledger.stored_j,
        "residual_j": ledger.residual_j,
    })
}

/// The landscape of a mechanism that carries `mass` in kg, as text.
pub fn landscape(mechanism: &Mechanism, mass: f64) -> String {
    let Landscape { equilibria, barrier, extrema, kinks } = &mechanism.landscape;
    let equilibria: Vec<Value> = equilibria
        .iter()
        .map(|equilibrium| {
            json!({
                "x_m": equilibrium.x,
                "stable": equilibrium.stable,
                "stiffness_left_n_per_m": equilibrium.stiffness_left,
                "stiffness_right_n_per_m": equilibrium.stiffness_right,
                "frequency_hz": small_amplitude_frequency(mass, equilibrium),
            })
        })
        .collect();
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
    let extrema: Vec<Value> =
        extrema.iter().map(|extremum| json!({ "x_m": extremum.x, "force_n": extremum.force })).collect();
    let kinks: Vec<Value> = kinks
        .iter()
        .map(|kink| {
            json!({
                "x_m": kink.x,
                "stiffness_left_n_per_m": kink.stiffness_left,
                "stiffness_right_n_per_m": kink.stiffness_right,
            })
        })
        .collect();
    let (left, right) = mechanism.curve.domain();
    pretty(&json!({
        "equilibria": equilibria,
        "barrier": barrier,
        "force_extrema": extrema,
        "kinks": kinks,
        "domain_m": [left, right],
    }))
}

/// Numbers are in serde_json's shortest form; one that is not finite became `null` on its way in.
pub(super) fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}
