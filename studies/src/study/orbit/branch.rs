//! Branch of periodic motions over a field.

use std::fmt;

use nalgebra::Vector3;

use super::corrector::{Corrector, Units};
use super::events::BranchEvent;
use super::walk::Walk;
use super::{NoOrbit, Orbit, map_of, orbit, with_orbits};
use crate::scene::column_names;
use crate::study::family::Family;
use crate::study::{Table, Task};

/// Why a branch ended.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum BranchEnd {
    /// At an end of the range.
    Range,
    /// It came back to where it had been.
    Closed,
    /// The motion touches a stop without speed, and no motion near to it goes on.
    Grazing,
    /// A motion that rests on its way leaps to another one: the mass, released as before, no longer goes
    /// where it went, as where it just fails to pass the barrier; or its chatter no longer ends before it is
    /// released.
    Leap,
    /// Newton's method finds no motion near the last one: it leaps, changes too fast, or ends early.
    Lost,
    /// At the most points.
    Points,
}

impl fmt::Display for BranchEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Range => "at an end of the range",
            Self::Closed => "where it had been before",
            Self::Grazing => "where the motion touches a stop without speed, and none near to it goes on",
            Self::Leap => "where the motion leaps to another one",
            Self::Lost => {
                "where no motion near the last one was found: it may leap to another, change too \
                 fast, or end early"
            }
            Self::Points => "after 5000 motions",
        })
    }
}

/// A branch: its motions in order, each with the value of the field and what happens there.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Branch {
    /// The field that changes.
    pub field: String,
    /// Its value at each motion.
    pub values: Vec<f64>,
    /// The motions.
    pub orbits: Vec<Orbit>,
    /// What happens there.
    pub events: Vec<Option<BranchEvent>>,
    /// Why the branch ended after the last.
    pub end: BranchEnd,
    /// Pairs of values between which the motion touches the stops otherwise, or its stability changes, where
    /// no event was found.
    pub unlocated: Vec<(f64, f64)>,
}

impl Branch {
    /// A row a motion: the field, what [`orbit_table`](super::orbit_table) has, and `event`.
    pub fn table(&self) -> Table {
        let column = column_names(&[&self.field]).concat();
        let table = Table::new().with(column, self.values.iter().copied().collect());
        let name = |event: &Option<BranchEvent>| event.map_or("", BranchEvent::name);
        with_orbits(table, &self.orbits).each("event", &self.events, name)
    }
}

/// The branch of periodic motions of a family over `field` from one value towards another, on from the motion
/// that a run comes to at the first; `phase` in forcing periods, `period` where one is asked for.
///
/// Ticks once a motion. An error is one of the first motion.
pub fn branch(
    family: &Family,
    field: &str,
    (from, to): (f64, f64),
    phase: f64,
    period: Option<u32>,
    task: &Task,
) -> Result<Branch, NoOrbit> {
    let model = family.model(from).map_err(|_| NoOrbit::NotConverged)?;
    let first = orbit(&model, phase, period, task.cancel)?;
    let scales = model.scales();
    let units = Units { length: scales.length, speed: scales.speed, range: (to - from).abs() };
    let map = map_of(&model, phase).ok_or(NoOrbit::NotConverged)?;
    let mirrored = Corrector::is_mirrored(&map, &first);
    let corrector = Corrector { family, phase, periods: first.period, mirrored, units };
    let upwards = Vector3::new(0.0, 0.0, (to - from).signum());
    let point = corrector.correct(corrector.at(first.state, from), &upwards).ok_or(NoOrbit::NotConverged)?;
    let along = corrector.tangent(&point, &upwards).ok_or(NoOrbit::Grazing)?;
    let branch = Branch {
        field: field.to_owned(),
        values: Vec::new(),
        orbits: Vec::new(),
        events: Vec::new(),
        end: BranchEnd::Points,
        unlocated: Vec::new(),
    };
    let mut walk = Walk::new(corrector, branch, (from, to), &model, (point, along));
    walk.branch.end = walk.run_out(task)?;
    Ok(walk.branch)
}
