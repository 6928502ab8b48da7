//! Traces over time: displacement, velocity, base acceleration, power.
//!
//! The traces are one view with several quantities. All traces show the same range of time and the same time
//! under the pointer, so that they can be read below each other. Their vertical ranges come from the scene
//! and from [`Ranges`](super::ranges::Ranges), not from what is visible.

use eframe::egui::Ui;

use crate::app::session::Session;
use crate::app::words::numbers::decimals_for;
use crate::dynamics::{EventKind, Model, Phase, STANDARD_GRAVITY, Sample, Side};
use crate::output::{Layer, Marks, OverTime, Panel, PlotAxis, Role, RunPanel, TIME};
use crate::scene::Quantity;
use interwell_studies::study::Watch;

use super::cursors::{cursors_ui, readout_ui};
use super::ghosts::REFERENCE;
use super::overlay::{Measurable, measured_trace, with_room};
use super::plot::plot_ui;
use super::ranges::room_for_push;
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
                let span = context.memory.reach(context.session);
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
    let upward = with_room(context.session, quantity.measured(), ends);
    let now = context.session.player.time();
    let timeline = &mut context.memory.timeline;
    timeline.default_window = stretch(context.session.shown());
    let window = timeline.window.unwrap_or(timeline.default_window);
    // the present is near the end of the time axis
    let from = (now - PRESENT * window).max(-0.02 * window);
    let automatic = [(from, from + window), upward];
    let [(from, to), (low, high)] = context.memory.ends(view, automatic);
    let digits = 1 + decimals_for(high - low);
    let watch = context.session.player.watch();
    let read = |t: f64| quantity.value_in(watch, &watch.state_at(t));
    let at_each = |t: f64| format!("{:.digits$} {unit}", read(t));
    let between = |a: f64, b: f64| format!("{:+.digits$} {unit}", read(b) - read(a));
    readout_ui(ui, context, to - from, at_each, between);
    let mut panel = panel(context.session, quantity, (from, to), (low, high));
    [(panel.x.low, panel.x.high), (panel.y.low, panel.y.high)] = automatic;
    let area = ui.available_rect_before_wrap();
    let plotted = plot_ui(ui, context.memory, view, &style, area, &panel);
    if let Some((t, y)) = plotted.pointed().filter(|_| !plotted.response.dragged()) {
        let t = t.clamp(watch.begin().min(now), now);
        let (curve, value) = nearest(context.session, quantity, &panel, (t, y));
        plotted.write(ui, &style, &format!("{curve}{value:.digits$} {unit} at {t:.3} s"));
    }
    if let Some((t, _)) = plotted.clicked {
        context.session.player.set_playing(false);
        context.session.player.seek(t);
    }
    cursors_ui(ui, context, &plotted, to - from, name);
}

/// The name and the value of the curve nearest to `y` at a time.
fn nearest(session: &Session, quantity: TraceQuantity, panel: &Panel, (t, y): Point) -> (String, f64) {
    let at = |watch: &Watch| quantity.value_in(watch, &watch.state_at(t));
    let value = |layer: &Layer| match (&layer.marks, layer.role) {
        (_, Role::Compared) => session.reference.apart().map(|apart| at(&apart.watch)),
        (Marks::Cloud(points) | Marks::Trace(points), Role::Measured) => {
            let by_time = |a: &&Point, b: &&Point| (a.0 - t).abs().total_cmp(&(b.0 - t).abs());
            points.iter().min_by(by_time).map(|point| point.1)
        }
        _ => None,
    };
    let others = panel.layers.iter().filter_map(|layer| Some((format!("{}: ", layer.name), value(layer)?)));
    let motion = (String::new(), at(session.player.watch()));
    let away = |curve: &(String, f64)| (curve.1 - y).abs();
    others.fold(motion, |best, other| if away(&other) < away(&best) { other } else { best })
}

/// The picture from `from` to `to` in s over this vertical axis.
fn panel(session: &Session, quantity: TraceQuantity, (from, to): Point, (low, high): Point) -> Panel {
    let (watch, now) = (session.player.watch(), session.player.time());
    // up to the present, or to what is known at the end
    let state = if now <= to { session.player.state() } else { watch.state_at(to) };
    let samples = within(watch, (from, now.min(to)), state);
    let line = |watch: &Watch, samples: &mut dyn Iterator<Item = Sample>| {
        Marks::Trace(samples.map(|sample| (sample.t, quantity.value_in(watch, &sample))).collect())
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
    let has_reference = matches!(quantity, TraceQuantity::Displacement | TraceQuantity::Velocity);
    if let Some(apart) = session.reference.apart().filter(|_| has_reference) {
        let (from, to) = (from.max(apart.since), now.min(to));
        let path = line(&apart.watch, &mut within(&apart.watch, (from, to), apart.watch.state_at(to)));
        lines.push(Layer::new(Role::Compared, REFERENCE, path));
    }
    lines.push(Layer::new(role, "", line(watch, &mut samples.clone())));
    let stable = session.shown().mechanism().landscape.equilibria.iter().filter(|point| point.stable);
    let beside = OverTime {
        time: PlotAxis::between(from, to, TIME),
        rests: (rest_spans(samples), "at rest on a stop"),
        impacts: [Side::Left, Side::Right].map(|side| impact_times(watch, side, (from, now.min(to)))),
        stops,
        wells: stable.map(|well| well.x * 1e3).collect(),
    };
    let up = PlotAxis::between(low, high, &panel.label(unit, has_load));
    panel.over_time(up, lines, &beside)
}

/// The samples of a motion from before `from` to `to` in s, and its `state` at the end. All of them: what a
/// line of so many points cannot show is left out where its pixels are known.
fn within(watch: &Watch, (from, to): Point, state: Sample) -> impl Iterator<Item = Sample> + Clone {
    let samples = watch.samples();
    let first = samples.partition_point(|sample| sample.t < from).saturating_sub(1);
    let last = samples.partition_point(|sample| sample.t <= to).max(first);
    samples.range(first..last).copied().chain([state])
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
fn rest_spans(samples: impl Iterator<Item = Sample> + Clone) -> Vec<(f64, f64)> {
    let mut spans: Vec<(f64, f64)> = Vec::new();
    for (a, b) in samples.clone().zip(samples.skip(1)).filter(|pair| pair.0.phase != Phase::Free) {
        match spans.last_mut() {
            Some(last) if last.1 == a.t => last.1 = b.t,
            _ => spans.push((a.t, b.t)),
        }
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::session::editor::Editor;

    /// The peaks of the power are those of single samples before impacts.
    #[test]
    fn a_trace_of_many_samples_leaves_none_out() {
        let mut session =
            Session::new(Editor::open("harvester").unwrap(), std::sync::Arc::new(|| ())).unwrap();
        session.player.speed = 100.0;
        while session.player.watch().samples().len() < 60_000 {
            session.player.tick(0.1);
        }
        let now = session.player.time();
        let watch = session.player.watch();
        for quantity in [TraceQuantity::Velocity, TraceQuantity::LoadPower { per_watt: 1000, unit: "mW" }] {
            let panel = panel(&session, quantity, (0.0, now), (-10.0, 10.0));
            let layers = panel.layers.iter();
            let lines: Vec<&Vec<Point>> = layers
                .filter_map(|layer| match &layer.marks {
                    Marks::Trace(points) => Some(points),
                    _ => None,
                })
                .collect();
            let [line] = lines[..] else { panic!("{}", lines.len()) };
            let all = watch.samples().iter().map(|sample| (sample.t, quantity.value_in(watch, sample)));
            assert!(line[..line.len() - 1].iter().copied().eq(all));
            assert!(line.iter().all(|point| point.1.is_finite()));
        }
    }
}
