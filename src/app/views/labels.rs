//! Text over pictures.

use std::sync::Arc;

use eframe::egui::{Align2, Color32, FontId, Galley, Painter, Pos2, Ui, vec2};

use crate::app::session::Session;
use crate::app::ui::style::Style;

/// Width in points of the background-coloured edge around letters.
const HALO: f32 = 1.2;

/// Time in s for which the pointer rests before a hint appears.
const REST: f32 = 1.2;

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
pub fn plated(painter: &Painter, style: &Style, (at, align): Place, galley: Arc<Galley>) {
    let place = align.anchor_size(at, galley.size());
    painter.rect_filled(place.expand2(vec2(2.0, 0.0)), 2.0, style.ground().gamma_multiply(0.9));
    painter.galley(place.min, galley, style.ink());
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
