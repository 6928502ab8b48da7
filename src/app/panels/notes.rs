//! Notes of the scene below the controls, as far as there is room.

use eframe::egui::{FontSelection, RichText, Ui, text::LayoutJob};

use crate::scene::Scene;

/// Heights in points: of the heading, of the line that offers the rest, and the least that is used.
const HEADING: f32 = 42.0;
const MORE: f32 = 30.0;
const LEAST: f32 = 120.0;

/// Draws them down to `bottom`. Whether all of them are asked for.
pub fn notes_ui(ui: &mut Ui, scene: &Scene, bottom: f32) -> bool {
    let notes = scene.notes.trim();
    let room = bottom - ui.cursor().top();
    if notes.is_empty() || room < LEAST {
        return false;
    }
    ui.add_space(14.0);
    ui.label(RichText::new("About this scene").heading());
    let font = FontSelection::Default.resolve(ui.style());
    let row = ui.fonts_mut(|fonts| fonts.row_height(&font));
    let mut job = LayoutJob::simple(notes.to_owned(), font, ui.visuals().text_color(), ui.available_width());
    let is_whole = ui.fonts_mut(|fonts| fonts.layout_job(job.clone())).size().y <= room - HEADING;
    if is_whole {
        ui.label(job);
        return false;
    }
    job.wrap.max_rows = (((room - HEADING - MORE) / row) as usize).max(1);
    let galley = ui.fonts_mut(|fonts| fonts.layout_job(job));
    ui.label(galley);
    ui.button("Read on").on_hover_text("All that the scene says about itself").clicked()
}
