//! Map of the scene: a run for every cell of a grid over two fields, from rest, coarse first.
//!
//! It is the sweep of the command line, run on threads of its own and looked at while it comes. It is asked
//! for by the view that shows it, frame by frame: a map that is not looked at stops where it is, and goes on
//! when it is looked at again.

mod axes;
mod cells;
mod of_session;
mod trail;

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Job, Wake, pool};
use crate::app::words::columns::{COLUMNS, ColumnInfo};
use crate::scene::{Scene, SweepAxis};
use crate::study::{self, Cell, STANDARD_COLUMNS};
use crate::system::clock::WallClock;

use super::editor::Editor;

pub use crate::numeric::short;
pub use axes::{ground, label, name_and_unit, over, part};
pub use cells::{CutCell, Map};
pub use trail::Trail;

/// Seconds for which a hand has to be still before a map is begun in the middle of a gesture.
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

#[derive(Default)]
pub struct Mapping {
    /// What the map shows, where it is not the RMS velocity.
    quantity: Option<&'static ColumnInfo>,
    /// Where the scene has been.
    pub trail: Trail,
    /// The axes that were chosen; none for the scene's own.
    chosen: Option<[SweepAxis; 2]>,
    /// The scene's own, as they were when the map was first looked at: they do not follow the scene over its
    /// map.
    held: Option<[SweepAxis; 2]>,
    /// What was chosen before a part of the map was enlarged, once for each part within the one before.
    larger: Vec<Option<[SweepAxis; 2]>>,
    map: Option<Map>,
    /// The map before, shown until the new one covers its ground.
    before: Option<Map>,
    task: Option<Job<(u64, u64, Cell)>>,
    /// Which question the cells under way belong to.
    generation: u64,
    /// Counts what has changed in the picture.
    version: u64,
    begun: Option<WallClock>,
    stopped: bool,
    wanted: bool,
    /// A question that waits for the hand to be still, and since when.
    waiting: Option<(Question, f64)>,
    /// Why there is no map.
    problem: Option<String>,
}

impl Mapping {
    /// The map that is to be seen, and whether it is still that of the scene.
    pub fn shown(&self) -> Option<(&Map, bool)> {
        let own = self.map.as_ref().filter(|map| map.is_covered() || self.before.is_none());
        let current = self.waiting.is_none() && self.problem.is_none();
        own.map(|map| (map, current)).or_else(|| self.before.as_ref().map(|map| (map, false)))
    }

    /// Where the scene has been on the axes of the map that is to be seen, the oldest place first.
    pub fn trail_places(&mut self) -> Vec<[Option<f64>; 2]> {
        let Some(axes) = self.shown().map(|own| own.0.question.axes.clone()) else { return Vec::new() };
        self.trail.places(axes.each_ref().map(|axis| axis.field.as_str())).to_vec()
    }

    /// The map of the present question, as far as it is known.
    pub fn map(&self) -> Option<&Map> {
        self.map.as_ref()
    }

    /// Counts what has changed in the picture.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Whether cells are being run.
    pub fn is_running(&self) -> bool {
        self.task.is_some()
    }

    /// Why there is no map.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    pub fn stop(&mut self) {
        self.pause();
        self.stopped = true;
    }

    /// Goes on, or begins anew where it is whole.
    pub fn go_on(&mut self) {
        self.stopped = false;
        if self.map.as_ref().is_some_and(Map::is_whole) {
            self.map = None;
        }
    }

    pub fn quantity(&self) -> &'static ColumnInfo {
        self.quantity.unwrap_or(&COLUMNS[0].1[0])
    }

    pub fn show(&mut self, quantity: &'static ColumnInfo) {
        self.quantity = Some(quantity);
    }

    /// The columns of the map's table, where they are more than the standard ones.
    pub fn columns(&self) -> Option<Vec<&'static str>> {
        let ledger = self.map.as_ref().and_then(|map| map.question.ledger);
        let wanted = ledger.into_iter().chain([self.quantity().column]);
        let mut more: Vec<&str> = wanted.filter(|name| !STANDARD_COLUMNS.contains(name)).collect();
        more.dedup();
        (!more.is_empty()).then(|| STANDARD_COLUMNS.into_iter().chain(more).collect())
    }

    /// The map as the command line writes it, once it is whole.
    pub fn csv(&self) -> Option<String> {
        self.map
            .as_ref()
            .filter(|map| map.is_whole())
            .map(|map| map.csv(&self.columns().unwrap_or_else(|| STANDARD_COLUMNS.to_vec())))
    }

    /// Chooses axes; none for the scene's own.
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

    /// Back to what was there before the last part was enlarged.
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

    fn pause(&mut self) {
        self.take();
        self.task = None;
        if let (Some(begun), Some(map)) = (self.begun.take(), &mut self.map) {
            map.took += begun.elapsed();
        }
    }

    /// Takes in the cells that have come.
    pub fn take(&mut self) {
        let (Some(task), Some(map)) = (&self.task, &mut self.map) else { return };
        let before = map.known;
        let generation = self.generation;
        let running = task.take(|(of, index, cell)| {
            if of != generation {
                return;
            }
            if let Some(place) = map.cells.get_mut(index as usize).filter(|place| place.is_none()) {
                *place = Some(cell);
                map.known += 1;
            }
        });
        let worked = map.took + self.begun.map_or(Duration::ZERO, |begun| begun.elapsed());
        if map.known > before {
            self.version += 1;
            if map.is_covered() {
                map.coarse_after.get_or_insert(worked);
                self.before = None;
                map.draw_lines(worked);
            }
        }
        if !running {
            map.took = worked;
            (self.task, self.begun) = (None, None);
            // an end short of the last cell, for want of threads, is not tried again by itself
            self.stopped |= !map.is_whole();
        }
    }

    /// To be called once a frame: a map that no view has asked for stops.
    pub fn end_frame(&mut self) {
        if !std::mem::take(&mut self.wanted) {
            self.pause();
        }
    }

    /// Asks that the map of this question be made, now or when the hand is still.
    fn ask(&mut self, question: Question, editor: &Editor, in_gesture: bool, time: f64, wake: &Wake) -> bool {
        self.wanted = true;
        if self.map.as_ref().is_some_and(|map| map.question == question) {
            (self.waiting, self.problem) = (None, None);
            if self.task.is_none() && !self.stopped {
                self.start(wake);
            }
            return false;
        }
        if self.problem.is_some() && self.waiting.as_ref().is_some_and(|waiting| waiting.0 == question) {
            return false;
        }
        // what runs would be thrown away
        self.pause();
        if in_gesture {
            let since = match &self.waiting {
                Some((same, since)) if *same == question => *since,
                _ => time,
            };
            if time - since < STILL {
                self.waiting = Some((question, since));
                return true;
            }
        }
        self.version += 1;
        self.stopped = false;
        match Map::new(&question, editor) {
            Ok(map) => {
                let old = self.map.take().filter(Map::is_covered).or_else(|| self.before.take());
                let fields = |question: &Question| question.axes.clone().map(|axis| axis.field);
                let shows = |old: &Question| old.ledger.is_some() || question.ledger.is_none();
                let alike = |old: &Map| fields(&old.question) == fields(&question) && shows(&old.question);
                self.before = old.filter(alike);
                self.map = Some(map);
                (self.waiting, self.problem) = (None, None);
                self.generation += 1;
                self.start(wake);
            }
            Err(problem) => {
                self.problem = Some(problem);
                self.waiting = Some((question, time));
            }
        }
        false
    }

    fn start(&mut self, wake: &Wake) {
        let Some(map) = self.map.as_ref().filter(|map| !map.is_whole()) else { return };
        let (sweep, levels) = (Arc::clone(&map.sweep), Arc::clone(&map.levels));
        let known: Vec<bool> = map.cells.iter().map(Option::is_some).collect();
        let generation = self.generation;
        self.begun = Some(WallClock::start());
        self.task = Job::start(wake, move |cancel, each| {
            let Some(pool) = pool() else { return };
            let task = study::Task { tick: &|| (), cancel };
            let mut begin = 0;
            for end in levels.ends {
                let missing = |index: &u64| !known[*index as usize];
                let cells: Vec<u64> = levels.order[begin..end].iter().copied().filter(missing).collect();
                begin = end;
                if !sweep.run_cells(&pool, &task, &cells, &|index, cell| each((generation, index, cell))) {
                    return;
                }
            }
        });
    }
}
