//! A chart in a place of the window: the shapes of its picture on paper, painted by egui.

use std::f32::consts::FRAC_PI_2;

use eframe::egui::epaint::TextShape;
use eframe::egui::{
    Color32, FontFamily, FontId, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, pos2,
};

use crate::app::ui::style::{SMALL, Style, strong_family};
use crate::output::{Area, Chart, Frame, Ink, Shape as Drawn, TICK, Theme};

use super::hand::axes_input;
use super::memory::Memory;
use super::view::View;

/// Points of the screen in a unit of a chart.
const UNIT: f32 = SMALL / TICK as f32;

/// Ascent of the letters in ems.
const ASCENT: f32 = 1984.0 / 2048.0;

/// A chart that was painted, with what the pointer does on it.
pub struct Pane {
    pub response: Response,
    origin: Pos2,
    frames: Vec<Frame>,
}

impl Pane {
    /// The value of the first panel's horizontal axis at a place on the screen.
    pub fn x_at(&self, at: Pos2) -> Option<f64> {
        let (frame, axis) = (self.frame(0)?, &self.frames.first()?.x);
        let share = f64::from((at.x - frame.left()) / frame.width());
        Some(axis.low + share * (axis.high - axis.low))
    }

    /// The place on the screen of a point of the first panel.
    pub fn place(&self, point: (f64, f64)) -> Option<Pos2> {
        Some(place(self.origin, self.frames.first()?.place(point)))
    }

    /// The frame of a panel on the screen.
    pub fn frame(&self, panel: usize) -> Option<Rect> {
        let Area { left, top, right, bottom } = self.frames.get(panel)?.area;
        Some(Rect::from_min_max(place(self.origin, (left, top)), place(self.origin, (right, bottom))))
    }
}

/// Paints `chart` in `area`, in which `view` has the axes of its first panel: those that were zoomed or are
/// held by hand, which the pointer can change.
pub fn pane_ui(
    ui: &mut Ui,
    memory: &mut Memory,
    view: View,
    style: &Style,
    area: Rect,
    mut chart: Chart,
) -> Pane {
    if let (Some(axes), Some(panel)) = (view.axes(), chart.first_panel()) {
        panel.x = panel.x.zoomed(memory.axes.ends(axes[0], (panel.x.low, panel.x.high)));
        panel.y = panel.y.zoomed(memory.axes.ends(axes[1], (panel.y.low, panel.y.high)));
    }
    let theme = if style.dark { Theme::DARK } else { Theme::LIGHT };
    let size = (f64::from(area.width() / UNIT), f64::from(area.height() / UNIT));
    let figure = chart.pane(size, &theme);
    let response = ui.interact(area, ui.scope_id().with("chart"), Sense::click_and_drag());
    let painter = ui.painter().with_clip_rect(area);
    painter.rect_filled(area, 0.0, style.ground());
    figure.shapes.iter().skip(1).for_each(|shape| paint(&painter, area.min, shape));
    let pane = Pane { response, origin: area.min, frames: figure.frames };
    if let Some(frame) = pane.frame(0) {
        axes_input(ui, memory, view, &pane.response, (area, frame));
    }
    pane
}

/// The place on the screen of one on a canvas whose upper left corner is at `origin`.
fn place(origin: Pos2, (x, y): (f64, f64)) -> Pos2 {
    pos2(origin.x + x as f32 * UNIT, origin.y + y as f32 * UNIT)
}

fn colour(Ink(red, green, blue): Ink) -> Color32 {
    Color32::from_rgb(red, green, blue)
}

fn paint(painter: &Painter, origin: Pos2, shape: &Drawn) {
    let places = |points: &[(f64, f64)]| points.iter().map(|point| place(origin, *point)).collect();
    match shape {
        Drawn::Rect(Area { left, top, right, bottom }, ink) => {
            let rect = Rect::from_min_max(place(origin, (*left, *top)), place(origin, (*right, *bottom)));
            painter.rect_filled(rect, 0.0, colour(*ink));
        }
        Drawn::Line(points, width, ink) => {
            painter.add(Shape::line(places(points), Stroke::new(*width as f32 * UNIT, colour(*ink))));
        }
        Drawn::Polygon(points, ink) => {
            painter.add(Shape::convex_polygon(places(points), colour(*ink), Stroke::NONE));
        }
        Drawn::Disc(centre, radius, ink) => {
            painter.circle_filled(place(origin, *centre), *radius as f32 * UNIT, colour(*ink));
        }
        Drawn::Text(text) => {
            let size = text.size as f32 * UNIT;
            let family = if text.bold { strong_family() } else { FontFamily::Proportional };
            let galley =
                painter.layout_no_wrap(text.words.clone(), FontId::new(size, family), colour(text.ink));
            let (at, before) = (place(origin, text.at), text.before() as f32 * UNIT);
            let (corner, angle) = match text.upright {
                true => (pos2(at.x - ASCENT * size, at.y + before), -FRAC_PI_2),
                false => (pos2(at.x - before, at.y - ASCENT * size), 0.0),
            };
            painter.add(TextShape::new(corner, galley, colour(text.ink)).with_angle(angle));
        }
    }
}
