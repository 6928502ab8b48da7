//! The picture of a sweep: over one field a line, drawn here; over two a [`map`](super::map).

use super::axis::Axis;
use super::figure::{Area, Figure};
use super::frame::Frame;
use super::map::{Overlay, map};
use super::mark::{Caption, REGIMES, Sample, legend, marker, regime};
use super::run::speed_unit;
use super::style::{self, Theme};
use crate::numeric::short;
use crate::scene::{Excitation, Scene, Start};
use crate::study::{Column, Grid, Table, Values};

/// The most cells that a picture shows: more than it has pixels to tell apart.
pub const MAX_PICTURE_CELLS: u64 = 500_000;

/// Why a sweep has no picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoPicture {
    /// Neither a line nor a map.
    #[error(
        "--plot shows a sweep over one field (a line) or two (a map), not over {0}: \
         take the others out, or sweep without --plot"
    )]
    Fields(usize),
    /// Finer than a picture.
    #[error(
        "--plot shows at most {MAX_PICTURE_CELLS} cells, not {0}: take longer steps, or sweep without --plot"
    )]
    Cells(u64),
}

pub(super) const LEFT: f64 = 160.0;
pub(super) const TOP: f64 = 185.0;
pub(super) const BOTTOM: f64 = 868.0;

/// Whether a sweep of this grid can be shown.
pub fn can_show(grid: &Grid) -> Result<(), NoPicture> {
    match grid.axes().len() {
        1 | 2 if grid.cells() > MAX_PICTURE_CELLS => Err(NoPicture::Cells(grid.cells())),
        1 | 2 => Ok(()),
        n => Err(NoPicture::Fields(n)),
    }
}

/// The picture of all rows of a sweep over `grid`.
pub fn sweep_figure(
    rows: &Table,
    grid: &Grid,
    overlay: &Overlay,
    scene: &Scene,
    caption: &Caption,
    theme: &Theme,
) -> Result<Figure, NoPicture> {
    can_show(grid)?;
    let mut figure = Figure::new(theme.paper);
    match grid.columns() {
        [x] => line(&mut figure, rows, x, theme),
        [x, y] => map(&mut figure, rows, (x, y), overlay, theme),
        other => return Err(NoPicture::Fields(other.len())),
    }
    caption.draw(&mut figure, theme, &sweep_about(grid, scene), LEFT);
    Ok(figure)
}

/// What was run, in one line.
pub fn sweep_about(grid: &Grid, scene: &Scene) -> String {
    let counts: Vec<String> = grid.axes().iter().map(|axis| axis.values.len().to_string()).collect();
    let swept = |field: &str| grid.axes().iter().any(|axis| axis.field == field);
    let mut parts = vec![format!("{} runs", counts.join(" \u{d7} "))];
    if !swept("run.duration_s") {
        parts[0] += &format!(" of {} s", short(scene.run.duration_s));
    }
    if scene.start == Start::Rest {
        parts.push("each from rest".to_owned());
    }
    if let Excitation::Sine { frequency_hz, .. } = scene.excitation
        && !swept("excitation.frequency_hz")
    {
        parts.push(format!("shaken at {} Hz", short(frequency_hz)));
    }
    parts.join(", ")
}

pub(super) fn words<'a>(rows: &'a Table, name: &str) -> &'a [&'static str] {
    match rows.column(name).map(|column| &column.values) {
        Some(Values::Words(words)) => words,
        _ => &[],
    }
}

pub(super) fn label(rows: &Table, name: &str) -> String {
    rows.column(name).map_or_else(|| name.to_owned(), Column::label)
}

/// What a legend says of cells without a speed, by the outcomes of all cells.
pub(super) fn missing_words(outcomes: &[&'static str]) -> &'static str {
    let is = |word: &&&str| **word == "not_converged";
    let unsolved = outcomes.iter().filter(is).count();
    let early = outcomes.iter().filter(|word| !is(word) && **word != "done").count();
    match (unsolved, early) {
        (0, _) => "ended early",
        (_, 0) => "flexures not solved",
        _ => "ended early or not solved",
    }
}

pub(super) const RMS: &str = "rms_velocity_m_per_s";

/// RMS velocity over one field, each value marked with its regime.
fn line(figure: &mut Figure, rows: &Table, x: &str, theme: &Theme) {
    const RIGHT: f64 = 1560.0;
    let values = rows.numbers(x).unwrap_or_default();
    let rms = rows.numbers(RMS).unwrap_or_default();
    let regimes = words(rows, "regime");
    let (scale, unit) = speed_unit(rms.iter().copied());
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let across = Axis::around(values.iter().copied(), 0.02, 8, &label(rows, x));
    let up =
        Axis::around(rms.iter().map(|v| v * scale).chain([0.0]), 0.05, 6, &format!("RMS velocity, {unit}"));
    // Speed is never negative; the little room below 0 is for the markers.
    let frame = Frame::new(Area::new(LEFT, TOP, RIGHT, BOTTOM), across, up);
    frame.grid(figure, theme);
    let missing: Vec<f64> = order.iter().filter(|i| !rms[**i].is_finite()).map(|i| values[*i]).collect();
    for at in &missing {
        frame.vertical(figure, *at, style::LINE, theme.soft, Some(style::DOT));
    }
    let points = order.iter().map(|i| (values[*i], rms[*i] * scale));
    for part in points.collect::<Vec<_>>().split(|point| !point.1.is_finite()) {
        frame.dense_line(figure, part.iter().copied(), style::FINE_LINE, theme.soft);
    }
    let room = (RIGHT - LEFT) / values.len().max(1) as f64;
    let size = (0.55 * room).clamp(3.5, style::MARKER);
    let edge = if size > 6.0 { theme.ink } else { theme.paper };
    for i in &order {
        let at = frame.place((values[*i], rms[*i] * scale));
        if at.1.is_finite() {
            let (shape, ink) = regime(regimes.get(*i).copied().unwrap_or(""), theme);
            marker(figure, shape, at, size, ink, edge);
        }
    }
    frame.axes(figure, theme);
    let mut entries = Vec::new();
    for (name, shape) in REGIMES {
        if regimes.contains(&name) {
            entries.push((Sample::Marker(shape, regime(name, theme).1), name));
        }
    }
    if !missing.is_empty() {
        entries.push((
            Sample::Line(theme.soft, style::LINE, Some(style::DOT)),
            missing_words(words(rows, "outcome")),
        ));
    }
    legend(figure, theme, &entries, LEFT, RIGHT, 146.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_says_why_a_cell_has_no_speed() {
        assert_eq!(missing_words(&["done", "left_table"]), "ended early");
        assert_eq!(missing_words(&["done", "not_converged"]), "flexures not solved");
        assert_eq!(missing_words(&["step_budget", "not_converged"]), "ended early or not solved");
    }
}
