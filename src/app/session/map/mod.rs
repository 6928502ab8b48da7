//! Map of the scene: a run for every cell of a grid over two fields, from rest, coarse first.
//!
//! It is the sweep of the command line, run in the background and shown while its cells come. A map that no
//! view shows is paused, and its known cells are kept for when one does.

mod axes;
mod cells;
mod trail;

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Background, pool};
use crate::app::words::columns::{COLUMNS, ColumnInfo};
use crate::app::words::fields::{in_words, name_and_unit as field_name_and_unit};
use crate::scene::{Axis, FieldPath, Scene, Stops, SweepAxis};
use crate::study::{Cell, STANDARD_COLUMNS, Task};

use super::Session;

pub use crate::numeric::short;
pub use axes::{ground, label, name_and_unit, over, part};
use cells::too_many;
pub use cells::{CutCell, Map};
pub use trail::Trail;

/// Time in s for which a hand has to be still before a map is begun in the middle of a gesture.
const STILL: f64 = 0.25;

/// What a map answers: a scene without what its axes change, and the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// The scene, with the first value of each axis.
    pub scene: Scene,
    /// Across and up.
    pub axes: [SweepAxis; 2],
    /// The column for which the runs sum up their energies, where they do.
    pub ledger: Option<&'static str>,
}

/// The map with what is chosen for it.
#[derive(Default)]
pub struct Mapping {
    /// What the map shows, where it is not the RMS velocity.
    quantity: Option<&'static ColumnInfo>,
    /// Where the scene has been.
    pub trail: Trail,
    /// The axes that were chosen; none for the scene's default ones.
    chosen: Option<[SweepAxis; 2]>,
    /// The default axes of the scene as they were when the map was first shown: they do not follow the scene
    /// over its map.
    first: Option<[SweepAxis; 2]>,
    /// What was chosen before a part of the map was enlarged, once for each part within the one before.
    larger: Vec<Option<[SweepAxis; 2]>>,
    pub cells: Background<Question, (u64, Cell), Map>,
    /// A question that is not asked yet, and the time in s at which a frame first wanted it.
    waiting: Option<(Question, f64)>,
    /// Why there is no map.
    problem: Option<String>,
}

impl Mapping {
    /// The map that is to be seen, and whether it is that of the scene.
    pub fn shown(&self) -> Option<(&Map, bool)> {
        let is_answered = self.waiting.is_none() && self.problem.is_none();
        self.cells.shown().map(|(map, is_current)| (map, is_current && is_answered))
    }

    /// Where the scene has been on the axes of the map that is to be seen, the oldest place first.
    pub fn trail_places(&mut self) -> Vec<[Option<f64>; 2]> {
        let Some(axes) = self.shown().map(|(map, _)| map.question.axes.clone()) else { return Vec::new() };
        self.trail.places(axes.each_ref().map(|axis| axis.field.as_str())).to_vec()
    }

    /// The map of the present question, as far as it is known.
    pub fn map(&self) -> Option<&Map> {
        self.cells.so_far()
    }

    /// Whether cells are being run.
    pub fn is_running(&self) -> bool {
        self.cells.is_running()
    }

    /// Why there is no map.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// Runs the cells that are not known yet, or all of them again where all are known.
    pub fn go_on(&mut self) {
        match self.map() {
            Some(map) if map.is_whole() => self.cells.clear(),
            _ => self.cells.again(),
        }
    }

    pub fn quantity(&self) -> &'static ColumnInfo {
        self.quantity.unwrap_or(&COLUMNS[0].1[0])
    }

    pub fn show(&mut self, quantity: &'static ColumnInfo) {
        self.quantity = Some(quantity);
    }

    /// The columns of the map's table, where there are more than the standard ones.
    pub fn columns(&self) -> Option<Vec<&'static str>> {
        let ledger = self.map().and_then(|map| map.question.ledger);
        let wanted = ledger.into_iter().chain([self.quantity().column]);
        let mut more: Vec<&str> = wanted.filter(|name| !STANDARD_COLUMNS.contains(name)).collect();
        more.dedup();
        (!more.is_empty()).then(|| STANDARD_COLUMNS.into_iter().chain(more).collect())
    }

    /// The map as the command line writes it, once all cells are known.
    pub fn csv(&self) -> Option<String> {
        let map = self.map().filter(|map| map.is_whole())?;
        Some(map.csv(&self.columns().unwrap_or_else(|| STANDARD_COLUMNS.to_vec())))
    }

    /// Chooses axes; none for the scene's default ones.
    pub fn choose(&mut self, axes: Option<[SweepAxis; 2]>) {
        (self.chosen, self.larger) = (axes, Vec::new());
    }

    /// Enlarges a part of the map, which has these axes.
    pub fn enlarge(&mut self, axes: [SweepAxis; 2]) {
        self.larger.push(self.chosen.replace(axes));
    }

    /// Whether a part of the map is enlarged.
    pub fn is_enlarged(&self) -> bool {
        !self.larger.is_empty()
    }

    /// Back to the axes before the last part was enlarged.
    pub fn show_larger(&mut self) {
        if let Some(axes) = self.larger.pop() {
            self.chosen = axes;
        }
    }

    /// Back to the whole map.
    pub fn show_whole(&mut self) {
        self.larger.truncate(1);
        self.show_larger();
    }
}

impl Session {
    /// The axes of the map; none where the scene has too few fields.
    pub fn map_axes(&self) -> Option<[SweepAxis; 2]> {
        let (scene, when_on) = (self.scene(), self.remembered_stops());
        for axes in [&self.map.chosen, &self.map.first].into_iter().flatten() {
            let ground = ground(scene, when_on, axes);
            if axes.iter().all(|axis| FieldPath::new(&axis.field).get(&ground).is_some()) {
                return Some(axes.clone());
            }
        }
        axes::default_axes(scene, when_on, self.well_mm())
    }

    /// The fields that a map of this scene can go over.
    pub fn map_fields(&self) -> Vec<String> {
        axes::fields(self.scene(), self.remembered_stops())
    }

    /// An axis over a field, around the place of the scene.
    pub fn map_axis(&self, field: &str) -> SweepAxis {
        axes::axis(field, self.scene(), self.remembered_stops(), self.well_mm())
    }

    fn well_mm(&self) -> Option<f64> {
        self.model().mechanism().landscape.right_stable().map(|well| well.x * 1e3)
    }

    /// Asks for the map of the scene as it stands, in the frame at `time` in s. Whether it waits for the hand
    /// to be still.
    pub fn want_map(&mut self, time: f64) -> bool {
        let Some(axes) = self.map_axes() else {
            self.map.problem = Some("This scene has no two fields to make a map over.".to_owned());
            return false;
        };
        // a choice for which the scene lacks the fields at the moment is kept for when it has them
        if self.map.chosen.as_ref() != Some(&axes) {
            self.map.first = Some(axes.clone());
        }
        let Some(question) = self.map_question(axes) else { return false };
        self.map.cells.mark_wanted();
        if self.map.cells.question() == Some(&question) {
            (self.map.waiting, self.map.problem) = (None, None);
            self.run_cells();
            return false;
        }
        let waiting = self.map.waiting.take().filter(|(wanted, _)| *wanted == question);
        if self.map.problem.is_some() && waiting.is_some() {
            self.map.waiting = waiting;
            return false;
        }
        // its cells would be thrown away
        self.map.cells.pause();
        let since = waiting.map_or(time, |(_, since)| since);
        if self.editor.in_gesture() && time - since < STILL {
            self.map.waiting = Some((question, since));
            return true;
        }
        match Map::new(&question, &self.editor, self.model().mechanism()) {
            Ok(map) => {
                self.map.problem = None;
                self.map.cells.set(question, map);
                self.run_cells();
            }
            Err(problem) => {
                self.map.problem = Some(problem);
                self.map.waiting = Some((question, time));
            }
        }
        false
    }

    /// What the map of the scene as it stands answers; none where an axis is over a field that cannot be set.
    fn map_question(&self, axes: [SweepAxis; 2]) -> Option<Question> {
        let mut scene = ground(self.scene(), self.remembered_stops(), &axes);
        if !axes.iter().all(|axis| FieldPath::new(&axis.field).set(&mut scene, axis.from)) {
            return None;
        }
        let same = self.map.map().filter(|map| map.question.scene == scene && map.question.axes == axes);
        // runs that sum up their energies have all columns of those that do not
        let quantity = self.map.quantity();
        let needed = || quantity.field().filter(|field| field.needs_ledger).map(|_| quantity.column);
        let ledger = same.and_then(|map| map.question.ledger).or_else(needed);
        Some(Question { scene, axes, ledger })
    }

    /// Runs the cells of the map that are not known, unless it was stopped.
    fn run_cells(&mut self) {
        let cells = &mut self.map.cells;
        let Some(map) = cells.so_far().filter(|map| cells.is_paused() && !map.is_whole()) else { return };
        let (sweep, levels) = (Arc::clone(&map.sweep), map.missing());
        cells.resume(&self.wake, move |cancel, each| {
            let (pool, task) = (pool()?, Task { tick: &|| (), cancel });
            for cells in levels {
                if !sweep.run_cells(&pool, &task, &cells, &|index, cell| each((index, cell))) {
                    break;
                }
            }
            None
        });
    }

    /// Where the scene stands on the axes of a map; none on an axis whose field it lacks, such as a travel
    /// limit without stops.
    pub fn place_on_map(&self, question: &Question) -> [Option<f64>; 2] {
        question.axes.each_ref().map(|axis| FieldPath::new(&axis.field).get(self.scene()))
    }

    /// Why axes cannot be those of a map of the scene: which of the two is at fault, which of its parts, and
    /// a sentence. None where they can.
    pub fn map_problem(&self, axes: &[SweepAxis; 2]) -> Option<(usize, &'static str, String)> {
        let ground = ground(self.scene(), self.remembered_stops(), axes);
        let mut cells = 1;
        for (i, axis) in axes.iter().enumerate() {
            match Axis::from_scene(axis, &ground) {
                Err((part, problem)) => {
                    let (name, why) = (field_name_and_unit(&axis.field).0, in_words(&problem, &ground));
                    return Some((i, part, format!("{name}, {part}: {why}")));
                }
                Ok(axis) => cells *= axis.values.len() as u64,
            }
        }
        too_many(cells).map(|problem| (1, "step", problem))
    }

    /// Takes the scene to a cell of its map, by one gesture; the motion goes on from where it is.
    pub fn go_to_cell(&mut self, column: usize, row: usize) {
        self.end_gesture();
        self.drag_to_cell(column, row);
        self.end_gesture();
    }

    /// The same as part of a gesture.
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
                let known = FieldPath::new(&axis.field).set(scene, value);
                debug_assert!(known, "an axis of the map belongs to the scene");
            }
        });
    }

    /// Waits until the map is whole, for `limit` at the longest. Whether it is.
    pub fn wait_for_map(&mut self, limit: Duration) -> bool {
        self.map.cells.wait(limit);
        self.map.map().is_some_and(Map::is_whole)
    }
}
