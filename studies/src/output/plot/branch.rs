//! Pictures of periodic motions: of a branch, displacement at the strobe over the field, unstable motions
//! dashed, events marked; of loci, lines over two fields.

use super::axis::{PlotAxis, Ranges};
use super::chart::{Chart, Marks, Panel};
use super::drawn::Drawn;
use super::figure::Point;
use super::role::Role;
use super::swept::swept_axis;
use crate::numeric::short;
use crate::study::{Branch, BranchEvent, Locus, LocusEvent, branches_table, loci_table};

/// The kinds of events in the order of their markers.
const EVENTS: [BranchEvent; 4] =
    [BranchEvent::Fold, BranchEvent::Flip, BranchEvent::Symmetry, BranchEvent::Grazing];

/// The picture of a branch, and of those that begin on it; `phase_deg` is the phase of their strobe in
/// degrees.
pub fn branch_chart(branches: &[Branch], phase_deg: f64, ranges: Ranges) -> Chart {
    let table = branches_table(branches);
    let field = table.columns()[1].name.as_str();
    let rows =
        || branches.iter().flat_map(|branch| branch.orbits.iter().zip(&branch.values).zip(&branch.events));
    let points: Vec<Point> = rows().map(|((orbit, value), _)| (*value, orbit.state.x * 1e3)).collect();
    let stable: Vec<bool> = rows().map(|((orbit, _), _)| orbit.is_stable()).collect();
    let firsts = branches.iter().scan(0, |before, branch| {
        *before += branch.orbits.len();
        Some(*before)
    });
    let firsts: Vec<usize> = firsts.collect();
    let up = PlotAxis::around(points.iter().map(|point| point.1), 0.08, "displacement at the strobe (mm)");
    let mut panel = Panel::new(swept_axis(&table, field, ranges.x), up.or_given(ranges.y));
    // a stable or unstable stretch ends at the point where the next one begins
    for (is_stable, role, name) in [(true, Role::Curve, "stable"), (false, Role::UnstableMotion, "unstable")]
    {
        let mut line = Vec::new();
        for (i, point) in points.iter().enumerate() {
            if firsts.contains(&i) {
                line.push((f64::NAN, f64::NAN));
            }
            if stable[i] == is_stable || (i > 0 && stable[i - 1] == is_stable && !firsts.contains(&i)) {
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
        let marked = rows().zip(&points).filter(|row| *row.0.1 == Some(event));
        let marked = marked.map(|row| *row.1).collect();
        panel.layer_if_any(Role::Event(place), event.name(), Marks::Points(marked));
    }
    let mut drawn = Drawn::new([field, "x_m"], &["stable", "event"]);
    for (((orbit, value), event), stable) in rows().zip(&stable).filter(|row| panel.x.contains(*row.0.0.1)) {
        let words = [if *stable { "true" } else { "false" }, event.map_or("", |event| event.name())];
        drawn.put("branch", &[*value, orbit.state.x], &words);
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
    let (count, periods, phase) = (points.len(), periods.join(", "), short(phase_deg));
    let about =
        format!("{count} periodic motions of period {periods}, at the drive's phase {phase}\u{b0}{end}");
    Chart::stack(vec![panel], about, drawn.table())
}

/// The picture of loci over two fields; `phase_deg` is the phase of their strobe in degrees.
pub fn loci_chart(loci: &[Locus], phase_deg: f64, ranges: Ranges) -> Chart {
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
