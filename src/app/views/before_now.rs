//! Before / now: what the last gesture changed.

use eframe::egui::{self, Grid, RichText, Sense, Ui, Vec2};

use crate::app::session::Card;
use crate::app::status::{Kind, grams, mm, speed};
use crate::app::widgets::kind_shapes;
use crate::app::words::explained;
use crate::dynamics::Regime;
use crate::scene::{Excitation, Scene, Stops};
use crate::study::Settled;

use super::ViewContext;

/// Draws it. Whether something changed.
pub fn before_now_ui(ui: &mut Ui, context: &mut ViewContext<'_>) -> bool {
    let style = context.style;
    let ground = egui::Frame::new().fill(style.ground()).inner_margin(10.0);
    ground.show(ui, |ui| {
        ui.set_min_size(ui.available_size());
        let now = context.session.now_card();
        let before = context.session.before_card().cloned();
        let columns = ui.available_width() / 3.0 - 12.0;
        Grid::new("before and now").num_columns(3).min_col_width(columns).spacing([8.0, 6.0]).show(
            ui,
            |ui| {
                ui.label("");
                ui.label(RichText::new("before").color(style.faint()));
                ui.label(RichText::new("now").heading());
                ui.end_row();
                let row = |ui: &mut Ui, name: &str, text: &dyn Fn(&Card) -> String| {
                    explained(ui.label(RichText::new(name).color(style.faint())), name);
                    ui.label(before.as_ref().map_or_else(dash, text));
                    ui.label(RichText::new(text(&now)).heading());
                    ui.end_row();
                };
                row(ui, "shaking", &|card| shaking(&card.scene));
                row(ui, "stops", &|card| stops(&card.scene));
                ui.label(RichText::new("motion").color(style.faint()));
                for card in [before.as_ref(), Some(&now)] {
                    regime_ui(ui, context, card.and_then(|card| card.settled.as_ref()));
                }
                ui.end_row();
                row(ui, "RMS velocity", &|card| {
                    value(card, |s| s.summary.rms_velocity.map(|rms| format!("{} mm/s", speed(rms))))
                });
                row(ui, "reach", &|card| {
                    value(card, |s| s.summary.max_abs_x.map(|reach| format!("{} mm", mm(reach))))
                });
                row(ui, "crosses from", &crosses_from);
            },
        );
        // only where there is room for it
        if before.is_none() && ui.available_height() > 28.0 {
            ui.add_space(6.0);
            ui.label(
                RichText::new("Change something: the state before it stays here to compare.")
                    .color(style.faint()),
            );
        }
    });
    false
}

/// The least shaking that crosses, as far as it was searched for.
fn crosses_from(card: &Card) -> String {
    let found = card.thresholds.and_then(|found| found.crosses_from);
    match found {
        Some(g) => format!("{} g", grams(g)),
        None => dash(),
    }
}

fn dash() -> String {
    "-".to_owned()
}

fn value(card: &Card, of: impl Fn(&Settled) -> Option<String>) -> String {
    card.settled.as_ref().and_then(of).unwrap_or_else(dash)
}

fn shaking(scene: &Scene) -> String {
    match &scene.excitation {
        Excitation::None => "none".to_owned(),
        Excitation::Constant { accel_g } => format!("{accel_g:.2} g, constant"),
        Excitation::Sine { amplitude_g, frequency_hz, .. } => {
            format!("{amplitude_g:.2} g, {frequency_hz:.1} Hz")
        }
        Excitation::AmplitudeRamp { from_g, to_g, .. } => format!("{from_g:.2} to {to_g:.2} g"),
        Excitation::Chirp { from_hz, to_hz, .. } => format!("{from_hz:.1} to {to_hz:.1} Hz"),
        Excitation::Noise { rms_g, .. } => format!("noise, {rms_g:.2} g"),
        Excitation::Recorded { .. } => "recorded".to_owned(),
        Excitation::Sum(_) => "several".to_owned(),
    }
}

fn stops(scene: &Scene) -> String {
    match scene.stops {
        Stops::None => "none".to_owned(),
        Stops::Rigid { travel_limit_mm, .. } => format!("±{travel_limit_mm:.2} mm"),
        Stops::Hertz { travel_limit_mm, .. } => format!("±{travel_limit_mm:.2} mm, compliant"),
        Stops::Uneven { left_mm, right_mm, .. } => {
            let side =
                |mm: Option<f64>, sign: &str| mm.map_or("open".to_owned(), |mm| format!("{sign}{mm:.2} mm"));
            format!("{}, {}", side(left_mm, "-"), side(right_mm, "+"))
        }
    }
}

fn regime_ui(ui: &mut Ui, context: &ViewContext<'_>, settled: Option<&Settled>) {
    let Some(settled) = settled else {
        ui.label("-");
        return;
    };
    let (kind, name) = match settled.summary.regime {
        Regime::Rest => (Kind::Resting, "resting"),
        Regime::Intrawell if settled.summary.releases > 0 => (Kind::Intrawell, "hopping"),
        Regime::Intrawell => (Kind::Intrawell, "intrawell"),
        Regime::Interwell => (Kind::Interwell, "interwell"),
        Regime::Irregular => (Kind::Irregular, "irregular"),
        Regime::Crossing => (Kind::Crossing, "crossing"),
        Regime::OneWell => (Kind::Other, "one well"),
    };
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(Vec2::splat(16.0), Sense::hover());
        ui.painter().extend(kind_shapes(kind, rect.center(), 5.0, context.style.kind(kind)));
        explained(ui.label(name), name);
    });
}
