//! Loci: where an orbit folds, doubles its period, breaks its symmetry or grazes, over two fields.
//!
//! The unknowns of a locus are the state at the strobe and both fields, the equations those of a periodic
//! orbit and the characteristic polynomial of its map at 1 or -1 (Kuznetsov 2004, section 10.3.2, in the form
//! with the determinant). Of a grazing they are the time of the touch, the state of the circuit then and both
//! fields, and the equations those of the flight from the touch to itself. Both are followed by
//! pseudo-arclength.

mod curve;
mod walk;

use std::str::FromStr;

use serde::Deserialize;

use super::{BranchAnswer, BranchEvent, BranchOptions, NoOrbit, OrbitAnswer, SAME, with_orbits};
use crate::scene::column_names;
use crate::study::{Family, Table, Task, number};
use curve::Curve;
use walk::Walk;

words! {
    /// A point of a locus at which two conditions hold.
    LocusEvent {
        /// Two loci of folds meet, tangent to each other.
        Cusp = "cusp",
        /// One multiplier is 1, another -1.
        FoldFlip = "fold-flip",
        /// The orbit grazes a stop, and a multiplier of the orbit without the touch is 1.
        GrazingFold = "grazing-fold",
        /// The orbit grazes a stop, and a multiplier of the orbit without the touch is -1.
        GrazingFlip = "grazing-flip",
        /// A symmetric orbit grazes both stops where its symmetry breaks.
        GrazingSymmetry = "grazing-symmetry",
        /// The orbit grazes a stop, or both, at two instants.
        GrazingTwice = "grazing-grazing",
    }
}

words! {
    /// Where and why a locus ended.
    #[non_exhaustive]
    LocusEnd {
        /// At an end of a range.
        Range = "at an end of a range",
        /// At a point where it had been before.
        Closed = "where it had been before",
        /// The orbit grazes a stop, or grazes once more: the condition no longer is one on a smooth map.
        Grazing = "where it meets a locus of grazing",
        /// Beside the first values of the fields the scene is not its own mirror image.
        Unmirrored = "at once: beside these values the scene is not its own mirror image, so that no motion \
                      breaks a symmetry",
        /// Newton's method finds no point near the last one.
        Lost = "where no motion near the last one was found",
        /// The largest number of points was reached.
        Points = "after the largest number of motions",
    }
}

/// A locus over two fields: its orbits in order, each with both values and an event, if any.
///
/// It is a part of the answer of the question [`Locus`](crate::questions::Locus). Values are in the units of
/// the fields.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OneLocus {
    /// The kind of event at every point.
    pub of: BranchEvent,
    /// The fields.
    pub fields: [String; 2],
    /// Their values at each orbit.
    pub values: Vec<[f64; 2]>,
    /// The orbits.
    pub orbits: Vec<OrbitAnswer>,
    /// The event at each orbit, if any.
    pub events: Vec<Option<LocusEvent>>,
    /// Why the locus ended.
    pub end: LocusEnd,
}

/// One row per orbit: the number of the locus from 1, both fields, the columns of
/// [`OrbitAnswer::table`], and `event`.
pub fn loci_table(loci: &[OneLocus]) -> Table {
    let Some(first) = loci.first() else { return Table::new() };
    let numbers = loci.iter().enumerate().flat_map(|(i, locus)| vec![Some(i as u64 + 1); locus.orbits.len()]);
    let mut table = Table::new().with("locus", numbers.collect());
    let names = column_names(&[&first.fields[0], &first.fields[1]]);
    for (place, name) in names.iter().enumerate() {
        let values = loci.iter().flat_map(|locus| locus.values.iter().map(move |values| values[place]));
        table = table.with(name.clone(), values.collect());
    }
    let orbits: Vec<OrbitAnswer> = loci.iter().flat_map(|locus| locus.orbits.iter().cloned()).collect();
    let events: Vec<_> = loci.iter().flat_map(|locus| locus.events.iter().copied()).collect();
    with_orbits(table, &orbits).each("event", &events, |event| event.map_or("", LocusEvent::name))
}

/// A field, and the value from which it is followed towards another.
///
/// The values are in the unit of the field, which is given by its dotted path.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct FieldRange {
    /// The field.
    pub field: String,
    /// The values.
    pub range: (f64, f64),
}

impl FromStr for FieldRange {
    type Err = String;

    /// Reads `FIELD=FROM:TO`; the error says so.
    fn from_str(text: &str) -> Result<Self, String> {
        let end = number("write FIELD=FROM:TO, such as excitation.amplitude_g=0.5:2");
        let (field, range) = text.split_once('=').unwrap_or((text, ""));
        let (from, to) = range.split_once(':').unwrap_or((range, ""));
        Ok(Self { field: field.trim().to_owned(), range: (end(from)?, end(to)?) })
    }
}

/// The loci that begin at the events `of` of a branch, which was followed over `range` at the first value of
/// the second field. An event on a locus before begins none. A locus that cannot be followed has the event
/// alone.
///
/// Ticks once per orbit.
pub fn loci(
    family: &Family,
    branch: &BranchAnswer,
    range: (f64, f64),
    (of, second): (BranchEvent, &FieldRange),
    options: &BranchOptions,
    task: &Task,
) -> Result<Vec<OneLocus>, NoOrbit> {
    task.unless_cancelled(|| {
        let mut found: Vec<OneLocus> = Vec::new();
        for (place, event) in branch.events.iter().enumerate() {
            let value = branch.values[place];
            let unit = (range.1 - range.0).abs();
            let starts_at =
                |values: &[f64; 2]| values[1] == second.range.0 && (values[0] - value).abs() <= SAME * unit;
            let is_known = || found.iter().any(|locus| locus.values.iter().any(starts_at));
            if *event != Some(of) || is_known() {
                continue;
            }
            let orbit = &branch.orbits[place];
            let locus = OneLocus {
                of,
                fields: [branch.field.clone(), second.field.clone()],
                values: Vec::new(),
                orbits: Vec::new(),
                events: Vec::new(),
                end: LocusEnd::Lost,
            };
            let begun = Curve::new(family, orbit, value, range, (of, second), options, task.cancel);
            let mut locus = match begun {
                Ok((curve, start)) => {
                    let ranges = [range, second.range];
                    Walk { curve, locus, at: start, ranges, options: *options }.run_out(task)?
                }
                Err(end) => OneLocus { end, ..locus },
            };
            if locus.orbits.is_empty() {
                locus.values.push([value, second.range.0]);
                locus.orbits.push(orbit.clone());
                locus.events.push(None);
            }
            found.push(locus);
        }
        Ok(found)
    })
}
