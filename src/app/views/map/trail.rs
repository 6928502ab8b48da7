//! Trail of the scene over the map: where the live motion has been, fading with age.

use eframe::egui::{Painter, Pos2, Shape, Stroke};

use crate::app::ui::style::Style;

use super::coordinates::Coordinates;

/// How far in points two places are apart at least to be two.
const APART: f32 = 3.0;

/// Steps in which it fades, and how much is left of the oldest one.
const FADES: usize = 12;
const FAINTEST: f32 = 0.15;

/// Draws the places, the oldest first. On an axis whose field the scene lacked it is left out.
pub fn draw(painter: &Painter, frame: &Coordinates, style: &Style, places: &[[Option<f64>; 2]]) {
    let painter = painter.with_clip_rect(frame.rect);
    for (points, strength) in parts(places, |at| frame.screen_from_world(at)) {
        for stroke in style.trail_strokes() {
            let stroke = Stroke::new(stroke.width, stroke.color.gamma_multiply(strength));
            painter.add(Shape::line(points.clone(), stroke));
        }
    }
}

/// The parts of one strength each, with their strength from 0 to 1, the oldest first.
fn parts(places: &[[Option<f64>; 2]], screen: impl Fn((f64, f64)) -> Pos2) -> Vec<(Vec<Pos2>, f32)> {
    let mut points: Vec<Option<Pos2>> = Vec::new();
    for [x, y] in places {
        let at = x.zip(*y).map(&screen);
        let near = |last: &Option<Pos2>| match (last, at) {
            (Some(last), Some(at)) => last.distance(at) < APART,
            (last, at) => last.is_none() && at.is_none(),
        };
        if !points.last().is_some_and(near) {
            points.push(at);
        }
    }
    let many = points.len().saturating_sub(1);
    let mut parts: Vec<(Vec<Pos2>, f32)> = Vec::new();
    for (i, pair) in points.windows(2).enumerate() {
        let fade = (i + 1) * FADES / many.max(1);
        let strength = (FAINTEST + (1.0 - FAINTEST) * fade as f32 / FADES as f32).min(1.0);
        let (Some(from), Some(to)) = (pair[0], pair[1]) else { continue };
        match parts.last_mut().filter(|own| own.1 == strength && own.0.last() == Some(&from)) {
            Some(part) => part.0.push(to),
            None => parts.push((vec![from, to], strength)),
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
        let own = parts(&all, screen);
        assert_eq!(own.last().unwrap().1, 1.0);
        assert!(own.windows(2).all(|pair| pair[0].1 < pair[1].1 && pair[0].0.last() == pair[1].0.first()));
        assert!(own[0].1 < 0.25 && own.len() <= FADES + 1);
        // a place twice is one, and without the field there is none
        let own = parts(&[at(0.0), at(1.0), [None, Some(0.0)], at(50.0), at(90.0)], screen);
        assert_eq!(
            own.iter().map(|own| own.0.clone()).collect::<Vec<_>>(),
            [[pos2(50.0, 0.0), pos2(90.0, 0.0)]]
        );
        assert!(parts(&[at(1.0)], screen).is_empty());
    }
}
