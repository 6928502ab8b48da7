//! Map of the scene: a run from rest for every cell of a grid over two fields, coarse first.
//!
//! It is the sweep of the command line, run in the background and shown while its cells come. The view that
//! shows it asks for it in every frame; a map that no view asks for pauses until a view asks for it again.

mod axes;
mod cells;

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::app::session::Session;
use crate::app::session::prepared::SceneWithFiles;
use crate::app::task::{Background, Each, Question, Uncompared, progress};
use crate::app::words::fields::{in_words, name_and_unit};
use crate::questions::{Error, Grid, Progress, Sweep, SweepCells};
use crate::scene::{Axis, FieldPath, Scene, Stops, SweepAxis};
use interwell_studies::study::{Cell, RMS_VELOCITY, STANDARD_COLUMNS, SummaryField};

pub use crate::numeric::short;
pub use axes::{ground, is_amplitude, label, over, part, start};
pub use cells::Map;

/// Time in s without a change after which a map is begun in the middle of a gesture.
const STILL: f64 = 0.25;

const MAX_SCENES: usize = 400;

pub const NO_FIELDS: &str = "This scene has no two fields to make a map over.";

/// The column of the mean power into the load of a transducer.
pub const LOAD_POWER: &str = "mean_load_power_w";

/// The question that a map answers: a scene, apart from the fields of the axes, and the axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapQuestion {
    /// The scene, with the first value of each axis.
    pub scene: SceneWithFiles,
    /// Across and up.
    #[serde(with = "crate::app::task::as_text")]
    pub axes: [SweepAxis; 2],
    /// The column for which the runs keep an energy ledger, if they do.
    pub ledger: Option<&'static SummaryField>,
}

impl MapQuestion {
    /// The sweep that makes the map, over a grid of its axes.
    fn sweep(&self) -> Result<SweepCells, Error> {
        let document = self.scene.document();
        document.check()?;
        let grid = Grid::new(document.axes(&self.axes.each_ref().map(over))?)?;
        let ledger = self.ledger.map(|field| field.name);
        Sweep::default().cells(&document, grid, ledger.as_slice(), &Progress::none())
    }
}

/// The cells of a map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellsQuestion {
    map: MapQuestion,
    /// The indices of the cells that are not known, level by level.
    missing: Uncompared<Vec<Vec<u64>>>,
    /// The sweep, where it has been prepared.
    #[serde(skip)]
    sweep: Uncompared<Option<Arc<SweepCells>>>,
}

impl Question for CellsQuestion {
    const NAME: &'static str = "cells";
    /// The index of a cell, and the cell.
    type Part = (u64, Cell);

    fn answer(&self, cancel: &AtomicBool, each: Each<Self::Part>) -> Option<Self::Part> {
        let Self { map, missing, sweep } = self;
        let sweep = sweep.0.clone().or_else(|| map.sweep().ok().map(Arc::new))?;
        for cells in &missing.0 {
            sweep.run(cells, &progress(cancel), &|index, cell| each((index, cell))).ok()?;
        }
        None
    }

    #[cfg(any(test, target_arch = "wasm32"))]
    fn divide(&self, count: usize) -> Vec<Self> {
        let part = |first: usize| {
            let levels = self.missing.0.iter();
            let missing = levels.map(|cells| cells.iter().skip(first).step_by(count).copied().collect());
            Self { missing: Uncompared(missing.collect()), ..self.clone() }
        };
        let has_cells = |part: &Self| part.missing.0.iter().any(|cells| !cells.is_empty());
        (0..count).map(part).filter(has_cells).collect()
    }
}

#[derive(Default)]
pub struct Mapping {
    /// The quantity that is shown; `None` for the RMS velocity.
    pub(super) quantity: Option<&'static SummaryField>,
    pub trail: Trail,
    /// The axes that the user has chosen; `None` for the default axes.
    chosen: Option<[SweepAxis; 2]>,
    /// The default axes, as they were when the map was first shown: they do not move with the scene.
    default_axes: Option<[SweepAxis; 2]>,
    /// The axes of the part of the map that is enlarged.
    pub enlarged: Option<[SweepAxis; 2]>,
    map: Option<Map>,
    /// The previous map, shown until the new one has a result everywhere, and whether it is of its scene.
    previous: Option<(Map, bool)>,
    /// A map that was whole, to come back to.
    kept: Option<Map>,
    /// The cells of the map that have come and are not in it yet.
    pub(super) cells: Background<CellsQuestion, (u64, Cell)>,
    pub version: u64,
    /// A question that waits for a pause in the gesture, and the time in s since which it has not changed.
    waiting: Option<(MapQuestion, f64)>,
    /// Why there is no map.
    pub problem: Option<String>,
}

impl Mapping {
    /// The map to show, and whether it is that of the present scene.
    pub fn shown(&self) -> Option<(&Map, bool)> {
        let newest = self.map.as_ref().filter(|map| map.is_covered() || self.previous.is_none());
        let current = self.waiting.is_none() && self.problem.is_none();
        let previous = || self.previous.as_ref().map(|(map, is_same)| (map, current && *is_same));
        newest.map(|map| (map, current)).or_else(previous)
    }

    /// Positions of the scene so far on the axes of the map that is shown, the oldest first.
    pub fn trail_places(&mut self) -> Vec<[Option<f64>; 2]> {
        let Some(axes) = self.shown().map(|(map, _)| map.question.axes.clone()) else { return Vec::new() };
        self.trail.places(axes.each_ref().map(|axis| axis.field.as_str())).to_vec()
    }

    /// The map of the present question, as far as it is known.
    pub fn map(&self) -> Option<&Map> {
        self.map.as_ref()
    }

    pub fn is_running(&self) -> bool {
        self.cells.is_running()
    }

    pub fn stop(&mut self) {
        self.cells.stop();
        self.take();
        self.version += 1;
    }

    /// Continues a stopped map, or begins again if it is complete.
    pub fn go_on(&mut self) {
        self.cells.resume();
        if self.map.as_ref().is_some_and(Map::is_whole) {
            self.cells.clear();
            self.map = None;
        }
    }

    pub fn quantity(&self) -> &'static SummaryField {
        self.quantity.unwrap_or(&RMS_VELOCITY)
    }

    pub fn show(&mut self, quantity: &'static SummaryField) {
        self.quantity = Some(quantity);
    }

    /// The columns of the map's table; `None` if they are the standard ones.
    pub fn columns(&self) -> Option<Vec<&'static str>> {
        let ledger = self.map.as_ref().and_then(|map| map.question.ledger);
        let wanted = ledger.into_iter().chain([self.quantity()]).map(|field| field.name);
        let mut extra: Vec<&str> = wanted.filter(|name| !STANDARD_COLUMNS.contains(name)).collect();
        extra.dedup();
        (!extra.is_empty()).then(|| STANDARD_COLUMNS.into_iter().chain(extra).collect())
    }

    /// The map as the command line writes it; `None` until all cells are known.
    pub fn csv(&self) -> Option<String> {
        let whole = self.map.as_ref().filter(|map| map.is_whole())?;
        Some(whole.csv(&self.columns().unwrap_or_else(|| STANDARD_COLUMNS.to_vec())))
    }

    /// Chooses axes; `None` for the default axes.
    pub fn choose(&mut self, axes: Option<[SweepAxis; 2]>) {
        (self.chosen, self.enlarged) = (axes, None);
    }

    pub fn take(&mut self) {
        let cells = self.cells.take_parts();
        let Some(map) = &mut self.map else { return };
        map.took = self.cells.worked();
        if cells.is_empty() {
            return;
        }
        self.version += u64::from(map.add(cells));
        if map.is_covered() {
            self.kept =
                self.previous.take().map(|previous| previous.0).filter(Map::is_whole).or(self.kept.take());
        }
    }
}

impl Session {
    /// The axes of the map, or of the part of it that is enlarged; `None` if the scene has fewer than two
    /// fields for them.
    pub fn map_axes(&self) -> Option<[SweepAxis; 2]> {
        let enlarged = self.map.enlarged.as_ref().filter(|axes| self.has_fields_of(*axes));
        enlarged.cloned().or_else(|| self.map_whole())
    }

    /// The axes of the whole map.
    pub fn map_whole(&self) -> Option<[SweepAxis; 2]> {
        let mut known = self.map.chosen.iter().chain(&self.map.default_axes);
        let usual = || axes::default_axes(self.scene(), self.remembered_stops, self.well_mm());
        known.find(|axes| self.has_fields_of(*axes)).cloned().or_else(usual)
    }

    /// Whether the scene, with its stops switched on if need be, has the fields of these axes.
    pub(super) fn has_fields_of(&self, axes: &[SweepAxis]) -> bool {
        let ground = ground(self.scene(), self.remembered_stops, axes);
        axes.iter().all(|axis| FieldPath::new(&axis.field).get(&ground).is_some())
    }

    pub fn map_fields(&self) -> Vec<String> {
        axes::fields(self.scene(), self.remembered_stops)
    }

    pub fn map_axis(&self, field: &str) -> SweepAxis {
        axes::axis(field, self.scene(), self.remembered_stops, self.well_mm())
    }

    fn well_mm(&self) -> Option<f64> {
        self.model().mechanism().landscape.right_stable().map(|well| well.x * 1e3)
    }

    /// Asks for the map of the scene at `time` in s. Returns whether it waits for a pause in the gesture.
    pub fn want_map(&mut self, time: f64) -> bool {
        let Some(axes) = self.map_axes() else {
            self.map.problem = Some(NO_FIELDS.to_owned());
            return false;
        };
        // chosen axes whose fields the scene lacks at present stay chosen
        if self.map.chosen.is_none() || self.map.chosen != self.map_whole() {
            self.map.default_axes = self.map_whole();
        }
        let Some(question) = self.map_question(axes) else { return false };
        self.map.cells.mark_wanted();
        if self.map.cells.question().is_some_and(|asked| asked.map == question) {
            (self.map.waiting, self.map.problem) = (None, None);
            self.run_cells();
            return false;
        }
        let waiting = self.map.waiting.take().filter(|(same, _)| *same == question);
        if self.map.problem.is_some() && waiting.is_some() {
            self.map.waiting = waiting;
            return false;
        }
        // the results of the running cells would not be used
        self.map.cells.pause();
        self.map.take();
        let since = waiting.map_or(time, |(_, since)| since);
        if self.editor.in_gesture() && time - since < STILL {
            self.map.waiting = Some((question, since));
            return true;
        }
        self.map.version += 1;
        self.map.cells.resume();
        let kept = self.map.kept.take_if(|map| map.question == question);
        let kept = kept.or_else(|| Some(self.map.previous.take_if(|(map, _)| map.question == question)?.0));
        match kept.map_or_else(|| Map::new(&question, self.model().mechanism()), Ok) {
            Ok(map) => {
                let mapping = &mut self.map;
                let newest = mapping.map.take().filter(Map::is_covered);
                let old = newest.or_else(|| mapping.previous.take().map(|previous| previous.0));
                let old = old.filter(|old| old.stands_in_for(&map));
                mapping.previous = None;
                match old {
                    Some(old) if map.is_covered() => mapping.kept = Some(old).filter(Map::is_whole),
                    old => {
                        mapping.previous = old.map(|old| {
                            let is_same = old.is_of_scene(&question);
                            (old, is_same)
                        })
                    }
                }
                (mapping.map, mapping.problem) = (Some(map), None);
                self.run_cells();
            }
            Err(problem) => {
                self.map.problem = Some(problem);
                self.map.waiting = Some((question, time));
            }
        }
        false
    }

    /// The question of the map over these axes; `None` if the first value of an axis cannot be set.
    fn map_question(&self, axes: [SweepAxis; 2]) -> Option<MapQuestion> {
        let mut scene = ground(self.scene(), self.remembered_stops, &axes);
        if !axes.iter().all(|axis| FieldPath::new(&axis.field).set(&mut scene, axis.from)) {
            return None;
        }
        let scene = self.with_files(scene);
        let same = self.map.map().filter(|map| map.question.scene == scene && map.question.axes == axes);
        // runs with an energy ledger have all columns of runs without one
        let quantity = self.map.quantity();
        let needed = || quantity.needs_ledger.then_some(quantity);
        let ledger = same.and_then(|map| map.question.ledger).or_else(needed);
        Some(MapQuestion { scene, axes, ledger })
    }

    /// Runs the missing cells of the map, unless they are running or were stopped.
    fn run_cells(&mut self) {
        let Mapping { map: Some(map), cells, .. } = &mut self.map else { return };
        let is_asked = cells.question().is_some_and(|asked| asked.map == map.question);
        if map.is_whole() || is_asked && !cells.is_paused() {
            return;
        }
        let (missing, sweep) = (Uncompared(map.missing()), Uncompared(Some(Arc::clone(&map.sweep))));
        cells.ask(CellsQuestion { map: map.question.clone(), missing, sweep }, &self.wake);
    }

    /// Why a map cannot have these axes: the index of the faulty axis, its faulty part, and a sentence.
    pub fn map_problem(&self, axes: &[SweepAxis; 2]) -> Option<(usize, &'static str, String)> {
        let ground = ground(self.scene(), self.remembered_stops, axes);
        let mut cells = 1;
        for (i, axis) in axes.iter().enumerate() {
            match Axis::from_scene(axis, &ground) {
                Err((part, problem)) => {
                    let why = in_words(&problem, &ground);
                    return Some((i, part, format!("{}, {part}: {why}", name_and_unit(&axis.field).0)));
                }
                Ok(axis) => cells *= axis.values.len() as u64,
            }
        }
        cells::too_many(cells).map(|problem| (1, "step", problem))
    }

    /// Moves the scene to a cell of its map, as one gesture; the motion goes on from its present state.
    pub fn go_to_cell(&mut self, column: usize, row: usize) {
        self.end_gesture();
        self.drag_to_cell(column, row);
        self.end_gesture();
    }

    pub fn drag_to_cell(&mut self, column: usize, row: usize) {
        let Some((map, _)) = self.map.shown() else { return };
        let (Some(x), Some(y)) = (map.edges[0].values.get(column), map.edges[1].values.get(row)) else {
            return;
        };
        let (values, axes, stops) = ([*x, *y], map.question.axes.clone(), map.question.scene.stops);
        self.edit(|scene| {
            if scene.stops == Stops::None && axes.iter().any(|axis| axis.field.starts_with("stops.")) {
                scene.stops = stops;
            }
            for (axis, value) in axes.iter().zip(values) {
                let is_set = FieldPath::new(&axis.field).set(scene, value);
                debug_assert!(is_set, "an axis of the map belongs to the scene");
            }
        });
    }

    /// Waits at most `timeout` until all cells of the map are known. Returns whether they are.
    pub fn wait_for_map(&mut self, timeout: Duration) -> bool {
        self.map.cells.wait(timeout);
        self.map.take();
        self.map.map().is_some_and(Map::is_whole)
    }
}

/// The scenes of the live motion so far, the oldest first.
#[derive(Default)]
pub struct Trail {
    scenes: VecDeque<Arc<Scene>>,
    /// Their positions on `fields`, the two axes that were last asked for.
    places: Vec<[Option<f64>; 2]>,
    fields: [String; 2],
}

impl Trail {
    pub(super) fn note(&mut self, scene: &Arc<Scene>) {
        self.scenes.push_back(Arc::clone(scene));
        if self.scenes.len() > MAX_SCENES {
            self.scenes.pop_front();
        }
        self.places.clear();
    }

    /// Forgets all scenes but the present one.
    pub fn clear(&mut self) {
        self.scenes.drain(..self.scenes.len().saturating_sub(1));
        self.places.clear();
    }

    /// Whether there is no scene but the present one.
    pub fn is_clear(&self) -> bool {
        self.scenes.len() < 2
    }

    /// Positions of the scenes on two fields, without repetitions; `None` on a field that a scene lacks.
    fn places(&mut self, fields: [&str; 2]) -> &[[Option<f64>; 2]] {
        if self.places.is_empty() || self.fields != fields {
            let paths = fields.map(FieldPath::new);
            let place = |scene: &Arc<Scene>| paths.each_ref().map(|path| path.get(scene));
            self.places = self.scenes.iter().map(place).collect();
            self.places.dedup();
            self.fields = fields.map(str::to_owned);
        }
        &self.places
    }
}
