//! A chart in a place of the window: the shapes of its picture on paper, painted by egui.

use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

use eframe::egui::epaint::{TessellationOptions, Tessellator, TextShape};
use eframe::egui::{
    Align2, Color32, FontFamily, FontId, Id, Mesh, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui,
    pos2, vec2,
};

use crate::app::ui::style::{BODY, SMALL, STATUS, Style, colour, strong_family};
use crate::app::words::meanings::explained;
use crate::app::words::numbers::with_minus;
use crate::output::{
    Area, Chart, Figure, Frame, Layer, Panel, PlotAxis, Room, Shape as Drawn, SurfaceFrame, TICK, Text,
    is_fine,
};

use super::LegendRow;
use super::hand::axes_input;
use super::labels::plated;
use super::memory::Memory;
use super::view::View;

/// Points of the screen in a unit of a chart.
pub const UNIT: f32 = SMALL / TICK as f32;

/// Width in points from the left edge of a view to its frame, where it stands in line with others.
pub const GUTTER: f32 = 62.0;

/// Width in points from the frame of such a view to its right edge.
pub const RIGHT: f32 = 8.0;

pub const LEGEND: f32 = LegendRow::HEIGHT;

/// Width in points to the left of a legend below the titles of its card.
pub const LEGEND_LEFT: f32 = 6.0;

/// Time in s after which what is written at a resting pointer goes.
const LINGER: f32 = 5.0;

/// Least radius in points of a dot that can be seen.
const LEAST_DOT: f32 = 1.5;

/// Ascent of the letters in ems.
const ASCENT: f32 = 1984.0 / 2048.0;

/// A place of the window for a chart.
pub struct Place {
    area: Rect,
    room: Option<Room>,
    sense: Sense,
}

impl From<Rect> for Place {
    fn from(area: Rect) -> Self {
        Self { area, room: None, sense: Sense::click_and_drag() }
    }
}

impl Place {
    /// A place in line with those above and below it, on a ground that the view has painted. It leaves these
    /// widths and heights in points free: beside the legend, and between it and the picture.
    pub fn in_line(ui: &Ui, area: Rect, sense: Sense, (beside, between): (f32, f32)) -> Self {
        let area = area.with_max_x(area.right() - RIGHT);
        let unit = |points: f32| f64::from(points / UNIT);
        let row = LegendRow::of(ui, area);
        // a legend that fits into the row of the card is in line with the frame, else it has rows of the full
        // width
        let shares = LegendRow::given(ui).is_some();
        let legend = if shares { (row.left - area.left()).max(GUTTER) } else { LEGEND_LEFT };
        let room = Room {
            left: unit(GUTTER),
            legend: unit(legend),
            below: unit(LEGEND_LEFT),
            beside: unit(beside + area.right() - row.right),
            between: unit(between),
        };
        Self { area, room: Some(room), sense }
    }
}

/// A chart that was painted.
pub struct Pane {
    pub response: Response,
    pub chart: Arc<Chart>,
    painting: Arc<Painting>,
}

impl Pane {
    pub fn draw(&self, painter: &Painter, style: &Style, panel: usize, layers: &[Layer]) {
        let Some(frame) = self.painting.frames.get(panel) else { return };
        let (mesh, _) =
            self.painting.mesh(painter.pixels_per_point(), style, frame.shapes(layers, &style.theme()));
        painter.add(Shape::mesh(mesh));
    }

    /// Writes the values under the pointer at the right end of the legend, `beside` points from the end, or
    /// where that has no room in a corner of the frame.
    pub fn reading(&self, ui: &Ui, style: &Style, beside: f32, text: &str) {
        let area = self.response.rect;
        let painter = ui.painter().with_clip_rect(area);
        let galley = painter.layout_no_wrap(with_minus(text), style.small(), style.ink());
        let free = LegendRow::of(ui, area);
        let row = Rect::from_min_max(area.min, pos2(free.right - beside, area.top() + LEGEND));
        let at = Align2::RIGHT_CENTER.anchor_size(row.right_center() - vec2(6.0, 0.0), galley.size());
        let is_cut = at.left() < free.left
            || self.painting.legend.iter().any(|entry| entry.0.intersects(at.expand2(vec2(4.0, 0.0))));
        match self.frame(0).filter(|_| is_cut) {
            Some(frame) => {
                let corner = (frame.right_top() + vec2(-4.0, 4.0), Align2::RIGHT_TOP);
                plated(&painter, style, corner, &with_minus(text), (style.small(), style.ink()));
            }
            None => painter.galley(at.min, galley, style.ink()),
        }
    }

    /// The values of a panel's axes at a place on the screen.
    pub fn values_at(&self, panel: usize, at: Pos2) -> Option<(f64, f64)> {
        let (rect, frame) = (self.frame(panel)?, self.painting.frames.get(panel)?);
        let value = |axis: &PlotAxis, share: f32| axis.low + f64::from(share) * (axis.high - axis.low);
        let across = (at.x - rect.left()) / rect.width();
        Some((value(&frame.x, across), value(&frame.y, (rect.bottom() - at.y) / rect.height())))
    }

    /// The place of the pointer over the view. `None` after it has rested for long: what is written at it
    /// would cover the picture.
    pub fn hovered(&self) -> Option<Pos2> {
        let rests = self.response.ctx.input(|input| {
            let pointer = &input.pointer;
            let is_pressed = pointer.any_down() || pointer.any_released();
            pointer.time_since_last_movement() > LINGER && !is_pressed
        });
        self.response.hover_pos().filter(|_| !rests)
    }

    /// The values of the first panel's axes under the pointer, if that is in its frame.
    pub fn pointed(&self) -> Option<(f64, f64)> {
        let frame = self.frame(0)?;
        self.values_at(0, self.hovered().filter(|at| frame.contains(*at))?)
    }

    pub fn place(&self, panel: usize, point: (f64, f64)) -> Option<Pos2> {
        Some(self.painting.place(self.painting.frames.get(panel)?.place(point)))
    }

    pub fn frame(&self, panel: usize) -> Option<Rect> {
        Some(self.painting.rect(self.painting.frames.get(panel)?.area))
    }

    pub fn axes(&self, panel: usize) -> Option<[&PlotAxis; 2]> {
        self.painting.frames.get(panel).map(|frame| [&frame.x, &frame.y])
    }

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
    frames: Vec<Frame>,
    surface: Option<SurfaceFrame>,
    legend: Vec<(Rect, String)>,
    mesh: Arc<Mesh>,
    texts: Vec<Text>,
}

impl Painting {
    /// The chart laid out in a place, its shapes but the texts as one mesh.
    fn new(ui: &Ui, style: &Style, Place { area, room, .. }: &Place, chart: &Chart) -> Self {
        let size = (f64::from(area.width() / UNIT), f64::from(area.height() / UNIT));
        let figure = chart.pane(size, &style.theme(), room.as_ref());
        let Figure { mut shapes, frames, surface, legend, .. } = figure;
        if room.is_some() {
            shapes.remove(0); // the ground, on which the view may have written
        }
        let mut painting = Self { frames, surface, ..Self::bare(area.min) };
        painting.legend = legend.into_iter().map(|(area, words)| (painting.rect(area), words)).collect();
        let (mesh, texts) = painting.mesh(ui.pixels_per_point(), style, shapes);
        (painting.mesh, painting.texts) = (Arc::new(mesh), texts);
        painting
    }

    /// An empty canvas with its corner at a place of the screen.
    fn bare(origin: Pos2) -> Self {
        let (mesh, texts) = (Arc::default(), Vec::new());
        Self { origin, frames: Vec::new(), surface: None, legend: Vec::new(), mesh, texts }
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
    let pane = fresh_pane_ui(ui, style, area, chart);
    if let Some(frame) = pane.frame(0) {
        axes_input(ui, memory, view, &pane.response, (area, frame));
    }
    pane
}

pub fn fresh_pane_ui(ui: &mut Ui, style: &Style, place: impl Into<Place>, chart: Chart) -> Pane {
    let place = place.into();
    let painting = Arc::new(Painting::new(ui, style, &place, &chart));
    shown(ui, &place, Arc::new(chart), painting)
}

/// Shows a chart that was painted for this place.
fn shown(ui: &mut Ui, place: &Place, chart: Arc<Chart>, painting: Arc<Painting>) -> Pane {
    let response = ui.interact(place.area, ui.scope_id().with("chart"), place.sense);
    // a frame at its edge is whole
    painting.paint(&ui.painter().with_clip_rect(place.area.expand(1.0)));
    for (rect, words) in &painting.legend {
        explained(ui.interact(*rect, ui.scope_id().with(("legend", words)), Sense::hover()), words);
    }
    Pane { response, chart, painting }
}

/// A chart as it was painted last, for a key and a place of the screen.
#[derive(Clone)]
struct Kept<K> {
    key: (K, Rect, Option<Room>, f32),
    chart: Arc<Chart>,
    painting: Arc<Painting>,
}

/// Paints a chart in a place as it was painted before, as long as `key` and the place stay the same; else it
/// is made anew.
pub fn kept_pane_ui<K: Clone + PartialEq + Send + Sync + 'static>(
    ui: &mut Ui,
    style: &Style,
    place: impl Into<Place>,
    key: K,
    chart: impl FnOnce() -> Chart,
) -> Pane {
    let place = place.into();
    let id: Id = ui.scope_id().with("kept chart");
    let key = (key, place.area, place.room, ui.pixels_per_point());
    let kept = ui.data(|data| data.get_temp::<Kept<K>>(id)).filter(|kept| kept.key == key);
    let kept = kept.unwrap_or_else(|| {
        let chart = Arc::new(chart());
        let painting = Arc::new(Painting::new(ui, style, &place, &chart));
        let kept = Kept { key, chart, painting };
        ui.data_mut(|data| data.insert_temp(id, kept.clone()));
        kept
    });
    shown(ui, &place, kept.chart, kept.painting)
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
