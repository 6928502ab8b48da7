//! Placement of texts in pictures.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rangef, Rect, Ui, vec2};

use crate::app::session::Session;
use crate::app::ui::style::Style;

/// How far in points the ground shows around a letter.
const HALO: f32 = 1.2;

/// How long in s a pointer rests before a note comes.
const REST: f32 = 1.2;

/// Room in points between texts in a row, and beside a wall.
const APART: f32 = 4.0;

/// Text with a thin edge of the ground around its letters, readable over lines. Where it stands.
pub fn haloed(
    painter: &Painter,
    style: &Style,
    (at, align): (Pos2, Align2),
    text: &str,
    (font, color): (FontId, Color32),
) -> Rect {
    let galley = painter.layout_no_wrap(text.to_owned(), font, color);
    let place = align.anchor_size(at, galley.size());
    for step in [vec2(-HALO, -HALO), vec2(HALO, -HALO), vec2(-HALO, HALO), vec2(HALO, HALO)] {
        painter.galley_with_override_text_color(place.min + step, galley.clone(), style.ground());
    }
    painter.galley(place.min, galley, color);
    place
}

/// Text on a plate of the ground, readable over walls and hatching as well. Where it stands.
pub fn plated(
    painter: &Painter,
    style: &Style,
    (at, align): (Pos2, Align2),
    text: &str,
    (font, color): (FontId, Color32),
) -> Rect {
    let galley = painter.layout_no_wrap(text.to_owned(), font, color);
    let place = align.anchor_size(at, galley.size());
    painter.rect_filled(place.expand2(vec2(2.0, 0.0)), 2.0, style.ground().gamma_multiply(0.9));
    painter.galley(place.min, galley, color);
    place
}

/// The left end of a text of some width in a row, as near as may be to the middle that it should have: within
/// `room` and clear of what is taken. None where it would not stand by that middle any more.
pub fn free_place(middle: f32, width: f32, room: Rangef, taken: &[Rangef]) -> Option<f32> {
    let (least, most) = (room.min + APART, room.max - APART - width);
    let wanted = (middle - 0.5 * width).clamp(least, most.max(least));
    let clear = |left: &f32| {
        let inside = *left >= least && *left <= most;
        inside && taken.iter().all(|own| left + width <= own.min - APART || *left >= own.max + APART)
    };
    let beside = taken.iter().flat_map(|own| [own.min - APART - width, own.max + APART]);
    let places = beside.chain([wanted]).filter(clear);
    let nearest = places.min_by(|a, b| (a - wanted).abs().total_cmp(&(b - wanted).abs()))?;
    ((nearest - wanted).abs() <= width).then_some(nearest)
}

/// Whether the pointer has stood still for so long that a note does not come in its way.
pub fn rests(ui: &Ui) -> bool {
    ui.input(|input| input.pointer.time_since_last_movement()) > REST
}

/// How long ago that was which is shown, where it is the past.
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
