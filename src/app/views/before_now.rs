//! View of the last change: the scene and its motion before it and now.

use eframe::egui::{self, Button, Grid, RichText, ScrollArea, Sense, Ui, Vec2};

use crate::app::session::Card;
use crate::app::session::pins::PinKind;
use crate::app::ui::widgets::kind_shapes;
use crate::app::words::fields::{mechanism_name, name_and_unit};
use crate::app::words::meanings::{explained, meaning};
use crate::app::words::numbers::{decimals_for, exact, shown};
use crate::app::words::status::{Kind, grams, mm_beside, seconds, speed};
use crate::dynamics::{Outcome, Summary};
use crate::scene::{Damping, Excitation, FieldPath, Scene, Start, numeric_fields};

use super::ViewContext;

/// Height of a row in points.
const ROW: f32 = 20.0;
/// Largest and smallest gap between two rows in points.
const ROW_GAP: (f32, f32) = (6.0, 1.0);

/// Number of rows always shown: heading, motion, RMS velocity, reach and crossing threshold.
const FIXED_ROWS: usize = 5;

pub fn before_now_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let style = context.style;
    let ground = egui::Frame::new().fill(style.ground()).inner_margin(10.0);
    ground.show(ui, |ui| {
        ui.set_min_size(ui.available_size());
        // scrolls where not all rows fit
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| card_ui(ui, context));
    });
}

fn card_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let style = context.style;
    let now = context.session.now_card();
    let before = context.session.before_card();
    let mut rows = before.map_or_else(Vec::new, |before| changes(&before.scene, &now.scene));
    // shaking and stops are shown even if unchanged, where there is room
    let height = ui.available_height();
    let room = (height / (ROW + ROW_GAP.1)) as usize;
    for (i, (name, text)) in
        [("shaking", shaking as fn(&Scene) -> String), ("stops", stops)].into_iter().enumerate()
    {
        let old = before.map_or_else(dash, |before| text(&before.scene));
        if rows.iter().all(|row| row.name != name) && rows.len() + FIXED_ROWS < room {
            let at = rows.len().min(i);
            rows.insert(at, Row { name: name.to_owned(), before: old, now: text(&now.scene) });
        }
    }
    let columns = ui.available_width() / 3.0 - 12.0;
    let count = (rows.len() + FIXED_ROWS) as f32;
    let gap = ((height - count * ROW) / (count - 1.0)).clamp(ROW_GAP.1, ROW_GAP.0);
    let grid = Grid::new("before and now").num_columns(3).min_col_width(columns).spacing([8.0, gap]);
    let mut pin = false;
    grid.show(ui, |ui| {
        let hover = "This motion goes on, dashed, beside the one that you change from here on (K).";
        let button = ui.add_enabled(!context.session.pins.is_full(), Button::new("Pin").small());
        pin = button.on_hover_text(hover).on_disabled_hover_text("Unpin one first.").clicked();
        ui.label(RichText::new("before").color(style.faint()));
        ui.label(RichText::new("now").heading());
        ui.end_row();
        let row_ui = |ui: &mut Ui, row: &Row| {
            let name = ui.label(RichText::new(&row.name).color(style.faint()));
            match now.settled.as_ref().filter(|_| row.name == RMS) {
                Some(settled) => name.on_hover_text(rms_words(settled)),
                None => explained(name, &row.name),
            };
            ui.label(&row.before);
            ui.label(RichText::new(&row.now).heading());
            ui.end_row();
        };
        rows.iter().for_each(|row| row_ui(ui, row));
        ui.label(RichText::new("motion").color(style.faint()));
        for card in [before, Some(&now)] {
            regime_ui(ui, context, card.and_then(|card| card.settled.as_ref()), false);
        }
        ui.end_row();
        let both = |name: &str, text: fn(&Card) -> String| Row {
            name: name.to_owned(),
            before: before.map_or_else(dash, text),
            now: text(&now),
        };
        row_ui(ui, &both(RMS, rms));
        row_ui(ui, &both("reach", reach));
        if !context.session.keeps_remedy {
            row_ui(ui, &both("crosses from", crosses_from));
        }
    });
    if before.is_none() && ui.available_height() > 28.0 {
        ui.add_space(6.0);
        let text = "Change something: the state before it stays here to compare.";
        ui.label(RichText::new(text).color(style.faint()));
    }
    if pin {
        context.memory.pin = Some(PinKind::Motion);
    }
}

const RMS: &str = "RMS velocity";

/// Meaning of the RMS velocity, and the time over which it was taken.
fn rms_words(settled: &Summary) -> String {
    let (from, to) = settled.window;
    let time = format!("from {} to {} after the start or the last change", seconds(from), seconds(to));
    format!("{}\n\nHere it was taken {time}.", meaning(RMS).unwrap_or_default())
}

#[derive(Debug, Clone, PartialEq)]
struct Row {
    name: String,
    before: String,
    now: String,
}

/// Rows for all differences: one each for shaking, stops, damping, mechanism, start and other numbers.
fn changes(before: &Scene, now: &Scene) -> Vec<Row> {
    let row = |name: &str, text: fn(&Scene) -> String| Row {
        name: name.to_owned(),
        before: text(before),
        now: text(now),
    };
    let whole = [
        row("shaking", shaking),
        row("stops", stops),
        row("damping", damping),
        row("mechanism", |scene| mechanism_name(&scene.mechanism)),
        row("start", start),
    ];
    let mut rows: Vec<Row> = whole.into_iter().filter(|row| row.before != row.now).collect();
    let differs = |name: &str, rows: &[Row]| rows.iter().any(|row| row.name == name);
    let (shaking_differs, stops_differ, start_differs) =
        (differs("shaking", &rows), differs("stops", &rows), differs("start", &rows));
    for path in numeric_fields(now) {
        let ((name, unit), field) = (name_and_unit(&path), FieldPath::new(&path));
        let numbers = [before, now].map(|scene| field.get(scene));
        let [Some(was), Some(is)] = numbers else { continue };
        // numbers that a row above contains already
        let is_in_row_above = match path.split_once('.') {
            Some(("excitation", number)) => shaking_differs && in_shaking(&now.excitation, number),
            Some(("stops", number)) => stops_differ && number.ends_with("_mm") && number != "radius_mm",
            Some(("start", _)) => start_differs,
            Some(("app", _)) => true,
            _ => false,
        };
        if was == is || is_in_row_above {
            continue;
        }
        // all digits if the rounded numbers are equal
        let rounded_differ = shown(was, 0) != shown(is, 0);
        let text = |value: f64| {
            let number = if rounded_differ { shown(value, 0) } else { exact(value, 0) };
            format!("{number} {unit}").trim_end().to_owned()
        };
        rows.push(Row { name, before: text(was), now: text(is) });
    }
    rows
}

/// Whether the row of the shaking contains this number.
fn in_shaking(excitation: &Excitation, number: &str) -> bool {
    let all: &[&str] = match excitation {
        Excitation::Constant { .. } => &["accel_g"],
        Excitation::Sine { .. } => &["amplitude_g", "frequency_hz"],
        Excitation::AmplitudeRamp { .. } => &["from_g", "to_g"],
        Excitation::Chirp { .. } => &["amplitude_g", "from_hz", "to_hz"],
        Excitation::Noise { .. } => &["rms_g"],
        _ => &[],
    };
    all.contains(&number)
}

pub(super) fn rms(card: &Card) -> String {
    value(card, |settled| settled.rms_velocity.map(|rms| format!("{} mm/s", speed(rms))))
}

pub(super) fn reach(card: &Card) -> String {
    let [left, right] = card.scene.stops.limits_mm();
    let stops = (left.map(|mm| -mm * 1e-3), right.map(|mm| mm * 1e-3));
    value(card, |settled| settled.max_abs_x.map(|reach| format!("{} mm", mm_beside(reach, stops))))
}

/// The smallest shaking amplitude at which the mass crosses the barrier, as far as it is known.
fn crosses_from(card: &Card) -> String {
    let found = card.thresholds.map(|found| found.crossing);
    match found.and_then(|crossing| Some((crossing.value?, crossing.undecided))) {
        Some((g, true)) => format!("about {} g", grams(g)),
        Some((g, false)) => format!("{} g", grams(g)),
        None => dash(),
    }
}

fn dash() -> String {
    "-".to_owned()
}

pub(super) fn value(card: &Card, of: impl Fn(&Summary) -> Option<String>) -> String {
    card.settled.as_ref().and_then(of).unwrap_or_else(dash)
}

pub(super) fn shaking(scene: &Scene) -> String {
    // a difference that this rounding hides has a row of its own, from `changes`
    let rounded = |value: f64| format!("{value:.3e}").parse().unwrap_or(value);
    let g = |value: f64| shown(rounded(value), 2);
    let hz = |value: f64| shown(rounded(value), 1);
    match &scene.excitation {
        Excitation::None => "none".to_owned(),
        Excitation::Constant { accel_g } => format!("{} g, constant", g(*accel_g)),
        Excitation::Sine { amplitude_g, frequency_hz, .. } => {
            format!("{} g, {} Hz", g(*amplitude_g), hz(*frequency_hz))
        }
        Excitation::AmplitudeRamp { from_g, to_g, .. } => format!("{} to {} g", g(*from_g), g(*to_g)),
        Excitation::Chirp { from_hz, to_hz, amplitude_g, .. } => {
            format!("{} g, {} to {} Hz", g(*amplitude_g), hz(*from_hz), hz(*to_hz))
        }
        Excitation::Noise { rms_g, .. } => format!("noise, {} g", g(*rms_g)),
        Excitation::Recorded { .. } => "recorded".to_owned(),
        Excitation::Sum(terms) => format!("sum of {}", terms.len()),
    }
}

pub(super) fn stops(scene: &Scene) -> String {
    let (stops, mm) = (&scene.stops, |value: f64| format!("{} mm", shown(value, decimals_for(value).min(2))));
    let side =
        |stop: Option<f64>, sign: &str| stop.map_or("open".to_owned(), |stop| format!("{sign}{}", mm(stop)));
    match (stops.travel_limit_mm(), stops.limits_mm()) {
        (Some(limit), _) if stops.restitutions() == [None; 2] => format!("±{}, compliant", mm(limit)),
        (Some(limit), _) => format!("±{}", mm(limit)),
        (None, [None, None]) => "none".to_owned(),
        (None, [left, right]) => format!("{}, {}", side(left, "-"), side(right, "+")),
    }
}

/// The kind of damping; its value has another row.
fn damping(scene: &Scene) -> String {
    match scene.damping {
        Damping::None => "none",
        Damping::Ratio(_) => "by ratio",
        Damping::Coefficient { .. } => "by coefficient",
    }
    .to_owned()
}

fn start(scene: &Scene) -> String {
    match scene.start {
        Start::Rest => "at rest".to_owned(),
        Start::At { x_mm, v_m_per_s, .. } => format!("{} mm, {} m/s", shown(x_mm, 1), shown(v_m_per_s, 0)),
    }
}

/// Symbol and name of the regime; if `small`, the name stands below the symbol in small text.
pub(super) fn regime_ui(ui: &mut Ui, context: &ViewContext<'_>, settled: Option<&Summary>, small: bool) {
    let Some(settled) = settled else {
        ui.label("-");
        return;
    };
    if settled.outcome != Outcome::Done {
        let text = RichText::new("the run ended early");
        ui.add(egui::Label::new(if small { text.font(context.style.small()) } else { text }).wrap());
        return;
    }
    let kind = Kind::from(settled.regime);
    let name = match kind {
        Kind::Resting => "resting",
        Kind::Intrawell if settled.releases > 0 => "hopping",
        kind => kind.name(),
    };
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(Vec2::splat(16.0), Sense::hover());
        ui.painter().extend(kind_shapes(kind, rect.center(), 5.0, context.style.kind(kind)));
        if !small {
            explained(ui.label(name), name);
        }
    });
    if small {
        explained(ui.label(RichText::new(name).font(context.style.small())), name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Document, PRESETS};

    /// Every difference has one row, whose two sides differ.
    #[test]
    fn every_number_that_differs_has_a_row() {
        for preset in PRESETS {
            let before = Document::load(preset.name).unwrap().scene;
            for path in numeric_fields(&before).iter().filter(|path| !path.starts_with("app.")) {
                let (mut now, field) = (before.clone(), FieldPath::new(path));
                let Some(value) = field.get(&before) else { continue };
                let changed = if value == 0.0 { 1.0 } else { value * 1.000_000_01 };
                assert!(field.set(&mut now, changed));
                // an integer field ignores so small a change
                if now == before {
                    assert!(field.set(&mut now, value + 1.0));
                }
                let rows = changes(&before, &now);
                assert!(rows.len() == 1, "{} {path}: {rows:?}", preset.name);
                assert!(rows.iter().all(|row| row.before != row.now), "{path}: {rows:?}");
            }
            assert!(changes(&before, &before).is_empty());
        }
    }
}
