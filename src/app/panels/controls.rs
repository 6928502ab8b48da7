//! Controls of the scene: shaking, stops with the search for the best ones and, under More, rarer fields.

use eframe::egui::{self, Label, Rect, RichText, Ui};

use crate::app::session::Session;
use crate::app::session::sliders::reach;
use crate::app::ui::knob::{How, Knob, refuse};
use crate::app::ui::widgets::{hover_beside, primary};
use crate::app::words::fields::{Reach, info, name_and_unit};
use crate::app::words::numbers::{below, decimals, round_up, shown};
use crate::scene::{Damping, Excitation, FieldPath, Stops, Transducer, numeric_fields};

use super::advanced;

/// Space in points between the parts of the column.
const APART: f32 = 14.0;

/// Name of the switch of the stops in a lesson's list of controls.
const SWITCH: &str = "stops";
/// What an amplitude is the amplitude of, as a heading before its control.
const SHAKING: &str = "Shaking";
const LEAST_SLIDER: f32 = 60.0;
/// Additional space in points between the controls of a lesson, one below another.
const COLUMN_SPACE: f32 = 6.0;

const MORE_HOVER: &str = "Damping and mass; spring, magnets and transducer, if there are any.";

const SEARCH_HOVER: &str = "Looks for the distance of the stops with which the scene as it stands, from \
                            rest, moves fastest, or where there is a transducer gives most power, and how \
                            far that is from where it is lost (B).";

const STOPS_OFF: &str = "The stops are off. This is where they will stand: switch them on first.";

/// Of a sine, a cosine or a force.
const FREQUENCY: [&str; 2] = ["excitation.frequency_hz", "excitation.frequency_rad_per_s"];
/// Amplitudes of shaking that has one amplitude.
const AMPLITUDE: [&str; 4] =
    ["excitation.amplitude_g", "excitation.rms_g", "excitation.amplitude_m_per_s2", "excitation.amplitude_n"];
/// The travel limit of the stops, or of each stop. While the stops are off their control is grey, and shows
/// the limit that they will have.
const LIMITS: [&str; 3] = ["stops.travel_limit_mm", "stops.left_mm", "stops.right_mm"];
/// Number of fields of a mechanism without a preload that have a control.
const FIRST: usize = 2;
/// The load of a transducer.
const LOAD: [&str; 2] = ["transducer.load_ohm", "transducer.load_kohm"];
/// Other fields of a transducer at the top of More.
const COUPLING: [&str; 2] = ["transducer.coupling_v_s_per_m", "transducer.coupling_n_per_v"];
/// Fields of a transducer under Advanced.
const CIRCUIT: [&str; 3] = ["transducer.coil_ohm", "transducer.inductance_mh", "transducer.capacitance_nf"];

/// The six controls that are always there, those of a transducer, and under More the rarer ones.
pub fn column_ui(ui: &mut Ui, session: &mut Session, more: &mut bool) {
    let width = (ui.available_width() - 84.0).max(80.0);
    ui.heading(SHAKING);
    shaking_ui(ui, session, width);
    fields_ui(ui, session, &FREQUENCY, width);
    ui.add_space(APART);
    stops_switch_ui(ui, session);
    fields_ui(ui, session, &LIMITS, width);
    restitution_ui(ui, session, width);
    best_stops_ui(ui, session);
    ui.add_space(APART);
    ui.heading("Mechanism");
    mechanism_ui(ui, session, width);
    if session.scene().transducer != Transducer::None {
        ui.add_space(APART);
        ui.heading("Load");
        fields_ui(ui, session, &LOAD, width);
    }
    ui.add_space(APART);
    let header = egui::CollapsingHeader::new(RichText::new("More").strong()).open(Some(*more));
    let header = header.show_unindented(ui, |ui| more_ui(ui, session, width));
    *more ^= header.header_response.on_hover_text(MORE_HOVER).clicked();
}

/// The controls that a lesson names and the scene has.
fn named<'a>(session: &Session, controls: &'a [String]) -> Vec<&'a String> {
    controls.iter().filter(|path| *path == SWITCH || session.number(path).is_some()).collect()
}

/// The controls that a lesson names, one below another. Returns the rectangle of each control.
pub fn named_ui(ui: &mut Ui, session: &mut Session, controls: &[String]) -> Vec<(String, Rect)> {
    let width = (ui.available_width() - 84.0).max(LEAST_SLIDER);
    let has_switch = controls.iter().any(|path| path == SWITCH);
    let mut places = Vec::new();
    // so that an outline around a control keeps clear of the others
    ui.spacing_mut().item_spacing.y += COLUMN_SPACE;
    for path in named(session, controls) {
        let control = ui.scope(|ui| match path.as_str() {
            SWITCH => stops_switch_ui(ui, session),
            path => {
                ui.spacing_mut().item_spacing.y -= COLUMN_SPACE;
                if AMPLITUDE.contains(&path) {
                    ui.heading(SHAKING);
                }
                knob_ui(ui, session, path, width, has_switch && is_off(session, path));
            }
        });
        places.push((path.clone(), control.response.rect));
    }
    places
}

/// Whether a word in lower case in a lesson names the control of a field, by its label or its usual name.
pub fn is_named(word: &str, path: &str) -> bool {
    let name = name_and_unit(path).0;
    let label = name.trim_end_matches(" ±").to_lowercase();
    match path {
        "stops" => ["stops", "stop"].contains(&word),
        "excitation.rms_g" => word == "shaking" || word == label,
        _ if path.starts_with("excitation.amplitude_") => word == "shaking" || word == label,
        "stops.travel_limit_mm" => ["travel limit", "position"].contains(&word),
        "start.v_m_per_s" => ["flick", "start", "velocity", label.as_str()].contains(&word),
        _ => word == label,
    }
}

fn shaking_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    let text = match &session.scene().excitation {
        Excitation::Sine { .. }
        | Excitation::Cosine { .. }
        | Excitation::Force { .. }
        | Excitation::Chirp { .. }
        | Excitation::Noise { .. } => return fields_ui(ui, session, &AMPLITUDE, width),
        Excitation::None => {
            let sine = session.suiting_sine();
            let Excitation::Sine { frequency_hz, amplitude_g, .. } = sine else { return };
            let hover = format!("A sine of {frequency_hz} Hz and {amplitude_g} g.");
            if ui.add(primary(ui, "Shake it")).on_hover_text(hover).clicked() {
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

fn more_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    fields_ui(ui, session, &COUPLING, width);
    for path in sliders(session).into_iter().filter(|path| is_balancing(path)) {
        field_ui(ui, session, &path, width);
    }
    if session.scene().damping == Damping::None {
        absent_ui(ui, "no damping", "The scene has none.");
    }
    fields_ui(ui, session, &["damping.xi", "damping.c_n_s_per_m", "mass_g"], width);
    ui.add_space(8.0);
    let hover = "Seldom changed: sizes of the flexures, kind of shaking, uneven stops, run.";
    let heading = RichText::new("Advanced").strong();
    let advanced = egui::CollapsingHeader::new(heading).id_salt("advanced").show_unindented(ui, |ui| {
        fields_ui(ui, session, &CIRCUIT, width);
        sizes_ui(ui, session, width);
        ui.separator();
        advanced::advanced_ui(ui, session, width);
    });
    advanced.header_response.on_hover_text(hover);
}

fn restitution_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    let why = match session.scene().stops {
        Stops::None | Stops::Rigid { .. } => return field_ui(ui, session, "stops.restitution", width),
        Stops::Uneven { left_mm, right_mm, .. } => {
            let sides = [(left_mm, "stops.restitution_left"), (right_mm, "stops.restitution_right")];
            let there: Vec<&str> = sides.iter().filter_map(|side| side.0.map(|_| side.1)).collect();
            return fields_ui(ui, session, &there, width);
        }
        Stops::Hertz { .. } => {
            "These stops are compliant: a faster impact keeps a smaller share of its speed."
        }
    };
    absent_ui(ui, "restitution", why);
}

/// The button that starts the search; it is absent in a lesson and without shaking.
fn best_stops_ui(ui: &mut Ui, session: &mut Session) {
    if session.is_lesson || !session.model().is_shaken() {
        return;
    }
    let why = session.best.is_running().then_some("The search is running.");
    let response = ui.add_enabled(why.is_none(), egui::Button::new("Find the best stops"));
    let response = response.on_hover_text(SEARCH_HOVER);
    if response.on_disabled_hover_text(why.unwrap_or_default()).clicked() {
        session.find_best_stops();
    }
}

/// Links for the search for the best stops, from right to left: stop it, forget it, or move the stops there.
pub fn best_stops_answer_ui(ui: &mut Ui, session: &mut Session) {
    if session.best.is_running() {
        if ui.link("Stop looking").clicked() {
            session.best.close();
        }
        ui.add(egui::Spinner::new().size(14.0));
        return;
    }
    if ui.link("Close").on_hover_text("Forgets the best stops.").clicked() {
        return session.best.close();
    }
    match session.is_at_best_stops() {
        true => _ = ui.label(RichText::new("The stops stand there.").weak()),
        false if session.best.limit_mm().is_some() => {
            let hover = "Moves the stops there, as one step that can be undone. The motion goes on.";
            if ui.link("Take the stops there").on_hover_text(hover).clicked() {
                session.go_to_best_stops();
            }
        }
        false => {}
    }
}

/// Paths of the mechanism's fields that have a slider, including those of the parts of a sum.
fn sliders(session: &Session) -> Vec<String> {
    let has_slider = |path: &String| path.starts_with("mechanism.") && info(path).is_some();
    numeric_fields(session.scene()).into_iter().filter(has_slider).collect()
}

fn is_preload(path: &str) -> bool {
    path.ends_with(".preload_mm")
}

/// The slider of the preload, or for a mechanism without one those of its first numbers.
fn mechanism_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    // the tolerance of a table has no name
    let is_number = |path: &String| path.starts_with("mechanism.") && name_and_unit(path).0 != *path;
    let of_preload = sliders(session).into_iter().find(|path| is_preload(path));
    let first = || numeric_fields(session.scene()).into_iter().filter(is_number).take(FIRST).collect();
    let shown: Vec<String> = of_preload.map_or_else(first, |path| vec![path]);
    if shown.is_empty() {
        absent_ui(ui, "preload", "The force comes from a table, which was made at one preload.");
    }
    shown.iter().for_each(|path| field_ui(ui, session, path, width));
}

/// Whether a field belongs to springs or magnets, which lower the barrier as stops do.
fn is_balancing(path: &str) -> bool {
    [".n_per_m", ".strength_n_mm4", ".gap_mm"].iter().any(|end| path.ends_with(end))
}

/// The sliders of the mechanism's other fields, the sizes of its flexures.
fn sizes_ui(ui: &mut Ui, session: &mut Session, width: f32) {
    let mut sizes = sliders(session);
    sizes.retain(|path| !is_preload(path) && !is_balancing(path));
    if sizes.is_empty() {
        let why = "The mechanism of this scene is a force without flexures behind it.";
        absent_ui(ui, "sizes of flexures", why);
    }
    sizes.iter().for_each(|path| field_ui(ui, session, path, width));
}

/// The control of a field of the scene, or of the stops that it gets when they are switched on. Draws nothing
/// if there is no such field. A change of the start restarts the motion.
pub(super) fn field_ui(ui: &mut Ui, session: &mut Session, path: &str, width: f32) {
    let off = is_off(session, path);
    knob_ui(ui, session, path, width, off);
}

/// Whether a field is one of stops that are off.
fn is_off(session: &Session, path: &str) -> bool {
    session.scene().stops == Stops::None && path.starts_with("stops.")
}

/// The control of a field, grey if it is `off`.
fn knob_ui(ui: &mut Ui, session: &mut Session, path: &str, width: f32, off: bool) {
    let Some(value) = session.number(path) else { return };
    let (name, unit) = name_and_unit(path);
    let (reach, typed, hover) = match info(path) {
        Some(field) => (reach(field, session), field.typed, field.hover),
        None => (around(session, path, value), (f64::MIN, f64::MAX), ""),
    };
    let id = egui::Id::unique(("field", path));
    let hover = if off { STOPS_OFF } else { hover };
    let knob = Knob { id, name: &name, unit, reach, typed, hover, width };
    let turn = ui.add_enabled_ui(!off, |ui| knob.ui(ui, value)).inner;
    if let Some(value) = turn.value {
        match turn.how {
            How::Pressed => session.press(path, ui.input(|input| input.time)),
            How::Once | How::Dragged => session.end_presses(),
        }
        if let Err(why) = session.set_number(path, value) {
            let value = shown(value, decimals(reach.step));
            let space = if unit.is_empty() { "" } else { " " };
            refuse(ui, id, format!("{value}{space}{unit} was not taken: {why}"));
        }
    }
    let is_start = path.starts_with("start.");
    if turn.ended || turn.value.is_some() && (turn.how == How::Once || is_start && turn.how == How::Pressed) {
        session.end_gesture();
        if is_start {
            session.restart();
            session.player.set_playing(true);
        }
    }
}

/// Slider range of a field that is not in the table: around the value that the scene was opened with.
fn around(session: &Session, path: &str, value: f64) -> Reach {
    let opened = FieldPath::new(path).get(session.editor.saved()).unwrap_or(value);
    let size = if opened == 0.0 { 1.0 } else { opened.abs() };
    let high = round_up(2.0 * size);
    Reach::even(if opened < 0.0 { -high } else { 0.0 }, high, below(high / 200.0))
}

pub(super) fn fields_ui(ui: &mut Ui, session: &mut Session, paths: &[&str], width: f32) {
    paths.iter().for_each(|path| field_ui(ui, session, path, width));
}

/// The name of a control that does not apply to the scene, greyed out, with the reason.
pub(super) fn absent_ui(ui: &mut Ui, name: &str, why: &str) {
    ui.add_enabled(false, Label::new(name)).on_disabled_hover_text(why);
}
