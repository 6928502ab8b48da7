//! Placement of text in pictures.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rangef, Rect, Ui, vec2};

use crate::app::session::Session;
use crate::app::ui::style::Style;

/// Width in points of the background-coloured edge around letters.
const HALO: f32 = 1.2;

/// Time in s for which the pointer rests before a hint appears.
const REST: f32 = 1.2;

/// Distance in points of a label from what is drawn.
const CLEAR: f32 = 2.0;

/// Gap in points between texts in a row, and beside a wall.
const GAP: f32 = 4.0;

/// The place of a text, and its font and colour.
type Place = (Pos2, Align2);
type Look = (FontId, Color32);

/// Draws text with a thin background-coloured edge, readable over lines.
pub fn haloed(painter: &Painter, style: &Style, (at, align): Place, text: &str, (font, color): Look) {
    let galley = painter.layout_no_wrap(text.to_owned(), font, color);
    let place = align.anchor_size(at, galley.size());
    for step in [vec2(-HALO, -HALO), vec2(HALO, -HALO), vec2(-HALO, HALO), vec2(HALO, HALO)] {
        painter.galley_with_override_text_color(place.min + step, galley.clone(), style.ground());
    }
    painter.galley(place.min, galley, color);
}

/// Draws text on a background-coloured plate, readable also over walls and hatching.
pub fn plated(painter: &Painter, style: &Style, (at, align): Place, text: &str, (font, color): Look) {
    let galley = painter.layout_no_wrap(text.to_owned(), font, color);
    let place = align.anchor_size(at, galley.size());
    painter.rect_filled(place.expand2(vec2(2.0, 0.0)), 2.0, style.ground().gamma_multiply(0.9));
    painter.galley(place.min, galley, color);
}

/// The left end of a text of `width` in a row, as close to the wanted `middle` as possible: within `room` and
/// clear of the ranges `taken`. `None` if it would be farther from the middle than its width.
pub fn free_place(middle: f32, width: f32, room: Rangef, taken: &[Rangef]) -> Option<f32> {
    let (low, high) = (room.min + GAP, room.max - GAP - width);
    let wanted = (middle - 0.5 * width).clamp(low, high.max(low));
    let clear = |left: &f32| {
        let inside = *left >= low && *left <= high;
        inside && taken.iter().all(|range| left + width <= range.min - GAP || *left >= range.max + GAP)
    };
    let beside = taken.iter().flat_map(|range| [range.min - GAP - width, range.max + GAP]);
    let places = beside.chain([wanted]).filter(clear);
    let nearest = places.min_by(|a, b| (a - wanted).abs().total_cmp(&(b - wanted).abs()))?;
    ((nearest - wanted).abs() <= width).then_some(nearest)
}

/// The lines and rectangles of a picture of which labels keep clear.
#[derive(Debug, Default)]
pub struct Taken {
    pub lines: Vec<Vec<Pos2>>,
    pub places: Vec<Rect>,
    /// The background of the labels, for pictures in which a line moves behind them.
    pub plate: Option<Color32>,
}

impl Taken {
    pub fn is_free(&self, place: Rect) -> bool {
        let wide = place.expand(CLEAR);
        let crosses = |pair: &[Pos2]| {
            let steps = (pair[0].distance(pair[1]) / CLEAR).ceil().clamp(1.0, 2000.0);
            Rect::from_two_pos(pair[0], pair[1]).intersects(wide)
                && (0..=steps as u32).any(|i| wide.contains(pair[0].lerp(pair[1], i as f32 / steps)))
        };
        let is_crossed = self.lines.iter().any(|line| line.windows(2).any(crosses));
        !is_crossed && !self.places.iter().any(|taken| taken.intersects(wide))
    }

    /// Writes the first of these texts and places that is free and within `room`. Returns where.
    pub fn write<'a>(
        &mut self,
        painter: &Painter,
        room: Rect,
        (font, colour): (FontId, Color32),
        places: impl IntoIterator<Item = (&'a str, Pos2, Align2)>,
    ) -> Option<Rect> {
        let mut galleys = places.into_iter().map(|(text, at, align)| {
            let galley = painter.layout_no_wrap(text.to_owned(), font.clone(), colour);
            (align.anchor_size(at, galley.size()), galley)
        });
        let (place, galley) =
            galleys.find(|(place, _)| room.contains_rect(*place) && self.is_free(*place))?;
        if let Some(plate) = self.plate {
            painter.rect_filled(place.expand2(vec2(CLEAR, 0.0)), 0.0, plate);
        }
        painter.galley(place.min, galley, colour);
        self.places.push(place);
        Some(place)
    }
}

pub fn pointer_rests(ui: &Ui) -> bool {
    ui.input(|input| input.pointer.time_since_last_movement()) > REST
}

/// The age of the state that is shown, as text. `None` for the present.
pub fn ago(session: &Session) -> Option<String> {
    let player = &session.player;
    let seconds = player.watch().time() - player.time();
    let decimals = if seconds < 0.1 { 4 } else { 2 };
    player.is_past().then(|| format!("{seconds:.decimals$} s ago"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_keeps_clear_of_lines_and_of_labels() {
        let label = Rect::from_min_size(Pos2::new(10.0, 10.0), vec2(40.0, 12.0));
        let line = |from: (f32, f32), to: (f32, f32)| Taken {
            lines: vec![vec![Pos2::new(from.0, from.1), Pos2::new(to.0, to.1)]],
            ..Taken::default()
        };
        assert!(!line((0.0, 0.0), (60.0, 30.0)).is_free(label));
        // its bounding box covers the label, and it does not
        assert!(line((0.0, 20.0), (60.0, 200.0)).is_free(label));
        let other = Taken { places: vec![label.translate(vec2(39.0, 0.0))], ..Taken::default() };
        assert!(!other.is_free(label) && Taken::default().is_free(label));
    }

    #[test]
    fn a_text_steps_aside_or_stays_away() {
        let room = Rangef::new(0.0, 200.0);
        assert_eq!(free_place(100.0, 40.0, room, &[]), Some(80.0));
        // at the edge, and beside a wall
        assert_eq!(free_place(5.0, 40.0, room, &[]), Some(4.0));
        assert_eq!(free_place(100.0, 40.0, room, &[Rangef::new(110.0, 120.0)]), Some(66.0));
        // between two walls that are too near, and with no room at all
        let walls = [Rangef::new(60.0, 80.0), Rangef::new(115.0, 190.0)];
        assert_eq!(free_place(97.0, 40.0, room, &walls), None);
        assert_eq!(free_place(10.0, 40.0, Rangef::new(0.0, 30.0), &[]), None);
    }
}
