//! Controls of the scene: shaking, stops and, under More, fields that are changed less often.

use eframe::egui::{self, Color32, Rect, RichText, Ui};

use crate::app::session::Session;
use crate::app::ui::widgets::hover_beside;
use crate::app::words::fields::name_and_unit;
use crate::scene::{Damping, Excitation, Stops};

use super::fields::{absent_ui, field_ui, fields_ui};
use super::{advanced, best_stops, geometry};

/// Width in points below which the row of controls has no room for headings.
const NARROW: f32 = 640.0;
/// Width in points of the search button in that row.
const SEARCH: f32 = 96.0;
/// Least width in points of a slider beside the search button.
const LEAST_BESIDE: f32 = 70.0;

/// Name of the switch of the stops in a lesson's list of controls.
const SWITCH: &str = "stops";
/// Width in points of that switch.
const SWITCH_WIDTH: f32 = 90.0;
/// Width in points of a slider's control apart from the slider and its name.
const BESIDE_SLIDER: f32 = 130.0;
/// Least width in points of a slider.
const LEAST_SLIDER: f32 = 60.0;
/// Greatest width in points of a slider.
const WIDEST_SLIDER: f32 = 280.0;

/// Hover text of More.
const MORE_HOVER: &str = "Restitution, preload, frequency, damping and mass; spring, magnets and \
                          transducer, where there are such.";

/// Fields of a transducer at the top of More.
const LOAD: [&str; 4] = [
    "transducer.load_ohm",
    "transducer.load_kohm",
    "transducer.coupling_v_s_per_m",
    "transducer.coupling_n_per_v",
];
/// Fields of a transducer under Advanced.
const CIRCUIT: [&str; 3] = ["transducer.coil_ohm", "transducer.inductance_mh", "transducer.capacitance_nf"];

pub fn column_ui(ui: &mut Ui, session: &mut Session, more: &mut bool) {
    let width = (ui.available_width() - 84.0).max(80.0);
    heading_ui(ui, "Shaking");
    shaking_ui(ui, session, width);
    ui.add_space(14.0);
    stops_switch_ui(ui, session);
    limit_ui(ui, session, width);
    best_stops::button_ui(ui, session, "Find the best stops");
    ui.add_space(14.0);
    let name = RichText::new(if *more { "Less" } else { "More" }).strong();
    if ui.selectable_label(*more, name).on_hover_text(MORE_HOVER).clicked() {
        *more = !*more;
    }
    if *more {
        more_ui(ui, session, width);
    }
}

/// Shaking and stops in one row, for a compact window; More opens a column beside the views.
pub fn row_ui(ui: &mut Ui, session: &mut Session, more: &mut bool) {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let button = ui.selectable_label(*more, "More").on_hover_text(MORE_HOVER);
        let escaped = *more && ui.input(|input| input.key_pressed(egui::Key::Escape));
        if button.clicked() || escaped {
            *more = !*more;
        }
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            let sides = match session.scene().stops {
                Stops::Uneven { left_mm, right_mm, .. } => left_mm.iter().chain(&right_mm).count(),
                _ => 1,
            };
            // a narrow row has no room for headings
            let is_narrow = ui.available_width() < NARROW;
            let names = if is_narrow { 330.0 } else { 395.0 } + 110.0 * sides as f32;
            let slider_width = |button: f32| (ui.available_width() - names - button) / (1 + sides) as f32;
            let has_search = !is_narrow && slider_width(SEARCH) >= LEAST_BESIDE;
            let width = slider_width(if has_search { SEARCH } else { 0.0 }).clamp(30.0, 260.0);
            if !is_narrow {
                heading_ui(ui, "Shaking");
            }
            shaking_ui(ui, session, width);
            ui.separator();
            stops_switch_ui(ui, session);
            limit_ui(ui, session, width);
            if has_search {
                best_stops::button_ui(ui, session, "Best stops");
            }
        });
    });
}

/// The controls that a lesson names, in rows that fill the width. Returns the rectangle of each control.
pub fn named_ui(ui: &mut Ui, session: &mut Session, controls: &[String]) -> Vec<(String, Rect)> {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let name_width = |ui: &Ui, path: &str| {
        let name = name_and_unit(path).0;
        ui.painter().layout_no_wrap(name, font.clone(), Color32::PLACEHOLDER).size().x
    };
    let shown: Vec<(&String, f32)> = controls
        .iter()
        .filter(|path| *path == SWITCH || session.number(path).is_some())
        .map(|path| (path, if path == SWITCH { SWITCH_WIDTH } else { name_width(ui, path) + BESIDE_SLIDER }))
        .collect();
    let mut rows: Vec<Vec<(&String, f32)>> = Vec::new();
    let least = |row: &[(&String, f32)]| row.iter().map(|control| control.1 + LEAST_SLIDER).sum::<f32>();
    for control in shown {
        match rows.last_mut() {
            Some(row) if least(row) + control.1 + LEAST_SLIDER <= ui.available_width() => row.push(control),
            _ => rows.push(vec![control]),
        }
    }
    let mut places = Vec::new();
    for row in rows {
        let sliders = row.iter().filter(|control| control.0 != SWITCH).count().max(1) as f32;
        let names: f32 = row.iter().map(|control| control.1).sum();
        let width = ((ui.available_width() - names) / sliders).clamp(LEAST_SLIDER, WIDEST_SLIDER);
        ui.horizontal(|ui| {
            for (path, _) in row {
                let control = ui.scope(|ui| match path.as_str() {
                    SWITCH => stops_switch_ui(ui, session),
                    path => field_ui(ui, session, path, width),
                });
                places.push((path.clone(), control.response.rect));
                ui.add_space(10.0);
            }
        });
    }
    places
}

/// The controls under More, as a column beside the views.
pub fn more_column_ui(ui: &mut Ui, session: &mut Session) {
    egui::ScrollArea::vertical().show(ui, |ui| more_ui(ui, session, 150.0));
}

fn heading_ui(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).heading());
}

fn shaking_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    let text = match &session.scene().excitation {
        Excitation::Sine { .. } | Excitation::Chirp { .. } | Excitation::Noise { .. } => {
            return fields_ui(ui, session, &["excitation.amplitude_g", "excitation.rms_g"], width);
        }
        Excitation::None => {
            let sine = session.suiting_sine();
            let Excitation::Sine { frequency_hz, amplitude_g, .. } = sine else { return };
            let hover = format!("A sine of {frequency_hz} Hz and {amplitude_g} g.");
            if ui.button("Shake it").on_hover_text(hover).clicked() {
                session.edit_once(|scene| scene.excitation = sine);
            }
            return;
        }
        Excitation::AmplitudeRamp { from_g, to_g, over_s, .. } => {
            format!("{from_g} to {to_g} g over {over_s} s")
        }
        Excitation::Recorded { path, .. } => format!("record {path}"),
        Excitation::Constant { accel_g } => format!("constant {accel_g} g"),
        Excitation::Sum(terms) => format!("sum of {} parts", terms.len()),
    };
    ui.label(text);
}

fn stops_switch_ui(ui: &mut Ui, session: &mut Session) {
    let mut on = session.scene().stops != Stops::None;
    let text = RichText::new("Stops").heading();
    let hover =
        "Rigid walls that limit the travel of the mass on both sides. A mass beyond them is set on the stop.";
    if hover_beside(ui.checkbox(&mut on, text), hover).changed() {
        session.switch_stops(on);
    }
}

/// The travel limit of the stops, or of each stop. While the stops are off it shows the limit that they will
/// have, and moving it switches them on.
fn limit_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    fields_ui(ui, session, &["stops.travel_limit_mm", "stops.left_mm", "stops.right_mm"], width)
}

fn more_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    fields_ui(ui, session, &LOAD, width);
    restitution_ui(ui, session, width);
    geometry::preload_ui(ui, session, width);
    geometry::balancing_ui(ui, session, width);
    if matches!(session.scene().excitation, Excitation::Sine { .. }) {
        field_ui(ui, session, "excitation.frequency_hz", width);
    }
    damping_ui(ui, session, width);
    field_ui(ui, session, "mass_g", width);
    ui.add_space(8.0);
    let hover = "What is changed seldom: sizes of the flexures, kind of shaking, uneven stops, run.";
    let heading = RichText::new("Advanced").strong();
    let advanced = egui::CollapsingHeader::new(heading).id_salt("advanced").show_unindented(ui, |ui| {
        fields_ui(ui, session, &CIRCUIT, width);
        geometry::sizes_ui(ui, session, width);
        ui.separator();
        advanced::advanced_ui(ui, session, width);
    });
    advanced.header_response.on_hover_text(hover);
}

fn restitution_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    let why = match session.scene().stops {
        Stops::Rigid { .. } => return field_ui(ui, session, "stops.restitution", width),
        Stops::None => "There are no stops to rebound from: switch them on first.",
        Stops::Hertz { .. } => {
            "These stops are compliant: a faster impact keeps a smaller share of its speed."
        }
        Stops::Uneven { .. } => "The two stops have a restitution each, under Advanced.",
    };
    absent_ui(ui, "restitution", why);
}

fn damping_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    if session.scene().damping == Damping::None {
        absent_ui(ui, "no damping", "The scene has none.");
    }
    fields_ui(ui, session, &["damping.xi", "damping.c_n_s_per_m"], width)
}
