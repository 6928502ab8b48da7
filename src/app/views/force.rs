//! View of the force curve, with the force of the shaking.
//!
//! The curve is dV/dx, the force that would hold the mass in place; the mechanism exerts the opposite force.
//! The push -m a_b of the base is a horizontal line that moves up and down. Both are positive to the right.
//! Where the line is above the curve, the mass is driven to the right, where it is below, to the left. A mass
//! on a stop is released when the line passes the curve at the stop.

use std::sync::Arc;

use eframe::egui::{Stroke, Ui};

use crate::app::task::Identity;
use crate::app::words::numbers::three;
use crate::dynamics::{Model, STANDARD_GRAVITY};
use crate::output::{
    DISPLACEMENT, HOLDING_FORCE, Layer, Marks, Panel, PlotAxis, Role, axis_name, force_panel,
};

use super::ghosts::{circle, ghost};
use super::overlay::measured_force;
use super::plot::{kept, plot_ui};
use super::ranges::{axis_end, room_for_push};
use super::stops::{add_walls, sides, stops_ui};
use super::{View, ViewContext};

/// Factor by which the axis exceeds the largest force between the wells.
const ROOM: f64 = 1.3;

/// Length of the line at a stop as a share of the axis.
const LINE: f64 = 0.08;

/// Number of points of the curve.
const POINTS: usize = 600;

/// Radius in points of the mass on the curve.
const BALL: f32 = 7.0;

pub fn force_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, style) = (ui.max_rect(), context.style);
    let end = end_of_axis(context);
    let up = context.memory.frozen.force.keep((-end, end), context.session.editor.in_gesture());
    let span = context.memory.place(context.session);
    let automatic = [(span.low * 1e3, span.high * 1e3), up];
    let ends = context.memory.ends(View::ForceCurve, automatic);
    let model = Arc::clone(context.session.shown());
    let measured = context.session.measured.over.clone();
    let mut panel = kept(ui, (Identity(Arc::clone(&model)), measured, ends), || {
        let [across, up] = automatic;
        let across = PlotAxis::between(across.0, across.1, DISPLACEMENT);
        let axes = (across, PlotAxis::between(up.0, up.1, &axis_name(HOLDING_FORCE, "N")));
        still(&model, ends[0], axes, measured_force(context.session))
    });
    add_walls(&mut panel, context.session);
    let curve = &model.mechanism().curve;
    let state = context.session.player.state();
    if model.is_shaken() {
        let (mm, push) = (state.x * 1e3, -model.mass() * state.base_accel);
        panel.layer(Role::Push, "push", Marks::Horizontals(vec![push]));
        panel.layer(Role::Apart, "", Marks::Path(vec![(mm, curve.force(state.x)), (mm, push)]));
    }
    let plotted = plot_ui(ui, context.memory, View::ForceCurve, &style, area, &panel);
    let frame = plotted.frame();
    let shared = std::mem::replace(&mut context.span, plotted.span());
    stops_ui(ui, context, frame, (frame.top(), frame.bottom()), (0.0, false));
    let painter = ui.painter().with_clip_rect(frame);
    let at = |x: f64, force: f64| plotted.place((x * 1e3, force));
    // a ball at an end of an axis is not cut
    let over = ui.painter().with_clip_rect(frame.expand(BALL + 1.0).intersect(area));
    if let Some(ghost) = ghost(context) {
        let curve = &ghost.model.mechanism().curve;
        ghost.stops(&painter, context, frame, 0.0);
        let at = at(ghost.state.x, curve.force(ghost.state.x));
        ghost.outline(&over, &style, &circle(at, BALL));
    }
    over.circle(at(state.x, curve.force(state.x)), BALL, style.mass(), Stroke::new(1.5, style.mass_edge()));
    if let Some((mm, _)) = plotted.pointed() {
        let force = curve.force(mm * 1e-3);
        if force.is_finite() {
            let direction = if force < 0.0 { " to the left" } else { " to the right" };
            let text = format!("{} N{direction} holds it at {} mm", three(force.abs()), three(mm));
            plotted.write(ui, &style, &text);
        }
    }
    context.span = shared;
}

/// The parts that stay the same from frame to frame: axes, curve, kinks and equilibria, the measured force,
/// and the push that frees the mass from each stop. The view draws the stops, which can be dragged.
fn still(
    model: &Model,
    (from, to): (f64, f64),
    axes: (PlotAxis, PlotAxis),
    measured: Option<Layer>,
) -> Panel {
    let curve = &model.mechanism().curve;
    let mm = |stop: Option<f64>| stop.map_or(f64::NAN, |x| x * 1e3);
    let (stops, domain) = (model.stop_positions(), curve.domain());
    let (low, high) = ((from * 1e-3).max(domain.0), (to * 1e-3).min(domain.1));
    let place = |i: usize| (low + (high - low) * i as f64 / POINTS as f64).min(high);
    let points = (0..=POINTS).map(place).map(|x| (x * 1e3, curve.force(x)));
    let points = if high > low { points.collect() } else { Vec::new() };
    let stops = (mm(stops.0), mm(stops.1));
    let mut panel = force_panel(model.mechanism(), axes, 1.0, stops, ("holds the mass there", points));
    panel.layers.retain(|layer| layer.role != Role::Stop);
    for (x, side) in sides(model).filter(|(x, side)| is_pressed(model, *x, *side)) {
        let force = curve.force(x);
        let line = vec![(x * 1e3, force), (x * 1e3 - f64::from(side) * LINE * (to - from), force)];
        let name = format!("frees the mass: {}", push_that_frees(model, force.abs()));
        panel.layer(Role::Limit, &name, Marks::Path(line));
    }
    panel.layers.extend(measured);
    panel
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

/// Whether the mechanism presses the mass onto the stop at `x`.
fn is_pressed(model: &Model, x: f64, side: f32) -> bool {
    model.mechanism().curve.force(x) * f64::from(side) < 0.0
}

/// A push as a force and as an acceleration.
fn push_that_frees(model: &Model, force: f64) -> String {
    format!("{} N = {} g", three(force), three(force / (model.mass() * STANDARD_GRAVITY)))
}
