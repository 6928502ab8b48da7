//! Displacement over time: it scrolls, rests are shaded, impacts are ticks, stops are lines.

use eframe::egui::{self, Ui, vec2};
use egui_plot::{GridMark, HLine, Line, LineStyle, Plot, PlotBounds, PlotPoint, PlotPoints, Span, VLine};

use crate::dynamics::{EventKind, Phase, Sample};

use super::ViewContext;
use super::span::ticks;

/// Forcing periods that are shown; without a period swings of the scene's own time scale.
const PERIODS: f64 = 6.0;
const SWINGS: f64 = 20.0;

/// Where in the window the present is.
const PRESENT: f64 = 0.94;

/// Draws it. Whether something changed.
pub fn displacement_ui(ui: &mut Ui, context: &mut ViewContext<'_>) -> bool {
    let style = context.style;
    let (now, model) = (context.session.player.time(), context.session.model());
    let natural = std::f64::consts::TAU * model.scales.time;
    let own = model.forcing_period.map_or(SWINGS * natural, |period| (PERIODS * period).min(200.0 * natural));
    let window = context.memory.time_window.unwrap_or(own);
    let from = (now - PRESENT * window).max(-0.02 * window);
    let to = from + window;
    let watch = context.session.player.watch();
    let shown = watch.samples();
    let first = shown.partition_point(|sample| sample.t < from).saturating_sub(1);
    let last = shown.partition_point(|sample| sample.t <= now);
    let state = context.session.player.state();
    let samples: Vec<Sample> = shown.range(first..last.max(first)).copied().chain([state]).collect();
    let points: Vec<PlotPoint> =
        samples.iter().map(|sample| PlotPoint::new(sample.t, sample.x * 1e3)).collect();
    let rests = rests(&samples);
    let impacts: Vec<f64> = watch
        .events()
        .iter()
        .skip(watch.events().partition_point(|event| event.t < from))
        .take_while(|event| event.t <= now)
        .filter(|event| event.kind == EventKind::Impact)
        .map(|event| event.t)
        .collect();
    let (left, right) = model.stop_positions();
    let (low, high) = (context.span.low * 1e3, context.span.high * 1e3);
    let tick = 0.035 * (high - low);
    ui.painter().rect_filled(ui.max_rect(), 0.0, style.ground());
    let response = Plot::new("displacement")
        .allow_drag(false)
        .allow_scroll(false)
        .allow_zoom(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .allow_double_click_reset(false)
        .show_background(false)
        .show_grid(false)
        .x_grid_spacer(|_| marks(from.max(0.0), to, 5.0))
        .y_grid_spacer(|_| marks(low, high, 6.0))
        .x_axis_label("time (s)")
        .y_axis_label("displacement (mm)")
        .set_margin_fraction(vec2(0.0, 0.0))
        .x_axis_formatter(|mark, _| plain(mark))
        .y_axis_formatter(|mark, _| plain(mark))
        .label_formatter(|_| None)
        .show_crosshair(false)
        .show(ui, |plot| {
            plot.set_plot_bounds(PlotBounds::from_min_max([from, low], [to, high]));
            for mark in marks(low, high, 6.0) {
                plot.hline(HLine::new("", mark.value).stroke(style.grid_stroke()));
            }
            for (begin, end) in rests {
                let span = Span::new("", begin..=end).fill(style.rest_shade());
                plot.span(span.border(egui::Stroke::NONE));
            }
            for stop in [left, right].into_iter().flatten() {
                plot.hline(
                    HLine::new("stop", stop * 1e3)
                        .stroke(style.stop_stroke())
                        .style(LineStyle::dashed_loose()),
                );
            }
            plot.vline(VLine::new("now", now).stroke(style.ghost_stroke()));
            // a tick stands at the edge, out of the way of the motion
            for t in thinned(&impacts, window) {
                let ends = vec![[t, low], [t, low + tick]];
                plot.line(Line::new("impact", ends).stroke(egui::Stroke::new(1.5, style.impact())));
            }
            plot.line(Line::new("x", PlotPoints::Owned(points)).stroke(style.motion_stroke()));
        });
    response
        .response
        .on_hover_text("Displacement of the mass from the middle. Grey: at rest on a stop. Ticks: impacts.");
    false
}

/// Round numbers for an axis, some `count` of them.
fn marks(low: f64, high: f64, count: f64) -> Vec<GridMark> {
    let (values, _) = ticks(low, high, count);
    let step_size = values.windows(2).next().map_or(1.0, |pair| (pair[1] - pair[0]) * 1e3);
    values.iter().map(|value| GridMark { value: value * 1e3, step_size }).collect()
}

/// A tick's number, with the decimals that tell it from the next one.
fn plain(mark: GridMark) -> String {
    let decimals = (-mark.step_size.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{:.decimals$}", mark.value + 0.0)
}

/// From when to when the mass rests.
fn rests(samples: &[Sample]) -> Vec<(f64, f64)> {
    let mut spans: Vec<(f64, f64)> = Vec::new();
    for pair in samples.windows(2) {
        if pair[0].phase == Phase::Free {
            continue;
        }
        match spans.last_mut() {
            Some(last) if last.1 == pair[0].t => last.1 = pair[1].t,
            _ => spans.push((pair[0].t, pair[1].t)),
        }
    }
    spans
}

/// Impacts that are told apart on the screen.
fn thinned(times: &[f64], window: f64) -> Vec<f64> {
    let mut kept: Vec<f64> = Vec::new();
    for t in times {
        if kept.last().is_none_or(|last| t - last > window / 1000.0) {
            kept.push(*t);
        }
    }
    kept
}
