//! Painting of a list of shapes as PNG.

use png::{PixelDimensions, Unit};
use skrifa::outline::OutlinePen;
use tiny_skia::{FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform};

use super::figure::{Area, Figure, Point, Shape, Text};
use super::font::{FontFace, UNITS};
use super::style::Ink;

/// Why a picture could not be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the picture cannot be drawn: {0}")]
pub struct PaintError(String);

fn failed(error: impl std::fmt::Display) -> PaintError {
    PaintError(error.to_string())
}

pub fn png(figure: &Figure) -> Result<Vec<u8>, PaintError> {
    let (wide, high) = (figure.shown.right - figure.shown.left, figure.shown.bottom - figure.shown.top);
    let (width, height) = match (figure.sheet.zip(figure.size_mm()), figure.size) {
        (Some((sheet, (width, height))), _) => (sheet.pixels(width), sheet.pixels(height)),
        (None, Some(size)) => size,
        (None, None) => (wide.round() as u32, high.round() as u32),
    };
    let scale = (f64::from(width) / wide).min(f64::from(height) / high);
    let move_by = (
        0.5 * (f64::from(width) - wide * scale) - figure.shown.left * scale,
        0.5 * (f64::from(height) - high * scale) - figure.shown.top * scale,
    );
    let pixels = Pixmap::new(width, height);
    let pixels = pixels.ok_or_else(|| failed(format!("a picture of {width} by {height} pixels")))?;
    let mut canvas = Canvas { pixels, scale, move_by };
    if let Some(Shape::Rect(_, Ink(red, green, blue))) = figure.shapes.first() {
        canvas.pixels.fill(tiny_skia::Color::from_rgba8(*red, *green, *blue, 255));
    }
    figure.shapes.iter().for_each(|shape| canvas.paint(shape));
    let rgb: Vec<u8> =
        canvas.pixels.pixels().iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    if let Some(sheet) = figure.sheet {
        let a_metre = (sheet.dpi / 0.0254).round() as u32;
        let dims = PixelDimensions { xppu: a_metre, yppu: a_metre, unit: Unit::Meter };
        encoder.set_pixel_dims(Some(dims));
    }
    for (keyword, words) in [("Software", figure.software()), ("Description", figure.made())] {
        encoder.add_itxt_chunk(keyword.to_owned(), words).map_err(failed)?;
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&rgb).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// Pixels, and where the shapes stand on them.
struct Canvas {
    pixels: Pixmap,
    scale: f64,
    move_by: (f64, f64),
}

impl Canvas {
    fn paint(&mut self, shape: &Shape) {
        match shape {
            Shape::Rect(area, ink) => self.rect(*area, *ink),
            Shape::Line(points, width, ink) => {
                let stroke = Stroke {
                    width: *width as f32,
                    line_cap: LineCap::Round,
                    line_join: LineJoin::Round,
                    ..Stroke::default()
                };
                if let Some(path) = path(points, false) {
                    self.pixels.stroke_path(&path, &paint(*ink), &stroke, self.transform(), None);
                }
            }
            // with a thin outline, so that no gap shows between neighbours
            Shape::Polygon(points, ink) => {
                let path = path(points, true);
                let stroke = Stroke { width: (0.8 / self.scale) as f32, ..Stroke::default() };
                if let Some(path) = &path {
                    self.pixels.stroke_path(path, &paint(*ink), &stroke, self.transform(), None);
                }
                self.fill(path, *ink);
            }
            Shape::Disc((x, y), radius, ink) => {
                self.fill(PathBuilder::from_circle(*x as f32, *y as f32, *radius as f32), *ink);
            }
            Shape::Text(text) => self.fill(letters(text), text.ink),
        }
    }

    fn transform(&self) -> Transform {
        let (scale, (x, y)) = (self.scale as f32, self.move_by);
        Transform::from_row(scale, 0.0, 0.0, scale, x as f32, y as f32)
    }

    fn fill(&mut self, path: Option<Path>, ink: Ink) {
        if let Some(path) = path {
            self.pixels.fill_path(&path, &paint(ink), FillRule::Winding, self.transform(), None);
        }
    }

    /// Fills whole pixels, so that the background does not show between the cells of a map.
    fn rect(&mut self, area: Area, ink: Ink) {
        let across = |x: f64| (x * self.scale + self.move_by.0).round() as f32;
        let down = |y: f64| (y * self.scale + self.move_by.1).round() as f32;
        let (left, top) = (across(area.left), down(area.top));
        let (right, bottom) = (across(area.right).max(left + 1.0), down(area.bottom).max(top + 1.0));
        if let Some(rect) = Rect::from_ltrb(left, top, right, bottom) {
            self.pixels.fill_rect(rect, &paint(ink), Transform::identity(), None);
        }
    }
}

fn paint(Ink(red, green, blue): Ink) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(red, green, blue, 255);
    paint
}

fn path(points: &[Point], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::with_capacity(points.len() + 2, points.len() + 1);
    for (i, (x, y)) in points.iter().enumerate() {
        match i {
            0 => path.move_to(*x as f32, *y as f32),
            _ => path.line_to(*x as f32, *y as f32),
        }
    }
    if closed {
        path.close();
    }
    path.finish()
}

/// The outline of a text on the canvas.
fn letters(text: &Text) -> Option<Path> {
    let face = FontFace::of(text.bold);
    let mut pen = Pen { path: PathBuilder::new(), text, from: -text.before() };
    let begin = pen.from;
    for letter in face.letters(&text.words) {
        pen.from = begin + text.size * letter.begin;
        face.outline(letter.glyph, &mut pen);
    }
    pen.path.finish()
}

/// Draws the outlines of letters where they stand on the canvas.
struct Pen<'a> {
    path: PathBuilder,
    text: &'a Text,
    /// Where the letter begins, along the text.
    from: f64,
}

impl Pen<'_> {
    /// The place on the canvas of one in the font's units.
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        let unit = self.text.size / UNITS;
        let (along, up) = (self.from + unit * f64::from(x), unit * f64::from(y));
        let (x, y) = self.text.at;
        let (x, y) = if self.text.upright { (x - up, y - along) } else { (x + along, y - up) };
        (x as f32, y as f32)
    }
}

impl OutlinePen for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, cx0: f32, cy0: f32, x: f32, y: f32) {
        let ((cx0, cy0), (x, y)) = (self.at(cx0, cy0), self.at(x, y));
        self.path.quad_to(cx0, cy0, x, y);
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        let ((cx0, cy0), (cx1, cy1), (x, y)) = (self.at(cx0, cy0), self.at(cx1, cy1), self.at(x, y));
        self.path.cubic_to(cx0, cy0, cx1, cy1, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
