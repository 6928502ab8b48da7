//! Pictures of accuracy against cost: error over processor time, both logarithmic, of the problems, a panel
//! each, and of one scene, beside its run in fixed steps.

use serde_json::json;

use super::methods::Scheme;
use super::scene::{StepSize, Tolerances, duration, step_name};
use super::{OWN, PROBLEMS};
use crate::numeric::elementary;
use crate::output::{
    Caption, Chart, DISPLACEMENT, Drawn, Marks, Panel, PanelColumn, PlotAxis, Point, Role, TIME,
};
use crate::scene::PROGRAM;
use crate::study::Table;

/// The axis of the time that the processor took.
const PROCESSOR_TIME: &str = "processor time (s)";

/// An error of 0 is drawn here; smaller errors cannot be told apart in double precision.
const LEAST: f64 = 1e-17;

/// The picture of a table as [`work_table`](super::Report::work_table) gives it, and its
/// caption.
#[doc(hidden)]
pub fn accuracy_chart(table: &Table, version: &str) -> (Chart, Caption) {
    let (problems, methods) = (table.words("case"), table.words("method"));
    let column = |name: &str| table.numbers(name).unwrap_or_default();
    let (errors, times) = (column("error"), column("cpu_s"));
    let distinct = |all: &[&'static str]| -> Vec<&'static str> {
        let firsts = all.iter().enumerate().filter(|(i, word)| !all[..*i].contains(word));
        firsts.map(|(_, word)| *word).collect()
    };
    let (shown, named) = (distinct(problems), distinct(methods));
    let floored = |error: f64| if error == 0.0 { LEAST } else { error };
    let known = times.iter().zip(errors).filter(|(_, error)| error.is_finite()).map(|(time, _)| *time);
    let across = PlotAxis::decades(known, PROCESSOR_TIME);
    let up = PlotAxis::decades(errors.iter().map(|error| floored(*error).min(10.0)), "error");
    let panel_of = |problem: &&'static str| {
        let mut panel = Panel::new(across.clone(), up.clone());
        let known = PROBLEMS.iter().find(|known| known.name == *problem);
        panel.heading = known.map_or(*problem, |known| known.heading).to_owned();
        // the method of this program is drawn last, so that it lies on top
        for method in named.iter().rev() {
            let points: Vec<Point> = (0..problems.len())
                .filter(|row| problems[*row] == *problem && methods[*row] == *method)
                .filter(|row| errors[*row].is_finite() && times[*row] > 0.0)
                .map(|row| (elementary::log10(times[row]), elementary::log10(floored(errors[row]))))
                .collect();
            let role = role_of(method);
            panel.draw(role, Marks::Path(points.clone()));
            panel.layer(role, *method, Marks::Points(points));
        }
        PanelColumn { width: 1.0, panels: vec![panel] }
    };
    let columns = shown.iter().map(panel_of).collect();
    let mut drawn = Drawn::new(["cpu_s", "error"], &["problem", "method"]);
    for row in 0..problems.len() {
        drawn.put("run", &[times[row], errors[row]], &[problems[row], methods[row]]);
    }
    let subtitle = match PROBLEMS.iter().filter(|problem| shown.contains(&problem.name)).count() {
        1 => "ten seconds of motion: error against the same motion in twice the digits".to_owned(),
        n => format!("{n} problems of ten seconds each: error against the same motion in twice the digits"),
    };
    let footer =
        format!("interwell {version} \u{b7} processor time on one core of the machine that drew this");
    let origin = json!({ "program": PROGRAM, "version": version });
    let caption = Caption::of("What accuracy costs", footer, &origin);
    (Chart { columns, subtitle, data: drawn.table() }, caption)
}

/// Largest number of steps of a run in fixed steps that are drawn as dots.
const MAX_DOTS: usize = 150;

/// Room above and below the true motion, as a share of its range.
const ROOM: f64 = 0.12;

/// Share of the travel at which an error of 0 is drawn: the digits of a double.
const LEAST_SHARE: f64 = 1e-16;

/// The picture of an [`AccuracyAnswer`](crate::questions::AccuracyAnswer), whose fields `tolerances` and
/// `stepped` are `known` and `stepped`, of a scene of this `tolerance`, with stops in m, NaN where there is
/// none: its error over processor time at several tolerances, and beside it each run in fixed steps over the
/// true one.
pub fn scene_accuracy_chart(
    known: &Tolerances,
    tolerance: f64,
    stepped: &[StepSize],
    stops: (f64, f64),
) -> Chart {
    let mut columns = vec![PanelColumn { width: 1.0, panels: vec![cost_panel(known, tolerance, stepped)] }];
    let panels: Vec<Panel> = stepped.iter().map(|run| steps_panel(run, stepped.len(), stops)).collect();
    if !panels.is_empty() {
        columns.push(PanelColumn { width: 1.3, panels });
    }
    let mut drawn = Drawn::new(["t_s", "x_m", "cpu_s", "error_m", "tolerance", "step_s"], &["method"]);
    for run in &known.runs {
        let row = [f64::NAN, f64::NAN, run.statistics.cpu_s, run.error, run.tolerance];
        drawn.put("tolerance", &row, &[]);
    }
    for run in stepped {
        let word = [run.scheme.name()];
        let row = [f64::NAN, f64::NAN, run.stepped.cpu_s, run.error, f64::NAN, run.step];
        drawn.put("fixed_step", &row, &word);
        run.truth.iter().for_each(|(t, x)| drawn.put("true", &[*t, *x], &[]));
        let row = |(t, x): &Point| [*t, *x, f64::NAN, f64::NAN, f64::NAN, run.step];
        run.ghost.iter().for_each(|point| drawn.put("stepped", &row(point), &word));
    }
    let about = format!("error of the displacement over {} of motion", duration(known.span));
    Chart { columns, subtitle: about, data: drawn.table() }
}

/// Error over processor time, of each run by its tolerance, and of those in fixed steps that reached their
/// end.
#[doc(hidden)]
pub fn cost_panel(known: &Tolerances, tolerance: f64, stepped: &[StepSize]) -> Panel {
    let least = LEAST_SHARE * known.travel.max(f64::MIN_POSITIVE);
    let point = |time: f64, error: f64| (time.max(1e-9), 1e3 * error.max(least));
    let logs = |(x, y): Point| (elementary::log10(x), elementary::log10(y));
    let runs: Vec<Point> = known.runs.iter().map(|run| point(run.statistics.cpu_s, run.error)).collect();
    let whole = stepped.iter().enumerate().filter(|(_, run)| run.stepped.ended_at.is_none());
    let ghosts: Vec<(usize, Point)> =
        whole.map(|(i, run)| (i, point(run.stepped.cpu_s, run.error))).collect();
    let all = || runs.iter().chain(ghosts.iter().map(|ghost| &ghost.1));
    let across = PlotAxis::decades(all().map(|point| point.0), PROCESSOR_TIME);
    let mut panel = Panel::new(across, PlotAxis::decades(all().map(|point| point.1), "error (mm)"));
    let places: Vec<Point> = runs.into_iter().map(logs).collect();
    let names = known.runs.iter().map(|run| format!("{:e}", run.tolerance));
    let mut words: Vec<(Point, String)> = places.iter().copied().zip(names).collect();
    panel.draw(Role::Motion, Marks::Path(places.clone()));
    panel.draw(Role::Interval, Marks::Points(places.clone()));
    let of_scene = known.runs.iter().zip(places).filter(|run| run.0.tolerance == tolerance);
    let of_scene = of_scene.map(|run| run.1).collect();
    panel.layer_if_any(Role::Unstable, "the tolerance of the scene", Marks::Points(of_scene));
    for (i, at) in ghosts {
        let run = &stepped[i];
        panel.layer(role_of(run.scheme.name()), in_steps(run, stepped.len()), Marks::Points(vec![logs(at)]));
        // one of several steps is named at its marker
        words.extend((stepped.len() > 1).then(|| (logs(at), step_name(run.step))));
    }
    panel.draw(Role::Motion, Marks::Words(words));
    panel
}

/// A run in fixed steps in words, one of so many.
fn in_steps(run: &StepSize, count: usize) -> String {
    match count {
        1 => format!("{} in steps of {}", run.scheme.name(), step_name(run.step)),
        _ => format!("{} in fixed steps", run.scheme.name()),
    }
}

/// The role of a method by its name.
fn role_of(method: &str) -> Role {
    match Scheme::ALL.into_iter().find(|scheme| scheme.name() == method) {
        Some(Scheme::SemiImplicitEuler) => Role::Euler,
        Some(Scheme::VelocityVerlet) => Role::Verlet,
        Some(Scheme::RungeKutta4) => Role::RungeKutta,
        None if method == OWN => Role::Taylor,
        None => Role::DormandPrince,
    }
}

/// A run in fixed steps, one of so many, over the true one, with stops in m.
#[doc(hidden)]
pub fn steps_panel(run: &StepSize, count: usize, stops: (f64, f64)) -> Panel {
    let path = |points: &[Point]| points.iter().map(|(t, x)| (*t, x * 1e3)).collect::<Vec<_>>();
    let (truth, stepped) = (path(&run.truth), path(&run.ghost));
    // a run that diverges leaves the picture
    let up = PlotAxis::around(truth.iter().map(|point| point.1), ROOM, DISPLACEMENT);
    let mut panel = Panel::new(PlotAxis::between(0.0, run.drawn, TIME), up);
    panel.level_stops((stops.0 * 1e3, stops.1 * 1e3));
    panel.layer(Role::Motion, "true", Marks::Trace(truth));
    if count > 1 {
        panel.heading = format!("steps of {}", step_name(run.step));
    }
    let role = role_of(run.scheme.name());
    panel.layer(role, in_steps(run, count), Marks::Trace(stepped.clone()));
    if stepped.len() <= MAX_DOTS {
        panel.draw(role, Marks::Points(stepped));
    }
    panel
}
