//! View of the phase portrait: velocity over displacement.
//!
//! The separatrix consists of the states whose energy equals the potential at the top of the barrier: without
//! shaking and dissipation, a state inside one of its loops never leaves that well. Shaking and impacts carry
//! the state across it.

use std::collections::VecDeque;

use eframe::egui::{self, Color32, Painter, Pos2, Sense, Shape, Stroke, Ui};

use crate::app::ui::widgets::kind_shapes;
use crate::app::words::numbers::three;
use crate::app::words::status::Kind;
use crate::dynamics::{Model, Phase, Sample};
use crate::output::separatrix as separatrix_of;
use crate::study::between;

use super::chart::Chart;
use super::ghosts::{dashed, ghosts};
use super::hand::axes_input;
use super::labels::pointer_rests;
use super::legend::{LEGEND, Symbol};
use super::stops::stops_ui;
use super::view::Axis;
use super::{View, ViewContext, too_small_ui};

/// Length of the trail in forcing periods.
const TRAIL_PERIODS: f64 = 4.0;
/// Length of the trail in natural times of the mechanism, if the shaking has no period.
const TRAIL_SWINGS: f64 = 12.0;

/// Largest number of points of the trail.
const MAX_POINTS: usize = 4000;
/// Number of steps in which the trail fades.
const FADES: usize = 16;

/// Deviation in points from a straight line below which a path between two samples is drawn straight.
const FLAT: f32 = 0.4;
/// Largest number of pieces between two samples.
const MAX_PIECES: f32 = 12.0;
/// Largest number of pieces of a path.
const MAX_TOTAL_PIECES: usize = 6000;

/// Opacity of the oldest part of the trail.
const FAINTEST: f32 = 0.12;

const MAX_STROBES: f64 = 300.0;

/// Radius in points of the mark of the present state.
const STATE: f32 = 6.0;
/// Radius in points of the mark of a stroboscopic state.
const STROBE: f32 = 3.0;

pub fn phase_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    states_ui(ui, context, false);
}

/// Draws the stroboscopic states without the path: the section of the live motion.
pub fn section_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    if context.session.shown().forcing_period().is_none() {
        let text = "A section has a point once a forcing period, and the shaking of this scene has none.";
        ui.label(egui::RichText::new(text).color(context.style.faint()));
        return;
    }
    states_ui(ui, context, true);
}

fn states_ui(ui: &mut Ui, context: &mut ViewContext<'_>, is_section: bool) {
    let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::click() | Sense::DRAG);
    if area.width() < 60.0 || area.height() < 80.0 {
        return too_small_ui(ui, &context.style, area);
    }
    let style = context.style;
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "states of the mass"));
    let speed = context.memory.ranges.follow(context.session).speed();
    let view = if is_section { View::Section } else { View::PhasePortrait };
    let (low, high) = context.memory.axes.ends(Axis::Up(view), (-speed, speed));
    let shared = context.span;
    context.span = context.memory.reach(context.session, Some(Axis::Reach));
    let chart = Chart::new(area, context.span, low, high);
    let pointer = response.hover_pos().filter(|at| chart.rect.contains(*at));
    chart.axes(ui, context, ("velocity (mm/s)", 1e-3), pointer.is_some());
    let painter = ui.painter().with_clip_rect(chart.rect);
    let mut legend = Vec::new();
    if separatrix(&painter, context, &chart) {
        legend.push((Symbol::Dashed(style.ghost_stroke()), "separatrix"));
    }
    chart.equilibria(&painter, &style, &context.session.shown().mechanism().landscape);
    let edges = (chart.rect.top(), chart.rect.bottom());
    stops_ui(ui, context, chart.rect, edges, 0.0);
    let painter = ui.painter().with_clip_rect(chart.rect.expand(STATE));
    let is_periodic = context.session.shown().forcing_period().is_some();
    let points_only = is_section || context.memory.points_only && is_periodic;
    if !points_only {
        ghost_trails(&painter, context, &chart);
        trail(&painter, context, &chart);
    }
    if is_periodic {
        legend.push((Symbol::Ring(style.base_stroke()), "once a period"));
    }
    if context.session.shown().stop_positions() != (None, None) && !points_only {
        legend.push((Symbol::Dashed(style.impact_stroke()), "impact"));
    }
    strobes(&painter, context, &chart);
    for ghost in ghosts(context) {
        ghost.stops(&painter, context, chart.rect, 0.0);
        let at = chart.screen_from_world(ghost.state.x, ghost.state.v);
        ghost.ball(&painter, &style, at, STATE);
    }
    let state = context.session.player.state();
    let at = chart.screen_from_world(state.x, state.v);
    if state.phase == Phase::Free {
        painter.circle(at, STATE, style.mass(), Stroke::new(1.5, style.mass_edge()));
    } else {
        painter.extend(kind_shapes(Kind::Resting, at, STATE + 2.5, style.mass_edge()));
        painter.extend(kind_shapes(Kind::Resting, at, STATE, style.mass()));
    }
    let right = match is_periodic && !is_section {
        true => points_ui(ui, area, &mut context.memory.points_only),
        false => area.right(),
    };
    chart.legend(ui, &style, right, &legend);
    axes_input(ui, context.memory, view, &response, (area, chart.rect));
    start_ui(ui, &response, context, &chart, pointer);
    context.span = shared;
}

/// Button in the row of the legend that hides the path. Returns its left edge.
fn points_ui(ui: &mut Ui, area: egui::Rect, points_only: &mut bool) -> f32 {
    let row = area.with_max_y(area.top() + LEGEND).with_max_x(area.right() - 4.0);
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    let builder = egui::UiBuilder::new().max_rect(row).layout(layout);
    ui.scope_builder(builder, |ui| {
        ui.spacing_mut().interact_size.y = LEGEND - 4.0;
        ui.spacing_mut().button_padding.y = 0.0;
        let text = egui::RichText::new("points only").small();
        let hover = "One point a forcing period, always at the same phase, and no path: motion that repeats \
                     is a few points, chaos is many.";
        let response = ui.selectable_label(*points_only, text).on_hover_text(hover);
        if response.clicked() {
            *points_only = !*points_only;
        }
        response.rect.left() - 6.0
    })
    .inner
}

/// Shows the state under the pointer; a click lets the motion go on from there.
fn start_ui(
    ui: &Ui,
    response: &egui::Response,
    context: &mut ViewContext<'_>,
    chart: &Chart,
    pointer: Option<Pos2>,
) {
    let Some(pointer) = pointer else { return };
    let (x, v) = chart.world_from_screen(pointer);
    let inside = within(context, x);
    if response.clicked() {
        context.session.player.place(x, if inside { v } else { 0.0 });
        context.session.moved_by_hand();
    }
    chart.readout(ui, &context.style, &format!("{} mm, {} mm/s", three(x * 1e3), three(v * 1e3)));
    if pointer_rests(ui) {
        response.clone().on_hover_text_at_pointer("Click: the motion goes on from here.");
    }
}

/// Whether the mass can be at `x` in m.
fn within(context: &ViewContext<'_>, x: f64) -> bool {
    let model = context.session.shown();
    let ((left, right), domain) = (model.stop_positions(), model.mechanism().curve.domain());
    x >= left.unwrap_or(domain.0).max(domain.0) && x <= right.unwrap_or(domain.1).min(domain.1)
}

/// Draws the states with the energy of the top of the barrier. Returns whether there is a barrier.
fn separatrix(painter: &Painter, context: &ViewContext<'_>, chart: &Chart) -> bool {
    let model = context.session.shown();
    let stroke = context.style.ghost_stroke();
    let branches = separatrix_of(model.mechanism(), model.mass(), (context.span.low, context.span.high));
    for path in &branches {
        let points: Vec<Pos2> = path.iter().map(|(x, v)| chart.screen_from_world(*x, *v)).collect();
        painter.extend(Shape::dashed_line(&points, stroke, 5.0, 4.0));
    }
    !branches.is_empty()
}

/// Draws the recent path, fading with age. An impact is a dashed jump; moving the mass by hand leaves a gap.
fn trail(painter: &Painter, context: &ViewContext<'_>, chart: &Chart) {
    let (session, style) = (&context.session, context.style);
    let model = session.shown();
    let length =
        model.forcing_period().map_or(TRAIL_SWINGS * model.natural_time(), |period| TRAIL_PERIODS * period);
    let state = session.player.state();
    let watch = session.player.watch();
    let path = recent(watch.samples(), state, length);
    let mut pieces_left = MAX_TOTAL_PIECES;
    let level = |t: f64| {
        let age = ((state.t - t) / length).clamp(0.0, 1.0);
        ((age * FADES as f64) as usize).min(FADES - 1)
    };
    let shade = |color: Color32, level: usize| {
        let age = level as f32 / (FADES - 1) as f32;
        color.gamma_multiply(1.0 - (1.0 - FAINTEST) * age)
    };
    let (motion, impact) = (style.motion_stroke(), style.impact_stroke());
    let mut line: Vec<Pos2> = Vec::new();
    let mut drawn = FADES;
    let finish = |line: &mut Vec<Pos2>, level: usize| {
        if line.len() > 1 {
            let stroke = Stroke::new(motion.width, shade(motion.color, level));
            painter.add(Shape::line(std::mem::take(line), stroke));
        }
        line.clear();
    };
    for pair in path.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let (from, to) = (chart.screen_from_world(a.x, a.v), chart.screen_from_world(b.x, b.v));
        let now = level(b.t);
        if a.t == b.t {
            finish(&mut line, drawn.min(FADES - 1));
            if a.x == b.x && a.v != b.v {
                let stroke = Stroke::new(1.5 * impact.width, shade(impact.color, now));
                painter.extend(Shape::dashed_line(&[from, to], stroke, 4.0, 3.0));
            }
            continue;
        }
        if now != drawn || line.is_empty() {
            finish(&mut line, drawn.min(FADES - 1));
            line.push(from);
            drawn = now;
        }
        let count = pieces(chart, watch.model_at(a.t), (&a, &b)).min(pieces_left);
        pieces_left -= count;
        let between = between(watch.model_at(a.t), &a, &b, count);
        line.extend(between.iter().map(|(x, v)| chart.screen_from_world(*x, *v)));
        line.push(to);
    }
    finish(&mut line, drawn.min(FADES - 1));
}

/// Draws the last period of the paths of the pinned motions, dashed; longer paths could not be told apart.
fn ghost_trails(painter: &Painter, context: &ViewContext<'_>, chart: &Chart) {
    let session = &context.session;
    let model = session.shown();
    let length = model.forcing_period().unwrap_or(TRAIL_SWINGS / TRAIL_PERIODS * model.natural_time());
    let now = session.player.time();
    let stroke = context.style.ghost_motion_stroke();
    for pin in session.pins.all() {
        let watch = pin.watch();
        let path = recent(watch.samples(), pin.state_at(now), length.min(now - pin.since()));
        let mut pieces_left = MAX_TOTAL_PIECES;
        let mut points: Vec<Pos2> = Vec::with_capacity(2 * path.len());
        for pair in path.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let count = if a.t == b.t { 1 } else { pieces(chart, watch.model_at(a.t), (&a, &b)) };
            let count = count.min(pieces_left);
            pieces_left -= count;
            let between = between(watch.model_at(a.t), &a, &b, count);
            points.push(chart.screen_from_world(a.x, a.v));
            points.extend(between.iter().map(|(x, v)| chart.screen_from_world(*x, *v)));
        }
        points.extend(path.last().map(|last| chart.screen_from_world(last.x, last.v)));
        painter.extend(dashed(&points, pin.place(), stroke));
    }
}

/// Number of pieces that make the path between two samples look smooth, from how far the control points of
/// its cubic are off the chord.
fn pieces(chart: &Chart, model: &Model, (a, b): (&Sample, &Sample)) -> usize {
    let third = (b.t - a.t) / 3.0;
    let control = |sample: &Sample, third: f64| {
        let acceleration = model.acceleration(sample.x, sample.v, sample.base_accel);
        chart.screen_from_world(sample.x + third * sample.v, sample.v + third * acceleration)
    };
    let (from, to) = (chart.screen_from_world(a.x, a.v), chart.screen_from_world(b.x, b.v));
    let along = (to - from).normalized();
    let distance = |at: Pos2| {
        let aside = at - from;
        (aside - along * aside.dot(along)).length()
    };
    let deviation = distance(control(a, third)).max(distance(control(b, -third)));
    if a.phase != Phase::Free || !(deviation > FLAT) {
        1
    } else {
        (2.0 * deviation).sqrt().ceil().min(MAX_PIECES) as usize
    }
}

/// The samples of the last `length` seconds before `state`, followed by `state`.
fn recent(samples: &VecDeque<Sample>, state: Sample, length: f64) -> Vec<Sample> {
    let last = samples.partition_point(|sample| sample.t <= state.t);
    let first = samples.partition_point(|sample| sample.t < state.t - length);
    let first = first.max(last.saturating_sub(MAX_POINTS)).min(last);
    samples.range(first..last).copied().chain([state]).collect()
}

/// Draws the stroboscopic states since the last change.
fn strobes(painter: &Painter, context: &ViewContext<'_>, chart: &Chart) {
    let session = &context.session;
    let Some(period) = session.shown().forcing_period() else { return };
    let (watch, now) = (session.player.watch(), session.player.time());
    // since the last change of the model, and since the mass was last moved by hand
    let placed = if session.player.is_past() { 0.0 } else { session.changed_at() };
    let begin = watch.model_since(now).max(placed).max(watch.begin());
    let last = (now / period).floor();
    let first = (begin / period).ceil().max(last - MAX_STROBES);
    let count = (last - first + 1.0).clamp(0.0, MAX_STROBES) as u32;
    let stroke = context.style.base_stroke();
    for i in 0..count {
        let state = watch.state_at((first + f64::from(i)) * period);
        let at = chart.screen_from_world(state.x, state.v);
        painter.circle(at, context.style.dot(STROBE), context.style.ground(), stroke);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_trail_is_capped_and_ends_at_the_state() {
        let sample =
            |t: f64| Sample { t, x: t, v: 0.0, base_accel: 0.0, phase: Phase::Free, electrical: 0.0 };
        let samples: VecDeque<Sample> = (0..20_000).map(|i| sample(f64::from(i) * 1e-3)).collect();
        let path = recent(&samples, sample(10.0005), 2.0);
        assert!(path.len() == 2001 && path.last().is_some_and(|last| last.t == 10.0005));
        assert_eq!(recent(&samples, sample(19.0), 1e9).len(), MAX_POINTS + 1);
        assert_eq!(recent(&VecDeque::new(), sample(0.0), 1.0).len(), 1);
    }
}
