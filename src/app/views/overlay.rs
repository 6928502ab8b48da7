//! Measured data over traces and the force curve: few samples as dots, many as a broad line.

use crate::app::session::Session;
use crate::output::{Layer, Marks, Role};
use crate::scene::Quantity;

use super::zoom::Ends;

/// Number of samples in a picture below which they are drawn as dots.
const DOTS: usize = 400;

/// Room above and below the measured values, as a share of their range.
const ROOM: f64 = 0.05;

/// Name of the legend entry.
const NAME: &str = "measured";

/// The quantity of an axis and its unit in SI; `None` for one that is not measured.
pub(super) type Measurable = Option<(Quantity, f64)>;

/// The unit of an axis in SI. `None` unless the axis shows the measured quantity.
fn unit(session: &Session, axis: Measurable) -> Option<f64> {
    let measured = session.measured.over.as_ref()?.record.values.quantity;
    axis.filter(|shown| shown.0 == measured).map(|shown| shown.1)
}

/// The ends of the vertical axis of a trace, widened to hold the measured values.
pub(super) fn with_room(session: &Session, axis: Measurable, (low, high): Ends) -> Ends {
    let Some((unit, over)) = unit(session, axis).zip(session.measured.over.as_ref()) else {
        return (low, high);
    };
    let (smallest, largest) = over.record.range;
    let margin = ROOM * (largest - smallest);
    let added = over.added();
    (low.min((smallest + added - margin) / unit), high.max((largest + added + margin) / unit))
}

/// The values measured from `from` to `to` in s. `None` if the trace shows another quantity.
pub(super) fn measured_trace(session: &Session, axis: Measurable, (from, to): Ends) -> Option<Layer> {
    let unit = unit(session, axis)?;
    let over = session.measured.over.as_ref()?;
    let (times, values) = (&over.record.across.values, &over.record.values.values);
    let first = times.partition_point(|t| over.time(*t) < from).saturating_sub(1);
    let last = (times.partition_point(|t| over.time(*t) <= to) + 1).min(times.len());
    let point = |i: usize| (over.time(times[i]), (values[i] + over.added()) / unit);
    let timing = over.record.timing.as_ref();
    let follows_gap =
        |i: usize| i > first && timing.is_some_and(|timing| timing.is_gap(times[i] - times[i - 1]));
    let parted = |i: usize| follows_gap(i).then_some((f64::NAN, f64::NAN)).into_iter().chain([point(i)]);
    let points: Vec<(f64, f64)> = (first..last).flat_map(parted).collect();
    let marks = if last.saturating_sub(first) < DOTS { Marks::Cloud(points) } else { Marks::Trace(points) };
    Some(Layer::new(Role::Measured, NAME, marks))
}

/// The measured force over position. `None` if no force was measured.
pub(super) fn measured_force(session: &Session) -> Option<Layer> {
    let over = session.measured.over.as_ref().filter(|over| over.is_force())?;
    let samples = over.record.across.values.iter().zip(&over.record.values.values);
    let points: Vec<_> = samples.map(|(x, force)| ((x + over.offset) * 1e3, *force)).collect();
    let marks = if points.len() < DOTS { Marks::Cloud(points) } else { Marks::Path(points) };
    Some(Layer::new(Role::Measured, NAME, marks))
}
