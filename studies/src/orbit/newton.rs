//! Periodic orbits, by Newton's method on the stroboscopic map, and their branches over a field.
//!
//! A periodic orbit of n forcing periods is a fixed point of the map from a state to the state n periods
//! later ([`StroboscopicMap`]). Its Floquet multipliers are the eigenvalues of the derivative of that map,
//! two or, beside a circuit, three; it is stable if all are inside the unit circle. After a rest on a stop
//! the motion no longer depends on the state before it, so that all are 0, except one beside a circuit, whose
//! state continues.
//!
//! [`orbit_near`] finds the orbit near a state, [`branch()`] follows it over a field.

use std::sync::atomic::AtomicBool;

use nalgebra::Vector4;

use super::begin::{Begin, begun};
use super::corrector::{Corrector, Units};
use super::events::{self, BranchEvent};
use super::grazing;
use super::walk::Walk;
use crate::dynamics::{
    CircuitState, Event, EventKind, Jacobian, MapState, Model, Multiplier, Outcome, Passage, StroboscopicMap,
};
use crate::scene::column_names;
use crate::study::{Cancelled, Family, Table, Task, Values};

const MAX_STEPS: usize = 40;

/// Longest step, as a share of the scales, since the guess should be near the orbit.
const LONGEST_STEP: f64 = 0.2;

/// Residual, as a share of the scales, at which the method may have converged.
const CLOSE: f64 = 1e-9;
/// Step, as a share of the scales, at which the method has converged.
const SMALLEST_STEP: f64 = 1e-13;

/// Distance below which two states belong to the same orbit, as a share of the scales.
pub(super) const SAME: f64 = 1e-6;

/// Largest distance of a motion from its state after its period, as a share of the scales, per stretching of
/// the map by the state: a hundred times that at which the points of a branch are accepted.
const RETURN: f64 = 1e-8;

/// Largest tolerance at which the map is computed. It is close to rounding, since derivatives by a field are
/// difference quotients and events on a branch are located to 1e-8.
const TOLERANCE: f64 = 1e-14;

/// A periodic orbit.
///
/// It is the answer of the question [`Orbit`](crate::questions::Orbit), and a point of a branch. Its state is
/// in m and m/s, that of a circuit in A or V. [`multipliers`](Self::multipliers) are the eigenvalues of its
/// Jacobian: it is stable if all lie within the unit circle.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OrbitAnswer {
    /// Its period in forcing periods.
    pub period: u32,
    /// Its state at the phase of the map.
    pub state: MapState,
    /// Its events over a period.
    pub passage: Passage,
    /// Derivative of the map over its period.
    pub jacobian: Jacobian,
    /// The kind of its electrical state; `None` without a circuit.
    pub circuit: Option<CircuitState>,
}

/// Why no periodic orbit was found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoOrbit {
    /// Newton's method has not converged.
    #[error("Newton's method finds no periodic motion near that of the run")]
    NotConverged,
    /// The motion touches a stop without speed, where the map has no derivative.
    #[error("the motion touches a stop without speed, where it has no derivative; change the scene a little")]
    Grazing,
    /// The motion does not last for the period.
    #[error("the motion ends early ({}){}", .0.name(), ended_at(*.0))]
    Ended(Outcome),
    /// The orbit found has not the requested period, but this shorter one in forcing periods.
    #[error("near the motion of the run is only one of period {0}")]
    Shorter(u32),
    /// The motion found does not come back to its state.
    #[error("the motion found does not repeat when it is integrated over its whole period")]
    Unrepeated,
    /// The run does not settle on a motion that repeats.
    #[error(
        "the run comes to no motion that repeats after at most 12 forcing periods; name a period, or start \
         elsewhere"
    )]
    NotSettled,
    /// No start leads to the motion that is meant.
    #[error(
        "no motion of period {period} with impacts = {impacts} was found from {starts} starts; give its state"
    )]
    NotFound {
        /// Number of starts tried.
        starts: u32,
        /// Its period in forcing periods.
        period: u32,
        /// Its impacts.
        impacts: u64,
    },
    /// It was cancelled.
    #[error("it was cancelled")]
    Cancelled,
}

impl From<Cancelled> for NoOrbit {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// Why there is no orbit where the motion ends early.
pub(super) fn ended(outcome: Outcome) -> NoOrbit {
    match outcome {
        Outcome::Cancelled { .. } => NoOrbit::Cancelled,
        outcome => NoOrbit::Ended(outcome),
    }
}

fn ended_at(outcome: Outcome) -> String {
    outcome.ended_at().map_or(String::new(), |at| format!(", {at} s after the drive's phase 0"))
}

impl OrbitAnswer {
    /// Floquet multipliers by falling magnitude: two, or three beside a circuit.
    pub fn multipliers(&self) -> Vec<Multiplier> {
        if self.passage.rested && self.jacobian.size() == 3 {
            // after the release only the circuit's state depends on the state before the rest
            let nothing = Multiplier { re: 0.0, im: 0.0 };
            return vec![Multiplier { re: self.jacobian.trace(), im: 0.0 }, nothing, nothing];
        }
        self.jacobian.multipliers(self.determinant())
    }

    /// Product of the multipliers.
    pub fn determinant(&self) -> f64 {
        self.passage.determinant.unwrap_or_else(|| self.jacobian.determinant())
    }

    pub(super) fn events_at_stops(&self) -> impl Iterator<Item = &Event> {
        self.passage.events.iter().filter(|event| event.kind != EventKind::Crossing)
    }

    /// Events at the stops in their order on the orbit. Only the first impact of a chattering sequence that
    /// ends in rest is kept, since the later ones are summed and their number is arbitrary.
    pub fn contacts(&self) -> Vec<Event> {
        let mut all: Vec<Event> = self.events_at_stops().copied().collect();
        // so that no chattering sequence is split
        if let Some(place) = all.iter().position(|event| event.kind == EventKind::Release) {
            all.rotate_left(place);
        }
        let mut kept: Vec<Event> = Vec::new();
        for event in all {
            let hits = |other: &Event| (other.kind, other.side) == (EventKind::Impact, event.side);
            if event.kind == EventKind::Rest {
                while kept.len() > 1 && kept[kept.len() - 2..].iter().all(hits) {
                    kept.pop();
                }
            }
            kept.push(event);
        }
        kept
    }

    /// Speed in m/s of the slowest of the [`contacts`](Self::contacts) that are impacts; `None` without one.
    pub fn gentlest_impact(&self) -> Option<f64> {
        let hits = |event: &Event| matches!(event.kind, EventKind::Impact | EventKind::Contact);
        let all = self.contacts().into_iter().filter(hits);
        all.map(|event| event.v_in.abs()).reduce(f64::min)
    }

    /// Whether the motion from the state comes back to it after the period, with the contacts that the orbit
    /// has. The map is that of the phase of its state.
    pub(super) fn comes_back(&self, map: &StroboscopicMap) -> bool {
        let passage = map.pass(self.state, self.period);
        let units = Units::of(map.model(), 1.0);
        let rows = self.jacobian.in_units(units.of_state());
        let stretch =
            rows.rows().as_flattened().iter().fold(1.0, |largest: f64, slope| largest.max(slope.abs()));
        let off = largest(units.apart(self.state, (&passage).into()));
        let (is_done, slowest) = (passage.outcome == Outcome::Done, grazing::GENTLEST * units.speed);
        // rounding decides whether a motion touches a stop that it grazes
        let again = Self { passage, ..self.clone() };
        is_done && off <= RETURN * stretch && !events::differ_above(self, &again, slowest)
    }

    /// One row: period, state, multipliers and what happens on the motion.
    pub fn table(&self) -> Table {
        with_orbits(Table::new(), std::slice::from_ref(self))
    }

    /// Whether the orbit is stable.
    pub fn is_stable(&self) -> bool {
        self.multipliers()[0].magnitude() < 1.0
    }
}

/// Whether an orbit is stable; `None` where rounding decides, as with a multiplier of 1 or -1.
fn stability(orbit: &OrbitAnswer) -> Option<bool> {
    let largest = orbit.multipliers()[0].magnitude();
    ((largest - 1.0).abs() > 1e-9).then_some(largest < 1.0)
}

/// The nearest state between rigid stops and on the force curve.
pub(super) fn allowed(model: &Model, state: MapState) -> MapState {
    let depth = if model.compliant().is_some() { f64::INFINITY } else { 0.0 };
    let (x, v) = model.held_within((state.x, state.v), depth);
    MapState { x, v, ..state }
}

/// The stroboscopic map of a model, exact enough for its derivatives; `None` if the drive has no period.
pub(super) fn map_of<'a>(model: &Model, phase: f64, cancel: &'a AtomicBool) -> Option<StroboscopicMap<'a>> {
    let model = model.with_tolerance(model.tolerance().min(TOLERANCE));
    model.stroboscopic_map(phase).map(|map| map.cancelled_by(cancel))
}

/// The periodic orbit near a state at the phase of the map, such as `(x, v)` without a circuit, by Newton's
/// method. Its period is `periods` forcing periods, at least 1, or a divisor.
pub fn orbit_near(
    map: &StroboscopicMap,
    guess: impl Into<MapState>,
    periods: u32,
) -> Result<OrbitAnswer, NoOrbit> {
    let units = Units::of(map.model(), 1.0);
    let mut state = allowed(map.model(), guess.into());
    let mut best = f64::INFINITY;
    for _ in 0..MAX_STEPS {
        let (passage, jacobian) = map.pass_with_jacobian(state, periods);
        if passage.outcome != Outcome::Done {
            return Err(ended(passage.outcome));
        }
        if !jacobian.is_finite() {
            return Err(NoOrbit::Grazing);
        }
        let off = units.apart(state, (&passage).into());
        let Some(step) = newton_step(&jacobian.in_units(units.of_state()), off) else {
            return Err(NoOrbit::NotConverged);
        };
        let length = largest(step);
        if largest(off) <= CLOSE && (length <= SMALLEST_STEP || length >= 0.5 * best) {
            let circuit = map.model().circuit_state();
            return shortest(map, OrbitAnswer { period: periods, state, passage, jacobian, circuit });
        }
        if !length.is_finite() {
            return Err(NoOrbit::NotConverged);
        }
        best = best.min(length);
        let share = (LONGEST_STEP / length).min(1.0);
        state = allowed(map.model(), units.moved(state, step.map(|part| share * part)));
    }
    Err(NoOrbit::NotConverged)
}

fn largest(change: [f64; 3]) -> f64 {
    change.iter().fold(0.0, |largest, part| part.abs().max(largest))
}

/// The step of Newton's method to a fixed point of a map with these derivatives, which is `off` at present:
/// (1 - J) step = off. `None` where the matrix is singular.
pub(crate) fn newton_step(jacobian: &Jacobian, off: [f64; 3]) -> Option<[f64; 3]> {
    jacobian.newton_step(off)
}

/// The same orbit with its shortest period.
fn shortest(map: &StroboscopicMap, orbit: OrbitAnswer) -> Result<OrbitAnswer, NoOrbit> {
    let units = Units::of(map.model(), 1.0);
    let divisors = (1..orbit.period).filter(|period| orbit.period.is_multiple_of(*period));
    for period in divisors {
        let (passage, jacobian) = map.pass_with_jacobian(orbit.state, period);
        if passage.outcome != Outcome::Done {
            return Err(ended(passage.outcome));
        }
        let off = largest(units.apart(orbit.state, (&passage).into()));
        if off <= CLOSE {
            return Ok(OrbitAnswer { period, passage, jacobian, ..orbit });
        }
        // near a doubling both orbits exist
        if off <= SAME
            && let Ok(shorter) = orbit_near(map, orbit.state, period)
        {
            return Ok(shorter);
        }
    }
    Ok(orbit)
}

/// The table with the columns of [`OrbitAnswer::table`], one row per orbit.
pub(super) fn with_orbits(table: Table, orbits: &[OrbitAnswer]) -> Table {
    let part = |number: usize, of: fn(&Multiplier) -> f64| {
        move |orbit: &OrbitAnswer| orbit.multipliers().get(number).map(of)
    };
    let table = table
        .each("period", orbits, |orbit| Some(u64::from(orbit.period)))
        .each("x_m", orbits, |orbit| orbit.state.x)
        .each("v_m_per_s", orbits, |orbit| orbit.state.v);
    let circuit = orbits.first().and_then(|orbit| orbit.circuit);
    let mut table = match circuit {
        Some(CircuitState::Current) => table.each("current_a", orbits, |orbit| orbit.state.electrical),
        Some(CircuitState::Voltage) => table.each("voltage_v", orbits, |orbit| orbit.state.electrical),
        None => table,
    };
    for place in 0..if circuit.is_some() { 3 } else { 2 } {
        let name = |ending: &str| format!("multiplier_{}_{ending}", place + 1);
        table = table.each(&name("re"), orbits, part(place, |multiplier| multiplier.re)).each(
            &name("im"),
            orbits,
            part(place, |multiplier| multiplier.im),
        );
    }
    table
        .each("stable", orbits, stability)
        .each("impacts", orbits, |orbit| Some(orbit.passage.impacts))
        .each("rests", orbits, |orbit| Some(orbit.passage.rests()))
        .each("gentlest_impact_m_per_s", orbits, |orbit| orbit.gentlest_impact())
        .each("nearest_miss_m", orbits, |orbit| orbit.passage.nearest_miss())
}

words! {
    /// Where and why a branch ended.
    #[non_exhaustive]
    BranchEnd {
        /// At an end of the range.
        Range = "at an end of the range",
        /// At a point where it had been before.
        Closed = "where it had been before",
        /// The orbit grazes a stop, and no orbit was found beyond the grazing.
        Grazing = "where the motion touches a stop without speed, and none near to it goes on",
        /// An orbit with a rest changes discontinuously, for example because the mass just fails to pass the
        /// barrier, or because a chattering sequence no longer ends before the release.
        Leap = "where the motion leaps to another one",
        /// Newton's method finds no orbit near the last one.
        Lost = "where no motion near the last one was found: it may leap to another, change too fast, or end \
                early",
        /// The largest number of points was reached.
        Points = "after the largest number of motions",
        /// The orbits become those of half their period.
        Joined = "where its motions become those of half the period",
    }
}

/// A branch: its orbits in order, each with the value of the field and an event, if any.
///
/// It is the answer of the question [`Branch`](crate::questions::Branch). Values are in the unit of the
/// field; around a fold they turn back.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BranchAnswer {
    /// The field that changes.
    pub field: String,
    /// Its value at each orbit.
    pub values: Vec<f64>,
    /// The orbits.
    pub orbits: Vec<OrbitAnswer>,
    /// The event at each orbit, if any.
    pub events: Vec<Option<BranchEvent>>,
    /// Why the branch ended.
    pub end: BranchEnd,
    /// Pairs of values between which contacts with the stops or the stability change without a located event.
    pub unlocated: Vec<(f64, f64)>,
    /// Values of events at which another branch begins that was searched for and not found.
    pub unbegun: Vec<f64>,
}

impl BranchAnswer {
    /// One row per orbit: the field, the columns of [`Orbit`](crate::questions::Orbit), and `event`.
    pub fn table(&self) -> Table {
        let column = column_names(&[&self.field]).concat();
        let table = Table::new().with(column, self.values.iter().copied().collect());
        let name = |event: &Option<BranchEvent>| event.map_or("", BranchEvent::name);
        with_orbits(table, &self.orbits).each("event", &self.events, name)
    }
}

/// The tables of branches, one below the other, with their numbers from 1 in the column `branch`.
pub fn branches_table(branches: &[BranchAnswer]) -> Table {
    let mut all = Table::new();
    for (number, branch) in (1..).zip(branches) {
        let numbers = vec![Some(number); branch.orbits.len()];
        let mut table = Table::new().with("branch", Values::Counts(numbers));
        for column in branch.table().into_columns() {
            table = table.with(column.name, column.values);
        }
        all.append(&table);
    }
    all
}

/// How a branch or a locus is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BranchOptions {
    /// Phase of the drive in forcing periods at which states are given.
    pub phase: f64,
    /// Period of the first orbit in forcing periods; `None` for that of the settled motion.
    pub period: Option<u32>,
    /// Which motion the first orbit is.
    pub begin: Begin,
    /// Longest step, as a share of the range of a field and of the scales of the state.
    pub step: f64,
    /// Largest number of orbits.
    pub count: usize,
}

impl BranchOptions {
    /// Longest step by default.
    pub const STEP: f64 = 1e-2;
    /// Largest number of orbits by default.
    pub const COUNT: usize = 5000;

    /// The default steps from an orbit of this period, with states at a phase in forcing periods.
    pub fn new(phase: f64, period: Option<u32>) -> Self {
        Self { phase, period, begin: Begin::Run, step: Self::STEP, count: Self::COUNT }
    }
}

/// The branch of periodic orbits of a family over `field`, from one value towards another. It begins at the
/// settled motion of a run at the first value, or at that which `options` name.
///
/// Ticks once per orbit. Errors concern the first orbit only.
pub fn branch(
    family: &Family,
    field: &str,
    (from, to): (f64, f64),
    options: &BranchOptions,
    task: &Task,
) -> Result<BranchAnswer, NoOrbit> {
    task.unless_cancelled(|| {
        let BranchOptions { phase, period, begin, .. } = *options;
        let model = family.model(from).map_err(|_| NoOrbit::NotConverged)?;
        let first = begun(&model, phase, period, begin, task.cancel)?;
        let units = Units::of(&model, (to - from).abs());
        let periods = first.period;
        let corrector = Corrector { family, phase, periods, mirrored: false, units, cancel: task.cancel };
        let corrector = Corrector { mirrored: corrector.keeps_mirrored(&first, from), ..corrector };
        let upwards = Vector4::w() * (to - from).signum();
        let point =
            corrector.correct(corrector.at(first.state, from), &upwards).ok_or(NoOrbit::NotConverged)?;
        let along = corrector.tangent(&point, &upwards).ok_or(NoOrbit::Grazing)?;
        Walk::new(corrector, field, (from, to), &model, (point, along), *options).run_out(task)
    })
}
