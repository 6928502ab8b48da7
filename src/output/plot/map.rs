//! Picture of a sweep over two fields: a quantity as colour, and where motion begins as lines.

use super::axis::{PlotAxis, Ranges};
use super::figure::{Align, Area, Figure, Text};
use super::font;
use super::frame::Frame;
use super::mark::{REGIMES, Sample, cross, legend};
use super::quantity::Quantity;
use super::style::{self, Ink, Theme, viridis};
use super::swept::{BOTTOM, LEFT, Overlay, SweepPicture, TOP, label, missing_words, words};
use crate::study::{Edges, Table, first_crossing_edge};

/// What a cell of a map shows.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Cell {
    Missing,
    Rest,
    Value(f64),
}

/// The cells of a map in columns, with their edges.
#[derive(Clone)]
pub(super) struct Mosaic {
    pub across: Edges,
    pub up: Edges,
    pub cells: Vec<Cell>,
}

impl Mosaic {
    /// Of those rows over the fields `x` and `y` that are to be `shown`.
    pub fn new(
        rows: &Table,
        (x, y): (&str, &str),
        quantity: &Quantity,
        shown: impl Fn(usize) -> bool,
    ) -> Self {
        let (xs, ys) = (rows.numbers(x).unwrap_or_default(), rows.numbers(y).unwrap_or_default());
        let (across, up) = (Edges::new(xs), Edges::new(ys));
        let regimes = words(rows, "regime");
        let mut cells = vec![Cell::Missing; across.values.len() * up.values.len()];
        for i in (0..rows.rows()).filter(|i| shown(*i)) {
            if let (Some(column), Some(row)) = (across.place(xs[i]), up.place(ys[i])) {
                cells[column * up.values.len() + row] = match regimes.get(i) {
                    _ if !quantity.values[i].is_finite() => Cell::Missing,
                    Some(&"rest") if quantity.velocity => Cell::Rest,
                    _ => Cell::Value(quantity.values[i]),
                };
            }
        }
        Self { across, up, cells }
    }

    /// A frame at `area` over all of it, with these labels or in these ranges.
    pub fn frame(&self, area: Area, labels: (&str, &str), ranges: Ranges) -> Frame {
        let axis = |ends: (f64, f64), given, count, label: &str| {
            PlotAxis::between(ends.0, ends.1, count, label).or_given(given, count, label)
        };
        let many = if area.right - area.left > 600.0 { 8 } else { 4 };
        let x = axis(self.across.ends(), ranges.x, many, labels.0);
        Frame::new(area, x, axis(self.up.ends(), ranges.y, 7, labels.1))
    }

    /// Paints the cells, each value in its colour.
    pub fn paint(&self, figure: &mut Figure, frame: &Frame, theme: &Theme, colour: impl Fn(f64) -> Ink) {
        let Self { across, up, cells } = self;
        for column in 0..across.values.len() {
            let own = &cells[column * up.values.len()..][..up.values.len()];
            let mut row = 0;
            for run in own.chunk_by(|a, b| a == b) {
                let (left, right) =
                    (frame.across(across.edges[column]), frame.across(across.edges[column + 1]));
                let (low, high) = (frame.down(up.edges[row]), frame.down(up.edges[row + run.len()]));
                row += run.len();
                let Some(area) = Area::new(left, high, right, low).common(frame.area) else { continue };
                match run[0] {
                    Cell::Value(value) => figure.rect(area, colour(value)),
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
    }
}

/// The quantity as colour over two fields.
pub(super) fn map(figure: &mut Figure, picture: &SweepPicture, (x, y): (&str, &str), theme: &Theme) {
    const RIGHT: f64 = 1310.0;
    let SweepPicture { rows, ranges, overlay, .. } = picture;
    let quantity = Quantity::of(rows, picture.quantity);
    let mosaic = Mosaic::new(rows, (x, y), &quantity, |_| true);
    let frame =
        mosaic.frame(Area::new(LEFT, TOP, RIGHT, BOTTOM), (&label(rows, x), &label(rows, y)), *ranges);
    let bar = quantity.axis(0.0, 6);
    mosaic.paint(figure, &frame, theme, |value| match quantity.regimes {
        true => theme.regimes[value as usize],
        false => viridis(bar.share(value)),
    });
    let Mosaic { across, up, cells } = &mosaic;
    let mut entries = meanings(rows, &quantity, cells, theme);
    entries.extend(over(figure, &frame, (x, y), across, up, overlay));
    frame.axes(figure, theme);
    if !quantity.regimes {
        colour_bar(figure, Area::new(1370.0, TOP, 1410.0, BOTTOM), &bar, theme, viridis);
    }
    legend(figure, theme, &entries, LEFT, 1560.0, 146.0);
}

/// What a legend says of cells that no colour bar explains.
pub(super) fn meanings(
    rows: &Table,
    quantity: &Quantity,
    cells: &[Cell],
    theme: &Theme,
) -> Vec<(Sample, &'static str)> {
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
    entries
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

/// A bar at `area` with the colours of the shares from 0 to 1.
pub(super) fn colour_bar(
    figure: &mut Figure,
    area: Area,
    axis: &PlotAxis,
    theme: &Theme,
    colour: impl Fn(f64) -> Ink,
) {
    const STEPS: usize = 256;
    let height = (area.bottom - area.top) / STEPS as f64;
    for i in 0..STEPS {
        let bottom = area.bottom - i as f64 * height;
        let step = Area::new(area.left, bottom - height, area.right, bottom);
        figure.rect(step, colour((i as f64 + 0.5) / STEPS as f64));
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
