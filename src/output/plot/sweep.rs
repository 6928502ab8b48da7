//! Picture of a sweep: lines over one field, drawn here; over two a [`map`](super::map).

use super::cut::{self, map_with_cuts};
use super::figure::{Area, Figure};
use super::frame::Frame;
use super::map::map;
use super::mark::{Caption, REGIMES, Sample, regime};
use super::quantity::{Quantity, quantities, words_of};
use super::style::{self, Theme};
use super::surface::{MAX_SURFACE_CELLS, SURFACE, surface};
use super::swept::{
    LEAST, LEFT, MARKER_ROOM, SweepPicture, View, below_legend, drawn, mark_regimes, missing_words, of_each,
    swept_axis,
};
use super::walk::{STACKED, walked_both, walked_lines, walked_maps};
use crate::numeric::short;
use crate::scene::{Excitation, Scene, Start};
use crate::study::{DIRECTION, Direction, Grid, SUMMARY_FIELDS, Table};

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
    /// One threshold.
    #[error(
        "--plot shows thresholds over another field (a line) or two (a map), and there is one threshold: add \
         --over FIELD=FROM:TO:STEP, or leave --plot out"
    )]
    SingleThreshold,
    /// Exponents of a single motion, or over several fields.
    #[error("--plot shows exponents over one field, not over {0}: name it with --over FIELD=FROM:TO:STEP")]
    Exponents(usize),
    /// Finer than a picture.
    #[error(
        "--plot shows at most {MAX_PICTURE_CELLS} cells, not {0}: take longer steps, or sweep without --plot"
    )]
    Cells(u64),
    /// More starts than a picture tells apart.
    #[error("--plot shows at most {MAX_PICTURE_CELLS} starts, not {0}: take fewer, or leave --plot out")]
    Starts(u64),
    /// No map that a surface or a cut could be of.
    #[error(
        "--surface and --cut show a sweep over two fields, each of two values or more, without --carry: give \
         two --over"
    )]
    NoMap,
    /// Words instead of heights.
    #[error("--surface shows heights, and --quantity {0} has words: name a column of numbers")]
    FlatWords(String),
    /// More faces than can be told apart.
    #[error("--surface shows at most {MAX_SURFACE_CELLS} cells, not {0}: take longer steps, or leave it out")]
    SurfaceCells(u64),
    /// No column that can be shown.
    #[error("--quantity {name}: no such column to show; there are: {known}")]
    Quantity {
        /// The column as given.
        name: String,
        /// Those that there are.
        known: String,
    },
}

/// Whether the column `quantity` of a sweep of this grid can be shown in this way; `table` is that of its
/// rows, which may be missing.
pub fn can_show(grid: &Grid, quantity: &str, view: &View, table: &Table) -> Result<(), NoPicture> {
    if !quantities(table, grid).any(|column| column == quantity) {
        let mut known: Vec<&str> = quantities(table, grid).collect();
        let more = SUMMARY_FIELDS.iter().map(|field| field.name).filter(|name| !known.contains(name));
        let more: Vec<&str> = more.collect();
        known.extend(more);
        let known = known.join(", ");
        return Err(NoPicture::Quantity { name: quantity.to_owned(), known });
    }
    if *view != View::Top {
        let lengths = || grid.axes().iter().map(|axis| axis.values.len());
        match (view, grid.cells()) {
            _ if lengths().count() != 2 || lengths().min() < Some(2) => return Err(NoPicture::NoMap),
            _ if table.column(DIRECTION).is_some() => return Err(NoPicture::NoMap),
            (View::Surface, _) if words_of(quantity).is_some() => {
                return Err(NoPicture::FlatWords(quantity.to_owned()));
            }
            (View::Surface, n) if n > MAX_SURFACE_CELLS => return Err(NoPicture::SurfaceCells(n)),
            _ => {}
        }
    }
    match grid.axes().len() {
        1 | 2 if grid.cells() > MAX_PICTURE_CELLS => Err(NoPicture::Cells(grid.cells())),
        1 | 2 => Ok(()),
        n => Err(NoPicture::Fields(n)),
    }
}

/// A field with at most so many values, each with many of the other field, is a line a value and not a map.
const FEW: usize = 6;
const MANY: usize = 3;

/// The picture of a sweep: over one field a line, over two a map, or a line for each value of a field that
/// has few.
pub fn sweep_figure(picture: &SweepPicture, caption: &Caption, theme: &Theme) -> Result<Figure, NoPicture> {
    let SweepPicture { rows, grid, scene, until_settled, .. } = *picture;
    can_show(grid, picture.quantity, &picture.view, rows)?;
    let mut figure = Figure::new(theme, caption, least(picture, theme));
    match (grid.columns(), few_lines(rows, grid)) {
        ([x, y], _) if picture.view == View::Surface => surface(&mut figure, picture, (x, y), theme),
        ([x, y], _) if let View::Cuts(cuts) = &picture.view => {
            map_with_cuts(&mut figure, picture, (x, y), cuts, theme);
        }
        ([x], _) if walked_both(rows) => walked_lines(&mut figure, picture, x, theme),
        ([x, y], _) if walked_both(rows) => walked_maps(&mut figure, picture, (x, y), theme),
        ([x], _) => lines(&mut figure, picture, x, None, theme),
        (_, Some((x, each))) => lines(&mut figure, picture, x, Some(each), theme),
        ([x, y], None) => map(&mut figure, picture, (x, y), theme),
        (other, None) => return Err(NoPicture::Fields(other.len())),
    }
    let ways = rows.words(DIRECTION);
    let walked = [Direction::Up, Direction::Down].into_iter().filter(|way| ways.contains(&way.name()));
    let walked: Vec<Direction> = walked.collect();
    caption.draw(&mut figure, theme, &sweep_about(grid, scene, &walked, until_settled), LEFT);
    Ok(figure)
}

/// What the picture needs between its captions.
fn least(picture: &SweepPicture, theme: &Theme) -> f64 {
    let maps = picture.grid.axes().len() == 2 && walked_both(picture.rows);
    match &picture.view {
        View::Surface => SURFACE,
        View::Cuts(cuts) => cut::least(cuts.len(), theme),
        View::Top if maps && theme.is_narrow() => STACKED,
        View::Top => LEAST,
    }
}

/// Of two swept fields the one to the right and the one of which each value has a line, where one has few.
pub(super) fn few_lines<'a>(rows: &Table, grid: &'a Grid) -> Option<(&'a str, &'a str)> {
    let [a, b] = grid.columns() else { return None };
    let count = |name: &str| distinct(rows.numbers(name).unwrap_or_default()).len();
    let few = |of: &str, beside: &str| count(of) <= FEW && count(beside) >= MANY * count(of);
    match (few(b, a), few(a, b)) {
        (true, _) => Some((a, b)),
        (false, true) => Some((b, a)),
        _ => None,
    }
}

/// The values in ascending order, each once.
pub(super) fn distinct(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// What was run, in one line; in which directions it was `walked`, where each run went on from the one
/// before, and up to when in s runs went on until they repeat, where they did.
pub fn sweep_about(grid: &Grid, scene: &Scene, walked: &[Direction], until_settled: Option<f64>) -> String {
    let lengths = grid.axes().iter().map(|axis| axis.values.len());
    let counts: Vec<String> = Some(walked.len())
        .filter(|ways| *ways > 1)
        .into_iter()
        .chain(lengths)
        .map(|n| n.to_string())
        .collect();
    let swept = |field: &str| grid.axes().iter().any(|axis| axis.field == field);
    let mut parts = vec![format!("{} runs", counts.join(" \u{d7} "))];
    if !swept("run.duration_s") {
        let longest = until_settled.map_or_else(String::new, |until| format!(" to {}", short(until)));
        parts[0] += &format!(" of {}{longest} s", short(scene.run.duration_s));
    }
    if !walked.is_empty() {
        let ways: Vec<&str> = walked.iter().map(|way| way.name()).collect();
        parts.push(format!("{}, each from where the one before was", ways.join(" and ")));
    } else if scene.start == Start::Rest {
        parts.push("each from rest".to_owned());
    }
    if let Excitation::Sine { frequency_hz, .. } = scene.excitation
        && !swept("excitation.frequency_hz")
    {
        parts.push(format!("shaken at {} Hz", short(frequency_hz)));
    }
    parts.join(", ")
}

/// The quantity over the field `x`, each value marked with its regime; a line for each value of `series`.
fn lines(figure: &mut Figure, picture: &SweepPicture, x: &str, series: Option<&str>, theme: &Theme) {
    let SweepPicture { rows, ranges, .. } = *picture;
    let values = rows.numbers(x).unwrap_or_default();
    let quantity = Quantity::of(rows, picture.quantity);
    let regimes = rows.words("regime");
    let of_series = series.and_then(|name| rows.numbers(name)).unwrap_or_default();
    let each = if series.is_some() { distinct(of_series) } else { vec![f64::NAN] };
    let ink = |i: usize| match each.len() {
        1 => theme.soft,
        n => theme.step(i as f64 / (n - 1) as f64),
    };

    let mut entries: Vec<(Sample, String)> = Vec::new();
    for (i, words) in series.iter().flat_map(|name| of_each(name, &each)).enumerate() {
        entries.push((Sample::Line(ink(i), style::GUIDE, None), words));
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
        let why = if quantity.velocity { missing_words(rows.words("outcome")) } else { "no value" };
        entries.push((dotted, why.to_owned()));
    }
    let entries: Vec<(Sample, &str)> =
        entries.iter().map(|(sample, words)| (*sample, words.as_str())).collect();
    let top = below_legend(figure, theme, &entries);

    let across = swept_axis(rows, x, ranges.x);
    // Most quantities are never negative; the little room below 0 is for the markers.
    let up = quantity.axis(0.05, 6).or_given(ranges.y, 6, &quantity.label);
    let frame = Frame::whole(figure, (LEFT, top), across, up);
    let Area { left, right, bottom, .. } = frame.area;
    frame.grid(figure, theme);
    for at in &missing {
        if lines {
            frame.vertical(figure, *at, style::LINE, theme.soft, Some(style::DOT));
        } else {
            let at = frame.across(*at);
            figure.line(&[(at, bottom - TICK), (at, bottom)], style::FINE_LINE, theme.soft, frame.area);
        }
    }
    // One seed has nothing between it and the next, nor has one regime.
    let joined = !(x == "seed" || x.ends_with(".seed") || quantity.words.is_some());
    for (i, value) in each.iter().enumerate() {
        let mut order: Vec<usize> =
            (0..values.len()).filter(|row| series.is_none() || of_series[*row] == *value).collect();
        order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        for part in order.split(|row| !quantity.values[*row].is_finite()) {
            let point = |row: &usize| (values[*row], quantity.values[*row]);
            if joined {
                let width = if series.is_some() { style::LINE } else { style::FINE_LINE };
                frame.dense_line(figure, part.iter().map(point), width, ink(i));
            }
            let marks = part.iter().map(|row| (point(row), regimes.get(*row).copied().unwrap_or("")));
            let room = (right - left) / order.len().max(1) as f64;
            let size = if joined { 0.8 * style::MARKER } else { (0.55 * room).clamp(3.5, style::MARKER) };
            let apart = if joined { MARKER_ROOM * size } else { 0.0 };
            let edge = if size > 6.0 { theme.ink } else { theme.paper };
            mark_regimes(figure, &frame, marks, size, apart, edge, theme);
        }
    }
    figure.data = drawn(picture, &[(x, ranges.x)]).table();
    frame.axes(figure, theme);
}

/// The most values without a quantity that have a line each; of more each has a tick at the lower edge, so
/// long.
const MOST_LINES: usize = 20;
const TICK: f64 = 18.0;
