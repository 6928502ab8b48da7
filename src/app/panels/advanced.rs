//! Controls that are rarely used: kind of shaking, uneven stops, run length and tolerance.
//!
//! An impossible choice is left out, or greyed out with the reason.

use std::mem::discriminant;

use eframe::egui::{self, ComboBox, Ui};

use crate::app::session::Session;
use crate::scene::{Excitation, Harmonic, STANDARD_GRAVITY, Stops};

use super::controls::{field_ui, fields_ui};

pub fn advanced_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    kind_ui(ui, session);
    excitation_ui(ui, session, width);
    ui.separator();
    uneven_ui(ui, session);
    ui.separator();
    run_ui(ui, session, width);
}

fn kind_name(excitation: &Excitation) -> &'static str {
    match excitation {
        Excitation::None => "none",
        Excitation::Constant { .. } => "constant",
        Excitation::Sine { .. } => "sine",
        Excitation::Cosine { .. } => "cosine",
        Excitation::Force { .. } => "force on the mass",
        Excitation::AmplitudeRamp { .. } => "amplitude ramp",
        Excitation::Chirp { .. } => "chirp",
        Excitation::Noise { .. } => "noise",
        Excitation::Recorded { .. } => "recorded",
        Excitation::Sum(_) => "sum",
    }
}

/// Shaking of each kind, with the amplitude and frequency of `from`, or of `suiting` if it has none, for a
/// proof mass in kg.
fn choices(from: &Excitation, suiting: &Excitation, mass: f64) -> [Excitation; 8] {
    let (suiting_f, suiting_g) = match suiting {
        Excitation::Sine { frequency_hz, amplitude_g, .. } => (*frequency_hz, *amplitude_g),
        _ => (3.0, 0.5),
    };
    let (f, g) = match from {
        Excitation::Sine { .. } | Excitation::Cosine { .. } | Excitation::Force { .. } => {
            let as_sine = |drive: Harmonic| (drive.frequency_hz, drive.amplitude_g());
            from.harmonic(mass).map_or((suiting_f, suiting_g), as_sine)
        }
        Excitation::AmplitudeRamp { frequency_hz, to_g, .. } => (*frequency_hz, *to_g),
        Excitation::Chirp { from_hz, to_hz, amplitude_g, .. } => (0.5 * (from_hz + to_hz), *amplitude_g),
        Excitation::Noise { rms_g, low_hz, high_hz, .. } => (0.5 * (low_hz + high_hz), *rms_g),
        Excitation::Constant { accel_g } => (suiting_f, *accel_g),
        _ => (suiting_f, suiting_g),
    };
    let frequency_rad_per_s = std::f64::consts::TAU * f;
    let amplitude_m_per_s2 = g * STANDARD_GRAVITY;
    [
        Excitation::None,
        Excitation::Constant { accel_g: g },
        Excitation::Sine { frequency_hz: f, amplitude_g: g, phase_deg: 0.0 },
        Excitation::Cosine { amplitude_m_per_s2, frequency_rad_per_s, phase_deg: 0.0 },
        Excitation::Force { amplitude_n: mass * amplitude_m_per_s2, frequency_rad_per_s, phase_deg: 0.0 },
        Excitation::AmplitudeRamp { frequency_hz: f, from_g: 0.0, to_g: g, over_s: 60.0 },
        Excitation::Chirp { from_hz: 0.5 * f, to_hz: 2.0 * f, over_s: 60.0, amplitude_g: g },
        Excitation::Noise { rms_g: g.abs(), low_hz: 0.5 * f, high_hz: 2.0 * f, seed: 1, lines: 256 },
    ]
}

fn kind_ui(ui: &mut Ui, session: &mut Session) {
    let present = &session.scene().excitation;
    let mut wanted = None;
    let name = ui.label("kind of shaking");
    // all kinds are seen at once
    let combo = ComboBox::from_id_salt("kind of shaking").selected_text(kind_name(present)).height(320.0);
    let combo = combo.show_ui(ui, |ui| {
        for choice in choices(present, &session.suiting_sine(), session.scene().mass_g / 1e3) {
            let is_present = discriminant(&choice) == discriminant(present);
            if ui.selectable_label(is_present, kind_name(&choice)).clicked() && !is_present {
                wanted = Some(choice);
            }
        }
        let recorded = "Open measured data with an acceleration (File menu), or name a record in the scene \
                        file: excitation: Recorded(path: ..).";
        let sum = "A sum of several is written in the scene file: excitation: Sum([..]).";
        for (name, why) in [("recorded", recorded), ("sum", sum)] {
            let choice = egui::Button::selectable(kind_name(present) == name, name);
            ui.add_enabled(false, choice).on_disabled_hover_text(why);
        }
    });
    combo.response.labelled_by(name.id).on_hover_text("What moves the base.");
    if let Some(wanted) = wanted {
        session.edit_once(|scene| scene.excitation = wanted);
    }
}

fn excitation_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    let paths: &[&'static str] = match &session.scene().excitation {
        Excitation::Constant { .. } => &["excitation.accel_g"],
        Excitation::Sine { .. } | Excitation::Cosine { .. } | Excitation::Force { .. } => {
            &["excitation.phase_deg"]
        }
        Excitation::AmplitudeRamp { .. } => {
            &["excitation.from_g", "excitation.to_g", "excitation.frequency_hz", "excitation.over_s"]
        }
        Excitation::Chirp { .. } => &["excitation.from_hz", "excitation.to_hz", "excitation.over_s"],
        Excitation::Noise { .. } => &["excitation.low_hz", "excitation.high_hz"],
        _ => &[],
    };
    fields_ui(ui, session, paths, width);
}

fn uneven_ui(ui: &mut Ui, session: &mut Session) {
    let stops = session.scene().stops;
    let mut uneven = matches!(stops, Stops::Uneven { .. });
    let tick = egui::Checkbox::new(&mut uneven, "different stops left and right");
    let rigid = matches!(stops, Stops::Rigid { .. } | Stops::Uneven { .. });
    let hover = "Each side has its own distance and restitution, or is open.";
    let response = ui.add_enabled(rigid, tick).on_hover_text(hover);
    let why = match stops {
        Stops::None => "There are no stops: switch them on first.",
        _ => "These stops are compliant, and compliant stops are equal.",
    };
    if response.on_disabled_hover_text(why).changed() {
        session.edit_once(|scene| scene.stops = other_kind(scene.stops));
    }
    let Stops::Uneven { left_mm, right_mm, .. } = session.scene().stops else { return };
    for (name, right, limit, other) in
        [("left stop is there", false, left_mm, right_mm), ("right stop is there", true, right_mm, left_mm)]
    {
        let mut exists = limit.is_some();
        // the last stop is removed only by the switch Stops
        let enabled = limit.is_none() || other.is_some();
        let response = ui.add_enabled(enabled, egui::Checkbox::new(&mut exists, name));
        let response = response.on_hover_text("An open side limits nothing.");
        let why = "One side has to have a stop; the switch Stops takes both away.";
        if response.on_disabled_hover_text(why).changed() {
            session.edit_once(|scene| {
                if let Stops::Uneven { left_mm, right_mm, .. } = &mut scene.stops {
                    *(if right { right_mm } else { left_mm }) = exists.then(|| opposite(other));
                }
            });
        }
    }
}

/// Converts equal stops to stops that may differ, or back: then both take the numbers of the right stop, or
/// of the left one if the right side is open or its stop does not stand right of x = 0.
fn other_kind(stops: Stops) -> Stops {
    let ([left_mm, right_mm], [restitution_left, restitution_right]) =
        (stops.limits_mm(), stops.restitutions());
    match stops {
        Stops::Rigid { .. } => Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right },
        Stops::Uneven { .. } => Stops::Rigid {
            travel_limit_mm: right_mm.into_iter().chain(left_mm).find(|mm| *mm > 0.0).unwrap_or(1.5),
            restitution: restitution_right.unwrap_or(0.36),
        },
        Stops::None | Stops::Hertz { .. } => stops,
    }
}

/// The distance in mm from x = 0 of a new stop opposite a stop at this distance on the other side.
fn opposite(other_mm: Option<f64>) -> f64 {
    match other_mm {
        Some(mm) if mm > 0.0 => mm,
        Some(mm) if mm < 0.0 => -2.0 * mm,
        _ => 1.5,
    }
}

fn run_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    field_ui(ui, session, "run.duration_s", width);
    let present = session.scene().run.tolerance;
    let mut wanted = present;
    let name = ui.label("tolerance");
    let combo = ComboBox::from_id_salt("tolerance").selected_text(format!("{present:e}")).show_ui(ui, |ui| {
        for value in [1e-6, 1e-9, 1e-12, 1e-14] {
            ui.selectable_value(&mut wanted, value, format!("{value:e}"));
        }
    });
    let hover = "Error allowed in a step. Smaller: a little slower; an irregular motion takes another path \
                 with the same averages.";
    combo.response.labelled_by(name.id).on_hover_text(hover);
    if wanted != present {
        session.edit_once(|scene| scene.run.tolerance = wanted);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Document, Scene, check};

    #[test]
    fn every_kind_of_every_preset_can_be_run() {
        for preset in crate::scene::PRESETS {
            let scene = Document::load(preset.name).unwrap().scene;
            let sine = Excitation::Sine { frequency_hz: 3.0, amplitude_g: 0.5, phase_deg: 0.0 };
            for excitation in choices(&scene.excitation, &sine, scene.mass_g / 1e3) {
                let kind = kind_name(&excitation);
                let changed = Scene { excitation, sweep: Vec::new(), ..scene.clone() };
                assert!(check(&changed).faults.is_empty(), "{} {kind}", preset.name);
            }
        }
    }

    #[test]
    fn stops_that_differ_and_back() {
        let stops = Stops::Rigid { travel_limit_mm: 2.0, restitution: 0.4 };
        assert_eq!(other_kind(other_kind(stops)), stops);
        assert_eq!(other_kind(Stops::None), Stops::None);
        let uneven = |left_mm, right_mm| Stops::Uneven {
            left_mm,
            right_mm,
            restitution_left: Some(0.5),
            restitution_right: Some(0.4),
        };
        for other in [Some(-2.0), Some(0.0), Some(3.0)] {
            let mut scene = Document::load("uneven-stops").unwrap().scene;
            scene.sweep.clear();
            for stops in [uneven(other, Some(opposite(other))), uneven(Some(opposite(other)), other)] {
                scene.stops = stops;
                assert!(check(&scene).faults.is_empty(), "{stops:?}");
                scene.stops = other_kind(stops);
                assert!(check(&scene).faults.is_empty(), "{stops:?}");
            }
        }
    }
}
