//! Distance of the pinned motions from the present one over time, by decades.

use eframe::egui::{self, Align2, RichText, Ui, UiBuilder, vec2};
use egui_plot::{HLine, Line, PlotBounds, PlotPoint, Text, VLine};

use crate::app::session::pins::{Pin, PinKind};
use crate::app::words::numbers::three;
use crate::study::distances;

use super::cursors::{cursors_ui, readout_ui};
use super::ghosts::PINNED;
use super::hand::hand;
use super::labels::haloed;
use super::legend::LEGEND;
use super::plot::{LOW, MARGIN, decades, marks, plot_place, power, still_plot};
use super::view::Axis;
use super::{View, ViewContext, too_small_ui};

const MOST_POINTS: usize = 2000;

/// Decades of a mm below which nothing is told apart.
const LEAST: f64 = -14.0;

/// Forcing periods, or characteristic times, that are shown at least, and where in the picture the present
/// is.
const PERIODS: f64 = 6.0;
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
            (pin.place(), distances(session.player.watch(), pin.watch(), span, MOST_POINTS))
        })
        .collect();
    let seen = || lines.iter().flat_map(|own| &own.1).map(|own| (own.1 * 1e3).log10());
    let finite = || seen().filter(|own| own.is_finite());
    // motions that are equal to the last digit lie at the bottom, whatever stands there
    let bottom = if finite().next().is_some() { 0.0 } else { LEAST };
    let least = finite().fold(bottom, f64::min).floor().max(LEAST);
    let most = finite().fold(least + 1.0, f64::max).ceil().max(1.0);
    let height = |metres: f64| (metres * 1e3).log10().max(least);
    let model = session.shown();
    let own = PERIODS * model.forcing_period().unwrap_or(model.characteristic_time());
    let to = from + ((now - from) / PRESENT).max(own);
    let [across, up] = [Axis::Across(View::Distance), Axis::Up(View::Distance)];
    let (from, to) = context.memory.axes.ends(across, (from, to));
    let (least, most) = context.memory.axes.ends(up, (least, most));
    let stroke = style.motion_stroke();
    let rows = f64::from((area.height() / 40.0).clamp(2.0, 7.0));
    let columns = f64::from((area.width() / 80.0).clamp(2.0, 10.0));
    let apart = |pin: &Pin, t: f64| (session.player.watch().state_at(t).x - pin.state_at(t).x).abs();
    let of_all = |word: &dyn Fn(&Pin) -> String| {
        pins.iter().map(|pin| format!("{} {}", pin.letter(), word(pin))).collect::<Vec<_>>().join(", ")
    };
    let at_each = |t: f64| of_all(&|pin| millimetres(apart(pin, t)));
    let between = |a: f64, b: f64| {
        let rate = |pin: &Pin| (apart(pin, b) / apart(pin, a)).ln() / (b - a);
        let said = |rate: f64| if rate.is_finite() { format!("{} /s", three(rate)) } else { "-".to_owned() };
        format!("exponential rate {}", of_all(&|pin| said(rate(pin))))
    };
    let readout = readout_ui(ui, context, (area, to - from), at_each, between);
    let is_low = area.height() < LOW;
    let (time_label, label) = if is_low { ("", "mm") } else { ("time (s)", "distance (mm)") };
    let plot = area.with_min_y(area.top() + LEGEND + readout).shrink2(vec2(MARGIN, 0.0));
    let mut child = plot_place(ui, &style, plot);
    let shown = still_plot("distance")
        .x_grid_spacer(|_| marks(from, to - 0.05 * (to - from), columns))
        .y_grid_spacer(|_| decades(least, most, rows))
        .x_axis_label(time_label)
        .y_axis_label(label)
        .y_axis_formatter(|mark, _| power(mark.value))
        .show(&mut child, |plot| {
            plot.set_plot_bounds(PlotBounds::from_min_max([from, least], [to, most]));
            for mark in decades(least, most, rows) {
                plot.hline(HLine::new("", mark.value).stroke(style.grid_stroke()));
            }
            plot.vline(VLine::new("now", now).stroke(style.ghost_stroke()));
            for (place, path) in &lines {
                let points: Vec<[f64; 2]> = path.iter().map(|(t, own)| [*t, height(*own)]).collect();
                let end = points.last().map(|own| PlotPoint::new(own[0], own[1]));
                // without dashes, of which so steep a line has thousands; its letter stands at its end
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
    let said: Vec<String> = lines
        .iter()
        .filter_map(|(place, path)| Some((PINNED[place % PINNED.len()], path.last()?.1)))
        .map(|(letter, metres)| match metres {
            0.0 => format!("{letter}: equal to the last digit"),
            metres => format!("{letter}: {}", millimetres(metres)),
        })
        .collect();
    let at = (area.right_top() + vec2(-6.0, 0.5 * LEGEND), Align2::RIGHT_CENTER);
    let painter = ui.painter().with_clip_rect(area);
    haloed(&painter, &style, at, &said.join("   "), (style.small(), style.ink()));
    let frame = *shown.transform.frame();
    hand(&child, context.memory, View::Distance, &shown.response, (area, frame));
    cursors_ui(&mut child, context, &shown.response, (frame, (from, to)), "distance");
}

/// A distance in m in words: short ones as powers of ten.
fn millimetres(metres: f64) -> String {
    let mm = 1e3 * metres;
    if mm >= 0.01 { format!("{} mm", three(mm)) } else { format!("{mm:.1e} mm") }
}

/// What stands there while nothing is pinned.
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
