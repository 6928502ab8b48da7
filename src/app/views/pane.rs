//! A chart in a place of the window: the shapes of its picture on paper, painted by egui.

use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

use eframe::egui::epaint::{TessellationOptions, Tessellator, TextShape};
use eframe::egui::{
    Color32, FontFamily, FontId, Id, Mesh, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, pos2,
};

use crate::app::ui::style::{BODY, SMALL, STATUS, Style, colour, strong_family};
use crate::app::words::meanings::explained;
use crate::output::{Area, Chart, Figure, Frame, Panel, Shape as Drawn, SurfaceFrame, TICK, Text, is_fine};

/// Points of the screen in a unit of a chart.
pub const UNIT: f32 = SMALL / TICK as f32;

/// Width in points to the left of a legend below the titles of its card.
pub const LEGEND_LEFT: f32 = 6.0;

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
    pub fn surface(&self) -> Option<Rect> {
        Some(self.painting.rect(self.painting.surface.as_ref()?.area))
    }

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

/// A chart as painted at a place of the screen.
struct Painting {
    origin: Pos2,
    surface: Option<SurfaceFrame>,
    legend: Vec<(Rect, String)>,
    mesh: Arc<Mesh>,
    texts: Vec<Text>,
}

impl Painting {
    /// The chart laid out in a place, its shapes but the texts as one mesh.
    fn new(ui: &Ui, style: &Style, area: Rect, chart: &Chart) -> Self {
        let size = (f64::from(area.width() / UNIT), f64::from(area.height() / UNIT));
        let Figure { shapes, surface, legend, .. } = chart.pane(size, &style.theme());
        let mut painting = Self { surface, ..Self::bare(area.min) };
        painting.legend = legend.into_iter().map(|(area, words)| (painting.rect(area), words)).collect();
        let (mesh, texts) = painting.mesh(ui.pixels_per_point(), style, shapes);
        (painting.mesh, painting.texts) = (Arc::new(mesh), texts);
        painting
    }

    /// An empty canvas with its corner at a place of the screen.
    fn bare(origin: Pos2) -> Self {
        let (mesh, texts) = (Arc::default(), Vec::new());
        Self { origin, surface: None, legend: Vec::new(), mesh, texts }
    }

    /// Shapes of the canvas as a mesh on the screen, and the texts among them.
    fn mesh(&self, pixels: f32, style: &Style, shapes: Vec<Drawn>) -> (Mesh, Vec<Text>) {
        // prerasterized discs lie in a texture that may change
        let options = TessellationOptions { prerasterized_discs: false, ..TessellationOptions::default() };
        let mut tessellator = Tessellator::new(pixels, options, [1, 1], Vec::new());
        let (mut mesh, mut texts) = (Mesh::default(), Vec::new());
        for shape in shapes {
            match shape {
                // without a soft edge, so that neighbouring cells leave no seam
                Drawn::Rect(area, ink) => mesh.add_colored_rect(self.rect(area), colour(ink)),
                Drawn::Text(text) => texts.push(text),
                shape => tessellator.tessellate_shape(self.shape(style, shape), &mut mesh),
            }
        }
        (mesh, texts)
    }

    /// A shape other than a text on the screen.
    fn shape(&self, style: &Style, shape: Drawn) -> Shape {
        let places = |points: &[(f64, f64)]| points.iter().map(|point| self.place(*point)).collect();
        match shape {
            Drawn::Rect(area, ink) => Shape::rect_filled(self.rect(area), 0.0, colour(ink)),
            Drawn::Line(points, width, ink) => {
                // frame and grid stay thin for a projector
                let width = if is_fine(width) { width as f32 * UNIT } else { style.line(width) };
                Shape::line(places(&points), Stroke::new(width, colour(ink)))
            }
            Drawn::Polygon(points, ink) => {
                let corners: Vec<Pos2> = places(&points);
                match has_sharp_corner(&corners) {
                    true => Shape::mesh(hard_edged(&corners, colour(ink))),
                    false => Shape::convex_polygon(corners, colour(ink), Stroke::NONE),
                }
            }
            Drawn::Disc(centre, radius, ink) => {
                let larger = if style.projector { 1.4 } else { 1.0 };
                let radius = larger * (radius as f32 * UNIT).max(LEAST_DOT);
                Shape::circle_filled(self.place(centre), radius, colour(ink))
            }
            Drawn::Text(_) => Shape::Noop,
        }
    }

    fn paint(&self, painter: &Painter) {
        painter.add(Shape::Mesh(Arc::clone(&self.mesh)));
        self.texts.iter().for_each(|text| write(painter, self.place(text.at), text));
    }

    /// The place on the screen of a point of the canvas.
    fn place(&self, (x, y): (f64, f64)) -> Pos2 {
        pos2(self.origin.x + x as f32 * UNIT, self.origin.y + y as f32 * UNIT)
    }

    fn rect(&self, Area { left, top, right, bottom }: Area) -> Rect {
        Rect::from_min_max(self.place((left, top)), self.place((right, bottom)))
    }
}

/// Paints shapes of a canvas whose corner is at `origin`.
pub fn paint(painter: &Painter, style: &Style, origin: Pos2, shapes: Vec<Drawn>) {
    let canvas = Painting::bare(origin);
    for shape in shapes {
        match shape {
            Drawn::Text(text) => write(painter, canvas.place(text.at), &text),
            shape => _ = painter.add(canvas.shape(style, shape)),
        }
    }
}

/// Shapes of a canvas whose corner is at `origin`, for the screen.
pub fn on_canvas(painter: &Painter, style: &Style, origin: Pos2, shapes: Vec<Drawn>) -> Vec<Shape> {
    let canvas = Painting::bare(origin);
    let (mesh, texts) = canvas.mesh(painter.pixels_per_point(), style, shapes);
    let texts = texts.iter().map(|text| written(painter, canvas.place(text.at), text).into());
    std::iter::once(Shape::mesh(mesh)).chain(texts).collect()
}

/// An area of such a canvas on the screen.
pub fn on_screen(origin: Pos2, area: Area) -> Rect {
    Painting::bare(origin).rect(area)
}

/// Paints the layers of a panel over all of `rect`, without its axes.
pub fn bare_panel(painter: &Painter, style: &Style, rect: Rect, Panel { x, y, layers, .. }: &Panel) {
    let (right, bottom) = (f64::from(rect.width() / UNIT), f64::from(rect.height() / UNIT));
    let frame = Frame { area: Area::new(0.0, 0.0, right, bottom), x: x.clone(), y: y.clone() };
    let canvas = Painting::bare(rect.min);
    let (mesh, _) = canvas.mesh(painter.pixels_per_point(), style, frame.shapes(layers, &style.theme()));
    painter.add(Shape::mesh(mesh));
}

/// Whether the soft edge of a polygon, which has no limit at its corners, would stand out by more than three
/// times its width.
fn has_sharp_corner(corners: &[Pos2]) -> bool {
    let before = corners.iter().cycle().skip(corners.len().saturating_sub(1));
    let after = corners.iter().cycle().skip(1);
    before.zip(corners).zip(after).any(|((before, at), after)| {
        let cosine = (*at - *before).normalized().dot((*after - *at).normalized());
        0.5 * (1.0 + cosine) < 1.0 / 9.0
    })
}

/// A convex polygon without a soft edge.
fn hard_edged(corners: &[Pos2], ink: Color32) -> Mesh {
    let mut mesh = Mesh::default();
    corners.iter().for_each(|corner| mesh.colored_vertex(*corner, ink));
    (2..corners.len() as u32).for_each(|last| mesh.add_triangle(0, last - 1, last));
    mesh
}

fn write(painter: &Painter, at: Pos2, text: &Text) {
    painter.add(written(painter, at, text));
}

fn written(painter: &Painter, at: Pos2, text: &Text) -> TextShape {
    let (wanted, ink) = (text.size as f32 * UNIT, colour(text.ink));
    // the name of an axis is as large as its numbers: the window has three sizes
    let size = [STATUS, BODY, SMALL].into_iter().find(|size| *size <= wanted + 0.1).unwrap_or(wanted);
    let family = if text.bold { strong_family() } else { FontFamily::Proportional };
    let galley = painter.layout_no_wrap(text.words.clone(), FontId::new(size, family), ink);
    let before = text.before() as f32 * UNIT * size / wanted;
    let (corner, angle) = match text.upright {
        true => (pos2(at.x - ASCENT * size, at.y + before), -FRAC_PI_2),
        false => (pos2(at.x - before, at.y - ASCENT * size), 0.0),
    };
    TextShape::new(corner, galley, ink).with_angle(angle)
}

/// Shows a chart that was painted for this place.
fn shown(ui: &mut Ui, area: Rect, chart: Arc<Chart>, painting: Arc<Painting>) -> Pane {
    let response = ui.interact(area, ui.scope_id().with("chart"), Sense::click_and_drag());
    // a frame at its edge is whole
    painting.paint(&ui.painter().with_clip_rect(area.expand(1.0)));
    for (rect, words) in &painting.legend {
        explained(ui.interact(*rect, ui.scope_id().with(("legend", words)), Sense::hover()), words);
    }
    Pane { response, chart, painting }
}

/// A chart as it was painted last, for a key and a place of the screen.
#[derive(Clone)]
struct Kept<K> {
    key: (K, Rect, f32),
    chart: Arc<Chart>,
    painting: Arc<Painting>,
}

/// Paints a chart in a place as it was painted before, as long as `key` and the place stay the same; else it
/// is made anew.
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
    shown(ui, area, kept.chart, kept.painting)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::BLACK;

    fn canvas() -> (Painting, Style) {
        (Painting::bare(Pos2::ZERO), Style { dark: false, projector: false })
    }

    /// The soft edges of thin triangles, such as those of a surface, do not stand out of them.
    #[test]
    fn a_thin_triangle_has_no_needles() {
        let (canvas, style) = canvas();
        for tenth in 0..200 {
            let thin = vec![(100.0, 100.0), (300.0, 100.0 + 0.1 * f64::from(tenth)), (120.0, 101.0)];
            let (mesh, _) = canvas.mesh(1.0, &style, vec![Drawn::Polygon(thin.clone(), BLACK)]);
            let places = thin.into_iter().map(|corner| canvas.place(corner));
            let bounds = Rect::from_points(&places.collect::<Vec<Pos2>>()).expand(2.0);
            assert!(mesh.vertices.len() >= 3);
            assert!(mesh.vertices.iter().all(|vertex| bounds.contains(vertex.pos)), "{tenth}");
        }
    }

    /// The joins of a line neither cut its peaks nor lengthen them: all of one height end within a pixel.
    #[test]
    fn peaks_of_one_height_are_drawn_as_high() {
        let (canvas, style) = canvas();
        let top = |half: f64| {
            let peak = vec![(100.0 - half, 400.0), (100.0, 100.0), (100.0 + half, 400.0)];
            let (mesh, _) = canvas.mesh(1.0, &style, vec![Drawn::Line(peak, 2.4, BLACK)]);
            mesh.vertices.iter().map(|vertex| vertex.pos.y).fold(f32::INFINITY, f32::min)
        };
        // one that goes back exactly on itself has no join, and ends half its width lower
        let tops = [0.01, 0.1, 1.0, 4.0, 20.0, 100.0].map(top);
        let peak = 100.0 * UNIT;
        assert!(tops.iter().all(|top| (peak - 2.2..=peak).contains(top)), "{tops:?} at {peak}");
        let ends =
            tops.iter().fold((f32::INFINITY, 0.0_f32), |(low, high), top| (low.min(*top), high.max(*top)));
        assert!(ends.1 - ends.0 < 1.0, "{tops:?}");
    }
}
