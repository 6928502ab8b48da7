//! Map of the scene: a run from rest for every cell of a grid over two fields, coarse first.
//!
//! It is the sweep of the command line, run in the background and shown while its cells come. The view that
//! shows it asks for it in every frame; a map that no view asks for pauses until a view asks for it again.

mod axes;
mod cells;
mod of_session;
mod trail;

use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Job, Wake, pool};
use crate::scene::{Scene, SweepAxis};
use crate::study::{self, Cell, RMS_VELOCITY, STANDARD_COLUMNS, SummaryField};
use crate::system::clock::WallClock;

use super::editor::Editor;

pub use crate::numeric::short;
pub use axes::{ground, label, over, part};
pub use cells::{CutCell, Map};
pub use trail::Trail;

/// Time in s without a change after which a map is begun in the middle of a gesture.
const STILL: f64 = 0.25;

/// The question that a map answers: a scene, apart from the fields of the axes, and the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// The scene, with the first value of each axis.
    pub scene: Scene,
    /// Across and up.
    pub axes: [SweepAxis; 2],
    /// The column for which the runs keep an energy ledger, if they do.
    pub ledger: Option<&'static str>,
}

#[derive(Default)]
pub struct Mapping {
    /// The quantity that the map shows; `None` for the RMS velocity.
    quantity: Option<&'static SummaryField>,
    /// The earlier positions of the scene.
    pub trail: Trail,
    /// The axes that the user has chosen; `None` for the default axes.
    chosen: Option<[SweepAxis; 2]>,
    /// The default axes, as they were when the map was first shown: they do not move with the scene.
    default_axes: Option<[SweepAxis; 2]>,
    /// The choices of axes before each enlargement of a part of the map, the first one first.
    before_enlarging: Vec<Option<[SweepAxis; 2]>>,
    map: Option<Map>,
    /// The previous map, shown until the new one has a result everywhere.
    previous: Option<Map>,
    task: Option<Job<(u64, u64, Cell)>>,
    /// Number of the question that the running cells belong to.
    generation: u64,
    /// Number of changes of the picture.
    version: u64,
    begun: Option<WallClock>,
    stopped: bool,
    wanted: bool,
    /// A question that waits for a pause in the gesture, and the time in s since which it has not changed.
    waiting: Option<(Question, f64)>,
    /// Why there is no map.
    problem: Option<String>,
}

impl Mapping {
    /// The map to show, and whether it is that of the present scene.
    pub fn shown(&self) -> Option<(&Map, bool)> {
        let newest = self.map.as_ref().filter(|map| map.is_covered() || self.previous.is_none());
        let current = self.waiting.is_none() && self.problem.is_none();
        newest.map(|map| (map, current)).or_else(|| self.previous.as_ref().map(|map| (map, false)))
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

    /// Number of changes of the picture.
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

    /// Continues a stopped map, or begins again if it is complete.
    pub fn go_on(&mut self) {
        self.stopped = false;
        if self.map.as_ref().is_some_and(Map::is_whole) {
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
        let wanted = ledger.into_iter().chain([self.quantity().name]);
        let mut extra: Vec<&str> = wanted.filter(|name| !STANDARD_COLUMNS.contains(name)).collect();
        extra.dedup();
        (!extra.is_empty()).then(|| STANDARD_COLUMNS.into_iter().chain(extra).collect())
    }

    /// The map as the command line writes it; `None` until all cells are known.
    pub fn csv(&self) -> Option<String> {
        self.map
            .as_ref()
            .filter(|map| map.is_whole())
            .map(|map| map.csv(&self.columns().unwrap_or_else(|| STANDARD_COLUMNS.to_vec())))
    }

    /// Chooses axes; `None` for the default axes.
    pub fn choose(&mut self, axes: Option<[SweepAxis; 2]>) {
        (self.chosen, self.before_enlarging) = (axes, Vec::new());
    }

    /// Enlarges the part of the map that these axes span.
    pub fn enlarge(&mut self, axes: [SweepAxis; 2]) {
        self.before_enlarging.push(self.chosen.replace(axes));
    }

    /// Whether a part of the map is enlarged.
    pub fn is_enlarged(&self) -> bool {
        !self.before_enlarging.is_empty()
    }

    /// Goes back to the axes before the last enlargement.
    pub fn show_larger(&mut self) {
        if let Some(axes) = self.before_enlarging.pop() {
            self.chosen = axes;
        }
    }

    /// Goes back to the whole map.
    pub fn show_whole(&mut self) {
        self.before_enlarging.truncate(1);
        self.show_larger();
    }

    fn pause(&mut self) {
        self.take();
        self.task = None;
        if let (Some(begun), Some(map)) = (self.begun.take(), &mut self.map) {
            map.took += begun.elapsed();
        }
    }

    /// Receives the cells that have been computed.
    pub fn take(&mut self) {
        let (Some(task), Some(map)) = (&self.task, &mut self.map) else { return };
        let known_before = map.known;
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
        if map.known > known_before {
            self.version += 1;
            if map.is_covered() {
                map.coarse_after.get_or_insert(worked);
                self.previous = None;
                map.draw_lines(worked);
            }
        }
        if !running {
            map.took = worked;
            (self.task, self.begun) = (None, None);
            // a job that ended early, because no threads could be started, is not tried again by itself
            self.stopped |= !map.is_whole();
        }
    }

    /// Pauses the map if no view has asked for it in this frame; to be called once a frame.
    pub fn end_frame(&mut self) {
        if !std::mem::take(&mut self.wanted) {
            self.pause();
        }
    }

    /// Asks for the map of a question, now or after a pause in the gesture. Returns whether it waits.
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
        // the results of the running cells would not be used
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
                let old = self.map.take().filter(Map::is_covered).or_else(|| self.previous.take());
                let fields = |question: &Question| question.axes.clone().map(|axis| axis.field);
                let shows = |old: &Question| old.ledger.is_some() || question.ledger.is_none();
                let alike = |old: &Map| fields(&old.question) == fields(&question) && shows(&old.question);
                self.previous = old.filter(alike);
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
