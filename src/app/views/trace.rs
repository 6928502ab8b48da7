//! Traces over time: displacement, velocity, base acceleration, power.
//!
//! The traces are one view with several quantities. All traces show the same range of time and the same time
//! under the pointer, so that they can be read below each other. Their vertical ranges come from the scene
//! and from [`Ranges`](super::ranges::Ranges), not from what is visible.

use eframe::egui::{Align2, Sense, Shape, Ui, pos2, vec2};

use crate::app::session::Session;
use crate::app::session::pins::Pin;
use crate::app::words::numbers::decimals_for;
use crate::dynamics::{EventKind, Model, Phase, STANDARD_GRAVITY, Sample, Side};
use crate::output::{Chart, Layer, Marks, OverTime, PlotAxis, Role, RunPanel, TIME};
use crate::scene::Quantity;
use interwell_studies::study::{Table, Watch};

use super::cursors::{cursors_ui, readout_height, readout_ui};
use super::hand::axes_input;
use super::overlay::{Measurable, measured_trace, with_room};
use super::pane::{Place, fresh_pane_ui};
use super::ranges::room_for_push;
use super::view::Axis;
use super::{View, ViewContext};

/// Number of forcing periods shown.
const PERIODS: f64 = 6.0;
/// Number of characteristic times of the motion shown, if the shaking has no period, and if nothing shakes
/// the mass, which is seen to come to rest.
const SWINGS: (f64, f64) = (8.0, 12.0);
/// Largest number of natural times of the mechanism shown; more swings cannot be told apart.
const MAX_SWINGS: f64 = 200.0;

/// Position of the present in the range of time, as a share of it.
const PRESENT: f64 = 0.94;

/// Width in points of a pin's letter at the end of its line.
const LETTER: f32 = 9.0;

/// Largest number of points of a line; a longer path is thinned.
const MAX_POINTS: usize = 20_000;

/// Largest number of points of a pinned motion's line, whose dashes cost more.
const MAX_GHOST_POINTS: usize = 4000;

/// A point of the picture: time in s and value.
type Point = (f64, f64);

/// A quantity drawn over time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TraceQuantity {
    /// Displacement relative to the base.
    Displacement,
    /// Velocity relative to the base.
    Velocity,
    BaseAcceleration,
    /// Power of the base into the mass.
    Power,
    /// Power into the load of a transducer.
    LoadPower {
        /// Number of units of the axis in a watt.
        per_watt: u32,
        /// The unit of the axis.
        unit: &'static str,
    },
}

impl TraceQuantity {
    /// Its value in the unit of its axis; NaN where it is not known.
    pub fn value(self, sample: &Sample, model: &Model) -> f64 {
        match self {
            Self::Displacement => sample.x * 1e3,
            Self::Velocity => sample.v * 1e3,
            Self::BaseAcceleration => sample.base_accel / STANDARD_GRAVITY,
            Self::Power => sample.work_rate(model.mass()) * 1e3,
            Self::LoadPower { per_watt, .. } => {
                model.output(sample).map_or(f64::NAN, |output| output.power * f64::from(per_watt))
            }
        }
    }

    /// Its value in a recorded motion, by the model at that time.
    fn value_in(self, watch: &Watch, sample: &Sample) -> f64 {
        self.value(sample, watch.model_at(sample.t))
    }

    /// Its name, its unit, its view, and the panel of the picture of a run that shows it.
    fn shown(self) -> (&'static str, &'static str, View, RunPanel) {
        match self {
            Self::Displacement => ("displacement", "mm", View::Displacement, RunPanel::Displacement),
            Self::Velocity => ("velocity", "mm/s", View::Velocity, RunPanel::Velocity),
            Self::BaseAcceleration => ("base", "g", View::BaseAcceleration, RunPanel::Acceleration),
            Self::Power => ("power", "mW", View::Power, RunPanel::Power),
            Self::LoadPower { unit, .. } => ("power into the load", unit, View::Power, RunPanel::Power),
        }
    }

    /// The measured quantity that it can be compared with, and the unit of its axis in SI.
    fn measured(self) -> Measurable {
        match self {
            Self::Displacement => Some((Quantity::Displacement, 1e-3)),
            Self::Velocity => Some((Quantity::Velocity, 1e-3)),
            Self::BaseAcceleration => Some((Quantity::Acceleration, STANDARD_GRAVITY)),
            Self::Power | Self::LoadPower { .. } => None,
        }
    }

    /// The ends of the vertical axis, in its unit.
    fn ends(self, context: &mut ViewContext<'_>) -> (f64, f64) {
        let both = |end: f64| (-end, end);
        match self {
            Self::Displacement => {
                let span = context.memory.reach(context.session, None);
                (span.low * 1e3, span.high * 1e3)
            }
            Self::Velocity => both(context.memory.ranges.follow(context.session).speed() * 1e3),
            Self::BaseAcceleration => both(
                1.12 * room_for_push(context.session.shown().largest_base_acceleration()) / STANDARD_GRAVITY,
            ),
            Self::Power => both(context.memory.ranges.follow(context.session).power() * 1e3),
            Self::LoadPower { per_watt, .. } => {
                let end = context.memory.ranges.follow(context.session).load_power() * f64::from(per_watt);
                (-0.04 * end, end)
            }
        }
    }
}

pub fn trace_ui(ui: &mut Ui, quantity: TraceQuantity, context: &mut ViewContext<'_>) {
    let (style, (name, unit, view, _)) = (context.style, quantity.shown());
    let ends = quantity.ends(context);
    let ends = with_room(context.session, quantity.measured(), ends);
    let (low, high) = context.memory.axes.ends(Axis::Up(view), ends);
    let now = context.session.player.time();
    let timeline = &mut context.memory.timeline;
    timeline.default_window = stretch(context.session.shown());
    let window = timeline.window.unwrap_or(timeline.default_window);
    // the present is near the end of the time axis
    let from = (now - PRESENT * window).max(-0.02 * window);
    let (from, to) = context.memory.axes.ends(Axis::Time, (from, from + window));
    let (window, end) = (to - from, now.min(to));
    let (area, digits) = (ui.max_rect(), 1 + decimals_for(high - low));
    let watch = context.session.player.watch();
    let read = |t: f64| quantity.value_in(watch, &watch.state_at(t));
    let at_each = |t: f64| format!("{:.digits$} {unit}", read(t));
    let between = |a: f64, b: f64| format!("{:+.digits$} {unit}", read(b) - read(a));
    let readout = readout_height(ui, context);
    let chart = chart(context.session, quantity, (from, to), (low, high));
    let place = Place::in_line(ui, area, Sense::click_and_drag(), (0.0, readout));
    let pane = fresh_pane_ui(ui, &style, place, chart);
    let Some(frame) = pane.frame(0) else { return };
    readout_ui(ui, context, (frame, window), at_each, between);
    axes_input(ui, context.memory, view, &pane.response, (area, frame));
    let painter = ui.painter().with_clip_rect(area);
    // each pin has its letter at the end of its line, beside those of the others
    for (i, pin) in pinned(context.session, quantity).iter().enumerate() {
        let value = quantity.value_in(&pin.watch, &pin.watch.state_at(end));
        if let Some(at) = pane.place(0, (end, value.clamp(low, high))).filter(|_| value.is_finite()) {
            let at = at + vec2(LETTER * (i as f32 + 0.5), 0.0);
            painter.text(at, Align2::CENTER_CENTER, pin.letter, style.small(), style.pin());
        }
    }
    let pass = ui.ctx().cumulative_pass_nr();
    let pointer = pane.hovered().and_then(|at| pane.values_at(0, at));
    if let Some((t, _)) = pointer {
        let watch = context.session.player.watch();
        let t = t.clamp(watch.begin().min(now), now);
        let value = quantity.value_in(watch, &watch.state_at(t));
        pane.reading(ui, &style, 0.0, &format!("{value:.digits$} {unit} at {t:.3} s"));
        context.memory.timeline.cursor = Some((t, pass));
    }
    let cursor = context.memory.timeline.cursor.filter(|cursor| cursor.1 + 1 >= pass);
    if let Some(at) = cursor.and_then(|cursor| pane.place(0, (cursor.0, low))) {
        let line = [pos2(at.x, frame.top()), pos2(at.x, frame.bottom())];
        painter.with_clip_rect(frame).extend(Shape::dashed_line(&line, style.ghost_stroke(), 4.0, 3.0));
    }
    cursors_ui(ui, context, &pane.response, (frame, (from, to)), name);
}

/// The picture from `from` to `to` in s over this vertical axis.
fn chart(session: &Session, quantity: TraceQuantity, (from, to): Point, (low, high): Point) -> Chart {
    let (watch, now) = (session.player.watch(), session.player.time());
    // up to the present, or to what is known at the end
    let state = if now <= to { session.player.state() } else { watch.state_at(to) };
    let samples: Vec<Sample> = thinned(watch, (from, now.min(to)), MAX_POINTS, state).collect();
    let line = |watch: &Watch, samples: &mut dyn Iterator<Item = Sample>| {
        let points = samples.map(|sample| (sample.t, quantity.value_in(watch, &sample)));
        Marks::Trace(points.filter(|point| !point.1.is_nan()).collect())
    };
    let measured = measured_trace(session, quantity.measured(), (from, to));
    let (_, unit, _, panel) = quantity.shown();
    let has_load = matches!(quantity, TraceQuantity::LoadPower { .. });
    // what was measured has the colour of a second quantity
    let role = if measured.is_some() { Role::Motion } else { panel.role(has_load) };
    let mut lines = vec![Layer::new(Role::Reference, "", Marks::Verticals(vec![now]))];
    let mut stops = (f64::NAN, f64::NAN);
    if quantity == TraceQuantity::Displacement {
        let (places, moved) = stop_lines(watch, from, to);
        stops = places;
        lines.extend(moved.map(|points| Layer::new(Role::Stop, "stop", Marks::Path(points))));
    }
    lines.extend(measured);
    for pin in pinned(session, quantity) {
        let (from, to) = (from.max(pin.since), now.min(to));
        let samples = &mut thinned(&pin.watch, (from, to), MAX_GHOST_POINTS, pin.watch.state_at(to));
        let path = line(&pin.watch, samples);
        lines.push(Layer::new(Role::Pin(pin.place()), &pin.letter.to_string(), path));
    }
    lines.push(Layer::new(role, "", line(watch, &mut samples.iter().copied())));
    let stable = session.shown().mechanism().landscape.equilibria.iter().filter(|point| point.stable);
    let beside = OverTime {
        time: PlotAxis::between(from, to, TIME),
        rests: (rest_spans(&samples), "at rest on a stop"),
        impacts: [Side::Left, Side::Right].map(|side| impact_times(watch, side, (from, now.min(to)))),
        stops,
        wells: stable.map(|well| well.x * 1e3).collect(),
    };
    let up = PlotAxis::between(low, high, &panel.label(unit, has_load));
    Chart::stack(vec![panel.over_time(up, lines, &beside)], "", Table::new())
}

/// The pinned motions whose paths are drawn: of displacement and velocity.
fn pinned(session: &Session, quantity: TraceQuantity) -> &[Pin] {
    let is_drawn = matches!(quantity, TraceQuantity::Displacement | TraceQuantity::Velocity);
    if is_drawn { session.pins.all() } else { &[] }
}

/// The samples of a motion from before `from` to `to` in s, thinned to about `count` samples, and its `state`
/// at the end.
fn thinned(watch: &Watch, (from, to): Point, count: usize, state: Sample) -> impl Iterator<Item = Sample> {
    let samples = watch.samples();
    let first = samples.partition_point(|sample| sample.t < from).saturating_sub(1);
    let last = samples.partition_point(|sample| sample.t <= to).max(first);
    let stride = ((last - first) / count).max(1);
    samples.range(first..last).step_by(stride).copied().chain([state])
}

/// Times of the impacts on a stop from `from` to `to` in s.
fn impact_times(watch: &Watch, side: Side, (from, to): Point) -> Vec<f64> {
    let events = watch.events();
    let seen = events.range(events.partition_point(|event| event.t < from)..);
    seen.take_while(|event| event.t <= to)
        .filter(|event| matches!(event.kind, EventKind::Impact | EventKind::Contact) && event.side == side)
        .map(|event| event.t)
        .collect()
}

/// The time in s that is shown by default of a motion of a model.
pub(in crate::app) fn stretch(model: &Model) -> f64 {
    let limit = MAX_SWINGS * model.natural_time();
    let swings = if model.is_shaken() { SWINGS.0 } else { SWINGS.1 };
    model
        .forcing_period()
        .map_or(swings * model.characteristic_time(), |period| (PERIODS * period).min(limit))
}

/// The positions in mm of the stops in a range of time, NaN without a stop. If a stop moved they are NaN, and
/// the lines of both stops over time are returned, separated by points that are not finite.
fn stop_lines(watch: &Watch, from: f64, to: f64) -> (Point, Option<Vec<Point>>) {
    let mm = |stop: Option<f64>| stop.map_or(f64::NAN, |x| x * 1e3);
    let uses: Vec<(f64, f64, [f64; 2])> = watch
        .models_between(from.max(0.0), to)
        .map(|(begin, end, model)| (begin, end, <[_; 2]>::from(model.stop_positions()).map(mm)))
        .collect();
    let first = uses.first().map_or([f64::NAN; 2], |first| first.2);
    if uses.iter().all(|each| each.2.map(f64::to_bits) == first.map(f64::to_bits)) {
        return (first.into(), None);
    }
    let gap = (f64::NAN, f64::NAN);
    let of_side = |side: usize| {
        uses.iter().flat_map(move |(begin, end, mm)| [(*begin, mm[side]), (*end, mm[side]), gap])
    };
    (gap, Some(of_side(0).chain(of_side(1)).collect()))
}

/// Times between which the mass rests on a stop.
fn rest_spans(samples: &[Sample]) -> Vec<(f64, f64)> {
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
