//! Notes of the scene below the controls, as far as there is room.

use eframe::egui::{Color32, FontSelection, RichText, Ui};

use crate::scene::Scene;

/// Heights in points: of the heading, of the line that offers the rest, and the least that is used.
const HEADING: f32 = 42.0;
const MORE: f32 = 30.0;
const LEAST: f32 = 120.0;

/// Draws them down to `bottom`; of a scene that was changed they tell what it was. Whether all of them are
/// asked for.
pub fn notes_ui(ui: &mut Ui, scene: &Scene, is_changed: bool, bottom: f32) -> bool {
    let notes = scene.notes.trim();
    let room = bottom - ui.cursor().top();
    if notes.is_empty() {
        return false;
    }
    let hover = "All that the scene says about itself";
    let heading = if is_changed { "The scene before changes" } else { "About this scene" };
    ui.add_space(14.0);
    if room < LEAST {
        return ui.button(heading).on_hover_text(hover).clicked();
    }
    ui.label(RichText::new(heading).heading());
    let font = FontSelection::Default.resolve(ui.style());
    let width = ui.available_width();
    let height = |text: &str| {
        let (text, font) = (text.to_owned(), font.clone());
        ui.fonts_mut(|fonts| fonts.layout(text, font, Color32::PLACEHOLDER, width)).size().y
    };
    if height(notes) <= room - HEADING {
        ui.label(notes);
        return false;
    }
    // as many whole sentences as there is room for
    let ends = notes.match_indices('.').map(|(at, _)| at + 1);
    let ends: Vec<usize> = ends.filter(|at| notes[*at..].starts_with(char::is_whitespace)).collect();
    let count = ends.partition_point(|end| height(&notes[..*end]) <= room - HEADING - MORE);
    let end = count.checked_sub(1).and_then(|last| ends.get(last)).copied().unwrap_or(0);
    ui.label(&notes[..end]);
    ui.button("Read on").on_hover_text(hover).clicked()
}
