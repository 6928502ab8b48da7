//! What the session has computed beside its motion: the map, the best stops, pinned motions, and the
//! differences from measured data.
//!
//! The types of these are in files that know no session, since the session has them as fields.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use crate::app::task::{Background, Identity, pool};
use crate::app::words::fields::{in_words, info, name_and_unit};
use crate::dynamics::Model;
use crate::scene::{Axis, Excitation, FieldPath, Scene, Start, Stops, SweepAxis, read_record};
use crate::study::{DesignRange, INTERVALS, Task, Watch};

use super::Session;
use super::best::{LIMIT, Part, Search};
use super::build::{CannotRun, fault_message};
use super::editor::keep_start_inside;
use super::map::cells::too_many;
use super::map::{Map, Mapping, Question, axes, ground};
use super::measured::{Differences, MeasuredQuestion, MeasuredRecord};
use super::pins::{LETTERS, Pin, PinKind};
use super::sliders::reach;

/// Time in s without a change after which a map is begun in the middle of a gesture.
const STILL: f64 = 0.25;

/// Distance in mm of the twin's start from that of the mass.
const TWIN_OFFSET_MM: f64 = 1e-3;

/// The map: its axes, the position of the scene on it, and moves of the scene to a cell.
impl Session {
    /// The axes of the map; `None` if the scene has fewer than two fields for them.
    pub fn map_axes(&self) -> Option<[SweepAxis; 2]> {
        let mut known = self.map.chosen().into_iter().chain(&self.map.default_axes);
        match known.find(|axes| self.has_fields_of(*axes)) {
            Some(axes) => Some(axes.clone()),
            None => axes::default_axes(self.scene(), self.remembered_stops(), self.well_mm()),
        }
    }

    /// Whether the scene, with its stops switched on if need be, has the fields of these axes.
    pub(super) fn has_fields_of(&self, axes: &[SweepAxis]) -> bool {
        let ground = ground(self.scene(), self.remembered_stops(), axes);
        axes.iter().all(|axis| FieldPath::new(&axis.field).get(&ground).is_some())
    }

    /// The fields of this scene that a map can have as axes.
    pub fn map_fields(&self) -> Vec<String> {
        axes::fields(self.scene(), self.remembered_stops())
    }

    /// An axis over a field, around its present value.
    pub fn map_axis(&self, field: &str) -> SweepAxis {
        axes::axis(field, self.scene(), self.remembered_stops(), self.well_mm())
    }

    fn well_mm(&self) -> Option<f64> {
        self.model().mechanism().landscape.right_stable().map(|well| well.x * 1e3)
    }

    /// Asks for the map of the present scene, in the frame at `time` in s. Returns whether the map waits for
    /// a pause in the gesture.
    pub fn want_map(&mut self, time: f64) -> bool {
        let Some(axes) = self.map_axes() else {
            self.map.problem = Some("This scene has no two fields to make a map over.".to_owned());
            return false;
        };
        // chosen axes whose fields the scene lacks at present stay chosen
        if self.map.chosen() != Some(&axes) {
            self.map.default_axes = Some(axes.clone());
        }
        let Some(question) = self.map_question(axes) else { return false };
        self.map.cells.mark_wanted();
        if self.map.cells.question() == Some(&question) {
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
        match Map::new(&question, &self.editor, self.model().mechanism()) {
            Ok(map) => {
                let mapping = &mut self.map;
                let old = mapping.map.take().filter(Map::is_covered).or_else(|| mapping.previous.take());
                mapping.previous = old.filter(|old| old.stands_in_for(&map));
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

    /// The question of the map over these axes; `None` if the first value of one cannot be set.
    fn map_question(&self, axes: [SweepAxis; 2]) -> Option<Question> {
        let mut scene = ground(self.scene(), self.remembered_stops(), &axes);
        if !axes.iter().all(|axis| FieldPath::new(&axis.field).set(&mut scene, axis.from)) {
            return None;
        }
        let same = self.map.map().filter(|map| map.question.scene == scene && map.question.axes == axes);
        // runs with an energy ledger have all columns of runs without one
        let quantity = self.map.quantity();
        let needed = || quantity.needs_ledger.then_some(quantity.name);
        let ledger = same.and_then(|map| map.question.ledger).or_else(needed);
        Some(Question { scene, axes, ledger })
    }

    /// Runs the missing cells of the map, unless they are running or were stopped.
    fn run_cells(&mut self) {
        let Mapping { map: Some(map), cells, .. } = &mut self.map else { return };
        if map.is_whole() || cells.question() == Some(&map.question) && !cells.is_paused() {
            return;
        }
        let (sweep, levels) = (Arc::clone(&map.sweep), map.missing());
        cells.ask(map.question.clone(), &self.wake, move |_, cancel, each| {
            let (pool, task) = (pool()?, Task { tick: &|| (), cancel });
            for cells in levels {
                if !sweep.run_cells(&pool, &task, &cells, &|index, cell| each((index, cell))) {
                    break;
                }
            }
            None
        });
    }

    /// Why a map of the scene cannot have these axes: the index of the faulty axis, its faulty part, and a
    /// sentence. `None` if it can.
    pub fn map_problem(&self, axes: &[SweepAxis; 2]) -> Option<(usize, &'static str, String)> {
        let ground = ground(self.scene(), self.remembered_stops(), axes);
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
        too_many(cells).map(|problem| (1, "step", problem))
    }

    /// Moves the scene to a cell of its map, as one gesture; the motion goes on from its present state.
    pub fn go_to_cell(&mut self, column: usize, row: usize) {
        self.end_gesture();
        self.drag_to_cell(column, row);
        self.end_gesture();
    }

    /// Moves the scene to a cell of its map, as part of a gesture.
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

/// The search for the best stops, and the move of the stops to them.
impl Session {
    /// Searches for the best travel limit of the present scene, started from rest.
    pub fn find_best_stops(&mut self) {
        if self.best.is_off {
            return;
        }
        self.end_gesture();
        self.best.close();
        let search = match self.best_search() {
            Ok(search) => search,
            Err(why) => return self.best.refusal = Some(why),
        };
        let files = self.editor.document().files.clone();
        self.best.start(search, files, &self.wake);
    }

    /// The search for the present scene, or why there can be none.
    fn best_search(&self) -> Result<Search, &'static str> {
        if self.fault().is_some() {
            return Err("The best stops are searched for once the scene can be run.");
        }
        if matches!(self.scene().stops, Stops::Uneven { .. }) {
            return Err("The best stops are searched for where both stand equally far out: switch off \
                        “different stops left and right” under Advanced first.");
        }
        let Some(field) = info(LIMIT) else { return Err("") };
        let reach = reach(field, self);
        let axis = SweepAxis { field: LIMIT.to_owned(), step: reach.step, ..SweepAxis::default() };
        let mut scene = ground(self.scene(), self.remembered_stops(), std::slice::from_ref(&axis));
        if !FieldPath::new(LIMIT).set(&mut scene, reach.low) {
            return Err("The stops that would come do not stand equally far out.");
        }
        let range = DesignRange::new(LIMIT, (reach.low, reach.high), INTERVALS[0]);
        let duration_s = (!self.model().repeats()).then_some(scene.run.duration_s);
        Ok(Search { scene, range, column: maximised_column(self.model()), duration_s })
    }

    /// Receives results, and drops them once the scene has changed; to be called once a frame.
    pub fn follow_best(&mut self) {
        self.best.search.poll();
        let is_stale = match self.best.search.question() {
            Some(search) => self.best_search().as_ref() != Ok(search),
            None => self.best.refusal.is_some_and(|why| self.best_search() != Err(why)),
        };
        if is_stale {
            self.best.close();
        }
    }

    /// Whether the stops stand at the best travel limit known.
    pub fn is_at_best_stops(&self) -> bool {
        let limit = self.best.limit_mm();
        limit.is_some() && limit == FieldPath::new(LIMIT).get(self.scene())
    }

    /// Moves the stops to the best travel limit known, as one gesture.
    pub fn go_to_best_stops(&mut self) {
        let (Some(limit), Some(search)) = (self.best.limit_mm(), self.best.search.question()) else {
            return;
        };
        let stops = search.scene.stops;
        self.edit_once(|scene| {
            if scene.stops == Stops::None {
                scene.stops = stops;
            }
            let is_set = FieldPath::new(LIMIT).set(scene, limit);
            debug_assert!(is_set, "the stops of the search have a travel limit");
        });
    }

    /// Waits at most `timeout` for the answer. Returns whether it has come.
    pub fn wait_for_best_stops(&mut self, timeout: Duration) -> bool {
        self.best.search.wait(timeout);
        matches!(self.best.search.answer(), Some(Part::Whole(_)))
    }
}

/// Pins of the motion.
impl Session {
    /// Pins a motion beside the present one. Returns the letter of the pin; the error says why there is none.
    pub fn pin(&mut self, kind: PinKind) -> Result<char, String> {
        let Some(letter) = self.pins.free_letter() else {
            return Err(format!("{} motions are pinned already: unpin one first", LETTERS.len()));
        };
        self.end_gesture();
        self.apply();
        if let Some(fault) = self.fault() {
            return Err(format!("No motion of this scene can be pinned: {fault}"));
        }
        let mut scene = self.scene().clone();
        match kind {
            PinKind::Motion => {}
            PinKind::OtherStops => {
                let off = scene.stops == Stops::None;
                scene.stops = if off { self.remembered_stops() } else { Stops::None };
                keep_start_inside(&mut scene);
            }
            PinKind::Twin => scene.start = self.twin_start(),
        }
        let model = match kind {
            PinKind::Motion => Arc::clone(&self.model),
            PinKind::OtherStops | PinKind::Twin => Arc::new(self.model_of(&scene)?),
        };
        if kind == PinKind::Twin {
            self.restart();
        }
        let mut watch = match kind {
            PinKind::Twin => Watch::new(&model),
            PinKind::Motion | PinKind::OtherStops => self.player.watch().clone(),
        };
        if kind == PinKind::OtherStops {
            watch.change(&model);
        }
        let known = self.settled.answer().copied().filter(|_| kind == PinKind::Motion);
        let since = watch.time();
        let mut pin = Pin { letter, kind, scene, model, watch, since, known, settled: Background::default() };
        if known.is_none() {
            pin.ask(&self.wake);
        }
        self.pins.all.push(pin);
        Ok(letter)
    }

    /// Replaces the scene by that of a pin, as one undo step; the motion goes on from its present state.
    /// Returns whether the scene changed.
    pub fn take_back(&mut self, letter: char) -> bool {
        let Some(scene) = self.pins.get(letter).map(|pin| pin.scene().clone()) else { return false };
        self.edit_once(|edited| *edited = scene)
    }

    /// Continues the pinned motions to the live time of the motion, in phase with its drive; to be called
    /// after the motion has been advanced.
    pub fn follow_pins(&mut self) {
        let watch = self.player.watch();
        for pin in &mut self.pins.all {
            pin.watch.keep_ledgers(watch.keeps_ledgers());
            pin.follow(watch.time());
        }
    }

    /// A start a micrometre beside that of the scene, on a side without a stop in the way.
    fn twin_start(&self) -> Start {
        let start = Watch::new(&self.model).now();
        let (_, right) = self.model.stop_positions();
        let room = right.is_none_or(|stop| (stop - start.x) * 1e3 > TWIN_OFFSET_MM);
        let offset = if room { TWIN_OFFSET_MM } else { -TWIN_OFFSET_MM };
        Start::At { x_mm: start.x * 1e3 + offset, v_m_per_s: start.v, electrical: start.electrical }
    }

    /// The model of a scene with the mechanism of the open one, or why there is none.
    fn model_of(&self, scene: &Scene) -> Result<Model, String> {
        let mut document = self.editor.runnable();
        // the sweep axes do not matter for a motion
        document.scene = Scene { sweep: Vec::new(), ..scene.clone() };
        let built = || -> Result<Model, CannotRun> {
            document.check()?;
            let model = Model::build(&document.scene, Arc::clone(&self.mechanism));
            Ok(model.map_err(|faults| document.error_from(faults))?)
        };
        built().map_err(|error| fault_message(&error, scene))
    }
}

/// Comparison with measured data, and the use of a measured acceleration as the drive.
impl Session {
    /// Asks for the differences of the record from the present scene; called in every frame that shows them.
    pub fn want_differences(&mut self) {
        let (still, Some(question)) = (self.stands_still(), self.measured_question()) else { return };
        self.measured.found.want(question, still, &self.wake, |question, cancel, _| {
            question.differences(Some(question.over.shift), cancel)
        });
    }

    /// Starts the search for the shift with which the record fits the run of the scene best.
    pub fn fit_shift(&mut self) {
        let Some(question) = self.measured_question() else { return };
        self.measured.no_fit = None;
        self.measured.fit.ask(question, &self.wake, |question, cancel, _| {
            let shift = |found| match found {
                Differences::Motion(comparison) => comparison.shift,
                Differences::Force(_) => 0.0,
            };
            question.differences(None, cancel).map(|found| found.map(shift))
        });
    }

    fn measured_question(&self) -> Option<MeasuredQuestion> {
        let over = self.measured.over.clone()?;
        Some(MeasuredQuestion { model: Identity(Arc::clone(&self.model)), scene: self.built.clone(), over })
    }

    /// Shakes the base with the acceleration in the file at `path`, as one undo step. Returns warnings about
    /// the record, each a clause that continues its name. On an error, which is a sentence, nothing changes.
    pub fn shake_with(&mut self, path: &Path, shown: &MeasuredRecord) -> Result<Vec<String>, String> {
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let name = absolute.to_str().ok_or("The name of the file is not valid UTF-8: rename it.")?;
        let record = read_record(&absolute).map_err(|problem| {
            format!(
                "A scene knows its record by the file alone, and has to find the columns of time and \
                 acceleration by the units at the ends of their names, such as `t_s` and `a_g`. The file \
                 {problem}"
            )
        })?;
        let mismatch = "A scene knows its record by the file alone, and reads other columns than those that \
                     are chosen here, or in other units: name the two columns `t_s` and `accel_m_per_s2`, \
                     or end their names with their units, and no other ones with such units.";
        if (&record.times, &record.accelerations) != (&shown.across.values, &shown.values.values) {
            return Err(mismatch.to_owned());
        }
        let warnings = record.warnings(self.scene().run.duration_s);
        let excitation = Excitation::Recorded { path: name.to_owned(), record: Some(Arc::new(record)) };
        self.edit_once(|scene| scene.excitation = excitation);
        self.apply();
        self.restart();
        Ok(warnings)
    }
}

/// The column to maximise: the mean power into the load if there is a transducer, else the RMS velocity.
fn maximised_column(model: &Model) -> &'static str {
    if model.has_transducer() { "mean_load_power_w" } else { "rms_velocity_m_per_s" }
}
