//! Frame with two axes, and the layers that it shows.

use super::axis::PlotAxis;
use super::cells::{Colours, Shade, Shades};
use super::chart::{Layer, Marks, Side};
use super::figure::{Align, Area, Figure, Point, Shape, Text, distance};
use super::mark::{REGIMES, dot, mark, marker};
use super::page::wrapped;
use super::role::{Look, Role};
use super::style::{self, Ink, Theme};
use super::thinned::{extremes, once, thinned};
use super::{font, labels};
use crate::numeric::elementary;

/// Half the size of the points of a cloud of few points, and of one of many.
const CLOUD: (f64, f64) = (6.0, 2.2);
/// Half the height of a marker in the colour of its value.
const VALUED: f64 = 3.0;
/// Number of points up to which a cloud has few.
const FEW: f64 = 100.0;
/// Number of points from which on it has many.
const MANY: f64 = 2000.0;
/// Length of a tick of a layer.
const TICK: f64 = 20.0;
/// Smallest distance of two such ticks.
const APART: f64 = 4.5;

/// Smallest distance of the numbers on a vertical axis.
const MIN_DISTANCE: f64 = 24.0;

/// Smallest distance of markers on a line, in multiples of half their height.
const MARKER_ROOM: f64 = 5.0;

/// Distance of the symbols over a map.
const SYMBOLS: f64 = 104.0;
/// Distance around a symbol within which all cells must be of its kind.
const AROUND: f64 = 20.0;

/// Half the size of one of many markers, as a share of the width over their number.
const SIZE_SHARE: f64 = 0.3;
/// Smallest half size of a marker.
const SMALLEST: f64 = 3.5;

/// A rectangle of the canvas with a horizontal and a vertical axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Its place on the canvas.
    pub area: Area,
    /// The horizontal axis.
    pub x: PlotAxis,
    /// The vertical axis.
    pub y: PlotAxis,
}

impl Frame {
    /// Horizontal position of a value of x on the canvas.
    pub fn across(&self, x: f64) -> f64 {
        self.area.left + self.x.share(x) * (self.area.right - self.area.left)
    }

    /// Vertical position of a value of y on the canvas.
    pub fn down(&self, y: f64) -> f64 {
        self.area.bottom - self.y.share(y) * (self.area.bottom - self.area.top)
    }

    /// Position of a pair of values on the canvas; values that are not finite are kept.
    pub fn place(&self, (x, y): Point) -> Point {
        let finite = |value: f64, place: f64| if value.is_finite() { place } else { f64::NAN };
        (finite(x, self.across(x)), finite(y, self.down(y)))
    }

    /// The shapes of layers over it, on a canvas of its size.
    pub fn shapes(&self, layers: &[Layer], theme: &Theme) -> Vec<Shape> {
        let Area { right, bottom, .. } = self.area;
        let mut figure = Figure::new(theme, (right, bottom), (0.0, bottom));
        figure.shapes.clear();
        layers.iter().for_each(|layer| self.layer(&mut figure, layer, theme));
        figure.shapes
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

    /// The frame with its ticks over everything else, and with their numbers if they are shown. Those of the
    /// vertical axis fit into this width; long words are wrapped, dense ones are smaller.
    pub fn ticks(&self, figure: &mut Figure, theme: &Theme, shows_x: bool, numbers: Option<f64>) {
        let Area { left, bottom, .. } = self.area;
        figure.outline(self.area, style::FRAME, theme.ink);
        let ascent = style::TICK * font::CAPITAL;
        let text =
            |words: &str, at: Point, align| Text::new(words, at, style::TICK, theme.ink).aligned(align);
        let (numbered, size) = self.numbered();
        for (i, (value, words)) in self.x.ticks.iter().enumerate() {
            let at = self.across(*value);
            let tick = [(at, bottom), (at, bottom + style::TICK_LENGTH)];
            figure.line(&tick, style::FRAME, theme.ink, figure.canvas);
            if shows_x && numbered(i) {
                // at the edge of the canvas a number is shifted inwards
                let half = 0.5 * font::width(words, size, false) + 2.0;
                let at = at.min(figure.canvas.right - half).max(half);
                let place = (at, bottom + style::TICK_LENGTH + ascent + 8.0);
                figure.text(Text { size, ..text(words, place, Align::Centre) });
            }
        }
        let places: Vec<f64> = self.y.ticks.iter().map(|tick| self.down(tick.0)).collect();
        let apart = places.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(f64::INFINITY, f64::min);
        // in a low frame some ticks have no number
        let least = if self.y.is_scale() { MIN_DISTANCE } else { 0.0 };
        let every = (least / apart).ceil().clamp(1.0, 50.0) as usize;
        let zero = self.y.ticks.iter().position(|tick| tick.0 == 0.0).unwrap_or(0);
        let apart = apart * every as f64;
        for (i, (at, (_, words))) in places.iter().zip(&self.y.ticks).enumerate() {
            let tick = [(left - style::TICK_LENGTH, *at), (left, *at)];
            figure.line(&tick, style::FRAME, theme.ink, figure.canvas);
            if let Some(room) = numbers.filter(|_| i % every == zero % every) {
                let lines = match self.y.is_scale() {
                    true => vec![words.clone()],
                    false => wrapped(words, style::TICK, false, room + 1e-6),
                };
                let widest =
                    lines.iter().map(|line| font::width(line, style::TICK, false)).fold(1.0, f64::max);
                let size = ((room / widest).min(1.0) * style::TICK).min(0.9 * apart / lines.len() as f64);
                for (line, words) in lines.iter().enumerate() {
                    let lower = (line as f64 - 0.5 * (lines.len() - 1) as f64) * 1.1 * size;
                    let place = (left - style::TICK_LENGTH - 7.0, at + lower + 0.5 * size * font::CAPITAL);
                    figure.text(Text { size, ..text(words, place, Align::Right) });
                }
            }
        }
    }

    /// Which ticks of the horizontal axis have a number, as many as have room, including 0; and the size of
    /// the numbers. Words all stand there, smaller where they need it.
    fn numbered(&self) -> (impl Fn(usize) -> bool + use<>, f64) {
        const BETWEEN: f64 = 16.0;
        let half = |words: &str| 0.5 * font::width(words, style::TICK, false);
        let ticks = self.x.ticks.iter().map(|(value, words)| (self.across(*value), half(words)));
        let ticks: Vec<(f64, f64)> = ticks.collect();
        let zero = self.x.ticks.iter().position(|tick| tick.0 == 0.0).unwrap_or(0);
        let apart = |every: &usize| {
            let kept: Vec<_> = ticks.iter().skip(zero % every).step_by(*every).collect();
            kept.windows(2).all(|pair| pair[1].0 - pair[0].0 >= pair[0].1 + pair[1].1 + BETWEEN)
        };
        let every = (1..=ticks.len().max(1)).find(apart).unwrap_or(1);
        let room = |pair: &[(f64, f64)]| (pair[1].0 - pair[0].0) / (pair[0].1 + pair[1].1 + BETWEEN);
        let (every, share) = match self.x.is_scale() {
            true => (every, 1.0),
            false => (1, ticks.windows(2).map(room).fold(1.0, f64::min)),
        };
        (move |i| i % every == zero % every, share * style::TICK)
    }

    /// Draws a layer.
    pub fn layer(&self, figure: &mut Figure, layer: &Layer, theme: &Theme) {
        let look = theme.look(layer.role);
        let Area { left, top, right, bottom } = self.area;
        match &layer.marks {
            Marks::Path(points) => self.path(figure, points, &look),
            Marks::Trace(points) => self.trace(figure, points, &look),
            Marks::Points(points) => {
                let mut places = self.inside(points);
                once(&mut places);
                let room = SIZE_SHARE * (right - left) / places.len().max(1) as f64;
                let size = look.size.min(room.max(SMALLEST));
                places.into_iter().for_each(|at| mark(figure, &look, at, size, theme));
            }
            Marks::Regimes(points, on_line) => self.regimes(figure, points, *on_line, theme),
            Marks::Cloud(points) => self.cloud(figure, points, &look, theme),
            Marks::Valued(points, colours) => {
                for (point, value) in points {
                    for at in self.inside(&[*point]) {
                        dot(figure, look.marker, at, VALUED + 0.8, theme.paper);
                        dot(figure, look.marker, at, VALUED, colours.ink(*value, theme));
                    }
                }
            }
            Marks::Sticks(points) => self.sticks(figure, points, &look),
            Marks::Intervals(rows) => {
                for [x, low, high] in rows {
                    // an unknown end lies outside the picture
                    let end = |y: &f64, edge: f64| if y.is_finite() { self.down(*y) } else { edge };
                    let at = self.across(*x);
                    figure.styled(&[(at, end(low, bottom)), (at, end(high, top))], &look, self.area);
                }
            }
            Marks::Band(rows) => self.band(figure, rows, &look),
            Marks::Bars(rows, share) => {
                let half = 0.5 * share * self.height_of_one();
                for [y, from, to] in rows.iter().filter(|row| row[0].is_finite()) {
                    let at = self.down(*y);
                    let [from, to] = [from, to].map(|x| self.across(*x).clamp(left, right));
                    let bar = Area::new(from, at - half, to.max(from + 2.0), at + half);
                    self.fill(figure, bar, &look);
                }
            }
            Marks::Spans(spans) => self.spans(figure, spans, layer.role, theme),
            Marks::Verticals(values) => {
                for at in values.iter().map(|x| self.across(*x)).filter(|at| at.is_finite()) {
                    figure.styled(&[(at, bottom), (at, top)], &look, self.area);
                }
            }
            Marks::Horizontals(values) => {
                for at in values.iter().map(|y| self.down(*y)).filter(|at| at.is_finite()) {
                    figure.styled(&[(left, at), (right, at)], &look, self.area);
                }
            }
            Marks::Wall(at, side) => self.wall(figure, *at, *side, &look, theme),
            Marks::Ticks(values, side) => {
                let [edge, inner] = match side {
                    Side::Top => [top, top + TICK],
                    _ => [bottom, bottom - TICK],
                };
                let mut last = f64::NEG_INFINITY;
                for at in values.iter().map(|x| self.across(*x)) {
                    if at - last >= APART || at < last {
                        figure.line(&[(at, edge), (at, inner)], look.width.min(2.4), look.ink, self.area);
                        last = at;
                    }
                }
            }
            Marks::Words(places) => {
                for (point, words) in places {
                    let size = style::FOOTER.min(0.95 * self.height_of_one());
                    let at = labels::beside(figure, self.area, self.place(*point), words, size);
                    if let Some(at) = at {
                        figure.text(Text::new(words, at, size, theme.ink));
                    }
                }
            }
            Marks::Cells(cells) => self.cells(figure, cells, theme),
            Marks::Mechanism(assembly) => assembly.draw(figure, self, theme),
            Marks::Surface(..) | Marks::Patch => {}
        }
    }

    /// The points that lie inside, on the canvas.
    fn inside(&self, points: &[Point]) -> Vec<Point> {
        points.iter().map(|point| self.place(*point)).filter(|at| self.area.contains(*at)).collect()
    }

    /// The height of 1 upward.
    fn height_of_one(&self) -> f64 {
        (self.area.bottom - self.area.top) / (self.y.high - self.y.low)
    }

    fn fill(&self, figure: &mut Figure, area: Area, look: &Look) {
        if let Some(area) = area.common(self.area) {
            figure.filled(area, look.ink, look.hatch);
        }
    }

    /// A line through data in any order. Points closer than a part of a pixel to the last kept one are left
    /// out.
    fn path(&self, figure: &mut Figure, points: &[Point], look: &Look) {
        const NEAR: f64 = 0.35;
        self.stretches(figure, points, look, |part| {
            let mut kept: Vec<Point> = Vec::new();
            for place in part {
                if kept.last().is_none_or(|last: &Point| distance(*place, *last) > NEAR) {
                    kept.push(*place);
                }
            }
            kept.extend(part.last());
            kept
        });
    }

    /// A line through data with ascending x: in each pixel column the first, smallest, largest and last
    /// points are kept, which cover the same pixels as all points.
    fn trace(&self, figure: &mut Figure, points: &[Point], look: &Look) {
        self.stretches(figure, points, look, |part| {
            part.chunk_by(|a, b| a.0.floor() == b.0.floor()).flat_map(extremes).collect()
        });
    }

    /// The points that are `kept` of each stretch of a line between two gaps. A single point becomes a dash.
    fn stretches(
        &self,
        figure: &mut Figure,
        points: &[Point],
        look: &Look,
        kept: impl Fn(&[Point]) -> Vec<Point>,
    ) {
        const DASH: f64 = 4.0;
        let places: Vec<Point> = points.iter().map(|point| self.place(*point)).collect();
        for part in places.split(|(x, y)| !(x.is_finite() && y.is_finite())) {
            match part {
                [] => {}
                [(x, y)] => {
                    figure.line(&[(x - DASH, *y), (x + DASH, *y)], look.width, look.ink, self.area);
                }
                _ => figure.styled(&kept(part), look, self.area),
            }
        }
    }

    /// Close markers on a line are left out; otherwise each is shown, and many are smaller.
    fn regimes(&self, figure: &mut Figure, points: &[(Point, &'static str)], on_line: bool, theme: &Theme) {
        let placed = points.iter().map(|(point, word)| (self.place(*point), *word));
        let marks: Vec<(Point, &str)> = placed.filter(|mark| self.area.contains(mark.0)).collect();
        let usual = 0.8 * style::MARKER;
        let (marks, size) = match on_line {
            true => (thinned(&marks, MARKER_ROOM * usual, 1.5 * usual), usual),
            false => {
                let room = SIZE_SHARE * (self.area.right - self.area.left) / marks.len().max(1) as f64;
                (marks, room.clamp(SMALLEST, usual))
            }
        };
        for (at, word) in marks {
            let role = REGIMES.iter().position(|regime| regime.0 == word).map_or(Role::Motion, Role::Regime);
            let look = theme.look(role);
            marker(figure, look.marker, at, size, look.ink, if size < 6.0 { theme.paper } else { theme.ink });
        }
    }

    fn cloud(&self, figure: &mut Figure, points: &[Point], look: &Look, theme: &Theme) {
        let mut places = self.inside(points);
        once(&mut places);
        let many = (elementary::ln(places.len() as f64 / FEW) / elementary::ln(MANY / FEW)).clamp(0.0, 1.0);
        let size = CLOUD.0 + many * (CLOUD.1 - CLOUD.0);
        for at in places {
            if look.hollow {
                // leaves room for a marker of another layer in its middle
                dot(figure, look.marker, at, 2.0 * size, look.ink);
                dot(figure, look.marker, at, 1.35 * size, theme.paper);
                continue;
            }
            if look.halo.is_some() {
                dot(figure, look.marker, at, size + 0.6, theme.soft);
            }
            dot(figure, look.marker, at, size, look.ink);
        }
    }

    /// Only the highest line in each pixel is kept.
    fn sticks(&self, figure: &mut Figure, points: &[Point], look: &Look) {
        let placed = points.iter().filter(|point| point.1 > self.y.low).map(|point| self.place(*point));
        let mut highest: Vec<Point> = Vec::new();
        for (x, y) in placed.filter(|place| place.1.is_finite()) {
            match highest.last_mut() {
                Some(last) if x - last.0 < 1.0 => last.1 = last.1.min(y),
                _ => highest.push((x, y)),
            }
        }
        for (x, y) in highest {
            figure.line(&[(x, self.area.bottom), (x, y)], look.width, look.ink, self.area);
        }
    }

    /// The area between two lines over x, where both have values; the lines may cross.
    fn band(&self, figure: &mut Figure, rows: &[[f64; 3]], look: &Look) {
        let mut fill = |corners: Vec<Point>| {
            let inside = self.area.clip_polygon(corners);
            if inside.len() > 2 {
                figure.polygon(inside, look.ink);
            }
        };
        for pair in rows.windows(2) {
            let [a, b] =
                [pair[0], pair[1]].map(|[x, low, high]| (self.place((x, low)), self.place((x, high))));
            if ![a.0, a.1, b.0, b.1].iter().all(|(x, y)| x.is_finite() && y.is_finite()) {
                continue;
            }
            let (before, after) = (a.0.1 - a.1.1, b.0.1 - b.1.1);
            if before * after < 0.0 {
                let share = before / (before - after);
                let mix = |p: f64, q: f64| p + share * (q - p);
                let meet = (mix(a.0.0, b.0.0), mix(a.0.1, b.0.1));
                fill(vec![a.0, meet, a.1]);
                fill(vec![b.0, meet, b.1]);
            } else {
                fill(vec![a.0, b.0, b.1, a.1]);
            }
        }
    }

    /// Shaded spans; neighbours closer than a part of a pixel are joined.
    fn spans(&self, figure: &mut Figure, spans: &[(f64, f64)], role: Role, theme: &Theme) {
        let mut merged: Vec<(f64, f64)> = Vec::new();
        for (left, right) in spans.iter().map(|(from, to)| (self.across(*from), self.across(*to))) {
            match merged.last_mut() {
                Some(last) if left - last.1 < 0.7 => last.1 = last.1.max(right),
                _ => merged.push((left, right)),
            }
        }
        for (left, right) in merged {
            if let Some(area) = Area::new(left, self.area.top, right, self.area.bottom).common(self.area) {
                match role {
                    Role::Missing => figure.missing(area, theme),
                    role => figure.rect(area, theme.look(role).ink),
                }
            }
        }
    }

    /// A wall extends to the edge of the frame if that is near.
    fn wall(&self, figure: &mut Figure, at: f64, side: Side, look: &Look, theme: &Theme) {
        let Area { left, top, right, bottom } = self.area;
        let thickness = |room: f64| if room < 3.0 * style::WALL { room } else { style::WALL };
        let is_upright = matches!(side, Side::Left | Side::Right);
        let (at, least, most) =
            if is_upright { (self.across(at), left, right) } else { (self.down(at), top, bottom) };
        let (from, to) = match side {
            Side::Left | Side::Top => (at - thickness(at - least), at),
            Side::Right | Side::Bottom => (at, at + thickness(most - at)),
        };
        let (solid, line) = match is_upright {
            true => (Area::new(from, top, to, bottom), [(at, top), (at, bottom)]),
            false => (Area::new(left, from, right, to), [(left, at), (right, at)]),
        };
        let filled = Look { ink: theme.wall_fill(), ..*look };
        self.fill(figure, solid, &filled);
        figure.line(&line, look.width, look.ink, self.area);
    }

    /// A cell reaches under its neighbours to the right and above, which are painted over it, so that the
    /// background does not show between two of them, whatever paints their edges.
    fn cells(&self, figure: &mut Figure, grid: &Shades, theme: &Theme) {
        let (columns, rows) = (grid.across.values.len(), grid.up.values.len());
        let is_painted = |column: usize, row: usize| {
            column < columns && row < rows && grid.at(column, row) != Shade::Blank
        };
        for column in 0..columns {
            let with_right = |row: usize| (grid.at(column, row), is_painted(column + 1, row));
            let all: Vec<(Shade, bool)> = (0..rows).map(with_right).collect();
            let mut row = 0;
            for run in all.chunk_by(|a, b| a == b) {
                let (first, above) = (row, row + run.len());
                row = above;
                let ((cell, aside), rises) = (run[0], is_painted(column, above));
                // of three neighbours the one in the corner may not be painted
                let is_bare = aside && rises && !is_painted(column + 1, above);
                let place = |aside: bool, rises: bool| {
                    let right = column + 1 + usize::from(aside);
                    let across = [column, right].map(|edge| self.across(grid.across.edges[edge]));
                    let top = above + usize::from(rises);
                    let down = [first, top].map(|edge| self.down(grid.up.edges[edge]));
                    Area::new(across[0], down[1], across[1], down[0]).common(self.area)
                };
                let Some(area) = place(false, false) else { continue };
                let mut fill = |ink: Ink, hatch: Option<Ink>| {
                    let corner = if is_bare { place(false, true) } else { None };
                    let grounds = [place(aside, rises && !is_bare), corner];
                    grounds.into_iter().flatten().for_each(|ground| figure.rect(ground, ink));
                    figure.hatched(area, hatch);
                };
                match cell {
                    Shade::Value(value) => {
                        fill(grid.colours.ink(value, theme), grid.colours.hatch(value, theme));
                    }
                    Shade::Rest => fill(theme.rest, Some(theme.rest_hatch)),
                    Shade::Missing => figure.missing(area, theme),
                    Shade::Blank => {}
                }
            }
        }
        self.symbols(figure, grid, theme);
    }

    /// Markers of the regimes at intervals, so that colour is not the only sign of them.
    fn symbols(&self, figure: &mut Figure, grid: &Shades, theme: &Theme) {
        let Colours::Categories(kinds) = &grid.colours else { return };
        let Area { left, top, right, bottom } = self.area;
        let role = |(x, y): Point| {
            let across = self.x.low + (x - left) / (right - left) * (self.x.high - self.x.low);
            let up = self.y.low + (bottom - y) / (bottom - top) * (self.y.high - self.y.low);
            let value = grid.at(grid.across.cell(across)?, grid.up.cell(up)?).value()?;
            kinds.get(value as usize).map(|kind| kind.0).filter(|role| matches!(role, Role::Regime(_)))
        };
        let count = |length: f64| (length / SYMBOLS) as usize;
        for i in 0..count(right - left) * count(bottom - top) {
            let (column, row) = (i % count(right - left), i / count(right - left));
            let at @ (x, y) = (left + (column as f64 + 0.5) * SYMBOLS, top + (row as f64 + 0.5) * SYMBOLS);
            let Some(of) = role(at) else { continue };
            let around = [(x - AROUND, y), (x + AROUND, y), (x, y - AROUND), (x, y + AROUND)];
            if around.into_iter().all(|place| role(place) == Some(of)) {
                dot(figure, theme.look(of).marker, at, style::MARKER, theme.paper);
            }
        }
    }
}
