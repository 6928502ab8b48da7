//! Measured data over traces and the force curve: few samples as dots, many as a broad line.

use eframe::egui::{Painter, Shape};
use egui_plot::{Line, PlotPoint, PlotPoints, PlotUi, Points};

use crate::app::session::Session;
use crate::app::ui::style::Style;
use crate::scene::Quantity;

use super::ViewContext;
use super::chart::Chart;
use super::legend::Symbol;

/// Number of samples in a picture below which they are drawn as dots.
const DOTS: usize = 400;

/// Radius in points of a dot.
const DOT: f32 = 2.6;

/// Number of intervals into which more samples are divided, of which each shows its smallest and largest one.
const INTERVALS: usize = 1500;

/// Room above and below the measured values, as a share of their range.
const ROOM: f64 = 0.05;

/// Name of the legend entry.
const NAME: &str = "measured";

/// The unit of an axis in SI. `None` unless the axis shows the measured quantity.
fn unit(session: &Session, axis: Option<(Quantity, f64)>) -> Option<f64> {
    let measured = session.measured.over.as_ref()?.record.values.quantity;
    axis.filter(|shown| shown.0 == measured).map(|shown| shown.1)
}

/// The ends of the vertical axis of a trace, widened to hold the measured values.
pub(super) fn with_room(
    session: &Session,
    axis: Option<(Quantity, f64)>,
    (low, high): (f64, f64),
) -> (f64, f64) {
    let Some((unit, over)) = unit(session, axis).zip(session.measured.over.as_ref()) else {
        return (low, high);
    };
    let (smallest, largest) = over.record.range;
    let margin = ROOM * (largest - smallest);
    let added = over.added();
    (low.min((smallest + added - margin) / unit), high.max((largest + added + margin) / unit))
}

/// Measured values over a range of time, as they are drawn.
pub(super) struct MeasuredTrace {
    parts: Vec<Vec<PlotPoint>>,
    dots: bool,
}

impl MeasuredTrace {
    /// The values measured from `from` to `to` in s. `None` if the trace shows another quantity.
    pub fn of(session: &Session, axis: Option<(Quantity, f64)>, (from, to): (f64, f64)) -> Option<Self> {
        let unit = unit(session, axis)?;
        let over = session.measured.over.as_ref()?;
        let (times, values) = (&over.record.across.values, &over.record.values.values);
        let first = times.partition_point(|t| over.time(*t) < from).saturating_sub(1);
        let last = (times.partition_point(|t| over.time(*t) <= to) + 1).min(times.len());
        let point = |i: usize| PlotPoint::new(over.time(times[i]), (values[i] + over.added()) / unit);
        if last.saturating_sub(first) < DOTS {
            return Some(Self { parts: vec![(first..last).map(point).collect()], dots: true });
        }
        let timing = over.record.timing.as_ref();
        let follows_gap = |i: usize| timing.is_some_and(|timing| timing.is_gap(times[i] - times[i - 1]));
        let length = ((last - first) / INTERVALS).max(1);
        let mut parts = vec![Vec::new()];
        let mut begin = first;
        while begin < last {
            let limit = (begin + length).min(last);
            let gap = (begin + 1..limit).find(|i| follows_gap(*i));
            let end = gap.unwrap_or(limit);
            if begin > first && follows_gap(begin) {
                parts.push(Vec::new());
            }
            let by = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
            let smallest = (begin..end).min_by(by).unwrap_or(begin);
            let largest = (begin..end).max_by(by).unwrap_or(begin);
            if let Some(part) = parts.last_mut() {
                part.push(point(smallest.min(largest)));
                part.extend((smallest != largest).then(|| point(smallest.max(largest))));
            }
            begin = end;
        }
        Some(Self { parts, dots: false })
    }

    pub fn entry(&self, style: &Style) -> (Symbol, &'static str) {
        entry(self.dots, style)
    }

    /// Draws the values, below the computed line.
    pub fn draw(self, plot: &mut PlotUi<'_>, style: &Style) {
        for part in self.parts {
            let points = PlotPoints::Owned(part);
            match self.dots {
                true => plot.points(Points::new(NAME, points).radius(DOT).color(style.measured())),
                false => {
                    plot.line(Line::new(NAME, points).stroke(style.measured_stroke()).allow_band(false));
                }
            }
        }
    }
}

fn entry(dots: bool, style: &Style) -> (Symbol, &'static str) {
    (if dots { Symbol::Dots(style.measured()) } else { Symbol::Line(style.measured_stroke()) }, NAME)
}

/// Draws the measured force over position. Returns its legend entry, or `None` if no force was measured.
pub(super) fn measured_force(
    painter: &Painter,
    context: &ViewContext<'_>,
    chart: &Chart,
) -> Option<(Symbol, &'static str)> {
    let over = context.session.measured.over.as_ref()?;
    let record = &over.record;
    if record.values.quantity != Quantity::Force {
        return None;
    }
    let style = context.style;
    let samples = record.across.values.iter().zip(&record.values.values);
    let mut points: Vec<_> =
        samples.map(|(x, force)| chart.screen_from_world(*x + over.offset, *force)).collect();
    let dots = points.len() < DOTS;
    if dots {
        painter.extend(points.into_iter().map(|at| Shape::circle_filled(at, DOT, style.measured())));
    } else {
        // points closer than one screen point are merged
        points.dedup_by(|next, last| next.distance(*last) < 1.0);
        painter.add(Shape::line(points, style.measured_stroke()));
    }
    Some(entry(dots, &style))
}
