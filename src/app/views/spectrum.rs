//! View of the spectrum of the settled motion: amplitude over frequency, on a logarithmic scale.

use eframe::egui::{self, Rect, RichText, Ui, UiBuilder, vec2};
use egui_plot::{HLine, Line, PlotBounds, PlotPoints, Points, VLine};

use crate::app::ui::style::Style;
use crate::dynamics::STANDARD_GRAVITY;
use crate::study::{Signal, Spectrum};

use super::hand::axes_input;
use super::legend::{LEGEND, Symbol, legend};
use super::plot::{MARGIN, decades, marks, plot_place, power, still_plot};
use super::view::Axis;
use super::{Memory, View, ViewContext, too_small_ui};

/// Height in points of the row of choices.
const TOOLS: f32 = 30.0;

/// Number of decades shown below the largest amplitude.
const DECADES: f64 = 6.0;
/// Largest multiple of the forcing frequency shown.
const MULTIPLES: f64 = 15.0;

/// Largest number of points of a line; of more, the largest in each interval is drawn.
const MAX_POINTS: usize = 2000;

/// Signals with their names, units and the number of units per SI unit.
const SIGNALS: [(Signal, &str, &str, f64); 3] = [
    (Signal::Displacement, "Displacement", "mm", 1e3),
    (Signal::Velocity, "Velocity", "mm/s", 1e3),
    (Signal::BaseAcceleration, "Base", "g", 1.0 / STANDARD_GRAVITY),
];

pub fn spectrum_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, style) = (ui.max_rect(), context.style);
    if area.width() < 200.0 || area.height() < 140.0 {
        return too_small_ui(ui, &style, area);
    }
    ui.painter().rect_filled(area, 0.0, style.ground());
    let tools = Rect::from_min_size(area.min, vec2(area.width(), TOOLS));
    ui.scope_builder(UiBuilder::new().max_rect(tools), |ui| {
        ui.horizontal_centered(|ui| {
            ui.add_space(8.0);
            for (signal, name, ..) in SIGNALS {
                ui.selectable_value(&mut context.session.explore.spectra.signal, signal, name);
            }
        });
    });
    context.session.want_spectrum();
    let below = area.with_min_y(tools.bottom());
    let (parts, current) = context.session.explore.spectra.found.parts();
    match parts.last() {
        Some(Ok(spectrum)) => {
            let forcing = context.session.model().forcing_period().map(|period| 1.0 / period);
            picture_ui(ui, context.memory, &style, below, spectrum, current, forcing);
        }
        Some(Err(problem)) => message_ui(ui, &style, below, problem),
        None => message_ui(ui, &style, below, "Working it out."),
    }
}

fn message_ui(ui: &mut Ui, style: &Style, area: Rect, text: &str) {
    ui.scope_builder(UiBuilder::new().max_rect(area.shrink(10.0)), |ui| {
        ui.label(RichText::new(text).color(style.faint()));
    });
}

fn picture_ui(
    ui: &mut Ui,
    memory: &mut Memory,
    style: &Style,
    area: Rect,
    spectrum: &Spectrum,
    current: bool,
    forcing: Option<f64>,
) {
    let Some((_, name, unit, scale)) = SIGNALS.into_iter().find(|entry| entry.0 == spectrum.signal) else {
        return;
    };
    let (Some(frequency), Some(amplitude)) =
        (spectrum.table.numbers("frequency_hz"), spectrum.table.numbers("amplitude"))
    else {
        return;
    };
    let last = frequency.last().copied().unwrap_or(1.0);
    let end = forcing.map_or(last, |forcing| last.min((MULTIPLES + 0.5) * forcing));
    let peak = amplitude.iter().fold(0.0, |peak: f64, value| peak.max(value * scale));
    let top = if peak > 0.0 { peak.log10() + 0.3 } else { 0.0 };
    let [across, up] = [Axis::Across(View::Spectrum), Axis::Up(View::Spectrum)];
    let (begin, end) = memory.axes.ends(across, (0.0, end));
    let (floor, top) = memory.axes.ends(up, (top - DECADES, top));
    let height = |value: f64| (value * scale).log10().max(floor);
    let lines: Vec<[f64; 2]> = frequency
        .iter()
        .zip(amplitude)
        .filter(|line| (begin..=end).contains(line.0))
        .map(|(frequency, amplitude)| [*frequency, height(*amplitude)])
        .collect();
    let is_lines = spectrum.period.is_some();
    let mut entries = vec![(
        Symbol::Line(style.motion_stroke()),
        if is_lines { "lines of a motion that repeats" } else { "amplitude" },
    )];
    if forcing.is_some() {
        entries.push((Symbol::Line(style.base_stroke()), "forcing frequency"));
    }
    let rows = f64::from((area.height() / 40.0).clamp(2.0, 7.0));
    let columns = f64::from((area.width() / 80.0).clamp(2.0, 10.0));
    let plot = Rect::from_min_max(area.min + vec2(MARGIN, LEGEND), area.max - vec2(MARGIN, 0.0));
    let mut child = plot_place(ui, style, plot);
    if !current {
        child.set_opacity(0.4);
    }
    let shown = still_plot("spectrum")
        .x_grid_spacer(|_| marks(begin, end - 0.02 * (end - begin), columns))
        .y_grid_spacer(|_| decades(floor, top, rows))
        .x_axis_label("frequency (Hz)")
        .y_axis_label(format!("amplitude ({unit})"))
        .y_axis_formatter(|mark, _| power(mark.value))
        .show(&mut child, |plot| {
            plot.set_plot_bounds(PlotBounds::from_min_max([begin, floor], [end, top]));
            for mark in decades(floor, top, rows) {
                plot.hline(HLine::new("", mark.value).stroke(style.grid_stroke()));
            }
            if let Some(forcing) = forcing {
                plot.vline(VLine::new("forcing", forcing).stroke(style.base_stroke()));
            }
            if is_lines {
                let seen = || lines.iter().filter(|line| line[1] > floor);
                for [frequency, height] in seen() {
                    let ends = vec![[*frequency, floor], [*frequency, *height]];
                    plot.line(Line::new("line", ends).stroke(style.motion_stroke()));
                }
                let tips: Vec<[f64; 2]> = seen().copied().collect();
                plot.points(Points::new("tips", tips).radius(style.dot(2.5)).color(style.motion()));
            } else {
                let line = Line::new("amplitude", PlotPoints::from(largest(&lines)));
                plot.line(line.stroke(style.motion_stroke()));
            }
        });
    let spoken = format!("spectrum of {}", name.to_lowercase());
    shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, spoken.clone()));
    legend(ui, style, area, area.right(), &entries);
    axes_input(ui, memory, View::Spectrum, &shown.response, (area, *shown.transform.frame()));
}

/// Thins a line to at most [`MAX_POINTS`] without losing a peak: keeps the largest point of each interval.
fn largest(lines: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let stride = lines.len().div_ceil(MAX_POINTS).max(1);
    lines
        .chunks(stride)
        .filter_map(|part| part.iter().copied().max_by(|a, b| a[1].total_cmp(&b[1])))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_peak_is_thinned_away() {
        let lines: Vec<[f64; 2]> =
            (0..9999).map(|i| [f64::from(i), if i == 7777 { 1.0 } else { 0.0 }]).collect();
        let thinned = largest(&lines);
        assert!(thinned.len() <= MAX_POINTS && thinned.contains(&[7777.0, 1.0]));
    }
}
