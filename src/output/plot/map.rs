//! Picture of a sweep over two fields: a quantity as colour, and where motion begins as lines.

use super::axis::{PlotAxis, Ranges};
use super::drawn::Drawn;
use super::figure::{Align, Area, Figure, Point, Text};
use super::font;
use super::frame::Frame;
use super::mark::{Sample, cross};
use super::quantity::Quantity;
use super::style::{self, Ink, Theme, viridis};
use super::swept::{LEFT, Overlay, SweepPicture, below_legend, drawn, label, missing_words};
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
        let regimes = rows.words("regime");
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
            let values = &cells[column * up.values.len()..][..up.values.len()];
            let mut row = 0;
            for run in values.chunk_by(|a, b| a == b) {
                let (left, right) =
                    (frame.across(across.edges[column]), frame.across(across.edges[column + 1]));
                let (low, high) = (frame.down(up.edges[row]), frame.down(up.edges[row + run.len()]));
                row += run.len();
                let Some(area) = Area::new(left, high, right, low).common(frame.area) else { continue };
                match run[0] {
                    Cell::Value(value) => figure.rect(area, colour(value)),
                    Cell::Rest => {
                        figure.rect(area, theme.rest);
                        figure.hatch(area, theme.rest_hatch);
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

/// Room right of the frame for a colour bar with its numbers and its label, and the bar's place in it: on a
/// wide canvas and on a narrow one.
const BESIDE: f64 = 290.0;
const BAR: (f64, f64) = (60.0, 100.0);
const NARROW_BESIDE: f64 = 175.0;
const NARROW_BAR: (f64, f64) = (22.0, 50.0);

/// The quantity as colour over two fields.
pub(super) fn map(figure: &mut Figure, picture: &SweepPicture, (x, y): (&str, &str), theme: &Theme) {
    let map = Map::new(picture, (x, y));
    let top = below_legend(figure, theme, &map.entries(picture, theme));
    let canvas = figure.canvas.right;
    let right = match (figure.is_narrow(), map.quantity.words.is_some()) {
        (true, true) => figure.right(),
        (true, false) => canvas - NARROW_BESIDE,
        (false, _) => canvas - BESIDE,
    };
    let place = if figure.is_narrow() { NARROW_BAR } else { BAR };
    map.draw(figure, picture, (x, y), (top, right, figure.bottom()), place, theme);
    figure.data = map.drawn(picture, (x, y)).table();
}

/// A map of a sweep, before it has a place.
pub(super) struct Map {
    pub quantity: Quantity,
    mosaic: Mosaic,
    pub lines: Lines,
}

impl Map {
    /// Of a picture over the fields `x` and `y`.
    pub fn new(picture: &SweepPicture, (x, y): (&str, &str)) -> Self {
        let quantity = Quantity::of(picture.rows, picture.quantity);
        let mosaic = Mosaic::new(picture.rows, (x, y), &quantity, |_| true);
        let lines = Lines::new((x, y), &mosaic, &picture.overlay);
        Self { quantity, mosaic, lines }
    }

    /// What its legend says.
    pub fn entries(&self, picture: &SweepPicture, theme: &Theme) -> Vec<(Sample, &'static str)> {
        let mut entries = meanings(picture.rows, &self.quantity, &self.mosaic.cells, theme);
        if self.lines.release.is_some() {
            entries.push((RELEASE, "release in closed form, |F(limit)|/mass"));
        }
        if !self.lines.crossing.is_empty() {
            entries.push((CROSSING, "first crossing cell"));
        }
        entries
    }

    /// Draws it between these upper, right and lower edges, with a colour bar at `bar` right of it; its
    /// frame.
    pub fn draw(
        &self,
        figure: &mut Figure,
        picture: &SweepPicture,
        (x, y): (&str, &str),
        (top, right, bottom): (f64, f64, f64),
        place: (f64, f64),
        theme: &Theme,
    ) -> Frame {
        let labels = (label(picture.rows, x), label(picture.rows, y));
        let area = Area::new(LEFT, top, right, bottom);
        let mut frame = self.mosaic.frame(area, (&labels.0, &labels.1), picture.ranges);
        frame.area.left = Frame::left(figure, &frame.y, LEFT, bottom - top);
        let bar = self.quantity.axis(0.0, 6);
        self.mosaic.paint(figure, &frame, theme, |value| match self.quantity.words {
            Some(_) => self.quantity.ink(value, theme),
            None => viridis(bar.share(value)),
        });
        self.lines.draw(figure, &frame);
        frame.axes(figure, theme);
        if self.quantity.words.is_none() {
            let area = Area::new(right + place.0, top, right + place.1, bottom);
            colour_bar(figure, area, &bar, theme, viridis);
        }
        frame
    }

    /// Its cells and the points of its lines.
    pub fn drawn(&self, picture: &SweepPicture, (x, y): (&str, &str)) -> Drawn {
        let mut drawn = drawn(picture, &[(x, picture.ranges.x), (y, picture.ranges.y)]);
        let release = self.lines.release.iter().flatten().map(|point| ("release", point));
        let crossing = self.lines.crossing.iter().flatten().map(|point| ("first_crossing", point));
        for (series, (a, b)) in release.chain(crossing) {
            drawn.put(series, &[*a, *b], &[]);
        }
        drawn
    }
}

/// What a legend says of cells that no colour bar explains.
pub(super) fn meanings(
    rows: &Table,
    quantity: &Quantity,
    cells: &[Cell],
    theme: &Theme,
) -> Vec<(Sample, &'static str)> {
    let mut entries = Vec::new();
    let there = |place: usize| cells.contains(&Cell::Value(place as f64));
    for (place, name) in quantity.words.unwrap_or_default().iter().enumerate().filter(|word| there(word.0)) {
        entries.push((Sample::Patch(quantity.ink(place as f64, theme), None), *name));
    }
    if cells.contains(&Cell::Rest) {
        entries.push((Sample::Patch(theme.rest, Some(theme.rest_hatch)), "at rest"));
    }
    if cells.contains(&Cell::Missing) {
        let why = if quantity.velocity { missing_words(rows.words("outcome")) } else { "no value" };
        entries.push((Sample::Crossed(theme.paper, theme.soft), why));
    }
    entries
}

/// How the lines over a map look in its legend.
const RELEASE: Sample = Sample::Outlined(style::WHITE, Some(style::DASH));
const CROSSING: Sample = Sample::Line(style::OVER_MAP, style::GUIDE, None);

/// The lines over a map, in its fields.
pub(super) struct Lines {
    /// The release in closed form.
    pub release: Option<Vec<Point>>,
    /// The edges of the first crossing cells.
    pub crossing: Vec<Vec<Point>>,
}

impl Lines {
    /// Over the fields `x` and `y` of a map.
    pub fn new((x, y): (&str, &str), mosaic: &Mosaic, overlay: &Overlay) -> Self {
        let pairs = |table: &Table| -> Option<Vec<Point>> {
            Some(table.numbers(x)?.iter().copied().zip(table.numbers(y)?.iter().copied()).collect())
        };
        let crossing = overlay.first_crossing.as_ref();
        let edge = |table| first_crossing_edge(table, (x, y), &mosaic.across, &mosaic.up);
        Self {
            release: overlay.release.as_ref().and_then(pairs),
            crossing: crossing.map(edge).unwrap_or_default(),
        }
    }

    fn draw(&self, figure: &mut Figure, frame: &Frame) {
        for (width, ink) in [(style::GUIDE + 4.0, style::WHITE), (style::GUIDE, style::OVER_MAP)] {
            self.crossing.iter().for_each(|part| frame.line(figure, part, width, ink));
        }
        if let Some(points) = &self.release {
            frame.line(figure, points, style::GUIDE + 4.0, style::BLACK);
            frame.dashed(figure, points, style::GUIDE, style::WHITE, style::DASH);
        }
    }
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
    let Area { top, right, bottom, .. } = area;
    figure.outline(area, style::FRAME, theme.ink);
    let mut widest: f64 = 0.0;
    for (value, words) in &axis.ticks {
        let at = bottom - axis.share(*value) * (bottom - top);
        let tick = [(right, at), (right + style::TICK_LENGTH, at)];
        figure.line(&tick, style::FRAME, theme.ink, figure.canvas);
        widest = widest.max(font::width(words, style::TICK, false));
        let place = (right + style::TICK_LENGTH + 7.0, at + 0.5 * style::TICK * font::CAPITAL);
        figure.text(Text::new(words, place, style::TICK, theme.ink));
    }
    let place = (
        (right + style::TICK_LENGTH + 7.0 + widest + 16.0 + style::AXIS * font::CAPITAL)
            .min(figure.canvas.right - 8.0),
        0.5 * (top + bottom),
    );
    let label = Text::new(&axis.label, place, style::AXIS, theme.ink);
    figure.text(Text { align: Align::Centre, upright: true, ..label });
}
