//! Coordinates and axes of the map on the screen.

use eframe::egui::{
    Align2, FontId, Painter, Pos2, Rect, Stroke, StrokeKind, Vec2, emath::Rot2, epaint::TextShape, pos2, vec2,
};

use crate::app::session::map::{Map, label};
use crate::app::ui::style::Style;
use crate::output::PlotAxis;

/// Width in points of the numbers and the name left of the map.
const LEFT: f32 = 52.0;
/// Height in points of the numbers and the name below the map.
const BOTTOM: f32 = 37.0;
/// Margin in points above the map.
const TOP: f32 = 6.0;
/// Width in points of the colour bar.
const BAR: f32 = 16.0;
/// Margin in points right of the map with a colour bar.
const BAR_ROOM: f32 = 84.0;
/// Margin in points right of the map without a colour bar.
const PLAIN_ROOM: f32 = 12.0;

/// Share of the width or height that the strip of a cut takes.
const STRIP: f32 = 0.24;
/// Smallest and largest width of a strip in points.
const STRIP_WIDTH: (f32, f32) = (96.0, 240.0);
/// Smallest and largest height of a strip in points.
const STRIP_HEIGHT: (f32, f32) = (56.0, 190.0);
/// Gap in points between the map and a strip.
const BETWEEN: f32 = 18.0;
/// Height in points below which both strips stand right of the map.
const LOW: f32 = 330.0;

/// Length of a tick in points.
const TICK: f32 = 4.0;

pub struct Coordinates {
    /// The area of the cells.
    pub rect: Rect,
    pub bar: Option<Rect>,
    /// The strips of the cuts along the horizontal axis (below or right of the map) and the vertical one.
    pub strips: Option<[Rect; 2]>,
    pub x: PlotAxis,
    pub y: PlotAxis,
}

impl Coordinates {
    /// The layout of the map in `area`, with a colour bar if `bar` and with strips for cuts if `cuts`.
    pub fn new(area: Rect, map: &Map, bar: bool, cuts: bool) -> Self {
        let room = if bar { BAR_ROOM } else { PLAIN_ROOM };
        let size = STRIP * area.size();
        let strip =
            vec2(size.x.clamp(STRIP_WIDTH.0, STRIP_WIDTH.1), size.y.clamp(STRIP_HEIGHT.0, STRIP_HEIGHT.1));
        let is_low = area.height() < LOW;
        let (taken, top) = match (cuts, is_low) {
            (false, _) => (Vec2::ZERO, TOP),
            (true, false) => (strip + vec2(BETWEEN, BETWEEN), TOP + 12.0),
            (true, true) => (vec2(2.0 * strip.x + BETWEEN + LEFT, 0.0), TOP + 12.0),
        };
        let rect = Rect::from_min_max(area.min + vec2(LEFT, top), area.max - vec2(room, BOTTOM) - taken);
        let strips = cuts.then(|| {
            let beside = pos2(rect.right() + BETWEEN, rect.top());
            let upward = Rect::from_min_size(beside, vec2(strip.x, rect.height()));
            let below = pos2(rect.left(), rect.bottom() + BETWEEN);
            let across = match is_low {
                true => upward.translate(vec2(strip.x + LEFT, 0.0)),
                false => Rect::from_min_size(below, vec2(rect.width(), strip.y)),
            };
            [across, upward]
        });
        let bar = bar.then(|| {
            let left = rect.right() + taken.x + 12.0;
            Rect::from_min_max(pos2(left, rect.top()), pos2(left + BAR, rect.bottom()))
        });
        let names = map.grid().columns();
        let ends = map.edges.each_ref().map(|edges| edges.ends());
        let count = |points: f32, each: f32| (points / each).clamp(2.0, 12.0) as usize;
        Self {
            x: PlotAxis::between(ends[0].0, ends[0].1, &label(&names[0]))
                .with_ticks(count(rect.width(), 55.0)),
            y: PlotAxis::between(ends[1].0, ends[1].1, &label(&names[1]))
                .with_ticks(count(rect.height(), 42.0)),
            rect,
            bar,
            strips,
        }
    }

    /// Screen position of a value on each axis.
    pub fn screen_from_world(&self, (x, y): (f64, f64)) -> Pos2 {
        let share = vec2(self.x.share(x) as f32, 1.0 - self.y.share(y) as f32);
        self.rect.min + share * self.rect.size()
    }

    /// The values at a screen position.
    pub fn world_from_screen(&self, at: Pos2) -> (f64, f64) {
        let share = (at - self.rect.min) / self.rect.size();
        let between = |axis: &PlotAxis, share: f32| axis.low + f64::from(share) * (axis.high - axis.low);
        (between(&self.x, share.x), between(&self.y, 1.0 - share.y))
    }

    /// Draws ticks, numbers and names around the map; the lower strip has the name of the quantity.
    pub fn axes(&self, painter: &Painter, style: &Style, quantity: Option<&str>) {
        let stroke = Stroke::new(1.0, style.ink());
        painter.rect_stroke(self.rect, 0.0, stroke, StrokeKind::Outside);
        let number = |at, align, text: &str| painter.text(at, align, text, style.small(), style.ink());
        // below the lower strip, or below map and strip where these stand side by side
        let under = match self.strips {
            Some([across, _]) if across.top() > self.rect.bottom() => vec![across],
            Some([across, _]) => vec![self.rect, across],
            None => vec![self.rect],
        };
        for rect in &under {
            let mut last = f32::NEG_INFINITY;
            for (value, text) in &self.x.ticks {
                let at = pos2(rect.left() + self.x.share(*value) as f32 * rect.width(), rect.bottom());
                painter.line_segment([at, at + vec2(0.0, TICK)], stroke);
                if at.x - last > 24.0 {
                    number(at + vec2(0.0, TICK + 1.0), Align2::CENTER_TOP, text);
                    last = at.x;
                }
            }
            let below = pos2(rect.center().x, rect.bottom() + BOTTOM - 2.0);
            painter.text(below, Align2::CENTER_BOTTOM, &self.x.label, style.body(), style.ink());
        }
        for (value, text) in &self.y.ticks {
            let at = pos2(self.rect.left(), self.screen_from_world((self.x.low, *value)).y);
            painter.line_segment([at, at - vec2(TICK, 0.0)], stroke);
            number(at - vec2(TICK + 3.0, 0.0), Align2::RIGHT_CENTER, text);
        }
        let (beside, room) = (pos2(self.rect.left() - LEFT + 10.0, self.rect.center().y), self.rect.height());
        upright(painter, style, beside, room, &self.y.label);
        if let (Some([across, _]), Some(quantity)) = (self.strips, quantity) {
            let beside = pos2(across.left() - LEFT + 10.0, across.center().y);
            upright(painter, style, beside, across.height(), quantity);
        }
    }
}

/// Draws text that reads upwards, centred at a point. Where `room` is too short it is written small, or
/// its unit alone.
pub fn upright(painter: &Painter, style: &Style, at: Pos2, room: f32, text: &str) {
    let unit = text.rsplit_once('(').map_or("", |(_, unit)| unit.trim_end_matches(')'));
    let written = |text: &str, font: FontId| painter.layout_no_wrap(text.to_owned(), font, style.ink());
    let all = [written(text, style.body()), written(text, style.small()), written(unit, style.small())];
    let Some(galley) = all.into_iter().find(|galley| galley.size().x <= room + TOP) else { return };
    let half: Vec2 = Rot2::from_angle(-std::f32::consts::FRAC_PI_2) * (0.5 * galley.size());
    let shape = TextShape::new(at - half, galley, style.ink());
    painter.add(shape.with_angle(-std::f32::consts::FRAC_PI_2));
}
