//! View of the force curve, with the force of the shaking.
//!
//! The curve is dV/dx, the force that would hold the mass in place; the mechanism exerts the opposite force.
//! The push -m a_b of the base is a horizontal line that moves up and down. Both are positive to the right.
//! Where the line is above the curve, the mass is driven to the right, where it is below, to the left. A mass
//! on a stop is released when the line passes the curve at the stop.

use eframe::egui::{Align2, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::words::numbers::three;
use crate::dynamics::STANDARD_GRAVITY;

use super::chart::Chart;
use super::ghosts::ghosts;
use super::hand::axes_input;
use super::labels::Taken;
use super::legend::Symbol;
use super::overlay::measured_force;
use super::ranges::{axis_end, room_for_push};
use super::stops::{WALL, stops_ui};
use super::view::Axis;
use super::{View, ViewContext, too_small_ui};

/// Factor by which the axis exceeds the largest force between the wells.
const ROOM: f64 = 1.3;

/// Half the size in points of the mark of a kink and of the force at a stop.
const MARK: f32 = 5.0;

/// Length of the line at a stop, in multiples of [`MARK`].
const LINE: f32 = 8.0;

/// Distance in points of a label from its stop.
const BESIDE: f32 = 16.0;
/// Heights in points of a label above the force at its stop, the first that is free.
const ABOVE: [f32; 9] = [2.0, -14.0, 16.0, -28.0, 30.0, -42.0, 44.0, -56.0, 58.0];

/// Radius in points of the mass on the curve.
const BALL: f32 = 7.0;

pub fn force_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::DRAG);
    if area.width() < 60.0 || area.height() < 80.0 {
        return too_small_ui(ui, &context.style, area);
    }
    let style = context.style;
    let end = end_of_axis(context);
    let ends = context.memory.frozen.force.keep((-end, end), context.session.editor.in_gesture());
    let (low, high) = context.memory.axes.ends(Axis::Up(View::ForceCurve), ends);
    let chart = Chart::new(area, context.span, low, high);
    axes_input(ui, context.memory, View::ForceCurve, &response, (area, chart.rect));
    let pointer = response.hover_pos().filter(|at| chart.rect.contains(*at));
    chart.axes(ui, context, ("force to the right (N)", 1.0), pointer.is_some());
    let painter = ui.painter().with_clip_rect(chart.rect);
    let measured = measured_force(&painter, context, &chart);
    let lines = curve(&painter, context, &chart);
    let edges = (chart.rect.top(), chart.rect.bottom());
    stops_ui(ui, context, chart.rect, edges, 0.0);
    let painter = ui.painter().with_clip_rect(chart.rect);
    let model = context.session.shown();
    let (landscape, curve) = (&model.mechanism().landscape, &model.mechanism().curve);
    chart.equilibria(&painter, &style, landscape);
    for kink in &landscape.kinks {
        let at = chart.screen_from_world(kink.x, curve.force(kink.x));
        let points = [vec2(0.0, -MARK), vec2(MARK, 0.0), vec2(0.0, MARK), vec2(-MARK, 0.0)];
        let diamond = points.iter().map(|step| at + *step * 1.3).collect();
        painter.add(Shape::closed_line(diamond, Stroke::new(1.5, style.ink())));
    }
    let state = context.session.player.state();
    let push = -model.mass() * state.base_accel;
    let mut legend = vec![(Symbol::Line(style.tray_stroke()), "holds the mass there")];
    if model.is_shaken() {
        legend.push((Symbol::Line(style.arrow_stroke()), "push of the base"));
        let at = chart.screen_from_world(state.x, push);
        painter.hline(chart.rect.x_range(), at.y, style.arrow_stroke());
        let from = chart.screen_from_world(state.x, curve.force(state.x));
        painter.extend(Shape::dashed_line(&[from, at], style.base_stroke(), 4.0, 3.0));
    }
    legend.extend(measured);
    releases(&painter, context, &chart, lines);
    for ghost in ghosts(context) {
        let curve = &ghost.model.mechanism().curve;
        ghost.stops(&painter, context, chart.rect, 0.0);
        let at = chart.screen_from_world(ghost.state.x, curve.force(ghost.state.x));
        ghost.ball(&painter, &style, at, BALL);
    }
    let at = chart.screen_from_world(state.x, curve.force(state.x));
    painter.circle(at, BALL, style.mass(), Stroke::new(1.5, style.mass_edge()));
    chart.legend(ui, &style, area.right(), &legend);
    if let Some(pointer) = pointer {
        let (x, _) = chart.world_from_screen(pointer);
        let force = context.session.shown().mechanism().curve.force(x);
        if force.is_finite() {
            let direction = if force < 0.0 { " to the left" } else { " to the right" };
            let text = format!("{} N{direction} holds it at {} mm", three(force.abs()), three(x * 1e3));
            chart.readout(ui, &style, &text);
        }
    }
}

/// End of the axis in N: covers the forces between the wells and the largest push of the base.
fn end_of_axis(context: &ViewContext<'_>) -> f64 {
    let model = context.session.shown();
    let landscape = &model.mechanism().landscape;
    let wells = landscape.barrier.map(|barrier| (barrier.left_well, barrier.right_well));
    let between = |x: f64| wells.is_some_and(|(left, right)| x > left && x < right);
    let mut largest = landscape
        .extrema
        .iter()
        .filter(|extremum| between(extremum.x))
        .map(|extremum| extremum.force.abs())
        .fold(0.0, f64::max);
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

/// Draws the force curve: thick between the stops, dashed beyond them. Returns its parts.
fn curve(painter: &Painter, context: &ViewContext<'_>, chart: &Chart) -> Vec<Vec<Pos2>> {
    let (style, model) = (context.style, context.session.shown());
    let curve = &model.mechanism().curve;
    let (left, right) = model.stop_positions();
    let domain = curve.domain();
    let (low, high) = (context.span.low.max(domain.0), context.span.high.min(domain.1));
    let (inner, outer) = (left.unwrap_or(low).clamp(low, high), right.unwrap_or(high).clamp(low, high));
    let force = |x: f64| curve.force(x);
    let parts = [(low, inner), (inner, outer), (outer, high)].map(|(a, b)| chart.curve(a, b, force));
    for beyond in [&parts[0], &parts[2]] {
        painter.extend(Shape::dashed_line(beyond, style.ghost_stroke(), 5.0, 5.0));
    }
    painter.add(Shape::line(parts[1].clone(), style.tray_stroke()));
    parts.into()
}

/// Marks the force at each stop that the mass can rest on, and writes it with the push that frees the mass:
/// beside the stop, clear of the `lines` of the curve.
fn releases(painter: &Painter, context: &ViewContext<'_>, chart: &Chart, lines: Vec<Vec<Pos2>>) {
    let (style, model) = (context.style, context.session.shown());
    let (left, right) = model.stop_positions();
    let sides = [(left, -1.0_f32), (right, 1.0)].into_iter().filter_map(|(x, side)| Some((x?, side)));
    let wall = |(x, side): (f64, f32)| {
        let face = chart.screen_from_world(x, 0.0).x;
        Rect::from_two_pos(pos2(face, chart.rect.top()), pos2(face + side * WALL, chart.rect.bottom()))
    };
    let mut taken = Taken { lines, places: sides.clone().map(wall).collect() };
    let zero = chart.screen_from_world(0.0, 0.0).y;
    taken.lines.push(vec![pos2(chart.rect.left(), zero), pos2(chart.rect.right(), zero)]);
    for (x, side) in sides {
        let force = model.mechanism().curve.force(x);
        // only where the mechanism presses the mass onto the stop
        if !(force * f64::from(side) < 0.0) {
            continue;
        }
        let at = chart.screen_from_world(x, force);
        let end = at - vec2(LINE * MARK * side, 0.0);
        painter.line_segment([at, end], style.stop_stroke());
        taken.lines.push(vec![at, end]);
        let push = three(force.abs() / (model.mass() * STANDARD_GRAVITY));
        let short = format!("{} N = {push} g", three(force.abs()));
        let long = format!("frees at {short}");
        // outside the wall, away from the mass, or else inside it
        let outwards = if side > 0.0 { Align2::LEFT_BOTTOM } else { Align2::RIGHT_BOTTOM };
        let inwards = if side > 0.0 { Align2::RIGHT_BOTTOM } else { Align2::LEFT_BOTTOM };
        let places = ABOVE.iter().flat_map(|above| {
            let y = at.y - above;
            let beyond = (pos2(at.x + BESIDE * side, y), outwards);
            let before = (pos2(end.x - 4.0 * side, y), inwards);
            let near = (pos2(at.x - 4.0 * side, y), inwards);
            [(&long, beyond), (&short, beyond), (&long, before), (&short, before), (&short, near)]
        });
        let places = places.map(|(text, (at, align))| (text.as_str(), at, align));
        taken.write(painter, chart.rect, (style.small(), style.faint()), places);
    }
}
