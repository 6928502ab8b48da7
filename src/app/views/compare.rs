//! Table of the present motion and the pinned ones, with differences.

use eframe::egui::TextWrapMode::Extend;
use eframe::egui::{self, Button, FontId, Grid, Label, RichText, ScrollArea, TextStyle, Ui};

use crate::app::session::Card;
use crate::app::session::pins::{Pin, PinKind};
use crate::app::ui::style::{SMALL, Style, strong_family};
use crate::app::words::meanings::explained;
use crate::app::words::status::seconds;
use crate::dynamics::Summary;
use crate::scene::Stops;

use super::ViewContext;
use super::before_now::{reach, regime_ui, rms, shaking, stops, value};

/// A row of the table: name, unit, text of a value, the value itself, and the decimals of a difference.
type Row = (&'static str, &'static str, fn(&Card) -> String, fn(&Summary) -> Option<f64>, fn(f64) -> usize);

const NUMBERS: [Row; 3] = [
    ("RMS velocity", "mm/s", rms, |run| run.rms_velocity.map(|v| v * 1e3), |size| usize::from(size < 9.95)),
    ("reach", "mm", reach, |run| run.max_abs_x.map(|x| x * 1e3), |size| if size < 0.95 { 2 } else { 1 }),
    ("impacts take", "%", impacts, |run| run.impact_share.map(|share| share * 100.0), |_| 0),
];

/// Width in points of the column of names.
const NAMES: f32 = 92.0;
/// Smallest width in points of a column of values.
const MIN_COLUMN: f32 = 44.0;
/// Width in points from which on a column has text of full size beside the symbols.
const WIDE_COLUMN: f32 = 96.0;

/// Gap in points between columns.
const COLUMN_GAP: f32 = 8.0;

/// An action on a pin.
enum PinAction {
    TakeBack(char),
    Unpin(char),
}

pub fn compare_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let style = context.style;
    let ground = egui::Frame::new().fill(style.ground()).inner_margin(10.0);
    ground.show(ui, |ui| {
        ui.set_min_size(ui.available_size());
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            buttons_ui(ui, context);
            if context.session.pins.all().is_empty() {
                let text = "Nothing is pinned. A pinned motion goes on beside the present one, dashed, with \
                            the drive in step.";
                ui.add(Label::new(RichText::new(text).color(style.faint())).wrap());
                return;
            }
            match table_ui(ui, context) {
                Some(PinAction::TakeBack(letter)) => _ = context.session.take_back(letter),
                Some(PinAction::Unpin(letter)) => context.session.pins.unpin(letter),
                None => {}
            }
        });
    });
}

/// Buttons that pin a motion.
fn buttons_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let full = context.session.pins.is_full();
    let stops = match context.session.scene().stops {
        Stops::None => "With stops",
        _ => "Without stops",
    };
    let all = [
        ("Pin", "The motion as it is, to change the scene beside it (K).", PinKind::Motion),
        (stops, "The motion from here on with its stops switched the other way.", PinKind::OtherStops),
        (
            "Twin",
            "From the start again, with a second mass that begins a micrometre beside it. The view Distance \
             shows how far the two are apart.",
            PinKind::Twin,
        ),
    ];
    ui.horizontal_wrapped(|ui| {
        for (name, hover, kind) in all {
            let button = ui.add_enabled(!full, Button::new(name));
            let button = button.on_hover_text(hover).on_disabled_hover_text("Unpin one first.");
            if button.clicked() {
                context.memory.pin = Some(kind);
            }
        }
    });
}

fn table_ui(ui: &mut Ui, context: &ViewContext<'_>) -> Option<PinAction> {
    let style = context.style;
    let now = context.session.now_card();
    let pins: Vec<(&Pin, Card)> = context.session.pins.all().iter().map(|pin| (pin, card(pin))).collect();
    let columns = (1 + pins.len()) as f32;
    let width = ((ui.available_width() - NAMES) / columns - COLUMN_GAP).max(MIN_COLUMN);
    let small = width < WIDE_COLUMN;
    if small {
        let styles = &mut ui.style_mut().text_styles;
        styles.insert(TextStyle::Body, style.small());
        styles.insert(TextStyle::Heading, FontId::new(SMALL, strong_family()));
        (ui.spacing_mut().button_padding.x, ui.spacing_mut().interact_size.y) = (2.0, 0.0);
    }
    let mut action = None;
    let name_ui = |ui: &mut Ui, name: &str, unit: &str| {
        let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
        let text = RichText::new(format!("{name}{unit}")).color(style.faint());
        explained(cell_ui(ui, NAMES, |ui| ui.add(Label::new(text).wrap())), name);
    };
    Grid::new("compare").num_columns(2 + pins.len()).spacing([COLUMN_GAP, 2.0]).show(ui, |ui| {
        ui.label("");
        cell_ui(ui, width, |ui| ui.label(RichText::new("now").heading()));
        for (pin, _) in &pins {
            let clicked = cell_ui(ui, width, |ui| heading_ui(ui, context, pin, width));
            action = action.take().or(clicked);
        }
        ui.end_row();
        for (name, unit, text) in [("shaking", "", shaking as fn(&_) -> String), ("stops", "mm", stops)] {
            name_ui(ui, name, unit);
            let present = text(&now.scene);
            let write = |ui: &mut Ui, text: RichText| {
                cell_ui(ui, width, |ui| ui.add(Label::new(text).wrap()));
            };
            write(ui, RichText::new(bare(&present, unit)).heading());
            for (_, card) in &pins {
                let text = text(&card.scene);
                let shown = RichText::new(bare(&text, unit));
                write(ui, if text == present { shown.color(style.faint()) } else { shown });
            }
            ui.end_row();
        }
        name_ui(ui, "motion", "");
        cell_ui(ui, width, |ui| regime_ui(ui, context, now.settled.as_ref(), small));
        for (pin, card) in &pins {
            cell_ui(ui, width, |ui| match pin.ended().and_then(|outcome| outcome.ended_at()) {
                Some(at) => {
                    let text = format!("ended at {}, stays there", seconds(at));
                    ui.add(Label::new(RichText::new(text).font(style.small())).wrap());
                }
                None => regime_ui(ui, context, card.settled.as_ref(), small),
            });
        }
        ui.end_row();
        for (name, unit, text, number, decimals) in NUMBERS {
            name_ui(ui, name, unit);
            let present = RichText::new(bare(&text(&now), unit)).heading();
            cell_ui(ui, width, |ui| ui.label(present));
            for (_, card) in &pins {
                let delta = difference(card, &now, number, decimals);
                cell_ui(ui, width, |ui| number_ui(ui, &style, &bare(&text(card), unit), delta.as_deref()));
            }
            ui.end_row();
        }
    });
    action
}

fn cell_ui<R>(ui: &mut Ui, width: f32, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let cell = ui.vertical(|ui| {
        ui.set_width(width);
        contents(ui)
    });
    cell.inner
}

/// A text without the unit that the heading of its row contains.
fn bare(text: &str, unit: &str) -> String {
    if unit.is_empty() { text.to_owned() } else { text.replace(&format!(" {unit}"), "") }
}

/// Name of a pin and the buttons that act on it. Returns the action clicked.
fn heading_ui(ui: &mut Ui, context: &ViewContext<'_>, pin: &Pin, width: f32) -> Option<PinAction> {
    let (letter, mut action) = (pin.letter(), None);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let kind = match (pin.kind(), pin.scene().stops) {
            (PinKind::Motion, _) => "pinned as it was",
            (PinKind::OtherStops, Stops::None) => "pinned without stops",
            (PinKind::OtherStops, _) => "pinned with stops",
            (PinKind::Twin, _) => "begun a micrometre beside the mass",
        };
        let hover = format!("{letter}: {kind}. In brackets: how much more or less it is than now.");
        let name = if pin.kind() == PinKind::Twin { format!("{letter} twin") } else { letter.to_string() };
        ui.label(RichText::new(name).heading()).on_hover_text(hover);
        let hover = "The scene as it is in this pin: one step that can be undone. The motion goes on from \
                     where it is.";
        let other = pin.scene() != context.session.scene();
        let text = RichText::new(if width < WIDE_COLUMN { "Back" } else { "Take back" }).small();
        let back = ui.add_enabled(other, Button::new(text).small().wrap_mode(Extend));
        if named(back, other, format!("Take {letter} back"))
            .on_hover_text(hover)
            .on_disabled_hover_text("It is the present scene.")
            .clicked()
        {
            action = Some(PinAction::TakeBack(letter));
        }
        let unpin = ui.add(Button::new(RichText::new("Unpin").small()).small().wrap_mode(Extend));
        if named(unpin, true, format!("Unpin {letter}")).clicked() {
            action = Some(PinAction::Unpin(letter));
        }
    });
    action
}

/// Gives a button a unique name for screen readers.
fn named(button: egui::Response, enabled: bool, name: String) -> egui::Response {
    button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, enabled, &name));
    button
}

/// A value, with its difference from the present motion in brackets.
fn number_ui(ui: &mut Ui, style: &Style, text: &str, difference: Option<&str>) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.label(text);
        if let Some(difference) = difference {
            ui.label(RichText::new(format!("({difference})")).font(style.small()).color(style.faint()));
        }
    });
}

/// The value of a pin minus that of the present motion, as text. `None` while either is unknown.
fn difference(
    pin: &Card,
    now: &Card,
    number: fn(&Summary) -> Option<f64>,
    decimals: fn(f64) -> usize,
) -> Option<String> {
    let of = |card: &Card| card.settled.as_ref().and_then(number);
    let (pinned, now) = (of(pin)?, of(now)?);
    let decimals = decimals(pinned.abs().max(now.abs()));
    let text = format!("{:+.decimals$}", pinned - now);
    // a difference that rounds to zero has no sign
    let is_zero = text.trim_start_matches(['+', '-', '0', '.']).is_empty();
    Some(if is_zero { "same".to_owned() } else { text })
}

/// Share of the work that impacts dissipate.
fn impacts(card: &Card) -> String {
    value(card, |settled| settled.impact_share.map(|share| format!("{:.0} %", 100.0 * share)))
}

fn card(pin: &Pin) -> Card {
    Card { scene: pin.scene().clone(), settled: pin.settled().copied(), thresholds: None }
}
