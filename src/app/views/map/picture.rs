//! Picture of the map: cells as a texture, hatching, symbols, lines, colour bar.

use std::sync::Arc;

use eframe::egui::{
    Align2, Color32, ColorImage, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, TextureHandle,
    TextureOptions, Ui, pos2, vec2,
};

use crate::app::session::map::Map;
use crate::app::ui::style::Style;
use crate::app::ui::widgets::kind_shapes;
use crate::app::words::kind::Kind;

use super::coordinates::{Coordinates, upright};
use super::quantity::{ColourScale, Look, MapQuantity};

/// Points between lines of hatching, and between samples along one.
const HATCH: f32 = 7.0;
const SAMPLE: f32 = 2.0;

/// Radius in points of the dot of a motion that had not settled, and the least side of a cell that bears one.
const DOT: f32 = 1.3;
const SMALLEST_DOTTED: f32 = 4.0;

/// Points between symbols of regimes.
const SYMBOLS: f32 = 46.0;

/// What was drawn, so that it is made again only where it would differ.
#[derive(Clone)]
pub struct Picture {
    texture: TextureHandle,
    looks: Arc<[Look]>,
    /// Which cells show a motion that had not settled.
    unsettled: Arc<[bool]>,
    size: [usize; 2],
    key: Key,
}

/// Version of the map, quantity, style, and whether the map is that of the scene.
type Key = (u64, MapQuantity, Style, bool);

impl Picture {
    /// The picture of a map, made anew where the map or the way it is shown has changed.
    pub fn of(ui: &Ui, old: Option<Self>, map: &Map, scale: &ColourScale, key: Key) -> Self {
        if let Some(old) = old.as_ref().filter(|old| old.key == key && old.size == map.size()) {
            return old.clone();
        }
        let size = map.size();
        let [columns, rows] = size;
        let cell = |i: usize| map.cell(i % columns, rows - 1 - i / columns);
        let look = |i: usize| cell(i).map_or(Look::Unknown, |c| scale.look(c.0));
        let looks: Arc<[Look]> = (0..columns * rows).map(look).collect();
        let transient = |i: usize| cell(i).and_then(|c| c.0.settled()?.settled) == Some(false);
        let unsettled = (0..columns * rows).map(transient).collect();
        let image = ColorImage::new(size, looks.iter().map(|look| colour(&key.2, *look)).collect());
        let texture = match old {
            Some(mut old) => {
                old.texture.set(image, TextureOptions::NEAREST);
                old.texture
            }
            None => ui.ctx().load_texture("map", image, TextureOptions::NEAREST),
        };
        Self { texture, looks, unsettled, size, key }
    }

    /// Whether some cell shows this.
    pub fn shows(&self, look: Look) -> bool {
        self.looks.contains(&look)
    }

    /// Draws cells, hatching and symbols.
    pub fn draw(&self, painter: &Painter, frame: &Coordinates, style: &Style) {
        let all = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        painter.image(self.texture.id(), frame.rect, all, Color32::WHITE);
        self.hatch(painter, frame.rect, Look::Rest, 1.0, style.hatch_stroke());
        self.hatch(painter, frame.rect, Look::Missing, 1.0, style.missing_stroke());
        self.hatch(painter, frame.rect, Look::Missing, -1.0, style.missing_stroke());
        if self.key.1 == MapQuantity::Regime {
            self.symbols(painter, frame.rect, style);
        }
        self.dots(painter, frame.rect, style);
    }

    /// Whether some cell shows a motion that had not settled.
    pub fn shows_unsettled(&self) -> bool {
        self.unsettled.contains(&true)
    }

    /// A dot on every cell whose motion had not settled, where cells are large enough to bear one.
    fn dots(&self, painter: &Painter, rect: Rect, style: &Style) {
        let [columns, rows] = self.size;
        let cell = rect.size() / vec2(columns as f32, rows as f32);
        if !self.shows_unsettled() || cell.min_elem() < SMALLEST_DOTTED {
            return;
        }
        for (i, _) in self.unsettled.iter().enumerate().filter(|(_, unsettled)| **unsettled) {
            let place = vec2((i % columns) as f32 + 0.5, (i / columns) as f32 + 0.5);
            dot(painter, rect.min + place * cell, style);
        }
    }

    fn look_at(&self, rect: Rect, at: Pos2) -> Look {
        let [columns, rows] = self.size;
        let share = (at - rect.min) / rect.size();
        let place = |share: f32, count: usize| ((share * count as f32).max(0.0) as usize).min(count - 1);
        self.looks[place(share.y, rows) * columns + place(share.x, columns)]
    }

    /// Parallel lines over the cells that show `wanted`, rising to the right for `way` 1.
    fn hatch(&self, painter: &Painter, rect: Rect, wanted: Look, way: f32, stroke: Stroke) {
        if !self.shows(wanted) {
            return;
        }
        let count = ((rect.width() + rect.height()) / HATCH) as usize;
        let steps = (rect.height() / SAMPLE).ceil() as usize;
        for line in 0..=count {
            // from the lower edge of the map upwards
            let foot = if way > 0.0 {
                rect.left() - rect.height() + line as f32 * HATCH
            } else {
                rect.left() + line as f32 * HATCH
            };
            let at = |step: usize| {
                let up = (step as f32 * SAMPLE).min(rect.height());
                pos2(foot + way * up, rect.bottom() - up)
            };
            let mut begin: Option<Pos2> = None;
            for step in 0..=steps {
                let place = at(step);
                let on = rect.contains(place) && self.look_at(rect, place) == wanted;
                match begin {
                    None if on => begin = Some(place),
                    Some(from) if !on => {
                        painter.line_segment([from, at(step - 1)], stroke);
                        begin = None;
                    }
                    _ => {}
                }
            }
            if let Some(from) = begin {
                painter.line_segment([from, at(steps)], stroke);
            }
        }
    }

    /// The symbol of the regime here and there, so that colour is not all that tells.
    fn symbols(&self, painter: &Painter, rect: Rect, style: &Style) {
        let (columns, rows) = ((rect.width() / SYMBOLS) as usize, (rect.height() / SYMBOLS) as usize);
        for i in 0..columns * rows.max(1) {
            let corner = rect.min + vec2((i % columns) as f32 + 0.5, (i / columns) as f32 + 0.5) * SYMBOLS;
            let Look::Kind(kind) = self.look_at(rect, corner) else { continue };
            // only where its surroundings are the same
            let around = [vec2(9.0, 0.0), vec2(-9.0, 0.0), vec2(0.0, 9.0), vec2(0.0, -9.0)];
            if around.iter().all(|step| self.look_at(rect, corner + *step) == Look::Kind(kind)) {
                painter.extend(kind_shapes(kind, corner, 5.0, style.over_kind()));
            }
        }
    }
}

fn colour(style: &Style, look: Look) -> Color32 {
    match look {
        Look::Unknown => style.panel(),
        Look::Missing | Look::None => style.ground(),
        Look::Rest => style.rest_shade(),
        Look::Kind(kind) => style.kind(kind),
        Look::Share(share) => style.scale(f64::from(share)),
    }
}

/// Release and first crossing.
pub fn lines(painter: &Painter, frame: &Coordinates, map: &Map, style: &Style) {
    let painter = painter.with_clip_rect(frame.rect);
    let screen =
        |points: &[(f64, f64)]| -> Vec<Pos2> { points.iter().map(|p| frame.screen_from_world(*p)).collect() };
    for stroke in style.crossing_strokes() {
        for part in &map.crossing {
            painter.add(Shape::line(screen(part), stroke));
        }
    }
    let [halo, release] = style.release_strokes();
    let points = screen(&map.release);
    painter.add(Shape::line(points.clone(), halo));
    painter.extend(Shape::dashed_line(&points, release, 9.0, 6.0));
}

/// The colours and their values.
pub fn bar(painter: &Painter, frame: &Coordinates, scale: &ColourScale, style: &Style) {
    let (Some(rect), Some(axis)) = (frame.bar, &scale.bar) else { return };
    let steps = scale.steps().unwrap_or(rect.height().max(2.0) as usize);
    let height = rect.height() / steps as f32;
    for step in 0..steps {
        let bottom = rect.bottom() - step as f32 * height;
        // a point of overlap leaves no seams between pixels
        let part = Rect::from_min_max(
            pos2(rect.left(), bottom - height),
            pos2(rect.right(), (bottom + 1.0).min(rect.bottom())),
        );
        let share = (step as f64 + 0.5) / steps as f64;
        painter.rect_filled(part, 0.0, style.scale(share));
    }
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
    upright(painter, style, (pos2(rect.right() + 44.0, rect.center().y), rect.height()), &axis.label);
}

/// The mark of a motion that had not settled.
pub fn dot(painter: &Painter, at: Pos2, style: &Style) {
    painter.circle_filled(at, DOT, style.hatch_stroke().color);
}

/// The regimes that a picture shows, in the order of the legend.
pub fn kinds(picture: &Picture) -> impl Iterator<Item = Kind> {
    let all = [Kind::Intrawell, Kind::Irregular, Kind::Interwell, Kind::Crossing, Kind::Other];
    all.into_iter().filter(|kind| picture.shows(Look::Kind(*kind)))
}
