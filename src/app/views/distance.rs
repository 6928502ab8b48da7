//! View of the distance between the pinned motions and the present one over time, on a logarithmic scale.

use eframe::egui::{self, Align2, Sense, Ui, vec2};

use crate::app::session::pins::{Pin, PinKind};
use crate::app::ui::widgets::tell;
use crate::app::words::numbers::{UNKNOWN, three, three_from};
use crate::numeric::elementary;
use crate::output::{Chart, Marks, Role, distance_ends, distance_panel};
use interwell_studies::study::{Table, distances};

use super::cursors::{cursors_ui, readout_height, readout_ui};
use super::hand::axes_input;
use super::labels::haloed;
use super::pane::{Place, fresh_pane_ui};
use super::view::Axis;
use super::{View, ViewContext, offer_ui};

const MAX_POINTS: usize = 2000;

/// Smallest number of forcing periods, or characteristic times, shown.
const PERIODS: f64 = 6.0;
/// Position of the present in the picture, as a share of its width.
const PRESENT: f64 = 0.94;

pub fn distance_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, style) = (ui.max_rect(), context.style);
    if context.session.pins.all().is_empty() {
        let text = "Nothing is pinned. A twin begins a micrometre beside the mass, from the start.";
        if offer_ui(ui, &style, area, text, "Twin start") {
            context.memory.pin = Some(PinKind::Twin);
        }
        return;
    }
    let (session, now) = (&context.session, context.session.player.time());
    let pins = session.pins.all();
    let from = pins.iter().map(|pin| pin.since).fold(now, f64::min);
    let of_pin = |pin: &Pin| distances(session.player.watch(), &pin.watch, (pin.since, now), MAX_POINTS);
    let lines: Vec<Vec<(f64, f64)>> = pins.iter().map(of_pin).collect();
    let (low, high) = distance_ends(lines.iter().flatten().map(|point| point.1));
    let height = |metres: f64| elementary::log10(metres * 1e3).max(low);
    let model = session.shown();
    let shortest = PERIODS * model.forcing_period().unwrap_or(model.characteristic_time());
    let to = from + ((now - from) / PRESENT).max(shortest);
    let (from, to) = context.memory.axes.ends(Axis::Across(View::Distance), (from, to));
    let (low, high) = context.memory.axes.ends(Axis::Up(View::Distance), (low, high));
    let distance = |pin: &Pin, t: f64| (session.player.watch().state_at(t).x - pin.watch.state_at(t).x).abs();
    let of_all = |word: &dyn Fn(&Pin) -> String| {
        pins.iter().map(|pin| format!("{} {}", pin.letter, word(pin))).collect::<Vec<_>>().join(", ")
    };
    let at_each = |t: f64| of_all(&|pin| millimetres(distance(pin, t)));
    let between = |a: f64, b: f64| {
        let rate = |pin: &Pin| elementary::ln(distance(pin, b) / distance(pin, a)) / (b - a);
        let text =
            |rate: f64| if rate.is_finite() { format!("{} /s", three(rate)) } else { UNKNOWN.to_owned() };
        format!("exponential rate {}", of_all(&|pin| text(rate(pin))))
    };
    let readout = readout_height(ui, context);
    let mut panel = distance_panel(&lines, (from, to), (low, high));
    panel.draw(Role::Reference, Marks::Verticals(vec![now]));
    let place = Place::in_line(ui, area, Sense::click_and_drag(), (0.0, readout));
    let pane = fresh_pane_ui(ui, &style, place, Chart::stack(vec![panel], "", Table::new()));
    let Some(frame) = pane.frame(0) else { return };
    readout_ui(ui, context, (frame, to - from), at_each, between);
    let painter = ui.painter().with_clip_rect(area);
    for (pin, path) in pins.iter().zip(&lines) {
        let end = path.last().and_then(|(t, metres)| pane.place(0, (*t, height(*metres))));
        if let Some(at) = end.filter(|at| frame.expand(1.0).contains(*at)) {
            let at = (at + vec2(3.0, 0.0), Align2::LEFT_CENTER);
            haloed(&painter, &style, at, &pin.letter.to_string(), (style.body(), style.ink()));
        }
    }
    tell(&pane.response, egui::Role::Canvas, "distance of the pinned motions");
    let text = |(pin, path): (&Pin, &Vec<(f64, f64)>)| match path.last()?.1 {
        0.0 => Some(format!("{}: equal to the last digit", pin.letter)),
        metres => Some(format!("{}: {}", pin.letter, millimetres(metres))),
    };
    pane.reading(ui, &style, 0.0, &pins.iter().zip(&lines).filter_map(text).collect::<Vec<_>>().join("   "));
    axes_input(ui, context.memory, View::Distance, &pane.response, (area, frame));
    cursors_ui(ui, context, &pane.response, (frame, (from, to)), "distance");
}

/// A distance in m as text in mm; a small one in scientific notation.
fn millimetres(metres: f64) -> String {
    format!("{} mm", three_from(1e3 * metres, 0.01))
}
