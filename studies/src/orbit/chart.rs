//! Pictures of periodic motions: of a branch, displacement at the strobe over the field, unstable motions
//! dashed, events marked; of loci, lines over two fields.

use super::{BranchAnswer, BranchEvent, LocusEvent, OneLocus, OrbitAnswer, branches_table, loci_table};
use crate::numeric::short;
use crate::output::{Chart, Drawn, Marks, Panel, PlotAxis, Point, Ranges, Role, swept_axis};

/// The picture of a branch, and of those that begin on it; `phase_deg` is the phase of their strobe in
/// degrees.
pub fn branch_chart(branches: &[BranchAnswer], phase_deg: f64, ranges: Ranges) -> Chart {
    let table = branches_table(branches);
    let field = table.columns()[1].name.as_str();
    let rows =
        || branches.iter().flat_map(|branch| branch.orbits.iter().zip(&branch.values).zip(&branch.events));
    let point = |orbit: &OrbitAnswer, value: f64| (value, orbit.state.x * 1e3);
    let heights = rows().map(|((orbit, value), _)| point(orbit, *value).1);
    let up = PlotAxis::around(heights, 0.08, "displacement at the strobe (mm)");
    let mut panel = Panel::new(swept_axis(&table, field, ranges.x), up.or_given(ranges.y));
    // a stable or unstable stretch ends at the point where the next one begins
    for (is_stable, role, name) in [(true, Role::Curve, "stable"), (false, Role::UnstableMotion, "unstable")]
    {
        let mut line: Vec<Point> = Vec::new();
        for branch in branches {
            let mut was_of_kind = false;
            for (orbit, value) in branch.orbits.iter().zip(&branch.values) {
                let is_of_kind = orbit.is_stable() == is_stable;
                line.extend((is_of_kind || was_of_kind).then(|| point(orbit, *value)));
                line.extend((!is_of_kind).then_some((f64::NAN, f64::NAN)));
                was_of_kind = is_of_kind;
            }
            line.push((f64::NAN, f64::NAN));
        }
        if line.iter().any(|point| point.0.is_finite()) {
            panel.layer(role, name, Marks::Path(line));
        }
    }
    for (place, event) in BranchEvent::ALL.into_iter().enumerate() {
        let marked = rows().filter(|(_, found)| **found == Some(event));
        let marked = marked.map(|((orbit, value), _)| point(orbit, *value)).collect();
        panel.layer_if_any(Role::Event(place), event.name(), Marks::Points(marked));
    }
    let mut drawn = Drawn::new([field, "x_m"], &["stable", "event"]);
    for ((orbit, value), event) in rows().filter(|row| panel.x.contains(*row.0.1)) {
        let stable = if orbit.is_stable() { "true" } else { "false" };
        drawn.put("branch", &[*value, orbit.state.x], &[stable, event.map_or("", BranchEvent::name)]);
    }
    let mut periods: Vec<u32> =
        branches.iter().flat_map(|branch| Some(branch.orbits.first()?.period)).collect();
    periods.sort_unstable();
    periods.dedup();
    let periods: Vec<String> = periods.iter().map(u32::to_string).collect();
    let end = match branches {
        [branch] => format!("; the branch ends {}", branch.end.name()),
        _ => format!("; {} branches", branches.len()),
    };
    let (count, periods, phase) = (rows().count(), periods.join(", "), short(phase_deg));
    let about =
        format!("{count} periodic motions of period {periods}, at the drive's phase {phase}\u{b0}{end}");
    Chart::stack(vec![panel], about, drawn.table())
}

/// The picture of loci over two fields; `phase_deg` is the phase of their strobe in degrees.
pub fn loci_chart(loci: &[OneLocus], phase_deg: f64, ranges: Ranges) -> Chart {
    let table = loci_table(loci);
    let [across, up] = [1, 2].map(|place| table.columns()[place].name.clone());
    let mut panel = Panel::new(swept_axis(&table, &across, ranges.x), swept_axis(&table, &up, ranges.y));
    let of = loci.first().map_or("", |locus| locus.of.name());
    let mut line: Vec<Point> = Vec::new();
    for locus in loci {
        line.extend(locus.values.iter().map(|[x, y]| (*x, *y)));
        line.push((f64::NAN, f64::NAN));
    }
    panel.layer(Role::Curve, of, Marks::Path(line));
    let mut place = 0;
    for event in LocusEvent::ALL {
        let rows = loci.iter().flat_map(|locus| locus.events.iter().zip(&locus.values));
        let marked: Vec<Point> =
            rows.filter(|row| *row.0 == Some(event)).map(|row| (row.1[0], row.1[1])).collect();
        if !marked.is_empty() {
            panel.layer(Role::Event(place), event.name(), Marks::Points(marked));
            place += 1;
        }
    }
    let mut drawn = Drawn::new([across.as_str(), up.as_str()], &["event"]);
    for locus in loci {
        for ([x, y], event) in locus.values.iter().zip(&locus.events).filter(|row| panel.x.contains(row.0[0]))
        {
            drawn.put(of, &[*x, *y], &[event.map_or("", LocusEvent::name)]);
        }
    }
    let motions: usize = loci.iter().map(|locus| locus.values.len()).sum();
    let events = match loci.first().map(|locus| locus.of) {
        Some(BranchEvent::Fold) => "folds",
        Some(BranchEvent::Flip) => "flips",
        Some(BranchEvent::Symmetry) => "breakings of the symmetry",
        Some(BranchEvent::Grazing) | None => "grazings",
    };
    let phase = short(phase_deg);
    let about =
        format!("{events} over two fields, {motions} periodic motions at the drive's phase {phase}\u{b0}");
    Chart::stack(vec![panel], about, drawn.table())
}
