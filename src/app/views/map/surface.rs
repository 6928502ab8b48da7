//! The map as a surface in projection, with the quantity as height and colour.

use std::sync::Arc;

use eframe::egui::{Align2, Color32, Mesh, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

use crate::app::session::map::{Map, label};
use crate::app::ui::style::Style;
use crate::output::{
    AXIS_EDGES, BACK_EDGES, BoxPlace, Face, PlotAxis, Projection, SIDES, surface_faces, wall_lines,
};

use super::coordinates::upright;
use super::picture::{Place, baked};
use super::quantity::{ColourScale, Look};

/// Margin in points left of the box.
const LEFT: f32 = 74.0;
/// Margin in points right of the box.
const RIGHT: f32 = 30.0;
/// Margin in points above the box.
const TOP: f32 = 12.0;
/// Margin in points below the box.
const BOTTOM: f32 = 48.0;

/// Largest number of columns and rows drawn; of more, every n-th.
const MAX_LINES: usize = 128;

pub struct Surface {
    place: Place,
    projection: Projection,
    /// Horizontal and vertical axis of the map, and the quantity.
    axes: [PlotAxis; 3],
    /// Positions of the ticks on the axis of the quantity, as shares of it.
    shares: Vec<f64>,
    /// The columns and rows that are drawn.
    drawn: [Vec<usize>; 2],
    faces: Vec<Face>,
    mesh: Arc<Mesh>,
}

impl Surface {
    /// The surface of a map at a place. `None` if the map shows words.
    pub fn new(place: Place, map: &Map, scale: &ColourScale, style: &Style) -> Option<Self> {
        let area = place.0;
        let bar = scale.bar.clone()?;
        let names = map.grid().columns();
        let axis = |i: usize| {
            let values = map.edges[i].values.iter().copied();
            PlotAxis::around(values, 0.0, &label(&names[i])).with_ticks(if area.width() > 500.0 {
                6
            } else {
                4
            })
        };
        let axes = [axis(0), axis(1), bar.clone()];
        let shares: Vec<f64> = bar.ticks.iter().map(|tick| scale.share(tick.0, &bar)).collect();
        let drawn = map.size().map(|count| {
            let step = count.div_ceil(MAX_LINES).max(1);
            (0..count).step_by(step).collect::<Vec<usize>>()
        });
        let along = |i: usize| {
            drawn[i].iter().map(|place| axes[i].share(map.edges[i].values[*place])).collect::<Vec<f64>>()
        };
        let height = |column: usize, row: usize| {
            let (cell, _) = map.cell(drawn[0][column], drawn[1][row])?;
            let resting = scale.look(cell).0 == Look::Rest;
            Some((scale.value(cell)?, resting))
        };
        let faces = surface_faces(&along(0), &along(1), height, |value| scale.share(value, &bar));
        let [left, top] = [area.left() + LEFT, area.top() + TOP].map(f64::from);
        let [right, bottom] = [area.right() - RIGHT, area.bottom() - BOTTOM].map(f64::from);
        let projection = Projection { left, top, right, bottom };
        let mut surface = Self { place, projection, axes, shares, drawn, faces, mesh: Arc::default() };
        surface.mesh = baked(place.1, surface.shapes(style));
        Some(surface)
    }

    /// Whether it was made for this place.
    pub fn is_at(&self, place: Place) -> bool {
        self.place == place
    }

    fn screen(&self, at: BoxPlace) -> Pos2 {
        let (x, y) = self.projection.place(at);
        pos2(x as f32, y as f32)
    }

    /// The walls, and the faces from back to front with their edges.
    fn shapes(&self, style: &Style) -> Vec<Shape> {
        let ticks = |axis: &PlotAxis| axis.ticks.iter().map(|tick| axis.share(tick.0)).collect::<Vec<_>>();
        let [x, y] = [&self.axes[0], &self.axes[1]].map(|axis| ticks(axis).into_iter());
        let line = |ends: (BoxPlace, BoxPlace), stroke: Stroke| {
            Shape::line_segment([self.screen(ends.0), self.screen(ends.1)], stroke)
        };
        let walls = wall_lines(x, y, self.shares.iter().copied()).into_iter();
        let mut shapes: Vec<Shape> = walls.map(|ends| line(ends, style.grid_stroke())).collect();
        shapes.extend(BACK_EDGES.map(|ends| line(ends, Stroke::new(1.0, style.faint()))));
        for face in &self.faces {
            let at = face.corners.map(|corner| self.screen(corner));
            let colour = if face.resting { style.rest_shade() } else { style.scale(face.share) };
            let mut mesh = Mesh::default();
            at.iter().for_each(|at| mesh.colored_vertex(*at, colour));
            mesh.add_triangle(0, 1, 2);
            mesh.add_triangle(0, 2, 3);
            shapes.push(Shape::mesh(mesh));
            let edge = match face.resting {
                true => style.hatch_stroke().color,
                false => Style::scale_edge(face.share),
            };
            for (side, _) in SIDES.iter().zip(face.lined).filter(|side| side.1) {
                shapes.push(Shape::line_segment(side.map(|i| at[i]), Stroke::new(0.7, edge)));
            }
        }
        shapes
    }

    pub fn draw(&self, painter: &Painter, style: &Style) {
        painter.add(Shape::Mesh(Arc::clone(&self.mesh)));
        let stroke = Stroke::new(1.0, style.ink());
        for (from, to) in AXIS_EDGES {
            painter.line_segment([self.screen(from), self.screen(to)], stroke);
        }
        let [x, y, z] = &self.axes;
        let number = |at: Pos2, align: Align2, text: &str| {
            painter.text(at, align, text, style.small(), style.ink()).size()
        };
        let row = |axis: &PlotAxis, side: f32, place: &dyn Fn(f64) -> BoxPlace| {
            let mut last: Option<Pos2> = None;
            for (value, text) in &axis.ticks {
                let at = self.screen(place(axis.share(*value)));
                painter.line_segment([at, at + vec2(3.0 * side, 5.0)], stroke);
                // numbers that would overlap are left out
                if last.is_none_or(|last| (last.y - at.y).abs() >= 9.0 || (last.x - at.x).abs() >= 34.0) {
                    let align = if side > 0.0 { Align2::LEFT_TOP } else { Align2::RIGHT_TOP };
                    number(at + vec2(5.0 * side, 4.0), align, text);
                    last = Some(at);
                }
            }
        };
        row(x, 1.0, &|share| (share, 0.0, 0.0));
        row(y, -1.0, &|share| (0.0, share, 0.0));
        let (mut widest, mut above) = (0.0_f32, f32::INFINITY);
        for ((_, text), share) in z.ticks.iter().zip(&self.shares) {
            let at = self.screen((0.0, 1.0, *share));
            if above - at.y < 13.0 {
                continue;
            }
            above = at.y;
            painter.line_segment([at, at - vec2(4.0, 0.0)], stroke);
            widest = widest.max(number(at - vec2(7.0, 0.0), Align2::RIGHT_CENTER, text).x);
        }
        let [near, right, left] =
            [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)].map(|at| self.screen(at));
        let high = self.screen((0.0, 1.0, 1.0));
        let beside = pos2((left.x - 17.0 - widest).max(self.place.0.left() + 8.0), 0.5 * (left.y + high.y));
        upright(painter, style, beside, left.y - high.y, &z.label);
        let bottom = self.place.0.bottom() - 3.0;
        for (label, (from, to)) in [(&x.label, (near, right)), (&y.label, (left, near))] {
            let at = pos2(0.5 * (from.x + to.x), bottom);
            painter.text(at, Align2::CENTER_BOTTOM, label, style.body(), style.ink());
        }
    }

    /// Screen positions of a cell's value and of the floor below it. `None` if the cell has no value.
    pub fn place_of(
        &self,
        map: &Map,
        scale: &ColourScale,
        (column, row): (usize, usize),
    ) -> Option<[Pos2; 2]> {
        let at = |i: usize, place: usize| self.axes[i].share(map.edges[i].values[place]);
        let (u, v) = (at(0, column), at(1, row));
        let height = scale.height(map.cell(column, row)?.0)?;
        Some([self.screen((u, v, height)), self.screen((u, v, 0.0))])
    }

    /// Draws the lines of the cuts along a column and along a row.
    pub fn cuts(&self, painter: &Painter, map: &Map, scale: &ColourScale, (column, row): (usize, usize)) {
        let [columns, rows] = map.size();
        let lines: [Vec<(usize, usize)>; 2] = [
            (0..rows).map(|row| (column, row)).collect(),
            (0..columns).map(|column| (column, row)).collect(),
        ];
        for line in lines {
            let places: Vec<Option<Pos2>> =
                line.into_iter().map(|cell| self.place_of(map, scale, cell).map(|ends| ends[0])).collect();
            for part in places.split(Option::is_none) {
                let points: Vec<Pos2> = part.iter().flatten().copied().collect();
                painter.add(Shape::line(points.clone(), Stroke::new(3.6, Style::over_map(false))));
                painter.add(Shape::line(points, Stroke::new(1.6, Style::over_map(true))));
            }
        }
    }

    /// Draws the scene as a ball on the surface, above its place on the floor.
    pub fn ball(&self, painter: &Painter, style: &Style, [at, floor]: [Pos2; 2]) {
        for stroke in style.marker_strokes() {
            painter.line_segment([at, floor], Stroke::new(0.6 * stroke.width, stroke.color));
        }
        painter.circle(at, 6.5, style.mass(), Stroke::new(1.5, Color32::BLACK));
    }

    /// The frontmost cell at a screen position.
    pub fn cell_at(&self, at: Pos2) -> Option<(usize, usize)> {
        self.faces.iter().rev().find_map(|face| {
            let corners = face.corners.map(|corner| self.screen(corner));
            let under = [[0, 1, 2], [0, 2, 3]].iter().any(|three| is_inside(three.map(|i| corners[i]), at));
            let nearest =
                (0..4).min_by(|a, b| corners[*a].distance(at).total_cmp(&corners[*b].distance(at)))?;
            let step = [(0, 0), (1, 0), (1, 1), (0, 1)][nearest];
            let cell = (self.drawn[0][face.cell.0 + step.0], self.drawn[1][face.cell.1 + step.1]);
            under.then_some(cell)
        })
    }

    /// Bounds of the drawing.
    pub fn rect(&self) -> Rect {
        let Projection { left, top, right, bottom } = self.projection;
        Rect::from_min_max(pos2(left as f32, top as f32), pos2(right as f32, bottom as f32))
    }
}

/// Whether a point lies in a triangle.
fn is_inside([a, b, c]: [Pos2; 3], at: Pos2) -> bool {
    let side = |from: Pos2, to: Pos2| (to - from).rot90().dot(at - from);
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}
