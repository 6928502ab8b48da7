//! Picture of a sweep over two fields: a quantity as colour, and where motion begins as lines.

use super::axis::PlotAxis;
use super::figure::{Align, Area, Figure, Text};
use super::font;
use super::frame::Frame;
use super::mark::{REGIMES, Sample, cross, legend};
use super::quantity::Quantity;
use super::style::{self, Theme, viridis};
use super::sweep::{BOTTOM, LEFT, SweepPicture, TOP, label, missing_words, words};
use crate::study::{Edges, Table, first_crossing_edge};

/// The lines over a map, each where it makes sense.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlay {
    /// The release in closed form, with the swept columns of the map.
    pub release: Option<Table>,
    /// The first crossing cell along the amplitude.
    pub first_crossing: Option<Table>,
}

/// What a cell of a map shows.
#[derive(Clone, Copy, PartialEq)]
enum Cell {
    Missing,
    Rest,
    Value(f64),
}

/// The quantity as colour over two fields.
pub(super) fn map(figure: &mut Figure, picture: &SweepPicture, (x, y): (&str, &str), theme: &Theme) {
    const RIGHT: f64 = 1310.0;
    let SweepPicture { rows, ranges, overlay, .. } = picture;
    let (xs, ys) = (rows.numbers(x).unwrap_or_default(), rows.numbers(y).unwrap_or_default());
    let (across, up) = (Edges::new(xs), Edges::new(ys));
    let quantity = Quantity::of(rows, picture.quantity);
    let regimes = words(rows, "regime");
    let mut cells = vec![Cell::Missing; across.values.len() * up.values.len()];
    for i in 0..rows.rows() {
        if let (Some(column), Some(row)) = (across.place(xs[i]), up.place(ys[i])) {
            cells[column * up.values.len() + row] = match regimes.get(i) {
                _ if !quantity.values[i].is_finite() => Cell::Missing,
                Some(&"rest") if quantity.velocity => Cell::Rest,
                _ => Cell::Value(quantity.values[i]),
            };
        }
    }
    let axis = |ends: (f64, f64), given, count, name| {
        let label = label(rows, name);
        PlotAxis::between(ends.0, ends.1, count, &label).or_given(given, count, &label)
    };
    let frame = Frame::new(
        Area::new(LEFT, TOP, RIGHT, BOTTOM),
        axis(across.ends(), ranges.x, 8, x),
        axis(up.ends(), ranges.y, 7, y),
    );
    let bar = quantity.axis(0.0, 6);
    for column in 0..across.values.len() {
        let own = &cells[column * up.values.len()..][..up.values.len()];
        let mut row = 0;
        for run in own.chunk_by(|a, b| a == b) {
            let (left, right) = (frame.across(across.edges[column]), frame.across(across.edges[column + 1]));
            let (low, high) = (frame.down(up.edges[row]), frame.down(up.edges[row + run.len()]));
            row += run.len();
            let Some(area) = Area::new(left, high, right, low).common(frame.area) else { continue };
            match run[0] {
                Cell::Value(place) if quantity.regimes => figure.rect(area, theme.regimes[place as usize]),
                Cell::Value(value) => figure.rect(area, viridis(bar.share(value))),
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
    if quantity.regimes {
        let there = |place: &usize| cells.contains(&Cell::Value(*place as f64));
        let names = REGIMES.iter().enumerate().filter(|(place, _)| there(place));
        entries.extend(names.map(|(place, (name, _))| (Sample::Patch(theme.regimes[place], None), *name)));
    }
    if cells.contains(&Cell::Rest) {
        entries.push((Sample::Patch(theme.rest, Some(theme.rest_hatch)), "at rest"));
    }
    if cells.contains(&Cell::Missing) {
        let why = if quantity.velocity { missing_words(words(rows, "outcome")) } else { "no value" };
        entries.push((Sample::Crossed(theme.paper, theme.soft), why));
    }
    entries.extend(over(figure, &frame, (x, y), &across, &up, overlay));
    frame.axes(figure, theme);
    if !quantity.regimes {
        colour_bar(figure, bar, theme);
    }
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
    if let Some(table) = &overlay.first_crossing {
        let parts = first_crossing_edge(table, (x, y), across, up);
        for (width, ink) in [(style::GUIDE + 4.0, style::WHITE), (style::GUIDE, style::OVER_MAP)] {
            parts.iter().for_each(|part| frame.line(figure, part, width, ink));
        }
        if !parts.is_empty() {
            entries.push((Sample::Line(style::OVER_MAP, style::GUIDE, None), "first crossing cell"));
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

fn colour_bar(figure: &mut Figure, axis: PlotAxis, theme: &Theme) {
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
