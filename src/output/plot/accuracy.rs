//! Picture of accuracy against cost: error over CPU time, both logarithmic, one frame for each problem.

use serde_json::Map;

use super::axis::PlotAxis;
use super::drawn::Drawn;
use super::figure::{Area, Figure, Point, Text, fitted};
use super::frame::Frame;
use super::mark::{Caption, Marker, Sample, legend, marker};
use super::style::{self, Ink, Theme};
use crate::scene::PROGRAM;
use crate::study::Table;
use crate::study::accuracy::{OWN, PROBLEMS};

const LEFT: f64 = 150.0;
const TOP: f64 = 270.0;
const BETWEEN: f64 = 45.0;
/// Height of a frame on a narrow canvas, where the frames are stacked.
const HEIGHT: f64 = 420.0;
/// Room between two stacked frames.
const UNDER: f64 = 150.0;

/// An error of 0 is drawn here; smaller errors cannot be told apart in double precision.
const LEAST: f64 = 1e-17;

/// The picture of a table as [`work_table`](crate::study::accuracy::Report::work_table) gives it.
pub fn accuracy_figure(table: &Table, version: &str, theme: &Theme) -> Figure {
    let (problems, methods) = (table.words("case"), table.words("method"));
    let column = |name: &str| table.numbers(name).unwrap_or_default();
    let (errors, times) = (column("error"), column("cpu_s"));
    let distinct = |all: &[&'static str]| {
        let mut found: Vec<&'static str> = Vec::new();
        all.iter().for_each(|word| {
            if !found.contains(word) {
                found.push(word);
            }
        });
        found
    };
    let (shown, named) = (distinct(problems), distinct(methods));
    let floored = |error: f64| if error == 0.0 { LEAST } else { error };
    let known = times.iter().zip(errors).filter(|(_, error)| error.is_finite()).map(|(time, _)| *time);
    let across = PlotAxis::decades(known, 4, "CPU time, s");
    let up = PlotAxis::decades(errors.iter().map(|error| floored(*error).min(10.0)), 9, "error");
    let title = "What accuracy costs".to_owned();
    let footer = format!("interwell {version} \u{b7} CPU time on one core of the machine that drew this");
    let about = PROBLEMS.iter().filter(|problem| shown.contains(&problem.name)).count();
    let subtitle = match about {
        1 => "ten seconds of motion: error against the same motion in twice the digits".to_owned(),
        n => format!("{n} problems of ten seconds each: error against the same motion in twice the digits"),
    };
    let mut origin = Map::new();
    origin.insert("program".into(), PROGRAM.into());
    origin.insert("version".into(), version.into());
    let caption = &Caption { title, footer, origin };
    let count = shown.len().max(1) as f64;
    let stacked = theme.is_narrow();
    let mut figure =
        Figure::new(theme, caption, if stacked { 160.0 + count * (HEIGHT + UNDER) } else { 420.0 });
    let entries: Vec<(Sample, &str)> = named
        .iter()
        .enumerate()
        .map(|(k, method)| {
            let (shape, ink) = look(k, theme);
            (Sample::Marker(shape, ink), *method)
        })
        .collect();
    let ends = (LEFT, figure.canvas.right - 30.0);
    let top = TOP.max(legend(&mut figure, theme, &entries, ends, 146.0) + 29.0);
    let (left, right) = (Frame::left(&figure, &up, LEFT, HEIGHT), ends.1);
    let width = if stacked { right - left } else { (right - left - BETWEEN * (count - 1.0)) / count };
    for (i, problem) in shown.iter().enumerate() {
        let place = i as f64;
        let area = if stacked {
            let top = top + place * (HEIGHT + UNDER);
            Area::new(left, top, right, top + HEIGHT)
        } else {
            let left = left + place * (width + BETWEEN);
            Area::new(left, top, left + width, figure.bottom())
        };
        let Area { left, top, .. } = area;
        let y = if i == 0 || stacked { up.clone() } else { up.clone().silent() };
        let frame = Frame::new(area, across.clone(), y);
        frame.grid(&mut figure, theme);
        // the method of this program is drawn last, so that it lies on top
        for (k, method) in named.iter().enumerate().rev() {
            let (shape, ink) = look(k, theme);
            let points: Vec<Point> = (0..problems.len())
                .filter(|row| problems[*row] == *problem && methods[*row] == *method)
                .filter(|row| errors[*row].is_finite() && times[*row] > 0.0)
                .map(|row| (times[row].log10(), floored(errors[row]).log10()))
                .collect();
            let line = if *method == OWN { style::LINE } else { style::FINE_LINE };
            frame.line(&mut figure, &points, line, ink);
            for point in points.iter().filter(|point| point.1 <= frame.y.high) {
                marker(&mut figure, shape, frame.place(*point), 0.75 * style::MARKER, ink, theme.ink);
            }
        }
        frame.axes(&mut figure, theme);
        let words = fitted(heading(problem), style::AXIS, true, width);
        figure.text(Text { bold: true, ..Text::new(words, (left, top - 16.0), style::AXIS, theme.ink) });
    }
    let mut drawn = Drawn::new(["cpu_s", "error"], &["problem", "method"]);
    for row in 0..problems.len() {
        drawn.put("run", &[times[row], errors[row]], &[problems[row], methods[row]]);
    }
    figure.data = drawn.table();
    caption.draw(&mut figure, theme, &subtitle, LEFT);
    figure
}

/// The heading over the frame of a problem.
fn heading(problem: &str) -> &str {
    PROBLEMS.iter().find(|known| known.name == problem).map_or(problem, |known| known.heading)
}

/// Marker and colour of the method at this place in the legend; the method of this program is first.
fn look(place: usize, theme: &Theme) -> (Marker, Ink) {
    let all = [
        (Marker::Disc, theme.regimes[3]),
        (Marker::Square, theme.regimes[1]),
        (Marker::Triangle, theme.shaking),
        (Marker::Diamond, theme.regimes[2]),
        (Marker::DoubleArrow, theme.second),
    ];
    all[place % all.len()]
}
