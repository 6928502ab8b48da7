//! Painting of a list of shapes as PNG or SVG.
//!
//! plotters draws both. Its bitmaps have whole pixels and hardly smooth an edge, so the picture is
//! drawn three times as large and averaged down; its SVG has whole coordinates too, so they are made
//! fine and the drawing is scaled to its size. Everything is cut to the canvas before it comes here.

use plotters::backend::{BitMapBackend, DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, RGBColor, ShapeStyle, TextStyle};

use png::{PixelDimensions, Unit};

use super::figure::{Align, Area, Figure, Point, Shape, Text};
use super::font::{LINE_HEIGHT, font};
use super::style::Ink;
use crate::numeric::short;

/// Why a picture could not be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the picture cannot be drawn: {0}")]
pub struct PaintError(String);

pub(super) fn failed(error: impl std::fmt::Display) -> PaintError {
    PaintError(error.to_string())
}

/// Pixels of the large bitmap in one of the picture, each way.
const FINER: u32 = 3;

/// Units of the SVG's coordinates in one of the canvas.
const SVG_UNITS: u32 = 8;

/// How one of plotters' backends understands lengths and texts.
#[derive(Clone, Copy)]
struct Terms {
    /// Its coordinates in a unit of the canvas.
    scale: f64,
    /// The place on the canvas that its origin shows.
    origin: Point,
    /// What it calls the size of a text whose em is 1.
    text_size: f64,
    /// How far below the top of a text, in ems, it puts the baseline.
    baseline: f64,
    /// Whether it draws thick lines well by itself.
    lines: bool,
}

/// The picture as PNG.
pub fn png(figure: &Figure) -> Result<Vec<u8>, PaintError> {
    let (wide, high) = (figure.shown.right - figure.shown.left, figure.shown.bottom - figure.shown.top);
    let (width, height) = match (figure.sheet.zip(figure.size_mm()), figure.size) {
        (Some((sheet, (width, height))), _) => (sheet.pixels(width), sheet.pixels(height)),
        (None, Some(size)) => size,
        (None, None) => (wide.round() as u32, high.round() as u32),
    };
    let share = (f64::from(width) / wide).min(f64::from(height) / high);
    let spare = (f64::from(width) / share - wide, f64::from(height) / share - high);
    let large = (width * FINER, height * FINER);
    let mut pixels = vec![0; large.0 as usize * large.1 as usize * 3];
    if let Some(Shape::Rect(_, Ink(red, green, blue))) = figure.shapes.first() {
        pixels.chunks_exact_mut(3).for_each(|pixel| pixel.copy_from_slice(&[*red, *green, *blue]));
    }
    let terms = Terms {
        scale: f64::from(FINER) * share,
        origin: (figure.shown.left - 0.5 * spare.0, figure.shown.top - 0.5 * spare.1),
        // ab_glyph's size is the line's height, and its text stands half a size below the given point.
        text_size: LINE_HEIGHT,
        baseline: 0.5 * LINE_HEIGHT,
        lines: false,
    };
    draw(figure, &mut BitMapBackend::with_buffer(&mut pixels, large), terms)?;
    let pixels = averaged(&pixels, width as usize);
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
    writer.write_image_data(&pixels).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// The picture as SVG.
pub fn svg(figure: &Figure) -> Result<String, PaintError> {
    let Area { left, top, right, bottom } = figure.shown;
    let units = |length: f64| (length * f64::from(SVG_UNITS)).round() as u32;
    let mut text = String::new();
    let terms = Terms {
        scale: SVG_UNITS.into(),
        origin: (0.0, 0.0),
        // plotters' own conventions: font-size = size/1.24, and the baseline 0.76 em below the top.
        text_size: 1.24,
        baseline: 0.76,
        lines: true,
    };
    let whole = (units(figure.canvas.right), units(figure.canvas.bottom));
    draw(figure, &mut SVGBackend::with_string(&mut text, whole), terms)?;
    let body = text.split_once('>').map_or("", |(_, body)| body);
    // Without crisp edges the paper shines through between the cells of a map.
    let body = body.replace("<rect ", "<rect shape-rendering=\"crispEdges\" ");
    let (width, height) = match (figure.size_mm(), figure.size) {
        (Some((width, height)), _) => (format!("{}mm", short(width)), format!("{}mm", short(height))),
        (None, Some((width, height))) => (width.to_string(), height.to_string()),
        (None, None) => {
            [right - left, bottom - top].map(|length| (units(length) / SVG_UNITS).to_string()).into()
        }
    };
    let made = figure.made().replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"{} {} {} {}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n\
         <metadata>{made}</metadata>{body}",
        units(left),
        units(top),
        units(right - left),
        units(bottom - top)
    ))
}

fn draw<B: DrawingBackend>(figure: &Figure, backend: &mut B, terms: Terms) -> Result<(), PaintError> {
    for shape in &figure.shapes {
        match shape {
            Shape::Rect(area, ink) => rect(backend, *area, *ink, terms)?,
            Shape::Line(points, width, ink) => line(backend, points, *width, *ink, terms)?,
            Shape::Polygon(points, ink) => polygon(backend, points, *ink, terms)?,
            Shape::Disc(centre, radius, ink) => {
                let radius = (radius * terms.scale).round().max(1.0) as u32;
                let filled = style(*ink, 1);
                backend.draw_circle(place(*centre, terms), radius, &filled, true).map_err(failed)?;
            }
            Shape::Text(text) => write(backend, text, terms)?,
        }
    }
    backend.present().map_err(failed)
}

fn place(point: Point, Terms { scale, origin, .. }: Terms) -> (i32, i32) {
    (((point.0 - origin.0) * scale).round() as i32, ((point.1 - origin.1) * scale).round() as i32)
}

fn style(ink: Ink, width: u32) -> ShapeStyle {
    ShapeStyle { color: RGBColor(ink.0, ink.1, ink.2).to_rgba(), filled: true, stroke_width: width }
}

fn rect<B: DrawingBackend>(backend: &mut B, area: Area, ink: Ink, terms: Terms) -> Result<(), PaintError> {
    let (from, to) = (place((area.left, area.top), terms), place((area.right, area.bottom), terms));
    backend.draw_rect(from, to, &style(ink, 1), true).map_err(failed)
}

fn polygon<B: DrawingBackend>(
    backend: &mut B,
    points: &[Point],
    ink: Ink,
    terms: Terms,
) -> Result<(), PaintError> {
    let corners: Vec<_> = points.iter().map(|point| place(*point, terms)).collect();
    backend.fill_polygon(corners, &style(ink, 1)).map_err(failed)
}

/// A thick line. In the bitmap each segment is a rectangle of its own, with a disc at every corner:
/// plotters' outline of a whole zigzag crosses itself and leaves holes.
fn line<B: DrawingBackend>(
    backend: &mut B,
    points: &[Point],
    width: f64,
    ink: Ink,
    terms: Terms,
) -> Result<(), PaintError> {
    if terms.lines {
        let path: Vec<_> = points.iter().map(|point| place(*point, terms)).collect();
        let width = (width * terms.scale).round().max(1.0) as u32;
        return backend.draw_path(path, &style(ink, width)).map_err(failed);
    }
    let half = 0.5 * width;
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let length = dx.hypot(dy);
        if length > 0.0 {
            let (nx, ny) = (-dy / length * half, dx / length * half);
            let corners =
                [(a.0 + nx, a.1 + ny), (b.0 + nx, b.1 + ny), (b.0 - nx, b.1 - ny), (a.0 - nx, a.1 - ny)];
            polygon(backend, &corners, ink, terms)?;
        }
    }
    let radius = half * terms.scale - 0.5;
    if radius >= 1.0 {
        for point in points {
            let centre = place(*point, terms);
            backend.draw_circle(centre, radius.round() as u32, &style(ink, 1), true).map_err(failed)?;
        }
    }
    Ok(())
}

fn write<B: DrawingBackend>(backend: &mut B, text: &Text, terms: Terms) -> Result<(), PaintError> {
    let rotated = if text.upright { FontTransform::Rotate270 } else { FontTransform::None };
    let font = font(text.size * terms.text_size * terms.scale, text.bold).transform(rotated);
    let h_pos = match text.align {
        Align::Left => HPos::Left,
        Align::Centre => HPos::Center,
        Align::Right => HPos::Right,
    };
    let ink = RGBColor(text.ink.0, text.ink.1, text.ink.2);
    let style = TextStyle::from(font).color(&ink).pos(Pos::new(h_pos, VPos::Top));
    let up = terms.baseline * text.size;
    let top = if text.upright { (text.at.0 - up, text.at.1) } else { (text.at.0, text.at.1 - up) };
    backend.draw_text(&text.words, &style, place(top, terms)).map_err(failed)
}

/// Each pixel the mean of a square of the large bitmap, in rows of `width`.
fn averaged(large: &[u8], width: usize) -> Vec<u8> {
    let finer = FINER as usize;
    let stride = width * finer * 3;
    let mut small = Vec::with_capacity(large.len() / (finer * finer));
    for rows in large.chunks_exact(stride * finer) {
        for column in 0..width {
            for channel in 0..3 {
                let at =
                    |row: usize, k: usize| u32::from(rows[row * stride + (column * finer + k) * 3 + channel]);
                let sum: u32 = (0..finer).flat_map(|row| (0..finer).map(move |k| at(row, k))).sum();
                small.push(((sum + FINER * FINER / 2) / (FINER * FINER)) as u8);
            }
        }
    }
    small
}
