//! Tables of the present motion: beside the one before the last change, and beside the pinned ones.

use eframe::egui::TextWrapMode::Extend;
use eframe::egui::{self, Button, RichText, Ui};

use crate::app::session::Card;
use crate::app::session::pins::{FULL, Pin, PinKind};
use crate::app::ui::widgets::tell;
use crate::scene::Stops;

use super::table::{Column, table_ui};
use super::{ViewContext, empty_ui, page_ui};

enum PinAction {
    TakeBack(char),
    Unpin(char),
}

/// Draws the view of the last change.
pub fn before_now_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (style, is_full) = (context.style, context.session.pins.is_full());
    let before = context.session.before.clone();
    let is_first = before.is_none();
    let column = |card| Column { card, ended: None, differs: false };
    let now = usize::from(!is_first);
    let columns: Vec<Column> =
        before.into_iter().chain([context.session.now_card()]).map(|card| column(Some(card))).collect();
    page_ui(ui, |ui| {
        let mut pin = false;
        table_ui(ui, context, (&columns, now), &mut |ui, column, _| match column {
            None => {
                let hover = "This motion continues, dashed, beside the motion that you change (K).";
                let button = ui.add_enabled(!is_full, Button::new("Pin").small());
                pin = button.on_hover_text(hover).on_disabled_hover_text(FULL).clicked();
            }
            Some(column) if column == now => _ = ui.label(RichText::new("now").heading()),
            Some(_) => _ = ui.label(RichText::new("before").color(style.faint())),
        });
        if is_first && ui.available_height() > 23.0 {
            ui.add_space(6.0);
            let text = "Change something: the state before it stays here to compare.";
            ui.label(RichText::new(text).color(style.faint()));
        }
        if pin {
            context.memory.pin = Some(PinKind::Motion);
        }
    });
}

/// Draws the view of the pinned motions.
pub fn compare_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    page_ui(ui, |ui| {
        buttons_ui(ui, context);
        if context.session.pins.all().is_empty() {
            let text = "Nothing is pinned. A pinned motion continues beside the present one, dashed, with \
                        the drive in step.";
            let below = ui.available_rect_before_wrap();
            return empty_ui(ui, &context.style, below, text);
        }
        match pinned_ui(ui, context) {
            Some(PinAction::TakeBack(letter)) => _ = context.session.take_back(letter),
            Some(PinAction::Unpin(letter)) => context.session.pins.unpin(letter),
            None => {}
        }
    });
}

fn buttons_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let full = context.session.pins.is_full();
    let stops = match context.session.scene().stops {
        Stops::None => "With stops",
        _ => "Without stops",
    };
    let twin = "From the start again, with a second mass that begins a micrometre beside it. The view \
                Distance shows how far the two are apart.";
    let all = [
        ("Pin", "The motion as it is, to change the scene beside it (K).", PinKind::Motion),
        (stops, "The motion from here on with its stops switched the other way.", PinKind::OtherStops),
        ("Twin", twin, PinKind::Twin),
    ];
    ui.horizontal_wrapped(|ui| {
        for (name, hover, kind) in all {
            let button = ui.add_enabled(!full, Button::new(name));
            if button.on_hover_text(hover).on_disabled_hover_text(FULL).clicked() {
                context.memory.pin = Some(kind);
            }
        }
    });
}

/// The table of the present motion and the pinned ones. Returns the action clicked.
fn pinned_ui(ui: &mut Ui, context: &ViewContext<'_>) -> Option<PinAction> {
    let pins = context.session.pins.all();
    let pinned = |pin: &Pin| {
        let thresholds = pin.thresholds.filter(|_| !context.session.keeps_remedy);
        let card = Card { scene: pin.scene.clone(), settled: pin.settled().copied(), thresholds };
        let ended = pin.watch.ended().and_then(|outcome| outcome.ended_at());
        Column { card: Some(card), ended, differs: true }
    };
    let now = Column { card: Some(context.session.now_card()), ended: None, differs: false };
    let columns: Vec<Column> = std::iter::once(now).chain(pins.iter().map(pinned)).collect();
    let mut action = None;
    table_ui(ui, context, (&columns, 0), &mut |ui, column, _| match column {
        None => {}
        Some(0) => _ = ui.label(RichText::new("now").heading()),
        Some(i) => action = action.take().or(heading_ui(ui, context, &pins[i - 1])),
    });
    action
}

/// Name of a pin and the buttons that act on it. Returns the action clicked.
fn heading_ui(ui: &mut Ui, context: &ViewContext<'_>, pin: &Pin) -> Option<PinAction> {
    let (letter, mut action) = (pin.letter, None);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let kind = match (pin.kind, pin.scene.stops) {
            (PinKind::Motion, _) => "pinned as it was",
            (PinKind::OtherStops, Stops::None) => "pinned without stops",
            (PinKind::OtherStops, _) => "pinned with stops",
            (PinKind::Twin, _) => "begun a micrometre beside the mass",
        };
        let hover = format!("{letter}: {kind}. In brackets: how much more or less it is than now.");
        let name = if pin.kind == PinKind::Twin { format!("{letter} twin") } else { letter.to_string() };
        ui.label(RichText::new(name).heading().color(context.style.pin())).on_hover_text(hover);
        let hover = "The scene as it is in this pin: one step that can be undone. The motion goes on from \
                     where it is.";
        let other = pin.scene != *context.session.scene();
        let text = RichText::new("Back").small();
        let back = ui.add_enabled(other, Button::new(text).small().wrap_mode(Extend));
        let spoken = format!("Take {letter} back");
        back.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, other, &spoken));
        let back = back.on_hover_text(hover).on_disabled_hover_text("It is the present scene.");
        let unpin = ui.add(Button::new(RichText::new("Unpin").small()).small().wrap_mode(Extend));
        tell(&unpin, egui::Role::Button, &format!("Unpin {letter}"));
        action = match (back.clicked(), unpin.clicked()) {
            (_, true) => Some(PinAction::Unpin(letter)),
            (is_back, _) => is_back.then_some(PinAction::TakeBack(letter)),
        };
    });
    action
}
