//! Frame with two axes, which places data on the canvas.

use super::axis::PlotAxis;
use super::figure::{Align, Area, Figure, Point, Text};
use super::font;
use super::style::{self, Ink, Theme};

/// A rectangle of the canvas with an axis to the right and one upward.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Where it is.
    pub area: Area,
    /// The axis to the right.
    pub x: PlotAxis,
    /// The axis upward.
    pub y: PlotAxis,
    /// How far left of the frame the label of the axis upward stands at least, so that labels of several
    /// frames are in line; the numbers may push it further.
    pub gutter: Option<f64>,
}

/// Distance of the upward label's line from the frame, besides the width of the numbers between them.
const BESIDE: f64 = style::TICK_LENGTH + 7.0 + 18.0;

/// From the first line of an upward label to its second.
const SECOND: f64 = 32.0;

/// Whether a label can stand in full size beside a frame of this height.
fn fits(label: &str, height: f64) -> bool {
    font::width(label, style::AXIS, false) <= height + 20.0
}

/// A label in two lines, parted at the blank next to its middle.
fn halves(label: &str) -> Option<(&str, &str)> {
    let middle = label.len() / 2;
    let blank = label.match_indices(' ').map(|blank| blank.0).min_by_key(|at| at.abs_diff(middle))?;
    Some((&label[..blank], &label[blank + 1..]))
}

impl Frame {
    /// A frame at `area` with these axes.
    pub fn new(area: Area, x: PlotAxis, y: PlotAxis) -> Self {
        Self { area, x, y, gutter: None }
    }

    /// Where the left edge of a frame with this axis upward stands, so that numbers and label have room: on a
    /// wide canvas at `wide`. On a narrow one a label that is too long for the frame's `height` has two
    /// lines.
    pub fn left(figure: &Figure, y: &PlotAxis, wide: f64, height: f64) -> f64 {
        if !figure.is_narrow() {
            return wide;
        }
        let numbers = y.ticks.iter().map(|tick| font::width(&tick.1, style::TICK, false)).fold(0.0, f64::max);
        BESIDE + numbers + style::AXIS + if fits(&y.label, height) { 0.0 } else { SECOND }
    }

    /// A frame from `top` to the lower edge of the canvas, on a wide canvas from `wide` on.
    pub fn whole(figure: &Figure, (wide, top): (f64, f64), x: PlotAxis, y: PlotAxis) -> Self {
        let left = Self::left(figure, &y, wide, figure.bottom() - top);
        Self::new(Area::new(left, top, figure.right(), figure.bottom()), x, y)
    }

    /// Where a value of x stands on the canvas.
    pub fn across(&self, x: f64) -> f64 {
        self.area.left + self.x.share(x) * (self.area.right - self.area.left)
    }

    /// Where a value of y stands on the canvas.
    pub fn down(&self, y: f64) -> f64 {
        self.area.bottom - self.y.share(y) * (self.area.bottom - self.area.top)
    }

    /// Where a pair of values stands on the canvas.
    pub fn place(&self, (x, y): Point) -> Point {
        (self.across(x), self.down(y))
    }

    /// Grid lines, under everything else.
    pub fn grid(&self, figure: &mut Figure, theme: &Theme) {
        let Area { left, top, right, bottom } = self.area;
        for (value, _) in &self.x.ticks {
            let at = self.across(*value);
            figure.line(&[(at, top), (at, bottom)], style::GRID, theme.grid, self.area);
        }
        for (value, _) in &self.y.ticks {
            let at = self.down(*value);
            figure.line(&[(left, at), (right, at)], style::GRID, theme.grid, self.area);
        }
    }

    /// Frame, ticks, numbers and labels, over everything else.
    pub fn axes(&self, figure: &mut Figure, theme: &Theme) {
        let Area { left, top, right, bottom } = self.area;
        figure.outline(self.area, style::FRAME, theme.ink);
        let ascent = style::TICK * font::CAPITAL;
        let text = |words: &str, at: Point, align: Align| Text {
            align,
            ..Text::new(words, at, style::TICK, theme.ink)
        };
        let (numbered, narrow) = (self.numbered(), figure.is_narrow());
        for (i, (value, words)) in self.x.ticks.iter().enumerate() {
            let at = self.across(*value);
            let words = if numbered(i) { words } else { "" };
            let tick = [(at, bottom), (at, bottom + style::TICK_LENGTH)];
            figure.line(&tick, style::FRAME, theme.ink, figure.canvas);
            figure.text(text(words, (at, bottom + style::TICK_LENGTH + ascent + 8.0), Align::Centre));
        }
        let mut widest: f64 = 0.0;
        for (value, words) in &self.y.ticks {
            let at = self.down(*value);
            let tick = [(left - style::TICK_LENGTH, at), (left, at)];
            figure.line(&tick, style::FRAME, theme.ink, figure.canvas);
            widest = widest.max(font::width(words, style::TICK, false));
            figure.text(text(words, (left - style::TICK_LENGTH - 7.0, at + 0.5 * ascent), Align::Right));
        }
        // A label too long for its axis is smaller, so that it does not reach into the next one.
        let mut label = |words: &str, at: Point, upright: bool| {
            let room = if upright { bottom - top + 20.0 } else { right - left + 60.0 };
            let size = style::AXIS * (room / font::width(words, style::AXIS, false)).min(1.0);
            figure.text(Text { size, upright, ..text(words, at, Align::Centre) });
        };
        let below = bottom + style::TICK_LENGTH + ascent + 16.0 + style::AXIS;
        label(&self.x.label, (0.5 * (left + right), below), false);
        let near = BESIDE + widest;
        let beside = (left - self.gutter.map_or(near, |gutter| gutter.max(near))).max(style::AXIS);
        let middle = 0.5 * (top + bottom);
        let two = narrow && beside >= style::AXIS + SECOND && !fits(&self.y.label, bottom - top);
        match halves(&self.y.label).filter(|_| two) {
            Some((first, second)) => {
                label(first, (beside - SECOND, middle), true);
                label(second, (beside, middle), true);
            }
            None => label(&self.y.label, (beside, middle), true),
        }
    }

    /// Which ticks to the right have their number: as many as stand apart, 0 among them.
    fn numbered(&self) -> impl Fn(usize) -> bool + use<> {
        const APART: f64 = 16.0;
        let ticks: Vec<(f64, f64)> = self
            .x
            .ticks
            .iter()
            .map(|(value, words)| (self.across(*value), 0.5 * font::width(words, style::TICK, false)))
            .collect();
        let zero = self.x.ticks.iter().position(|tick| tick.0 == 0.0).unwrap_or(0);
        let apart = |every: &usize| {
            let kept: Vec<_> = ticks.iter().skip(zero % every).step_by(*every).collect();
            kept.windows(2).all(|pair| pair[1].0 - pair[0].0 >= pair[0].1 + pair[1].1 + APART)
        };
        let every = (1..=ticks.len().max(1)).find(apart).unwrap_or(1);
        move |i| i % every == zero % every
    }

    /// A line through data.
    pub fn line(&self, figure: &mut Figure, data: &[Point], width: f64, ink: Ink) {
        figure.line(&self.places(data), width, ink, self.area);
    }

    /// A dashed line through data.
    pub fn dashed(&self, figure: &mut Figure, data: &[Point], width: f64, ink: Ink, dash: (f64, f64)) {
        figure.dashed(&self.places(data), width, ink, dash, self.area);
    }

    fn places(&self, data: &[Point]) -> Vec<Point> {
        data.iter().map(|point| self.place(*point)).collect()
    }

    /// A line through data with ascending x, of which there may be millions: in each column of the
    /// canvas the first, the least, the greatest and the last are kept, which cover what all of them would.
    pub fn dense_line(&self, figure: &mut Figure, data: impl Iterator<Item = Point>, width: f64, ink: Ink) {
        let mut kept: Vec<Point> = Vec::new();
        let mut column: Vec<Point> = Vec::new();
        let flush = |column: &mut Vec<Point>, kept: &mut Vec<Point>| {
            kept.extend(extremes(column));
            column.clear();
        };
        for point in data {
            let place = self.place(point);
            let same = column.first().is_some_and(|first| first.0.floor() == place.0.floor());
            if !same {
                flush(&mut column, &mut kept);
            }
            // Only four of a column count, so no more than a few are held.
            if column.len() >= 64 {
                column = extremes(&column);
            }
            column.push(place);
        }
        flush(&mut column, &mut kept);
        figure.line(&kept, width, ink, self.area);
    }

    /// A line through data in any order: points nearer to the last kept one than a part of a pixel are left
    /// out.
    pub fn path(&self, figure: &mut Figure, data: impl Iterator<Item = Point>, width: f64, ink: Ink) {
        const NEAR: f64 = 0.35;
        let mut kept: Vec<Point> = Vec::new();
        let mut last = None;
        for point in data {
            let place = self.place(point);
            let far =
                kept.last().is_none_or(|last: &Point| (last.0 - place.0).hypot(last.1 - place.1) > NEAR);
            if far {
                kept.push(place);
            }
            last = Some(place);
        }
        kept.extend(last);
        figure.line(&kept, width, ink, self.area);
    }

    /// A line at one x from the lower to the upper edge.
    pub fn vertical(&self, figure: &mut Figure, x: f64, width: f64, ink: Ink, dash: Option<(f64, f64)>) {
        let at = self.across(x);
        self.guide(figure, [(at, self.area.bottom), (at, self.area.top)], width, ink, dash);
    }

    /// A line at one y from the left to the right edge.
    pub fn horizontal(&self, figure: &mut Figure, y: f64, width: f64, ink: Ink, dash: Option<(f64, f64)>) {
        let at = self.down(y);
        self.guide(figure, [(self.area.left, at), (self.area.right, at)], width, ink, dash);
    }

    fn guide(&self, figure: &mut Figure, ends: [Point; 2], width: f64, ink: Ink, dash: Option<(f64, f64)>) {
        match dash {
            Some(dash) => figure.dashed(&ends, width, ink, dash, self.area),
            None => figure.line(&ends, width, ink, self.area),
        }
    }

    /// A wall at `x`, solid towards its left (`left`) or right.
    pub fn wall_across(&self, figure: &mut Figure, x: f64, left: bool, theme: &Theme) {
        let at = self.across(x);
        let Area { top, bottom, .. } = self.area;
        let (from, to) = if left { (at - style::WALL, at) } else { (at, at + style::WALL) };
        if let Some(solid) = Area::new(from, top, to, bottom).common(self.area) {
            figure.rect(solid, theme.wall_fill());
            figure.hatch(solid, theme.wall_hatch());
        }
        figure.line(&[(at, top), (at, bottom)], style::LINE, theme.wall, self.area);
    }

    /// A wall at `y`, solid below or above it.
    pub fn wall_down(&self, figure: &mut Figure, y: f64, below: bool, theme: &Theme) {
        let at = self.down(y);
        let Area { left, right, .. } = self.area;
        let (top, bottom) = if below { (at, at + style::WALL) } else { (at - style::WALL, at) };
        if let Some(solid) = Area::new(left, top, right, bottom).common(self.area) {
            figure.rect(solid, theme.wall_fill());
        }
        figure.line(&[(left, at), (right, at)], style::LINE, theme.wall, self.area);
    }
}

/// Upper and lower edges of frames one under the other, drawn up or down so that they fill the room from
/// `top` to `bottom`.
pub fn stretched<const N: usize>(frames: [(f64, f64); N], top: f64, bottom: f64) -> [(f64, f64); N] {
    let (first, last) = (frames[0].0, frames[N - 1].1);
    let scale = (bottom - top) / (last - first);
    frames.map(|(from, to)| (top + scale * (from - first), top + scale * (to - first)))
}

/// First, least, greatest and last of a column, in their order.
fn extremes(column: &[Point]) -> Vec<Point> {
    let by = |better: fn(f64, f64) -> bool| {
        let mut best: Option<usize> = None;
        for (i, point) in column.iter().enumerate() {
            if !point.1.is_nan() && best.is_none_or(|best| better(point.1, column[best].1)) {
                best = Some(i);
            }
        }
        best
    };
    let mut places: Vec<usize> = [
        column.first().map(|_| 0),
        by(|value, best| value < best),
        by(|value, best| value > best),
        column.len().checked_sub(1),
    ]
    .into_iter()
    .flatten()
    .collect();
    places.sort_unstable();
    places.dedup();
    places.into_iter().map(|i| column[i]).collect()
}
