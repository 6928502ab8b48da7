//! Cells as a surface in projection: their height and their colour are the value.

use super::axis::PlotAxis;
use super::cells::{Shade, Shades};
use super::figure::{Align, Area, Figure, Point, Text, distance};
use super::font;
use super::page::{Lines, wrapped};
use super::projection::{AXIS_EDGES, BACK_EDGES, BoxPlace, Face, SIDES, faces, placed, wall_lines};
use super::style::{self, Ink, Theme, viridis};

/// Largest number of cells that are drawn as faces.
pub const MAX_SURFACE_CELLS: u64 = 60_000;

/// Room for the numbers left and right of the box.
const BESIDE: (f64, f64) = (130.0, 30.0);
/// Room below the box for the numbers, and with a line of the labels.
const UNDER: (f64, f64) = (70.0, 100.0);
/// Distance of the two labels below the box.
const BETWEEN: f64 = 24.0;
/// Height of a further line of a label.
const LINE: f64 = 38.0;
/// Distance of a label from the box below it.
const GAP: f64 = 14.0;
/// Length by which the label of the height may be longer than its axis.
const BEYOND: f64 = 40.0;

/// The labels of the three axes in lines, all of the full size.
#[derive(Default)]
pub struct Labels {
    x: Lines,
    y: Lines,
    /// That of the height in lines above the box; none if it stands upright beside its axis.
    z: Lines,
}

impl Labels {
    /// The labels of these axes about a box in an area of this width and height.
    pub fn new([x, y, z]: [&PlotAxis; 3], (width, height): (f64, f64)) -> Self {
        let view = SurfaceFrame::within(Area::new(0.0, 0.0, width, height), [x, y, z]);
        let [right, left] = [RIGHT, LEFT].map(|at| view.place(at));
        let lines = |axis: &PlotAxis, room: f64| Lines {
            lines: wrapped(&axis.label, style::AXIS, false, room),
            size: style::AXIS,
        };
        let upright = left.1 - view.place((0.0, 1.0, 1.0)).1 + BEYOND;
        let fits = font::width(&z.label, style::AXIS, false) <= upright;
        let z = if fits { Lines::default() } else { lines(z, width) };
        // both stand below the same edge of the canvas
        let half = 0.5 * (right.0 - left.0) - BETWEEN;
        Self { x: lines(x, half), y: lines(y, half), z }
    }

    /// The room that they take above and below the box.
    pub fn room(&self) -> (f64, f64) {
        let below = self.x.lines.len().max(self.y.lines.len()).max(1);
        (self.z.across(LINE), UNDER.1 + LINE * (below - 1) as f64)
    }
}

/// The corners of the floor at which the axes begin and end.
const NEAR: BoxPlace = (0.0, 0.0, 0.0);
const RIGHT: BoxPlace = (1.0, 0.0, 0.0);
const LEFT: BoxPlace = (0.0, 1.0, 0.0);

/// A box in projection with three axes: to the right, to the back and upward.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFrame {
    /// The rectangle that it fills.
    pub area: Area,
    /// The axis to the right.
    pub x: PlotAxis,
    /// The axis to the back.
    pub y: PlotAxis,
    /// The axis upward.
    pub z: PlotAxis,
}

impl SurfaceFrame {
    /// The box with these axes in an area with its numbers.
    fn within(Area { left, top, right, bottom }: Area, [x, y, z]: [&PlotAxis; 3]) -> Self {
        let area = Area::new(left + BESIDE.0, top, right - BESIDE.1, bottom);
        Self { area, x: x.with_ticks(6), y: y.with_ticks(6), z: z.with_ticks(5) }
    }

    /// Position on the canvas of a point in the box, with coordinates from 0 to 1.
    fn place(&self, at: BoxPlace) -> Point {
        placed(self.area, at)
    }

    /// Position on the canvas of values of the three axes.
    pub fn point(&self, (x, y, z): (f64, f64, f64)) -> Point {
        self.place((self.x.share(x), self.y.share(y), self.z.share(z)))
    }

    /// The column and row of the cell of the frontmost face at a point of the canvas whose value is nearest
    /// to that point.
    pub fn cell_at(&self, cells: &Shades, at: Point) -> Option<(usize, usize)> {
        let is_inside = |corners: [Point; 3]| {
            let side = |i: usize| {
                let (from, to) = (corners[i], corners[(i + 1) % 3]);
                (to.0 - from.0) * (at.1 - from.1) - (to.1 - from.1) * (at.0 - from.0)
            };
            let sides = [0, 1, 2].map(side);
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        };
        self.faces(cells).iter().rev().find_map(|face| {
            let corners = face.corners.map(|corner| self.place(corner));
            let under = [[0, 1, 2], [0, 2, 3]].iter().any(|three| is_inside(three.map(|i| corners[i])));
            let distance = |i: &usize| distance(at, corners[*i]);
            let nearest = (0..4).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            let step = [(0, 0), (1, 0), (1, 1), (0, 1)][nearest];
            under.then_some((face.cell.0 + step.0, face.cell.1 + step.1))
        })
    }

    /// The faces over the cells that lie within the axes, the farthest first; none where one of the four
    /// values is missing.
    fn faces(&self, cells: &Shades) -> Vec<Face> {
        let shares = |values: &[f64], axis: &PlotAxis| {
            values.iter().map(|value| axis.share(*value)).collect::<Vec<_>>()
        };
        let (across, up) = (shares(&cells.across.values, &self.x), shares(&cells.up.values, &self.y));
        let inside = |shares: &[f64], i: usize| (-1e-9..=1.0 + 1e-9).contains(&shares[i]);
        let height = |column: usize, row: usize| {
            let height = match cells.at(column, row) {
                Shade::Missing | Shade::Blank => None,
                Shade::Rest => Some((0.0, true)),
                Shade::Value(value) => Some((value, false)),
            };
            height.filter(|_| inside(&across, column) && inside(&up, row))
        };
        faces(&across, &up, height, |value| self.z.share(value))
    }

    fn line(&self, figure: &mut Figure, (from, to): (BoxPlace, BoxPlace), width: f64, ink: Ink) {
        let canvas = figure.canvas;
        figure.line(&[self.place(from), self.place(to)], width, ink, canvas);
    }

    /// Floor and back walls with the lines of their ticks.
    fn walls(&self, figure: &mut Figure, theme: &Theme) {
        let shares = |axis: &PlotAxis| axis.ticks.iter().map(|tick| axis.share(tick.0)).collect::<Vec<_>>();
        for line in wall_lines([&self.x, &self.y, &self.z].map(shares)) {
            self.line(figure, line, style::GRID, theme.grid);
        }
        for line in BACK_EDGES {
            self.line(figure, line, style::THIN, theme.soft);
        }
    }

    /// Hatching on the floor under cells without a value.
    fn holes(&self, figure: &mut Figure, cells: &Shades, theme: &Theme) {
        let share = |axis: &PlotAxis, edge: f64| axis.share(edge).clamp(0.0, 1.0);
        for (i, x) in cells.across.edges.windows(2).enumerate() {
            for (j, y) in cells.up.edges.windows(2).enumerate() {
                if cells.at(i, j) != Shade::Missing {
                    continue;
                }
                let [left, right] = [x[0], x[1]].map(|x| share(&self.x, x));
                let [near, far] = [y[0], y[1]].map(|y| share(&self.y, y));
                let (across, back) = (0.5 * (left + right), 0.5 * (near + far));
                let lines = [
                    ((left, back), (across, near)),
                    ((left, far), (right, near)),
                    ((across, far), (right, back)),
                ];
                for ((u, v), (to_u, to_v)) in lines {
                    self.line(figure, ((u, v, 0.0), (to_u, to_v, 0.0)), style::HATCH.1, theme.soft);
                }
            }
        }
    }

    /// The edges that carry ticks, their numbers and labels.
    fn axes(&self, figure: &mut Figure, labels: &Labels, theme: &Theme) {
        for line in AXIS_EDGES {
            self.line(figure, line, style::FRAME, theme.ink);
        }
        let canvas = figure.canvas;
        let text =
            |words: &str, at: Point, size: f64, align| Text::new(words, at, size, theme.ink).aligned(align);
        let below = style::TICK * font::CAPITAL + 14.0;
        let mut row = |axis: &PlotAxis, place: &dyn Fn(f64) -> Point, align: Align, out: f64| {
            let places: Vec<Point> = axis.ticks.iter().map(|tick| place(axis.share(tick.0))).collect();
            let width = axis.widest_number();
            let apart = |every: &usize| {
                let kept: Vec<&Point> = places.iter().step_by(*every).collect();
                kept.windows(2).all(|pair| {
                    let (across, down) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
                    down.abs() >= 0.8 * style::TICK || across.abs() >= width + 12.0
                })
            };
            // as many numbers as have room
            let every = (1..=places.len()).find(apart).unwrap_or(1);
            for (i, (at, (_, words))) in places.iter().zip(&axis.ticks).enumerate() {
                figure.line(&[*at, (at.0 + 0.6 * out, at.1 + 9.0)], style::FRAME, theme.ink, canvas);
                if i % every == 0 {
                    figure.text(text(words, (at.0 + out, at.1 + below), style::TICK, align));
                }
            }
        };
        row(&self.x, &|share| self.place((share, 0.0, 0.0)), Align::Left, 10.0);
        row(&self.y, &|share| self.place((0.0, share, 0.0)), Align::Right, -10.0);
        for (value, words) in &self.z.ticks {
            let (x, y) = self.place((0.0, 1.0, self.z.share(*value)));
            figure.line(&[(x - style::TICK_LENGTH, y), (x, y)], style::FRAME, theme.ink, canvas);
            let at = (x - style::TICK_LENGTH - 7.0, y + 0.5 * style::TICK * font::CAPITAL);
            figure.text(text(words, at, style::TICK, Align::Right));
        }
        let [near, right, left] = [NEAR, RIGHT, LEFT].map(|at| self.place(at));
        let count = labels.z.lines.len();
        for (i, line) in labels.z.lines.iter().enumerate() {
            let at = (self.area.left - BESIDE.0, self.area.top - GAP - LINE * (count - 1 - i) as f64);
            figure.text(text(line, at, style::AXIS, Align::Left));
        }
        if count == 0 {
            let beside = (left.0 - style::TICK_LENGTH - 25.0 - self.z.widest_number()).max(style::AXIS);
            let middle = (beside, 0.5 * (left.1 + self.place((0.0, 1.0, 1.0)).1));
            figure.text(Text { upright: true, ..text(&self.z.label, middle, style::AXIS, Align::Centre) });
        }
        for (label, (from, to)) in [(&labels.x, (near, right)), (&labels.y, (left, near))] {
            for (i, line) in label.lines.iter().enumerate() {
                let at = (0.5 * (from.0 + to.0), self.area.bottom + UNDER.0 + LINE * i as f64);
                figure.text(text(line, at, style::AXIS, Align::Centre));
            }
        }
    }
}

/// Draws the surface of `cells` over the axes in `area`, about which there is room for the labels.
pub fn draw(
    figure: &mut Figure,
    area: Area,
    axes: [&PlotAxis; 3],
    labels: &Labels,
    cells: &Shades,
    theme: &Theme,
) {
    let view = SurfaceFrame::within(area, axes);
    view.walls(figure, theme);
    view.holes(figure, cells, theme);
    skin(figure, &view, cells, theme);
    view.axes(figure, labels, theme);
    figure.surface = Some(view);
}

/// The faces of the surface with the lines over them.
fn skin(figure: &mut Figure, view: &SurfaceFrame, cells: &Shades, theme: &Theme) {
    let canvas = figure.canvas;
    for face in view.faces(cells) {
        let ink = if face.resting { theme.rest } else { viridis(face.share) };
        let mut points: Vec<Point> = face.corners.iter().map(|corner| view.place(*corner)).collect();
        for three in [[0, 1, 2], [0, 2, 3]] {
            figure.polygon(three.map(|i| points[i]).to_vec(), ink);
        }
        points.push(points[0]);
        figure.line(&points, 0.9, ink, canvas);
        let edge = if face.resting { theme.rest_hatch } else { ink.over(style::BLACK, 0.62) };
        for (side, _) in SIDES.iter().zip(face.lined).filter(|side| side.1) {
            figure.line(&side.map(|i| points[i]), 1.1, edge, canvas);
        }
    }
}
