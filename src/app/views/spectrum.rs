//! View of the spectrum of the settled motion: amplitude over frequency, on a logarithmic scale.

use eframe::egui::{self, Rect, Ui, UiBuilder, vec2};

use crate::app::ui::widgets::{segment_ui, tell};
use crate::output::{Ranges, SpectrumQuantity, spectrum_chart};
use interwell_studies::study::Signal;

use super::plot::plot_ui;
use super::{View, ViewContext, empty_ui};

/// Height in points of the row of choices.
const TOOLS: f32 = 30.0;

/// Signals with their names.
const SIGNALS: [(Signal, &str); 3] = [
    (Signal::Displacement, "Displacement"),
    (Signal::Velocity, "Velocity"),
    (Signal::BaseAcceleration, "Base"),
];

pub fn spectrum_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, style) = (ui.max_rect(), context.style);
    let tools = Rect::from_min_size(area.min, vec2(area.width(), TOOLS));
    ui.scope_builder(UiBuilder::new().max_rect(tools), |ui| {
        ui.horizontal_centered(|ui| {
            ui.add_space(8.0);
            for (signal, name) in SIGNALS {
                segment_ui(ui, &mut context.session.explore.spectra.signal, signal, name);
            }
        });
    });
    context.session.want_spectrum();
    let below = area.with_min_y(tools.bottom());
    let (parts, current) = context.session.explore.spectra.found.parts();
    let spectrum = match parts.last() {
        Some(Ok(spectrum)) => spectrum,
        Some(Err(problem)) => return empty_ui(ui, &style, below, problem),
        None => return empty_ui(ui, &style, below, "Computing."),
    };
    let chart = spectrum_chart(spectrum, SpectrumQuantity::Amplitude, Ranges::default());
    let name = SIGNALS.iter().find(|entry| entry.0 == spectrum.signal).map_or("", |entry| entry.1);
    let mut child = ui.new_child(UiBuilder::new().max_rect(below));
    if !current {
        child.set_opacity(0.4);
    }
    let Some(panel) = chart.panels().next() else { return };
    let plotted = plot_ui(&mut child, context.memory, View::Spectrum, &style, below, panel);
    plotted.read(ui, &style, panel);
    tell(&plotted.response, egui::Role::Canvas, &format!("spectrum of {}", name.to_lowercase()));
}
