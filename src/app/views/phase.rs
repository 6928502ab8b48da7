//! View of the phase portrait: velocity over displacement.
//!
//! The separatrix consists of the states whose energy equals the potential at the top of the barrier: without
//! shaking and dissipation, a state inside one of its loops never leaves that well. Shaking and impacts carry
//! the state across it.

use std::collections::VecDeque;
use std::sync::Arc;

use eframe::egui::{self, Color32, Pos2, Stroke, Ui, pos2, vec2};

use crate::app::task::Identity;
use crate::app::ui::widgets::{kind_shapes, tell};
use crate::app::words::numbers::three;
use crate::app::words::status::Kind;
use crate::dynamics::{Model, Phase, Sample};
use crate::output::{DISPLACEMENT, Marks, Panel, PlotAxis, Role, VELOCITY, axis_name, portrait_panel};
use interwell_studies::study::between;

use super::context::sized_ui;
use super::ghosts::{REFERENCE, circle, ghost};
use super::labels::pointer_rests;
use super::plot::{Plotted, kept, plot_ui};
use super::stops::{add_walls, stops_ui};
use super::{View, ViewContext};

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

const MAX_STROBES: f64 = 300.0;

/// Radius in points of the mark of the present state.
const STATE: f32 = 6.0;
/// Radius in points of the dot of a start.
const START: f32 = 3.0;

/// A point of the picture: displacement in mm, velocity in mm/s.
type State = (f64, f64);

/// A point of the picture from m and m/s.
fn state((x, v): (f64, f64)) -> State {
    (x * 1e3, v * 1e3)
}

/// Draws the stroboscopic states without the path: the section of the live motion.
pub fn section_ui(ui: &mut Ui, context: &mut ViewContext<'_>) {
    if context.session.shown().forcing_period().is_none() {
        let text = "A section has a point once a forcing period, and the shaking of this scene has none.";
        ui.label(egui::RichText::new(text).color(context.style.faint()));
        return;
    }
    sized_ui(ui, context, vec2(60.0, 80.0), |ui, context| states_ui(ui, context, true));
}

pub fn states_ui(ui: &mut Ui, context: &mut ViewContext<'_>, is_section: bool) {
    let (area, style) = (ui.max_rect(), context.style);
    let view = if is_section { View::Section } else { View::PhasePortrait };
    let speed = 1e3 * context.memory.ranges.follow(context.session).speed();
    let span = context.memory.reach(context.session);
    let model = Arc::clone(context.session.shown());
    let automatic = [(span.low * 1e3, span.high * 1e3), (-speed, speed)];
    let ends = context.memory.ends(view, automatic);
    let axes = |[across, up]: [(f64, f64); 2]| {
        let up = PlotAxis::between(up.0, up.1, &axis_name(VELOCITY, "mm/s"));
        (PlotAxis::between(across.0, across.1, DISPLACEMENT), up)
    };
    let mut panel = kept(ui, (Identity(Arc::clone(&model)), ends), || {
        portrait_panel(&model, axes(ends), 1e3, (f64::NAN, f64::NAN), Vec::new())
    });
    (panel.x, panel.y) = axes(automatic);
    add_walls(&mut panel, context.session);
    if !is_section {
        let [across, up] = ends.map(|(low, high)| high - low);
        let scale = (f64::from(area.width()) / across, f64::from(area.height()) / up);
        reference_trail(&mut panel, context, scale);
        trail(&mut panel, context, scale);
    }
    if model.forcing_period().is_some() {
        panel.layer(Role::Strobe, "once a period", Marks::Points(strobes(context)));
    }
    if model.stop_positions() != (None, None) {
        panel.layer(Role::Resting, "at rest", Marks::Points(Vec::new()));
    }
    let plotted = plot_ui(ui, context.memory, view, &style, area, &panel);
    tell(&plotted.response, egui::Role::Canvas, "states of the mass");
    let frame = plotted.frame();
    let shared = std::mem::replace(&mut context.span, plotted.span());
    stops_ui(ui, context, frame, (frame.top(), frame.bottom()), (0.0, false));
    let painter = ui.painter().with_clip_rect(frame.expand(STATE));
    let at = |sample: Sample| plotted.place(state((sample.x, sample.v)));
    if let Some(ghost) = ghost(context) {
        ghost.stops(&painter, context, frame, 0.0);
        ghost.outline(&painter, &style, &circle(at(ghost.state), STATE));
    }
    starts(&painter, context, |start| Some(plotted.place(start)), 1e3);
    let present = context.session.player.state();
    if present.phase == Phase::Free {
        painter.circle(at(present), STATE, style.mass(), Stroke::new(1.5, style.mass_edge()));
    } else {
        painter.extend(kind_shapes(Kind::Resting, at(present), STATE + 2.5, style.mass_edge()));
        painter.extend(kind_shapes(Kind::Resting, at(present), STATE, style.mass()));
    }
    start_ui(ui, context, &plotted);
    context.span = shared;
}

/// Marks of the starts of which a lesson speaks; the axis upward has a velocity in m/s times `per_speed`:
/// rings or, where these would touch, a line from the first to the last.
pub(super) fn starts(
    painter: &egui::Painter,
    context: &ViewContext<'_>,
    place: impl Fn(State) -> Option<Pos2>,
    per_speed: f64,
) {
    let starts = context.memory.starts.iter();
    let places: Vec<Pos2> = starts.filter_map(|(x, v)| place((x * 1e3, v * per_speed))).collect();
    let apart = places.windows(2).map(|pair| pair[0].distance(pair[1])).fold(f32::INFINITY, f32::min);
    if apart >= 2.5 * START {
        for at in places {
            // seen on the colour of any basin
            painter.circle(at, START, Color32::WHITE, Stroke::new(0.3 * START, Color32::BLACK));
        }
        return;
    }
    if let [first, .., last] = places[..] {
        for (width, colour) in [(4.0, Color32::WHITE), (2.0, Color32::BLACK)] {
            painter.line_segment([first, last], Stroke::new(width, colour));
        }
    }
}

/// Shows the state under the pointer; a click continues the motion from there.
fn start_ui(ui: &Ui, context: &mut ViewContext<'_>, plotted: &Plotted) {
    let model = context.session.shown();
    let ((left, right), (low, high)) = (model.stop_positions(), model.mechanism().curve.domain());
    let ends = (1e3 * left.unwrap_or(low).max(low), 1e3 * right.unwrap_or(high).min(high));
    // beyond a stop the mass is put onto it
    let held = |(mm, speed): State| {
        let at = mm.clamp(ends.0, ends.1);
        (at, if at == mm { speed } else { 0.0 })
    };
    if let Some((mm, speed)) = plotted.clicked.map(held) {
        context.session.place(mm / 1e3, speed / 1e3);
    }
    let Some((mm, speed)) = plotted.pointed().map(held) else { return };
    plotted.write(ui, &context.style, &format!("{} mm, {} mm/s", three(mm), three(speed)));
    if pointer_rests(ui) {
        plotted.response.clone().on_hover_text_at_pointer("Click: the motion continues from here.");
    }
}

/// The recent path, fading with age. An impact is a dashed jump; moving the mass by hand leaves a gap.
fn trail(panel: &mut Panel, context: &ViewContext<'_>, scale: State) {
    let session = &context.session;
    let model = session.shown();
    let length =
        model.forcing_period().map_or(TRAIL_SWINGS * model.natural_time(), |period| TRAIL_PERIODS * period);
    let present = session.player.state();
    let watch = session.player.watch();
    let path = recent(watch.samples(), present, length);
    let mut pieces_left = MAX_TOTAL_PIECES;
    let level = |t: f64| {
        let age = ((present.t - t) / length).clamp(0.0, 1.0);
        ((age * FADES as f64) as usize).min(FADES - 1)
    };
    let mut parts: [Vec<State>; FADES] = Default::default();
    let mut jumps = Vec::new();
    const GAP: State = (f64::NAN, f64::NAN);
    for pair in path.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let (from, to, now) = (state((a.x, a.v)), state((b.x, b.v)), level(b.t));
        if a.t == b.t {
            parts[now].push(GAP);
            if a.x == b.x && a.v != b.v {
                jumps.extend([from, to, GAP]);
            }
            continue;
        }
        if parts[now].last() != Some(&from) {
            parts[now].extend([GAP, from]);
        }
        let count = pieces(scale, watch.model_at(a.t), (&a, &b)).min(pieces_left);
        pieces_left -= count;
        parts[now].extend(between(watch.model_at(a.t), &a, &b, count).into_iter().map(state));
        parts[now].push(to);
    }
    // the oldest lies below
    for (level, part) in parts.into_iter().enumerate().rev() {
        panel.layer(Role::Past(level as f64 / (FADES - 1) as f64), "", Marks::Path(part));
    }
    panel.layer_if_any(Role::Jump(0.0), "impact", Marks::Path(jumps));
}

/// The last period of the path of the reference; a longer one could not be told apart.
fn reference_trail(panel: &mut Panel, context: &ViewContext<'_>, scale: State) {
    let session = &context.session;
    let model = session.shown();
    let length = model.forcing_period().unwrap_or(TRAIL_SWINGS / TRAIL_PERIODS * model.natural_time());
    let now = session.player.time();
    let Some(apart) = session.reference.apart() else { return };
    let watch = &apart.watch;
    let path = recent(watch.samples(), watch.state_at(now), length.min(now - apart.since));
    let mut pieces_left = MAX_TOTAL_PIECES;
    let mut points: Vec<State> = Vec::with_capacity(2 * path.len());
    for pair in path.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let count = pieces(scale, watch.model_at(a.t), (&a, &b)).min(pieces_left);
        pieces_left -= count;
        points.push(state((a.x, a.v)));
        points.extend(between(watch.model_at(a.t), &a, &b, count).into_iter().map(state));
    }
    points.extend(path.last().map(|last| state((last.x, last.v))));
    panel.layer(Role::Compared, REFERENCE, Marks::Path(points));
}

/// Number of pieces that make the path between two samples look smooth, from how far the control points of
/// its cubic are off the chord, in points of the screen by this scale.
fn pieces(scale: State, model: &Model, (a, b): (&Sample, &Sample)) -> usize {
    let third = (b.t - a.t) / 3.0;
    let place = |at: (f64, f64)| {
        let (mm, speed) = state(at);
        pos2((mm * scale.0) as f32, (speed * scale.1) as f32)
    };
    let control = |sample: &Sample, third: f64| {
        let acceleration = model.acceleration(sample.x, sample.v, sample.base_accel);
        place((sample.x + third * sample.v, sample.v + third * acceleration))
    };
    let (from, to) = (place((a.x, a.v)), place((b.x, b.v)));
    let along = (to - from).normalized();
    let distance = |at: egui::Pos2| {
        let aside = at - from;
        (aside - along * aside.dot(along)).length()
    };
    let deviation = distance(control(a, third)).max(distance(control(b, -third)));
    let is_bent = a.phase == Phase::Free && deviation > FLAT;
    if is_bent { (2.0 * deviation).sqrt().ceil().min(MAX_PIECES) as usize } else { 1 }
}

/// The samples of the last `length` seconds before `state`, followed by `state`.
fn recent(samples: &VecDeque<Sample>, state: Sample, length: f64) -> Vec<Sample> {
    let last = samples.partition_point(|sample| sample.t <= state.t);
    let first = samples.partition_point(|sample| sample.t < state.t - length);
    let first = first.max(last.saturating_sub(MAX_POINTS)).min(last);
    samples.range(first..last).copied().chain([state]).collect()
}

/// The stroboscopic states since the last change.
fn strobes(context: &ViewContext<'_>) -> Vec<State> {
    let session = &context.session;
    let Some(period) = session.shown().forcing_period() else { return Vec::new() };
    let (watch, now) = (session.player.watch(), session.player.time());
    // since the last change of the model, and since the mass was last moved by hand
    let placed = if session.player.is_past() { 0.0 } else { session.changed_at };
    let begin = watch.model_since(now).max(placed).max(watch.begin());
    let last = (now / period).floor();
    let first = (begin / period).ceil().max(last - MAX_STROBES);
    let count = (last - first + 1.0).clamp(0.0, MAX_STROBES) as u32;
    let at = |i: u32| watch.state_at((first + f64::from(i)) * period);
    (0..count).map(at).map(|sample| state((sample.x, sample.v))).collect()
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
