//! View of the measured data: shift and scale in time, and differences from the computed motion.

use eframe::egui::{self, Button, Grid, Id, RichText, Ui};

use crate::app::session::Session;
use crate::app::session::measured::{Differences, MeasuredData, Overlay, file_name, sentence};
use crate::app::ui::knob::{How, Knob};
use crate::app::ui::style::Style;
use crate::app::words::fields::Reach;
use crate::app::words::numbers::{UNKNOWN, below, decimals_for, three};
use crate::dynamics::STANDARD_GRAVITY;
use crate::numeric::short;
use crate::scene::{Quantity, Start};
use interwell_studies::study::{Table, metres};

use super::{ViewContext, offer_ui, page_ui};

/// Range of the shift slider to either side, in forcing periods or characteristic times.
const PERIODS: f64 = 2.0;

/// Largest shift in s, offset in mm and time scale that may be typed.
const MAX_TYPED: f64 = 1e12;

/// Percentage above which it is left out, since the reference is close to zero.
const MAX_PERCENT: f64 = 1000.0;

/// Width of a slider in points.
const SLIDER: f32 = 100.0;

pub fn measured_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    page_ui(ui, |ui| {
        let Some(over) = context.session.measured.over.clone() else {
            let text = "Drop a CSV on the window, of displacement, velocity or acceleration over time or of \
                        force over position, to compare it with the computed motion or force.";
            let room = ui.available_rect_before_wrap();
            let is_wanted = offer_ui(ui, &context.style, room, text, "Open measured data...");
            context.memory.open_measured |= is_wanted;
            return;
        };
        context.session.want_differences();
        head_ui(ui, context, &over);
        ui.horizontal_wrapped(|ui| {
            if over.record.timing.is_some() {
                time_ui(ui, context.session, &over);
            }
            offset_ui(ui, context.session, &over);
        });
        if let Some(Err(why)) = context.session.measured.fit.answer() {
            ui.label(format!("No shift was found. {why}"));
        }
        differences_ui(ui, context, &over);
    });
}

/// The control of a number of the record, by its id, its name and its unit; it may be typed from `least` on.
fn of_record(names: [&'static str; 3], reach: Reach, least: f64, hover: &'static str) -> Knob<'static> {
    let [id, name, unit] = names;
    Knob { id: Id::unique(id), name, unit, reach, typed: (least, MAX_TYPED), hover, width: SLIDER }
}

/// Draws the number of a control without a slider, after its name. Returns the number if it changed.
fn alone_ui(ui: &mut Ui, knob: Knob<'_>, value: f64) -> Option<f64> {
    ui.label(knob.name).on_hover_text(knob.hover);
    knob.alone_ui(ui, value)
}

/// Name of the record and the buttons that act on it.
fn head_ui(ui: &mut Ui, context: &mut ViewContext<'_>, over: &Overlay) {
    let record = &over.record;
    ui.horizontal(|ui| {
        let name = egui::Label::new(RichText::new(file_name(&record.path)).heading()).truncate();
        ui.scope(|ui| {
            ui.set_max_width((ui.available_width() - 180.0).max(60.0));
            let [across, values] = [&record.across, &record.values]
                .map(|channel| format!("{} from `{}`", channel.quantity.name(), channel.column));
            ui.add(name).on_hover_text(format!("{across}, {values}. {}", record.describe()));
        });
        if record.timing.is_some() {
            let fitting = context.session.measured.fit.is_running();
            let fit = ui.add_enabled(!fitting, Button::new("Fit the shift").small());
            let hover = "The shift with the least mean square difference from the run of the scene, where at \
                         least half of the shorter of the two overlaps; of several that fit, the one nearest \
                         to 0.";
            if fit.on_hover_text(hover).on_disabled_hover_text("Looking for it.").clicked() {
                context.session.fit_shift();
            }
        }
        if ui.add(Button::new("Remove").small()).clicked() {
            context.session.measured = MeasuredData::default();
        }
    });
}

fn time_ui(ui: &mut Ui, session: &mut Session, over: &Overlay) {
    let model = session.model();
    let period = model.forcing_period().unwrap_or(model.characteristic_time());
    let (low, high) = (over.centre - PERIODS * period, over.centre + PERIODS * period);
    let reach = Reach::even(low, high, below(period / 200.0));
    let hover = "Added to the times of the record. Type a number to go farther than the slider.";
    let knob = of_record(["shift of the record", "shift", "s"], reach, -MAX_TYPED, hover);
    let turn = ui.horizontal(|ui| knob.ui(ui, over.shift)).inner;
    if let Some(shift) = turn.value {
        session.measured.shift_to(shift, turn.how == How::Once);
    }
    let hover = "The factor of the times of the record, before they are shifted: 0.999 for a \
                 clock that is fast by a thousandth.";
    let reach = Reach::even(0.9, 1.1, 1e-4);
    let knob = of_record(["time scale of the record", "time scale", ""], reach, 1.0 / MAX_TYPED, hover);
    if let Some(scale) = alone_ui(ui, knob, over.time_scale)
        && let Some(over) = &mut session.measured.over
    {
        over.time_scale = scale;
    }
}

/// Control of the offset that is added to a displacement or a position.
fn offset_ui(ui: &mut Ui, session: &mut Session, over: &Overlay) {
    let record = &over.record;
    if ![record.across.quantity, record.values.quantity].contains(&Quantity::Displacement) {
        return;
    }
    let hover = "Added to the displacement if the sensor has its zero elsewhere: the \
                 difference of the means, once the shift is right.";
    let reach = Reach::even(-10.0, 10.0, 0.01);
    let knob = of_record(["offset of the record", "add", "mm"], reach, -MAX_TYPED, hover);
    if let Some(mm) = alone_ui(ui, knob, over.offset * 1e3)
        && let Some(over) = &mut session.measured.over
    {
        over.offset = metres(mm);
    }
}

/// Table of the differences, and a note on the run that they refer to.
fn differences_ui(ui: &mut Ui, context: &ViewContext<'_>, over: &Overlay) {
    let (style, session) = (context.style, &context.session);
    let faint = |text: String| egui::Label::new(RichText::new(text).color(style.faint())).wrap();
    let (parts, current) = session.measured.found.parts();
    match parts.last() {
        None => _ = ui.label("Computing."),
        Some(Err(problem)) => _ = ui.label(problem),
        Some(Ok(found)) => {
            let (table, remarks) = match found {
                Differences::Motion(motion) => (&motion.table, &motion.remarks),
                Differences::Force(force) => (&force.table, &force.remarks),
            };
            table_ui(ui, &style, table, current);
            // the hover text of the name describes the sampling already
            let sampled = over.record.timing.as_ref().map(|timing| timing.describe());
            for remark in remarks.iter().filter(|remark| sampled.as_ref() != Some(*remark)) {
                ui.add(faint(sentence(remark)));
            }
        }
    }
    if over.record.timing.is_none() {
        return;
    }
    let begin = match session.scene().start {
        Start::Rest => "from rest",
        Start::At { .. } => "from its start",
    };
    let end = short(session.model().duration());
    let mut text = format!("Compared with the run of the scene {begin}, 0 to {end} s.");
    if session.is_continued {
        text += " The motion on the screen was changed while it ran and is another one: the button at \
                 the left of the time bar restarts it.";
    }
    ui.add(faint(text));
}

fn table_ui(ui: &mut Ui, style: &Style, table: &Table, current: bool) {
    let numbers = |name: &str| table.numbers(name).unwrap_or_default();
    let ink = if current { style.ink() } else { style.faint() };
    let columns = ["measured", "computed", "difference", "difference_percent"].map(numbers);
    Grid::new("differences").num_columns(4).spacing([10.0, 2.0]).show(ui, |ui| {
        for name in ["", "measured", "computed", "difference"] {
            ui.label(RichText::new(name).color(style.faint()));
        }
        ui.end_row();
        for (row, (name, unit)) in table.words("quantity").iter().zip(table.words("unit")).enumerate() {
            let [measured, computed, difference, percent] = columns.map(|column| column[row]);
            // neither side has a value
            if !difference.is_finite() && measured.is_nan() && computed.is_nan() {
                continue;
            }
            let (scale, unit) = match *unit {
                "m" => (1e3, ", mm"),
                "m/s" => (1e3, ", mm/s"),
                "m/s2" => (1.0 / STANDARD_GRAVITY, ", g"),
                "N" => (1.0, ", N"),
                "s" => (1.0, ", s"),
                "g" => (1.0, ", g"),
                _ => (1.0, ""),
            };
            // both values get the decimals of the larger one
            let larger = measured.abs().max(computed.abs()) * scale;
            let decimals = if unit.is_empty() { 0 } else { decimals_for(larger) };
            let both = |value: f64| match value.is_finite() {
                true => format!("{:.decimals$}", value * scale),
                false if difference.is_finite() => String::new(),
                false => UNKNOWN.to_owned(),
            };
            let mut third = match difference.is_finite() && *name != "largest_difference_at" {
                true if unit.is_empty() => format!("{difference:.0}"),
                true if (difference * scale).abs() < 1e-9 * larger => "0".to_owned(), // rounding
                true => three(difference * scale),
                false => String::new(),
            };
            if percent.abs() < MAX_PERCENT && !third.is_empty() {
                let digits = usize::from(percent.abs() < 99.95);
                third += &format!(" ({percent:.digits$} %)");
            }
            ui.label(RichText::new(format!("{}{unit}", row_name(name))).color(style.faint()));
            for text in [both(measured), both(computed), third] {
                ui.label(RichText::new(text).color(ink));
            }
            ui.end_row();
        }
    });
}

fn row_name(name: &str) -> String {
    match name {
        "first_crossing_amplitude" => "shaking then".to_owned(),
        "rebound_height_left" | "rebound_height_right" => "their height".to_owned(),
        "rebound_height_left_worst" | "rebound_height_right_worst" => "farthest apart".to_owned(),
        "largest_difference_at" => "is at".to_owned(),
        name => name.replace('_', " ").replace("rms", "RMS"),
    }
}
