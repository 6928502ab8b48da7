//! Picture as a list of simple shapes in painting order.
//!
//! Plots produce shapes; [`Format`](super::Format) turns them into a file. So a plot is independent of the
//! format, and tests can inspect its contents.

use std::borrow::Cow;

use serde_json::{Map, Value};

use super::font;
use super::frame::Frame;
use super::role::Look;
use super::sheet::Sheet;
use super::style::{self, Ink, Theme};
use super::surface::SurfaceFrame;
use crate::numeric::{elementary, short};
use crate::study::Table;

/// A position on the canvas, to the right and down from the upper left corner.
pub type Point = (f64, f64);

/// A rectangle by two corners, the first one above and to the left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Lower edge.
    pub bottom: f64,
}

impl Area {
    /// The rectangle with these edges.
    pub fn new(left: f64, top: f64, right: f64, bottom: f64) -> Self {
        Self { left, top, right, bottom }
    }

    /// The intersection with `other`; `None` if it is empty.
    pub fn common(self, other: Self) -> Option<Self> {
        let (left, right) = (self.left.max(other.left), self.right.min(other.right));
        let (top, bottom) = (self.top.max(other.top), self.bottom.min(other.bottom));
        (left < right && top < bottom).then_some(Self { left, top, right, bottom })
    }

    /// Whether a point lies inside.
    pub fn contains(self, (x, y): Point) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    /// The part of a convex polygon that lies inside (Sutherland and Hodgman 1974); empty if none does.
    pub fn clip_polygon(self, points: Vec<Point>) -> Vec<Point> {
        let Self { left, top, right, bottom } = self;
        // the inside is the side to which the normal of the edge points
        let edges = [((1.0, 0.0), left), ((-1.0, 0.0), -right), ((0.0, 1.0), top), ((0.0, -1.0), -bottom)];
        edges.into_iter().fold(points, |points, (normal, edge)| {
            let depth = |at: Point| normal.0 * at.0 + normal.1 * at.1 - edge;
            let mut inside = Vec::new();
            for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
                let (before, after) = (depth(*a), depth(*b));
                if before >= 0.0 {
                    inside.push(*a);
                }
                if before * after < 0.0 {
                    let share = before / (before - after);
                    inside.push((a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1)));
                }
            }
            inside
        })
    }

    /// The parts of a line that lie inside.
    pub fn parts(self, points: &[Point]) -> Vec<Vec<Point>> {
        let mut parts: Vec<Vec<Point>> = Vec::new();
        let mut end = None;
        for pair in points.windows(2) {
            let Some((from, to)) = self.clip(pair[0], pair[1]) else {
                end = None;
                continue;
            };
            match parts.last_mut().filter(|_| end == Some(from)) {
                Some(part) => part.push(to),
                None => parts.push(vec![from, to]),
            }
            end = Some(to);
        }
        parts
    }

    /// The part of the segment from `a` to `b` that lies inside (Liang and Barsky 1984).
    pub fn clip(self, a: Point, b: Point) -> Option<(Point, Point)> {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let edges =
            [(-dx, a.0 - self.left), (dx, self.right - a.0), (-dy, a.1 - self.top), (dy, self.bottom - a.1)];
        for (towards, room) in edges {
            if !(towards.is_finite() && room.is_finite()) || (towards == 0.0 && room < 0.0) {
                return None;
            }
            if towards < 0.0 {
                enter = enter.max(room / towards);
            } else if towards > 0.0 {
                leave = leave.min(room / towards);
            }
        }
        let at = |share: f64| (a.0 + share * dx, a.1 + share * dy);
        // ends inside are kept bit for bit, since the next segment begins there
        let (from, to) = (if enter > 0.0 { at(enter) } else { a }, if leave < 1.0 { at(leave) } else { b });
        (enter <= leave).then_some((from, to))
    }
}

/// The point of a text that is at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// At its beginning.
    Left,
    /// In its middle.
    Centre,
    /// At its end.
    Right,
}

/// Largest number of dashes of a line.
const MAX_DASHES: f64 = 400.0;

/// A line of text.
#[derive(Debug, Clone, PartialEq)]
pub struct Text {
    /// The text.
    pub words: String,
    /// Position on the canvas; the vertical one is that of the baseline.
    pub at: Point,
    /// Height of an em.
    pub size: f64,
    /// Colour.
    pub ink: Ink,
    /// Heavier letters.
    pub bold: bool,
    /// The point of the text that is at `at`.
    pub align: Align,
    /// Whether it reads upwards.
    pub upright: bool,
}

impl Text {
    /// Plain words that begin at a place.
    pub fn new(words: impl Into<String>, at: Point, size: f64, ink: Ink) -> Self {
        Self { words: words.into(), at, size, ink, bold: false, align: Align::Left, upright: false }
    }

    /// The same text with its beginning, middle or end at its position.
    pub fn aligned(self, align: Align) -> Self {
        Self { align, ..self }
    }

    /// Length of the text before its position.
    pub fn before(&self) -> f64 {
        match self.align {
            Align::Left => 0.0,
            Align::Centre => 0.5 * font::width(&self.words, self.size, self.bold),
            Align::Right => font::width(&self.words, self.size, self.bold),
        }
    }
}

/// One shape.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A filled rectangle.
    Rect(Area, Ink),
    /// A line through points, with round ends and corners.
    Line(Vec<Point>, f64, Ink),
    /// A filled convex polygon.
    Polygon(Vec<Point>, Ink),
    /// A filled disc.
    Disc(Point, f64, Ink),
    /// A text.
    Text(Text),
}

/// A picture laid out as plain shapes, which [`Format::bytes`](super::Format::bytes) paints.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// The shapes in the order in which they are painted.
    pub shapes: Vec<Shape>,
    /// The whole canvas.
    pub canvas: Area,
    /// The part of the canvas that is painted.
    pub shown: Area,
    /// Width and height in pixels; by default one pixel per unit of the canvas. The painted part keeps its
    /// proportions and is centred.
    pub size: Option<(u32, u32)>,
    /// The sheet of paper for which it is laid out; `None` for a screen.
    pub sheet: Option<Sheet>,
    /// Its provenance: names and values, as in a manifest.
    pub origin: Map<String, Value>,
    /// The drawn data, one row per point, cell or mark, with its kind in the column `series`.
    pub data: Table,
    /// The frames of its panels, without those of surfaces.
    pub frames: Vec<Frame>,
    /// The frame of a surface.
    pub surface: Option<SurfaceFrame>,
    /// The entries of its legend with their places.
    pub legend: Vec<(Area, String)>,
    /// Upper and lower edge of the part between the captions.
    body: (f64, f64),
}

impl Figure {
    /// An empty canvas of this width and height, with captions over and under the `body`.
    pub fn new(theme: &Theme, (width, height): (f64, f64), body: (f64, f64)) -> Self {
        let canvas = Area::new(0.0, 0.0, width, height);
        Self {
            shapes: vec![Shape::Rect(canvas, theme.paper)],
            canvas,
            shown: canvas,
            size: None,
            sheet: theme.sheet,
            body,
            origin: Map::new(),
            frames: Vec::new(),
            surface: None,
            legend: Vec::new(),
            data: Table::new(),
        }
    }

    /// The picture without its captions, for a page that has its own caption.
    #[must_use]
    pub fn without_title(mut self) -> Self {
        (self.shown.top, self.shown.bottom) = self.body;
        let shown = self.shown;
        self.shapes.retain_mut(|shape| match shape {
            Shape::Text(text) => (shown.top..=shown.bottom).contains(&text.at.1),
            Shape::Rect(area, _) => area.common(shown).inspect(|part| *area = *part).is_some(),
            _ => true,
        });
        self
    }

    /// A warning if the requested height is too small for the picture, which is then higher.
    pub fn grown(&self) -> Option<String> {
        let (asked, made) = (self.sheet?.height_mm?, self.size_mm()?.1);
        let words = || format!("{asked} mm are too low; the picture is {} mm high", short(made));
        (made > asked + 1e-6).then(words)
    }

    /// Its provenance as JSON in one line.
    pub fn made(&self) -> String {
        Value::Object(self.origin.clone()).to_string()
    }

    /// Program and version that made it.
    pub fn software(&self) -> String {
        let word = |key: &str| self.origin.get(key).and_then(Value::as_str).unwrap_or_default();
        format!("{} {}", word("program"), word("version"))
    }

    /// Width and height in mm of the shown part, on a sheet.
    pub fn size_mm(&self) -> Option<(f64, f64)> {
        let unit = self.sheet?.unit_mm();
        Some(((self.shown.right - self.shown.left) * unit, (self.shown.bottom - self.shown.top) * unit))
    }

    /// Adds a filled rectangle; what lies outside the canvas is cut off.
    pub fn rect(&mut self, area: Area, ink: Ink) {
        if let Some(area) = area.common(self.canvas) {
            self.shapes.push(Shape::Rect(area, ink));
        }
    }

    /// Adds a line; parts outside `within` and points that are not finite are left out.
    pub fn line(&mut self, points: &[Point], width: f64, ink: Ink, within: Area) {
        for part in within.parts(points) {
            self.shapes.push(Shape::Line(part, width, ink));
        }
    }

    /// Adds a broken line with dashes and gaps of the given lengths, longer ones in a line of very many.
    pub fn dashed(&mut self, points: &[Point], width: f64, ink: Ink, (on, off): (f64, f64), within: Area) {
        for part in within.parts(points) {
            let lengths = part.windows(2).map(|pair| distance(pair[0], pair[1]));
            let length: f64 = lengths.sum();
            let longer = (length / (MAX_DASHES * (on + off))).max(1.0);
            for piece in dashes(&part, (on * longer, off * longer)) {
                self.shapes.push(Shape::Line(piece, width, ink));
            }
        }
    }

    /// Adds a line as it looks: its dash, and the outline under it. A line with an outline keeps half of its
    /// width from the edges, so that its round ends do not stand out.
    pub fn styled(&mut self, points: &[Point], look: &Look, within: Area) {
        let Some(halo) = look.halo else { return self.plain(points, look, within) };
        let (width, Area { left, top, right, bottom }) = (look.width + 4.0, within);
        let half = 0.5 * width;
        let inwards =
            |(x, y): Point| (x.max(left + half).min(right - half), y.max(top + half).min(bottom - half));
        let parts = within.parts(points).into_iter().map(|part| part.into_iter().map(inwards).collect());
        let parts: Vec<Vec<Point>> = parts.collect();
        parts.iter().for_each(|part| self.line(part, width, halo, within));
        parts.iter().for_each(|part| self.plain(part, look, within));
    }

    /// Adds a line with its dash.
    fn plain(&mut self, points: &[Point], look: &Look, within: Area) {
        match look.dash {
            Some(dash) => self.dashed(points, look.width, look.ink, dash, within),
            None => self.line(points, look.width, look.ink, within),
        }
    }

    /// Adds a filled convex polygon where all of it lies on the canvas.
    pub fn polygon(&mut self, points: Vec<Point>, ink: Ink) {
        if points.iter().all(|point| self.canvas.contains(*point)) {
            self.shapes.push(Shape::Polygon(points, ink));
        }
    }

    /// Adds a filled disc where its centre lies on the canvas.
    pub fn disc(&mut self, centre: Point, radius: f64, ink: Ink) {
        if self.canvas.contains(centre) {
            self.shapes.push(Shape::Disc(centre, radius, ink));
        }
    }

    /// Adds a text; control characters become blanks.
    pub fn text(&mut self, mut text: Text) {
        text.words = text.words.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        if self.canvas.contains(text.at) && !text.words.trim().is_empty() {
            self.shapes.push(Shape::Text(text));
        }
    }

    /// Adds the outline of `area`.
    pub fn outline(&mut self, area: Area, width: f64, ink: Ink) {
        let Area { left, top, right, bottom } = area;
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
        self.line(&corners, width, ink, self.canvas);
    }

    /// Fills `area`, and hatches it with lines that rise to the right.
    pub fn filled(&mut self, area: Area, ink: Ink, hatch: Option<Ink>) {
        self.rect(area, ink);
        self.hatched(area, hatch);
    }

    /// Hatches `area`, where there is a hatching, with lines that rise to the right.
    pub fn hatched(&mut self, area: Area, hatch: Option<Ink>) {
        if let Some(hatch) = hatch {
            self.hatch(area, hatch, 1.0);
        }
    }

    /// Fills `area` with the sign of a missing value, lines that fall to the right.
    pub fn missing(&mut self, area: Area, theme: &Theme) {
        self.rect(area, theme.paper);
        self.hatch(area, theme.soft, -1.0);
    }

    /// Hatches `area` with lines x + `sign` y = k step, aligned with all other hatchings.
    fn hatch(&mut self, area: Area, ink: Ink, sign: f64) {
        let Some(area @ Area { left, top, right, bottom }) = area.common(self.canvas) else { return };
        let (step, width) = style::HATCH;
        let (low, high) = if sign > 0.0 { (top, bottom) } else { (-bottom, -top) };
        for k in ((left + low) / step).ceil() as i64..=((right + high) / step).floor() as i64 {
            let sum = k as f64 * step;
            self.line(&[(sum - sign * top, top), (sum - sign * bottom, bottom)], width, ink, area);
        }
    }

    /// All texts of the picture.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        self.shapes.iter().filter_map(|shape| match shape {
            Shape::Text(text) => Some(text.words.as_str()),
            _ => None,
        })
    }
}

/// The distance from one point to another.
pub fn distance(from: Point, to: Point) -> f64 {
    elementary::hypot(to.0 - from.0, to.1 - from.1)
}

/// A polygon with a fixed orientation, so that overlapping parts of a path leave no hole.
pub(super) fn oriented(points: &[Point]) -> Cow<'_, [Point]> {
    let ends = points.iter().zip(points.iter().cycle().skip(1));
    let area: f64 = ends.map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum();
    if area < 0.0 { points.iter().rev().copied().collect() } else { points.into() }
}

/// A line cut into dashes.
fn dashes(points: &[Point], (on, off): (f64, f64)) -> Vec<Vec<Point>> {
    let mut pieces = Vec::new();
    let mut piece: Vec<Point> = points.first().copied().into_iter().collect();
    let (mut drawing, mut left) = (true, on);
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = distance(from, to);
            if length <= left {
                left -= length;
                if drawing {
                    piece.push(to);
                }
                break;
            }
            let share = left / length;
            from = (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
            if drawing {
                piece.push(from);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![from];
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
    }
    if drawing && piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_path_are_inside_and_join_where_it_stays_inside() {
        let area = Area::new(0.0, -1.0, 4.0, 1.0);
        let path =
            [(-1.0, 0.0), (1.0, 0.0), (2.0, 0.5), (3.0, 1e30), (3.0, -1e30), (3.5, f64::NAN), (9.0, 0.0)];
        let parts = area.parts(&path);
        let ends: Vec<(f64, f64, usize)> =
            parts.iter().map(|part| (part[0].0, part[part.len() - 1].0, part.len())).collect();
        assert_eq!(ends, [(0.0, 2.0, 4), (3.0, 3.0, 2)]);
        assert!(parts.concat().iter().all(|point| point.1.abs() <= 1.0 + 1e-9));
    }
}
