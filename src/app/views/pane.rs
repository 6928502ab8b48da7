//! A chart in a place of the window: the shapes of its picture on paper, painted by egui.

use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

use eframe::egui::epaint::{TessellationOptions, Tessellator, TextShape};
use eframe::egui::{
    FontFamily, FontId, Id, Mesh, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, pos2,
};

use crate::app::ui::style::{SMALL, Style, colour, strong_family};
use crate::output::{Area, Chart, Figure, Frame, PlotAxis, Shape as Drawn, SurfaceFrame, TICK, Text};

use super::hand::axes_input;
use super::memory::Memory;
use super::view::View;

/// Points of the screen in a unit of a chart.
const UNIT: f32 = SMALL / TICK as f32;

/// Least radius in points of a dot that can be seen.
const LEAST_DOT: f32 = 1.5;

/// Ascent of the letters in ems.
const ASCENT: f32 = 1984.0 / 2048.0;

/// A chart that was painted.
pub struct Pane {
    pub response: Response,
    pub chart: Arc<Chart>,
    painting: Arc<Painting>,
}

impl Pane {
    /// The values of a panel's axes at a place on the screen.
    pub fn values_at(&self, panel: usize, at: Pos2) -> Option<(f64, f64)> {
        let (rect, frame) = (self.frame(panel)?, self.painting.frames.get(panel)?);
        let value = |axis: &PlotAxis, share: f32| axis.low + f64::from(share) * (axis.high - axis.low);
        let across = (at.x - rect.left()) / rect.width();
        Some((value(&frame.x, across), value(&frame.y, (rect.bottom() - at.y) / rect.height())))
    }

    /// The place on the screen of a point of a panel.
    pub fn place(&self, panel: usize, point: (f64, f64)) -> Option<Pos2> {
        Some(self.painting.place(self.painting.frames.get(panel)?.place(point)))
    }

    /// The frame of a panel on the screen.
    pub fn frame(&self, panel: usize) -> Option<Rect> {
        Some(self.painting.rect(self.painting.frames.get(panel)?.area))
    }

    /// The axes of a panel.
    pub fn axes(&self, panel: usize) -> Option<[&PlotAxis; 2]> {
        self.painting.frames.get(panel).map(|frame| [&frame.x, &frame.y])
    }

    /// The rectangle of its surface on the screen.
    pub fn surface(&self) -> Option<Rect> {
        Some(self.painting.rect(self.painting.surface.as_ref()?.area))
    }

    /// The place on the screen of a point of its surface.
    pub fn place_on_surface(&self, point: (f64, f64, f64)) -> Option<Pos2> {
        Some(self.painting.place(self.painting.surface.as_ref()?.point(point)))
    }

    /// The column and row of the surface's cell at a place on the screen.
    pub fn surface_cell(&self, at: Pos2) -> Option<(usize, usize)> {
        let (cells, _) = self.chart.panels().next()?.surface()?;
        let place = (at - self.painting.origin) / UNIT;
        self.painting.surface.as_ref()?.cell_at(cells, (place.x.into(), place.y.into()))
    }
}

/// What is painted of a chart at a place of the screen.
struct Painting {
    origin: Pos2,
    frames: Vec<Frame>,
    surface: Option<SurfaceFrame>,
    mesh: Arc<Mesh>,
    texts: Vec<Text>,
}

impl Painting {
    /// The chart laid out in `area`, its shapes but the texts as one mesh.
    fn new(ui: &Ui, style: &Style, area: Rect, chart: &Chart) -> Self {
        let size = (f64::from(area.width() / UNIT), f64::from(area.height() / UNIT));
        let Figure { shapes, frames, surface, .. } = chart.pane(size, &style.theme());
        // prerasterized discs lie in a texture that may change
        let options = TessellationOptions { prerasterized_discs: false, ..TessellationOptions::default() };
        let mut tessellator = Tessellator::new(ui.pixels_per_point(), options, [1, 1], Vec::new());
        let (mut mesh, mut texts) = (Mesh::default(), Vec::new());
        let mut painting =
            Self { origin: area.min, frames, surface, mesh: Arc::default(), texts: Vec::new() };
        for shape in shapes {
            let places = |points: &[(f64, f64)]| points.iter().map(|point| painting.place(*point)).collect();
            match shape {
                // without a soft edge, so that neighbouring cells leave no seam
                Drawn::Rect(area, ink) => mesh.add_colored_rect(painting.rect(area), colour(ink)),
                Drawn::Line(points, width, ink) => {
                    let stroke = Stroke::new(style.width(width as f32 * UNIT), colour(ink));
                    tessellator.tessellate_shape(Shape::line(places(&points), stroke), &mut mesh);
                }
                Drawn::Polygon(points, ink) => {
                    let shape = Shape::convex_polygon(places(&points), colour(ink), Stroke::NONE);
                    tessellator.tessellate_shape(shape, &mut mesh);
                }
                Drawn::Disc(centre, radius, ink) => {
                    let radius = style.dot((radius as f32 * UNIT).max(LEAST_DOT));
                    let disc = Shape::circle_filled(painting.place(centre), radius, colour(ink));
                    tessellator.tessellate_shape(disc, &mut mesh);
                }
                Drawn::Text(text) => texts.push(text),
            }
        }
        (painting.mesh, painting.texts) = (Arc::new(mesh), texts);
        painting
    }

    fn paint(&self, painter: &Painter) {
        painter.add(Shape::Mesh(Arc::clone(&self.mesh)));
        self.texts.iter().for_each(|text| write(painter, self.place(text.at), text));
    }

    /// The place on the screen of one on the canvas.
    fn place(&self, (x, y): (f64, f64)) -> Pos2 {
        pos2(self.origin.x + x as f32 * UNIT, self.origin.y + y as f32 * UNIT)
    }

    fn rect(&self, Area { left, top, right, bottom }: Area) -> Rect {
        Rect::from_min_max(self.place((left, top)), self.place((right, bottom)))
    }
}

fn write(painter: &Painter, at: Pos2, text: &Text) {
    let (size, ink) = (text.size as f32 * UNIT, colour(text.ink));
    let family = if text.bold { strong_family() } else { FontFamily::Proportional };
    let galley = painter.layout_no_wrap(text.words.clone(), FontId::new(size, family), ink);
    let before = text.before() as f32 * UNIT;
    let (corner, angle) = match text.upright {
        true => (pos2(at.x - ASCENT * size, at.y + before), -FRAC_PI_2),
        false => (pos2(at.x - before, at.y - ASCENT * size), 0.0),
    };
    painter.add(TextShape::new(corner, galley, ink).with_angle(angle));
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
    let painting = Arc::new(Painting::new(ui, style, area, &chart));
    let response = ui.interact(area, ui.scope_id().with("chart"), Sense::click_and_drag());
    painting.paint(&ui.painter().with_clip_rect(area));
    let pane = Pane { response, chart: Arc::new(chart), painting };
    if let Some(frame) = pane.frame(0) {
        axes_input(ui, memory, view, &pane.response, (area, frame));
    }
    pane
}

/// A chart as it was painted last, for a key and a place of the screen.
#[derive(Clone)]
struct Kept<K> {
    key: (K, Rect, f32),
    chart: Arc<Chart>,
    painting: Arc<Painting>,
}

/// Paints a chart in `area` as it was painted before, as long as `key` and `area` stay the same; else it is
/// made anew.
pub fn kept_pane_ui<K: Clone + PartialEq + Send + Sync + 'static>(
    ui: &mut Ui,
    style: &Style,
    area: Rect,
    key: K,
    chart: impl FnOnce() -> Chart,
) -> Pane {
    let id: Id = ui.scope_id().with("kept chart");
    let key = (key, area, ui.pixels_per_point());
    let kept = ui.data(|data| data.get_temp::<Kept<K>>(id)).filter(|kept| kept.key == key);
    let kept = kept.unwrap_or_else(|| {
        let chart = Arc::new(chart());
        let painting = Arc::new(Painting::new(ui, style, area, &chart));
        let kept = Kept { key, chart, painting };
        ui.data_mut(|data| data.insert_temp(id, kept.clone()));
        kept
    });
    let response = ui.interact(area, ui.scope_id().with("chart"), Sense::click_and_drag());
    kept.painting.paint(&ui.painter().with_clip_rect(area));
    Pane { response, chart: kept.chart, painting: kept.painting }
}
