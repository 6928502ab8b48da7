//! Notes of the scene below the controls, as far as they fit.

use eframe::egui::{Color32, FontSelection, RichText, Ui};

use crate::scene::Scene;

/// Height in points of the heading.
const HEADING: f32 = 42.0;
/// Height in points of the button that shows the rest.
const MORE: f32 = 30.0;
/// Least height in points in which notes are shown.
const LEAST: f32 = 120.0;

/// Draws the notes down to `bottom`. If the scene was changed, they describe it before the changes. Returns
/// whether the user asks for all of the notes.
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
    // as many whole sentences as fit
    let ends = notes.match_indices('.').map(|(at, _)| at + 1);
    let ends: Vec<usize> = ends.filter(|at| notes[*at..].starts_with(char::is_whitespace)).collect();
    let count = ends.partition_point(|end| height(&notes[..*end]) <= room - HEADING - MORE);
    let end = count.checked_sub(1).and_then(|last| ends.get(last)).copied().unwrap_or(0);
    ui.label(&notes[..end]);
    ui.button("Read on").on_hover_text(hover).clicked()
}
