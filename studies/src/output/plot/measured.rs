//! Picture of a measured motion over the computed one, with a second panel that shows a part closer.

use super::axis::{PlotAxis, Ranges};
use super::chart::{Chart, Marks, Panel};
use super::drawn::Drawn;
use super::figure::Point;
use super::record::{DOTS, axis_of, parted, rms_difference};
use super::role::Role;
use crate::numeric::short;
use crate::scene::Quantity;
use crate::study::{Comparison, Trace};

/// The picture of a run from its trace, and of what was measured of this quantity over it; `inset` are the
/// times in s of the second panel, `ranges` those of the first.
pub fn measured_chart(
    trace: &Trace,
    (found, quantity): (&Comparison, Quantity),
    inset: Option<(f64, f64)>,
    ranges: Ranges,
) -> Chart {
    let column = |name: &str| trace.path.numbers(name).unwrap_or_default();
    let (scale, words, unit) = axis_of(quantity, &found.measured);
    let (name, label) = match quantity {
        Quantity::Velocity => ("v_m_per_s", format!("{words} ({unit})")),
        Quantity::Acceleration => ("base_accel_m_per_s2", format!("base {words} ({unit})")),
        _ => ("x_m", format!("{words} ({unit})")),
    };
    let scaled = |times: &[f64], values: &[f64]| -> Vec<Point> {
        let pairs = times.iter().zip(values).map(|(t, value)| (*t, value * scale));
        pairs.filter(|point| point.1.is_finite()).collect()
    };
    let computed = scaled(column("t_s"), column(name));
    let measured = scaled(&found.times, &found.measured);
    let panel = |(from, to): (f64, f64), given: Option<(f64, f64)>, closer: Option<(f64, f64)>| {
        let seen = |data: &[Point]| -> Vec<Point> {
            data.iter().copied().filter(|point| (from..=to).contains(&point.0)).collect()
        };
        let (seen_computed, seen_measured) = (seen(&computed), seen(&measured));
        let all = seen_computed.iter().chain(&seen_measured).map(|point| point.1);
        let up = PlotAxis::around(all, 0.09, &label).or_given(given);
        let mut panel = Panel::new(PlotAxis::between(from, to, "time (s)"), up);
        if let Some(times) = closer {
            panel.layer(Role::Closer, "shown closer below", Marks::Spans(vec![times]));
        }
        if quantity == Quantity::Displacement {
            panel.level_stops((trace.stops.0 * 1e3, trace.stops.1 * 1e3));
        }
        // many samples lie below the computed line, few over it
        let is_cloud = seen_measured.len() < DOTS;
        if !is_cloud {
            panel.layer(Role::Measured, "measured", Marks::Trace(parted(&measured)));
        }
        panel.layer(Role::Motion, "computed", Marks::Trace(computed.clone()));
        if is_cloud {
            panel.layer(Role::Measured, "measured", Marks::Cloud(measured.clone()));
        }
        panel
    };
    let mut panels = vec![panel(ranges.x.unwrap_or((0.0, trace.end)), ranges.y, inset)];
    panels.extend(inset.map(|times| panel(times, None, None)));
    let mut drawn = Drawn::new(["t_s", name], &[]);
    for (series, points) in [("computed", &computed), ("measured", &measured)] {
        points.iter().for_each(|(t, value)| drawn.put(series, &[*t, value / scale], &[]));
    }
    let mut words = rms_difference(found.rms, scale, unit);
    if found.shift != 0.0 {
        words += &format!("; record shifted by {} s", short(found.shift)).replace('-', "\u{2212}");
    }
    Chart::stack(panels, words, drawn.table())
}
