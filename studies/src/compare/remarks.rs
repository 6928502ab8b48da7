//! What the rows of a comparison lack, in sentences.

use super::Rated;
use crate::dynamics::Regime;
use crate::numeric::short;
use crate::questions::Simulation;
use crate::scene::{Document, RunSettings, Stops, Transducer};
use crate::study::Table;

/// The remarks on a comparison: which scenes have another excitation or run than in their files, and why the
/// `rated` ones lack a number. Each begins with the names of the scenes to which it applies.
pub(super) fn of_comparison(
    given: &[(&str, &Simulation)],
    environment: &Document,
    scenes: &[(String, Simulation)],
    rated: &[Rated],
    (amplitude_g, table): (f64, &Table),
) -> Vec<String> {
    let replaced =
        given.iter().filter_map(|(name, scene)| Some(((*name).to_owned(), replaced(scene, environment)?)));
    let lacking = scenes.iter().zip(rated).enumerate().flat_map(|(row, ((name, scene), rated))| {
        let empty = table.columns().iter().filter(move |column| column.values.is_missing(row));
        let remarks = of_scene(scene, rated, amplitude_g, empty.map(|column| &*column.name));
        remarks.into_iter().map(|words| (name.clone(), words))
    });
    let groups = grouped(replaced).into_iter().chain(grouped(lacking));
    groups.map(|(names, words)| format!("{names}: {words}")).collect()
}

/// Which of excitation and run of a scene those of the environment replace.
fn replaced(simulation: &Simulation, environment: &Document) -> Option<String> {
    let (scene, lent) = (simulation.scene(), &environment.scene);
    let how = match (scene.excitation != lent.excitation, window(&scene.run) != window(&lent.run)) {
        (true, true) => "excitation and run",
        (true, false) => "excitation",
        (false, true) => "run",
        (false, false) => return None,
    };
    Some(format!("rated with the {how} of {}, not with its own", environment.name))
}

/// Duration of a run, beginning of its settled window, and tolerance.
fn window(run: &RunSettings) -> [f64; 3] {
    [run.duration_s, run.settle_s.unwrap_or(0.5 * run.duration_s), run.tolerance]
}

/// Each distinct remark after the names of all to which it applies.
fn grouped(remarks: impl IntoIterator<Item = (String, String)>) -> Vec<(String, String)> {
    let mut groups: Vec<(String, String)> = Vec::new();
    for (name, words) in remarks {
        match groups.iter_mut().find(|group| group.1 == words) {
            Some((names, _)) => *names += &format!(", {name}"),
            None => groups.push((name, words)),
        }
    }
    groups
}

/// Explains the empty and infinite cells of a row, an early end, rest, and an undecided threshold.
fn of_scene<'a>(
    simulation: &Simulation,
    rated: &Rated,
    amplitude_g: f64,
    empty: impl Iterator<Item = &'a str>,
) -> Vec<String> {
    let (summary, given) = (&rated.summary, short(amplitude_g));
    let mut all = Vec::new();
    if let Some(at) = summary.outcome.ended_at() {
        let (at, outcome) = (short(at), summary.outcome.name());
        all.push(format!(
            "its run ended early at {at} s ({outcome}): nothing is known of its settled motion"
        ));
    } else if summary.regime == Regime::Rest {
        all.push(format!("{given} g does not move it"));
    }
    if let Some(crossing) = rated.crossing.filter(|crossing| crossing.undecided) {
        let low = crossing.low.map_or_else(String::new, |low| format!(" above {} g", short(low)));
        let high = crossing.high.map_or_else(String::new, |high| format!(" below {} g", short(high)));
        all.push(format!(
            "its threshold is undecided: of some amplitudes{low}{high} it is not known whether they cross: \
             the motion does not repeat in the time for which it is followed, the run ended early, or there \
             is no valid scene"
        ));
    }
    if let Some((_, size)) = rated.sensitivity.as_ref().filter(|(change, _)| change.is_infinite()) {
        all.push(format!("with {size} changed by 1 % nothing is left to cross, or nothing crosses"));
    }
    let empty = empty.map(|column| (column.to_owned(), why_empty(column, simulation, rated, &given)));
    all.extend(grouped(empty).iter().map(|(names, why)| format!("no {names}: {why}")));
    all
}

fn why_empty(column: &str, simulation: &Simulation, rated: &Rated, given: &str) -> String {
    let (summary, crossing) = (&rated.summary, rated.crossing_g());
    let transducer = simulation.scene().transducer != Transducer::None;
    match column {
        "release_g" => "it rests on no stop",
        "mean_load_power_w" if !transducer => "it has no transducer",
        "impact_speed_max_m_per_s" if simulation.scene().stops == Stops::None => "it has no stops",
        "impact_speed_max_m_per_s" if summary.outcome.ended_at().is_none() => "it strikes no stop",
        "rms_velocity_m_per_s" | "mean_load_power_w" | "max_abs_x_m" | "impact_speed_max_m_per_s" => {
            "its run ended early"
        }
        _ if simulation.mechanism().landscape.barrier.is_none() => {
            "no barrier between two wells, so nothing to cross"
        }
        _ if rated.crossing.is_none() => "no barrier stands between its stops, so nothing to cross",
        "crosses_from_hz" | "crosses_to_hz" => {
            return format!("no frequency that was tried makes its settled motion cross at {given} g");
        }
        _ if crossing.is_none() => "no amplitude that was tried makes its settled motion cross",
        "crossing_low_g" => "no smaller amplitude that was tried is known not to cross",
        "crossing_high_g" => "no amplitude that was tried is known to cross for good",
        "crossing_step_g" | "crossing_resolution_g" => "it crosses at the least amplitude that was tried",
        _ => "its mechanism has no length, thickness or gap to change",
    }
    .to_owned()
}
