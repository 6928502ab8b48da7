//! Picture of the map: cells as a texture, hatching, symbols, lines, colour bar.

use std::sync::Arc;

use eframe::egui::epaint::{TessellationOptions, Tessellator};
use eframe::egui::{
    Align2, Color32, ColorImage, Mesh, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, TextureHandle,
    TextureOptions, Ui, pos2, vec2,
};

use crate::app::session::map::Map;
use crate::app::ui::style::Style;
use crate::app::ui::widgets::kind_shapes;
use crate::app::words::kind::Kind;
use crate::dynamics::Summary;
use crate::study::SummaryField;

use super::coordinates::{Coordinates, upright};
use super::quantity::{ColourScale, Look};

/// Distance in points between lines of hatching.
const HATCH: f32 = 7.0;
/// Distance in points between samples along a line of hatching.
const SAMPLE: f32 = 2.0;

/// Radius in points of the dot of a motion that may be a transient.
const DOT: f32 = 1.3;
/// Smallest side in points of a cell that has a dot.
const MIN_DOTTED: f32 = 4.0;

/// Distance in points between symbols of regimes.
const SYMBOLS: f32 = 46.0;

/// The map as it was drawn, kept so that it is made anew only after a change.
#[derive(Clone)]
pub struct Picture {
    pub scale: Arc<ColourScale>,
    texture: TextureHandle,
    looks: Arc<[Look]>,
    /// Which cells show a motion at rest.
    resting: Arc<[bool]>,
    /// Which cells show a motion that may be a transient.
    transients: Arc<[bool]>,
    size: [usize; 2],
    key: Key,
    /// The mesh of the shapes over the cells, and the place that it was made for.
    over: Option<(Place, Arc<Mesh>)>,
    is_new: bool,
}

/// Version of the map, column, style, and whether the map is that of the scene.
pub type Key = (u64, &'static str, Style, bool);

/// The rectangle of a picture and its pixels in a point.
pub type Place = (Rect, f32);

/// Shapes as a mesh, so that they are tessellated once and not in every frame. They must not contain text.
pub fn baked(pixels_per_point: f32, shapes: Vec<Shape>) -> Arc<Mesh> {
    // prerasterized discs lie in a texture that may change
    let options = TessellationOptions { prerasterized_discs: false, ..TessellationOptions::default() };
    let mut tessellator = Tessellator::new(pixels_per_point, options, [1, 1], Vec::new());
    let mut mesh = Mesh::default();
    shapes.into_iter().for_each(|shape| tessellator.tessellate_shape(shape, &mut mesh));
    Arc::new(mesh)
}

impl Picture {
    /// The picture of a map, made anew where the map or the way it is shown has changed.
    pub fn of(ui: &Ui, old: Option<Self>, map: &Map, quantity: &'static SummaryField, key: Key) -> Self {
        if let Some(old) = old.as_ref().filter(|old| old.key == key && old.size == map.size()) {
            return Self { is_new: false, ..old.clone() };
        }
        let scale = ColourScale::of(quantity, map);
        let size = map.size();
        let [columns, rows] = size;
        let cell = |i: usize| map.cell(i % columns, rows - 1 - i / columns);
        let look = |i: usize| cell(i).map_or((Look::Unknown, false), |c| scale.look(c.0));
        let (looks, resting): (Vec<Look>, Vec<bool>) = (0..columns * rows).map(look).unzip();
        let transient = |i: usize| cell(i).and_then(|c| c.0.settled()).is_some_and(Summary::is_transient);
        let transients = (0..columns * rows).map(transient).collect();
        let image = ColorImage::new(size, looks.iter().map(|look| colour(&key.2, *look)).collect());
        let texture = match old {
            Some(mut old) => {
                old.texture.set(image, TextureOptions::NEAREST);
                old.texture
            }
            None => ui.ctx().load_texture("map", image, TextureOptions::NEAREST),
        };
        let (looks, resting) = (looks.into(), resting.into());
        Self {
            scale: Arc::new(scale),
            texture,
            looks,
            resting,
            transients,
            size,
            key,
            over: None,
            is_new: true,
        }
    }

    /// Whether it was made in this frame and not drawn before.
    pub fn is_new(&self) -> bool {
        self.is_new
    }

    pub fn shows(&self, look: Look) -> bool {
        self.looks.contains(&look)
    }

    pub fn shows_rest(&self) -> bool {
        self.resting.contains(&true)
    }

    /// Whether any cell shows a motion that may be a transient.
    pub fn shows_transient(&self) -> bool {
        self.transients.contains(&true)
    }

    /// Draws cells, hatching, symbols and the colour bar.
    pub fn draw(&mut self, painter: &Painter, frame: &Coordinates, map: &Map, style: &Style) {
        let all = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        painter.image(self.texture.id(), frame.rect, all, Color32::WHITE);
        let place = (frame.rect, painter.pixels_per_point());
        let mesh = match &self.over {
            Some((at, mesh)) if *at == place => Arc::clone(mesh),
            _ => baked(place.1, self.shapes(frame, map, style)),
        };
        painter.with_clip_rect(frame.rect).add(Shape::Mesh(Arc::clone(&mesh)));
        self.over = Some((place, mesh));
    }

    /// The shapes over the cells.
    fn shapes(&self, frame: &Coordinates, map: &Map, style: &Style) -> Vec<Shape> {
        let mut shapes = Vec::new();
        let rest = |i: usize| self.resting[i];
        let missing = |i: usize| self.looks[i] == Look::Missing;
        self.hatch(&mut shapes, frame.rect, rest, 1.0, style.hatch_stroke());
        for slope in [1.0, -1.0] {
            self.hatch(&mut shapes, frame.rect, missing, slope, style.missing_stroke());
        }
        self.symbols(&mut shapes, frame.rect, style);
        self.dots(&mut shapes, frame.rect, style);
        lines(&mut shapes, frame, map, style);
        shapes
    }

    /// Marks every cell whose motion may be a transient by a dot, where cells are large enough.
    fn dots(&self, shapes: &mut Vec<Shape>, rect: Rect, style: &Style) {
        let [columns, rows] = self.size;
        let cell = rect.size() / vec2(columns as f32, rows as f32);
        if cell.min_elem() < MIN_DOTTED {
            return;
        }
        for (i, _) in self.transients.iter().enumerate().filter(|(_, transient)| **transient) {
            let place = vec2((i % columns) as f32 + 0.5, (i / columns) as f32 + 0.5);
            shapes.push(dot(rect.min + place * cell, style));
        }
    }

    /// The index of the cell at a screen position.
    fn cell_at(&self, rect: Rect, at: Pos2) -> usize {
        let [columns, rows] = self.size;
        let share = (at - rect.min) / rect.size();
        let place = |share: f32, count: usize| ((share * count as f32).max(0.0) as usize).min(count - 1);
        place(share.y, rows) * columns + place(share.x, columns)
    }

    /// Hatches the cells that are `wanted`, rising to the right for `slope` 1 and to the left for -1.
    fn hatch(
        &self,
        shapes: &mut Vec<Shape>,
        rect: Rect,
        wanted: impl Fn(usize) -> bool,
        slope: f32,
        stroke: Stroke,
    ) {
        if !(0..self.looks.len()).any(&wanted) {
            return;
        }
        let count = ((rect.width() + rect.height()) / HATCH) as usize;
        let steps = (rect.height() / SAMPLE).ceil() as usize;
        for line in 0..=count {
            // each line begins at the lower edge of the map
            let foot = if slope > 0.0 {
                rect.left() - rect.height() + line as f32 * HATCH
            } else {
                rect.left() + line as f32 * HATCH
            };
            let at = |step: usize| {
                let up = (step as f32 * SAMPLE).min(rect.height());
                pos2(foot + slope * up, rect.bottom() - up)
            };
            let mut begin: Option<Pos2> = None;
            for step in 0..=steps {
                let place = at(step);
                let on = rect.contains(place) && wanted(self.cell_at(rect, place));
                match begin {
                    None if on => begin = Some(place),
                    Some(from) if !on => {
                        shapes.push(Shape::line_segment([from, at(step - 1)], stroke));
                        begin = None;
                    }
                    _ => {}
                }
            }
            if let Some(from) = begin {
                shapes.push(Shape::line_segment([from, at(steps)], stroke));
            }
        }
    }

    /// Draws symbols of the regimes at intervals, so that colour is not the only sign of them.
    fn symbols(&self, shapes: &mut Vec<Shape>, rect: Rect, style: &Style) {
        let (columns, rows) = ((rect.width() / SYMBOLS) as usize, (rect.height() / SYMBOLS) as usize);
        let look_at = |at: Pos2| self.looks[self.cell_at(rect, at)];
        for i in 0..columns * rows.max(1) {
            let corner = rect.min + vec2((i % columns) as f32 + 0.5, (i / columns) as f32 + 0.5) * SYMBOLS;
            let Look::Kind(kind) = look_at(corner) else { continue };
            // only where its surroundings are the same
            let around = [vec2(9.0, 0.0), vec2(-9.0, 0.0), vec2(0.0, 9.0), vec2(0.0, -9.0)];
            if around.iter().all(|step| look_at(corner + *step) == Look::Kind(kind)) {
                shapes.extend(kind_shapes(kind, corner, 5.0, style.over_kind()));
            }
        }
    }
}

pub fn colour(style: &Style, look: Look) -> Color32 {
    match look {
        Look::Unknown => style.panel(),
        Look::Missing | Look::None => style.ground(),
        Look::Rest => style.rest_shade(),
        Look::Kind(kind) => style.kind(kind),
        Look::Word(place) => style.attractor(place.into()),
        Look::Share(share) => style.scale(f64::from(share)),
    }
}

/// Draws release and first crossing.
fn lines(shapes: &mut Vec<Shape>, frame: &Coordinates, map: &Map, style: &Style) {
    let screen =
        |points: &[(f64, f64)]| -> Vec<Pos2> { points.iter().map(|p| frame.screen_from_world(*p)).collect() };
    for stroke in style.crossing_strokes() {
        shapes.extend(map.crossing.iter().map(|part| Shape::line(screen(part), stroke)));
    }
    let [halo, release] = style.release_strokes();
    let points = screen(&map.release);
    shapes.push(Shape::line(points.clone(), halo));
    shapes.extend(Shape::dashed_line(&points, release, 9.0, 6.0));
}

/// Draws the colour bar and its values.
pub fn bar(painter: &Painter, rect: Rect, scale: &ColourScale, style: &Style) {
    let Some(axis) = &scale.bar else { return };
    let mut mesh = Mesh::default();
    let steps = scale.steps().unwrap_or(64);
    for step in 0..steps {
        let at = |part: usize| rect.bottom() - part as f32 / steps as f32 * rect.height();
        let part = Rect::from_min_max(pos2(rect.left(), at(step + 1)), pos2(rect.right(), at(step)));
        mesh.add_colored_rect(part, style.scale((step as f64 + 0.5) / steps as f64));
    }
    painter.add(Shape::mesh(mesh));
    let stroke = Stroke::new(1.0, style.ink());
    painter.rect_stroke(rect, 0.0, stroke, StrokeKind::Outside);
    let mut above = f32::INFINITY;
    for (value, text) in &axis.ticks {
        let at = pos2(rect.right(), rect.bottom() - scale.share(*value, axis) as f32 * rect.height());
        if above - at.y < 13.0 {
            continue;
        }
        above = at.y;
        painter.line_segment([at, at + vec2(4.0, 0.0)], stroke);
        painter.text(at + vec2(7.0, 0.0), Align2::LEFT_CENTER, text, style.small(), style.ink());
    }
    upright(painter, style, pos2(rect.right() + 44.0, rect.center().y), rect.height(), &axis.label);
}

/// The mark of a motion that may be a transient.
pub fn dot(at: Pos2, style: &Style) -> Shape {
    Shape::circle_filled(at, DOT, style.hatch_stroke().color)
}

/// The regimes that a picture shows, in the order of the legend.
pub fn kinds(picture: &Picture) -> impl Iterator<Item = Kind> {
    let all = [Kind::Intrawell, Kind::Irregular, Kind::Interwell, Kind::Crossing, Kind::Other];
    all.into_iter().filter(|kind| picture.shows(Look::Kind(*kind)))
}
