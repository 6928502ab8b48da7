//! Cuts through the map: the quantity along a column and a row, with regimes and both thresholds.

use eframe::egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, pos2, vec2};

use crate::app::session::map::{CutCell, Map, short};
use crate::app::ui::style::Style;
use crate::app::ui::widgets::kind_shapes;
use crate::app::words::kind::Kind;
use crate::study::{label_and_unit, line_meets};

use super::coordinates::Coordinates;
use super::quantity::ColourScale;

/// Share of a strip that stays free at both ends of the scale.
const MARGIN: f32 = 0.06;

/// Radius of a mark in points.
const MARK: f32 = 3.2;
/// Smallest distance in points between marks of one kind.
const MARK_GAP: f32 = 6.5;

/// Smallest distance in points between numbers, vertically and horizontally.
const NUMBERS: (f32, f32) = (14.0, 34.0);

/// Opacity of the mark of a neighbour that stands for a cell that has not run yet.
const FAINT: f32 = 0.4;

/// A cut through the map and its strip on the screen.
struct Strip<'a> {
    /// Whether it runs along a column.
    upright: bool,
    rect: Rect,
    frame: &'a Coordinates,
    scale: &'a ColourScale,
    map: &'a Map,
    /// The column or row, and its value.
    at: (usize, f64),
}

/// Draws the cuts through a cell, and where they lie on the map.
pub fn draw(
    painter: &Painter,
    frame: &Coordinates,
    map: &Map,
    scale: &ColourScale,
    (column, row): (usize, usize),
    style: &Style,
) {
    let Some([across, beside]) = frame.strips else { return };
    let (x, y) = (map.edges[0].values[column], map.edges[1].values[row]);
    for (upright, rect, at) in [(true, beside, (column, x)), (false, across, (row, y))] {
        let strip = Strip { upright, rect, frame, scale, map, at };
        strip.place_on_map(painter);
        strip.draw(painter, style, if upright { row } else { column });
    }
}

impl Strip<'_> {
    /// Screen position of a value of its axis and a share of the scale.
    fn place(&self, along: f64, share: f64) -> Pos2 {
        let share = MARGIN + (1.0 - 2.0 * MARGIN) * share as f32;
        let Rect { min, max } = self.rect;
        let size = self.rect.size();
        match self.upright {
            true => pos2(min.x + share * size.x, max.y - self.frame.y.share(along) as f32 * size.y),
            false => pos2(min.x + self.frame.x.share(along) as f32 * size.x, max.y - share * size.y),
        }
    }

    /// The line across the strip at a value of its axis.
    fn across(&self, along: f64) -> [Pos2; 2] {
        let at = self.place(along, 0.0);
        match self.upright {
            true => [pos2(self.rect.left(), at.y), pos2(self.rect.right(), at.y)],
            false => [pos2(at.x, self.rect.top()), pos2(at.x, self.rect.bottom())],
        }
    }

    /// Draws the dotted line on the map.
    fn place_on_map(&self, painter: &Painter) {
        let rect = self.frame.rect;
        let at = self.frame.screen_from_world((self.at.1, self.at.1));
        let ends = match self.upright {
            true => [pos2(at.x, rect.bottom()), pos2(at.x, rect.top())],
            false => [pos2(rect.left(), at.y), pos2(rect.right(), at.y)],
        };
        painter.line_segment(ends, Stroke::new(2.6, Style::over_map(false)));
        painter.extend(Shape::dashed_line(&ends, Stroke::new(1.4, Style::over_map(true)), 3.0, 4.0));
    }

    fn draw(&self, painter: &Painter, style: &Style, scene: usize) {
        let inside = painter.with_clip_rect(self.rect);
        self.numbers(painter, style);
        self.thresholds(&inside, style);
        let values = &self.map.edges[usize::from(self.upright)].values;
        let cells = self.map.cut(self.upright, self.at.0);
        let point = |cut: &CutCell<'_>| Some(self.place(values[cut.place], self.scale.height(cut.cell)?));
        // the line connects neighbouring cells that have numbers
        let mut line: Vec<Pos2> = Vec::new();
        let mut last = None;
        for cut in cells.iter().filter(|cut| cut.is_known) {
            let at = point(cut).filter(|_| !self.scale.is_of_words());
            if at.is_none() || last.is_some_and(|last| cut.place != last + 1) {
                inside.add(Shape::line(std::mem::take(&mut line), style.ghost_stroke()));
            }
            line.extend(at);
            last = Some(cut.place);
        }
        inside.add(Shape::line(line, style.ghost_stroke()));
        let mut before: Option<(Pos2, Kind)> = None;
        for cut in &cells {
            let Some(at) = point(cut) else { continue };
            let kind = cut.cell.settled().map_or(Kind::Fault, |settled| Kind::from(settled.regime));
            let is_scene = cut.place == scene && cut.is_known;
            if !is_scene && before.is_some_and(|(last, of)| of == kind && last.distance(at) < MARK_GAP) {
                continue;
            }
            before = Some((at, kind));
            let colour = style.kind(kind);
            let colour = if cut.is_known { colour } else { colour.gamma_multiply(FAINT) };
            inside.extend(kind_shapes(kind, at, MARK, colour));
            if is_scene {
                for stroke in style.marker_strokes() {
                    inside.circle_stroke(at, 2.2 * MARK, stroke);
                }
            }
        }
        painter.rect_stroke(self.rect, 0.0, Stroke::new(1.0, style.ink()), StrokeKind::Outside);
        let (name, unit) = label_and_unit(&self.map.grid().columns()[usize::from(!self.upright)]);
        let heading = format!("at {name} {} {}", short(self.at.1), unit);
        let at = self.rect.left_top() - vec2(0.0, 2.0);
        painter.text(at, Align2::LEFT_BOTTOM, heading.trim_end(), style.small(), style.ink());
    }

    /// Draws the numbers of the quantity and their lines.
    fn numbers(&self, painter: &Painter, style: &Style) {
        let Some(bar) = &self.scale.bar else { return };
        let mut last: Option<Pos2> = None;
        for (value, text) in &bar.ticks {
            let (low, high) = self.map.edges[usize::from(self.upright)].ends();
            let share = self.scale.share(*value, bar);
            let ends = [self.place(low, share), self.place(high, share)];
            let distance = if self.upright { NUMBERS.1 } else { NUMBERS.0 };
            if last.is_some_and(|last| last.distance(ends[0]) < distance) {
                continue;
            }
            last = Some(ends[0]);
            painter.line_segment(ends, style.grid_stroke());
            let (step, align) = match self.upright {
                true => (vec2(0.0, 3.0), Align2::CENTER_TOP),
                false => (vec2(-5.0, 0.0), Align2::RIGHT_CENTER),
            };
            painter.text(ends[0] + step, align, text, style.small(), style.ink());
        }
    }

    /// Marks where the cut meets the release and the first crossing.
    fn thresholds(&self, painter: &Painter, style: &Style) {
        let (value, upright) = (self.at.1, self.upright);
        let [halo, release] = style.release_strokes();
        for at in line_meets(&self.map.release, value, upright) {
            painter.line_segment(self.across(at), halo);
            painter.extend(Shape::dashed_line(&self.across(at), release, 9.0, 6.0));
        }
        for at in self.map.crossing.iter().flat_map(|part| line_meets(part, value, upright)) {
            painter.line_segment(self.across(at), style.crossing_strokes()[1]);
        }
    }
}
