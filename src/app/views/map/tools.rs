//! Controls over the map, its progress and its legend.

use eframe::egui::{self, ComboBox, RichText, Ui};

use crate::app::session::map::{Mapping, start};
use crate::app::ui::knob::refuse;
use crate::app::ui::widgets::{choices_ui, segment_ui, tell};
use crate::app::words::columns::{COLUMNS, title};
use crate::output::words_of;
use crate::scene::{Start, SweepAxis};
use interwell_studies::study::SummaryField;

use super::super::ViewContext;
use super::super::axes::{field_ui, range_id, range_row_ui};
use super::super::memory::MapLook;

/// Width in points of the title; a longer one is cut, but complete in the list and beside the colours.
const TITLE: f32 = 130.0;

/// Quantity, axes, further choices and progress in one row, which wraps.
pub fn tools_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    // what no step of a lesson explains is in the menu
    let is_lesson = context.session.is_lesson;
    egui::Frame::new().inner_margin(egui::Margin::symmetric(8, 0)).show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            quantity_ui(ui, &mut context.session.map);
            if !is_lesson {
                fields_ui(ui, context);
            }
            choices_ui(ui, "Options", |ui| {
                ui.label(format!("Every cell is a separate run {}.", start_in_words(context)));
                let quantity = context.session.map.quantity();
                ui.horizontal(|ui| look_ui(ui, &mut context.memory.map_look, quantity));
                trail_items_ui(ui, context);
                ui.separator();
                if is_lesson {
                    ui.horizontal(|ui| fields_ui(ui, context));
                }
                if let Some(axes) = context.session.map_axes() {
                    ranges_items_ui(ui, context, &axes);
                }
                ui.separator();
                again_ui(ui, &mut context.session.map);
            });
            progress_ui(ui, &mut context.session.map);
        });
    });
}

/// From where the runs of the map start.
fn start_in_words(context: &ViewContext<'_>) -> &'static str {
    match start(context.session.scene()) {
        Start::Rest => "from rest",
        Start::At { .. } => "from the scene's start",
    }
}

/// Choice of the quantity, by groups of columns.
fn quantity_ui(ui: &mut Ui, mapping: &mut Mapping) {
    let chosen = mapping.quantity();
    let heading = RichText::new(title(chosen)).heading();
    let combo =
        ComboBox::from_id_salt("quantity").width(TITLE).height(420.0).selected_text(heading).truncate();
    let inner = combo.show_ui(ui, |ui| {
        for (group, columns) in &COLUMNS {
            ui.menu_button(*group, |ui| {
                for column in columns.iter().filter_map(|name| SummaryField::find(name)) {
                    let entry = ui.selectable_label(column.name == chosen.name, title(column));
                    let cost =
                        if column.needs_ledger { " Its runs are computed again, one by one." } else { "" };
                    if entry.on_hover_text(format!("{}{cost}", column.about)).clicked() {
                        mapping.show(column);
                        ui.close();
                    }
                }
            });
        }
    });
    tell(&inner.response, egui::Role::ComboBox, &format!("map of {}", title(chosen)));
    inner.response.on_hover_text(chosen.about);
}

/// Choice between the map from above and the surface, and of cuts.
fn look_ui(ui: &mut Ui, look: &mut MapLook, quantity: &SummaryField) {
    segment_ui(ui, &mut look.surface, false, "Flat")
        .on_hover_text("Each run is a cell, and its colour the quantity.");
    let surface = if words_of(quantity.name).is_some() {
        "Words have no height: they are seen from above."
    } else {
        "The same as a surface: height and colour are the quantity."
    };
    segment_ui(ui, &mut look.surface, true, "Surface").on_hover_text(surface);
    ui.checkbox(&mut look.cuts, "Cuts").on_hover_text(
        "Lines through the map where the scene is, beside it: the quantity over one axis at this value of \
         the other, with regimes, release and first crossing.",
    );
}

/// Choice of the fields of both axes.
fn fields_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let Some(axes) = context.session.map_axes() else { return };
    let known = context.session.map_fields();
    let mut chosen = axes.clone();
    for (i, (axis, (word, role))) in axes.iter().zip([("over", "across"), ("and", "up")]).enumerate() {
        ui.label(word);
        let choices: Vec<String> = known.iter().filter(|path| **path != axes[1 - i].field).cloned().collect();
        if let Some(path) = field_ui(ui, axis, role, &choices) {
            chosen[i] = context.session.map_axis(&path);
            context.session.map.choose(Some(chosen.clone()));
        }
    }
}

fn trail_items_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    ui.checkbox(&mut context.memory.map_look.trail, "Show where the scene has been");
    let trail = &mut context.session.map.trail;
    if ui.add_enabled(!trail.is_clear(), egui::Button::new("Clear the trail")).clicked() {
        trail.clear();
        ui.close();
    }
}

fn ranges_items_ui(ui: &mut Ui, context: &mut ViewContext<'_>, axes: &[SweepAxis; 2]) {
    let mut wanted = axes.clone();
    egui::Grid::new("ranges").num_columns(7).show(ui, |ui| {
        for (axis, role) in wanted.iter_mut().zip(["across", "up"]) {
            range_row_ui(ui, axis, role);
        }
    });
    if wanted != *axes {
        match context.session.map_problem(&wanted) {
            None => context.session.map.choose(Some(wanted)),
            Some((i, part, why)) => refuse(ui, range_id(["across", "up"][i], part), why),
        }
    }
    if ui.button("As the scene has it").on_hover_text("The ranges that the map began with.").clicked() {
        context.session.map.choose(None);
    }
}

/// Stops a map that is computed, or goes on with it.
fn progress_ui(ui: &mut Ui, mapping: &mut Mapping) {
    let Some(map) = mapping.map() else { return };
    let (known, all) = (map.known, map.count());
    if mapping.is_running() {
        if ui.button("Stop").on_hover_text("Leave the map as it is now.").clicked() {
            mapping.stop();
        }
        return bar_ui(ui, (known, all), 50.0);
    }
    let hover = format!("{known} of {all} runs are done. Runs the others.");
    if known < all && ui.button("Continue").on_hover_text(hover).clicked() {
        mapping.go_on();
    }
}

/// Computes a map that is whole again.
fn again_ui(ui: &mut Ui, mapping: &mut Mapping) {
    let Some(map) = mapping.map().filter(|map| map.known == map.count()) else { return };
    let (coarse, took) = (map.coarse_after.unwrap_or(map.took).as_secs_f64(), map.took.as_secs_f64());
    ui.label(format!("Coarse after {coarse:.2} s, all {} runs after {took:.1} s.", map.count()));
    if ui.button("Recompute").clicked() {
        mapping.go_on();
        ui.close();
    }
}

/// How many of all runs are done.
fn bar_ui(ui: &mut Ui, (known, all): (usize, usize), width: f32) {
    let bar = egui::ProgressBar::new(known as f32 / all as f32).desired_width(width).desired_height(12.0);
    ui.add(bar).on_hover_text(format!("{known} of {all} runs"));
}
