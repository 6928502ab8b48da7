//! Picture of thresholds: over one field lines, drawn here; over two a [`map`](super::map) or lines.

use super::axis::{PlotAxis, Ranges};
use super::drawn::{Drawn, as_numbers};
use super::figure::{Area, Figure, Point};
use super::frame::Frame;
use super::map::map;
use super::mark::{Caption, Marker, Sample, marker};
use super::style::{self, Theme};
use super::sweep::{NoPicture, distinct, few_lines};
use super::swept::{LEAST, LEFT, Overlay, SweepPicture, View, below_legend, of_each, swept_axis};
use crate::scene::{Scene, column_names};
use crate::study::{Column, Grid, Onset, Table, Values};

/// What the picture of thresholds is drawn from.
#[derive(Debug, Clone, Copy)]
pub struct ThresholdPicture<'a> {
    /// As [`threshold_table`](crate::study::threshold_table) gives them.
    pub rows: &'a Table,
    /// The fields that they are over.
    pub grid: &'a Grid,
    /// Over which scene.
    pub scene: &'a Scene,
    /// Dotted path of the field whose threshold is shown.
    pub field: &'a str,
    /// What begins at it.
    pub onset: Onset,
    /// The axes, upward that of the threshold over one field.
    pub ranges: Ranges,
}

/// Whether thresholds over this grid can be shown.
pub fn can_show_thresholds(grid: &Grid) -> Result<(), NoPicture> {
    match grid.axes().len() {
        0 => Err(NoPicture::SingleThreshold),
        1 | 2 => Ok(()),
        n => Err(NoPicture::Fields(n)),
    }
}

/// The picture of thresholds: over one field a line, over two a line for each value of the one that has few,
/// else a map.
pub fn threshold_figure(
    picture: &ThresholdPicture,
    caption: &Caption,
    theme: &Theme,
) -> Result<Figure, NoPicture> {
    can_show_thresholds(picture.grid)?;
    let ThresholdPicture { rows, grid, scene, onset, ranges, .. } = *picture;
    let mut figure = Figure::new(theme, caption, LEAST);
    let least = format!("least_{}", column_names(&[picture.field]).concat());
    let values = rows.numbers("value").unwrap_or_default();
    let quantity = Column { name: least.clone(), values: Values::Numbers(values.to_vec()) };
    match (grid.columns(), few_lines(rows, grid)) {
        ([x], _) => lines(&mut figure, picture, x, None, &quantity.label(), theme),
        ([_, _], Some((x, each))) => {
            lines(&mut figure, picture, x, Some(each), &quantity.label(), theme);
        }
        (columns, _) => {
            let named = rows.clone().with(&least, quantity.values);
            let (quantity, overlay) = (least.as_str(), Overlay::default());
            let until_settled = None;
            let view = View::Top;
            let shown =
                SweepPicture { rows: &named, grid, scene, until_settled, quantity, overlay, view, ranges };
            map(&mut figure, &shown, (&columns[0], &columns[1]), theme);
        }
    }
    let names = grid.columns().iter().map(String::as_str);
    let mut drawn = Drawn::new(names.chain([&*least, "low", "high", "windows"]), &[]);
    let windows = rows.column("windows").and_then(as_numbers).unwrap_or_default();
    let of_row = |name: &str, row: usize| rows.numbers(name).map(|values| values[row]);
    for (row, &windows) in windows.iter().enumerate() {
        let fields = grid.columns().iter().map(String::as_str);
        let columns = fields.chain(["value", "low", "high"]).filter_map(|name| of_row(name, row));
        let numbers: Vec<f64> = columns.chain([windows]).collect();
        drawn.put("threshold", &numbers, &[]);
    }
    figure.data = drawn.table();
    caption.draw(&mut figure, theme, about(onset), LEFT);
    Ok(figure)
}

/// What begins at the threshold.
fn about(onset: Onset) -> &'static str {
    match onset {
        Onset::Release => "the least value at which the mass is released from the stop that it rests on",
        Onset::Crossing => "the least value at which the motion from rest, once it has settled, crosses",
        Onset::Interwell => {
            "the least value at which the motion from rest, once it has settled, is interwell"
        }
    }
}

/// The threshold over the field `x`; a line for each value of `series`.
fn lines(
    figure: &mut Figure,
    picture: &ThresholdPicture,
    x: &str,
    series: Option<&str>,
    up: &str,
    theme: &Theme,
) {
    let ThresholdPicture { rows, ranges, .. } = *picture;
    let numbers = |name: &str| rows.numbers(name).unwrap_or_default();
    let (places, values) = (numbers(x), numbers("value"));
    let gaps: Vec<bool> = match rows.column("windows").map(|column| &column.values) {
        Some(Values::Counts(counts)) => {
            counts.iter().map(|count| count.is_some_and(|count| count > 0)).collect()
        }
        _ => Vec::new(),
    };
    let of_series = series.map(numbers).unwrap_or_default();
    let each = if series.is_some() { distinct(of_series) } else { vec![f64::NAN] };
    let ink = |i: usize| match each.len() {
        1 => theme.ink,
        n => theme.step(i as f64 / (n - 1) as f64),
    };

    let mut entries: Vec<(Sample, String)> = Vec::new();
    for (i, words) in series.iter().flat_map(|name| of_each(name, &each)).enumerate() {
        entries.push((Sample::Line(ink(i), style::GUIDE, None), words));
    }
    let gap = gaps.contains(&true);
    if gap {
        entries.push((Sample::Marker(Marker::Disc, theme.ink), "no gap found above".to_owned()));
        entries.push((Sample::Marker(Marker::Triangle, theme.unstable), "gaps above".to_owned()));
    }
    let undecided = rows.words("undecided").iter().enumerate().filter(|(_, word)| **word == "true");
    let bars: Vec<(usize, [f64; 2])> =
        undecided.map(|(row, _)| (row, ["low", "high"].map(|name| numbers(name)[row]))).collect();
    if !bars.is_empty() {
        entries.push((Sample::Line(theme.soft, style::GUIDE, None), "undecided between".to_owned()));
    }
    let missing: Vec<usize> = (0..values.len()).filter(|i| !values[*i].is_finite()).collect();
    if !missing.is_empty() {
        entries.push((Sample::Ticks(theme.soft), "none in the range".to_owned()));
    }
    let entries: Vec<(Sample, &str)> =
        entries.iter().map(|(sample, words)| (*sample, words.as_str())).collect();
    let top = below_legend(figure, theme, &entries);

    let across = swept_axis(rows, x, ranges.x);
    let from_zero = values.iter().copied().chain(bars.iter().flat_map(|(_, bar)| *bar)).chain([0.0]);
    let upward = PlotAxis::around(from_zero, 0.05, 6, up).or_given(ranges.y, 6, up);
    let frame = Frame::whole(figure, (LEFT, top), across, upward);
    let edges = [frame.y.low, frame.y.high];
    let Area { left, right, bottom, .. } = frame.area;
    frame.grid(figure, theme);
    for (row, ends) in bars {
        // an end that is not known lies beyond the picture
        let end = |i: usize| (places[row], if ends[i].is_finite() { ends[i] } else { edges[i] });
        frame.line(figure, &[end(0), end(1)], style::GUIDE, theme.soft);
    }
    for row in missing {
        let at = frame.across(places[row]);
        figure.line(&[(at, bottom - TICK), (at, bottom)], style::LINE, theme.soft, frame.area);
    }
    for (i, value) in each.iter().enumerate() {
        let mut order: Vec<usize> =
            (0..values.len()).filter(|row| series.is_none() || of_series[*row] == *value).collect();
        order.sort_by(|a, b| places[*a].total_cmp(&places[*b]));
        let size = (0.3 * (right - left) / order.len().max(1) as f64).clamp(3.5, style::MARKER);
        for part in order.split(|row| !values[*row].is_finite()) {
            let points: Vec<Point> = part.iter().map(|row| (places[*row], values[*row])).collect();
            frame.line(figure, &points, style::LINE, ink(i));
            for (row, point) in part.iter().zip(points) {
                let at = frame.place(point);
                let (shape, colour) = match gaps.get(*row) {
                    Some(true) => (Marker::Triangle, theme.unstable),
                    _ => (Marker::Disc, ink(i)),
                };
                if frame.area.contains(at) {
                    marker(figure, shape, at, size, colour, if size > 6.0 { theme.ink } else { theme.paper });
                }
            }
        }
    }
    frame.axes(figure, theme);
}

/// Length of a tick at the lower edge where there is no threshold.
const TICK: f64 = 18.0;
