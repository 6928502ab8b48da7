//! Measured data over a trace and over the force curve: few samples as dots, many as a broad line below.

use eframe::egui::{Painter, Shape};
use egui_plot::{Line, PlotPoint, PlotPoints, PlotUi, Points};

use crate::app::session::Session;
use crate::app::ui::style::Style;
use crate::scene::Quantity;

use super::ViewContext;
use super::chart::Chart;
use super::legend::Sign;

/// Fewer samples than this in a picture are dots.
const DOTS: usize = 400;

/// Radius in points of a dot.
const DOT: f32 = 2.6;

/// Of more samples the least and the greatest of each stretch are drawn, of which there are so many.
const STRETCHES: usize = 1500;

/// Room above and below the measured values, as a share of their range.
const ROOM: f64 = 0.05;

/// What the entry of the legend is called.
const NAME: &str = "measured";

/// The unit of an axis in SI, where it shows what was measured: the quantity that it can show, and its unit.
fn unit(session: &Session, axis: Option<(Quantity, f64)>) -> Option<f64> {
    let measured = session.measured.over.as_ref()?.record.values.quantity;
    axis.filter(|own| own.0 == measured).map(|own| own.1)
}

/// The ends of the vertical axis of a trace, with room for what was measured.
pub(super) fn with_room(
    session: &Session,
    axis: Option<(Quantity, f64)>,
    (low, high): (f64, f64),
) -> (f64, f64) {
    let Some((unit, over)) = unit(session, axis).zip(session.measured.over.as_ref()) else {
        return (low, high);
    };
    let (least, greatest) = over.record.range;
    let more = ROOM * (greatest - least);
    let added = over.added();
    (low.min((least + added - more) / unit), high.max((greatest + added + more) / unit))
}

/// What was measured in a stretch of time.
pub(super) struct MeasuredTrace {
    parts: Vec<Vec<PlotPoint>>,
    dots: bool,
}

impl MeasuredTrace {
    /// What was measured from `from` to `to` in s, where a trace shows that quantity.
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
        let parted = |i: usize| timing.is_some_and(|own| own.is_gap(times[i] - times[i - 1]));
        let stretch = ((last - first) / STRETCHES).max(1);
        let mut parts = vec![Vec::new()];
        let mut begin = first;
        while begin < last {
            let most = (begin + stretch).min(last);
            let gap = (begin + 1..most).find(|i| parted(*i));
            let end = gap.unwrap_or(most);
            if begin > first && parted(begin) {
                parts.push(Vec::new());
            }
            let by = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
            let least = (begin..end).min_by(by).unwrap_or(begin);
            let greatest = (begin..end).max_by(by).unwrap_or(begin);
            if let Some(part) = parts.last_mut() {
                part.push(point(least.min(greatest)));
                part.extend((least != greatest).then(|| point(least.max(greatest))));
            }
            begin = end;
        }
        Some(Self { parts, dots: false })
    }

    pub fn entry(&self, style: &Style) -> (Sign, &'static str) {
        entry(self.dots, style)
    }

    /// Draws it, below what is computed.
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

fn entry(dots: bool, style: &Style) -> (Sign, &'static str) {
    (if dots { Sign::Dots(style.measured()) } else { Sign::Line(style.measured_stroke()) }, NAME)
}

/// Draws the measured force over the position; its entry in the legend, where there is one.
pub(super) fn measured_force(
    painter: &Painter,
    context: &ViewContext<'_>,
    chart: &Chart,
) -> Option<(Sign, &'static str)> {
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
        // nearer to each other than a point they are not told apart
        points.dedup_by(|next, own| next.distance(*own) < 1.0);
        painter.add(Shape::line(points, style.measured_stroke()));
    }
    Some(entry(dots, &style))
}
