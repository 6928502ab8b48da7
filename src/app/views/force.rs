//! View of the force curve, with the force of the shaking.
//!
//! The curve is dV/dx, the force that would hold the mass in place; the mechanism exerts the opposite force.
//! The push -m a_b of the base is a horizontal line that moves up and down. Both are positive to the right.
//! Where the line is above the curve, the mass is driven to the right, where it is below, to the left. A mass
//! on a stop is released when the line passes the curve at the stop.

use std::sync::Arc;

use eframe::egui::{Align2, Painter, Pos2, Rect, Sense, Stroke, Ui, pos2, vec2};

use crate::app::task::Identity;
use crate::app::words::numbers::three;
use crate::dynamics::{Model, STANDARD_GRAVITY};
use crate::output::{
    Chart, DISPLACEMENT, HOLDING_FORCE, Layer, Marks, PlotAxis, Role, axis_name, force_panel,
};
use interwell_studies::study::Table;

use super::ghosts::ghosts;
use super::hand::axes_input;
use super::labels::Taken;
use super::overlay::measured_force;
use super::pane::{Pane, Place, kept_pane_ui};
use super::ranges::{axis_end, room_for_push};
use super::stops::{sides, stops_ui, wall};
use super::view::Axis;
use super::{Span, View, ViewContext};

/// Factor by which the axis exceeds the largest force between the wells.
const ROOM: f64 = 1.3;

/// Length in points of the line at a stop.
const LINE: f32 = 40.0;

/// Number of points of the curve.
const POINTS: usize = 600;

/// Distance in points of a label from its stop.
const BESIDE: f32 = 16.0;
/// Heights in points of a label above the force at its stop, the first that is free.
const ABOVE: [f32; 9] = [2.0, -14.0, 16.0, -28.0, 30.0, -42.0, 44.0, -56.0, 58.0];

/// Number of these that are near the stop.
const NEAR: usize = 3;

/// Radius in points of the mass on the curve.
const BALL: f32 = 7.0;

pub fn force_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, style) = (ui.max_rect(), context.style);
    let end = end_of_axis(context);
    let ends = context.memory.frozen.force.keep((-end, end), context.session.editor.in_gesture());
    let (low, high) = context.memory.axes.ends(Axis::Up(View::ForceCurve), ends);
    let (span, model) = (context.span, Arc::clone(context.session.shown()));
    let measured = context.session.measured.over.clone();
    let key = (Identity(Arc::clone(&model)), measured, [span.low, span.high, low, high], style);
    let pane = kept_pane_ui(ui, &style, Place::in_line(ui, area, Sense::DRAG, (0.0, 0.0)), key, || {
        let across = PlotAxis::between(span.low * 1e3, span.high * 1e3, DISPLACEMENT);
        let up = PlotAxis::between(low, high, &axis_name(HOLDING_FORCE, "N"));
        still(&model, span, (across, up), measured_force(context.session))
    });
    let Some(frame) = pane.frame(0) else { return };
    axes_input(ui, context.memory, View::ForceCurve, &pane.response, (area, frame));
    stops_ui(ui, context, frame, (frame.top(), frame.bottom()), (0.0, false));
    let painter = ui.painter().with_clip_rect(frame);
    let curve = &model.mechanism().curve;
    let state = context.session.player.state();
    let push = -model.mass() * state.base_accel;
    let mm = state.x * 1e3;
    if model.is_shaken() {
        let apart = Marks::Path(vec![(mm, curve.force(state.x)), (mm, push)]);
        let push = Layer::new(Role::Push, "", Marks::Horizontals(vec![push]));
        pane.draw(&painter, &style, 0, &[push, Layer::new(Role::Apart, "", apart)]);
    }
    releases(&painter, context, &pane, frame);
    let at = |x: f64, force: f64| pane.place(0, (x * 1e3, force)).unwrap_or(frame.min);
    // a ball at an end of an axis is not cut
    let over = ui.painter().with_clip_rect(frame.expand(BALL + 1.0).intersect(area));
    for ghost in ghosts(context) {
        let curve = &ghost.model.mechanism().curve;
        ghost.stops(&painter, context, frame, 0.0);
        ghost.ball(&over, &style, at(ghost.state.x, curve.force(ghost.state.x)), BALL);
    }
    let mass = at(state.x, curve.force(state.x));
    over.circle(mass, BALL, style.mass(), Stroke::new(1.5, style.mass_edge()));
    if let Some((mm, _)) = pane.pointed() {
        let force = curve.force(mm * 1e-3);
        if force.is_finite() {
            let direction = if force < 0.0 { " to the left" } else { " to the right" };
            let text = format!("{} N{direction} holds it at {} mm", three(force.abs()), three(mm));
            pane.reading(ui, &style, 0.0, &text);
        }
    }
}

/// The parts that stay the same from frame to frame: axes, curve, kinks and equilibria, the measured force,
/// and the legend of the push. The view draws the stops, which can be dragged.
fn still(model: &Model, span: Span, axes: (PlotAxis, PlotAxis), measured: Option<Layer>) -> Chart {
    let curve = &model.mechanism().curve;
    let mm = |stop: Option<f64>| stop.map_or(f64::NAN, |x| x * 1e3);
    let (stops, domain) = (model.stop_positions(), curve.domain());
    let (low, high) = (span.low.max(domain.0), span.high.min(domain.1));
    let place = |i: usize| (low + (high - low) * i as f64 / POINTS as f64).min(high);
    let points = (0..=POINTS).map(place).map(|x| (x * 1e3, curve.force(x)));
    let points = if high > low { points.collect() } else { Vec::new() };
    let stops = (mm(stops.0), mm(stops.1));
    let mut panel = force_panel(model.mechanism(), axes, 1.0, stops, ("holds the mass there", points));
    panel.layers.retain(|layer| layer.role != Role::Stop);
    // the legend names the lines before the marks
    let named = |role, name: &str| Layer::new(role, name, Marks::Path(Vec::new()));
    let push = model.is_shaken().then(|| named(Role::Push, "push"));
    // with the push, if it is the same at both stops
    let presses: Vec<String> = presses(model).map(|(x, _)| push_that_frees(model, x)).collect();
    let release = presses.first().map(|first| match presses.iter().all(|press| press == first) {
        true => named(Role::Stop, &format!("frees the mass: {first}")),
        false => named(Role::Stop, "frees the mass"),
    });
    let lines = [named(Role::Curve, "holds the mass there")].into_iter().chain(push).chain(release);
    let first = lines.chain(measured);
    panel.layers.splice(0..0, first);
    Chart::stack(vec![panel], "", Table::new())
}

/// End of the axis in N: covers the forces between the wells and the largest push of the base.
fn end_of_axis(context: &ViewContext<'_>) -> f64 {
    let model = context.session.shown();
    let landscape = &model.mechanism().landscape;
    let wells = landscape.barrier.map(|barrier| (barrier.left_well, barrier.right_well));
    let between = |x: f64| wells.is_some_and(|(left, right)| x > left && x < right);
    let extrema = landscape.extrema.iter().filter(|extremum| between(extremum.x));
    let mut largest = extrema.map(|extremum| extremum.force.abs()).fold(0.0, f64::max);
    if wells.is_none() {
        // without two wells, the forces at the ends of the x axis count
        let curve = &model.mechanism().curve;
        let domain = curve.domain();
        for x in [context.span.low, context.span.high] {
            largest = largest.max(curve.force(x.clamp(domain.0, domain.1)).abs());
        }
    }
    let accel = model.largest_base_acceleration();
    let push = if model.is_shaken() { model.mass() * room_for_push(accel).min(1.1 * accel) } else { 0.0 };
    axis_end((ROOM * largest).max(1.1 * push))
}

fn lines(pane: &Pane) -> Vec<Vec<Pos2>> {
    let layers = pane.chart.panels().flat_map(|panel| &panel.layers);
    let on_screen = |layer: &Layer| match &layer.marks {
        Marks::Path(points) => points.iter().filter_map(|point| pane.place(0, *point)).collect(),
        _ => Vec::new(),
    };
    layers.map(on_screen).collect()
}

/// Whether the mechanism presses the mass onto the stop at `x`.
fn is_pressed(model: &Model, x: f64, side: f32) -> bool {
    model.mechanism().curve.force(x) * f64::from(side) < 0.0
}

/// The stops that the mass can rest on, with their sides.
fn presses(model: &Model) -> impl Iterator<Item = (f64, f32)> {
    sides(model).filter(|(x, side)| is_pressed(model, *x, *side))
}

/// The push that frees the mass from a stop at `x`, as a force and as an acceleration.
fn push_that_frees(model: &Model, x: f64) -> String {
    let force = model.mechanism().curve.force(x).abs();
    format!("{} N = {} g", three(force), three(force / (model.mass() * STANDARD_GRAVITY)))
}

/// Marks the force at each stop that the mass can rest on, and writes it with the push that frees the mass:
/// beside the stop, clear of the lines of the curve.
fn releases(painter: &Painter, context: &ViewContext<'_>, pane: &Pane, rect: Rect) {
    let (style, model) = (context.style, context.session.shown());
    let place = |x: f64, force: f64| pane.place(0, (x * 1e3, force)).unwrap_or(rect.min);
    let places = sides(model).map(|(x, side)| wall(rect, place(x, 0.0).x, side)).collect();
    let mut taken = Taken { lines: lines(pane), places, plate: Some(style.ground()) };
    let zero = place(0.0, 0.0).y;
    taken.lines.push(vec![pos2(rect.left(), zero), pos2(rect.right(), zero)]);
    let texts: Vec<String> = presses(model).map(|(x, _)| push_that_frees(model, x)).collect();
    // the legend has the push that is the same at both stops: no label stands far from its stop for it
    let heights = if texts.windows(2).all(|pair| pair[0] == pair[1]) { &ABOVE[..NEAR] } else { &ABOVE[..] };
    for ((x, side), short) in presses(model).zip(texts) {
        let force = model.mechanism().curve.force(x);
        let at = place(x, force);
        let end = at - vec2(LINE * side, 0.0);
        painter.line_segment([at, end], style.stop_stroke());
        taken.lines.push(vec![at, end]);
        let long = format!("frees at {short}");
        // outside the wall, away from the mass, or else inside it
        let outwards = if side > 0.0 { Align2::LEFT_BOTTOM } else { Align2::RIGHT_BOTTOM };
        let inwards = if side > 0.0 { Align2::RIGHT_BOTTOM } else { Align2::LEFT_BOTTOM };
        let places = heights.iter().flat_map(|above| {
            let y = at.y - above;
            let beyond = (pos2(at.x + BESIDE * side, y), outwards);
            let before = (pos2(end.x - 4.0 * side, y), inwards);
            let near = (pos2(at.x - 4.0 * side, y), inwards);
            [(&long, beyond), (&short, beyond), (&long, before), (&short, before), (&short, near)]
        });
        let places = places.map(|(text, (at, align))| (text.as_str(), at, align));
        // clear of the frame
        taken.write(painter, rect.shrink(3.0), (style.small(), style.faint()), places);
    }
}
