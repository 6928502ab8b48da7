//! The session's map: its axes, the position of the scene on it, and moves of the scene to a cell.

use std::sync::Arc;
use std::time::Duration;

use crate::app::session::Session;
use crate::app::task::wait_while;
use crate::app::words::fields::{in_words, name_and_unit};
use crate::scene::{Axis, FieldPath, Stops, SweepAxis};
use crate::study::release_line;

use super::cells::too_many;
use super::{Map, Question, axes};

impl Session {
    /// The axes of the map; `None` if the scene has fewer than two fields for them.
    pub fn map_axes(&self) -> Option<[SweepAxis; 2]> {
        let (scene, when_on) = (self.scene(), self.remembered_stops());
        for axes in [&self.map.chosen, &self.map.default_axes].into_iter().flatten() {
            let ground = axes::ground(scene, when_on, axes);
            if axes.iter().all(|axis| FieldPath::new(&axis.field).get(&ground).is_some()) {
                return Some(axes.clone());
            }
        }
        axes::default_axes(scene, when_on, self.well_mm())
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
        if self.map.chosen.as_ref() != Some(&axes) {
            self.map.default_axes = Some(axes.clone());
        }
        let mut scene = axes::ground(self.scene(), self.remembered_stops(), &axes);
        for axis in &axes {
            if !FieldPath::new(&axis.field).set(&mut scene, axis.from) {
                return false;
            }
        }
        let wake = Arc::clone(self.wake());
        let in_gesture = self.editor.in_gesture();
        let quantity = self.map.quantity();
        let same =
            self.map.map.as_ref().filter(|map| map.question.scene == scene && map.question.axes == axes);
        // runs with an energy ledger have all columns of runs without one
        let needed = || quantity.needs_ledger.then_some(quantity.name);
        let ledger = same.and_then(|map| map.question.ledger).or_else(needed);
        let waits = self.map.ask(Question { scene, axes, ledger }, &self.editor, in_gesture, time, &wake);
        let mechanism = Arc::clone(self.model().mechanism());
        if let Some(map) = self.map.map.as_mut().filter(|map| map.known == 0 && map.release.is_empty())
            && !map.grid().changes_mechanism()
            && let Some(line) = release_line(&map.question.scene, &mechanism, map.sweep.grid())
        {
            let columns = map.grid().columns();
            let (x, y) = (line.numbers(&columns[0]), line.numbers(&columns[1]));
            map.release = x.into_iter().flatten().copied().zip(y.into_iter().flatten().copied()).collect();
        }
        waits
    }

    /// Position of the scene on the axes of a map; `None` on an axis whose field it lacks, such as the travel
    /// limit without stops.
    pub fn place_on_map(&self, question: &Question) -> [Option<f64>; 2] {
        question.axes.each_ref().map(|axis| FieldPath::new(&axis.field).get(self.scene()))
    }

    /// Why a map of the scene cannot have these axes: the index of the faulty axis, its faulty part, and a
    /// sentence. `None` if it can.
    pub fn map_problem(&self, axes: &[SweepAxis; 2]) -> Option<(usize, &'static str, String)> {
        let ground = axes::ground(self.scene(), self.remembered_stops(), axes);
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
        wait_while(timeout, || {
            self.map.take();
            self.map.is_running()
        });
        self.map.map().is_some_and(Map::is_whole)
    }
}
