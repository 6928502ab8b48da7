//! Picture of a branch of periodic motions: displacement at the strobe over the field, unstable motions
//! dashed, events marked.

use super::axis::{PlotAxis, Ranges};
use super::drawn::Drawn;
use super::figure::{Figure, Point};
use super::frame::Frame;
use super::mark::{Caption, Marker, Sample, marker};
use super::style::{self, Theme};
use super::swept::{LEAST, LEFT, below_legend, swept_axis};
use crate::numeric::short;
use crate::study::{Branch, BranchEvent};

/// The kinds of events with their markers.
const EVENTS: [(BranchEvent, Marker); 4] = [
    (BranchEvent::Fold, Marker::Triangle),
    (BranchEvent::Flip, Marker::Diamond),
    (BranchEvent::Symmetry, Marker::Square),
    (BranchEvent::Grazing, Marker::DoubleArrow),
];

/// The picture of a branch; `phase_deg` is the phase of its strobe in degrees.
pub fn branch_figure(
    branch: &Branch,
    phase_deg: f64,
    ranges: Ranges,
    caption: &Caption,
    theme: &Theme,
) -> Figure {
    let mut figure = Figure::new(theme, caption, LEAST);
    let table = branch.table();
    let millimetres: Vec<f64> = branch.orbits.iter().map(|orbit| orbit.state.0 * 1e3).collect();
    let points: Vec<Point> = branch.values.iter().copied().zip(millimetres.iter().copied()).collect();
    let stable: Vec<bool> = branch.orbits.iter().map(|orbit| orbit.is_stable()).collect();
    let mut entries = Vec::new();
    if stable.contains(&true) {
        entries.push((Sample::Line(theme.ink, style::LINE, None), "stable"));
    }
    if stable.contains(&false) {
        entries.push((Sample::Line(theme.unstable, style::LINE, Some(style::DASH)), "unstable"));
    }
    for (event, shape) in EVENTS.into_iter().filter(|kind| branch.events.contains(&Some(kind.0))) {
        entries.push((Sample::Marker(shape, theme.soft), event.name()));
    }
    let top = below_legend(&mut figure, theme, &entries);
    let y_label = "displacement at the strobe, mm";
    let across = swept_axis(&table, &table.columns()[0].name, ranges.x);
    let up = PlotAxis::around(millimetres, 0.08, 6, y_label).or_given(ranges.y, 6, y_label);
    let frame = Frame::whole(&figure, (LEFT, top), across, up);
    frame.grid(&mut figure, theme);
    // a stable or unstable stretch ends at the point where the next one begins
    let mut from = 0;
    for to in 1..=points.len() {
        if to < points.len() && stable[to] == stable[from] {
            continue;
        }
        let stretch = &points[from..=to.min(points.len() - 1)];
        if stable[from] {
            frame.line(&mut figure, stretch, style::LINE, theme.ink);
        } else {
            frame.dashed(&mut figure, stretch, style::LINE, theme.unstable, style::DASH);
        }
        from = to;
    }
    for (event, point) in branch.events.iter().zip(&points) {
        let shape = event.and_then(|event| EVENTS.iter().find(|known| known.0 == event));
        let at = frame.place(*point);
        if let Some((_, shape)) = shape.filter(|_| frame.area.contains(at)) {
            marker(&mut figure, *shape, at, style::MARKER, theme.soft, theme.ink);
        }
    }
    frame.axes(&mut figure, theme);
    let mut drawn = Drawn::new([table.columns()[0].name.as_str(), "x_m"], &["stable", "event"]);
    for (i, value) in branch.values.iter().enumerate() {
        if (frame.x.low..=frame.x.high).contains(value) {
            let words =
                [if stable[i] { "true" } else { "false" }, branch.events[i].map_or("", |event| event.name())];
            drawn.put("branch", &[*value, branch.orbits[i].state.0], &words);
        }
    }
    figure.data = drawn.table();
    let period = branch.orbits.first().map_or(1, |orbit| orbit.period);
    let about = format!(
        "{} periodic motions of period {period}, at the drive's phase {}\u{b0}; the branch ends {}",
        branch.orbits.len(),
        short(phase_deg),
        branch.end
    );
    caption.draw(&mut figure, theme, &about, LEFT);
    figure
}
