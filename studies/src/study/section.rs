//! Section of a motion: its stroboscopic states or its impacts over the settled window.
//!
//! Over a grid it gives a bifurcation diagram.

use std::sync::atomic::AtomicBool;

use super::grid_study::{AHEAD, fields};
use super::walk::without_a_period;
use super::{Carry, Cell, Grid, GridStudy, Question, Row, Table, Tally};
use crate::dynamics::{Event, EventKind, Model, Request, Run, SectionPoint, Summary};
use crate::scene::{Fault, Scene};

/// Largest number of states of one section.
pub const MAX_SECTION: u64 = 1 << 22;

/// Number of states that are kept in memory before their rows are written.
const KEPT: u64 = 1 << 21;

/// Extra column of the table of states: the number of impacts in the settled window.
pub const IMPACTS: &str = "impacts";

/// Where a section is taken.
///
/// Sections at several phases show how the set of states is stretched and folded within a period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SectionAt {
    /// At this phase of the drive in degrees; for a sum of sines, 360 degrees are the common period.
    Phase(f64),
    /// At every impact that counts, contacts with a compliant stop among them.
    Impacts,
}

/// How a section is taken.
///
/// Without [`periods`](Self::periods) the section is that of the settled window of the scene's run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionOptions {
    /// Where it is taken.
    pub at: SectionAt,
    /// Forcing periods that are skipped and that make the settled window, in place of the scene's run.
    pub periods: Option<(u64, u64)>,
    /// Each run continues until its motion repeats, at most up to this time in s.
    pub until_settled: Option<f64>,
    /// The last field of a grid is walked, as in a [sweep](crate::questions::Sweep::carry).
    pub carry: Option<Carry>,
}

/// The section of one run.
#[derive(Debug, Clone)]
pub struct Sectioned {
    cell: Cell,
    /// Its states, if it is taken at a phase.
    states: Vec<SectionPoint>,
    /// Its impacts, if it is taken at impacts, each with the phase in degrees of a drive that repeats.
    impacts: Vec<(Event, Option<f64>)>,
}

impl Sectioned {
    fn len(&self) -> usize {
        self.states.len() + self.impacts.len()
    }
}

impl Question for SectionOptions {
    type Answer = Sectioned;

    fn request(&self) -> Option<Request<'_>> {
        let (section, events) = match self.at {
            SectionAt::Phase(degrees) => (Some(degrees.rem_euclid(360.0) / 360.0), false),
            SectionAt::Impacts => (None, true),
        };
        Some(Request { section, events, until_settled: self.until_settled, ..Request::default() })
    }

    fn model(&self, model: Model) -> Model {
        match self.periods.zip(model.forcing_period()) {
            Some(((skip, keep), period)) => {
                model.with_duration((skip + keep) as f64 * period, skip as f64 * period)
            }
            None => model,
        }
    }

    fn fault(&self, model: &Model, scene: &Scene) -> Option<Fault> {
        let strobed = matches!(self.at, SectionAt::Phase(_));
        let needs = match (strobed, self.carry, self.periods) {
            (true, ..) => "a section at one phase",
            (_, Some(_), _) => "a walk from cell to cell",
            (.., Some(_)) => "a number of periods",
            _ => return None,
        };
        if let Some(fault) = without_a_period(model, scene, needs) {
            return Some(fault);
        }
        let (periods, period) = (model.window_periods().0, model.forcing_period()?);
        let long = |problem: String| {
            let value = scene.run.duration_s.to_string();
            Some(Fault { field: "run.duration_s".into(), value, problem })
        };
        match periods {
            _ if !strobed => None,
            0 => long(format!(
                "leaves a settled window of {} s, less than one forcing period of {period} s; lengthen the \
                 run",
                model.duration() - model.settle()
            )),
            1..=MAX_SECTION => None,
            _ => long(format!(
                "makes a settled window of {periods} forcing periods; at most {MAX_SECTION} are listed: \
                 raise run.settle_s, or shorten the run"
            )),
        }
    }

    fn answer(&self, model: &Model, run: Option<Run>, _: &AtomicBool) -> Sectioned {
        let Some(run) = run else { return Self::without_model(Cell::NotRun) };
        let (from, to) = run.summary.window;
        let strikes = run.events.iter().filter(|event| {
            matches!(event.kind, EventKind::Impact | EventKind::Contact)
                && event.v_in.abs() > model.min_impact_speed()
                && event.t >= from
                && event.t < to
        });
        let phase = |event: &Event| model.drive_phase(event.t).map(|turns| 360.0 * turns);
        let impacts = strikes.map(|event| (*event, phase(event))).collect();
        Sectioned { cell: Cell::Run(run.summary), impacts, states: run.section }
    }

    fn without_model(cell: Cell) -> Sectioned {
        Sectioned { cell, states: Vec::new(), impacts: Vec::new() }
    }

    fn count(tally: &mut Tally, answer: &Sectioned) {
        tally.count(&answer.cell);
    }

    fn table(&self, grid: &Grid, rows: &[Row<Sectioned>]) -> Table {
        let table = fields(grid, rows, Sectioned::len, self.carry.is_some());
        let index = rows.iter().flat_map(|row| (0..row.answer.len() as u64).map(Some));
        let table = table.with("index", index.collect());
        match self.at {
            SectionAt::Phase(_) => {
                let of_row = |row: &Row<Sectioned>| {
                    let impacts = row.answer.cell.summary().map_or(0, |summary| summary.impacts);
                    row.answer.states.iter().map(move |state| (*state, impacts)).collect::<Vec<_>>()
                };
                let states: Vec<(SectionPoint, u64)> = rows.iter().flat_map(of_row).collect();
                table
                    .each("t_s", &states, |(state, _)| state.t)
                    .each("x_m", &states, |(state, _)| state.x)
                    .each("v_m_per_s", &states, |(state, _)| state.v)
                    .each(IMPACTS, &states, |(_, impacts)| Some(*impacts))
            }
            SectionAt::Impacts => {
                let impacts: Vec<&(Event, Option<f64>)> =
                    rows.iter().flat_map(|row| &row.answer.impacts).collect();
                table
                    .each("t_s", &impacts, |(event, _)| event.t)
                    .each("side", &impacts, |(event, _)| event.side.name())
                    .each("phase_deg", &impacts, |(_, phase)| *phase)
                    .each("v_in_m_per_s", &impacts, |(event, _)| event.v_in)
            }
        }
    }

    fn carry(&self) -> Option<Carry> {
        self.carry
    }

    fn ahead(&self, threads: u64) -> u64 {
        let each = self.periods.map_or(1 << 12, |(_, keep)| keep.max(1));
        (KEPT / each).clamp(threads, AHEAD * threads)
    }
}

impl Default for SectionOptions {
    /// The states at the phase 0 over the scene's own run.
    fn default() -> Self {
        Self { at: SectionAt::Phase(0.0), periods: None, until_settled: None, carry: None }
    }
}

/// The section of a run of `model`, the model of `scene`, and the summary of the run. The table of states has
/// the column [`IMPACTS`]. A fault if the drive does not repeat, or if the settled window has no period or
/// too many.
pub fn section(
    model: &Model,
    scene: &Scene,
    options: &SectionOptions,
    cancel: &AtomicBool,
) -> Result<(Table, Summary), Fault> {
    let model = options.model(model.clone());
    if let Some(fault) = options.fault(&model, scene) {
        return Err(fault);
    }
    let run = model.run(&Request { cancel: Some(cancel), ..options.request().unwrap_or_default() });
    let summary = run.summary;
    let row = Row { index: 0, direction: None, answer: options.answer(&model, Some(run), cancel) };
    Ok((options.table(&Grid::of_one(), &[row]), summary))
}

/// Sections of the cells of a grid: the swept fields, the direction of a walk, then one [`section`].
pub type Sections = GridStudy<SectionOptions>;
