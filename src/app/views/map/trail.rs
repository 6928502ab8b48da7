//! Trail of the scene over the map: where the live motion has been, fading with age.

use eframe::egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, vec2};

use crate::app::ui::style::Style;

use super::super::labels::haloed;
use super::super::plot::Plotted;

/// Distance in points below which two places are merged.
const NEAR: f32 = 3.0;

/// Number of steps in which the trail fades.
const FADES: usize = 12;
/// Opacity of the oldest part.
const FAINTEST: f32 = 0.15;

/// Width in points of a trail from which on it is named.
const NAMED: f32 = 40.0;

/// Draws the places, the oldest first, and the name of the trail at its oldest end; a place at which the
/// scene lacked the field of an axis is a gap.
pub fn draw(painter: &Painter, plotted: &Plotted, style: &Style, places: &[[Option<f64>; 2]]) {
    let parts = parts(places, |at| plotted.place(at));
    for (points, opacity) in &parts {
        for stroke in style.trail_strokes() {
            let stroke = Stroke::new(stroke.width, stroke.color.gamma_multiply(*opacity));
            painter.add(Shape::line(points.clone(), stroke));
        }
    }
    let all: Vec<Pos2> = parts.into_iter().flat_map(|part| part.0).collect();
    if let (Some(oldest), true) = (all.first(), Rect::from_points(&all).size().max_elem() > NAMED) {
        let words = (*oldest + vec2(0.0, -4.0), Align2::CENTER_BOTTOM);
        haloed(painter, style, words, "trail", (style.small(), style.ink()));
    }
}

/// Parts of equal opacity, with their opacity from 0 to 1, the oldest first.
fn parts(places: &[[Option<f64>; 2]], screen: impl Fn((f64, f64)) -> Pos2) -> Vec<(Vec<Pos2>, f32)> {
    let mut points: Vec<Option<Pos2>> = Vec::new();
    for [x, y] in places {
        let at = x.zip(*y).map(&screen);
        let near = |last: &Option<Pos2>| match (last, at) {
            (Some(last), Some(at)) => last.distance(at) < NEAR,
            (last, at) => last.is_none() && at.is_none(),
        };
        if !points.last().is_some_and(near) {
            points.push(at);
        }
    }
    let count = points.len().saturating_sub(1);
    let mut parts: Vec<(Vec<Pos2>, f32)> = Vec::new();
    for (i, pair) in points.windows(2).enumerate() {
        let fade = (i + 1) * FADES / count.max(1);
        let opacity = (FAINTEST + (1.0 - FAINTEST) * fade as f32 / FADES as f32).min(1.0);
        let (Some(from), Some(to)) = (pair[0], pair[1]) else { continue };
        match parts.last_mut().filter(|part| part.1 == opacity && part.0.last() == Some(&from)) {
            Some(part) => part.0.push(to),
            None => parts.push((vec![from, to], opacity)),
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    #[test]
    fn it_is_strongest_at_its_end_and_has_gaps() {
        let screen = |(x, y): (f64, f64)| pos2(x as f32, y as f32);
        let at = |x: f64| [Some(x), Some(0.0)];
        let all: Vec<_> = (0..=24).map(|i| at(10.0 * f64::from(i))).collect();
        let lines = parts(&all, screen);
        assert_eq!(lines.last().unwrap().1, 1.0);
        assert!(lines.windows(2).all(|pair| pair[0].1 < pair[1].1 && pair[0].0.last() == pair[1].0.first()));
        assert!(lines[0].1 < 0.25 && lines.len() <= FADES + 1);
        // near places are merged, and one without the field is a gap
        let lines = parts(&[at(0.0), at(1.0), [None, Some(0.0)], at(50.0), at(90.0)], screen);
        assert_eq!(
            lines.iter().map(|line| line.0.clone()).collect::<Vec<_>>(),
            [[pos2(50.0, 0.0), pos2(90.0, 0.0)]]
        );
        assert!(parts(&[at(1.0)], screen).is_empty());
    }
}
