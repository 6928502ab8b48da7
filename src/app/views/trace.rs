//! Traces over time: displacement, velocity, base acceleration, power.
//!
//! The traces are one view with several quantities. All traces show the same range of time and the same time
//! under the pointer, so that they can be read below each other. Their vertical ranges come from the scene
//! and from [`Ranges`](super::ranges::Ranges), not from what is visible.

use eframe::egui::{Align2, RichText, Stroke, Ui, vec2};
use egui_plot::{HLine, Line, LineStyle, PlotBounds, PlotPoint, PlotPoints, PlotUi, Span, Text, VLine};

use crate::app::session::Session;
use crate::app::session::pins::Pin;
use crate::app::ui::style::Style;
use crate::app::words::numbers::decimals_for;
use crate::dynamics::{EventKind, Model, Phase, STANDARD_GRAVITY, Sample};
use crate::scene::Quantity;
use crate::study::Watch;

use super::cursors::{cursors_ui, readout_ui};
use super::ghosts::{PINNED, plot_dashes};
use super::hand::axes_input;
use super::labels::haloed;
use super::legend::{LEGEND, Symbol, legend};
use super::overlay::{MeasuredTrace, with_room};
use super::plot::{LOW, MARGIN, even, marks, plot_place, still_plot};
use super::ranges::room_for_push;
use super::view::Axis;
use super::{View, ViewContext};

/// Number of forcing periods shown.
const PERIODS: f64 = 6.0;
/// Number of characteristic times of the motion shown, if the shaking has no period.
const SWINGS: f64 = 8.0;
/// Largest number of natural times of the mechanism shown; more swings cannot be told apart.
const MAX_SWINGS: f64 = 200.0;

/// Position of the present in the range of time, as a share of it.
const PRESENT: f64 = 0.94;

/// Width of a pin's letter at the end of its line, as a share of the range of time.
const LETTER: f64 = 0.019;

/// Height in points of the numbers and the name below a plot.
const BELOW: f32 = 40.0;

/// Share of the time axis at its end without numbers, which would be cut off there.
const NO_NUMBER: f64 = 0.05;

/// Largest number of points of a line; a longer path is thinned.
const MAX_POINTS: usize = 20_000;

/// Largest number of points of a pinned motion's line, whose dashes cost more.
const MAX_GHOST_POINTS: usize = 4000;

/// Largest number of flights drawn as separate lines; with more, the tips of one line are not visible.
const MAX_FLIGHTS: usize = 400;

/// The ends of a line over time, in s and mm.
type StopLine = [[f64; 2]; 2];

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

    /// The measured quantity that it can be compared with, and the unit of its axis in SI.
    fn measured(self) -> Option<(Quantity, f64)> {
        match self {
            Self::Displacement => Some((Quantity::Displacement, 1e-3)),
            Self::Velocity => Some((Quantity::Velocity, 1e-3)),
            Self::BaseAcceleration => Some((Quantity::Acceleration, STANDARD_GRAVITY)),
            Self::Power | Self::LoadPower { .. } => None,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::Velocity => "velocity",
            Self::BaseAcceleration => "base",
            Self::Power => "power",
            Self::LoadPower { .. } => "power into the load",
        }
    }

    fn view(self) -> View {
        match self {
            Self::Displacement => View::Displacement,
            Self::Velocity => View::Velocity,
            Self::BaseAcceleration => View::BaseAcceleration,
            Self::Power | Self::LoadPower { .. } => View::Power,
        }
    }

    fn unit(self) -> &'static str {
        match self {
            Self::Displacement => "mm",
            Self::Velocity => "mm/s",
            Self::BaseAcceleration => "g",
            Self::Power => "mW",
            Self::LoadPower { unit, .. } => unit,
        }
    }

    fn stroke(self, style: &Style) -> Stroke {
        match self {
            Self::Displacement | Self::Velocity => style.motion_stroke(),
            Self::BaseAcceleration | Self::Power => style.base_stroke(),
            Self::LoadPower { .. } => style.power_stroke(),
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
    let style = context.style;
    let ends = quantity.ends(context);
    let ends = with_room(context.session, quantity.measured(), ends);
    let (low, high) = context.memory.axes.ends(Axis::Up(quantity.view()), ends);
    let now = context.session.player.time();
    let (from, to) = time_ends(context, now);
    let (window, end) = (to - from, now.min(to));
    let watch = context.session.player.watch();
    let samples = shown_samples(context.session, from, to);
    let is_displacement = quantity == TraceQuantity::Displacement;
    let paths =
        paths(&samples, is_displacement, |sample| PlotPoint::new(sample.t, quantity.value_in(watch, sample)));
    let ghosts = ghost_paths(context.session, quantity, from, end);
    let measured = MeasuredTrace::of(context.session, quantity.measured(), (from, to));
    let rests = rest_spans(&samples);
    let impacts = impact_times(watch, from, end);
    let stops = if is_displacement { stop_lines(watch, from, to) } else { Vec::new() };
    let pass = ui.ctx().cumulative_pass_nr();
    let cursor = context.memory.timeline.cursor.filter(|cursor| cursor.1 + 1 >= pass).map(|cursor| cursor.0);
    let tick = 0.035 * (high - low);
    let rows = f64::from((ui.available_height() / 40.0).clamp(2.0, 6.0));
    let columns = f64::from((ui.available_width() / 80.0).clamp(2.0, 8.0));
    let area = ui.max_rect();
    ui.painter().rect_filled(area, 0.0, style.ground());
    let entries = entries(&style, &rests, &impacts, &stops, &ghosts, measured.as_ref());
    let (axis, time_label) = axis_names(ui, quantity, &style);
    // a number at the very end of the axis would be cut off
    let edge = 0.02 * (high - low);
    let digits = 1 + decimals_for(high - low);
    let (read, unit) = (|t: f64| quantity.value_in(watch, &watch.state_at(t)), quantity.unit());
    let at_each = |t: f64| format!("{:.digits$} {unit}", read(t));
    let between = |a: f64, b: f64| format!("{:+.digits$} {unit}", read(b) - read(a));
    let readout = readout_ui(ui, context, (area, window), at_each, between);
    let plot = area.with_min_x(area.left() + MARGIN).with_min_y(area.top() + LEGEND + readout);
    // distance on the screen between two points of the plot
    let distance = |a: &PlotPoint, b: &PlotPoint| {
        let (x, y) = ((b.x - a.x) / window, (b.y - a.y) / (high - low));
        (x as f32 * plot.width()).hypot(y as f32 * plot.height())
    };
    let mut ui = plot_place(ui, &style, plot);
    let response = still_plot(quantity.name())
        .x_grid_spacer(|_| marks(&even(from.max(0.0), to - NO_NUMBER * window, columns)))
        .y_grid_spacer(|_| marks(&even(low + edge, high - edge, rows)))
        .x_axis_label(time_label)
        .y_axis_label(axis)
        .show(&mut ui, |plot| {
            plot.set_plot_bounds(PlotBounds::from_min_max([from, low], [to, high]));
            for (value, _) in even(low, high, rows).ticks {
                plot.hline(HLine::new("", value).stroke(style.grid_stroke()));
            }
            draw_rests_and_stops(plot, rests, stops, &style);
            plot.vline(VLine::new("now", now).stroke(style.ghost_stroke()));
            // the ticks stand at the edge, clear of the motion
            for t in thinned(&impacts, window) {
                let ends = vec![[t, low], [t, low + tick]];
                plot.line(Line::new("impact", ends).stroke(style.impact_stroke()));
            }
            if let Some(trace) = measured {
                trace.draw(plot, &style);
            }
            // each has its letter at its end, beside those of the others
            for (i, (place, path)) in ghosts.iter().enumerate() {
                let Some(last) = path.last().filter(|last| last.y.is_finite()) else { continue };
                let at = PlotPoint::new(last.x + LETTER * (i as f64 + 0.5) * window, last.y.clamp(low, high));
                let letter = RichText::new(PINNED[place % PINNED.len()]).font(style.small());
                plot.text(Text::new("letter", at, letter).color(style.ink()));
            }
            for (place, path) in ghosts {
                let length = path.windows(2).map(|pair| distance(&pair[0], &pair[1])).sum();
                let line = Line::new("ghost", PlotPoints::Owned(path)).stroke(style.ghost_motion_stroke());
                let line = line.style(plot_dashes(place, length));
                plot.line(line.allow_band(!is_displacement));
            }
            for path in paths {
                let line =
                    Line::new(quantity.name(), PlotPoints::Owned(path)).stroke(quantity.stroke(&style));
                // a band reaches beyond the ends of a steep line
                plot.line(line.allow_band(!is_displacement));
            }
            if let Some(t) = cursor {
                let dashed = LineStyle::dashed_dense();
                plot.vline(VLine::new("cursor", t).stroke(style.ghost_stroke()).style(dashed));
            }
        });
    let (transform, response) = (response.transform, response.response);
    axes_input(&ui, context.memory, quantity.view(), &response, (area, *transform.frame()));
    cursors_ui(&mut ui, context, &response, (*transform.frame(), (from, to)), quantity.name());
    let painter = ui.painter().with_clip_rect(area);
    let mut right = area.right();
    if let Some(at) = response.hover_pos() {
        let t = transform.value_from_position(at).x;
        let watch = context.session.player.watch();
        let t = t.clamp(watch.begin().min(now), now);
        context.memory.timeline.cursor = Some((t, pass));
        let value = quantity.value_in(watch, &watch.state_at(t));
        let at = (area.right_top() + vec2(-6.0, 0.5 * LEGEND), Align2::RIGHT_CENTER);
        let text = format!("{value:.digits$} {} at {t:.3} s", quantity.unit());
        right = haloed(&painter, &style, at, &text, (style.small(), style.ink())).left();
    }
    legend(&ui, &style, area, right, &entries);
}

/// The ends of the time axis in s, which shows the present near its end.
fn time_ends(context: &mut ViewContext<'_>, now: f64) -> (f64, f64) {
    let timeline = &mut context.memory.timeline;
    timeline.default_window = stretch(context.session.shown());
    let window = timeline.window.unwrap_or(timeline.default_window);
    let from = (now - PRESENT * window).max(-0.02 * window);
    context.memory.axes.ends(Axis::Time, (from, from + window))
}

/// The entries of the legend for what the trace shows besides the motion.
fn entries(
    style: &Style,
    rests: &[(f64, f64)],
    impacts: &[f64],
    stops: &[StopLine],
    ghosts: &[(usize, Vec<PlotPoint>)],
    measured: Option<&MeasuredTrace>,
) -> Vec<(Symbol, &'static str)> {
    let seen = [
        (!rests.is_empty(), Symbol::Shade(style.rest_shade()), "at rest on a stop"),
        (!impacts.is_empty(), Symbol::Ticks(style.impact_stroke()), "impacts"),
        (!stops.is_empty(), Symbol::Dashed(style.stop_stroke()), "stops"),
    ];
    let seen = seen.into_iter().filter(|entry| entry.0);
    let mut entries: Vec<_> = seen.map(|(_, symbol, name)| (symbol, name)).collect();
    let pinned = |place: usize| (Symbol::Dashes(style.ghost_motion_stroke(), place), PINNED[place]);
    entries.extend(ghosts.iter().map(|ghost| pinned(ghost.0)));
    entries.extend(measured.map(|trace| trace.entry(style)));
    entries
}

fn draw_rests_and_stops(plot: &mut PlotUi<'_>, rests: Vec<(f64, f64)>, stops: Vec<StopLine>, style: &Style) {
    for (begin, end) in rests {
        let span = Span::new("", begin..=end).fill(style.rest_shade());
        plot.span(span.border(Stroke::NONE));
    }
    for ends in stops {
        let line = Line::new("stop", ends.to_vec()).stroke(style.stop_stroke());
        plot.line(line.style(LineStyle::dashed_loose()));
    }
}

/// The states from `from` to `to` in s, thinned, up to the present or to what is known at `to`.
fn shown_samples(session: &Session, from: f64, to: f64) -> Vec<Sample> {
    let (watch, now) = (session.player.watch(), session.player.time());
    let (samples, end) = (watch.samples(), now.min(to));
    let first = samples.partition_point(|sample| sample.t < from).saturating_sub(1);
    let last = samples.partition_point(|sample| sample.t <= end).max(first);
    let state = if now <= to { session.player.state() } else { watch.state_at(end) };
    let stride = ((last - first) / MAX_POINTS).max(1);
    samples.range(first..last).step_by(stride).copied().chain([state]).collect()
}

/// Times of the impacts from `from` to `to` in s.
fn impact_times(watch: &Watch, from: f64, to: f64) -> Vec<f64> {
    watch
        .events()
        .iter()
        .skip(watch.events().partition_point(|event| event.t < from))
        .take_while(|event| event.t <= to)
        .filter(|event| matches!(event.kind, EventKind::Impact | EventKind::Contact))
        .map(|event| event.t)
        .collect()
}

/// Names of the vertical and of the time axis, as short as the height left in `ui` demands.
fn axis_names(ui: &Ui, quantity: TraceQuantity, style: &Style) -> (String, &'static str) {
    let axis = format!("{} ({})", quantity.name(), quantity.unit());
    let is_low = ui.available_height() < LOW;
    // a name that is longer than its axis would run into the legend
    let name = ui.painter().layout_no_wrap(axis.clone(), style.small(), style.ink()).size().x;
    let is_long = name > ui.available_height() - LEGEND - BELOW;
    let axis = if is_low || is_long { quantity.unit().to_owned() } else { axis };
    (axis, if is_low { "" } else { "time (s)" })
}

/// Paths of the displacement or the velocity of the pinned motions since they were pinned, with the indices
/// of the pins; none of another quantity.
fn ghost_paths(
    session: &Session,
    quantity: TraceQuantity,
    from: f64,
    to: f64,
) -> Vec<(usize, Vec<PlotPoint>)> {
    if !matches!(quantity, TraceQuantity::Displacement | TraceQuantity::Velocity) {
        return Vec::new();
    }
    let path = |pin: &Pin| {
        let (watch, samples) = (pin.watch(), pin.watch().samples());
        let first = samples.partition_point(|sample| sample.t < from.max(pin.since())).saturating_sub(1);
        let last = samples.partition_point(|sample| sample.t <= to).max(first);
        let stride = ((last - first) / MAX_GHOST_POINTS).max(1);
        let shown = samples.range(first..last).step_by(stride).copied().chain([pin.state_at(to)]);
        let points = shown.map(|sample| PlotPoint::new(sample.t, quantity.value_in(watch, &sample)));
        (pin.place(), points.collect())
    };
    session.pins.all().iter().map(path).collect()
}

/// The time in s that is shown by default of a motion of a model.
pub(in crate::app) fn stretch(model: &Model) -> f64 {
    let limit = MAX_SWINGS * model.natural_time();
    model
        .forcing_period()
        .map_or(SWINGS * model.characteristic_time(), |period| (PERIODS * period).min(limit))
}

/// The path as lines, without unknown values. A line has a tip beyond a point where it reverses; with
/// `flights`, each flight is therefore a separate line, which does not reach through a stop.
fn paths(samples: &[Sample], flights: bool, point: impl Fn(&Sample) -> PlotPoint) -> Vec<Vec<PlotPoint>> {
    let reverses = |pair: &&[Sample]| pair[0].t == pair[1].t;
    let line = |part: &[Sample]| part.iter().map(&point).filter(|at| !at.y.is_nan()).collect();
    if !flights || samples.windows(2).filter(reverses).count() > MAX_FLIGHTS {
        return vec![line(samples)];
    }
    let parts = samples.chunk_by(|a, b| a.t != b.t);
    parts.map(line).collect()
}

/// Lines of the stops over time; a stop that did not move is one line.
fn stop_lines(watch: &Watch, from: f64, to: f64) -> Vec<StopLine> {
    let mut lines: Vec<StopLine> = Vec::new();
    for (begin, end, model) in watch.models_between(from.max(0.0), to) {
        let (left, right) = model.stop_positions();
        for mm in [left, right].into_iter().flatten().map(|stop| stop * 1e3) {
            match lines.iter_mut().find(|line| line[1] == [begin, mm]) {
                Some(line) => line[1][0] = end,
                None => lines.push([[begin, mm], [end, mm]]),
            }
        }
    }
    lines
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

/// Times of the impacts that can be told apart on the screen.
fn thinned(times: &[f64], window: f64) -> Vec<f64> {
    let mut kept: Vec<f64> = Vec::new();
    for t in times {
        if kept.last().is_none_or(|last| t - last > window / 1000.0) {
            kept.push(*t);
        }
    }
    kept
}
