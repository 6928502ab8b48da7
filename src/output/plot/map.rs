//! The picture of a sweep over two fields: RMS velocity as colour, and where motion begins as lines.

use super::axis::Axis;
use super::figure::{Align, Area, Figure, Text};
use super::font;
use super::frame::Frame;
use super::mark::{Sample, cross, legend};
use super::run::speed_unit;
use super::style::{self, Theme, viridis};
use super::sweep::{BOTTOM, LEFT, RMS, TOP, label, missing_words, words};
use crate::study::{Edges, Table, first_interwell_edge};

/// The lines over a map, each where it makes sense.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlay {
    /// The release in closed form, with the swept columns of the map.
    pub release: Option<Table>,
    /// The first interwell cell along the amplitude.
    pub first_interwell: Option<Table>,
}

/// What a cell of a map shows.
#[derive(Clone, Copy, PartialEq)]
enum Cell {
    Missing,
    Rest,
    Speed(f64),
}

/// RMS velocity as colour over two fields.
pub(super) fn map(figure: &mut Figure, rows: &Table, (x, y): (&str, &str), overlay: &Overlay, theme: &Theme) {
    const RIGHT: f64 = 1310.0;
    let (xs, ys) = (rows.numbers(x).unwrap_or_default(), rows.numbers(y).unwrap_or_default());
    let (across, up) = (Edges::new(xs), Edges::new(ys));
    let rms = rows.numbers(RMS).unwrap_or_default();
    let regimes = words(rows, "regime");
    let mut cells = vec![Cell::Missing; across.values.len() * up.values.len()];
    for i in 0..rows.rows() {
        if let (Some(column), Some(row)) = (across.place(xs[i]), up.place(ys[i])) {
            cells[column * up.values.len() + row] = match regimes.get(i) {
                _ if !rms[i].is_finite() => Cell::Missing,
                Some(&"rest") => Cell::Rest,
                _ => Cell::Speed(rms[i]),
            };
        }
    }
    let ends = (across.ends(), up.ends());
    let frame = Frame::new(
        Area::new(LEFT, TOP, RIGHT, BOTTOM),
        Axis::between(ends.0.0, ends.0.1, 8, &label(rows, x)),
        Axis::between(ends.1.0, ends.1.1, 7, &label(rows, y)),
    );
    let (scale, unit) = speed_unit(rms.iter().copied());
    let greatest = rms.iter().filter(|v| v.is_finite()).fold(0.0_f64, |a, b| a.max(b * scale));
    let bar = Axis::between(0.0, greatest, 6, &format!("RMS velocity, {unit}"));
    for column in 0..across.values.len() {
        let own = &cells[column * up.values.len()..][..up.values.len()];
        let mut row = 0;
        for run in own.chunk_by(|a, b| a == b) {
            let (left, right) = (frame.across(across.edges[column]), frame.across(across.edges[column + 1]));
            let (low, high) = (frame.down(up.edges[row]), frame.down(up.edges[row + run.len()]));
            row += run.len();
            let area = Area::new(left, high, right, low);
            match run[0] {
                Cell::Speed(speed) => figure.rect(area, viridis(bar.share(speed * scale))),
                Cell::Rest => {
                    figure.rect(area, theme.rest);
                    figure.hatch(area, style::HATCH, theme.rest_hatch);
                }
                Cell::Missing => {
                    figure.rect(area, theme.paper);
                    cross(figure, area, theme.soft);
                }
            }
        }
    }
    let mut entries = Vec::new();
    let missing = missing_words(words(rows, "outcome"));
    if cells.contains(&Cell::Rest) {
        entries.push((Sample::Patch(theme.rest, Some(theme.rest_hatch)), "at rest"));
    }
    if cells.contains(&Cell::Missing) {
        entries.push((Sample::Crossed(theme.paper, theme.soft), missing));
    }
    entries.extend(over(figure, &frame, (x, y), &across, &up, overlay));
    frame.axes(figure, theme);
    colour_bar(figure, bar, theme);
    legend(figure, theme, &entries, LEFT, 1560.0, 146.0);
}

/// The lines over the map; what the legend says of them.
fn over(
    figure: &mut Figure,
    frame: &Frame,
    (x, y): (&str, &str),
    across: &Edges,
    up: &Edges,
    overlay: &Overlay,
) -> Vec<(Sample, &'static str)> {
    let mut entries = Vec::new();
    let pairs = |table: &Table| -> Option<Vec<(f64, f64)>> {
        Some(table.numbers(x)?.iter().copied().zip(table.numbers(y)?.iter().copied()).collect())
    };
    if let Some(table) = &overlay.first_interwell {
        let parts = first_interwell_edge(table, (x, y), across, up);
        for (width, ink) in [(style::GUIDE + 4.0, style::WHITE), (style::GUIDE, style::OVER_MAP)] {
            parts.iter().for_each(|part| frame.line(figure, part, width, ink));
        }
        if !parts.is_empty() {
            entries.push((Sample::Line(style::OVER_MAP, style::GUIDE, None), "first interwell cell"));
        }
    }
    if let Some(points) = overlay.release.as_ref().and_then(pairs) {
        frame.line(figure, &points, style::GUIDE + 4.0, style::BLACK);
        frame.dashed(figure, &points, style::GUIDE, style::WHITE, style::DASH);
        let sample = Sample::Outlined(style::WHITE, Some(style::DASH));
        entries.insert(0, (sample, "release in closed form, |F(limit)|/mass"));
    }
    entries
}

fn colour_bar(figure: &mut Figure, axis: Axis, theme: &Theme) {
    const STEPS: usize = 256;
    let area = Area::new(1370.0, TOP, 1410.0, BOTTOM);
    let height = (area.bottom - area.top) / STEPS as f64;
    for i in 0..STEPS {
        let bottom = area.bottom - i as f64 * height;
        let step = Area::new(area.left, bottom - height, area.right, bottom);
        figure.rect(step, viridis((i as f64 + 0.5) / STEPS as f64));
    }
    let Area { left, top, right, bottom } = area;
    let outline = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
    figure.line(&outline, style::FRAME, theme.ink, Figure::canvas());
    let mut widest: f64 = 0.0;
    let text = |words: &str, at, size, align, upright| Text {
        words: words.to_owned(),
        at,
        size,
        ink: theme.ink,
        bold: false,
        align,
        upright,
    };
    for (value, words) in &axis.ticks {
        let at = bottom - axis.share(*value) * (bottom - top);
        let tick = [(right, at), (right + style::TICK_LENGTH, at)];
        figure.line(&tick, style::FRAME, theme.ink, Figure::canvas());
        widest = widest.max(font::width(words, style::TICK, false));
        let place = (right + style::TICK_LENGTH + 7.0, at + 0.5 * style::TICK * font::CAPITAL);
        figure.text(text(words, place, style::TICK, Align::Left, false));
    }
    let place = (
        (right + style::TICK_LENGTH + 7.0 + widest + 16.0 + style::AXIS * font::CAPITAL).min(1592.0),
        0.5 * (top + bottom),
    );
    figure.text(text(&axis.label, place, style::AXIS, Align::Centre, true));
}
