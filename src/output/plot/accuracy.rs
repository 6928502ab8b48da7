//! Picture of work against precision: error over CPU time, both logarithmic, a frame for each problem.

use super::axis::PlotAxis;
use super::figure::{Area, Figure, Point, Text};
use super::frame::Frame;
use super::mark::{Caption, Marker, Sample, legend, marker};
use super::style::{self, Ink, Theme};
use super::swept::words;
use crate::study::Table;
use crate::study::accuracy::{OWN, PROBLEMS};

const LEFT: f64 = 150.0;
const RIGHT: f64 = 1570.0;
const TOP: f64 = 270.0;
const BOTTOM: f64 = 868.0;
const BETWEEN: f64 = 45.0;

/// Errors below this are all that a double can tell.
const LEAST: f64 = 1e-17;

/// The picture of a table as [`work_table`](crate::study::accuracy::Report::work_table) gives it.
pub fn accuracy_figure(table: &Table, version: &str, theme: &Theme) -> Figure {
    let mut figure = Figure::new(theme.paper);
    let (problems, methods) = (words(table, "problem"), words(table, "method"));
    let column = |name: &str| table.numbers(name).unwrap_or_default();
    let (errors, times) = (column("error"), column("cpu_s"));
    let distinct = |all: &[&'static str]| {
        let mut own: Vec<&'static str> = Vec::new();
        all.iter().for_each(|word| {
            if !own.contains(word) {
                own.push(word);
            }
        });
        own
    };
    let (shown, named) = (distinct(problems), distinct(methods));
    let floored = |error: f64| if error == 0.0 { LEAST } else { error };
    let told = times.iter().zip(errors).filter(|(_, error)| error.is_finite()).map(|(time, _)| *time);
    let across = PlotAxis::decades(told, 4, "CPU time, s");
    let up = PlotAxis::decades(errors.iter().map(|error| floored(*error).min(10.0)), 9, "error");
    let width = (RIGHT - LEFT - BETWEEN * (shown.len().max(1) - 1) as f64) / shown.len().max(1) as f64;
    for (i, problem) in shown.iter().enumerate() {
        let left = LEFT + i as f64 * (width + BETWEEN);
        let y = if i == 0 { up.clone() } else { up.clone().silent() };
        let frame = Frame::new(Area::new(left, TOP, left + width, BOTTOM), across.clone(), y);
        frame.grid(&mut figure, theme);
        // the own method last, so that it lies on top
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
        figure.text(Text {
            words: super::figure::fitted(heading(problem), style::AXIS, true, width),
            at: (left, TOP - 16.0),
            size: style::AXIS,
            ink: theme.ink,
            bold: true,
            align: super::figure::Align::Left,
            upright: false,
        });
    }
    let entries: Vec<(Sample, &str)> = named
        .iter()
        .enumerate()
        .map(|(k, method)| {
            let (shape, ink) = look(k, theme);
            (Sample::Marker(shape, ink), *method)
        })
        .collect();
    legend(&mut figure, theme, &entries, LEFT, RIGHT, 146.0);
    let title = "What accuracy costs".to_owned();
    let footer = format!("interwell {version} \u{b7} CPU time on one core of the machine that drew this");
    let about = PROBLEMS.iter().filter(|own| shown.contains(&own.name)).count();
    let subtitle = match about {
        1 => "ten seconds of motion: error against the same motion in twice the digits".to_owned(),
        n => format!("{n} problems of ten seconds each: error against the same motion in twice the digits"),
    };
    Caption { title, footer }.draw(&mut figure, theme, &subtitle, LEFT);
    figure
}

/// The words over the frame of a problem.
fn heading(problem: &str) -> &str {
    PROBLEMS.iter().find(|own| own.name == problem).map_or(problem, |own| own.heading)
}

/// Marker and colour of the method that stands at this place: the own one first.
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
