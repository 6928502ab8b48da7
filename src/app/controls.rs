//! The hands on the scene: shaking, stops, and under More what is changed less often.

use eframe::egui::{self, RichText, Ui};

use crate::scene::{Damping, Excitation, Stops};

use super::session::Session;
use super::style::Style;
use super::widgets::{Knob, Turn, hover_beside};
use super::{advanced, geometry};

const SHAKING_HOVER: &str =
    "Increase: the base pushes the mass harder. Beyond some amplitude it crosses to the other well.";
const LIMIT_HOVER: &str = "Increase: the stops move outward. Inside the wells the mass then rests lower on the hill: it takes more \
     shaking to free it and travels further once it crosses.";

/// The controls as a column. Whether something changed.
pub fn column_ui(ui: &mut Ui, session: &mut Session, style: &Style, more: &mut bool) -> bool {
    let width = (ui.available_width() - 84.0).max(80.0);
    heading_ui(ui, "Shaking");
    let mut changed = shaking_ui(ui, session, width);
    ui.add_space(14.0);
    changed |= stops_switch_ui(ui, session);
    changed |= limit_ui(ui, session, width);
    ui.add_space(14.0);
    let arrow = if *more { "Less" } else { "More" };
    let hover = "Restitution, preload, frequency, damping and mass.";
    if ui.selectable_label(*more, RichText::new(arrow).strong()).on_hover_text(hover).clicked() {
        *more = !*more;
    }
    if *more {
        changed |= more_ui(ui, session, style, width);
    }
    changed
}

/// Shaking and stops as one row, where room is short; the rest opens beside the views. Whether something
/// changed.
pub fn row_ui(ui: &mut Ui, session: &mut Session, more: &mut bool) -> bool {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let hover = "Restitution, preload, frequency, damping and mass.";
        let button = ui.selectable_label(*more, "More").on_hover_text(hover);
        let escaped = *more && ui.input(|input| input.key_pressed(egui::Key::Escape));
        if button.clicked() || escaped {
            *more = !*more;
        }
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            let sides = match session.scene().stops {
                Stops::Uneven { left_mm, right_mm, .. } => left_mm.iter().chain(&right_mm).count(),
                _ => 1,
            };
            let names = 330.0 + 110.0 * sides as f32;
            let width = ((ui.available_width() - names) / (1 + sides) as f32).clamp(30.0, 260.0);
            heading_ui(ui, "Shaking");
            let mut changed = shaking_ui(ui, session, width);
            ui.separator();
            changed |= stops_switch_ui(ui, session);
            changed | limit_ui(ui, session, width)
        })
        .inner
    })
    .inner
}

/// What is changed less often, as a column beside the views. Whether something changed.
pub fn more_column_ui(ui: &mut Ui, session: &mut Session, style: &Style) -> bool {
    egui::ScrollArea::vertical().show(ui, |ui| more_ui(ui, session, style, 150.0)).inner
}

fn heading_ui(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).heading());
}

/// Applies what a knob did through `change`. Whether something changed.
pub(super) fn turn(
    session: &mut Session,
    turn: Turn,
    change: impl FnOnce(&mut crate::scene::Scene, f64),
) -> bool {
    let changed = turn.value.is_some_and(|value| session.edit(|scene| change(scene, value)));
    if turn.ended {
        session.end_gesture();
    }
    changed
}

fn shaking_ui(ui: &mut Ui, session: &mut Session, width: f32) -> bool {
    let knob =
        |name, hover| Knob { name, unit: " g", range: (0.0, 2.0), step: 0.01, decimals: 2, hover, width };
    match &session.scene().excitation {
        Excitation::Sine { amplitude_g, .. } => {
            let (name, value) = ("amplitude", *amplitude_g);
            let done = knob(name, SHAKING_HOVER).ui(ui, value);
            turn(session, done, |scene, value| {
                if let Excitation::Sine { amplitude_g, .. } = &mut scene.excitation {
                    *amplitude_g = value;
                }
            })
        }
        Excitation::Noise { rms_g, .. } => {
            let value = *rms_g;
            let done = Knob { range: (0.0, 1.0), ..knob("RMS", SHAKING_HOVER) }.ui(ui, value);
            turn(session, done, |scene, value| {
                if let Excitation::Noise { rms_g, .. } = &mut scene.excitation {
                    *rms_g = value.max(0.0);
                }
            })
        }
        Excitation::Chirp { amplitude_g, .. } => {
            let value = *amplitude_g;
            let done = knob("amplitude", SHAKING_HOVER).ui(ui, value);
            turn(session, done, |scene, value| {
                if let Excitation::Chirp { amplitude_g, .. } = &mut scene.excitation {
                    *amplitude_g = value;
                }
            })
        }
        Excitation::None => {
            let hover = "A sine of 3 Hz and 0.5 g.";
            ui.button("Shake it").on_hover_text(hover).clicked()
                && session.edit_once(|scene| {
                    scene.excitation =
                        Excitation::Sine { frequency_hz: 3.0, amplitude_g: 0.5, phase_deg: 0.0 };
                })
        }
        Excitation::AmplitudeRamp { from_g, to_g, over_s, .. } => {
            ui.label(format!("{from_g} to {to_g} g over {over_s} s"));
            false
        }
        Excitation::Recorded { path, .. } => {
            ui.label(format!("record {path}"));
            false
        }
        Excitation::Constant { accel_g } => {
            ui.label(format!("constant {accel_g} g"));
            false
        }
        Excitation::Sum(terms) => {
            ui.label(format!("sum of {} parts", terms.len()));
            false
        }
    }
}

fn stops_switch_ui(ui: &mut Ui, session: &mut Session) -> bool {
    let mut on = session.scene().stops != Stops::None;
    let text = RichText::new("Stops").heading();
    let hover = "Rigid walls that limit the travel of the mass on both sides.";
    hover_beside(ui.checkbox(&mut on, text), hover).changed() && session.switch_stops(on)
}

fn limit_ui(ui: &mut Ui, session: &mut Session, width: f32) -> bool {
    let stops = session.scene().stops;
    let on = stops != Stops::None;
    let shown = if on { stops } else { session.remembered_stops() };
    let reach = session.model().mechanism.landscape.right_stable().map_or(10.0, |well| well.x.abs() * 1e3);
    // on the grid of the step
    let range = (0.1, ((1.2 * reach).max(1.0) * 10.0).round() / 10.0);
    let knob = |name| Knob { name, unit: " mm", range, step: 0.05, decimals: 2, hover: LIMIT_HOVER, width };
    match shown {
        Stops::Rigid { travel_limit_mm, .. } | Stops::Hertz { travel_limit_mm, .. } => {
            // remembered while off: moving it then says where they will be
            let done = knob("at ±").ui(ui, travel_limit_mm);
            let put = |value: f64| {
                let mut moved = shown;
                put_side(&mut moved, true, value);
                moved
            };
            if on {
                turn(session, done, |scene, value| scene.stops = put(value))
            } else {
                if let Some(value) = done.value {
                    session.remember_stops(put(value));
                }
                false
            }
        }
        Stops::Uneven { left_mm, right_mm, .. } => {
            let mut changed = false;
            for (name, value, right) in [("left", left_mm, false), ("right", right_mm, true)] {
                let Some(value) = value else { continue };
                let done = ui.add_enabled_ui(on, |ui| knob(name).ui(ui, value)).inner;
                changed |= turn(session, done, |scene, value| put_side(&mut scene.stops, right, value));
            }
            changed
        }
        Stops::None => false,
    }
}

/// Puts the stop of one side to a distance in mm from the middle.
pub fn put_side(stops: &mut Stops, right: bool, mm: f64) {
    let mm = mm.max(1e-3);
    match stops {
        Stops::None => {}
        Stops::Rigid { travel_limit_mm, .. } | Stops::Hertz { travel_limit_mm, .. } => *travel_limit_mm = mm,
        Stops::Uneven { left_mm, right_mm, .. } => {
            let own = if right { right_mm } else { left_mm };
            if own.is_some() {
                *own = Some(mm);
            }
        }
    }
}

fn more_ui(ui: &mut Ui, session: &mut Session, style: &Style, width: f32) -> bool {
    let mut changed = restitution_ui(ui, session, width);
    changed |= geometry::preload_ui(ui, session, style, width);
    changed |= frequency_ui(ui, session, width);
    changed |= damping_ui(ui, session, width);
    let knob = Knob {
        name: "mass",
        unit: " g",
        range: (1.0, 50.0),
        step: 0.1,
        decimals: 1,
        hover: "Increase: a heavier mass is pushed harder by the same shaking and swings more slowly.",
        width,
    };
    let done = knob.ui(ui, session.scene().mass_g);
    changed |= turn(session, done, |scene, value| scene.mass_g = value.max(1e-3));
    ui.add_space(8.0);
    let hover = "What is changed seldom: sizes of the flexures, kind of shaking, uneven stops, run.";
    let heading = RichText::new("Advanced").strong();
    let advanced = egui::CollapsingHeader::new(heading).id_salt("advanced").show_unindented(ui, |ui| {
        changed |= geometry::sizes_ui(ui, session, style, width);
        ui.separator();
        changed |= advanced::advanced_ui(ui, session, width);
    });
    advanced.header_response.on_hover_text(hover);
    changed
}

fn restitution_ui(ui: &mut Ui, session: &mut Session, width: f32) -> bool {
    let Stops::Rigid { restitution, .. } = session.scene().stops else {
        let why = match session.scene().stops {
            Stops::None => "There are no stops to rebound from: switch them on first.",
            Stops::Hertz { .. } => {
                "These stops are compliant: a faster impact keeps a smaller share of its speed."
            }
            _ => "The two stops have a restitution each, under Advanced.",
        };
        ui.add_enabled(false, egui::Label::new("restitution")).on_disabled_hover_text(why);
        return false;
    };
    let knob = Knob {
        name: "restitution",
        unit: "",
        range: (0.0, 1.0),
        step: 0.01,
        decimals: 2,
        hover: "Increase: a rebound keeps more of the speed, so that the mass chatters for longer before it rests.",
        width,
    };
    let done = knob.ui(ui, restitution);
    turn(session, done, |scene, value| {
        if let Stops::Rigid { restitution, .. } = &mut scene.stops {
            *restitution = value.clamp(0.0, 1.0);
        }
    })
}

fn frequency_ui(ui: &mut Ui, session: &mut Session, width: f32) -> bool {
    let Excitation::Sine { frequency_hz, .. } = session.scene().excitation else { return false };
    let knob = Knob {
        name: "frequency",
        unit: " Hz",
        range: (0.5, 20.0),
        step: 0.1,
        decimals: 1,
        hover: "Increase: the pushes follow each other faster and last less long.",
        width,
    };
    let done = knob.ui(ui, frequency_hz);
    turn(session, done, |scene, value| {
        if let Excitation::Sine { frequency_hz, .. } = &mut scene.excitation {
            *frequency_hz = value.max(1e-3);
        }
    })
}

fn damping_ui(ui: &mut Ui, session: &mut Session, width: f32) -> bool {
    let hover = "Increase: the motion dies away faster.";
    match session.scene().damping {
        Damping::Ratio(ratio) => {
            let range = (0.0, 0.2);
            let knob =
                Knob { name: "damping ratio", unit: "", range, step: 0.001, decimals: 3, hover, width };
            let done = knob.ui(ui, ratio);
            turn(session, done, |scene, value| scene.damping = Damping::Ratio(value.max(0.0)))
        }
        Damping::Coefficient { c_n_s_per_m } => {
            let range = (0.0, (2.0 * c_n_s_per_m).max(0.01));
            let (step, unit) = (range.1 / 200.0, " N s/m");
            let knob = Knob { name: "damping", unit, range, step, decimals: 3, hover, width };
            let done = knob.ui(ui, c_n_s_per_m);
            turn(session, done, |scene, value| {
                scene.damping = Damping::Coefficient { c_n_s_per_m: value.max(0.0) }
            })
        }
        Damping::None => {
            ui.add_enabled(false, egui::Label::new("no damping"))
                .on_disabled_hover_text("The scene has none.");
            false
        }
    }
}
