//! Painting of a list of shapes as PDF: paths, and text as text with the letters used embedded.
//!
//! krilla writes the file, without a date and with an identity made from what is in it, so the same picture
//! is the same bytes.

use krilla::Document;
use krilla::color::rgb;
use krilla::geom::{PathBuilder, Point as Place, Rect, Transform};
use krilla::metadata::Metadata;
use krilla::page::PageSettings;
use krilla::paint::{Fill, LineCap, LineJoin, Stroke};
use krilla::surface::Surface;
use krilla::text::{Font, TextDirection};

use super::figure::{Align, Area, Figure, Point, Shape, Text};
use super::font::{self, FACES};
use super::paint::{PaintError, failed};
use super::style::Ink;

/// Points of PDF in a mm, and in a pixel of a screen.
const A_MM: f64 = 72.0 / 25.4;
const A_PIXEL: f64 = 72.0 / 96.0;

/// Distance of a cubic's control points from the ends of a quarter of a unit circle, for the least error.
const QUARTER: f64 = 0.551_915_024_5;

/// The picture as PDF.
pub fn pdf(figure: &Figure) -> Result<Vec<u8>, PaintError> {
    let Area { left, top, right, bottom } = figure.shown;
    let (wide, high) = (right - left, bottom - top);
    let (width, height) = match (figure.size_mm(), figure.size) {
        (Some((width, height)), _) => (width * A_MM, height * A_MM),
        (None, Some((width, height))) => (f64::from(width) * A_PIXEL, f64::from(height) * A_PIXEL),
        (None, None) => (wide * A_PIXEL, high * A_PIXEL),
    };
    let faces = FACES.map(|bytes| Font::new(bytes.to_vec().into(), 0));
    let [Some(regular), Some(bold)] = faces else { return Err(failed("the font cannot be read")) };
    let mut document = Document::new();
    let title = figure.origin.get("title").and_then(|title| title.as_str()).unwrap_or_default();
    let about = Metadata::new().title(title.to_owned()).creator(figure.software());
    document.set_metadata(about.description(figure.made()));
    let settings = PageSettings::from_wh(width as f32, height as f32);
    let settings = settings.ok_or_else(|| failed(format!("a page of {width} by {height} points")))?;
    let mut page = document.start_page_with(settings);
    let mut surface = page.surface();
    if let Some(Shape::Rect(_, paper)) = figure.shapes.first() {
        fill(&mut surface, *paper);
        rect(&mut surface, Area::new(0.0, 0.0, width, height));
    }
    let scale = (width / wide).min(height / high);
    let move_by = (0.5 * (width - wide * scale) - left * scale, 0.5 * (height - high * scale) - top * scale);
    surface.push_transform(&Transform::from_row(
        scale as f32,
        0.0,
        0.0,
        scale as f32,
        move_by.0 as f32,
        move_by.1 as f32,
    ));
    for shape in figure.shapes.iter().skip(1) {
        match shape {
            Shape::Rect(area, ink) => {
                fill(&mut surface, *ink);
                rect(&mut surface, *area);
            }
            Shape::Line(points, width, ink) => line(&mut surface, points, *width, *ink),
            Shape::Polygon(points, ink) => {
                fill(&mut surface, *ink);
                outline(&mut surface, points, true);
            }
            Shape::Disc(centre, radius, ink) => {
                fill(&mut surface, *ink);
                disc(&mut surface, *centre, *radius);
            }
            Shape::Text(text) => write(&mut surface, text, if text.bold { &bold } else { &regular }),
        }
    }
    surface.pop();
    surface.finish();
    page.finish();
    document.finish().map_err(|error| failed(format!("{error:?}")))
}

fn colour(Ink(red, green, blue): Ink) -> rgb::Color {
    rgb::Color::new(red, green, blue)
}

fn fill(surface: &mut Surface, ink: Ink) {
    surface.set_stroke(None);
    surface.set_fill(Some(Fill { paint: colour(ink).into(), ..Fill::default() }));
}

fn rect(surface: &mut Surface, Area { left, top, right, bottom }: Area) {
    let mut path = PathBuilder::new();
    if let Some(rect) = Rect::from_ltrb(left as f32, top as f32, right as f32, bottom as f32) {
        path.push_rect(rect);
    }
    if let Some(path) = path.finish() {
        surface.draw_path(&path);
    }
}

/// A path through points, filled or drawn as the surface is set.
fn outline(surface: &mut Surface, points: &[Point], closed: bool) {
    let mut path = PathBuilder::new();
    for (i, (x, y)) in points.iter().enumerate() {
        if i == 0 {
            path.move_to(*x as f32, *y as f32);
        } else {
            path.line_to(*x as f32, *y as f32);
        }
    }
    if closed {
        path.close();
    }
    if let Some(path) = path.finish() {
        surface.draw_path(&path);
    }
}

fn line(surface: &mut Surface, points: &[Point], width: f64, ink: Ink) {
    surface.set_fill(None);
    surface.set_stroke(Some(Stroke {
        paint: colour(ink).into(),
        width: width as f32,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        ..Stroke::default()
    }));
    outline(surface, points, false);
}

fn disc(surface: &mut Surface, (x, y): Point, radius: f64) {
    let at = |dx: f64, dy: f64| ((x + radius * dx) as f32, (y + radius * dy) as f32);
    let mut path = PathBuilder::new();
    let (begin_x, begin_y) = at(1.0, 0.0);
    path.move_to(begin_x, begin_y);
    let mut from = (1.0, 0.0);
    for to in [(0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, 0.0)] {
        let (a, b) = (
            at(from.0 + QUARTER * to.0, from.1 + QUARTER * to.1),
            at(to.0 + QUARTER * from.0, to.1 + QUARTER * from.1),
        );
        let end = at(to.0, to.1);
        path.cubic_to(a.0, a.1, b.0, b.1, end.0, end.1);
        from = to;
    }
    path.close();
    if let Some(path) = path.finish() {
        surface.draw_path(&path);
    }
}

fn write(surface: &mut Surface, text: &Text, face: &Font) {
    let back = match text.align {
        Align::Left => 0.0,
        Align::Centre => 0.5,
        Align::Right => 1.0,
    } * font::width(&text.words, text.size, text.bold);
    let (x, y) = (text.at.0 as f32, text.at.1 as f32);
    let turn = if text.upright { (0.0, -1.0, 1.0, 0.0) } else { (1.0, 0.0, 0.0, 1.0) };
    surface.push_transform(&Transform::from_row(turn.0, turn.1, turn.2, turn.3, x, y));
    fill(surface, text.ink);
    let begin = Place::from_xy(-back as f32, 0.0);
    surface.draw_text(begin, face.clone(), text.size as f32, &text.words, false, TextDirection::LeftToRight);
    surface.pop();
}
