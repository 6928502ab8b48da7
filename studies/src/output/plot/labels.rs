//! Places of labels beside points: clear of lines, markers and other texts.

use super::figure::{Area, Figure, Point, Shape, Text, distance};
use super::font;
use super::style::is_fine;

/// Distance of a label from its point where nothing is drawn there, and where a marker is.
const BESIDE: [f64; 2] = [8.0, 16.0];

/// Distance of a label from the edges of its frame, and from what it keeps clear of.
const EDGE: f64 = 4.0;
const CLEAR: f64 = 1.0;
/// Distance of a label of a drawing from what is drawn.
const APART: f64 = 5.0;

/// The box of a text that is not upright.
fn box_of(text: &Text) -> Area {
    let (left, y) = (text.at.0 - text.before(), text.at.1);
    let width = font::width(&text.words, text.size, text.bold);
    Area::new(left, y - text.size * font::CAPITAL, left + width, y)
}

/// Whether a shape lies in an area. Thin lines, such as those of a grid, and rectangles do not count: what is
/// written on them can be read.
fn covers(shape: &Shape, area: Area) -> bool {
    match shape {
        Shape::Line(points, width, _) => {
            !is_fine(*width) && points.windows(2).any(|pair| area.clip(pair[0], pair[1]).is_some())
        }
        Shape::Disc(centre, radius, _) => {
            let near = (centre.0.clamp(area.left, area.right), centre.1.clamp(area.top, area.bottom));
            distance(*centre, near) < *radius
        }
        Shape::Polygon(points, _) => area.clip_polygon(points.clone()).len() > 2,
        Shape::Text(text) => !text.upright && box_of(text).common(area).is_some(),
        Shape::Rect(..) => false,
    }
}

/// Where words of this size begin beside a point, within a frame: to its right, or where that is covered on
/// another side. Where no place is free it is the first one, `None` if another text stands there.
pub fn beside(figure: &Figure, within: Area, (x, y): Point, words: &str, size: f64) -> Option<Point> {
    let (wide, high) = (font::width(words, size, false), size * font::CAPITAL);
    let middle = y + 0.5 * high;
    let usual = ((x + BESIDE[0]).min(within.right - wide - EDGE).max(within.left + EDGE), middle);
    let around = BESIDE.into_iter().flat_map(|gap| {
        let (right, left) = (x + gap, x - gap - wide);
        let (above, below) = (y - gap, y + gap + high);
        [
            (right, middle),
            (right, above),
            (right, below),
            (left, middle),
            (left, above),
            (left, below),
            (x - 0.5 * wide, above),
            (x - 0.5 * wide, below),
        ]
    });
    let area = |(left, bottom): Point| {
        Area::new(left - CLEAR, bottom - high - CLEAR, left + wide + CLEAR, bottom + CLEAR)
    };
    let is_free = |place: &Point| {
        let area = area(*place);
        let is_inside = area.left >= within.left + CLEAR
            && area.right <= within.right - CLEAR
            && area.top >= within.top
            && area.bottom <= within.bottom;
        is_inside && !figure.shapes.iter().any(|shape| covers(shape, area))
    };
    let mut texts = figure.shapes.iter().filter(|shape| matches!(shape, Shape::Text(_)));
    let free = std::iter::once(usual).chain(around).find(is_free);
    free.or_else(|| (!texts.any(|text| covers(text, area(usual)))).then_some(usual))
}

/// The first of these texts that lies within an area, clear of lines, letters and what is `kept` free; with
/// its place.
pub fn first_free(
    figure: &Figure,
    within: Area,
    kept: &[Area],
    texts: impl IntoIterator<Item = Text>,
) -> Option<(Text, Area)> {
    texts.into_iter().map(|text| (box_of(&text), text)).find_map(
        |(Area { left, top, right, bottom }, text)| {
            let area = Area::new(left - APART, top - APART, right + APART, bottom + APART);
            let is_free = within.contains((left, top))
                && within.contains((right, bottom))
                && !kept.iter().any(|kept| kept.common(area).is_some())
                && !figure.shapes.iter().any(|shape| covers(shape, area));
            is_free.then_some((text, area))
        },
    )
}

#[cfg(test)]
mod tests {
    use super::super::axis::PlotAxis;
    use super::super::chart::{Chart, Marks, Panel};
    use super::super::mark::Caption;
    use super::super::role::Role;
    use super::super::sheet::Sheet;
    use super::super::style::Theme;
    use super::*;
    use crate::study::Table;

    /// Labels at the markers of a falling and of a rising line cover neither the line nor a marker, on a
    /// screen and on paper.
    #[test]
    fn labels_stand_clear_of_their_line() {
        let sheet = Sheet { width_mm: 85.0, height_mm: None, font_pt: 8.0, dpi: 300.0, titled: true };
        for slope in [-1.0, 1.0] {
            let points: Vec<Point> = (0..5).map(|i| (f64::from(i), slope * f64::from(i))).collect();
            let axis = || PlotAxis::around(points.iter().flat_map(|point| [point.0, point.1]), 0.1, "x");
            let mut panel = Panel::new(axis(), axis());
            panel.draw(Role::Motion, Marks::Path(points.clone()));
            panel.draw(Role::Interval, Marks::Points(points.clone()));
            let words = points.iter().map(|point| (*point, "label".to_owned())).collect();
            panel.draw(Role::Motion, Marks::Words(words));
            let chart = Chart::stack(vec![panel], "", Table::new());
            let caption = Caption::of("", String::new(), &serde_json::Value::Null);
            for sheet in [None, Some(sheet)] {
                let figure = chart.figure(&caption, &Theme::of(false, sheet));
                let label = |shape: &&Shape| matches!(shape, Shape::Text(text) if text.words == "label");
                let labels: Vec<&Shape> = figure.shapes.iter().filter(label).collect();
                assert_eq!(labels.len(), 5);
                for shape in labels {
                    let Shape::Text(text) = shape else { continue };
                    let others = figure.shapes.iter().filter(|other| *other != shape);
                    assert!(!others.into_iter().any(|other| covers(other, box_of(text))), "{text:?}");
                }
            }
        }
    }
}
