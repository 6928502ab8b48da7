//! Painting of a list of shapes as SVG: paths, and text as text.

use super::figure::{Align, Area, Figure, Point, Shape, Text, oriented};
use super::style::Ink;
use crate::numeric::short;

/// The font families that an SVG requests.
const FAMILY: &str = "Inter, Helvetica, Arial, sans-serif";

/// Number of units of the SVG coordinates, which are whole numbers, per unit of the canvas.
const UNITS: f64 = 8.0;

pub fn svg(figure: &Figure) -> String {
    let Area { left, top, right, bottom } = figure.shown;
    let (width, height) = match (figure.size_mm(), figure.size) {
        (Some((width, height)), _) => (format!("{}mm", short(width)), format!("{}mm", short(height))),
        (None, Some((width, height))) => (width.to_string(), height.to_string()),
        (None, None) => [right - left, bottom - top].map(|length| length.round().to_string()).into(),
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"{} {} {} {}\" stroke-linejoin=\"round\" stroke-linecap=\"round\" \
         font-family=\"{FAMILY}\">\n<metadata>{}</metadata>\n",
        units(left),
        units(top),
        units(right - left),
        units(bottom - top),
        escaped(&figure.made()),
    );
    // consecutive shapes of the same kind and colour become one path
    for shapes in figure.shapes.chunk_by(|a, b| brush(a).is_some() && brush(a) == brush(b)) {
        match (&shapes[0], brush(&shapes[0])) {
            (Shape::Text(text), _) => write(&mut svg, text),
            (_, Some(brush)) => path(&mut svg, shapes, brush),
            _ => {}
        }
    }
    svg += "</svg>\n";
    svg
}

/// How a path is painted.
#[derive(Clone, Copy, PartialEq)]
enum Brush {
    /// Filled without antialiasing, so that the background does not show between the cells of a map.
    Crisp(Ink),
    Fill(Ink),
    Stroke(Ink, i64),
}

/// How a shape is painted; `None` for a text. A disc is a line of no length with round ends.
fn brush(shape: &Shape) -> Option<Brush> {
    Some(match shape {
        Shape::Rect(_, ink) => Brush::Crisp(*ink),
        Shape::Polygon(_, ink) => Brush::Fill(*ink),
        Shape::Line(_, width, ink) => Brush::Stroke(*ink, units(*width).max(1)),
        Shape::Disc(_, radius, ink) => Brush::Stroke(*ink, units(2.0 * radius).max(1)),
        Shape::Text(_) => return None,
    })
}

fn path(svg: &mut String, shapes: &[Shape], brush: Brush) {
    let painted = match brush {
        Brush::Crisp(ink) => format!("shape-rendering=\"crispEdges\" fill=\"{}\"", hex(ink)),
        Brush::Fill(ink) => format!("fill=\"{}\"", hex(ink)),
        Brush::Stroke(ink, width) => {
            format!("fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\"", hex(ink))
        }
    };
    *svg += &format!("<path {painted} d=\"");
    for shape in shapes {
        match shape {
            Shape::Rect(Area { left, top, right, bottom }, _) => {
                let [left, top, right, bottom] = [*left, *top, *right, *bottom].map(units);
                *svg += &format!("M{left} {top}H{right}V{bottom}H{left}z");
            }
            Shape::Polygon(points, _) => {
                line(svg, oriented(points).iter());
                svg.push('z');
            }
            Shape::Line(points, ..) => line(svg, points.iter()),
            Shape::Disc((x, y), ..) => *svg += &format!("M{} {}h.1", units(*x), units(*y)),
            Shape::Text(_) => {}
        }
    }
    *svg += "\"/>\n";
}

/// A line through points in relative coordinates.
fn line<'a>(svg: &mut String, points: impl Iterator<Item = &'a Point>) {
    let mut last: Option<(i64, i64)> = None;
    let mut moved = false;
    for (x, y) in points.map(|(x, y)| (units(*x), units(*y))) {
        match last {
            None => *svg += &format!("M{x} {y}"),
            Some((from_x, from_y)) if (x, y) != (from_x, from_y) => {
                // a sign also separates two numbers
                let (dx, dy) = (x - from_x, y - from_y);
                let space = |number: i64| if number < 0 { "" } else { " " };
                let before = if moved { space(dx) } else { "l" };
                *svg += &format!("{before}{dx}{}{dy}", space(dy));
                moved = true;
            }
            Some(_) => {}
        }
        last = Some((x, y));
    }
    if !moved {
        *svg += "h.1";
    }
}

fn write(svg: &mut String, text: &Text) {
    let (x, y) = (units(text.at.0), units(text.at.1));
    let anchor = match text.align {
        Align::Left => "start",
        Align::Centre => "middle",
        Align::Right => "end",
    };
    let size = short((text.size * UNITS * 1e3).round() / 1e3);
    let weight = if text.bold { " font-weight=\"600\"" } else { "" };
    let turn = if text.upright { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
    let (ink, words) = (hex(text.ink), escaped(&text.words));
    *svg += &format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{size}\"{weight}");
    *svg += &format!(" fill=\"{ink}\"{turn}>{words}</text>\n");
}

fn units(length: f64) -> i64 {
    (length * UNITS).round() as i64
}

fn hex(Ink(red, green, blue): Ink) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn escaped(words: &str) -> String {
    words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
