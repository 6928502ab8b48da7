//! Picture of accuracy against cost: error over CPU time, both logarithmic, one panel for each problem.

use serde_json::json;

use super::axis::PlotAxis;
use super::chart::{Chart, Column, Marks, Panel};
use super::drawn::Drawn;
use super::figure::Point;
use super::mark::Caption;
use super::role::Role;
use crate::numeric::elementary;
use crate::scene::PROGRAM;
use crate::study::Table;
use crate::study::accuracy::PROBLEMS;

/// An error of 0 is drawn here; smaller errors cannot be told apart in double precision.
const LEAST: f64 = 1e-17;

/// The picture of a table as [`work_table`](crate::study::accuracy::Report::work_table) gives it, and its
/// caption.
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
    let across = PlotAxis::decades(known, "CPU time (s)");
    let up = PlotAxis::decades(errors.iter().map(|error| floored(*error).min(10.0)), "error");
    let panel_of = |problem: &&'static str| {
        let mut panel = Panel::new(across.clone(), up.clone());
        let known = PROBLEMS.iter().find(|known| known.name == *problem);
        panel.heading = known.map_or(*problem, |known| known.heading).to_owned();
        // the method of this program is drawn last, so that it lies on top
        for (place, method) in named.iter().enumerate().rev() {
            let points: Vec<Point> = (0..problems.len())
                .filter(|row| problems[*row] == *problem && methods[*row] == *method)
                .filter(|row| errors[*row].is_finite() && times[*row] > 0.0)
                .map(|row| (elementary::log10(times[row]), elementary::log10(floored(errors[row]))))
                .collect();
            panel.draw(Role::Method(place), Marks::Path(points.clone()));
            panel.layer(Role::Method(place), *method, Marks::Points(points));
        }
        Column { width: 1.0, panels: vec![panel] }
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
    let footer = format!("interwell {version} \u{b7} CPU time on one core of the machine that drew this");
    let origin = json!({ "program": PROGRAM, "version": version });
    let caption = Caption::of("What accuracy costs", footer, &origin);
    (Chart { columns, subtitle, data: drawn.table() }, caption)
}
