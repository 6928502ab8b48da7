//! What is this scene, in words? What it models and leaves out, how good its force curve is, where it
//! rests.

use std::sync::Arc;

use super::curve::small_amplitude_frequency;
use crate::dynamics::Model;
use crate::mechanics::{Equilibrium, Landscape, Mechanism};
use crate::numeric::short;
use crate::scene::{Damping, Fault, Scene};

/// The scene in words, a line each; all faults that only show when the model is built.
///
/// Numbers here are rounded to four digits for reading; `curve --landscape` has them all.
pub fn inspect(scene: &Scene, mechanism: &Arc<Mechanism>) -> Result<Vec<String>, Vec<Fault>> {
    let model = Model::build(scene, Arc::clone(mechanism))?;
    let mut lines = model.describe();
    lines.push(force_curve(mechanism));
    lines.extend(damping(scene, &model));
    lines.extend(landscape(&mechanism.landscape, model.mass));
    Ok(lines)
}

fn force_curve(mechanism: &Mechanism) -> String {
    let curve = &mechanism.curve;
    let pieces = match curve.pieces().len() {
        1 => "one polynomial".to_owned(),
        n => format!("{n} polynomials"),
    };
    let (left, right) = curve.domain();
    let reach = if left.is_finite() || right.is_finite() {
        format!(", from {} to {} mm", short(left * 1e3), short(right * 1e3))
    } else {
        String::new()
    };
    match curve.fit() {
        None => format!("force curve: {pieces}{reach}, exact"),
        Some(fit) => format!(
            "force curve: {pieces}{reach} through {} samples; off by at most {} N ({} of {} N) at x = {} mm",
            fit.samples,
            short(fit.worst_n),
            short(fit.worst_n / fit.scale_n),
            short(fit.scale_n),
            short(fit.worst_at_m * 1e3),
        ),
    }
}

/// k and c of a damping ratio.
fn damping(scene: &Scene, model: &Model) -> Option<String> {
    let Damping::Ratio(xi) = scene.damping else { return None };
    let stiffness = model.mechanism.damping_stiffness()?;
    Some(format!(
        "damping ratio {xi}: with k = {} N/m, c = 2 xi sqrt(k m) = {} N s/m",
        short(stiffness),
        short(model.damping)
    ))
}

fn landscape(landscape: &Landscape, mass: f64) -> Vec<String> {
    let mut lines: Vec<String> = landscape.equilibria.iter().map(|e| equilibrium(e, mass)).collect();
    if lines.is_empty() {
        lines.push("no equilibrium".to_owned());
    }
    if let Some(barrier) = landscape.barrier {
        let mj = |joules: f64| short(joules * 1e3);
        let height = if mj(barrier.from_left_j) == mj(barrier.from_right_j) {
            format!("{} mJ above both wells", mj(barrier.from_left_j))
        } else {
            let (left, right) = (mj(barrier.from_left_j), mj(barrier.from_right_j));
            format!("{left} mJ above the left well, {right} mJ above the right one")
        };
        lines.push(format!("barrier at {} mm, {height}", short(barrier.x * 1e3)));
    }
    let list = |items: Vec<String>| items.join(", ");
    if !landscape.extrema.is_empty() {
        let extrema = landscape.extrema.iter();
        let extrema = extrema.map(|e| format!("{} N at {} mm", short(e.force), short(e.x * 1e3))).collect();
        lines.push(format!("force extrema: {}", list(extrema)));
    }
    if !landscape.kinks.is_empty() {
        let sides = |left: f64, right: f64| format!("{} | {} N/m", short(left), short(right));
        let kinks = landscape.kinks.iter();
        let kinks = kinks
            .map(|k| format!("{} mm ({})", short(k.x * 1e3), sides(k.stiffness_left, k.stiffness_right)))
            .collect();
        lines.push(format!("kinks, stiffness left | right: {}", list(kinks)));
    }
    lines
}

fn equilibrium(equilibrium: &Equilibrium, mass: f64) -> String {
    let (left, right) = (short(equilibrium.stiffness_left), short(equilibrium.stiffness_right));
    let stiffness = if left == right { left } else { format!("{left} | {right}") };
    let kind = if equilibrium.stable { "stable" } else { "unstable" };
    let frequency = small_amplitude_frequency(mass, equilibrium);
    let frequency = frequency.map_or(String::new(), |f| format!(", {} Hz when plucked", short(f)));
    format!("{kind} equilibrium at {} mm, stiffness {stiffness} N/m{frequency}", short(equilibrium.x * 1e3))
}
