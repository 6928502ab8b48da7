//! Picture of a sweep: lines over one field, drawn here; over two a [`map`](super::map).

use super::axis::{PlotAxis, Ranges};
use super::figure::{Area, Figure, Point};
use super::frame::Frame;
use super::map::{Overlay, map};
use super::mark::{Caption, REGIMES, Sample, legend, marker, regime};
use super::quantity::{Quantity, quantities};
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
    /// Exponents of a single motion, or over several fields.
    #[error("--plot shows exponents over one field, not over {0}: name it with --over FIELD=FROM:TO:STEP")]
    Exponents(usize),
    /// Finer than a picture.
    #[error(
        "--plot shows at most {MAX_PICTURE_CELLS} cells, not {0}: take longer steps, or sweep without --plot"
    )]
    Cells(u64),
    /// No column that can be shown.
    #[error("--quantity {asked}: the rows have no such column to show; they have: {known}")]
    Quantity {
        /// The column asked for.
        asked: String,
        /// Those that there are.
        known: String,
    },
}

pub(super) const LEFT: f64 = 160.0;
pub(super) const TOP: f64 = 185.0;
pub(super) const BOTTOM: f64 = 868.0;

/// Whether the column `quantity` of a sweep of this grid can be shown; `table` is that of its rows, which may
/// be missing.
pub fn can_show(grid: &Grid, quantity: &str, table: &Table) -> Result<(), NoPicture> {
    if !quantities(table, grid).any(|own| own == quantity) {
        let known = quantities(table, grid).collect::<Vec<_>>().join(", ");
        return Err(NoPicture::Quantity { asked: quantity.to_owned(), known });
    }
    match grid.axes().len() {
        1 | 2 if grid.cells() > MAX_PICTURE_CELLS => Err(NoPicture::Cells(grid.cells())),
        1 | 2 => Ok(()),
        n => Err(NoPicture::Fields(n)),
    }
}

/// What the picture of a sweep is drawn from.
#[derive(Debug, Clone)]
pub struct SweepPicture<'a> {
    /// All rows.
    pub rows: &'a Table,
    /// Of which grid.
    pub grid: &'a Grid,
    /// Over which scene.
    pub scene: &'a Scene,
    /// The column that is shown.
    pub quantity: &'a str,
    /// The lines over a map.
    pub overlay: Overlay,
    /// The axes of the fields, and over one field that of the quantity upward.
    pub ranges: Ranges,
}

/// A field with at most so many values, each with many of the other field, is a line a value and not a map.
const FEW: usize = 6;
const MANY: usize = 3;

/// The picture of a sweep: over one field a line, over two a map, or a line for each value of a field that
/// has few.
pub fn sweep_figure(picture: &SweepPicture, caption: &Caption, theme: &Theme) -> Result<Figure, NoPicture> {
    let SweepPicture { rows, grid, scene, .. } = *picture;
    can_show(grid, picture.quantity, rows)?;
    let mut figure = Figure::new(theme.paper);
    let few = |of: usize, beside: usize| {
        let count = |i: usize| distinct(rows.numbers(&grid.columns()[i]).unwrap_or_default()).len();
        count(of) <= FEW && count(beside) >= MANY * count(of)
    };
    match grid.columns() {
        [x] => lines(&mut figure, picture, x, None, theme),
        [x, y] if few(1, 0) => lines(&mut figure, picture, x, Some(y), theme),
        [x, y] if few(0, 1) => lines(&mut figure, picture, y, Some(x), theme),
        [x, y] => map(&mut figure, picture, (x, y), theme),
        other => return Err(NoPicture::Fields(other.len())),
    }
    caption.draw(&mut figure, theme, &sweep_about(grid, scene), LEFT);
    Ok(figure)
}

/// The values in ascending order, each once.
fn distinct(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
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

/// The quantity over the field `x`, each value marked with its regime; a line for each value of `series`.
fn lines(figure: &mut Figure, picture: &SweepPicture, x: &str, series: Option<&str>, theme: &Theme) {
    const RIGHT: f64 = 1560.0;
    let SweepPicture { rows, ranges, .. } = *picture;
    let values = rows.numbers(x).unwrap_or_default();
    let quantity = Quantity::of(rows, picture.quantity);
    let regimes = words(rows, "regime");
    let of_series = series.and_then(|name| rows.numbers(name)).unwrap_or_default();
    let each = if series.is_some() { distinct(of_series) } else { vec![f64::NAN] };
    let ink = |i: usize| match each.len() {
        1 => theme.soft,
        n => theme.step(i as f64 / (n - 1) as f64),
    };

    let mut entries: Vec<(Sample, String)> = Vec::new();
    if let Some(name) = series {
        let label = label(rows, name);
        let (words, unit) = label.split_once(", ").unwrap_or((&label, ""));
        for (i, value) in each.iter().enumerate() {
            let words = if i == 0 { format!("{words} {}", short(*value)) } else { short(*value) };
            entries.push((
                Sample::Line(ink(i), style::GUIDE, None),
                format!("{words} {unit}").trim_end().to_owned(),
            ));
        }
    }
    for (name, shape) in REGIMES {
        if regimes.contains(&name) {
            entries.push((Sample::Marker(shape, regime(name, theme).1), name.to_owned()));
        }
    }
    let missing: Vec<f64> =
        (0..values.len()).filter(|i| !quantity.values[*i].is_finite()).map(|i| values[i]).collect();
    // Many lines from edge to edge would be all that is seen.
    let lines = missing.len() <= MOST_LINES;
    if !missing.is_empty() {
        let dotted = Sample::Line(theme.soft, style::LINE, Some(style::DOT));
        let dotted = if lines { dotted } else { Sample::Ticks(theme.soft) };
        let why = if quantity.velocity { missing_words(words(rows, "outcome")) } else { "no value" };
        entries.push((dotted, why.to_owned()));
    }
    let entries: Vec<(Sample, &str)> =
        entries.iter().map(|(sample, words)| (*sample, words.as_str())).collect();
    let top = TOP.max(legend(figure, theme, &entries, LEFT, RIGHT, 146.0) + 18.0);

    let x_label = label(rows, x);
    let across = PlotAxis::around(values.iter().copied(), 0.02, 8, &x_label).or_given(ranges.x, 8, &x_label);
    // Most quantities are never negative; the little room below 0 is for the markers.
    let up = quantity.axis(0.05, 6).or_given(ranges.y, 6, &quantity.label);
    let frame = Frame::new(Area::new(LEFT, top, RIGHT, BOTTOM), across, up);
    frame.grid(figure, theme);
    for at in &missing {
        if lines {
            frame.vertical(figure, *at, style::LINE, theme.soft, Some(style::DOT));
        } else {
            let at = frame.across(*at);
            figure.line(&[(at, BOTTOM - TICK), (at, BOTTOM)], style::FINE_LINE, theme.soft, frame.area);
        }
    }
    // One seed has nothing between it and the next, nor has one regime.
    let joined = !(x == "seed" || x.ends_with(".seed") || quantity.regimes);
    for (i, own) in each.iter().enumerate() {
        let mut order: Vec<usize> =
            (0..values.len()).filter(|row| series.is_none() || of_series[*row] == *own).collect();
        order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        for part in order.split(|row| !quantity.values[*row].is_finite()) {
            let point = |row: &usize| (values[*row], quantity.values[*row]);
            if joined {
                let width = if series.is_some() { style::LINE } else { style::FINE_LINE };
                frame.dense_line(figure, part.iter().map(point), width, ink(i));
            }
            let marks: Vec<(Point, &str)> = part
                .iter()
                .map(|row| (frame.place(point(row)), regimes.get(*row).copied().unwrap_or("")))
                .filter(|(at, _)| frame.area.contains(*at))
                .collect();
            let room = (RIGHT - LEFT) / order.len().max(1) as f64;
            let size = if joined { 0.8 * style::MARKER } else { (0.55 * room).clamp(3.5, style::MARKER) };
            let apart = if joined { MARKER_ROOM * size } else { 0.0 };
            for (at, word) in thinned(&marks, apart, 1.5 * size) {
                let (shape, ink) = regime(word, theme);
                marker(figure, shape, at, size, ink, if size > 6.0 { theme.ink } else { theme.paper });
            }
        }
    }
    frame.axes(figure, theme);
}

/// The most values without a quantity that have a line each; of more each has a tick at the lower edge, so
/// long.
const MOST_LINES: usize = 20;
const TICK: f64 = 18.0;

/// So many times its half height apart, markers on a line are told from each other.
const MARKER_ROOM: f64 = 5.0;

/// The marks of a line that stand `apart` from the one before; where the word changes, `close` is enough.
fn thinned<'a>(marks: &[(Point, &'a str)], apart: f64, close: f64) -> Vec<(Point, &'a str)> {
    let mut kept: Vec<(Point, &str)> = Vec::new();
    for (at, word) in marks {
        let stands = kept.last().is_none_or(|(last, own)| {
            (at.0 - last.0).hypot(at.1 - last.1) >= if own == word { apart } else { close.min(apart) }
        });
        if stands {
            kept.push((*at, word));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_on_a_line_stand_apart_and_a_change_is_seen() {
        let marks: Vec<(Point, &str)> = (0..100)
            .map(|i| ((f64::from(i) * 4.0, 0.0), if i < 50 { "rest" } else { "interwell" }))
            .collect();
        let kept = thinned(&marks, 40.0, 10.0);
        assert!(kept.windows(2).all(|pair| {
            let step = pair[1].0.0 - pair[0].0.0;
            step >= 40.0 || (pair[0].1 != pair[1].1 && step >= 10.0)
        }));
        let first = kept.iter().find(|own| own.1 == "interwell").unwrap();
        assert!(first.0.0 <= 200.0 + 10.0, "{first:?}");
        assert_eq!(thinned(&marks, 0.0, 10.0), marks);
    }

    #[test]
    fn a_legend_says_why_a_cell_has_no_speed() {
        assert_eq!(missing_words(&["done", "left_table"]), "ended early");
        assert_eq!(missing_words(&["done", "not_converged"]), "flexures not solved");
        assert_eq!(missing_words(&["step_budget", "not_converged"]), "ended early or not solved");
    }
}
