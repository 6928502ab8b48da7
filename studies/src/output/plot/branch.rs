//! Picture of a branch of periodic motions: displacement at the strobe over the field, unstable motions
//! dashed, events marked.

use super::axis::{PlotAxis, Ranges};
use super::chart::{Chart, Marks, Panel};
use super::drawn::Drawn;
use super::figure::Point;
use super::role::Role;
use super::swept::swept_axis;
use crate::numeric::short;
use crate::study::{Branch, BranchEvent};

/// The kinds of events in the order of their markers.
const EVENTS: [BranchEvent; 4] =
    [BranchEvent::Fold, BranchEvent::Flip, BranchEvent::Symmetry, BranchEvent::Grazing];

/// The picture of a branch; `phase_deg` is the phase of its strobe in degrees.
pub fn branch_chart(branch: &Branch, phase_deg: f64, ranges: Ranges) -> Chart {
    let table = branch.table();
    let field = table.columns()[0].name.as_str();
    let millimetres: Vec<f64> = branch.orbits.iter().map(|orbit| orbit.state.x * 1e3).collect();
    let points: Vec<Point> = branch.values.iter().copied().zip(millimetres.iter().copied()).collect();
    let stable: Vec<bool> = branch.orbits.iter().map(|orbit| orbit.is_stable()).collect();
    let up = PlotAxis::around(millimetres, 0.08, "displacement at the strobe (mm)").or_given(ranges.y);
    let mut panel = Panel::new(swept_axis(&table, field, ranges.x), up);
    // a stable or unstable stretch ends at the point where the next one begins
    for (is_stable, role, name) in [(true, Role::Curve, "stable"), (false, Role::UnstableMotion, "unstable")]
    {
        let mut line = Vec::new();
        for (i, point) in points.iter().enumerate() {
            if stable[i] == is_stable || (i > 0 && stable[i - 1] == is_stable) {
                line.push(*point);
            }
            if stable[i] != is_stable {
                line.push((f64::NAN, f64::NAN));
            }
        }
        if stable.contains(&is_stable) {
            panel.layer(role, name, Marks::Path(line));
        }
    }
    for (place, event) in EVENTS.into_iter().enumerate() {
        let marked = branch.events.iter().zip(&points).filter(|row| *row.0 == Some(event));
        let marked: Vec<Point> = marked.map(|row| *row.1).collect();
        if !marked.is_empty() {
            panel.layer(Role::Event(place), event.name(), Marks::Points(marked));
        }
    }
    let mut drawn = Drawn::new([field, "x_m"], &["stable", "event"]);
    for (i, value) in branch.values.iter().enumerate().filter(|row| panel.x.contains(*row.1)) {
        let words =
            [if stable[i] { "true" } else { "false" }, branch.events[i].map_or("", |event| event.name())];
        drawn.put("branch", &[*value, branch.orbits[i].state.x], &words);
    }
    let period = branch.orbits.first().map_or(1, |orbit| orbit.period);
    let about = format!(
        "{} periodic motions of period {period}, at the drive's phase {}\u{b0}; the branch ends {}",
        branch.orbits.len(),
        short(phase_deg),
        branch.end
    );
    Chart::stack(vec![panel], about, drawn.table())
}
