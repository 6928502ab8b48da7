//! View of the distance between the pinned motions and the present one over time, on a logarithmic scale.

use eframe::egui::{self, Align2, RichText, Ui, UiBuilder, pos2, vec2};
use egui_plot::{HLine, Line, PlotBounds, PlotPoint, Text, VLine};

use crate::app::session::pins::{Pin, PinKind};
use crate::app::words::numbers::three;
use crate::output::PlotAxis;
use crate::study::distances;

use super::cursors::{cursors_ui, readout_ui};
use super::ghosts::PINNED;
use super::hand::axes_input;
use super::labels::haloed;
use super::legend::LEGEND;
use super::plot::{LOW, MARGIN, even, marks, plot_place, still_plot};
use super::view::Axis;
use super::{LegendRow, View, ViewContext, too_small_ui};

const MAX_POINTS: usize = 2000;

/// Decimal logarithm of the smallest distance shown, in mm; below it lies rounding error.
const MIN_LOG: f64 = -14.0;

/// Smallest number of forcing periods, or characteristic times, shown.
const PERIODS: f64 = 6.0;
/// Position of the present in the picture, as a share of its width.
const PRESENT: f64 = 0.94;

pub fn distance_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, style) = (ui.max_rect(), context.style);
    if area.width() < 160.0 || area.height() < 100.0 {
        return too_small_ui(ui, &style, area);
    }
    ui.painter().rect_filled(area, 0.0, style.ground());
    if context.session.pins.all().is_empty() {
        return nothing_ui(ui, context, area);
    }
    let (session, now) = (&context.session, context.session.player.time());
    let pins = session.pins.all();
    let from = pins.iter().map(|pin| pin.since()).fold(now, f64::min);
    let lines: Vec<(usize, Vec<(f64, f64)>)> = pins
        .iter()
        .map(|pin| {
            let span = (pin.since(), now);
            (pin.place(), distances(session.player.watch(), pin.watch(), span, MAX_POINTS))
        })
        .collect();
    let seen = || lines.iter().flat_map(|line| &line.1).map(|point| (point.1 * 1e3).log10());
    let finite = || seen().filter(|log| log.is_finite());
    // if all motions are equal to the last digit, the axis starts at its lowest end
    let bottom = if finite().next().is_some() { 0.0 } else { MIN_LOG };
    let low = finite().fold(bottom, f64::min).floor().max(MIN_LOG);
    let high = finite().fold(low + 1.0, f64::max).ceil().max(1.0);
    let height = |metres: f64| (metres * 1e3).log10().max(low);
    let model = session.shown();
    let shortest = PERIODS * model.forcing_period().unwrap_or(model.characteristic_time());
    let to = from + ((now - from) / PRESENT).max(shortest);
    let [across, up] = [Axis::Across(View::Distance), Axis::Up(View::Distance)];
    let (from, to) = context.memory.axes.ends(across, (from, to));
    let (low, high) = context.memory.axes.ends(up, (low, high));
    let stroke = style.motion_stroke();
    let rows = f64::from((area.height() / 40.0).clamp(2.0, 7.0));
    let columns = f64::from((area.width() / 80.0).clamp(2.0, 10.0));
    let distance = |pin: &Pin, t: f64| (session.player.watch().state_at(t).x - pin.state_at(t).x).abs();
    let of_all = |word: &dyn Fn(&Pin) -> String| {
        pins.iter().map(|pin| format!("{} {}", pin.letter(), word(pin))).collect::<Vec<_>>().join(", ")
    };
    let at_each = |t: f64| of_all(&|pin| millimetres(distance(pin, t)));
    let between = |a: f64, b: f64| {
        let rate = |pin: &Pin| (distance(pin, b) / distance(pin, a)).ln() / (b - a);
        let text = |rate: f64| if rate.is_finite() { format!("{} /s", three(rate)) } else { "-".to_owned() };
        format!("exponential rate {}", of_all(&|pin| text(rate(pin))))
    };
    let readout = readout_ui(ui, context, (area, to - from), at_each, between);
    let is_low = area.height() < LOW;
    let decades = PlotAxis::powers(low, high, "").with_ticks(rows as usize);
    let (time_label, label) = if is_low { ("", "mm") } else { ("time (s)", "distance (mm)") };
    let plot = area.with_min_y(area.top() + LEGEND + readout).shrink2(vec2(MARGIN, 0.0));
    let mut child = plot_place(ui, &style, plot);
    let shown = still_plot("distance")
        .x_grid_spacer(|_| marks(&even(from, to - 0.05 * (to - from), columns)))
        .y_grid_spacer(|_| marks(&decades))
        .x_axis_label(time_label)
        .y_axis_label(label)
        .y_axis_formatter(|mark, _| {
            let tick = decades.ticks.iter().find(|tick| tick.0 == mark.value);
            tick.map(|tick| tick.1.clone()).unwrap_or_default()
        })
        .show(&mut child, |plot| {
            plot.set_plot_bounds(PlotBounds::from_min_max([from, low], [to, high]));
            for (value, _) in &decades.ticks {
                plot.hline(HLine::new("", *value).stroke(style.grid_stroke()));
            }
            plot.vline(VLine::new("now", now).stroke(style.ghost_stroke()));
            for (place, path) in &lines {
                let points: Vec<[f64; 2]> = path.iter().map(|(t, metres)| [*t, height(*metres)]).collect();
                let end = points.last().map(|last| PlotPoint::new(last[0], last[1]));
                // solid, since so steep a line has thousands of dashes; the letter at its end names it
                plot.line(Line::new("distance", points).stroke(stroke).allow_band(false));
                if let Some(end) = end {
                    let letter = RichText::new(PINNED[place % PINNED.len()]).font(style.body());
                    plot.text(
                        Text::new("letter", end, letter).color(style.ink()).anchor(Align2::LEFT_CENTER),
                    );
                }
            }
        });
    let spoken = "distance of the pinned motions";
    shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, spoken));
    let texts: Vec<String> = lines
        .iter()
        .filter_map(|(place, path)| Some((PINNED[place % PINNED.len()], path.last()?.1)))
        .map(|(letter, metres)| match metres {
            0.0 => format!("{letter}: equal to the last digit"),
            metres => format!("{letter}: {}", millimetres(metres)),
        })
        .collect();
    let end = LegendRow::of(ui, area).right - 6.0;
    let at = (pos2(end, area.top() + 0.5 * LEGEND), Align2::RIGHT_CENTER);
    let painter = ui.painter().with_clip_rect(area);
    haloed(&painter, &style, at, &texts.join("   "), (style.small(), style.ink()));
    let frame = *shown.transform.frame();
    axes_input(&child, context.memory, View::Distance, &shown.response, (area, frame));
    cursors_ui(&mut child, context, &shown.response, (frame, (from, to)), "distance");
}

/// A distance in m as text in mm; a small one in scientific notation.
fn millimetres(metres: f64) -> String {
    let mm = 1e3 * metres;
    if mm >= 0.01 { format!("{} mm", three(mm)) } else { format!("{mm:.1e} mm") }
}

/// Placeholder while nothing is pinned.
fn nothing_ui(ui: &mut Ui, context: &mut ViewContext<'_>, area: egui::Rect) {
    let faint = context.style.faint();
    ui.scope_builder(UiBuilder::new().max_rect(area.shrink(10.0)), |ui| {
        let text = "Nothing is pinned. A twin begins a micrometre beside the mass, from the start.";
        ui.label(RichText::new(text).color(faint));
        if ui.button("Twin start").clicked() {
            context.memory.pin = Some(PinKind::Twin);
        }
    });
}
